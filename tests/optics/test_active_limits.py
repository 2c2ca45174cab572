"""Faces of optically active media at critical and grazing incidence, and with next to no activity."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from crystal_core.optics.arrays import BoolArray, Real
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.frames import interface_frame
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.optics.interface import Scattering, scatter
from crystal_core.optics.medium import Medium
from tests.optics.active_cases import (
    KINDS,
    NORMAL,
    PAIRS,
    SIDES,
    Setup,
    conserved,
    jump,
    random_setup,
    sized,
    waves_of,
)

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
