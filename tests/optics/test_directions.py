"""The two waves along a wave normal, against the eigenproblem they solve and against long arithmetic."""

from __future__ import annotations

import itertools

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crystal_core.errors import InputError
from crystal_core.optics.arrays import Real
from crystal_core.optics.directions import PlaneWave, waves_along
from crystal_core.optics.indicatrix import BiaxialIndicatrix, permittivity
from crystal_core.optics.interface import scatter
from crystal_core.optics.medium import Medium

ARAGONITE = (1.5300, 1.6810, 1.6854)
CALCITE = (1.6584, 1.4864)


def directions(seed: int, count: int) -> Real:
    s = np.random.default_rng(seed).normal(size=(3, count))
    return np.asarray(s / np.linalg.norm(s, axis=0))


def frame(seed: int) -> Real:
    return np.asarray(np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0])


def media() -> dict[str, Medium]:
    axes = frame(5)
    return {
        "isotropic": Medium.isotropic(1.54),
        "positive uniaxial": Medium.uniaxial(1.5443, 1.5534, axes[2]),
        "calcite": Medium.uniaxial(*CALCITE, axes[2]),
        "aragonite": Medium.biaxial(ARAGONITE, axes),
        "in another order": Medium.biaxial((1.9, 1.5, 1.7), axes),
        "left-handed": Medium.biaxial((1.5, 1.6, 1.9), -axes),
        "two indices equal": Medium.biaxial((1.5, 1.7, 1.5), axes),
        "the upper two equal": Medium.biaxial((1.7, 1.7, 1.5), axes),
        "all equal": Medium.biaxial((1.6, 1.6, 1.6), axes),
        "nearly equal": Medium.biaxial((1.6, 1.6 + 1e-9, 1.6 + 3e-9), axes),
        "nearly uniaxial": Medium.biaxial((1.5, 1.5 + 4e-16, 1.7), axes),
        "huge": Medium.biaxial((1.2, 2.0, 4.0), axes),
    }


def assert_maxwell(medium: Medium, s: Real, waves: tuple[PlaneWave, PlaneWave]) -> None:
    eps = permittivity(medium)
    for wave in waves:
        assert np.all(np.isfinite(wave.index))
        np.testing.assert_allclose(wave.k, wave.index * s, atol=1e-14)
        np.testing.assert_allclose(np.linalg.norm(wave.e, axis=0), 1.0, atol=1e-14)
        np.testing.assert_allclose(wave.d, np.einsum("ij,jn->in", eps, wave.e), atol=1e-13)
        np.testing.assert_allclose(np.cross(wave.k, wave.e, axis=0), wave.h, atol=1e-13)
        np.testing.assert_allclose(np.cross(wave.k, wave.h, axis=0), -wave.d, atol=1e-13)
        np.testing.assert_allclose(np.sum(wave.k * wave.d, axis=0), 0.0, atol=1e-13)
        energy = np.cross(wave.e, wave.h, axis=0)
        np.testing.assert_allclose(wave.ray, energy / np.linalg.norm(energy, axis=0), atol=1e-13)
    a, b = waves
    np.testing.assert_allclose(np.sum(a.d * b.d, axis=0), 0.0, atol=1e-13)


@pytest.mark.parametrize("name", media())
def test_maxwell_holds_in_every_direction(name: str) -> None:
    medium = media()[name]
    s = directions(1, 3000)
    assert_maxwell(medium, s, waves_along(medium, s))


