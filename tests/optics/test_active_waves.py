"""Waves of optically active media along a wave normal: rotation, elliptical vibrations, energy flow, limits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials import medium as medium_of
from crystal_core.optics import directions
from crystal_core.optics.arrays import Field, Real
from crystal_core.optics.berreman import activity
from crystal_core.optics.directions import PlaneWave, waves_along
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.optics.medium import Medium
from tests.optics.active_cases import KINDS, frames, material, maxwell_error, poynting, random_medium, units
from tests.optics.active_exact import DIGITS, exact_indices, wave_matrix

SIZES = (0.1, 1e-3, 1e-5, 1e-9)
Z = np.array(((0.0,), (0.0,), (1.0,)))
QUARTZ_DEG_PER_MM = {656.28: 17.318, 589.3: 21.705, 486.13: 32.773}
"""Right quartz at C, D (mean of D1, D2), F: J. L. Soret & E. Sarasin, in Winkelmann, Handbuch der Physik 2/1 (1894)."""


def counter_clockwise(field: Field) -> Real:
    """Return the degree of circular vibration in the plane x, y, 1 where E(t) turns from x to y: seen against +z."""
    # Re E exp(−iωt): the area that it goes round, Re(E(0) × E(quarter period)) by the length squared.
    start, quarter = field.real, (field * np.exp(-0.5j * np.pi)).real
    area = start[0] * quarter[1] - start[1] * quarter[0]
    return np.asarray(2 * area / np.sum(np.abs(field[:2]) ** 2, axis=0))


def rotation_deg_per_mm(medium: Medium, wavelength_nm: float) -> float:
    """Return the rotation clockwise to an observer who faces the source, of light along +z."""
    slow, fast = waves_along(medium, Z)
    left, right = (slow, fast) if counter_clockwise(slow.e)[0] > 0 else (fast, slow)
    for wave, sense in ((left, 1.0), (right, -1.0)):
        np.testing.assert_allclose(counter_clockwise(wave.e), sense, atol=1e-9)
    # E = left + right at z: each runs ahead by 2π n z/λ, and the counter-clockwise one turns back by it.
    return float(180.0 * (left.index - right.index)[0] / (wavelength_nm * 1e-6))


@pytest.mark.parametrize(("wavelength_nm", "expected"), QUARTZ_DEG_PER_MM.items())
def test_quartz_turns_light_along_its_axis_as_tabulated(wavelength_nm: float, expected: float) -> None:
    quartz = medium_of(minerals_db.mineral("quartz"), wavelength_nm)
    assert rotation_deg_per_mm(quartz, wavelength_nm) == pytest.approx(expected, rel=0.01)
    back = np.diag((1.0, -1.0, -1.0))  # the other way along the axis: the same hand
    turned = medium_of(minerals_db.mineral("quartz"), wavelength_nm, back)
    assert rotation_deg_per_mm(turned, wavelength_nm) == pytest.approx(expected, rel=0.01)


def test_paratellurite_turns_light_along_its_axis_as_tabulated() -> None:
    """86.9 °/mm at 632.8 nm: N. Uchida, Phys. Rev. B 4, 3736 (1971), of either hand."""
    paratellurite = medium_of(minerals_db.mineral("paratellurite"), 632.8)
    assert abs(rotation_deg_per_mm(paratellurite, 632.8)) == pytest.approx(86.9, rel=0.02)


def test_the_wrong_hand_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    quartz = medium_of(minerals_db.mineral("quartz"), 589.3)

    def mirrored(medium: Medium) -> Real | None:
        kappa = activity(medium)
        return None if kappa is None else -kappa

    monkeypatch.setattr(directions, "activity", mirrored)
    assert rotation_deg_per_mm(quartz, 589.3) == pytest.approx(-21.705, rel=0.01)


def test_rotation_is_g_over_n_whatever_the_gyration_across() -> None:
    g33, n_o, rng = 7e-5, 1.5443, np.random.default_rng(1)
    for across in rng.normal(size=5) * 1e-4:
        turns = rotation_deg_per_mm(Medium.uniaxial(n_o, 1.5534, Z[:, 0]).active(np.diag((across, across, g33))), 589.3)
        assert turns == pytest.approx(np.degrees(np.pi * g33 / (589.3e-6 * n_o)), rel=1e-7)


def test_a_cubic_crystal_turns_light_alike_in_all_directions() -> None:
    s = units(np.random.default_rng(2), 100)
    slow, fast = waves_along(Medium.isotropic(1.55).active(6e-5 * np.eye(3)), s)
    np.testing.assert_allclose(slow.index, 1.55 + 3e-5 / 1.55, rtol=0, atol=1e-15)
    np.testing.assert_allclose(fast.index, 1.55 - 3e-5 / 1.55, rtol=0, atol=1e-15)
    np.testing.assert_allclose(slow.walk_off(), 0.0, atol=1e-15)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", SIZES)
def test_maxwells_equations_hold(kind: str, size: float) -> None:
    rng = np.random.default_rng(3)
    medium, s = random_medium(rng, kind, 2000, size), units(rng, 2000)
    epsilon, kappa = material(medium, 2000)
    pair = waves_along(medium, s)
    for wave, name in zip(pair, ("slow", "fast"), strict=True):
        assert set(wave.mode) == {name}
        assert maxwell_error(medium, wave.k, wave.e) < 3e-14
        np.testing.assert_allclose(np.linalg.norm(wave.e, axis=0), 1.0, atol=1e-14)
        np.testing.assert_allclose(wave.k, wave.index * s, atol=1e-14)
        h = np.cross(wave.k, wave.e, axis=0) + 1j * np.einsum("ijn,jn->in", kappa, wave.e)
        np.testing.assert_allclose(wave.h, h, atol=3e-14)
        d = np.einsum("ijn,jn->in", epsilon, wave.e) + 1j * np.einsum("ijn,jn->in", kappa, wave.h)
        np.testing.assert_allclose(wave.d, d, atol=3e-14)
        np.testing.assert_allclose(wave.ray, poynting(medium, wave), atol=1e-13)
        cosine = np.sum(wave.ray * s, axis=0)
        np.testing.assert_allclose(np.cos(wave.walk_off()), cosine, atol=1e-13)
    slow, fast = pair
    assert np.all(slow.index >= fast.index)
    # Two waves along one direction exchange no energy.
    exchange = np.cross(np.conj(slow.e), fast.h, axis=0) + np.cross(fast.e, np.conj(slow.h), axis=0)
    np.testing.assert_allclose(np.sum(s * exchange, axis=0), 0.0, atol=1e-13)


@pytest.mark.parametrize("kind", KINDS)
def test_indices_and_fields_agree_with_forty_digits(kind: str) -> None:
    """From det[(k× + iκ)² + ε] = 0, a quartic in n, and the null vector E: H does not enter."""
    rng = np.random.default_rng(4)
    medium, s = random_medium(rng, kind, 12, 1e-2), units(rng, 12)
    epsilon, kappa = material(medium, 12)
    pair = waves_along(medium, s)
    for ray in range(12):
        own = epsilon[:, :, ray], kappa[:, :, ray]
        with mpmath.workdps(DIGITS):
            exact = exact_indices(s[:, ray], *own)
            for wave, n in zip(pair, exact, strict=True):
                assert abs(wave.index[ray] - n) < 2e-15
                k = [n * component for component in s[:, ray].tolist()]
                matrix = wave_matrix(k, mpmath.matrix(own[0].tolist()), mpmath.matrix(own[1].tolist()))
                assert mpmath.norm(matrix * mpmath.matrix(wave.e[:, ray].tolist())) < 1e-14


def tilt(wave: PlaneWave, along: Real) -> Real:
    """Return the axial ratio of D along and across `along` (3, N), positive if counter-clockwise."""
    s = wave.k / wave.index
    first = np.sum(wave.d * along, axis=0)
    second = np.sum(wave.d * np.cross(s, along, axis=0), axis=0)
    return np.asarray((second / first).imag)


@pytest.mark.parametrize("ratio", [-0.5, 0.0, 1.0])
def test_vibrations_are_fresnels_ellipses(ratio: float) -> None:
    """Axial ratio tan χ with tan 2χ = 2G/(n₁² − n₂²) (J. F. Nye, Physical Properties of Crystals, ch. XIV), G = s·g·s.

    In opposite senses for both waves; and (n² − n₁²)(n² − n₂²) = G². All of it to the relative birefringence, 1.2 %.
    """
    g33, n_o, n_e = 6.5e-5, 1.5443, 1.5534
    birefringent = (n_e**2 - n_o**2) / n_o**2
    quartz = Medium.uniaxial(n_o, n_e, Z[:, 0]).active(np.diag((ratio * g33, ratio * g33, g33)))
    theta = np.radians((2.0, 5.0, 10.0, 30.0, 70.0, 90.0))
    s = np.stack((np.sin(theta), np.zeros(theta.size), np.cos(theta)))
    slow, fast = waves_along(quartz, s)
    ordinary, extraordinary = waves_along(Medium.uniaxial(n_o, n_e, Z[:, 0]), s)
    g = g33 * (np.cos(theta) ** 2 + ratio * np.sin(theta) ** 2)
    split = (extraordinary.index - ordinary.index) * (extraordinary.index + ordinary.index)
    chi = 0.5 * np.arctan2(2 * g, split)
    # Of a positive crystal the slow wave is the extraordinary one. Counter-clockwise for G > 0.
    for wave, plain, sign in ((slow, extraordinary, 1.0), (fast, ordinary, -1.0)):
        error = birefringent * g33 / split
        ratio_of_axes = tilt(wave, plain.d.real / np.linalg.norm(plain.d, axis=0))
        assert np.all(np.abs(ratio_of_axes - sign * np.tan(chi)) < error)
        product = (wave.index**2 - ordinary.index**2) * (wave.index**2 - extraordinary.index**2)
        assert np.all(np.abs(product - g * g) < 3 * birefringent * g33**2)


def test_along_an_optic_axis_of_a_biaxial_crystal_n_is_the_mean() -> None:
    """There n_slow − n_fast = G/n̄ with the mean n̄ of all three indices, not n_β: off by |n_β − n̄|/n̄.

    Exactly so if g is the same in all directions; a g that is not comes in with the birefringence besides.
    """
    indices = (1.53, 1.681, 1.6854)
    mean = sum(indices) / 3
    inactive = Medium.biaxial(indices, frames(np.random.default_rng(5), 1)[:, :, 0])
    s = np.stack(BiaxialIndicatrix.of(inactive).optic_axes(), axis=1)
    slow, fast = waves_along(inactive.active(5e-5 * np.eye(3)), s)
    np.testing.assert_allclose(slow.index - fast.index, 5e-5 / mean, rtol=1e-4)

    gyration = np.array(((3e-5, 1e-5, 0.0), (1e-5, -2e-5, 4e-6), (0.0, 4e-6, 5e-5)))
    slow, fast = waves_along(inactive.active(gyration), s)
    g = np.einsum("in,ij,jn->n", s, gyration, s)
    birefringence = (indices[2] ** 2 - indices[0] ** 2) / mean**2
    np.testing.assert_allclose(slow.index - fast.index, np.abs(g) / mean, atol=birefringence * 5e-5 / mean)


@pytest.mark.parametrize("kind", KINDS)
def test_energy_goes_along_the_normal_of_the_index_surface(kind: str) -> None:
    """The energy's velocity is that of a group: ray · dk = 0 on the sheet, by central differences."""
    rng = np.random.default_rng(6)
    medium, s = random_medium(rng, kind, 300, 1e-2), units(rng, 300)
    step = 1e-5
    for turn in frames(rng, 300)[:2]:
        across = np.cross(s, turn, axis=0)
        ends = []
        for sign in (1, -1):
            moved = s + sign * step * across
            ends.append(waves_along(medium, moved / np.linalg.norm(moved, axis=0)))
        for which, wave in enumerate(waves_along(medium, s)):
            change = (ends[0][which].k - ends[1][which].k) / (2 * step)
            np.testing.assert_allclose(np.sum(wave.ray * change, axis=0), 0.0, atol=1e-6)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", [1e-6, 1e-9, 1e-12])
