"""What every closed body can be asked, whether half-spaces, a quadric or a mesh bound it."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

__all__ = ["Body", "dot", "moved", "turned"]

Real = NDArray[np.float64]


class Body(Protocol):
    """A closed body of numbered faces, in mm."""

    @property
    def vertices(self) -> Real:
        """Return corners, shape (V, 3); of a curved body those of the triangles that stand for it."""
        ...

    @property
    def triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Return triangles, counter-clockwise from outside, shape (T, 3), and the face of each, shape (T,).

        Of a curved body: for drawing only, inscribed. Rays are never traced against them.
        """
        ...

    @property
    def volume_mm3(self) -> float:
        """Return the exact volume."""
        ...

    @property
    def edges(self) -> dict[tuple[int, int], tuple[int, int]]:
        """Return the two faces at each edge, by the edge's corners in the order in which the first face runs."""
        ...

    @property
    def face_count(self) -> int:
        """Return how many faces it has."""
        ...

    def transformed(self, rotation: Real, shift_mm: Real) -> Body:
        """Return the body with every point x moved to rotation·x + shift, shapes (3, 3) and (3,)."""
        ...

    def normal(self, face: NDArray[np.intp], point: Real) -> Real:
        """Return outward unit normals, shape (3, N), of faces, shape (N,), at points on them, shape (3, N)."""
        ...

    def exit(self, point: Real, direction: Real) -> tuple[Real, NDArray[np.intp]]:
        """Return distance (in lengths of the direction) and face where rays from inside or on the body leave it."""
        ...


def dot(a: Real, b: Real) -> Real:
    """Return scalar products of vectors, shape (3, N) or (3,); no BLAS, whose bits depend on the number of rays."""
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def turned(rotation: Real, vectors: Real) -> Real:
    """Return rotation·v for vectors of shape (3, N), without BLAS."""
    return np.stack([dot(row, vectors) for row in rotation])


def moved(points: Real, rotation: Real, shift_mm: Real) -> Real:
    """Return rotation·x + shift for points of shape (V, 3)."""
    return np.asarray(points @ rotation.T + shift_mm)