@pytest.mark.parametrize("name", media())
def test_the_degenerate_directions_are_quiet(name: str) -> None:
    """At and around the optic axes and the principal directions, from nothing to a degree: warnings are errors."""
    medium = media()[name]
    axes = medium.axes if medium.axes is not None else frame(5)
    centres = [*axes, *np.eye(3)]
    if medium.axes is not None:
        centres += BiaxialIndicatrix.of(medium).optic_axes()
    offsets = np.concatenate(([0.0], 10.0 ** np.arange(-18.0, -1.0)))
    around = np.array([sign * c[:, None] + t * directions(2, 8) for c in centres for t in offsets for sign in (1, -1)])
    s = around.transpose(1, 0, 2).reshape(3, -1)
    s = s / np.linalg.norm(s, axis=0)
    waves = waves_along(medium, s)
    assert_maxwell(medium, s, waves)
    assert waves[0].mode.shape == waves[0].index.shape == (s.shape[1],)
    if medium.axes is not None:
        assert np.all(waves[0].index >= waves[1].index)


def test_two_waves_are_the_eigenvectors_of_the_projected_impermeability() -> None:
    rng = np.random.default_rng(3)
    for seed in range(40):
        n = rng.uniform(1.3, 2.6, 3)
        medium = Medium.biaxial(n, frame(seed))
        s = directions(seed, 50)
        slow, fast = waves_along(medium, s)
        inverse = np.linalg.inv(permittivity(medium))
        for j in range(s.shape[1]):
            # Any basis across s, by the SVD; the section of the indicatrix is a 2 × 2 problem there.
            basis = np.linalg.svd(s[:, j : j + 1])[0][:, 1:]
            values, vectors = np.linalg.eigh(basis.T @ inverse @ basis)
            split = values[1] - values[0]
            for wave, value, vector in zip((slow, fast), values, vectors.T, strict=True):
                assert wave.index[j] == pytest.approx(value**-0.5, rel=1e-13)
                d = wave.d[:, j] / np.linalg.norm(wave.d[:, j])
                expected = basis @ vector
                assert np.linalg.norm(np.cross(d, expected)) <= 1e-14 / split


@pytest.mark.parametrize("exponent", [-1, -3, -5, -7, -9, -11, -13])
def test_near_an_optic_axis_against_forty_digits(exponent: int) -> None:
    theta = 10.0**exponent
    axes = frame(8)
    for indices in (ARAGONITE, (1.5, 1.52, 1.7), (1.6, 1.6001, 1.6002)):
        medium = Medium.biaxial(indices, axes)
        for axis in BiaxialIndicatrix.of(medium).optic_axes():
            s = axis[:, None] + theta * np.cross(axis, directions(9, 6), axisa=0, axisb=0, axisc=0)
            s = s / np.linalg.norm(s, axis=0)
            waves = waves_along(medium, s)
            true_angle = np.linalg.norm(np.cross(axis, s, axisa=0, axisb=0, axisc=0), axis=0)
            for j in range(s.shape[1]):
                bound = 1e-14 / true_angle[j]
                for wave, (n, d, ray) in zip(waves, long_waves(indices, axes, s[:, j]), strict=True):
                    assert wave.index[j] == pytest.approx(n, rel=1e-14)
                    got = wave.d[:, j] / np.linalg.norm(wave.d[:, j])
                    assert min(np.linalg.norm(got - d), np.linalg.norm(got + d)) <= bound
                    assert np.linalg.norm(wave.ray[:, j] - ray) <= bound


