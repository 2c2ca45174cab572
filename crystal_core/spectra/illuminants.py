"""The light: CIE standard illuminants."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from crystal_core.spectra.tables import read_table

__all__ = ["d65"]


def d65(wavelength_nm: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return the relative spectral power of D65, average daylight.

    Parameters
    ----------
    wavelength_nm : array_like, shape (...)
        Wavelengths, nm.

    Returns
    -------
    float64 array, shape (...)
        Power per wavelength, 100 at 560 nm; straight lines between the rows of the 5 nm table, as the CIE prescribes;
        0 outside 300 to 830 nm.

    References
    ----------
    CIE 015:2018, Colorimetry, 4th ed., doi:10.25039/TR.015.2018.
    """
    power: npt.NDArray[np.float64] = read_table("cie_d65.csv").interpolate(wavelength_nm, zero_outside=True)[0]
    return power
