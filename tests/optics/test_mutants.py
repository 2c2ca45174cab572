"""Deliberately wrong variants of the physics, each with the test that catches it.

Others stand beside what they are mutants of: the adjoint multiplied on the left, W not conjugated and the frame's turn
forgotten in `test_adjoint.py`; O dropped in `test_reciprocity.py`; 1/n² in contact in `test_curvature.py`; ε'' of the
other sign, D for E and the way counted along k in `test_absorption_exact.py`.
"""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.linalg import expm

from crystal_core.optics import Coherency, Medium, scatter, transverse_frame
from crystal_core.optics.arrays import Real
from crystal_core.optics.directions import waves_along
from tests.optics.paths import AIR, facing, norm, tangential
from tests.reference.media import random_units

COUNT = 4000
CALCITE = (1.6584, 1.4864)
K0 = 2 * np.pi / 589.3e-6  # mm⁻¹

Rule = Callable[[Real, Real, Real], Real]
"""(k, ray, normal) inside → tangential wave vector outside."""


def _by_k(k: Real, ray: Real, z: Real) -> Real:  # noqa: ARG001
    return tangential(k, z)


def _by_ray(k: Real, ray: Real, z: Real) -> Real:
    """Mutant: Snell's law with |k| for the ray."""
    return tangential(norm(k) * ray, z)


def _in_the_plane_of_the_ray(k: Real, ray: Real, z: Real) -> Real:
    """Mutant, the rule of the paper's section 5: the right angle, but in the plane of the ray and the normal."""
    direction = tangential(ray, z)
    return np.asarray(direction / norm(direction) * norm(tangential(k, z)))


def _extraordinary(seed: int) -> tuple[Medium, Real, Real, Real]:
    """Return calcite, k and ray of extraordinary waves in it, and normals of faces that they leave it by."""
    rng = np.random.default_rng(seed)
    calcite = Medium.uniaxial(*CALCITE, random_units(rng, COUNT))
    d = random_units(rng, COUNT)
    z = facing(random_units(rng, COUNT), d)
    wave = scatter(z, tangential(d, z), AIR, calcite).transmitted[1]
    return calcite, wave.k, wave.ray, facing(random_units(rng, COUNT), wave.ray)


def _outside(kt: Real, z: Real) -> Real:
    return np.asarray(kt + z * np.sqrt(np.maximum(0.0, 1.0 - np.sum(kt * kt, axis=0))))


def _return_error(rule: Rule, seed: int = 51) -> tuple[np.ndarray, np.ndarray]:
    """Return how far light sent back from where a rule says light goes is off the ray inside, and the rule's error.

    Degrees, for rays that the right rule and the tested one let out.
    """
    calcite, k, ray, z = _extraordinary(seed)
    kt, right = rule(k, ray, z), tangential(k, z)
    out = (norm(kt) < 0.999) & (norm(right) < 0.999)
    assert np.count_nonzero(out) > COUNT // 10
    rays = np.flatnonzero(out)
    calcite, kt, right, ray, z = calcite.take(rays), kt[:, out], right[:, out], ray[:, out], z[:, out]
    back = scatter(-z, -kt, AIR, calcite).transmitted[1]

    def degrees(a: Real, b: Real) -> np.ndarray:
        return np.asarray(np.degrees(2 * np.arcsin(np.minimum(1.0, 0.5 * norm(a - b)))))

    return degrees(-back.ray, ray), degrees(_outside(kt, z), _outside(right, z))


def test_refraction_belongs_to_k() -> None:
    off, _ = _return_error(_by_k)
    assert off.max() < 1e-8


@pytest.mark.parametrize(("rule", "mean", "largest"), [(_by_ray, 7.5, 20), (_in_the_plane_of_the_ray, 4.0, 12)])
def test_mutants_of_refraction_are_caught(rule: Rule, mean: float, largest: float) -> None:
    """Light sent back does not find the ray again, by degrees; nor does it leave calcite where it should."""
    off, error = _return_error(rule)
    assert np.median(off) > 1.0
    assert error.mean() == pytest.approx(mean, rel=0.05)
    assert error.max() > largest


@pytest.mark.parametrize("rule", [_by_ray, _in_the_plane_of_the_ray])
def test_mutants_of_refraction_bend_what_a_plate_leaves_straight(rule: Rule) -> None:
    """Light leaves a plane-parallel plate as it came in."""
    rng = np.random.default_rng(52)
    calcite = Medium.uniaxial(*CALCITE, random_units(rng, COUNT))
    d = random_units(rng, COUNT)
    z = facing(random_units(rng, COUNT), d)
    wave = scatter(z, tangential(d, z), AIR, calcite).transmitted[1]
    np.testing.assert_allclose(_by_k(wave.k, wave.ray, z), tangential(d, z), atol=1e-14)
    assert np.median(norm(rule(wave.k, wave.ray, z) - tangential(d, z))) > 0.02


