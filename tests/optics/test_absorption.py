"""a(E) against Beer-Lambert along the principal directions and against the exact complex wave vector."""

import numpy as np
import pytest

from crystal_core.optics import Medium, absorption_along_ray
from crystal_core.optics.directions import waves_along
from tests.reference.berreman import modes, tensor_uniaxial

N_O, N_E = 1.639, 1.620  # a tourmaline at 589.3 nm, near enough: any uniaxial crystal serves
AXIS = np.array((0.0, 0.0, 1.0))
PER_MM = (3.0, 0.4)
WAVELENGTH_NM = 589.3


def _medium() -> Medium:
    return Medium.uniaxial(N_O, N_E, AXIS, PER_MM)


def test_principal_directions() -> None:
    across = np.array(((1.0,), (0.0,), (0.0,)))
    ordinary, extraordinary = waves_along(_medium(), across)
    assert absorption_along_ray(_medium(), ordinary.k, ordinary.e) == pytest.approx(PER_MM[0], abs=1e-14)
    assert absorption_along_ray(_medium(), extraordinary.k, extraordinary.e) == pytest.approx(PER_MM[1], abs=1e-14)
    along = np.array(((0.0,), (0.0,), (1.0,)))
    for wave in waves_along(_medium(), along):  # both vibrate across the axis
        assert absorption_along_ray(_medium(), wave.k, wave.e) == pytest.approx(PER_MM[0], abs=1e-14)


@pytest.mark.parametrize("angle_deg", [3.0, 20.0, 45.0, 70.0, 89.0])
def test_agrees_with_the_exact_complex_mode(angle_deg: float) -> None:
    """2 k0 Im(k)·ray of the absorbing tensor; first order holds to ε'' / (split of the sheets)."""
    k0 = 2 * np.pi / (WAVELENGTH_NM * 1e-6)
    complex_eps = [n * n + 1j * n * a / k0 for n, a in zip((N_O, N_E), PER_MM, strict=True)]
    n_o, n_e = (np.sqrt(eps) for eps in complex_eps)
    eps = tensor_uniaxial(n_o, n_e, AXIS)
    angle = np.deg2rad(angle_deg)
    normal = np.array((np.sin(angle), 0.0, np.cos(angle)))
    forward, _ = modes(eps, normal, np.zeros(3))
    measured = []
    for mode in forward:
        k = np.asarray(mode.k, np.complex128)
        ray = np.asarray(mode.ray, np.float64)
        measured.append((2 * k0 * np.imag(k) @ ray, np.real(k)))
    expected = []
    for wave in waves_along(_medium(), normal[:, None]):
        expected.append(absorption_along_ray(_medium(), wave.k, wave.e)[0])
    np.testing.assert_allclose(sorted(a for a, _ in measured), sorted(expected), rtol=2e-6)


def test_a_transparent_medium_has_none() -> None:
    k = np.array(((0.0,), (0.0,), (1.6,)))
    field = np.array(((1.0,), (0.0,), (0.0,)))
    assert absorption_along_ray(Medium.uniaxial(N_O, N_E, AXIS), k, field) == 0.0
