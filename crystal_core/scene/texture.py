"""Textures: pictures checked and decoded, and the average of a reflectance over a small square of the page."""

from __future__ import annotations

import io
import math
import warnings
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from crystal_core.errors import InputError
from crystal_core.spectra.colour import decode_srgb

__all__ = ["MAX_BYTES", "MAX_PIXELS", "Texture", "check_texture", "decode_texture", "read_asset"]

Real = NDArray[np.float64]
Texels = NDArray[np.float32]

MAX_BYTES = 8 * 1024 * 1024
MAX_PIXELS = 16_000_000
FORMATS = ("PNG", "JPEG")

LEVELS_PER_OCTAVE = 4
"""Filter widths are rounded to quarter octaves: at most 9 % off, and a flat page needs two or three of them."""


def check_texture(data: bytes, pointer: str) -> None:
    """Check that `data` is a picture that can serve as a texture, without decoding its pixels.

    Raises
    ------
    InputError
        At `pointer`: too many bytes or pixels, not PNG or JPEG, or broken.
    """
    _open(data, pointer)


def decode_texture(data: bytes, pointer: str) -> Texels:
    """Return the picture's linear sRGB reflectance, shape (H, W, 1) if it is grey, else (H, W, 3).

    Transparent parts show white paper. Raises `InputError` as `check_texture` does, and where the pixels are broken.
    """
    picture = _open(data, pointer)
    try:
        rgba = picture.convert("RGBA")
    except (OSError, SyntaxError, ValueError) as error:
        raise InputError.at(pointer, f"the picture is broken: {error}") from error
    white = Image.new("RGBA", rgba.size, (255, 255, 255, 255))
    rgb = np.asarray(Image.alpha_composite(white, rgba).convert("RGB"))
    if (rgb[..., 0] == rgb[..., 1]).all() and (rgb[..., 0] == rgb[..., 2]).all():
        rgb = rgb[..., :1]
    linear = decode_srgb(np.arange(256) / 255.0).astype(np.float32)
    return np.asarray(linear[rgb], np.float32)


def read_asset(assets: Path | None, name: str, pointer: str) -> bytes:
    """Return the bytes of an asset (``asset:<sha256>``) from the folder of assets.

    Raises
    ------
    InputError
        At `pointer`: there is no such asset.
    """
    digest = name.removeprefix("asset:")
    path = None if assets is None else assets / digest
    if path is None or not path.is_file():
        raise InputError.at(pointer, f"unknown asset {name!r}")
    return path.read_bytes()


def _open(data: bytes, pointer: str) -> Image.Image:
    if len(data) > MAX_BYTES:
        raise InputError.at(pointer, f"the picture has {len(data)} bytes; at most {MAX_BYTES} are taken")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # judged below, by our own limit
            picture = Image.open(io.BytesIO(data), formats=FORMATS)
    except UnidentifiedImageError as error:
        raise InputError.at(pointer, "not a PNG or JPEG picture") from error
    except (Image.DecompressionBombError, OSError, SyntaxError, ValueError) as error:
        raise InputError.at(pointer, f"the picture cannot be read: {error}") from error
    width, height = picture.size
    if width * height > MAX_PIXELS:
        raise InputError.at(pointer, f"the picture has {width} × {height} pixels; at most {MAX_PIXELS} are taken")
    return picture


