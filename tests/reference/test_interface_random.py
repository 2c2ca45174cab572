"""The project's interface optics against the independent Berreman solver, over random media and incidences.

The bound on powers, rays, wave vectors and fields is 1e-9 for modes at least 1e-3 rad from an optic axis with
|k_n| >= 1e-3, as the optics promises; nearer to an axis the truth is kept to 40 digits and the bound is 1e-14/angle.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from crystal_core.optics import Medium, Scattering, Wave, scatter
from tests.reference.arithmetic import Array
from tests.reference.berreman import Mode, Scattered, dot, scatter_reference, tensor_uniaxial

KINDS = ("isotropic", "uniaxial")
PAIRS = [pytest.param(a, b, id=f"{a}-to-{b}") for a in KINDS for b in KINDS]
SAMPLES = [300, pytest.param(2000, marks=pytest.mark.full)]


@dataclass(frozen=True)
class Media:
    """One random medium per case; without axes isotropic. n_o, n_e (N,), axis (3, N)."""

    n_o: Array
    n_e: Array
    axis: Array | None

    def medium(self) -> Medium:
        if self.axis is None:
            return Medium.isotropic(self.n_o)
        return Medium.uniaxial(self.n_o, self.n_e, self.axis)

    def tensor(self, case: int, digits: int | None) -> Array:
        axis = np.array([0.0, 0.0, 1.0]) if self.axis is None else self.axis[:, case]
        return tensor_uniaxial(float(self.n_o[case]), float(self.n_e[case]), axis, digits)

    def axis_of(self, case: int) -> Array | None:
        return None if self.axis is None else self.axis[:, case]

    @property
    def largest(self) -> Array:
        return np.maximum(self.n_o, self.n_e)


def random_units(rng: np.random.Generator, count: int) -> Array:
    v = rng.standard_normal((3, count))
    return np.asarray(v / np.linalg.norm(v, axis=0))


def random_media(rng: np.random.Generator, kind: str, count: int) -> Media:
    n_o, n_e = rng.uniform(1.0, 2.6, (2, count))
    if kind == "isotropic":
        return Media(n_o, n_o, None)
    # half of the cases as weakly birefringent as quartz or beryl
    weak = rng.random(count) < 0.5
    return Media(n_o, np.where(weak, n_o * rng.uniform(0.99, 1.01, count), n_e), random_units(rng, count))


@dataclass(frozen=True)
class Cases:
    source: Media
    target: Media
    normal: Array
    tangential: Array

    def run(self) -> Scattering:
        return scatter(self.normal, self.tangential, self.source.medium(), self.target.medium())

    def truth(self, case: int, digits: int | None = None) -> Scattered:
        """Return the independent answer, to 40 digits where double precision would not do."""
        result = scatter_reference(
            self.normal[:, case],
            self.tangential[:, case],
            self.source.tensor(case, digits),
            self.target.tensor(case, digits),
            source_axis=self.source.axis_of(case),
            target_axis=self.target.axis_of(case),
            digits=digits,
        )
        if digits is None:
            birefringent = [
                p
                for p, media in (
                    (result.incident, self.source),
                    (result.backward, self.source),
                    (result.forward, self.target),
                )
                if media.axis is not None
            ]
            near = any(np.abs(p.k - q.k).max() < 1e-4 for p, q in birefringent)
            steep = any(abs(dot(m.k, m.normal)) < 1e-2 for m in (*result.incident, *result.backward, *result.forward))
            if near or steep:
                return self.truth(case, 40)
        return result


def random_cases(seed: int, source: str, target: str, count: int) -> Cases:
    rng = np.random.default_rng(seed)
    first, second = random_media(rng, source, count), random_media(rng, target, count)
    normal = random_units(rng, count)
    across = np.cross(normal, random_units(rng, count), axis=0)
    across /= np.linalg.norm(across, axis=0)
    across -= normal * np.sum(normal * across, axis=0)
    return Cases(first, second, normal, across * rng.uniform(0, 0.999, count) * first.largest)


def as_float(v: Array) -> Array:
    return np.array([complex(x) for x in v])


def is_fair(truth: Scattered, source_axis: Array | None, target_axis: Array | None) -> bool:
    """Whether every wave is at least 1e-3 rad from its optic axis and has |k_n| >= 1e-3."""
    for pair, axis in (
        (truth.incident, source_axis),
        (truth.backward, source_axis),
        (truth.forward, target_axis),
    ):
        for mode in pair:
            k = as_float(mode.k)
            if abs(k @ as_float(mode.normal)) < 1e-3:
                return False
            if axis is None or not mode.propagating:
                continue
            if np.linalg.norm(np.cross(k.real, axis)) < 1e-3 * np.linalg.norm(k.real):
                return False
    return True


def assert_same_wave(wave: Wave, mode: Mode, case: int, bound: float) -> None:
    """Same k, ray and field; the field of a mode is defined up to a phase, so fields are compared as E E^dagger."""
    assert bool(wave.propagating[case]) == mode.propagating
    k = wave.k[:, case] + 1j * wave.k_imag[:, case]
    np.testing.assert_allclose(k, as_float(mode.k), rtol=0, atol=bound)
    e, field = as_float(mode.e), wave.field[:, case]
    np.testing.assert_allclose(np.outer(field, field.conj()), np.outer(e, e.conj()), rtol=0, atol=bound)
    if mode.propagating:
        np.testing.assert_allclose(wave.ray[:, case], mode.ray, rtol=0, atol=bound)
        np.testing.assert_allclose(wave.index[case], np.linalg.norm(as_float(mode.k)), rtol=0, atol=bound)
        np.testing.assert_allclose(wave.flux[case], float(mode.flux), rtol=0, atol=bound)
    else:
        assert wave.flux[case] == 0


def assert_same_outgoing_fields(
    waves: Sequence[Wave], amplitudes: Any, modes: Sequence[Mode], truth: Array, phase: Array, case: int, bound: float
) -> None:
    """Amplitude times field of each outgoing mode, for the same incident field, phase and all."""
    for i, j in itertools.product(range(2), range(2)):
        if np.isfinite(phase[j]):
            ours = amplitudes[i][j][case] * waves[i].field[:, case]
            theirs = complex(truth[i, j]) * as_float(modes[i].e) * phase[j]
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=bound)


def assert_agrees(got: Scattering, truth: Scattered, case: int, bound: float) -> None:
    for waves, pair in (
        (got.incident, truth.incident),
        (got.reflected, truth.backward),
        (got.transmitted, truth.forward),
    ):
        for wave, mode in zip(waves, pair, strict=True):
            assert_same_wave(wave, mode, case, bound)
    live = [mode.propagating for mode in truth.incident]
    for ours, theirs in (
        (got.power_reflected, truth.power_reflected),
        (got.power_transmitted, truth.power_transmitted),
    ):
        for i, j in itertools.product(range(2), range(2)):
            if live[j]:
                np.testing.assert_allclose(ours[i][j][case], theirs[i, j], rtol=0, atol=bound)
    phase = np.full(2, np.nan, dtype=complex)
    for j, mode in enumerate(truth.incident):
        if live[j]:
            phase[j] = np.vdot(as_float(mode.e), got.incident[j].field[:, case])
    assert_same_outgoing_fields(
        got.reflected, got.amplitude_reflected, truth.backward, truth.reflected, phase, case, bound
    )
    assert_same_outgoing_fields(
        got.transmitted, got.amplitude_transmitted, truth.forward, truth.transmitted, phase, case, bound
    )


def kept_energy(got: Scattering, j: int) -> Array:
    """Sum of all power fractions of incident mode j, (N,)."""
    return np.asarray(sum(got.power_reflected[i][j] + got.power_transmitted[i][j] for i in range(2)))


@pytest.mark.parametrize("count", SAMPLES)
@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_agrees_with_berreman(source: str, target: str, count: int) -> None:
    cases = random_cases(101, source, target, count)
    got = cases.run()
    compared = 0
    for case in range(count):
        truth = cases.truth(case)
        if is_fair(truth, cases.source.axis_of(case), cases.target.axis_of(case)):
            compared += 1
            assert_agrees(got, truth, case, 1e-9)
    assert compared > 0.98 * count


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_energy_is_kept(source: str, target: str) -> None:
    cases = random_cases(102, source, target, 20_000)
    got = cases.run()
    for j in range(2):
        live = got.incident[j].propagating
        assert live.sum() > 15_000
        assert np.abs(kept_energy(got, j)[live] - 1).max() < 1e-12
    both = [wave.propagating for wave in (*got.incident, *got.transmitted)]
    assert min(mask.sum() for mask in both) > 5_000  # transmitted and totally reflected cases are both there
    assert (~got.transmitted[0].propagating).sum() > 1_000


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_paths_are_reversible(source: str, target: str) -> None:
    """The same interface met from the far side by -k: waves, rays and the powers between each two modes come back."""
    cases = random_cases(103, source, target, 20_000)
    there = cases.run()
    back = Cases(cases.target, cases.source, -cases.normal, -cases.tangential).run()
    for i, j in itertools.product(range(2), range(2)):
        live = there.incident[j].propagating & there.transmitted[i].propagating
        assert live.sum() > 5_000
        np.testing.assert_allclose(-back.incident[i].k[:, live], there.transmitted[i].k[:, live], rtol=0, atol=1e-12)
        # a slanting wave has its ray within 1e-16 / k_n
        np.testing.assert_allclose(-back.transmitted[j].ray[:, live], there.incident[j].ray[:, live], rtol=0, atol=1e-9)
        forth, return_ = there.power_transmitted[i][j][live], back.power_transmitted[j][i][live]
        np.testing.assert_allclose(return_, forth, rtol=0, atol=1e-10)
    mirrored = Cases(cases.source, cases.target, cases.normal, -cases.tangential).run()
    for i, j in itertools.product(range(2), range(2)):
        live = there.incident[j].propagating & there.reflected[i].propagating
        forth, return_ = there.power_reflected[i][j][live], mirrored.power_reflected[j][i][live]
        np.testing.assert_allclose(return_, forth, rtol=0, atol=1e-10)


@pytest.mark.parametrize("exponent", [3, 4, 6, 8, 10])
@pytest.mark.parametrize("inside", [False, True], ids=["into", "out-of"])
def test_near_the_optic_axis(inside: bool, exponent: int) -> None:
    """At an angle theta from the axis each mode is within 1e-14/theta of the truth, sums over the pair within 1e-9."""
    rng = np.random.default_rng(104 + exponent)
    count, theta = 8, 10.0**-exponent
    n_o, n_e, n = rng.uniform(1.3, 1.9, (3, count))
    normal = random_units(rng, count)
    # an ordinary wave inside at up to 40 degrees; the axis is that direction turned by about theta
    across = np.cross(normal, random_units(rng, count), axis=0)
    across /= np.linalg.norm(across, axis=0)
    tilt = rng.uniform(0.0, 0.7, count)
    wave = np.sin(tilt) * across + np.cos(tilt) * normal
    axis = wave + theta * np.cross(wave, random_units(rng, count), axis=0)
    axis /= np.linalg.norm(axis, axis=0)
    crystal, glass = Media(n_o, n_e, axis), Media(n, n, None)
    tangential = n_o * np.sin(tilt) * across
    tangential -= normal * np.sum(normal * tangential, axis=0)
    cases = Cases(*((crystal, glass) if inside else (glass, crystal)), normal, tangential)
    got = cases.run()
    for case in range(count):
        truth = cases.truth(case, digits=50)
        bound = max(1e-12, 1e-14 / theta)
        for waves, pair in ((got.incident, truth.incident), (got.transmitted, truth.forward)):
            for ours, mode in zip(waves, pair, strict=True):
                np.testing.assert_allclose(ours.ray[:, case], mode.ray, rtol=0, atol=bound)
                e, field = as_float(mode.e), ours.field[:, case]
                np.testing.assert_allclose(np.outer(field, field.conj()), np.outer(e, e.conj()), rtol=0, atol=bound)
        assert_total_powers(got, truth, case)


def assert_total_powers(got: Scattering, truth: Scattered, case: int) -> None:
    """Compare what does not depend on the basis of a degenerate pair: powers summed over outgoing and incident."""
    for ours, theirs in (
        (got.power_reflected, truth.power_reflected),
        (got.power_transmitted, truth.power_transmitted),
    ):
        total = sum(ours[i][j][case] for i in range(2) for j in range(2))
        np.testing.assert_allclose(total, theirs.sum(), rtol=0, atol=1e-9)


NORMAL = np.array([0.0, 0.0, 1.0])
OBLIQUE = np.array([0.48, 0.6, 0.64])
DEGENERATE: dict[str, tuple[tuple[float, float, Any], tuple[float, float, Any], Sequence[float]]] = {
    # (n_o, n_e, axis), axis None for isotropic; tangential k along x
    "glass, normal incidence": ((1.0, 1.0, None), (1.5, 1.5, None), (0.0,)),
    "calcite, normal incidence": ((1.0, 1.0, None), (1.6584, 1.4864, OBLIQUE), (0.0,)),
    "axis along the normal": ((1.0, 1.0, None), (1.6584, 1.4864, NORMAL), (0.0, 1e-300, 1e-160, 1e-16, 1e-9, 0.5)),
    "axis along the normal, from inside": ((1.6584, 1.4864, NORMAL), (1.0, 1.0, None), (0.0, 1e-160, 1e-16, 1e-9, 0.5)),
    "axis in the face": ((1.0, 1.0, None), (1.6584, 1.4864, np.array([0.0, 1.0, 0.0])), (0.0, 1e-16, 0.5)),
    "no birefringence": ((1.0, 1.0, None), (1.55, 1.55, OBLIQUE), (0.0, 1e-9, 0.5, 0.999)),
    "no birefringence, from inside": ((1.55, 1.55, OBLIQUE), (1.0, 1.0, None), (0.0, 1e-9, 0.5, 0.999)),
    "an ulp of birefringence": ((1.0, 1.0, None), (1.55, np.nextafter(1.55, 2), OBLIQUE), (0.0, 1e-9, 0.5, 0.999)),
    "equal glasses": ((1.5, 1.5, None), (1.5, 1.5, None), (0.0, 0.5, 1.499)),
    "equal crystals": ((1.6584, 1.4864, OBLIQUE), (1.6584, 1.4864, OBLIQUE), (0.0, 0.5, 1.3)),
    "equal crystals, one reversed axis": ((1.6584, 1.4864, OBLIQUE), (1.6584, 1.4864, -OBLIQUE), (0.0, 0.5, 1.3)),
}


def degenerate_cases(name: str) -> Cases:
    source, target, tangential = DEGENERATE[name]

    def media(n_o: float, n_e: float, axis: Any) -> Media:
        count = len(tangential)
        columns = None if axis is None else np.repeat(np.array(axis)[:, None], count, axis=1)
        return Media(np.full(count, n_o), np.full(count, n_e), columns)

    along = np.zeros((3, len(tangential)))
    along[0] = tangential
    return Cases(media(*source), media(*target), np.repeat(NORMAL[:, None], len(tangential), axis=1), along)


def assert_finite(got: Scattering) -> None:
    """No NaN in anything that a wave which came in gives, and unit fields."""
    for wave in (*got.incident, *got.reflected, *got.transmitted):
        assert np.isfinite(wave.k).all()
        assert np.isfinite(wave.k_imag).all()
        assert np.isfinite(wave.flux).all()
        assert np.isfinite(wave.ray[:, wave.propagating]).all()
        np.testing.assert_allclose(np.linalg.norm(wave.ray[:, wave.propagating], axis=0), 1, rtol=0, atol=1e-14)
        np.testing.assert_allclose(np.linalg.norm(wave.field, axis=0), 1, rtol=0, atol=1e-14)
    for i, j in itertools.product(range(2), range(2)):
        live = got.incident[j].propagating
        for table in (got.amplitude_reflected, got.amplitude_transmitted, got.power_reflected, got.power_transmitted):
            assert np.isfinite(table[i][j][live]).all()


@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_directions(name: str) -> None:
    cases = degenerate_cases(name)
    got = cases.run()
    assert_finite(got)
    for j in range(2):
        live = got.incident[j].propagating
        np.testing.assert_allclose(kept_energy(got, j)[live], 1, rtol=0, atol=1e-12)
    for case in range(cases.tangential.shape[1]):
        assert_total_powers(got, cases.truth(case, digits=50), case)
    if name.startswith("equal"):
        for i, j in itertools.product(range(2), range(2)):
            np.testing.assert_allclose(got.power_reflected[i][j], 0, rtol=0, atol=1e-24)


CRITICAL: dict[str, tuple[tuple[float, float, Any], tuple[float, float, Any], float]] = {
    "glass to air": ((1.5, 1.5, None), (1.0, 1.0, None), 1.0),
    "calcite to air": ((1.6584, 1.4864, OBLIQUE), (1.0, 1.0, None), 1.0),
    "glass to calcite, ordinary": ((1.9, 1.9, None), (1.6584, 1.4864, OBLIQUE), 1.6584),
    "glass to calcite, extraordinary": ((1.9, 1.9, None), (1.6584, 1.4864, np.array([0.0, 1.0, 0.0])), 1.4864),
    "calcite to glass": ((1.6584, 1.4864, OBLIQUE), (1.4, 1.4, None), 1.4),
    "glass to quartz, axis along the tangential k": ((1.9, 1.9, None), (1.544, 1.553, np.array([1.0, 0, 0])), 1.544),
    "grazing in glass": ((1.5, 1.5, None), (1.7, 1.7, None), 1.5),
    "grazing in air over calcite": ((1.0, 1.0, None), (1.6584, 1.4864, OBLIQUE), 1.0),
    "grazing and critical at once": ((1.5, 1.5, None), (1.5, 1.5, None), 1.5),
    "grazing ordinary in calcite": ((1.6584, 1.4864, OBLIQUE), (1.7, 1.7, None), 1.6584),
}


@pytest.mark.parametrize("name", CRITICAL)
def test_critical_and_grazing(name: str) -> None:
    """Exactly at the edge, one ulp to both sides, and further: nothing is NaN, energy is kept, nothing jumps."""
    source, target, edge = CRITICAL[name]
    steps = [-1e-6, -1e-9, -1e-12, -1e-15, 0.0, 1e-15, 1e-12, 1e-9, 1e-6]
    tangential = [edge + d for d in steps]
    tangential += [float(np.nextafter(edge, 0)), float(np.nextafter(edge, 3))]
    DEGENERATE[name] = (source, target, tangential)
    cases = degenerate_cases(name)
    del DEGENERATE[name]
    got = cases.run()
    assert_finite(got)
    for j in range(2):
        live = got.incident[j].propagating
        np.testing.assert_allclose(kept_energy(got, j)[live], 1, rtol=0, atol=1e-12)
        if live.all():
            # powers go like the square root of the distance from the edge
            total = got.power_reflected[0][j] + got.power_reflected[1][j]
            for here, distance in zip(total, [*steps, 1e-15, 1e-15], strict=True):
                assert abs(here - total[steps.index(0.0)]) < 20 * np.sqrt(abs(distance)) + 1e-6
