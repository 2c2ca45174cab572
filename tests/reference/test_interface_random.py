"""The project's interface optics against the independent Berreman solver, over random media and incidences.

The bound on powers, rays, wave vectors and fields is 1e-9 for modes at least 1e-3 rad from an optic axis with
|k_n| >= 1e-3, as the optics promises. Nearer to an axis: test_interface_axis.py.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterable

import numpy as np
import pytest

from crystal_core.optics import Wave, optic_axes
from tests.reference.arithmetic import Array
from tests.reference.berreman import Scattered
from tests.reference.cases import Cases, is_fair, random_cases
from tests.reference.comparison import assert_agrees, kept_energy, matched, on_outer_sheet
from tests.reference.media import KINDS, Kind

PAIRS = [pytest.param(a, b, id=f"{a}-to-{b}") for a in KINDS for b in KINDS]
SAMPLES = [300, pytest.param(2100, marks=pytest.mark.full)]


def outer_sheets(truth: Scattered, cases: Cases, case: int) -> dict[str, list[bool]]:
    """Return, for the propagating modes of each biaxial pair, whether they lie on the outer sheet."""
    source, target = cases.source.tensor(case, None), cases.target.tensor(case, None)
    sides = {
        "incident": (truth.incident, source, cases.source),
        "reflected": (truth.backward, source, cases.source),
        "transmitted": (truth.forward, target, cases.target),
    }
    return {
        name: [on_outer_sheet(mode, eps) for mode in pair if mode.propagating]
        for name, (pair, eps, media) in sides.items()
        if media.kind == "biaxial"
    }


def count(seen: Counter[str], truth: Scattered, sheets: dict[str, list[bool]]) -> None:
    """Count the situations that a test must have met."""
    seen["one incident mode"] += sum(m.propagating for m in truth.incident) == 1
    seen["evanescent transmitted"] += not all(m.propagating for m in truth.forward)
    seen["evanescent reflected"] += not all(m.propagating for m in truth.backward)
    seen["total reflection"] += not any(m.propagating for m in truth.forward)
    seen["incident pair slow"] += sheets.get("incident") == [True, True]
    seen["transmitted pair slow"] += sheets.get("transmitted") == [True, True]


@pytest.mark.parametrize("size", SAMPLES)
@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_agrees_with_berreman(source: Kind, target: Kind, size: int) -> None:
    cases = random_cases(101, source, target, size)
    got = cases.run()
    seen: Counter[str] = Counter()
    compared = 0
    for case in range(size):
        truth = matched(got, cases.truth(case), cases, case)
        if not is_fair(truth, cases, case):
            continue
        compared += 1
        assert_agrees(got, truth, case, 1e-9)
        sheets = outer_sheets(truth, cases, case)
        count(seen, truth, sheets)
        for name, pair in (
            ("incident", got.incident),
            ("reflected", got.reflected),
            ("transmitted", got.transmitted),
        ):
            if name in sheets:
                modes = [str(wave.mode[case]) for wave in pair if wave.propagating[case]]
                assert modes == ["slow" if outer else "fast" for outer in sheets[name]]
                assert modes != ["fast", "slow"]
    assert compared >= (2000 if size > 2000 else 0.95 * size)
    assert seen["evanescent transmitted"] > size // 30
    assert seen["total reflection"] > size // 50
    if source != "isotropic":
        assert seen["one incident mode"] > size // 30
        assert seen["evanescent reflected"] > size // 30
    if source == "biaxial":
        assert seen["incident pair slow"] > size // 100
    if target == "biaxial":
        assert seen["transmitted pair slow"] > size // 150


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_energy_is_kept(source: Kind, target: Kind) -> None:
    cases = random_cases(102, source, target, 20_000)
    got = cases.run()
    for j in range(2):
        live = got.incident[j].propagating
        assert live.sum() > 14_000
        assert np.abs(kept_energy(got, j)[live] - 1).max() < 1e-12
    both = [wave.propagating for wave in (*got.incident, *got.transmitted)]
    assert min(mask.sum() for mask in both) > 5_000  # transmitted and totally reflected cases are both there
    assert (~got.transmitted[0].propagating).sum() > 1_000


def off_axis(waves: Iterable[Wave], axes: tuple[Array, ...]) -> Array:
    """Return the rays with no wave within 1e-5 of an optic axis: there a mode is known to 1e-14/theta only."""
    good = [
        np.linalg.norm(np.cross(wave.k, axis, axis=0), axis=0) > 1e-5 * np.linalg.norm(wave.k, axis=0)
        for wave in waves
        for axis in axes
    ]
    return np.all(good, axis=0) if good else np.array(True)


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_paths_are_reversible(source: Kind, target: Kind) -> None:
    """The same face met from the far side by -k: waves, rays and the powers between each two modes come back."""
    cases = random_cases(103, source, target, 20_000)
    there, back = cases.run(), cases.reversed().run()
    source_axes, target_axes = (optic_axes(media.medium()) for media in (cases.source, cases.target))
    clear = off_axis((*there.incident, *there.reflected), source_axes) & off_axis(there.transmitted, target_axes)
    for i, j in itertools.product(range(2), range(2)):
        live = there.incident[j].propagating & there.transmitted[i].propagating & clear
        assert live.sum() > 5_000
        np.testing.assert_allclose(-back.incident[i].k[:, live], there.transmitted[i].k[:, live], rtol=0, atol=1e-12)
        # a slanting wave has its ray within 1e-16 / k_n
        np.testing.assert_allclose(-back.transmitted[j].ray[:, live], there.incident[j].ray[:, live], rtol=0, atol=1e-9)
        forth, return_ = there.power_transmitted[i][j][live], back.power_transmitted[j][i][live]
        np.testing.assert_allclose(return_, forth, rtol=0, atol=1e-10)
    mirrored = Cases(cases.source, cases.target, cases.normal, -cases.tangential).run()
    for i, j in itertools.product(range(2), range(2)):
        live = there.incident[j].propagating & there.reflected[i].propagating & clear
        assert live.sum() > 14_000
        forth, return_ = there.power_reflected[i][j][live], mirrored.power_reflected[j][i][live]
        np.testing.assert_allclose(return_, forth, rtol=0, atol=1e-10)
