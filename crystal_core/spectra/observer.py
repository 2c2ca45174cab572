"""The eye: the CIE 1931 standard observer, 2 degree field."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from crystal_core.spectra.tables import read_table

__all__ = ["LONGEST_NM", "SHORTEST_NM", "colour_matching"]

SHORTEST_NM = 360.0
"""Where the observer's table begins, nm."""
LONGEST_NM = 830.0
"""Where the observer's table ends, nm."""


def colour_matching(wavelength_nm: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return the colour matching functions x̄, ȳ, z̄.

    Parameters
    ----------
    wavelength_nm : array_like, shape (...)
        Wavelengths, nm.

    Returns
    -------
    float64 array, shape (3, ...)
        Without unit; straight lines between the rows of the 1 nm table, 0 outside 360 to 830 nm.

    References
    ----------
    CIE 015:2018, Colorimetry, 4th ed., doi:10.25039/TR.015.2018.
    """
    return read_table("cie_1931_2_degree.csv").interpolate(wavelength_nm, zero_outside=True)
