"""The project's biaxial optics on published numbers: aragonite, n = 1.5300, 1.6810, 1.6854."""

from __future__ import annotations

import numpy as np
import pytest

from crystal_core.optics import Medium, scatter
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from tests.reference.arithmetic import Array
from tests.reference.berreman import scatter_reference, tensor_biaxial, tensor_uniaxial

INDICES = (1.5300, 1.6810, 1.6854)
AIR = Medium.isotropic(1.0)
ARAGONITE = Medium.biaxial(INDICES, np.eye(3))

# Air to aragonite on the axes TURNED, k = (0.5, 0, 0.866), normal +z: k_z and ray of each wave, powers [out, in].
TURNED = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
SLOW = 1.6053827289797, (0.2960984455159, 0.0016337156525, 0.9551560299429)
FAST = 1.5086003521871, (0.3823132977691, 0.0578087937871, 0.9222226877006)
TRANSMITTED = ((0.5529024282432, 0.3758588466988), (0.3642133591842, 0.5819900398080))


def test_optic_axes_of_aragonite() -> None:
    """2V = 18.03 degrees about alpha (negative); in air sin E = n_beta sin V, 2E = 30.55 degrees."""
    indicatrix = BiaxialIndicatrix.of(ARAGONITE)
    assert np.degrees(indicatrix.two_v()) == pytest.approx(18.03, abs=0.005)
    assert not indicatrix.is_positive()
    first, second = indicatrix.optic_axes()
    # the acute angle, about the direction of the lowest index
    between = np.degrees(np.arccos(abs(first @ second)))
    assert between == pytest.approx(18.03, abs=0.005)
    in_air = np.degrees(2 * np.arcsin(INDICES[1] * np.sin(indicatrix.two_v() / 2)))
    assert in_air == pytest.approx(30.55, abs=0.02)


def rays_about(axis: Array, theta: float) -> Array:
    """Return the rays, (3, 2 N), of both waves at theta from an axis that is the face's normal, all around it."""
    turns = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    x = np.cross(axis, [0.0, 1, 0])
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    tangential = INDICES[1] * theta * (np.outer(x, np.cos(turns)) + np.outer(y, np.sin(turns)))
    waves = scatter(axis, tangential, AIR, ARAGONITE).transmitted
    return np.concatenate([wave.ray for wave in waves], axis=1)


@pytest.mark.parametrize("theta", [1e-4, 1e-6, 1e-7, 1e-9])
@pytest.mark.parametrize("which", [0, 1])
def test_internal_conical_refraction(which: int, theta: float) -> None:
    """Waves all around an optic axis have rays on a cone, 1.882 degrees wide, with the axis on its surface."""
    a, b, c = INDICES
    axis = BiaxialIndicatrix.of(ARAGONITE).optic_axes()[which]
    rays = rays_about(axis, theta)
    # the section across the axis is a circle through the axis: its far point is the width of the cone
    from_axis = [np.arctan2(np.linalg.norm(np.cross(axis, ray)), axis @ ray) for ray in rays.T]
    widest = max(from_axis)
    assert np.degrees(widest) == pytest.approx(1.882, abs=1e-3 + np.degrees(20 * theta))
    # tan chi = sqrt((n_gamma^2 - n_beta^2)(n_beta^2 - n_alpha^2)) / (n_alpha n_gamma), Born & Wolf, 15.3.4
    expected = np.arctan(np.sqrt((c**2 - b**2) * (b**2 - a**2)) / (a * c))
    # a ray is known to 1e-14/theta, and the cone is that of theta -> 0
    assert widest == pytest.approx(expected, abs=20 * theta + 1e-14 / theta)
    assert min(from_axis) < 20 * theta + 1e-14 / theta


def test_air_to_aragonite() -> None:
    """An oblique face, digit by digit as the independent solver has it in 40 digits."""
    normal, tangential = np.array([0.0, 0.0, 1.0]), np.array([0.5, 0.0, 0.0])
    got = scatter(normal, tangential[:, None], AIR, Medium.biaxial(INDICES, TURNED))
    # principal directions along the rows
    target = tensor_biaxial(INDICES, TURNED.T, 40)
    truth = scatter_reference(normal, tangential, tensor_uniaxial(1, 1, normal, 40), target, digits=40)
    slow, fast = sorted(range(2), key=lambda i: -float(truth.forward[i].k[2]))
    for wave, place, q, ray in (
        (got.transmitted[0], slow, SLOW[0], SLOW[1]),
        (got.transmitted[1], fast, FAST[0], FAST[1]),
    ):
        np.testing.assert_allclose(float(truth.forward[place].k[2]), q, rtol=0, atol=1e-12)
        np.testing.assert_allclose(truth.forward[place].ray, ray, rtol=0, atol=1e-12)
        np.testing.assert_allclose(wave.k[:, 0], [0.5, 0, q], rtol=0, atol=1e-12)
        np.testing.assert_allclose(wave.ray[:, 0], ray, rtol=0, atol=1e-12)
    powers = np.array(got.power_transmitted)[:, :, 0]
    np.testing.assert_allclose(powers, TRANSMITTED, rtol=0, atol=1e-12)
    np.testing.assert_allclose(truth.power_transmitted[[slow, fast]], TRANSMITTED, rtol=0, atol=1e-12)
