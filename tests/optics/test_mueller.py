"""Stokes and Mueller views against Malus, Brewster, quarter-wave plates and the coherency matrices they stand for."""

import numpy as np
import pytest

from crystal_core.optics import Coherency, Medium, scatter
from crystal_core.optics.mueller import (
    coherency_of,
    degree_of_polarization,
    frame_rotation,
    importance_before,
    measured,
    mueller,
    partially_coherent,
    reversed_jones,
    reversed_mueller,
    rotated_jones,
    rotated_mueller,
    transported,
)

COUNT = 200
POLARIZER = np.array(((1.0, 0.0), (0.0, 0.0)))[:, :, None]


def _jones(rng: np.random.Generator) -> np.ndarray:
    return rng.standard_normal((2, 2, COUNT)) + 1j * rng.standard_normal((2, 2, COUNT))


def _light(rng: np.random.Generator) -> Coherency:
    """Return partially polarized light."""
    a = _jones(rng)
    c = np.einsum("ijn,kjn->ikn", a, np.conj(a))
    return Coherency(c[0, 0].real, c[1, 1].real, c[0, 1].real, c[0, 1].imag)


def _apply(matrix: np.ndarray, stokes: np.ndarray) -> np.ndarray:
    return np.einsum("ijn,jn->in", matrix, stokes)


def test_mueller_does_to_stokes_what_jones_does_to_the_coherency() -> None:
    rng = np.random.default_rng(1)
    j, light = _jones(rng), _light(rng)
    c = np.array(((light.xx, light.xy_re + 1j * light.xy_im), (light.xy_re - 1j * light.xy_im, light.yy)))
    passed = np.einsum("abn,bcn,dcn->adn", j, c, np.conj(j))
    expected = Coherency(passed[0, 0].real, passed[1, 1].real, passed[0, 1].real, passed[0, 1].imag).stokes()
    np.testing.assert_allclose(transported(light, j).stokes(), expected, atol=1e-12)
    np.testing.assert_allclose(_apply(mueller(j), light.stokes()), expected, atol=1e-12)


def test_coherency_of_undoes_stokes() -> None:
    light = _light(np.random.default_rng(2))
    back = coherency_of(light.stokes())
    for name in ("xx", "yy", "xy_re", "xy_im"):
        np.testing.assert_allclose(getattr(back, name), getattr(light, name), atol=1e-14)


def test_events_in_sequence_multiply_on_the_left() -> None:
    rng = np.random.default_rng(3)
    first, second = _jones(rng), _jones(rng)
    both = np.einsum("abn,bcn->acn", second, first)
    product = np.einsum("abn,bcn->acn", mueller(second), mueller(first))
    np.testing.assert_allclose(mueller(both), product, atol=1e-11)


def test_malus() -> None:
    """Between polarizers at an angle φ passes cos² φ; unpolarized light is halved by the first."""
    angle = np.linspace(0.0, np.pi, 13)
    turned = rotated_mueller(mueller(POLARIZER), angle)
    light = _apply(mueller(POLARIZER), Coherency.unpolarized(np.ones(1)).stokes())
    np.testing.assert_allclose(light[:, 0], (0.5, 0.5, 0.0, 0.0), atol=1e-16)
    np.testing.assert_allclose(_apply(turned, light)[0], 0.5 * np.cos(angle) ** 2, atol=1e-15)
    np.testing.assert_allclose(turned, mueller(rotated_jones(POLARIZER, angle)), atol=1e-15)


def test_rotation_is_counter_clockwise() -> None:
    """A polarizer turned by +45° passes light along (1, 1), S2 > 0, and not that along (1, −1)."""
    passed = _apply(rotated_mueller(mueller(POLARIZER), np.pi / 4), np.array((1.0, 0.0, 0.0, 0.0))[:, None])
    np.testing.assert_allclose(passed[:, 0], (0.5, 0.0, 0.5, 0.0), atol=1e-15)


def test_frame_rotation_is_that_of_the_coherency() -> None:
    rng = np.random.default_rng(4)
    light, angle = _light(rng), rng.uniform(0, 2 * np.pi, COUNT)
    turned = light.rotated(np.cos(angle), np.sin(angle)).stokes()
    np.testing.assert_allclose(_apply(mueller(frame_rotation(angle)), light.stokes()), turned, atol=1e-13)
    s0, s1, s2, s3 = light.stokes()
    cos, sin = np.cos(2 * angle), np.sin(2 * angle)
    np.testing.assert_allclose(turned, (s0, cos * s1 + sin * s2, cos * s2 - sin * s1, s3), atol=1e-13)


def test_quarter_wave_plate_makes_circular_light() -> None:
    """Slow axis along y, light along (1, 1): E = (1, i), counter-clockwise to who faces the source, S3 = +1.

    Fields are exp(i(k·r − ωt)), so that the slow wave's phase k d is the larger one. Two such plates are a half-wave
    plate, which turns circular light round and +45° into −45°.
    """
    plate = np.array(((1.0, 0.0), (0.0, np.exp(0.5j * np.pi))))[:, :, None]
    diagonal = Coherency.pure(np.ones(1), np.ones(1), 0.5 * np.ones(1))
    matrix = mueller(plate)
    once = _apply(matrix, diagonal.stokes())
    np.testing.assert_allclose(once[:, 0], (1.0, 0.0, 0.0, 1.0), atol=1e-15)
    np.testing.assert_allclose(_apply(matrix, once)[:, 0], (1.0, 0.0, -1.0, 0.0), atol=1e-15)
    clockwise = _apply(rotated_mueller(matrix, np.pi / 2), diagonal.stokes())
    np.testing.assert_allclose(clockwise[:, 0], (1.0, 0.0, 0.0, -1.0), atol=1e-15)