def long_waves(indices: tuple[float, ...], axes: Real, s: Real) -> list[tuple[float, Real, Real]]:
    """Return (n, unit D, ray) of the slow and the fast wave, from the 2 × 2 eigenproblem in 40-digit arithmetic."""
    with mpmath.workdps(40):
        # Rows in double precision are orthogonal to 1e-16 only, which a small birefringence would magnify.
        e, _ = mpmath.qr(mpmath.matrix([[float(x) for x in row] for row in axes]).T)
        eta = e * mpmath.diag([1 / mpmath.mpf(n) ** 2 for n in indices]) * e.T
        t = mpmath.matrix([mpmath.mpf(float(x)) for x in s])
        t /= mpmath.norm(t)
        helper = mpmath.matrix([1, 0, 0]) if abs(t[0]) < 0.6 else mpmath.matrix([0, 1, 0])
        a = helper - t * (t.T * helper)[0]
        a /= mpmath.norm(a)
        b = mpmath.matrix([t[1] * a[2] - t[2] * a[1], t[2] * a[0] - t[0] * a[2], t[0] * a[1] - t[1] * a[0]])
        p, q, r = ((u.T * eta * v)[0] for u, v in ((a, a), (a, b), (b, b)))
        turn = mpmath.atan2(2 * q, p - r) / 2  # of the larger eigenvalue, the fast wave
        found = []
        for angle in (turn + mpmath.pi / 2, turn):
            d = a * mpmath.cos(angle) + b * mpmath.sin(angle)
            n = 1 / mpmath.sqrt((d.T * eta * d)[0])
            field = eta * d
            field /= mpmath.norm(field)
            ray = t - field * (field.T * t)[0]
            ray /= mpmath.norm(ray)
            found.append((float(n), *(np.array([float(x) for x in v]) for v in (d, ray))))
        return found


@pytest.mark.parametrize("name", ["aragonite", "in another order", "left-handed", "huge", "calcite", "isotropic"])
def test_the_ray_is_the_normal_of_the_index_surface(name: str) -> None:
    """Fresnel's polynomial F(k) = k² k·ε·k − k·(tr ε − ε)ε·k + det ε vanishes at k; its gradient is along the ray."""
    medium = media()[name]
    eps = permittivity(medium)
    cofactor = np.trace(eps) * eps - eps @ eps
    for wave in waves_along(medium, directions(4, 2000)):
        k = wave.k
        k2, kek = np.sum(k * k, axis=0), np.einsum("in,ij,jn->n", k, eps, k)
        f = k2 * kek - np.einsum("in,ij,jn->n", k, cofactor, k) + np.linalg.det(eps)
        np.testing.assert_allclose(f, 0.0, atol=1e-12 * np.linalg.det(eps))
        gradient = 2 * k * kek + 2 * k2 * (eps @ k) - 2 * (cofactor @ k)
        length = np.linalg.norm(gradient, axis=0)
        # In an isotropic medium the polynomial is a square and its gradient vanishes on the surface.
        clear = length > 1e-3
        assert np.count_nonzero(clear) > 1900 or name == "isotropic"
        sine = np.linalg.norm(np.cross(wave.ray, gradient, axis=0), axis=0)[clear] / length[clear]
        np.testing.assert_allclose(sine, 0.0, atol=1e-11)
        assert np.all(np.sum(wave.ray * k, axis=0) > 0)


def test_along_the_principal_directions() -> None:
    axes = frame(6)
    alpha, beta, gamma = ARAGONITE
    slow, fast = waves_along(Medium.biaxial(ARAGONITE, axes), axes.T)
    np.testing.assert_allclose(slow.index, (gamma, gamma, beta), rtol=1e-15)
    np.testing.assert_allclose(fast.index, (beta, alpha, alpha), rtol=1e-15)
    for wave, vibrations in ((slow, (2, 2, 1)), (fast, (1, 0, 0))):
        along = np.abs(np.sum(wave.e * axes[list(vibrations)].T, axis=0))
        np.testing.assert_allclose(along, 1.0, atol=1e-14)
        np.testing.assert_allclose(wave.ray, axes.T, atol=1e-15)
    assert slow.mode.tolist() == ["slow"] * 3
    assert fast.mode.tolist() == ["fast"] * 3


