"""Light of hot bodies: Planck's radiator and CIE illuminant A."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = ["black_body", "illuminant_a"]

C2_NM_K = 1.438776877e7
"""Second radiation constant hc/k, nm·K: exact in the SI of 2019."""

A_C2_NM_K, A_TEMPERATURE_K = 1.435e7, 2848.0
"""With which the CIE defines illuminant A: 2848 K with the constant of 1931, 2856 K with that of today."""


def black_body(wavelength_nm: npt.ArrayLike, temperature_k: float) -> npt.NDArray[np.float64]:
    """Return the spectral power of a black body, relative to that at 560 nm.

    Parameters
    ----------
    wavelength_nm : array_like, shape (...)
        Wavelengths, nm.
    temperature_k : float
        Its temperature.

    Returns
    -------
    float64 array, shape (...)
        Planck's law per wavelength, 100 at 560 nm.
    """
    return _planck(wavelength_nm, C2_NM_K / temperature_k)


def illuminant_a(wavelength_nm: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return the relative spectral power of CIE standard illuminant A, an incandescent lamp, 100 at 560 nm.

    References
    ----------
    CIE 015:2018, Colorimetry, 4th ed., equation 4.1, doi:10.25039/TR.015.2018.
    """
    return _planck(wavelength_nm, A_C2_NM_K / A_TEMPERATURE_K)


def _planck(wavelength_nm: npt.ArrayLike, c2_over_t_nm: float) -> npt.NDArray[np.float64]:
    wavelengths = np.asarray(wavelength_nm, np.float64)
    at_560 = np.expm1(c2_over_t_nm / 560.0)
    return np.asarray(100.0 * (560.0 / wavelengths) ** 5 * at_560 / np.expm1(c2_over_t_nm / wavelengths), np.float64)
