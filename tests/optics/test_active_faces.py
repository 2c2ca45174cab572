"""Faces of optically active media: continuity, energy, reversal, long arithmetic, critical angles, limits."""

from __future__ import annotations

import itertools
from dataclasses import replace

import mpmath
import numpy as np
import pytest

import minerals_db
from crystal_core.materials import medium as medium_of
from crystal_core.optics import active
from crystal_core.optics.arrays import BoolArray, Complex, Field, Real
from crystal_core.optics.berreman import activity
from crystal_core.optics.directions import waves_along
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.frames import interface_frame
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.optics.interface import Scattering, scatter, solve_face
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Mode, Wave
from tests.optics.active_cases import (
    KINDS,
    Setup,
    conserved,
    full_k,
    magnetic,
    material,
    maxwell_error,
    random_medium,
    random_setup,
    units,
)
from tests.optics.active_exact import DIGITS, exact_face

NORMAL = np.array((0.0, 0.0, 1.0))
PAIRS = list(itertools.product(KINDS, KINDS))
SIDES = {"from active": (1, None), "into active": (None, 1), "both active": (1, 1)}
SIZES = (0.1, 1e-3, 1e-5, 1e-8, 1e-12)


def sized(side: str, size: float) -> tuple[float | None, float | None]:
    first, second = SIDES[side]
    return (None if first is None else size), (None if second is None else size)


def jump(setup: Setup, result: Scattering, mode: int) -> float:
    """Return the largest jump of tangential E or H over the faces, for one incident wave of unit E."""
    free = result.incident[mode].propagating
    total = np.zeros((2, 3, free.size), np.complex128)
    waves: list[tuple[Wave, Field, Medium]] = [(result.incident[mode], np.ones(free.size), setup.source)]
    waves += [(result.reflected[i], result.amplitude_reflected[i][mode], setup.source) for i in (0, 1)]
    waves += [(result.transmitted[i], -result.amplitude_transmitted[i][mode], setup.target) for i in (0, 1)]
    for wave, amplitude, medium in waves:
        total += amplitude * np.stack((wave.field, magnetic(medium, full_k(wave), wave.field)))
    total -= setup.normal * np.sum(total * setup.normal, axis=1, keepdims=True)
    return float(np.abs(total[:, :, free]).max())


def waves_of(result: Scattering) -> list[Wave]:
    return [*result.incident, *result.reflected, *result.transmitted]


@pytest.mark.parametrize(("source", "target"), PAIRS)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("size", SIZES)
def test_maxwell_continuity_and_energy(source: str, target: str, side: str, size: float) -> None:
    """Over random faces, from weak to absurd activity, total reflection included."""
    setup = random_setup(1, source, target, 300, sized(side, size))
    result = setup.scatter()
    for wave in waves_of(result)[:4]:
        assert maxwell_error(setup.source, full_k(wave), wave.field) < 1e-12
    for wave in waves_of(result)[4:]:
        assert maxwell_error(setup.target, full_k(wave), wave.field) < 1e-12
    for mode in (0, 1):
        assert np.count_nonzero(result.incident[mode].propagating) > 100
        np.testing.assert_allclose(conserved(result, mode), 1.0, rtol=0, atol=1e-12)
        assert jump(setup, result, mode) < 2e-12
    beyond = [~wave.propagating for wave in result.transmitted]
    assert np.count_nonzero(beyond[0] & beyond[1]) > 10
    for wave in waves_of(result):
        assert np.all(wave.propagating | (np.abs(wave.k_imag).max(axis=0) > 0))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", SIZES)
