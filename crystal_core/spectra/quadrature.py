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
        Linear sRGB of a spectrum that is 1 (relative to D65) at wavelength k and 0 at the others, shape (K, 3). They
        sum to (1, 1, 1): a spectrally flat radiance gives its own grey, whatever K is.
    """

    wavelength_nm: Real
    weights: Real


def stratified_wavelengths(count: int, offset: float) -> WavelengthSet:
    """Return the wavelengths at the quantiles (k + offset)/count of D65·(x̄ + ȳ + z̄), and their weights.

    Drawing by that density makes the weights nearly equal in size. What the few wavelengths miss of the integral of
    a flat spectrum is shared out equally among them (a control variate); it vanishes as `count` grows or as sets of
    many offsets are averaged.

    Parameters
    ----------
    count : int
        K ≥ 1.
    offset : float
        In [0, 1); sets with offsets i/M interleave to a set of K·M.
    """
    cumulative, density = _density()
    quantiles = (np.arange(count) + offset) / count
    wavelengths = np.interp(quantiles, cumulative, GRID_NM)
    power = d65(wavelengths) * colour_matching(wavelengths)
    white = d65(GRID_NM) * colour_matching(GRID_NM)
    white_y = np.trapezoid(white[1], GRID_NM)
    xyz = power / np.interp(wavelengths, GRID_NM, density) / (count * white_y)
    weights = xyz_to_linear_srgb(xyz.T)
    weights += (1.0 - weights.sum(axis=0)) / count
    return WavelengthSet(wavelengths, weights)


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
