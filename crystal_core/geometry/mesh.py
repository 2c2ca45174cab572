"""A closed body of triangles that need not be convex; triangles in one plane are one face."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import moved
from crystal_core.geometry.triangle_tree import TriangleTree

__all__ = ["Mesh"]

Real = NDArray[np.float64]

_BEHIND = 1e-9
"""A crossing this little behind a ray's start, in units of the body's size, is one that it stands on: two parts of a
body nearer to each other than this would be taken for one."""


@dataclass(frozen=True)
class Mesh:
    """What a closed, oriented surface of triangles encloses.

    Parameters
    ----------
    vertices : Real
        Corners, mm, shape (V, 3).
    corners : NDArray of int32
        Corner indices of the triangles, counter-clockwise from outside, shape (T, 3).
    owners : NDArray of int32
        The face each triangle belongs to, shape (T,).
    normals : Real
        Outward unit normals of the faces, shape (F, 3).
    offsets : Real
        Distance of each face's plane from the origin along its normal, mm, shape (F,).
    """

    vertices: Real
    corners: NDArray[np.int32]
    owners: NDArray[np.int32]
    normals: Real
    offsets: Real

    @property
    def face_count(self) -> int:
        """Return how many faces it has."""
        return len(self.normals)

    @property
    def triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Return the triangles, shape (T, 3), and the face of each, shape (T,)."""
        return self.corners, self.owners

    @cached_property
    def volume_mm3(self) -> float:
        """Return the volume, by the divergence theorem over the triangles."""
        a, b, c = (self.vertices[self.corners[:, i]] for i in range(3))
        return float(np.sum(a * np.cross(b, c)) / 6.0)

    @cached_property
    def areas_mm2(self) -> Real:
        """Return the area of each face, shape (F,)."""
        a, b, c = (self.vertices[self.corners[:, i]] for i in range(3))
        doubled = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        return np.asarray(0.5 * np.bincount(self.owners, doubled, minlength=self.face_count), np.float64)

    @cached_property
    def edges(self) -> dict[tuple[int, int], tuple[int, int]]:
        """Return the two faces at each edge between faces, by its corners in the order in which the first face runs."""
        owners = {
            (int(a), int(b)): int(owner)
            for triangle, owner in zip(self.corners, self.owners, strict=True)
            for a, b in zip(triangle, np.roll(triangle, -1), strict=True)
        }
        return {(i, j): (face, owners[j, i]) for (i, j), face in owners.items() if face < owners[j, i]}

    @cached_property
    def tree(self) -> TriangleTree:
        """Return the tree in which rays find triangles."""
        return TriangleTree(self.vertices[self.corners])

    def transformed(self, rotation: Real, shift_mm: Real) -> Mesh:
        """Return the body with every point x moved to rotation·x + shift, shapes (3, 3) and (3,)."""
        normals = self.normals @ rotation.T
        return Mesh(
            moved(self.vertices, rotation, shift_mm),
            self.corners,
            self.owners,
            normals,
            self.offsets + normals @ shift_mm,
        )

    def normal(self, face: NDArray[np.intp], point: Real) -> Real:  # noqa: ARG002  (curved bodies need the point)
        """Return outward unit normals, shape (3, N), of faces, shape (N,), at points on them, shape (3, N)."""
        return self.normals.T[:, face]

    def entry(self, point: Real, direction: Real) -> tuple[Real, NDArray[np.intp]]:
        """Return where rays that start outside or on the body enter it.

        Parameters
        ----------
        point, direction : Real
            Shape (3, N).

        Returns
        -------
        distance : Real
            In lengths of the direction, ≥ 0, shape (N,); inf where a ray does not.
        face : NDArray of int
            −1 where a ray does not, shape (N,).
        """
        return self._first(point, direction, leaving=False)

    def exit(self, point: Real, direction: Real) -> tuple[Real, NDArray[np.intp]]:
        """Return where rays that start inside or on the body leave it for the first time.

        Only faces that a ray can leave through are looked at, so the face it has just come in by is never its exit.

        Parameters
        ----------
        point, direction : Real
            Shape (3, N).

        Returns
        -------
        distance : Real
            In lengths of the direction, ≥ 0, shape (N,); inf for a ray that starts outside and never comes in.
        face : NDArray of int
            −1 for such a ray, shape (N,).
        """
        return self._first(point, direction, leaving=True)

    def _first(self, point: Real, direction: Real, *, leaving: bool) -> tuple[Real, NDArray[np.intp]]:
        least = -_BEHIND * self.tree.size
        distance, triangle = self.tree.nearest(point, direction, leaving=leaving, least=least)
        return np.maximum(distance, 0.0), np.where(triangle >= 0, self.owners[triangle], -1).astype(np.intp)
