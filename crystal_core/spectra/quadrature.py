"""Stratified wavelengths and the weights that turn radiances at them into linear sRGB under D65."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from crystal_core.spectra.colour import xyz_to_linear_srgb
from crystal_core.spectra.illuminants import d65
from crystal_core.spectra.observer import colour_matching

__all__ = ["WavelengthSet", "effective_wavelength_nm", "stratified_wavelengths"]

Real = NDArray[np.float64]

GRID_NM = np.arange(360.0, 830.5, 0.5)
"""Where the sampling density is tabulated: twice as fine as the tables of D65 and of the observer."""


@dataclass(frozen=True)
class WavelengthSet:
    """K wavelengths, one in each of K strata of equal weight for the eye.

    Parameters
    ----------
    wavelength_nm : Real
        Shape (K,), ascending.
    weights : Real
        Linear sRGB of a spectrum that is 1 (relative to D65) at wavelength k and 0 at the others, shape (K, 3).
    """

    wavelength_nm: Real
    weights: Real


def stratified_wavelengths(sets: int, count: int) -> tuple[WavelengthSet, ...]:
    """Return interleaved sets of wavelengths.

    Together they are the midpoints of sets·count strata, of which set i has every sets-th. The strata have equal
    shares of D65·(x̄ + ȳ + z̄), which makes the weights nearly equal in size. The weights of a set are those of its own
    quadrature; the average over all sets gives a spectrally flat radiance its own grey exactly: what the midpoints
    miss of it (less than 0.01 from 8 strata on) is shared out equally.

    Parameters
    ----------
    sets : int
        Number of sets, ≥ 1.
    count : int
        Number K of wavelengths of a set, ≥ 1.
    """
    cumulative, density = _density()
    total = sets * count
    wavelengths = np.interp((np.arange(total) + 0.5) / total, cumulative, GRID_NM)
    power = d65(wavelengths) * colour_matching(wavelengths)
    white = d65(GRID_NM) * colour_matching(GRID_NM)[1]
    xyz = power / np.interp(wavelengths, GRID_NM, density) / (count * np.trapezoid(white, GRID_NM))
    weights = xyz_to_linear_srgb(xyz.T)
    weights += (sets - weights.sum(axis=0)) / total
    return tuple(WavelengthSet(wavelengths[i::sets], weights[i::sets]) for i in range(sets))


def effective_wavelength_nm() -> float:
    """Return the mean wavelength of daylight as the eye weighs it, ∫ λ D65 ȳ dλ / ∫ D65 ȳ dλ (about 560 nm)."""
    luminance = d65(GRID_NM) * colour_matching(GRID_NM)[1]
    return float(np.sum(GRID_NM * luminance) / np.sum(luminance))


@lru_cache(maxsize=1)
def _density() -> tuple[Real, Real]:
    """Return the cumulative distribution, 0 … 1, and the density (per nm) of D65·(x̄ + ȳ + z̄) on the grid."""
    values = d65(GRID_NM) * colour_matching(GRID_NM).sum(axis=0)
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(GRID_NM)
    cumulative = np.concatenate(((0.0,), np.cumsum(steps)))
    return cumulative / cumulative[-1], values / cumulative[-1]
