"""Comparing what the project's optics says of a face with the independent answer."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np

from crystal_core.optics import Scattering, Wave
from tests.reference.arithmetic import Array
from tests.reference.berreman import Mode, Scattered
from tests.reference.cases import Cases, as_float
from tests.reference.media import Media

__all__ = [
    "assert_agrees",
    "assert_same_totals",
    "kept_energy",
    "matched",
    "on_outer_sheet",
    "total_field",
]


def matched(got: Scattering, truth: Scattered, cases: Cases, case: int) -> Scattered:
    """Return the truth with the modes of biaxial pairs in the order of the project's, by their wave vectors."""

    def order(media: Media, waves: Sequence[Wave], modes: Sequence[Mode]) -> tuple[int, int]:
        if media.kind != "biaxial":
            return (0, 1)
        ours = [wave.k[:, case] + 1j * wave.k_imag[:, case] for wave in waves]
        theirs = [as_float(mode.k) for mode in modes]
        straight, crossed = (
            sum(float(np.linalg.norm(ours[i] - theirs[places[i]])) for i in range(2)) for places in ((0, 1), (1, 0))
        )
        return (0, 1) if straight <= crossed else (1, 0)

    return truth.reordered(
        order(cases.source, got.incident, truth.incident),
        order(cases.source, got.reflected, truth.backward),
        order(cases.target, got.transmitted, truth.forward),
    )


def on_outer_sheet(mode: Mode, eps: Array) -> bool:
    """Whether a propagating wave is the slower of the two that its own wave normal has.

    Across a unit vector s the two waves have D along the axes of the section of eps^-1, and n^-2 as their lengths.
    """
    k = as_float(mode.k).real
    n = float(np.linalg.norm(k))
    s = k / n
    x = np.cross(s, np.eye(3)[int(np.argmin(np.abs(s)))])
    basis = np.array([x, np.cross(s, x)]) / np.linalg.norm(x)
    fast, slow = np.linalg.eigvalsh(basis @ np.linalg.inv(eps) @ basis.T)[::-1] ** -0.5
    return bool(abs(n - slow) < abs(n - fast))


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
        assert np.isnan(wave.ray[:, case]).all()
        assert np.isnan(wave.index[case])


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
    """Compare all waves, powers and fields of a face; modes that cannot come in have NaN."""
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
            else:
                assert np.isnan(ours[i][j][case])
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


def total_field(waves: Sequence[Wave], amplitudes: Any, j: int, case: int) -> Array:
    """Return the sum of the fields of an outgoing pair at the face, (3,), for incident mode j."""
    return np.asarray(sum(amplitudes[i][j][case] * waves[i].field[:, case] for i in range(2)))


def assert_same_totals(got: Scattering, truth: Scattered, case: int, bound: float) -> None:
    """Compare what does not depend on the basis of a degenerate pair, neither of the outgoing ones nor the incident.

    The modes of a pair are orthogonal in the form g, and g of a wave with itself is twice its flux. With incident modes
    of unit flux another choice of a degenerate pair is therefore an orthogonal matrix, under which the sums over both
    modes of what goes out, sum_j E_j E_j^dagger of the total fields and the powers, stay. (|D| = 1 would serve a
    uniaxial axis only: at a biaxial one the two waves have different rays, and their D are not at right angles.) Only
    if both modes come in are there such sums.
    """
    live = [mode.propagating for mode in truth.incident]
    assert [bool(wave.propagating[case]) for wave in got.incident] == live
    if not all(live):
        return
    sides: tuple[tuple[Sequence[Wave], Any, Any, Sequence[Mode], Array, Array], ...] = (
        (
            got.reflected,
            got.amplitude_reflected,
            got.power_reflected,
            truth.backward,
            truth.reflected,
            truth.power_reflected,
        ),
        (
            got.transmitted,
            got.amplitude_transmitted,
            got.power_transmitted,
            truth.forward,
            truth.transmitted,
            truth.power_transmitted,
        ),
    )
    for waves, amplitudes, powers, modes, true_amplitudes, true_powers in sides:
        ours, theirs = np.zeros((3, 3), complex), np.zeros((3, 3), complex)
        our_flux = their_flux = 0.0
        for j in range(2):
            weight = 1 / got.incident[j].flux[case]
            field = total_field(waves, amplitudes, j, case)
            ours += weight * np.outer(field, field.conj())
            our_flux += sum(powers[i][j][case] for i in range(2))
            weight = 1 / float(truth.incident[j].flux)
            field = as_float(sum(true_amplitudes[i, j] * modes[i].e for i in range(2)))
            theirs += weight * np.outer(field, field.conj())
            their_flux += float(true_powers[:, j].sum())
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=bound)
        np.testing.assert_allclose(our_flux, their_flux, rtol=0, atol=bound)
