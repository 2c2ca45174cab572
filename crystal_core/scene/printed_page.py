"""The default texture: rows of digits between fine lines, drawn at any resolution."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

__all__ = ["PAPER", "printed_digits"]

PAPER = 0.9
"""Reflectance of unprinted paper."""

INK = 0.04
"""Reflectance of printer's ink."""

SIDE_PX = 2048
ROWS = 10
"""Rows of digits on the page, as many digits in each: 6.4 mm apart on a page of 64 mm."""

LINE_WIDTH_ROWS = 0.02
"""Width of the fine lines, in rows: about 0.13 mm on a page of 64 mm."""

DIGIT_HEIGHT_ROWS = 0.82

SUPERSAMPLING = 3
"""Drawn so many times larger and reduced: Pillow's own edges have too few grey levels."""


@lru_cache(maxsize=1)
def printed_digits() -> NDArray[np.float32]:
    """Return the reflectance of the page, the same at all wavelengths, shape (2048, 2048, 1).

    The digits are those of π, in the typeface that Pillow carries (Aileron, CC0).
    """
    side = SIDE_PX * SUPERSAMPLING
    row = side / ROWS
    picture = Image.new("L", (side, side), 255)
    draw = ImageDraw.Draw(picture)
    font = ImageFont.load_default(size=row * DIGIT_HEIGHT_ROWS)
    half_line = max(1, round(0.5 * LINE_WIDTH_ROWS * row))
    for i in range(ROWS + 1):
        at = round(i * row)
        draw.rectangle((0, at - half_line, side, at + half_line), fill=0)
    for i in range(ROWS):
        for j in range(ROWS):
            digit = DIGITS[i * ROWS + j]
            draw.text(((j + 0.5) * row, (i + 0.5) * row), digit, fill=0, font=font, anchor="mm")
    coverage = np.asarray(picture.reduce(SUPERSAMPLING), np.float32) / 255.0
    return (INK + (PAPER - INK) * coverage)[:, :, None]


DIGITS = "3141592653589793238462643383279502884197169399375105820974944592307816406286208998628034825342117067"