def test_walk_off_of_calcite_at_45_degrees() -> None:
    ordinary, extraordinary = waves_along(Medium.uniaxial(*CALCITE, (0, 0, 1)), np.array([[1.0], [0], [1]]) / 2**0.5)
    assert np.degrees(extraordinary.walk_off()[0]) == pytest.approx(6.2241176, abs=5e-8)
    assert ordinary.walk_off()[0] == pytest.approx(0.0, abs=1e-15)
    assert (ordinary.mode[0], extraordinary.mode[0]) == ("ordinary", "extraordinary")
    # A negative crystal: the ray is turned away from the axis.
    angle = np.degrees(np.arctan2(extraordinary.ray[0, 0], extraordinary.ray[2, 0]))
    assert angle == pytest.approx(45 + 6.2241176, abs=5e-8)


def test_the_walk_off_is_that_of_the_closed_form() -> None:
    """tan(ray to axis) = (n_o/n_e)² tan(wave normal to axis)."""
    theta = np.linspace(0.0, np.pi, 181)
    s = np.stack((np.sin(theta), np.zeros_like(theta), np.cos(theta)))
    wave = waves_along(Medium.uniaxial(*CALCITE, (0, 0, 1)), s)[1]
    ray = np.arctan2((CALCITE[0] / CALCITE[1]) ** 2 * np.sin(theta), np.cos(theta))
    np.testing.assert_allclose(wave.ray, np.stack((np.sin(ray), 0 * ray, np.cos(ray))), atol=1e-14)
    np.testing.assert_allclose(wave.walk_off(), np.abs(ray - theta), atol=1e-15)


@pytest.mark.parametrize(("n_o", "n_e"), [(1.5443, 1.5534), CALCITE, (1.6, 1.6 + 1e-12)])
def test_three_indices_agree_with_two(n_o: float, n_e: float) -> None:
    axes = frame(7)
    s = directions(10, 500)
    pair = waves_along(Medium.uniaxial(n_o, n_e, axes[1]), s)
    general = waves_along(Medium.biaxial((n_o, n_e, n_o), axes), s)
    for wave, same in zip(pair if n_o > n_e else pair[::-1], general, strict=True):
        np.testing.assert_allclose(same.index, wave.index, rtol=1e-14)
        np.testing.assert_allclose(same.ray, wave.ray, atol=1e-13)
        np.testing.assert_allclose(np.abs(np.sum(same.e * wave.e, axis=0)), 1.0, atol=1e-13)


def test_an_isotropic_pair_is_right_handed() -> None:
    s = directions(11, 100)
    first, second = waves_along(Medium.isotropic(1.5), s)
    assert (first.mode[0], second.mode[0]) == ("s", "p")
    np.testing.assert_allclose(np.cross(second.e, first.e, axis=0), s, atol=1e-15)
    np.testing.assert_allclose(first.ray, s, atol=1e-15)


def test_one_medium_per_direction() -> None:
    rng = np.random.default_rng(12)
    s, count = directions(13, 9), 9
    axes = np.stack([frame(i) for i in range(count)], axis=2)
    several = {
        "indices in three orders": Medium.biaxial(rng.uniform(1.4, 2.0, (3, count)), axes),
        "one frame": Medium.biaxial(rng.uniform(1.4, 2.0, (3, count)), axes[:, :, 0]),
        "one set of indices": Medium.biaxial(ARAGONITE, axes),
        "uniaxial": Medium.uniaxial(rng.uniform(1.4, 2.0, count), 1.6, axes[0]),
        "isotropic": Medium.isotropic(rng.uniform(1.4, 2.0, count)),
    }
    for name, medium in several.items():
        together = waves_along(medium, s)
        for j in range(count):
            alone = waves_along(medium.take(np.array([j])), s[:, j : j + 1])
            for a, b in zip(together, alone, strict=True):
                for part in ("index", "k", "d", "e", "h", "ray"):
                    assert np.array_equal(getattr(a, part)[..., j], getattr(b, part)[..., 0]), (name, part)


