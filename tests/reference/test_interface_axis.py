"""The interface optics near an optic axis, where the two waves of a pair come together: truth in 80 digits.

At the angle theta from the axis each mode is within 1e-14/theta; what does not depend on how the pair is split, total
powers and total fields, is within 1e-9.
"""

from __future__ import annotations

import numpy as np
import pytest

from crystal_core.optics import Scattering, Wave
from tests.reference.arithmetic import Array
from tests.reference.berreman import Mode, Scattered
from tests.reference.cases import Cases, angle_to_axes, as_float
from tests.reference.comparison import assert_same_totals, kept_energy, matched, total_field
from tests.reference.media import Kind, Media, random_frames, random_units

DIGITS = 80
CASES = [6, pytest.param(25, marks=pytest.mark.full)]


def crystals(rng: np.random.Generator, kind: Kind, count: int, weak: bool) -> Media:
    """Return crystals with indices from 1.3 to 1.9, or 1 % of that apart."""
    indices = rng.uniform(1.3, 1.9, (3, count))
    if weak:
        indices = 1.6 + 0.01 * (indices - 1.6)
    if kind == "uniaxial":
        indices[1] = indices[0]
    return Media(kind, indices, random_frames(rng, count))


def near_axis(seed: int, kind: Kind, theta: float, count: int, inside: bool, weak: bool) -> Cases:
    """Return faces crossed by waves at theta from an optic axis, by order of magnitude, up to 40 degrees inside."""
    rng = np.random.default_rng(seed)
    crystal = crystals(rng, kind, count, weak)
    n = rng.uniform(1.3, 1.9, (3, count))
    glass = Media("isotropic", np.broadcast_to(n[0], (3, count)), crystal.axes)
    axes = np.array([crystal.optic_axes(i)[i % 2 if kind == "biaxial" else 0] for i in range(count)]).T
    # the index along an optic axis is the middle one, or the ordinary
    middle = np.sort(crystal.indices, axis=0)[1]
    tilt = rng.uniform(0.0, 0.7, count)
    slant = np.cross(axes, random_units(rng, count), axis=0)
    slant /= np.linalg.norm(slant, axis=0)
    normal = np.cos(tilt) * axes + np.sin(tilt) * slant
    normal /= np.linalg.norm(normal, axis=0)
    off = np.cross(axes, random_units(rng, count), axis=0)
    wave = middle * (axes + theta * off / np.linalg.norm(off, axis=0))
    tangential = wave - normal * np.sum(normal * wave, axis=0)
    return Cases(*((crystal, glass) if inside else (glass, crystal)), normal, tangential)


def assert_near_truth(wave: Wave, mode: Mode, case: int, axes: list[Array]) -> None:
    """Within 1e-14 over the wave's own angle from the axis (1e-12 where that is less)."""
    bound = max(1e-12, 1e-14 / angle_to_axes(as_float(mode.k).real, axes))
    np.testing.assert_allclose(wave.k[:, case], as_float(mode.k).real, rtol=0, atol=1e-12)
    np.testing.assert_allclose(wave.ray[:, case], mode.ray, rtol=0, atol=bound)
    e, field = as_float(mode.e), wave.field[:, case]
    np.testing.assert_allclose(np.outer(field, field.conj()), np.outer(e, e.conj()), rtol=0, atol=bound)


def assert_same_sums(got: Scattering, truth: Scattered, case: int) -> None:
    """From glass: the reflected light of each incident mode, and the sums over the transmitted pair."""
    for j in range(2):
        for i in range(2):
            ours = got.power_reflected[i][j][case]
            np.testing.assert_allclose(ours, truth.power_reflected[i, j], rtol=0, atol=1e-9)
        ours = sum(got.power_transmitted[i][j][case] for i in range(2))
        np.testing.assert_allclose(ours, truth.power_transmitted[:, j].sum(), rtol=0, atol=1e-9)
        phase = np.vdot(as_float(truth.incident[j].e), got.incident[j].field[:, case])
        theirs = as_float(sum(truth.transmitted[i, j] * truth.forward[i].e for i in range(2))) * phase
        field = total_field(got.transmitted, got.amplitude_transmitted, j, case)
        np.testing.assert_allclose(field, theirs, rtol=0, atol=1e-9)


@pytest.mark.parametrize("size", CASES)
@pytest.mark.parametrize("exponent", [3, 4, 6, 8, 10, 12])
@pytest.mark.parametrize("weak", [False, True], ids=["strong", "weak"])
@pytest.mark.parametrize("inside", [False, True], ids=["into", "out-of"])
@pytest.mark.parametrize("kind", ["uniaxial", "biaxial"])
def test_near_the_optic_axis(kind: Kind, inside: bool, weak: bool, exponent: int, size: int) -> None:
    theta = 10.0**-exponent
    cases = near_axis(104 + exponent, kind, theta, size, inside, weak)
    got = cases.run()
    for case in range(size):
        truth = matched(got, cases.truth(case, digits=DIGITS), cases, case)
        if inside:
            axes, waves, pair = cases.source.optic_axes(case), got.incident, truth.incident
        else:
            axes, waves, pair = cases.target.optic_axes(case), got.transmitted, truth.forward
        for ours, mode in zip(waves, pair, strict=True):
            assert mode.propagating
            assert 0.1 * theta < angle_to_axes(as_float(mode.k).real, axes) < 3 * theta + 1e-15
            assert_near_truth(ours, mode, case, axes)
        assert_same_totals(got, truth, case, 1e-9)
        if not inside:
            assert_same_sums(got, truth, case)


@pytest.mark.parametrize("theta", [0.0, 1e-16, 1e-15, 1e-14, 1e-13])
@pytest.mark.parametrize("inside", [False, True], ids=["into", "out-of"])
@pytest.mark.parametrize("kind", ["uniaxial", "biaxial"])
def test_on_the_optic_axis(kind: Kind, inside: bool, theta: float) -> None:
    """On the axis to rounding: no mode of its own is defined, but unit fields, energy and all sums are."""
    size = 6
    cases = near_axis(7, kind, theta, size, inside, False)
    got = cases.run()
    for pair in (got.incident, got.reflected, got.transmitted):
        for wave in pair:
            np.testing.assert_allclose(np.linalg.norm(wave.field, axis=0), 1, rtol=0, atol=1e-14)
            free = wave.propagating
            np.testing.assert_allclose(np.linalg.norm(wave.ray[:, free], axis=0), 1, rtol=0, atol=1e-14)
    for j in range(2):
        np.testing.assert_allclose(kept_energy(got, j), 1, rtol=0, atol=1e-12)
    for case in range(size):
        assert_same_totals(got, cases.truth(case, digits=DIGITS), case, 1e-9)
