"""Vectors and frames as people write them down: tuples of numbers, right to a few digits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import Field
from pydantic_core import PydanticCustomError

__all__ = ["UNIT_TOLERANCE", "Matrix", "Number", "Vector", "is_right_handed", "matrix_of", "orthonormal", "wrong"]

UNIT_TOLERANCE = 1e-6
"""How far written axes may stand from orthonormal (each |axis|² and each cosine), and |normal| from 1: decimals of
seven digits pass. The nearest orthonormal frame is taken; a frame that is good to 1e-12 is taken as it stands."""

_AS_IT_STANDS = 1e-12

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
"""A finite number; no text, no truth value."""
Vector = tuple[Number, Number, Number]
Matrix = tuple[Vector, Vector, Vector]


def wrong(message: str) -> PydanticCustomError:
    """Return the error that a validator raises; `message` says what would be right."""
    return PydanticCustomError("description", "{message}", {"message": message})


def orthonormal(frame: Matrix, what: str) -> Matrix:
    """Return the nearest orthonormal frame of the same handedness."""
    a, b, c = frame
    gram = (_dot(a, a) - 1, _dot(b, b) - 1, _dot(c, c) - 1, _dot(a, b), _dot(b, c), _dot(c, a))
    error = max(map(abs, gram))
    if not error <= UNIT_TOLERANCE:
        raise wrong(f"{what} must be orthonormal: unit vectors at right angles, to {UNIT_TOLERANCE:g}")
    if error <= _AS_IT_STANDS:
        return frame
    matrix = np.array(frame)
    for _ in range(2):  # Newton's iteration for the orthogonal polar factor (Higham, Functions of Matrices, 2008, §8.3)
        matrix = 1.5 * matrix - 0.5 * matrix @ matrix.T @ matrix
    rows: list[list[float]] = matrix.tolist()
    return matrix_of(rows)


def matrix_of(rows: Sequence[Sequence[float]]) -> Matrix:
    """Return three rows of three numbers as tuples."""
    a, b, c = ((row[0], row[1], row[2]) for row in rows)
    return a, b, c


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def is_right_handed(frame: Matrix) -> bool:
    """Tell whether the third row is on the side of the cross product of the first two."""
    a, b, c = frame
    cross = (b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0])
    return _dot(a, cross) > 0