def test_two_waves_go_either_way(kind: str, size: float) -> None:
    """By their energy where they propagate, by their decay where not; slow waves first, and those that propagate."""
    setup = random_setup(2, kind, "isotropic", 1000, (size, None), reach=1.3)
    medium = framed(setup.source, interface_frame(setup.normal, setup.tangential))
    free = medium.propagating()
    assert 50 < np.count_nonzero(~free[1]) < 950
    assert np.all(free[0] | ~free[1])
    for sign in (1, -1):
        pair = medium.pair(sign, True)
        for mode, passes in zip(pair, free, strict=True):
            assert np.all(sign * mode.flux()[passes] >= 0)
            assert np.all(np.imag(mode.q)[passes] == 0)
            assert np.all(sign * np.imag(mode.q)[~passes] > 0)
        both = free[1] & ~(pair[0].names() == pair[1].names())
        lengths = [np.real(mode.q) ** 2 for mode in pair]
        assert np.all(pair[0].names() == "slow")
        assert np.all(lengths[0][both] >= lengths[1][both])


@pytest.mark.parametrize(("source", "target"), PAIRS)
@pytest.mark.parametrize("side", SIDES)
def test_powers_agree_with_fifty_digits(source: str, target: str, side: str) -> None:
    count = 5
    setup = random_setup(3, source, target, count, sized(side, 1e-2))
    result = setup.scatter()
    tensors = material(setup.source, count), material(setup.target, count)
    for ray in range(count):
        own = [(eps[:, :, ray], kap[:, :, ray]) for eps, kap in tensors]
        with mpmath.workdps(DIGITS):
            incident, reflected, transmitted, powers = exact_face(
                setup.normal[:, ray], setup.tangential[:, ray], own[0], own[1]
            )
        order = []
        sides = ((result.incident, incident), (result.reflected, reflected), (result.transmitted, transmitted))
        for ours, theirs in sides:
            q = [np.sum(setup.normal[:, ray] * full_k(wave)[:, ray]) for wave in ours]
            exact = np.array([complex(wave.q) for wave in theirs])
            if np.abs(exact[0] - exact[1]) < 1e-20:  # inactive, isotropic: s and p on both lists
                nearest = [0, 1]
            else:
                nearest = [int(np.argmin(np.abs(exact - value))) for value in q]
            assert sorted(nearest) == [0, 1]
            order.append(nearest)
            for value, place in zip(q, nearest, strict=True):
                assert abs(value - exact[place]) < 1e-12
        expected = powers[np.ix_([*order[1], *(2 + place for place in order[2])], order[0])]
        for j in (0, 1):
            got = [power[j][ray] for power in (*result.power_reflected, *result.power_transmitted)]
            np.testing.assert_allclose(got, expected[:, j], rtol=0, atol=1e-11)


def scattering_matrix(setup: Setup) -> tuple[Complex, list[Wave], list[Wave]]:
    """Return S between waves of unit flux, [out, in] (4, 4, N), NaN where one is evanescent, and both lists of waves.

    Waves 0 and 1 are in the source, 2 and 3 in the target; light comes from both sides.
    """
    front = setup.scatter()
    back = setup.from_behind().scatter()
    incoming, outgoing = [*front.incident, *back.incident], [*front.reflected, *front.transmitted]
    s = np.empty((4, 4, setup.normal.shape[1]), np.complex128)
    for side, result in enumerate((front, back)):
        own, other = result.amplitude_reflected, result.amplitude_transmitted
        other_waves = [*result.reflected, *result.transmitted]
        for i, j in itertools.product(range(4), (0, 1)):
            amplitude = own[i][j] if i < 2 else other[i - 2][j]
            place = i if side == 0 else (i + 2) % 4
            # Both calls find the same wave; its phase is that of the first.
            turn = np.sum(np.conj(outgoing[place].field) * other_waves[i].field, axis=0)
            scale = np.sqrt(
                np.abs(outgoing[place].flux) / np.where(result.incident[j].flux > 0, result.incident[j].flux, np.nan)
            )
            s[place, 2 * side + j] = amplitude * turn * np.where(outgoing[place].propagating, scale, np.nan)
    return s, incoming, outgoing


