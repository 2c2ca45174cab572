"""Array types of the optics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["BoolArray", "Complex", "Field", "Real", "dot"]

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
BoolArray = NDArray[np.bool_]
Field = NDArray[np.float64] | NDArray[np.complex128]
"""Real where every wave of a batch propagates, complex where one may be evanescent."""


def dot(a: Real, b: Real) -> Real:
    """Return a·b over the first axis, shapes (3, ...), as a plain sum.

    No BLAS: the bits of a matrix product depend on the length of the batch.
    """
    result: Real = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return result
