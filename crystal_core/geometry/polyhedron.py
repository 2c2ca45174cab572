"""A convex polyhedron as half-spaces with exact planes; vertices and triangles follow from them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog
from scipy.spatial import HalfspaceIntersection

from crystal_core.errors import InputError

__all__ = ["ConvexPolyhedron"]

Real = NDArray[np.float64]

COINCIDENT_MM = 1e-9
"""Two computed corners nearer than this are one: far above rounding of mm-sized bodies, far below any real edge."""

ALONG_PLANE = 1e-200
"""Stands for the speed, per unit of distance, of a ray parallel to a face."""


@dataclass(frozen=True)
class ConvexPolyhedron:
    """The points x with normals·x ≤ offsets.

    Parameters
    ----------
    normals : Real
        Outward unit normals, shape (F, 3).
    offsets : Real
        Distance of each face's plane from the origin along its normal, in mm, shape (F,).
    vertices : Real
        Corners, in mm, shape (V, 3).
    faces : tuple of tuple of int
        Corner indices of each face, counter-clockwise seen from outside, in the order of `normals`.
    """

    normals: Real
    offsets: Real
    vertices: Real
    faces: tuple[tuple[int, ...], ...]

    @classmethod
    def from_half_spaces(cls, normals: Real, offsets: Real) -> ConvexPolyhedron:
        """Return the body that the half-spaces bound.

        Parameters
        ----------
        normals : Real
            Outward unit normals, shape (F, 3).
        offsets : Real
            In mm, shape (F,).

        Raises
        ------
        InputError
            The half-spaces enclose no volume or an unbounded one, or one of them bounds nothing.
        """
        normals = np.asarray(normals, np.float64)
        offsets = np.asarray(offsets, np.float64)
        # The largest inscribed sphere: its centre is the interior point that HalfspaceIntersection needs.
        found = linprog(
            (0.0, 0.0, 0.0, -1.0),
            A_ub=np.column_stack((normals, np.ones(len(normals)))),
            b_ub=offsets,
            bounds=[(None, None)] * 3 + [(0, None)],
        )
        if found.status != 0 or found.x is None or found.x[3] <= COINCIDENT_MM:
            raise InputError.at("/shape", "the faces do not enclose a body")
        centre = found.x[:3]
        corners = HalfspaceIntersection(np.column_stack((normals, -offsets)), centre).intersections
        vertices = _distinct(corners)
        faces = []
        for normal, offset in zip(normals, offsets, strict=True):
            on_face = np.flatnonzero(np.abs(vertices @ normal - offset) < 10 * COINCIDENT_MM)
            if on_face.size < 3:
                raise InputError.at("/shape", f"the face with normal {normal.round(4).tolist()} bounds nothing")
            faces.append(_ring(vertices, on_face, normal))
        return cls(normals, offsets, vertices, tuple(faces))

    def transformed(self, rotation: Real, shift_mm: Real) -> ConvexPolyhedron:
        """Return the body with every point x moved to rotation·x + shift, shapes (3, 3) and (3,)."""
        normals = self.normals @ rotation.T
        return ConvexPolyhedron(
            normals, self.offsets + normals @ shift_mm, self.vertices @ rotation.T + shift_mm, self.faces
        )

    @cached_property
    def triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Return a fan of triangles, shape (T, 3), and the face each belongs to, shape (T,)."""
        corners = [(ring[0], ring[i], ring[i + 1]) for ring in self.faces for i in range(1, len(ring) - 1)]
        owners = [face for face, ring in enumerate(self.faces) for _ in range(1, len(ring) - 1)]
        return np.array(corners, np.int32), np.array(owners, np.int32)

    @cached_property
    def volume_mm3(self) -> float:
        """Return the volume, by the divergence theorem over the triangles."""
        a, b, c = (self.vertices[self.triangles[0][:, i]] for i in range(3))
        return float(np.sum(a * np.cross(b, c)) / 6.0)

    @cached_property
    def areas_mm2(self) -> Real:
        """Return the area of each face, shape (F,)."""
        corners, owners = self.triangles
        a, b, c = (self.vertices[corners[:, i]] for i in range(3))
        doubled = np.einsum("ti,ti->t", np.cross(b - a, c - a), self.normals[owners])
        return np.asarray(0.5 * np.bincount(owners, doubled, minlength=len(self.faces)), np.float64)

    @cached_property
    def edges(self) -> dict[tuple[int, int], tuple[int, int]]:
        """Return the two faces at each edge, by the edge's corners in the order in which the first face runs."""
        owners = {
            ends: face for face, ring in enumerate(self.faces) for ends in zip(ring, ring[1:] + ring[:1], strict=True)
        }
        return {(i, j): (face, owners[j, i]) for (i, j), face in owners.items() if face < owners[j, i]}

    @property
    def face_count(self) -> int:
        """Return how many faces it has."""
        return len(self.faces)

    def normal(self, face: NDArray[np.intp], point: Real) -> Real:  # noqa: ARG002  (curved bodies need the point)
        """Return outward unit normals, shape (3, N), of faces, shape (N,), at points on them, shape (3, N)."""
        return self.normals.T[:, face]

    @cached_property
    def parallel_face(self) -> NDArray[np.int32]:
        """Return for each face the index of the face parallel to it, −1 where there is none, shape (F,)."""
        opposite = self.normals @ self.normals.T < -1.0 + 1e-12
        return np.where(opposite.any(axis=1), opposite.argmax(axis=1), -1).astype(np.int32)

    def exit(self, point: Real, direction: Real) -> tuple[Real, NDArray[np.intp]]:
        """Return where rays that start inside or on the body leave it.

        No epsilon: of the faces whose outward normal the ray has a positive component along, the nearest plane is
        the exit. The face a ray starts from can therefore never be its exit.

        Parameters
        ----------
        point, direction : Real
            Shape (3, N).

        Returns
        -------
        distance : Real
            In units of the direction's length, ≥ 0, shape (N,).
        face : NDArray
            Index of the exit face, shape (N,).
        """
        nearest = np.full(point.shape[1], np.inf)
        face = np.zeros(point.shape[1], np.intp)
        for index, other in self._slabs:
            n = self.normals[index]
            speed = n[0] * direction[0] + n[1] * direction[1] + n[2] * direction[2]
            height = n[0] * point[0] + n[1] * point[1] + n[2] * point[2]
            # A ray along the plane never reaches it: any tiny speed sends the crossing far away.
            speed[speed == 0.0] = ALONG_PLANE
            ahead = speed > 0.0
            if other >= 0:  # of two parallel faces a ray can only meet the one it moves towards
                distance = np.where(ahead, self.offsets[index], -self.offsets[other])
                distance -= height
                distance /= speed
            else:
                distance = np.where(ahead, (self.offsets[index] - height) / speed, np.inf)
            nearer = distance < nearest
            np.copyto(nearest, distance, where=nearer)
            np.copyto(face, np.where(ahead, index, other), where=nearer)
        return np.maximum(nearest, 0.0), face

    @cached_property
    def _slabs(self) -> tuple[tuple[int, int], ...]:
        """Return each face with the one parallel to it, or −1; each pair once."""
        pairs = enumerate(int(other) for other in self.parallel_face)
        return tuple((index, other) for index, other in pairs if other < 0 or index < other)

    def span(self, point: Real, direction: Real) -> tuple[Real, Real, NDArray[np.intp], NDArray[np.intp]]:
        """Return where straight lines enter and leave the body.

        Parameters
        ----------
        point, direction : Real
            Shape (3, N).

        Returns
        -------
        enters, leaves : Real
            Distances in units of the direction's length, shape (N,); the line misses the body where enters ≥ leaves.
        entry_face, exit_face : NDArray
            Face indices, shape (N,).
        """
        enters, leaves = np.full(point.shape[1], -np.inf), np.full(point.shape[1], np.inf)
        entry, exit_ = np.zeros(point.shape[1], np.intp), np.zeros(point.shape[1], np.intp)
        for index, (n, offset) in enumerate(zip(self.normals, self.offsets, strict=True)):
            speed = n[0] * direction[0] + n[1] * direction[1] + n[2] * direction[2]
            gap = offset - (n[0] * point[0] + n[1] * point[1] + n[2] * point[2])
            # A line along a face: ±inf, or NaN on its plane.
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                distance = gap / speed
            later = (speed < 0.0) & (distance > enters)
            np.copyto(enters, distance, where=later)
            entry[later] = index
            sooner = (speed > 0.0) & (distance < leaves)
            np.copyto(leaves, distance, where=sooner)
            exit_[sooner] = index
            np.copyto(leaves, -np.inf, where=(speed == 0.0) & (gap < 0.0))
        return enters, leaves, entry, exit_


def _distinct(corners: Real) -> Real:
    """Merge corners that fall together (more than three planes through one point)."""
    kept: list[Real] = []
    for corner in corners[np.isfinite(corners).all(axis=1)]:
        if all(np.max(np.abs(corner - other)) > COINCIDENT_MM for other in kept):
            kept.append(corner)
    return np.array(kept)


def _ring(vertices: Real, members: NDArray[np.intp], normal: Real) -> tuple[int, ...]:
    """Return the members counter-clockwise about `normal`."""
    spokes = vertices[members] - vertices[members].mean(axis=0)
    x = spokes[0] / np.linalg.norm(spokes[0])
    y = np.cross(normal, x)
    order = np.argsort(np.arctan2(spokes @ y, spokes @ x))
    return tuple(int(i) for i in members[order])