def _transfer(eps: np.ndarray, thickness: float) -> np.ndarray:
    """Return exp(i k0 Δ d) of Berreman's (Ex, Ey, Hx, Hy) at normal incidence, (4, 4)."""
    across = eps[:2, :2] - np.outer(eps[:2, 2], eps[2, :2]) / eps[2, 2]
    delta = np.zeros((4, 4))
    delta[0, 3], delta[1, 2] = 1.0, -1.0  # q Ex = Hy, q Ey = −Hx
    delta[2], delta[3] = np.append(-across[1], (0, 0)), np.append(across[0], (0, 0))  # q Hx = −Dy, q Hy = Dx
    return np.asarray(expm(1j * K0 * thickness * delta))


def test_phase_is_of_k_not_of_the_ray() -> None:
    """Mutant: phase = index × length of the ray. Both waves of a slanting crystal, against Berreman's matrix.

    10 µm of calcite cut at 45°: the ray is 0.59 % longer than the plate, and the mutant's phase off by 0.99 rad.
    """
    axis = np.array((np.sqrt(0.5), 0.0, np.sqrt(0.5)))
    eps = CALCITE[0] ** 2 * np.eye(3) + (CALCITE[1] ** 2 - CALCITE[0] ** 2) * np.outer(axis, axis)
    thickness = 0.01  # mm
    z = np.array((0.0, 0.0, 1.0))[:, None]
    for wave in waves_along(Medium.uniaxial(*CALCITE, axis), z):
        psi = np.array((wave.e[0, 0], wave.e[1, 0], wave.h[0, 0], wave.h[1, 0]))
        behind = _transfer(eps, thickness) @ psi
        phase = np.exp(1j * K0 * wave.k[2, 0] * thickness)
        np.testing.assert_allclose(behind, phase * psi, atol=1e-11)
        mutant = np.exp(1j * K0 * wave.index[0] * thickness / wave.ray[2, 0])
        if wave.mode[0] == "extraordinary":
            assert abs(mutant - phase) > 0.9


def _turning(field: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Return how the tip of Re E exp(−iωt) turns about the direction, counter-clockwise seen facing the source: + ."""
    now, later = field.real, field.imag  # Re(E exp(−iωt)) at ωt = 0 and π/2
    return np.asarray(2.0 * np.sum(np.cross(now, later, axis=0) * direction, axis=0))


def test_a_left_handed_frame_is_caught() -> None:
    """S3 of totally reflected light by its frame, against how its field turns in space.

    Mutant: (x, −y, direction), in which S3 has the other sign.
    """
    rng = np.random.default_rng(53)
    glass = Medium.isotropic(1.7)
    d = random_units(rng, COUNT)
    across = np.cross(d, random_units(rng, COUNT), axis=0)
    sin = rng.uniform(0.62, 0.98, COUNT)  # the critical sine is 0.59
    z = np.sqrt(1 - sin**2) * d + sin * across / norm(across)
    s = scatter(z / norm(z), tangential(1.7 * d, z / norm(z)), glass, AIR)
    total = s.amplitude_reflected
    assert not s.transmitted[0].propagating.any()
    field = sum(total[i][j] * s.reflected[i].field for i in (0, 1) for j in (0, 1))
    out = s.reflected[0].k / 1.7
    x, y = transverse_frame(out)

    def circular(first: Real, second: Real) -> np.ndarray:
        ex, ey = (np.sum(axis * field, axis=0) for axis in (first, second))
        return Coherency.pure(ex, ey, np.ones(COUNT)).stokes()[3]

    turning = _turning(field, out)
    assert np.median(np.abs(turning)) > 0.3
    np.testing.assert_allclose(circular(x, y), turning, atol=1e-12)
    assert np.median(np.abs(circular(x, -y) - turning)) > 0.3


def test_fresnel_rhomb() -> None:
    """Two total reflections in glass of 1.51 at 54.6° make light at 45° circular: phases of s and p have their signs.

    Mutant: conjugated amplitudes, those of exp(i(ωt − k·r)), turn the other way.
    """
    angle = np.deg2rad(54.6)
    glass = Medium.isotropic(1.51)
    kt = np.array((1.51 * np.sin(angle), 0.0, 0.0))[:, None]
    r = scatter((0.0, 0.0, 1.0), kt, glass, AIR).amplitude_reflected
    s, p = r[0][0] ** 2, r[1][1] ** 2
    one = np.ones(1)
    stokes = Coherency.pure(p, s, 0.5 * one).stokes()[:, 0]
    # δ = δ_s − δ_p with tan(δ/2) = cos θ √(sin² θ − n⁻²)/sin² θ (Born & Wolf, Principles of Optics, 7th ed., §1.5.4);
    # p comes first, and the tip of E goes from p to s.
    delta = 2 * np.arctan(np.cos(angle) * np.sqrt(np.sin(angle) ** 2 - 1.51**-2) / np.sin(angle) ** 2)
    np.testing.assert_allclose(stokes, (1.0, 0.0, np.cos(2 * delta), np.sin(2 * delta)), atol=1e-13)
    assert stokes[3] > 0.9999
    mutant = Coherency.pure(np.conj(p), np.conj(s), 0.5 * one).stokes()[3, 0]
    assert mutant == pytest.approx(-stokes[3], abs=1e-12)
