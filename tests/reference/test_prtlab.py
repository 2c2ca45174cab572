"""Rays, fields and powers at faces of isotropic and uniaxial media against prtLab."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from crystal_core.optics import Scattering, Wave
from tests.reference.arithmetic import Array
from tests.reference.cases import Cases, random_cases
from tests.reference.media import Kind
from tests.reference.prtlab_faces import Event, events

PLAIN: tuple[Kind, ...] = ("isotropic", "uniaxial")
PAIRS = [pytest.param(a, b, id=f"{a}-to-{b}") for a in PLAIN for b in PLAIN]


def within_its_reach(cases: Cases, got: Scattering) -> Array:
    """Return the cases that prtLab can do to 1e-9 in its double precision, (N,).

    Waves of crystals propagate (its choice between evanescent ones is by the sign of rounding), stand 1e-4 apart (their
    fields come from an SVD) and have k, as the ray, forward (from a crystal to glass it lets k decide what is forward).
    """
    good = np.ones(cases.normal.shape[1], bool)
    for pair, media, side in (
        (got.incident, cases.source, 1),
        (got.reflected, cases.source, -1),
        (got.transmitted, cases.target, 1),
    ):
        if media.kind == "isotropic":
            continue
        good &= np.linalg.norm(pair[0].k - pair[1].k, axis=0) > 1e-4
        for wave in pair:
            good &= wave.propagating & (side * wave.flux > 1e-3)
            good &= side * np.sum(wave.k * cases.normal, axis=0) > 1e-3
    return np.flatnonzero(good)


def pick(waves: Sequence[Wave], mode: str, case: int) -> int:
    return [str(wave.mode[case]) for wave in waves].index(mode)


def compare(cases: Cases, got: Scattering, case: int, frame: Array, event: Event) -> int:
    """Compare one event and return how many outgoing waves were."""
    if event.mode in ("s", "p"):
        inputs = [np.vdot(wave.field[:, case], frame.T @ event.field) for wave in got.incident]
    else:
        which = pick(got.incident, event.mode, case)
        np.testing.assert_allclose(frame @ got.incident[which].k[:, case], event.k, rtol=0, atol=1e-9)
        inputs = [0j, 0j]
        inputs[which] = np.vdot(got.incident[which].field[:, case], frame.T @ event.field)
    assert len(event.outgoing) == sum(1 if media.kind == "isotropic" else 2 for media in (cases.source, cases.target))
    for out in event.outgoing:
        waves, table = (
            (got.reflected, got.amplitude_reflected) if out.reflected else (got.transmitted, got.amplitude_transmitted)
        )
        modes = [0, 1] if out.mode == "isotropic" else [pick(waves, out.mode, case)]
        field = sum(table[i][j][case] * inputs[j] * waves[i].field[:, case] for i in modes for j in (0, 1) if inputs[j])
        np.testing.assert_allclose(frame @ field, out.field, rtol=0, atol=1e-9)
        for i in modes:
            k = waves[i].k[:, case] + 1j * waves[i].k_imag[:, case]
            np.testing.assert_allclose(frame @ k, out.k, rtol=0, atol=1e-9)
            if waves[i].propagating[case]:
                np.testing.assert_allclose(frame @ waves[i].ray[:, case], out.ray, rtol=0, atol=1e-9)
        # the fluxes of s and p add up, those of the fields here are the event's own
        flux = sum(
            abs(sum(table[i][j][case] * inputs[j] for j in (0, 1) if inputs[j])) ** 2 * abs(waves[i].flux[case])
            for i in modes
        )
        np.testing.assert_allclose(flux / event.flux, out.flux / event.flux, rtol=0, atol=1e-9)
        if event.mode not in ("s", "p"):
            powers = got.power_reflected if out.reflected else got.power_transmitted
            ours = sum(powers[i][which][case] for i in modes)
            np.testing.assert_allclose(ours, out.flux / event.flux, rtol=0, atol=1e-9)
    return len(event.outgoing)


@pytest.mark.parametrize("size", [200, pytest.param(2000, marks=pytest.mark.full)])
@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_agrees_with_prtlab(source: Kind, target: Kind, size: int) -> None:
    cases = random_cases(302, source, target, 2 * size)
    got = cases.run()
    kappa = np.linalg.norm(cases.tangential, axis=0)
    x = cases.tangential / kappa
    frames = np.array([x, np.cross(cases.normal, x, axis=0), cases.normal])
    reach = within_its_reach(cases, got)[:size]
    assert len(reach) == size
    compared = 0
    for case in reach.tolist():
        frame = frames[:, :, case]
        for event in events(cases.source, cases.target, case, frame, float(kappa[case])):
            compared += compare(cases, got, case, frame, event)
    assert compared > 3 * size
