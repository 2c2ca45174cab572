"""Optical and morphological constants of a mineral's entry, evaluated."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.errors import NotSupportedError
from crystal_core.optics import Medium
from minerals_db import Mineral

__all__ = ["SODIUM_D_NM", "medium", "principal_indices"]

Real = NDArray[np.float64]

SODIUM_D_NM = 589.3
"""Mean of the sodium doublet, at which mineralogists quote indices."""


def principal_indices(mineral: Mineral, wavelength_nm: ArrayLike) -> tuple[Real, ...]:
    """Return (n,) of an isotropic or (n_o, n_e) of a uniaxial mineral at vacuum wavelengths, each of their shape.

    Raises
    ------
    NotSupportedError
        The mineral is biaxial.
    """
    wavelengths = np.asarray(wavelength_nm, np.float64)
    if mineral.optical_class == "isotropic":
        return (mineral.dispersion["n"].index(wavelengths),)
    if mineral.optical_class == "uniaxial":
        return mineral.dispersion["o"].index(wavelengths), mineral.dispersion["e"].index(wavelengths)
    raise NotSupportedError(f"{mineral.id} is biaxial: only isotropic and uniaxial crystals can be rendered yet")


def medium(mineral: Mineral, wavelength_nm: ArrayLike, axis: ArrayLike) -> Medium:
    """Return the mineral's medium at each ray's wavelength, shape (N,), with its optic axis along `axis`.

    Parameters
    ----------
    axis : array_like
        Unit vector, shape (3,); not looked at if the mineral is isotropic.
    """
    indices = principal_indices(mineral, wavelength_nm)
    return Medium.isotropic(indices[0]) if len(indices) == 1 else Medium.uniaxial(indices[0], indices[1], axis)