class Texture:
    """A reflectance on a rectangle, interpolated bilinearly, averaged over squares on request.

    Parameters
    ----------
    texels : Texels
        Linear reflectance, shape (H, W, 1 or 3), row 0 at the top.
    width_mm : float
        Width of the rectangle, which is centred on the origin; the height follows from the texels' aspect.
    """

    def __init__(self, texels: Texels, width_mm: float) -> None:
        self.texels = texels
        self.width_mm = width_mm
        self.height_mm = width_mm * texels.shape[0] / texels.shape[1]
        self.texel_mm = width_mm / texels.shape[1]
        self._levels: dict[int, tuple[NDArray[np.float32], int]] = {}

    @property
    def channels(self) -> int:
        """1 for a grey texture, 3 for linear sRGB."""
        return int(self.texels.shape[2])

    @cached_property
    def mean(self) -> float:
        """Mean reflectance over the rectangle and its channels."""
        return float(self.texels.mean(dtype=np.float64))

    def average(self, x: Real, y: Real, width_mm: float) -> Real:
        """Return the mean reflectance over axis-parallel squares, shape (channels, N); points outside take the rim's.

        Parameters
        ----------
        x, y : Real
            Centres on the page, in mm, shape (N,).
        width_mm : float
            Side of the squares; rounded to a quarter octave of texels.
        """
        level = round(LEVELS_PER_OCTAVE * math.log2(max(width_mm / self.texel_mm, 1.0)))
        return self._sample(x, y, level)

    def _sample(self, x: Real, y: Real, level: int) -> Real:
        """Interpolate bilinearly in one prefiltered level."""
        if level not in self._levels:
            self._levels[level] = self._filtered(level)
        values, stride = self._levels[level]
        rows, columns = values.shape[1:]
        column = np.clip(((x + 0.5 * self.width_mm) / self.texel_mm - 0.5) / stride, 0.0, columns - 1.000001)
        row = np.clip(((0.5 * self.height_mm - y) / self.texel_mm - 0.5) / stride, 0.0, rows - 1.000001)
        i, j = row.astype(np.int64), column.astype(np.int64)
        fi, fj = row - i, column - j
        corner = i * columns + j
        result = np.empty((self.channels, x.size))
        for channel in range(self.channels):
            flat = values[channel].reshape(-1)
            upper = flat[corner]
            upper = upper + fj * (flat[corner + 1] - upper)
            lower = flat[corner + columns]
            lower = lower + fj * (flat[corner + columns + 1] - lower)
            result[channel] = upper + fi * (lower - upper)
        return result

    def _filtered(self, level: int) -> tuple[NDArray[np.float32], int]:
        """Return the texels averaged over squares of 2^(level/4) texels, (channels, H, W), and their spacing.

        Wide averages are kept at every stride-th texel. A texel counts as a square of even reflectance here (variance
        1/12) and the levels are interpolated by tents (stride²/6), where the texture itself is texels under tents of 1:
        the box (width²/12) is made so much narrower that the variance of the whole is right.
        """
        width = 2.0 ** (level / LEVELS_PER_OCTAVE)
        stride = max(1, int(width // 4))
        values = np.moveaxis(self.texels, -1, 0)
        if level > 0:
            box = math.sqrt(max(width**2 - 1.0 - 2.0 * (stride**2 - 1), 0.01))
            values = _box_average(_box_average(values, box, 1), box, 2)
        values = values[:, ::stride, ::stride]
        if min(values.shape[1:]) < 2:  # a texture of a few texels still needs two corners a side
            values = np.pad(values, ((0, 0), (0, 1), (0, 1)), mode="edge")
        return np.ascontiguousarray(values), stride


def _box_average(values: Texels, width: float, axis: int) -> Texels:
    """Average over `width` texels (any real number > 0) along an axis; the rim's texels go on outside."""
    length = values.shape[axis]
    reach = int(np.ceil(0.5 * width + 0.5))
    pad = [(0, 0)] * values.ndim
    pad[axis] = (reach, reach)
    sums = np.cumsum(np.pad(values, pad, mode="edge"), axis=axis, dtype=np.float64)
    sums = np.insert(sums, 0, 0.0, axis=axis)  # sums[i]: integral over the padded texels before edge i

    def integral(shift: float) -> NDArray[np.float64]:
        whole = int(np.floor(shift))
        part = shift - whole
        first = np.take(sums, np.arange(whole, whole + length), axis=axis)
        second = np.take(sums, np.arange(whole + 1, whole + 1 + length), axis=axis)
        return first + part * (second - first)

    centre = reach + 0.5
    return ((integral(centre + 0.5 * width) - integral(centre - 0.5 * width)) / width).astype(np.float32)