def test_with_the_gyration_the_activity_goes(kind: str, size: float) -> None:
    rng = np.random.default_rng(7)
    medium, s = random_medium(rng, kind, 500, size), units(rng, 500)
    inactive = Medium(medium.indices, medium.axis, medium.axes)
    pair = waves_along(medium, s)
    plain = np.stack([wave.index for wave in waves_along(inactive, s)])
    order = np.argsort(-plain, axis=0)
    got = np.stack([wave.index for wave in pair])
    np.testing.assert_allclose(got, np.take_along_axis(plain, order, axis=0), atol=10 * size + 1e-14)
    if kind == "isotropic":
        return
    apart = np.flatnonzero(np.abs(plain[0] - plain[1]) > 1e-3)
    assert apart.size > 400
    fields = np.stack([wave.e for wave in waves_along(inactive, s)])
    sorted_fields = np.take_along_axis(fields, order[:, None, :], axis=0)
    for wave, field in zip(pair, sorted_fields, strict=True):
        overlap = np.abs(np.sum(np.conj(wave.e) * field, axis=0))[apart]
        np.testing.assert_allclose(overlap, 1.0, atol=(1e4 * size) ** 2 + 1e-13)


def test_no_gyration_is_no_activity() -> None:
    medium = Medium.uniaxial(1.5443, 1.5534, Z[:, 0])
    s = units(np.random.default_rng(8), 10)
    for plain, zero in zip(waves_along(medium, s), waves_along(medium.active(np.zeros((3, 3))), s), strict=True):
        np.testing.assert_array_equal(zero.mode, plain.mode)
        np.testing.assert_array_equal(zero.e, plain.e)


def test_where_nothing_tells_the_waves_apart_any_pair_serves() -> None:
    """A batch with one inactive ray, along its optic axis."""
    gyration = np.stack((np.diag((0.0, 0.0, 7e-5)), np.zeros((3, 3))), axis=2)
    medium = Medium.uniaxial(1.5443, 1.5534, Z[:, 0]).active(gyration)
    s = np.repeat(Z, 2, axis=1)
    slow, fast = waves_along(medium, s)
    assert slow.index[1] == pytest.approx(1.5443, abs=1e-15)
    assert fast.index[1] == pytest.approx(1.5443, abs=1e-15)
    assert abs(np.vdot(slow.e[:, 1], fast.e[:, 1])) < 1e-15


def test_a_gyration_beyond_the_indices_is_refused() -> None:
    """D·E + B·H would not be positive: there is no such medium."""
    for medium in (
        Medium.isotropic(1.1),
        Medium.uniaxial(1.5, 1.1, Z[:, 0]),
        Medium.biaxial((1.1, 1.5, 1.6), np.eye(3)),
    ):
        with pytest.raises(InputError, match=r"^/gyration: the gyration is too large"):
            waves_along(medium.active(np.diag((1.5, -1.5, 1.5))), Z)