def _apart(setup: Setup) -> Setup:
    """Keep the faces at which waves are told apart: two that all but agree are known to rounding/(their distance)."""
    result, behind = setup.scatter(), setup.from_behind().scatter()
    kept = np.ones(setup.normal.shape[1], np.bool_)
    source, target = setup.source.gyration is not None, setup.target.gyration is not None
    for active_side, waves in (
        (source, (*result.incident, *result.reflected)),
        (target, (*result.transmitted, *behind.incident)),
    ):
        for one, other in itertools.combinations(waves, 2):
            gap = np.abs(full_k(one) - full_k(other)).max(axis=0)
            kept &= (gap > 2e-5) | (not active_side)
    for wave in waves_of(result):
        kept &= ~wave.propagating | (wave.flux > 1e-3) | (wave.flux < -1e-3)
    return setup.take(np.flatnonzero(kept))


@pytest.mark.parametrize(("source", "target"), PAIRS)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("size", [1e-1, 1e-4])
def test_reversed_scattering_is_the_transpose(source: str, target: str, side: str, size: float) -> None:
    """The partner of (k, E) is (−k, E*), with the ray reversed: between these S(reversed) = Sᵀ, and S†S = 1."""
    setup = _apart(random_setup(4, source, target, 300, sized(side, size)))
    s, incoming, outgoing = scattering_matrix(setup)
    there = Setup(setup.normal, -setup.tangential, setup.source, setup.target)
    back, incoming_back, outgoing_back = scattering_matrix(there)
    phases = []
    for ours, partners in ((outgoing, incoming_back), (incoming, outgoing_back)):
        for wave, partner in zip(ours, partners, strict=True):
            free = wave.propagating
            np.testing.assert_array_equal(partner.propagating, free)
            np.testing.assert_allclose(partner.k[:, free], -wave.k[:, free], atol=1e-12)
            np.testing.assert_allclose(partner.ray[:, free], -wave.ray[:, free], atol=1e-9)
            phases.append(np.sum(wave.field * partner.field, axis=0))  # of E_partner = phase · E*
            np.testing.assert_allclose(np.abs(phases[-1][free]), 1.0, rtol=0, atol=1e-12)
    # An amplitude into a field that has a phase too much lacks it.
    out, into = np.array(phases[:4]), np.array(phases[4:])
    expected = s.swapaxes(0, 1) * out[None] / into[:, None]
    some = np.isfinite(expected) & np.isfinite(back)
    assert np.count_nonzero(some) > 1500
    np.testing.assert_allclose(back[some], expected[some], rtol=0, atol=1e-10)
    # The transposition says something, and so does the conjugation of the partner.
    different = np.abs(s - s.swapaxes(0, 1))[np.isfinite(s) & np.isfinite(s.swapaxes(0, 1))]
    assert np.quantile(different, 0.9) > 1e-3
    whole = np.flatnonzero(np.isfinite(s).all(axis=(0, 1)))
    assert whole.size > 20
    gram = np.einsum("kin,kjn->nij", np.conj(s[:, :, whole]), s[:, :, whole])
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(4), gram.shape), rtol=0, atol=1e-10)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("modes", list(itertools.product((0, 1), (0, 1))))
def test_a_path_through_an_active_crystal_comes_back(kind: str, modes: tuple[int, int]) -> None:
    """Air, crystal, reflection inside, air; then with −k from the end: every k and ray comes back."""
    count, rng = 600, np.random.default_rng(5)
    crystal, air = random_medium(rng, kind, count, 1e-2), Medium.isotropic(1.0)
    normals = [units(rng, count) for _ in range(3)]

    def step(k: Real, normal: Real, source: Medium, target: Medium) -> Scattering:
        return scatter(normal, k - normal * np.sum(k * normal, axis=0), source, target)

    def towards(ray: Real, normal: Real) -> Real:
        """Normals in the sense of the ray."""
        return np.asarray(normal * np.where(np.sum(ray * normal, axis=0) > 0, 1.0, -1.0))

    start = units(rng, count)
    z0 = towards(start, normals[0])
    inside = step(start, z0, air, crystal).transmitted[modes[0]]
    z1 = towards(inside.ray, normals[1])
    turned = step(inside.k, z1, crystal, air).reflected[modes[1]]
    z2 = towards(np.where(np.isfinite(turned.ray), turned.ray, 1.0), normals[2])
    out = step(turned.k, z2, crystal, air).transmitted[0]
    good = inside.propagating & turned.propagating & out.propagating
    for ray, z in ((start, z0), (inside.ray, z1), (turned.ray, z2)):
        good &= np.abs(np.sum(np.where(np.isfinite(ray), ray, 0.0) * z, axis=0)) > 1e-2
    rays = np.flatnonzero(good)
    assert rays.size > 40
    part = crystal.take(rays)
    back = step(-out.k[:, rays], -z2[:, rays], air, part)
    first = _nearest(back.transmitted, -turned.k[:, rays])
    np.testing.assert_allclose(first.ray, -turned.ray[:, rays], atol=1e-10)
    np.testing.assert_allclose(np.abs(np.sum(first.field * turned.field[:, rays], axis=0)), 1.0, atol=1e-11)
    second = _nearest(step(first.k, -z1[:, rays] * -1.0, part, air).reflected, -inside.k[:, rays])
    np.testing.assert_allclose(second.ray, -inside.ray[:, rays], atol=1e-10)
    last = _nearest(step(second.k, -z0[:, rays], part, air).transmitted, -start[:, rays])
    np.testing.assert_allclose(last.ray, -start[:, rays], atol=1e-10)


