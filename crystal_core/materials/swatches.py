"""The colours of a mineral in light that vibrates along its principal directions: what a dichroscope shows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crystal_core.errors import InputError
from crystal_core.materials.constants import absorption_coefficients
from crystal_core.optics.arrays import Real
from crystal_core.spectra.colour import D65_WHITE_XYZ, encode_srgb, xyz_to_linear_srgb
from crystal_core.spectra.illuminants import d65
from crystal_core.spectra.observer import colour_matching
from minerals_db import Mineral

__all__ = ["hexadecimal", "swatches"]

_WAVELENGTHS_NM = np.linspace(380.0, 780.0, 401)


def swatches(
    mineral: Mineral, thickness_mm: float = 1.0, concentrations: Mapping[str, float] | None = None
) -> Mapping[str, Real]:
    """Return the transmitted colours of a mineral per principal direction of its absorption.

    White light (D65) that vibrates along one direction all the way, in a plate whose faces reflect nothing; CIE 1931 2°
    observer, white = 1.

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    thickness_mm : float
        Way through the crystal, mm.
    concentrations : Mapping of str to float, optional
        Weight percent of chromophores, by key.

    Returns
    -------
    Mapping of str to float64 array, shape (3,)
        By the names of the curves of `mineral.dispersion`: sRGB as stored in files, 0 to 1; linear channels outside are
        clipped before they are encoded. White for a mineral without absorption data.

    Raises
    ------
    InputError
        A thickness that is not finite and positive; whatever `absorption_coefficients` does not take.
    """
    if not (np.isfinite(thickness_mm) and thickness_mm > 0.0):
        raise InputError.at("/thickness_mm", "the thickness must be finite and above zero")
    absorbed = absorption_coefficients(mineral, _WAVELENGTHS_NM, concentrations)
    if absorbed is None:
        return {axis: np.ones(3) for axis in mineral.dispersion}
    weights = d65(_WAVELENGTHS_NM) * colour_matching(_WAVELENGTHS_NM)
    white = weights.sum(axis=1)
    colours = {}
    for axis, coefficient in zip(mineral.dispersion, absorbed, strict=True):
        xyz = (weights * np.exp(-thickness_mm * coefficient)).sum(axis=1) / white * np.array(D65_WHITE_XYZ)
        colours[axis] = encode_srgb(np.clip(xyz_to_linear_srgb(xyz), 0.0, 1.0))
    return colours


def hexadecimal(srgb: Real) -> str:
    """Return a colour as pages write it, #rrggbb, from sRGB of 0 to 1, shape (3,)."""
    red, green, blue = (round(255.0 * float(channel)) for channel in srgb)
    return f"#{red:02x}{green:02x}{blue:02x}"
