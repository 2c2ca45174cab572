"""Retardation of plates, and the degree of coherence that a band of wavelengths leaves behind it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from crystal_core.errors import InputError
from crystal_core.optics.arrays import BoolArray, Complex, Real
from crystal_core.optics.beams import TOGETHER, plate_beams
from crystal_core.optics.plates import Plate

__all__ = ["degree_of_coherence", "path_lengths_nm", "retardation_nm"]

SAME_DIRECTION = 1e-6
"""Angle, radians, up to which two plates' vibration directions count as the same."""


def retardation_nm(
    plates: Sequence[Plate], wavelength_nm: ArrayLike, tangential_k: ArrayLike | None = None
) -> Real | None:
    """Return the retardation Γ of a plate, or of plates that share their vibration directions, shape (N,).

    Γ = (q_slow − q_fast) d with the normal parts q of the two wave vectors (never index × length of a ray): the phase
    difference behind the plate is 2π Γ/λ. Of several plates Γ is the sum, in which plates whose slow direction is
    the fast one of the first count negative (crossed plates subtract), and what is left is given without a sign.

    Parameters
    ----------
    plates : sequence of Plate
        With indices at each wavelength. Absorption is disregarded. Plates without retardation (isotropic ones, sections
        across an optic axis) have no directions of their own and agree with all others.
    wavelength_nm : array_like
        Vacuum wavelengths, nm, shape () or (N,).
    tangential_k : array_like, optional
        Tangential wave vector in units of k0, shape (3,) or (3, N); normal incidence if left out.

    Returns
    -------
    Real or None
        nm, ≥ 0; NaN where one of a plate's waves is evanescent. None where plates do not share axes at any one of the
        wavelengths.

    Raises
    ------
    InputError
        A wavelength that is not finite and positive, a tangential wave vector that is not finite.
    """
    wavelength, kx, ky = _checked(wavelength_nm, tangential_k)
    total = np.zeros(wavelength.size)
    slow_direction: Complex | None = None
    fast_direction: Complex | None = None
    known = np.zeros(wavelength.size, np.bool_)
    for plate in plates:
        slow_path, fast_path, slow, fast = _modes(plate, wavelength, kx, ky)
        path = slow_path - fast_path
        retards = path > TOGETHER * plate.thickness_um * 1e3
        if slow_direction is None or fast_direction is None:
            slow_direction, fast_direction = slow.copy(), fast.copy()
        compared = known & retards
        parallel = _same(slow, slow_direction) & _same(fast, fast_direction)
        crossed = _same(slow, fast_direction) & _same(fast, slow_direction)
        if np.any(compared & ~parallel & ~crossed):
            return None
        total = total + np.where(compared & crossed, -path, path)
        fresh = ~known & retards
        slow_direction[fresh], fast_direction[fresh] = slow[fresh], fast[fresh]
        known |= retards
    return np.abs(total)


def path_lengths_nm(plates: Sequence[Plate], wavelength_nm: ArrayLike) -> tuple[Real, Real]:
    """Return what the fringes of a stack depend on at normal incidence, nm, shape (N,) each.

    Σ (q_slow − q_fast) d, the most that its retardation can be however its axes lie, and 2 Σ q_slow d, the longest
    optical path there and back.
    """
    wavelength, kx, ky = _checked(wavelength_nm, None)
    difference, there_and_back = np.zeros(wavelength.size), np.zeros(wavelength.size)
    for plate in plates:
        slow, fast = _modes(plate, wavelength, kx, ky)[:2]
        difference = difference + (slow - fast)
        there_and_back = there_and_back + 2.0 * slow
    return difference, there_and_back


def degree_of_coherence(retardation_nm: ArrayLike, band_nm: ArrayLike, wavelength_nm: ArrayLike) -> Real:
    """Return how much of the cross term of two fields is left in a band: sinc(Γ Δλ/λ²), sinc x = sin(π x)/(π x).

    The Fourier transform of a box of width Δλ about λ, to first order in Δλ/λ (Born & Wolf, Principles of Optics,
    7th ed., §7.5.8). It is negative where Γ Δλ/λ² is between 1 and 2, and so on: the fringes are there again, shifted
    by half a period.

    Parameters
    ----------
    retardation_nm : array_like
        Γ, or any path difference, nm.
    band_nm : array_like
        Width Δλ of the band, nm, ≥ 0.
    wavelength_nm : array_like
        Its middle λ, nm.

    Raises
    ------
    InputError
        A band that is negative or not finite, a wavelength that is not finite and positive.
    """
    band, wavelength = np.asarray(band_nm, np.float64), np.asarray(wavelength_nm, np.float64)
    if not np.all(np.isfinite(band) & (band >= 0)):
        raise InputError.at("/band_nm", "the width of a band must be finite and ≥ 0")
    if not np.all(np.isfinite(wavelength) & (wavelength > 0)):
        raise InputError.at("/wavelength_nm", "wavelengths must be finite and positive")
    return np.asarray(np.sinc(np.asarray(retardation_nm, np.float64) * band / (wavelength * wavelength)))


def _modes(plate: Plate, wavelength: Real, kx: Real, ky: Real) -> tuple[Real, Real, Complex, Complex]:
    """Return q d, nm, (N,), of the slow and of the fast wave, then their tangential fields E, (N, 2)."""
    beams = plate_beams(plate.medium.transparent(), wavelength, kx, ky, np.zeros(wavelength.size)).forward
    path = np.where(beams.carries, beams.q.real, np.nan) * plate.thickness_um * 1e3
    slow = np.where(path[:, 0] >= path[:, 1], 0, 1)[:, None]
    paths = [np.take_along_axis(path, which, axis=1)[:, 0] for which in (slow, 1 - slow)]
    fields = [np.take_along_axis(beams.psi[:, :2], which[:, None], axis=2)[:, :, 0] for which in (slow, 1 - slow)]
    return paths[0], paths[1], fields[0], fields[1]


def _same(a: Complex, b: Complex) -> BoolArray:
    """Return whether complex directions agree up to a factor: sin² of the angle between them is |a ∧ b|²/|a|²|b|²."""
    wedge = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    size = np.sqrt((np.abs(a) ** 2).sum(axis=1) * (np.abs(b) ** 2).sum(axis=1))
    return np.asarray(wedge <= SAME_DIRECTION * size)


def _checked(wavelength_nm: ArrayLike, tangential_k: ArrayLike | None) -> tuple[Real, Real, Real]:
    wavelength = np.atleast_1d(np.asarray(wavelength_nm, np.float64))
    if wavelength.ndim != 1 or not np.all(np.isfinite(wavelength) & (wavelength > 0)):
        raise InputError.at("/wavelength_nm", "wavelengths must be finite and positive, shape () or (N,)")
    kt = np.zeros(3) if tangential_k is None else np.asarray(tangential_k, np.float64)
    if kt.shape not in ((3,), (3, wavelength.size)) or not np.all(np.isfinite(kt)):
        raise InputError.at("/tangential_k", "the tangential wave vector must be finite, shape (3,) or (3, N)")
    wide = np.broadcast_to(kt if kt.ndim == 2 else kt[:, None], (3, wavelength.size))
    return wavelength, np.ascontiguousarray(wide[0]), np.ascontiguousarray(wide[1])