@settings(max_examples=60, deadline=None)
@given(
    indices=st.tuples(*[st.floats(1.0, 3.0)] * 3),
    components=st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 1e-3),
)
def test_any_medium_any_direction(indices: tuple[float, ...], components: tuple[float, ...]) -> None:
    s = np.array(components)[:, None]
    s = s / np.linalg.norm(s)
    medium = Medium.biaxial(indices, np.eye(3))
    slow, fast = waves_along(medium, s)
    assert_maxwell(medium, s, (slow, fast))
    alpha, beta, gamma = sorted(indices)
    edge = 1e-14
    assert beta * (1 - edge) <= slow.index[0] <= gamma * (1 + edge)
    assert alpha * (1 - edge) <= fast.index[0] <= beta * (1 + edge)
    # The reversed wave has the same index and the reversed ray: rays can be traced backward.
    for wave, back in itertools.product((slow, fast), waves_along(medium, -s)):
        if wave.mode[0] == back.mode[0]:
            np.testing.assert_allclose(back.index, wave.index, rtol=1e-15)
    for wave in (slow, fast):
        np.testing.assert_allclose(np.sum(wave.ray_vector() * wave.k, axis=0), 1.0, rtol=1e-14)
        speed = 1.0 / (wave.index * np.cos(wave.walk_off()))
        np.testing.assert_allclose(np.linalg.norm(wave.ray_vector(), axis=0), speed, rtol=1e-14)


def test_no_directions_at_all() -> None:
    for medium in media().values():
        first, second = waves_along(medium, np.empty((3, 0)))
        assert first.ray.shape == second.k.shape == (3, 0)


@pytest.mark.parametrize(
    "wave_normal", [(0, 0, 1), np.zeros((3, 1)), np.full((3, 1), np.nan), np.ones((3, 2)), np.eye(2), np.inf]
)
def test_wrong_wave_normals_are_refused(wave_normal: Real) -> None:
    with pytest.raises(InputError, match="/wave_normal"):
        waves_along(Medium.biaxial(ARAGONITE, np.eye(3)), wave_normal)


@pytest.mark.parametrize(
    "medium",
    [
        Medium.isotropic([1.5, 1.6, 1.7]),
        Medium.uniaxial(1.5, 1.6, np.eye(3)),
        Medium.biaxial(ARAGONITE, np.stack([np.eye(3)] * 3, axis=2)),
        Medium.isotropic(1.5).active(np.stack([1e-5 * np.eye(3)] * 3, axis=2)),
    ],
)
def test_a_medium_of_another_number_of_rays_is_refused(medium: Medium) -> None:
    with pytest.raises(InputError, match="2 wave normals"):
        waves_along(medium, np.eye(3)[:, :2])


@pytest.mark.parametrize("name", ["isotropic", "calcite", "aragonite", "in another order", "huge"])
def test_the_waves_behind_a_face_are_waves_of_their_directions(name: str) -> None:
    """`scatter` solves for k at a given tangential part; the same waves come out when their direction is given."""
    medium = media()[name]
    rng = np.random.default_rng(14)
    normal = np.array((0.0, 0.6, 0.8))
    across = np.cross(normal, directions(15, 400), axisa=0, axisb=0, axisc=0)
    tangential = rng.uniform(0.0, 0.999, 400) * across / np.linalg.norm(across, axis=0)
    for wave in scatter(normal, tangential, Medium.isotropic(1.0), medium).transmitted:
        assert np.all(wave.propagating)
        candidates = waves_along(medium, wave.k / wave.index)
        index = np.stack([other.index for other in candidates])
        nearest = np.argmin(np.abs(index - wave.index), axis=0)
        chosen = np.arange(400)
        np.testing.assert_allclose(index[nearest, chosen], wave.index, rtol=1e-12)
        if name != "isotropic":  # where any pair serves
            for part, same in (("ray", wave.ray), ("e", wave.field.real)):
                got = np.stack([getattr(other, part) for other in candidates])[nearest, :, chosen].T
                np.testing.assert_allclose(np.linalg.norm(np.cross(got, same, axis=0), axis=0), 0.0, atol=1e-10)