def _nearest(pair: tuple[Wave, Wave], k: Real) -> Wave:
    """Return, of each pair, the wave of the wave vector given, which must be there."""
    first, second = pair
    is_first = np.abs(first.k - k).max(axis=0) < np.abs(second.k - k).max(axis=0)

    wave = replace(
        first,
        k=np.where(is_first, first.k, second.k),
        ray=np.where(is_first, first.ray, second.ray),
        field=np.where(is_first, first.field, second.field),
    )
    np.testing.assert_allclose(wave.k, k, atol=1e-11)
    return wave


AXIS = np.array((0.48, 0.6, 0.64))
TURNED = np.array(((0.36, 0.48, -0.8), (-0.8, 0.6, 0.0), (0.48, 0.64, 0.6)))
ARAGONITE = (1.53, 1.681, 1.6854)


def quartz(axis: Real, size: float = 6.5e-5) -> Medium:
    gyration = -0.5 * size * np.eye(3) + 1.5 * size * np.outer(axis, axis)
    return Medium.uniaxial(1.5443, 1.5534, axis).active(gyration)


def with_optic_axis_along_normal(gyration: Real) -> Medium:
    a, b, c = (n**-2.0 for n in ARAGONITE)
    x, z = np.sqrt((a - b) / (a - c)), np.sqrt((b - c) / (a - c))
    return Medium.biaxial(ARAGONITE, ((z, 0.0, x), (0.0, 1.0, 0.0), (-x, 0.0, z))).active(gyration)


SPECIAL = {
    "quartz, axis along the normal": quartz(NORMAL),
    "quartz, axis in the plane of incidence": quartz(np.array((1.0, 0.0, 0.0))),
    "quartz, axis along s": quartz(np.array((0.0, 1.0, 0.0))),
    "quartz, slanting axis": quartz(AXIS),
    "cubic": Medium.isotropic(1.55).active(6e-5 * np.eye(3)),
    "strong cubic": Medium.isotropic(1.55).active(6e-2 * np.eye(3)),
    "biaxial": Medium.biaxial(ARAGONITE, TURNED).active(1e-4 * np.eye(3)),
    "biaxial, optic axis along the normal": with_optic_axis_along_normal(1e-4 * np.eye(3)),
    "biaxial, optic axis along the normal, hardly active": with_optic_axis_along_normal(1e-14 * np.eye(3)),
    "isotropic, hardly active": Medium.isotropic(1.55).active(1e-14 * np.eye(3)),
    "quartz, hardly active": quartz(AXIS, 1e-14),
    "quartz along the normal, hardly active": quartz(NORMAL, 1e-14),
}
AIR, DENSE, ACTIVE_DENSE = Medium.isotropic(1.0), Medium.isotropic(2.0), Medium.isotropic(2.0).active(1e-4 * np.eye(3))


