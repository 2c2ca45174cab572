"""From tristimulus values to the pixels of a file: XYZ, linear sRGB, sRGB.

**White.** The primaries and the transfer curve are those of IEC 61966-2-1. Its printed four-digit matrix is not used:
its white is D65 rounded to four digits. Here white is D65 as tabulated by the CIE, seen by the CIE 1931 observer, both
summed over 360 to 830 nm by 1 nm, and the matrix is the one that takes this white to (1, 1, 1) and keeps the
primaries' chromaticities, to all digits. It differs from the printed one by less than 4e-4 in any element.
``tools/tabulate_spectra.py`` prints the constants; a test computes them again.

**Gamut.** There is one rule: each channel of linear sRGB is clipped to 0 … 1 (:func:`to_srgb8`). How many pixels it
changed is counted, and belongs into the manifest.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = [
    "D65_WHITE_XYZ",
    "GAMUT_TOLERANCE",
    "LINEAR_SRGB_TO_XYZ",
    "XYZ_TO_LINEAR_SRGB",
    "decode_srgb",
    "encode_srgb",
    "linear_srgb_to_xyz",
    "to_srgb8",
    "xyz_to_linear_srgb",
]

FloatArray = npt.NDArray[np.float64]
Matrix = tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]

D65_WHITE_XYZ: tuple[float, float, float] = (0.9504707022404212, 1.0, 1.0888284599768294)
LINEAR_SRGB_TO_XYZ: Matrix = (
    (0.41245769432984675, 0.35757581137308925, 0.1804371965374851),
    (0.21267349863882723, 0.7151516227461785, 0.07217487861499404),
    (0.019333954421711548, 0.11919193712436306, 0.950302568430755),
)
XYZ_TO_LINEAR_SRGB: Matrix = (
    (3.2404443003798242, -1.5371338347955574, -0.49852989236612677),
    (-0.9692667522745354, 1.8760122424286196, 0.04155604847526977),
    (0.05564351938090817, -0.20402623772999642, 1.0572268682372543),
)

GAMUT_TOLERANCE = 0.5 / 255.0 / 12.92
"""How far (in linear sRGB) a channel may leave 0 … 1 before its pixel counts as clipped: half a step of an 8-bit file
where its steps are smallest, so that rounding errors of white or black are not counted."""

_LINEAR_END = 0.0031308
"""IEC 61966-2-1: below it the transfer curve is a straight line."""
_ENCODED_END = 0.04045
"""The same place on the encoded side."""


def _apply(matrix: Matrix, colour: npt.ArrayLike) -> FloatArray:
    """Return ``matrix @ colour`` along the last axis; elementwise, as the bits of BLAS depend on the batch."""
    values = np.asarray(colour, dtype=np.float64)
    if values.ndim == 0 or values.shape[-1] != 3:
        raise ValueError(f"colours have three components on the last axis, not shape {values.shape}")
    first, second, third = values[..., 0], values[..., 1], values[..., 2]
    return np.stack([row[0] * first + row[1] * second + row[2] * third for row in matrix], axis=-1)


def xyz_to_linear_srgb(xyz: npt.ArrayLike) -> FloatArray:
    """Return linear sRGB.

    Parameters
    ----------
    xyz : array_like, shape (..., 3)
        Tristimulus values of the CIE 1931 observer, Y = 1 for white.

    Returns
    -------
    float64 array, shape (..., 3)
        White is (1, 1, 1); not clipped.

    Raises
    ------
    ValueError
        Where the last axis is not three long.

    References
    ----------
    IEC 61966-2-1:1999 with the white of the module's docstring.
    """
    return _apply(XYZ_TO_LINEAR_SRGB, xyz)


def linear_srgb_to_xyz(linear: npt.ArrayLike) -> FloatArray:
    """Return tristimulus values, Y = 1 for white; the inverse of :func:`xyz_to_linear_srgb`.

    Parameters
    ----------
    linear : array_like, shape (..., 3)
        Linear sRGB.

    Returns
    -------
    float64 array, shape (..., 3)

    Raises
    ------
    ValueError
        Where the last axis is not three long.
    """
    return _apply(LINEAR_SRGB_TO_XYZ, linear)


def encode_srgb(linear: npt.ArrayLike) -> FloatArray:
    """Return sRGB values as stored in files, 0 to 1, from linear ones.

    Parameters
    ----------
    linear : array_like, shape (...)
        Linear channel values. 0 to 1 become 0 to 1; the curve goes on outside, it does not clip.

    Returns
    -------
    float64 array, shape (...)

    References
    ----------
    IEC 61966-2-1:1999.
    """
    values = np.asarray(linear, dtype=np.float64)
    curved = 1.055 * np.power(np.maximum(values, _LINEAR_END), 1.0 / 2.4) - 0.055
    return np.where(values <= _LINEAR_END, 12.92 * values, curved)


def decode_srgb(encoded: npt.ArrayLike) -> FloatArray:
    """Return linear channel values from sRGB values as stored in files; the inverse of :func:`encode_srgb`.

    Parameters
    ----------
    encoded : array_like, shape (...)
        0 to 1.

    Returns
    -------
    float64 array, shape (...)

    References
    ----------
    IEC 61966-2-1:1999. The two ends of its curve miss each other by 1e-8, so there and back is exact to that.
    """
    values = np.asarray(encoded, dtype=np.float64)
    curved = np.power((np.maximum(values, _ENCODED_END) + 0.055) / 1.055, 2.4)
    return np.where(values <= _ENCODED_END, values / 12.92, curved)


def to_srgb8(linear: npt.ArrayLike) -> tuple[npt.NDArray[np.uint8], float]:
    """Return the pixels of an 8-bit file: clip to the gamut, encode, round.

    Parameters
    ----------
    linear : array_like, shape (..., 3)
        Linear sRGB.

    Returns
    -------
    pixels : uint8 array, shape (..., 3)
        sRGB.
    clipped_fraction : float
        Share of the pixels, 0 to 1, that were outside 0 … 1 in any channel by more than ``GAMUT_TOLERANCE``.

    Raises
    ------
    ValueError
        Where the last axis is not three long, or a value is NaN or infinite: no clipping may hide that.
    """
    values = np.asarray(linear, dtype=np.float64)
    if values.ndim == 0 or values.shape[-1] != 3:
        raise ValueError(f"pixels have three channels on the last axis, not shape {values.shape}")
    if not bool(np.all(np.isfinite(values))):
        raise ValueError("a picture with NaN or infinite values cannot be shown")
    outside = np.any((values < -GAMUT_TOLERANCE) | (values > 1.0 + GAMUT_TOLERANCE), axis=-1)
    clipped_fraction = float(np.count_nonzero(outside)) / max(outside.size, 1)
    encoded = encode_srgb(np.clip(values, 0.0, 1.0))
    return np.floor(encoded * 255.0 + 0.5).astype(np.uint8), clipped_fraction
