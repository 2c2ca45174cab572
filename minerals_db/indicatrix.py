"""What the principal indices say of the indicatrix: birefringence, optic sign, the angle between the optic axes.

Principal curves belong to directions of the crystal; α, β, γ are the names of their values after sorting, which may
change from one wavelength to another where curves cross.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from minerals_db.curve import FloatArray

if TYPE_CHECKING:
    from minerals_db.schema import Mineral

__all__ = [
    "SODIUM_D_NM",
    "angle_about_gamma_deg",
    "birefringence",
    "optic_sign",
    "principal_indices",
    "sorted_indices",
    "two_v_deg",
]

SODIUM_D_NM = 589.3
"""Mean of the sodium doublet, at which mineralogists quote indices, nm."""


def principal_indices(mineral: Mineral, wavelength_nm: npt.ArrayLike) -> Mapping[str, FloatArray]:
    """Return the principal indices by the name of their curve, each in the shape of the wavelengths (nm)."""
    return {axis: curve.index(wavelength_nm) for axis, curve in mineral.dispersion.items()}


def sorted_indices(mineral: Mineral, wavelength_nm: npt.ArrayLike) -> FloatArray:
    """Return the principal indices in rising order, shape (k, ...) for wavelengths (nm) of shape (...).

    k is 1 of an isotropic, 2 of a uniaxial and 3 of a biaxial crystal: n_α, n_β, n_γ.
    """
    return np.sort(np.stack(list(principal_indices(mineral, wavelength_nm).values())), axis=0)


def birefringence(mineral: Mineral, wavelength_nm: npt.ArrayLike) -> FloatArray:
    """Return the largest index less the smallest, in the shape of the wavelengths (nm); never negative."""
    n = sorted_indices(mineral, wavelength_nm)
    return np.asarray(n[-1] - n[0])


def angle_about_gamma_deg(indices: npt.ArrayLike) -> FloatArray:
    """Return 2V_γ, the angle between the optic axes in which Z lies, degrees, 0 to 180.

    tan² V_γ = (n_α⁻² − n_β⁻²)/(n_β⁻² − n_γ⁻²); Born & Wolf, Principles of Optics, 7th ed., §15.3.3, eq. (11).

    Parameters
    ----------
    indices : array_like, shape (3, ...)
        n_α ≤ n_β ≤ n_γ.

    Returns
    -------
    float64 array, shape (...)
        0 where n_α = n_β, 180 where n_β = n_γ; NaN where all are equal.
    """
    alpha, beta, gamma = np.asarray(indices, dtype=np.float64) ** -2
    two_v = np.asarray(2.0 * np.degrees(np.arctan2(np.sqrt(alpha - beta), np.sqrt(beta - gamma))))
    return np.where(alpha == gamma, np.nan, two_v)


def two_v_deg(mineral: Mineral, wavelength_nm: npt.ArrayLike) -> FloatArray:
    """Return the acute angle between the optic axes, degrees, in the shape of the wavelengths (nm).

    NaN unless the mineral is biaxial. `optic_sign` tells which bisectrix lies in it: Z of a positive crystal.
    """
    if mineral.optical_class != "biaxial":
        return np.full(np.shape(wavelength_nm), np.nan)
    about_gamma = angle_about_gamma_deg(sorted_indices(mineral, wavelength_nm))
    return np.minimum(about_gamma, 180.0 - about_gamma)


def optic_sign(mineral: Mineral, wavelength_nm: float) -> Literal["positive", "negative"] | None:
    """Return the optic sign that the indices give at one wavelength, nm; None where there is no birefringence.

    Uniaxial: positive where n_e > n_o. Biaxial: positive where Z is the acute bisectrix, 2V_γ < 90°.
    """
    if mineral.optical_class == "isotropic" or float(birefringence(mineral, wavelength_nm)) == 0.0:
        return None
    if mineral.optical_class == "uniaxial":
        n = principal_indices(mineral, wavelength_nm)
        return "positive" if n["e"] > n["o"] else "negative"
    return "positive" if angle_about_gamma_deg(sorted_indices(mineral, wavelength_nm)) < 90.0 else "negative"