def along_x(kappa: Real) -> Real:
    return np.stack((kappa, np.zeros(kappa.size), np.zeros(kappa.size)))


def around_critical(medium: Medium) -> Real:
    """Tangential wave vectors at, and from rounding to 1e-4 around, the limits of both modes."""
    found = []
    for mode in (0, 1):
        low, high = 1.0, 1.9
        for _ in range(60):
            middle = 0.5 * (low + high)
            frame = interface_frame(NORMAL[:, None], along_x(np.array((middle,))))
            low, high = (middle, high) if framed(medium, frame).propagating()[mode][0] else (low, middle)
        steps = 10.0 ** np.arange(-15, -3)
        found += [low * (1 + sign * steps) for sign in (1, -1)] + [low + np.arange(-4, 5) * np.spacing(low)]
    return np.concatenate(found)


def assert_sound(kappa: Real, source: Medium, target: Medium, energy: float) -> None:
    setup = Setup(np.repeat(NORMAL[:, None], kappa.size, axis=1), along_x(kappa), source, target)
    result = setup.scatter()
    for wave in waves_of(result):
        assert np.all(np.isfinite(wave.k))
        np.testing.assert_allclose(np.linalg.norm(wave.field, axis=0), 1.0, atol=1e-14)
    for mode in (0, 1):
        free = result.incident[mode].propagating
        np.testing.assert_allclose(conserved(result, mode), 1.0, rtol=0, atol=energy)
        if free.any():
            assert jump(setup, result, mode) < 1e-12


@pytest.mark.parametrize("name", SPECIAL)
def test_normal_and_slight_incidence(name: str) -> None:
    kappa = np.array((0.0, 1e-300, 1e-160, 1e-16, 1e-9, 1e-5, 0.5, 0.999, 1.0, np.nextafter(1.0, 2), 1.2))
    assert_sound(kappa[:8], AIR, SPECIAL[name], 1e-14)
    assert_sound(kappa, SPECIAL[name], AIR, 1e-14)
    assert_sound(kappa, SPECIAL[name], SPECIAL[name], 1e-14)


@pytest.mark.parametrize("name", SPECIAL)
def test_critical_angles_and_grazing_incidence(name: str) -> None:
    """Exactly at the limit, within rounding of it, and up to 1e-4 from it: no warning, no NaN, no lost energy."""
    medium = SPECIAL[name]
    kappa = around_critical(medium)
    assert_sound(kappa, DENSE, medium, 1e-13)
    assert_sound(kappa, ACTIVE_DENSE, medium, 1e-13)
    assert_sound(kappa, medium, AIR, 1e-13)
    assert_sound(kappa, medium, DENSE, 1e-13)


@pytest.mark.parametrize("name", ["quartz, slanting axis", "strong cubic", "biaxial"])
def test_grazing_contact_with_the_same_crystal(name: str) -> None:
    """Where the wave that goes on and the one that comes back are nearly one, each is good to rounding over flux."""
    medium = SPECIAL[name]
    assert_sound(around_critical(medium), medium, medium, 1e-8)
    result = scatter(NORMAL, along_x(np.array((0.0, 0.5, 1.2))), medium, medium)
    for i, j in itertools.product((0, 1), (0, 1)):
        np.testing.assert_allclose(result.power_transmitted[i][j], float(i == j), atol=1e-14)
        np.testing.assert_allclose(result.power_reflected[i][j], 0.0, atol=1e-14)