def test_brewster() -> None:
    """At tan θ = n the reflected light is polarized along s whole, and R_s = ((n² − 1)/(n² + 1))²."""
    n = 1.5
    kt = np.array((np.sin(np.arctan(n)), 0.0, 0.0))[:, None]
    r = scatter((0.0, 0.0, 1.0), kt, Medium.isotropic(1.0), Medium.isotropic(n)).amplitude_reflected
    jones = np.array(((r[1][1], r[1][0]), (r[0][1], r[0][0])))  # (p, s, propagation)
    reflected = transported(Coherency.unpolarized(np.ones(1)), jones)
    power = 0.5 * ((n * n - 1) / (n * n + 1)) ** 2
    np.testing.assert_allclose(reflected.stokes()[:, 0], (power, -power, 0.0, 0.0), atol=1e-16)
    np.testing.assert_allclose(degree_of_polarization(reflected), 1.0, rtol=1e-14)


def test_degree_of_polarization() -> None:
    rng = np.random.default_rng(5)
    light = _light(rng)
    determinant = light.xx * light.yy - light.xy_re**2 - light.xy_im**2
    expected = np.sqrt(1.0 - 4.0 * determinant / light.intensity() ** 2)
    np.testing.assert_allclose(degree_of_polarization(light), expected, rtol=1e-10)
    s0, s1, s2, s3 = light.stokes()
    np.testing.assert_allclose(degree_of_polarization(light), np.sqrt(s1**2 + s2**2 + s3**2) / s0, rtol=1e-14)
    np.testing.assert_array_equal(degree_of_polarization(Coherency.unpolarized(np.array((0.0, 2.0)))), 0.0)


def test_pure_light_stays_pure_and_a_sum_depolarizes() -> None:
    """A Jones matrix keeps pure light pure; half a beam straight on and half turned by a right angle has no S1 left."""
    rng = np.random.default_rng(6)
    j = _jones(rng)
    pure = Coherency.pure(j[0, 0], j[0, 1], np.ones(COUNT))
    np.testing.assert_allclose(degree_of_polarization(transported(pure, _jones(rng))), 1.0, rtol=1e-12)
    half = np.eye(2)[:, :, None] * np.sqrt(0.5)
    mixed = mueller(half) + mueller(rotated_jones(np.diag((1.0, -1.0))[:, :, None] * np.sqrt(0.5), np.pi / 4))
    horizontal = Coherency.pure(np.ones(1), np.zeros(1), np.ones(1))
    out = coherency_of(_apply(mixed, horizontal.stokes()))
    np.testing.assert_allclose(out.intensity(), 1.0, rtol=1e-15)
    np.testing.assert_allclose(degree_of_polarization(out), 0.0, atol=1e-15)


def test_partial_coherence_is_the_mean_over_the_band() -> None:
    """Of a phase with the mean exp(iδ) = γ: the mean Mueller matrix over equally likely phases ±δ, cos δ = γ."""
    rng = np.random.default_rng(7)
    first, second = _jones(rng), _jones(rng)
    delta = rng.uniform(0.0, np.pi, COUNT)
    mean = 0.5 * (mueller(first + np.exp(1j * delta) * second) + mueller(first + np.exp(-1j * delta) * second))
    np.testing.assert_allclose(partially_coherent(first, second, np.cos(delta)), mean, atol=1e-12)
    np.testing.assert_allclose(partially_coherent(first, second, 1.0), mueller(first + second), atol=1e-12)
    np.testing.assert_allclose(partially_coherent(first, second, 0.0), mueller(first) + mueller(second), atol=1e-12)


def test_the_adjoint_measures_the_same() -> None:
    """tr(W · J C J†) = tr(J† W J · C); multiplied on the left, J W J†, it is wrong by a large part."""
    rng = np.random.default_rng(8)
    light, importance, j = _light(rng), _light(rng), _jones(rng)
    behind = measured(importance, transported(light, j))
    np.testing.assert_allclose(measured(importance_before(importance, j), light), behind, rtol=1e-12)
    assert np.median(np.abs(measured(transported(importance, j), light) / behind - 1.0)) > 0.1


def test_reversal() -> None:
    """M(J_b) = O M(J)ᵀ O; twice run backward is forward again, and O matters."""
    j = _jones(np.random.default_rng(9))
    matrix = mueller(j)
    np.testing.assert_allclose(mueller(reversed_jones(j)), reversed_mueller(matrix), atol=1e-12)
    np.testing.assert_allclose(reversed_jones(reversed_jones(j)), j, atol=1e-15)
    without = np.swapaxes(matrix, 0, 1)
    assert np.median(np.abs(reversed_mueller(matrix) - without).max(axis=(0, 1))) > 0.1


def test_an_optically_active_rotation_is_undone_by_going_back_and_a_quarter_plate_is_not() -> None:
    """Natural activity turns the plane counter-clockwise, seen facing the source, whichever way light goes through."""
    turn = frame_rotation(-0.3)  # the element turns the light, not the frame
    np.testing.assert_allclose(reversed_jones(turn), turn, atol=1e-16)
    plate = rotated_jones(np.array(((1.0, 0.0), (0.0, 1j)))[:, :, None], 0.3)
    mirrored = rotated_jones(np.array(((1.0, 0.0), (0.0, 1j)))[:, :, None], -0.3)
    np.testing.assert_allclose(reversed_jones(plate), mirrored, atol=1e-16)


@pytest.mark.parametrize("wrong", [np.eye(2), np.ones((4, 4, 1)), np.ones((2, 3, 1))])
def test_shapes_are_checked(wrong: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"\(2, 2, N\)"):
        mueller(wrong)
