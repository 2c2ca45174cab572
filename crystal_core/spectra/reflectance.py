"""Spectra for RGB: a reflectance that looks like a given colour under D65."""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

from crystal_core.spectra.tables import SpectralTable, read_table

__all__ = ["basis"]


@cache
def _partition() -> SpectralTable:
    """Return the basis, divided by its own sum.

    The published digits add to 1 within 1e-5; after the division white paper reflects everything and nothing reflects
    more than it gets.
    """
    table = read_table("mallett_yuksel_2019.csv")
    return SpectralTable(table.wavelength_nm, table.columns / (table.columns[0] + table.columns[1] + table.columns[2]))


def basis(wavelength_nm: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return the reflectances r, g, b of the primaries of linear sRGB.

    The colour (R, G, B) of linear sRGB, each within 0 to 1, stands for the reflectance ρ(λ) = R r + G g + B b, which is
    within 0 to 1, and under D65 to the CIE 1931 observer has that colour again.

    Parameters
    ----------
    wavelength_nm : array_like, shape (...)
        Wavelengths, nm.

    Returns
    -------
    float64 array, shape (3, ...)
        Each within 0 to 1, their sum 1; straight lines between the rows of a 1 nm table, which the paper's 5 nm rows
        gave by Sprague's interpolation; outside 380 to 780 nm its end values.

    References
    ----------
    I. Mallett, C. Yuksel, Spectral primary decomposition for rendering with sRGB reflectance, EGSR (2019),
    doi:10.2312/SR.20191216.
    """
    return _partition().interpolate(wavelength_nm, zero_outside=False)