def test_reflection_at_normal_incidence_knows_nothing_of_activity() -> None:
    """An isotropic κ leaves E/H at 1/n: r = (1 − n)/(1 + n) for circular light, which stays circular."""
    for n, g in ((1.5, 1e-2), (2.3, 0.3)):
        result = scatter(NORMAL, np.zeros((3, 1)), Medium.isotropic(n).active(g * np.eye(3)), AIR)
        for mode in (0, 1):
            expected = ((n - 1) / (n + 1)) ** 2
            total = result.power_reflected[0][mode] + result.power_reflected[1][mode]
            assert total[0] == pytest.approx(expected, abs=1e-15)
            # k̂·spin is kept: the slow wave comes back as the fast one, to whom it looks alike from behind.
            assert result.power_reflected[mode][mode][0] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(("source", "target"), PAIRS)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("size", [1e-7, 1e-10, 1e-13])
def test_powers_tend_to_those_of_inactive_media(source: str, target: str, side: str, size: float) -> None:
    """Summed over the modes of isotropic sides; wave by wave of others, where both indices differ by 1e-2."""
    setup = random_setup(6, source, target, 200, sized(side, size))
    plain = replace(setup, source=_inactive(setup.source), target=_inactive(setup.target))
    got, expected = setup.scatter(), plain.scatter()
    for ours, theirs in (
        (got.power_reflected, expected.power_reflected),
        (got.power_transmitted, expected.power_transmitted),
    ):
        # Of unpolarized light from an isotropic medium, or of both modes together: no mode is preferred.
        sums = [np.sum(np.array(power), axis=(0, 1)) for power in (ours, theirs)]
        kept = np.isfinite(sums[0]) & np.isfinite(sums[1]) & _steep(got) & _steep(expected)
        assert np.count_nonzero(kept) > 60
        np.testing.assert_allclose(sums[0][kept], sums[1][kept], atol=1e3 * size + 1e-9)


def _inactive(medium: Medium) -> Medium:
    return replace(medium, gyration=None)


def _steep(result: Scattering) -> BoolArray:
    """Whether no wave is near its limit, where powers go as the square root of everything."""
    kept = np.ones(result.incident[0].k.shape[1], np.bool_)
    for wave in waves_of(result):
        kept &= ~wave.propagating | (np.abs(wave.flux) > 0.05)
        kept &= wave.propagating | (np.abs(wave.k_imag).max(axis=0) > 0.05)
    return kept


@pytest.mark.parametrize("kind", KINDS[1:])
def test_waves_tend_to_those_of_inactive_crystals(kind: str) -> None:
    setup = random_setup(7, "isotropic", kind, 500, (None, 1e-11))
    ours = setup.scatter()
    theirs = replace(setup, target=_inactive(setup.target)).scatter()
    both = ours.transmitted[1].propagating & theirs.transmitted[1].propagating & theirs.transmitted[0].propagating
    gap = np.abs(theirs.transmitted[0].index - theirs.transmitted[1].index)
    rays = np.flatnonzero(both & _steep(theirs) & (np.where(both, gap, 0.0) > 0.01))
    assert rays.size > 150
    for i, wave in enumerate(ours.transmitted):
        distance = [np.abs(wave.k - other.k)[:, rays].max(axis=0) for other in theirs.transmitted]
        assert np.max(np.minimum(*distance)) < 1e-9
        first = distance[0] < distance[1]
        for j in (0, 1):
            same = np.where(first, theirs.power_transmitted[0][j][rays], theirs.power_transmitted[1][j][rays])
            np.testing.assert_allclose(ours.power_transmitted[i][j][rays], same, atol=1e-8)


