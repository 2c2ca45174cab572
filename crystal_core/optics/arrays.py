"""Array types of the optics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["BoolArray", "Complex", "Field", "Rays", "Real", "columns", "dot"]

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
BoolArray = NDArray[np.bool_]
Field = NDArray[np.float64] | NDArray[np.complex128]
"""Real where every wave of a batch propagates, complex where one may be evanescent."""

Rays = slice | NDArray[np.intp]
"""A selection of rays."""


def columns(vectors: Real, rays: Rays) -> Real:
    """Return the vectors, shape (3, N), of a selection of rays, component by component in memory.

    Plain indexing, vectors[:, rays], would lay the result out ray by ray: five times slower, and every later
    operation on one component strides.
    """
    if isinstance(rays, slice):
        return vectors[:, rays]
    return vectors.take(rays, axis=1)


def dot(a: Real, b: Real) -> Real:
    """Return a·b over the first axis, shapes (3, ...), as a plain sum.

    No BLAS: the bits of a matrix product depend on the length of the batch.
    """
    result: Real = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return result
