"""Faces of optically active media: continuity, energy, long arithmetic, rotation, mutants."""

from __future__ import annotations

import itertools

import mpmath
import numpy as np
import pytest

import minerals_db
from crystal_core.materials import medium as medium_of
from crystal_core.optics import active
from crystal_core.optics.arrays import Real
from crystal_core.optics.berreman import activity
from crystal_core.optics.directions import waves_along
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.frames import interface_frame
from crystal_core.optics.interface import scatter, solve_face
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Mode
from tests.optics.active_cases import (
    KINDS,
    NORMAL,
    PAIRS,
    SIDES,
    SIZES,
    conserved,
    full_k,
    jump,
    material,
    maxwell_error,
    random_setup,
    sized,
    waves_of,
)
from tests.optics.active_exact import DIGITS, exact_face


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


def test_reflection_at_normal_incidence_knows_nothing_of_activity() -> None:
    """An isotropic κ leaves E/H at 1/n: r = (1 − n)/(1 + n) for circular light, which stays circular."""
    for n, g in ((1.5, 1e-2), (2.3, 0.3)):
        result = scatter(NORMAL, np.zeros((3, 1)), Medium.isotropic(n).active(g * np.eye(3)), Medium.isotropic(1.0))
        for mode in (0, 1):
            expected = ((n - 1) / (n + 1)) ** 2
            total = result.power_reflected[0][mode] + result.power_reflected[1][mode]
            assert total[0] == pytest.approx(expected, abs=1e-15)
            # k̂·spin is kept: the slow wave comes back as the fast one, to whom it looks alike from behind.
            assert result.power_reflected[mode][mode][0] == pytest.approx(0.0, abs=1e-15)


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