def test_between_faces_of_matched_index_light_is_turned() -> None:
    """In and out of 1 mm of right quartz, along its axis, from glass of n_o: x comes out at −21.7°, as tabulated."""
    crystal = medium_of(minerals_db.mineral("quartz"), 589.3)
    glass = Medium.isotropic(crystal.indices[0])
    entry = scatter(NORMAL, np.zeros((3, 1)), glass, crystal)
    leaving = scatter(NORMAL, np.zeros((3, 1)), crystal, glass)
    start = [np.conj(wave.field[:, 0]) @ np.array((1.0, 0.0, 0.0)) for wave in entry.incident]
    field = np.zeros(3, np.complex128)
    for i, j in itertools.product((0, 1), (0, 1)):
        inside = entry.transmitted[i]
        phase = np.exp(2j * np.pi * inside.k[2, 0] * 1e6 / 589.3)
        carried = start[j] * entry.amplitude_transmitted[i][j][0] * phase
        same = np.conj(leaving.incident[i].field[:, 0]) @ inside.field[:, 0]
        for out in (0, 1):
            amplitude = carried * same * leaving.amplitude_transmitted[out][i][0]
            field += amplitude * leaving.transmitted[out].field[:, 0]
    assert np.linalg.norm(field) == pytest.approx(1.0, abs=1e-9)
    x, y = field[:2] * np.exp(-1j * np.angle(field[0]))
    assert abs(y.imag) < 1e-8  # it stays linear
    # +z comes towards the observer, who sees x to y counter-clockwise; dextro is clockwise.
    assert np.degrees(np.arctan2(y.real, x.real)) == pytest.approx(-21.705, rel=0.01)


def test_waves_behind_a_face_are_those_of_their_directions() -> None:
    for kind in KINDS:
        setup = random_setup(8, "isotropic", kind, 300, (None, 1e-2))
        for i, wave in enumerate(setup.scatter().transmitted):
            rays = np.flatnonzero(wave.propagating)
            s = wave.k[:, rays] / wave.index[rays]
            pair = waves_along(setup.target.take(rays), s)
            is_slow = wave.mode[rays] == "slow"
            assert np.all(is_slow) == (i == 0)
            index, ray = (np.where(is_slow, *(getattr(p, name) for p in pair)) for name in ("index", "ray"))
            np.testing.assert_allclose(wave.index[rays], index, atol=1e-13)
            np.testing.assert_allclose(wave.ray[:, rays], ray, atol=1e-10)


def test_near_an_optic_axis_both_waves_may_be_slow() -> None:
    """Inhibited reflection: activity parts the sheets, and leaves the dimple of the outer one where it is weak."""
    inactive = Medium.biaxial((1.5, 1.6, 1.9), np.eye(3))
    axis = BiaxialIndicatrix.of(inactive).optic_axes()[0]
    normal = np.array((0.0, 1.0, 0.0))  # across the plane of the optic axes
    kt = 1.6 * axis[:, None] * (1.0 + np.linspace(-0.02, 0.02, 401))
    frame = interface_frame(np.repeat(normal[:, None], 401, axis=1), kt)
    second = []
    for crystal in (inactive, inactive.active(1e-7 * np.eye(3))):
        waves = framed(crystal, frame)
        mode = waves.pair(1, True)[1]
        assert np.all(waves.pair(1, True)[0].names() == "slow")
        second.append(np.where(waves.propagating()[1], mode.names(), "none"))
    assert np.count_nonzero(second[0] == "slow") > 10
    assert np.count_nonzero(second[0] == "fast") > 10
    assert np.count_nonzero(second[0] == "none") > 10
    assert np.count_nonzero(second[0] != second[1]) <= 2  # at the cone itself


@pytest.mark.parametrize("kind", KINDS)
def test_a_ray_does_not_feel_its_batch(kind: str) -> None:
    setup = random_setup(9, kind, kind, 40, (1e-3, 1e-3))
    whole = setup.scatter()
    for ray in (0, 17, 39):
        alone = setup.take(np.array((ray,))).scatter()
        for ours, theirs in zip(waves_of(alone), waves_of(whole), strict=True):
            np.testing.assert_allclose(ours.field[:, 0], theirs.field[:, ray], rtol=0, atol=1e-10)
        for i, j in itertools.product((0, 1), (0, 1)):
            one, all_of_them = alone.power_transmitted[i][j], whole.power_transmitted[i][j]
            np.testing.assert_allclose(one[0], all_of_them[ray], rtol=0, atol=1e-10)
    medium = framed(setup.source, interface_frame(setup.normal, setup.tangential))
    for part, mode in zip(medium.take(np.arange(5, 15)).pair(1, True), medium.pair(1, True), strict=True):
        np.testing.assert_array_equal(part.q, mode.q[5:15])
        np.testing.assert_array_equal(part.flux(), mode.flux()[5:15])
        np.testing.assert_array_equal(part.names(), mode.names()[5:15])


