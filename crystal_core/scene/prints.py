"""What is printed on a page: its picture, and black dots for measuring."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError
from crystal_core.scene.printed_page import printed_digits
from crystal_core.scene.texture import MAX_PIXELS, Texture, decode_texture

__all__ = ["decoded_print", "with_marks"]

TEXELS_PER_MARK = 8.0
"""Texels across a mark at least: its covered rim then keeps its centre to a hundredth of a texel."""


def decoded_print(data: bytes | None, pointer: str) -> NDArray[np.float32]:
    """Return the texels of a picture's bytes, or of the printed digits if there are none.

    Raises
    ------
    InputError
        At `pointer`: the bytes are no picture.
    """
    return printed_digits() if data is None else decode_texture(data, pointer)


def with_marks(
    texture: Texture, marks_mm: tuple[tuple[float, float], ...], diameter_mm: float, pointer: str
) -> Texture:
    """Return the texture with black discs; a texel on the rim is covered by the part of it that the disc covers.

    Raises
    ------
    InputError
        At ``{pointer}/marks_mm/i``: a mark beside the page; at ``{pointer}/mark_diameter_mm``: marks too small for it.
    """
    texels = _fine_enough(texture, diameter_mm / TEXELS_PER_MARK, f"{pointer}/mark_diameter_mm")
    texture = Texture(texels, texture.width_mm)
    rows, columns = texels.shape[:2]
    radius = 0.5 * diameter_mm / texture.texel_mm
    grid = (np.arange(16) + 0.5) / 16
    for number, (x, y) in enumerate(marks_mm):
        column = (x + 0.5 * texture.width_mm) / texture.texel_mm
        row = (0.5 * texture.height_mm - y) / texture.texel_mm
        if not (radius < column < columns - radius and radius < row < rows - radius):
            raise InputError.at(f"{pointer}/marks_mm/{number}", "the mark does not lie on the page")
        i0, i1 = int(row - radius), int(np.ceil(row + radius))
        j0, j1 = int(column - radius), int(np.ceil(column + radius))
        dy = (np.arange(i0, i1)[:, None] + grid - row).reshape(-1, 1)
        dx = (np.arange(j0, j1)[:, None] + grid - column).reshape(1, -1)
        inside = (dx * dx + dy * dy <= radius * radius).reshape(i1 - i0, 16, j1 - j0, 16)
        texels[i0:i1, j0:j1] *= (1.0 - inside.mean(axis=(1, 3)))[:, :, None].astype(np.float32)
    return texture


def _fine_enough(texture: Texture, texel_mm: float, pointer: str) -> NDArray[np.float32]:
    """Return a copy of the texels, or the same reflectance on finer ones if they are wider than `texel_mm`."""
    factor = int(np.ceil(texture.texel_mm / texel_mm))
    rows, columns = texture.texels.shape[0] * factor, texture.texels.shape[1] * factor
    if factor == 1:
        return texture.texels.copy()
    if rows * columns > MAX_PIXELS:
        raise InputError.at(pointer, "the marks are too small for a page of this width")
    x = ((np.arange(columns) + 0.5) / columns - 0.5) * texture.width_mm
    y = (0.5 - (np.arange(rows) + 0.5) / rows) * texture.height_mm
    values = texture.average(np.tile(x, rows), np.repeat(y, columns), 0.0)
    return np.ascontiguousarray(np.moveaxis(values.reshape(-1, rows, columns), 0, -1), np.float32)