@pytest.mark.parametrize("side", SIDES)
def test_single_precision_keeps_the_bound_of_the_other_media(side: str) -> None:
    """Roots within 5e-6 and energy within 2e-6, where all waves propagate and none slants more than 0.1."""
    setup = random_setup(10, "biaxial", "uniaxial", 2000, sized(side, 1e-4), reach=0.5)
    roots, flows = [], []
    for precision in (np.float64, np.float32):
        frame = interface_frame(setup.normal.astype(precision), setup.tangential.astype(precision))
        here, there = (framed(medium.astype(precision), frame) for medium in (setup.source, setup.target))
        face = solve_face(here, there, True, True)
        modes = (*face.incident, *face.reflected, *face.transmitted)
        roots.append(np.array([mode.q for mode in modes]))
        flow = [np.abs(face.transmission(0)[i]) ** 2 * face.transmitted[i].flux() for i in (0, 1)]
        flow += [-(np.abs(face.reflection(i, 0)) ** 2) * face.reflected[i].flux() for i in (0, 1)]
        flows.append(np.sum(flow, axis=0) / face.incident[0].flux())
        # Inactive media leave their fields as long as they come.
        parts = np.array(
            [[np.zeros(mode.q.shape) if e is None else e for e in (mode.ex, mode.ey, mode.ez)] for mode in modes]
        )
        fluxes = np.abs([mode.flux() for mode in modes]) / np.sum(np.abs(parts) ** 2, axis=1)
        steep = (np.min(fluxes, axis=0) > 0.1) & (np.abs(roots[-1].imag).max(axis=0) == 0)
    assert roots[1].dtype == np.complex64
    assert np.count_nonzero(steep) > 500
    np.testing.assert_allclose(roots[1][:, steep], roots[0][:, steep], rtol=0, atol=5e-6)
    np.testing.assert_allclose(flows[1][steep], 1.0, rtol=0, atol=2e-6)


def _mirrored(medium: Medium) -> Real | None:
    kappa = activity(medium)
    return None if kappa is None else -kappa


def test_the_wrong_hand_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    test_between_faces_of_matched_index_light_is_turned()
    monkeypatch.setattr(active, "activity", _mirrored)
    with pytest.raises(AssertionError):
        test_between_faces_of_matched_index_light_is_turned()
    with pytest.raises(AssertionError):
        test_maxwell_continuity_and_energy("uniaxial", "isotropic", "from active", 1e-3)


def test_a_magnetic_field_without_activity_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """H = k × E: what continuity would be taken of if κ were left out there."""
    original = active.FramedActive.pair

    def careless(self: active.FramedActive, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
        pair = original(self, sign, evanescent)
        for mode in pair:
            assert mode.ex is not None
            assert mode.ey is not None
            assert mode.ez is not None
            mode.hx, mode.hy = -mode.q * mode.ey, mode.q * mode.ex - self.frame.kappa * mode.ez
        return pair

    monkeypatch.setattr(active.FramedActive, "pair", careless)
    for side in SIDES:
        with pytest.raises(AssertionError):
            test_maxwell_continuity_and_energy("biaxial", "uniaxial", side, 1e-3)


def test_active_partners_are_not_those_of_inactive_media(monkeypatch: pytest.MonkeyPatch) -> None:
    """(−k, E) instead of (−k, E*): the projection with the bilinear form would rest on it."""
    from crystal_core.optics import interface

    monkeypatch.setattr(interface, "FramedActive", ())
    with pytest.raises(AssertionError):
        test_maxwell_continuity_and_energy("uniaxial", "isotropic", "from active", 1e-3)
