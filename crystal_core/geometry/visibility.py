"""Which face of a body a ray from outside meets first.

Only that decision is taken here; callers recompute distance and point from the face's exact plane. Embree (float32)
decides where its wheel exists; the NumPy intersectors are its reference in the tests and its stand-in elsewhere. Curved
bodies are met where they are, not where triangles would stand for them.
"""

from __future__ import annotations

import importlib.util
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import Body
from crystal_core.geometry.cabochon import Cabochon
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.sphere import Sphere

__all__ = ["EmbreeFinder", "ExactFinder", "FaceFinder", "NumpyFinder", "TreeFinder", "face_finder"]

Real = NDArray[np.float64]


class FaceFinder(Protocol):
    """Finds the first face on a ray."""

    def first_face(self, origin: Real, direction: Real) -> NDArray[np.int32]:
        """Return the index of the first face hit, −1 for a miss, shape (N,); rays of shape (3, N)."""
        ...


def face_finder(body: Body) -> FaceFinder:
    """Return the finder of a curved body, or Embree's where its wheel is installed, else NumPy's."""
    if isinstance(body, Sphere | Cabochon):
        return ExactFinder(body)
    if importlib.util.find_spec("embreex") is not None:
        return EmbreeFinder(body)
    return TreeFinder(body) if isinstance(body, Mesh) else NumpyFinder(body)


class ExactFinder:
    """Where lines enter a curved body, in float64."""

    def __init__(self, body: Sphere | Cabochon) -> None:
        self._body = body

    def first_face(self, origin: Real, direction: Real) -> NDArray[np.int32]:
        """Return the index of the first face hit, −1 for a miss, shape (N,); rays of shape (3, N)."""
        enters, leaves, entry, exit_ = self._body.span(origin, direction)
        met = (enters < leaves) & (leaves > 0.0)
        return np.where(met, np.where(enters > 0.0, entry, exit_), -1).astype(np.int32)


class TreeFinder:
    """The tree of a mesh, in float64; rays from inside meet nothing before they have left it."""

    def __init__(self, body: Mesh) -> None:
        self._body = body

    def first_face(self, origin: Real, direction: Real) -> NDArray[np.int32]:
        """Return the index of the first face hit, −1 for a miss, shape (N,); rays of shape (3, N)."""
        return self._body.entry(origin, direction)[1].astype(np.int32)


class EmbreeFinder:
    """Embree's bounding volume hierarchy over the body's triangles."""

    def __init__(self, body: Body) -> None:
        from embreex import mesh_construction, rtcore_scene

        triangles, self._owners = body.triangles
        self._scene = rtcore_scene.EmbreeScene()
        mesh_construction.TriangleMesh(self._scene, body.vertices.astype(np.float32), triangles)

    def first_face(self, origin: Real, direction: Real) -> NDArray[np.int32]:
        """Return the index of the first face hit, −1 for a miss, shape (N,); rays of shape (3, N)."""
        hit = self._scene.run(
            np.ascontiguousarray(origin.T, np.float32),
            np.ascontiguousarray(direction.T, np.float32),
            query="INTERSECT",
        )
        return np.where(hit >= 0, self._owners[hit], -1).astype(np.int32)


class NumpyFinder:
    """Every ray against every triangle: T. Möller, B. Trumbore, J. Graphics Tools 2(1), 1997."""

    def __init__(self, body: Body) -> None:
        triangles, self._owners = body.triangles
        self._corners = body.vertices[triangles]

    def first_face(self, origin: Real, direction: Real) -> NDArray[np.int32]:
        """Return the index of the first face hit, −1 for a miss, shape (N,); rays of shape (3, N)."""
        o, d = origin.T, direction.T
        nearest = np.full(o.shape[0], np.inf)
        face = np.full(o.shape[0], -1, np.int32)
        for (a, b, c), owner in zip(self._corners, self._owners, strict=True):
            edge1, edge2 = b - a, c - a
            p = np.cross(d, edge2)
            determinant = np.sum(p * edge1, axis=1)
            with np.errstate(divide="ignore", invalid="ignore"):  # rays in the triangle's plane: no hit
                inverse = 1.0 / determinant
                s = o - a
                u = np.sum(s * p, axis=1) * inverse
                q = np.cross(s, edge1)
                v = np.sum(d * q, axis=1) * inverse
                distance = np.sum(edge2 * q, axis=1) * inverse
                hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (distance > 0) & (distance < nearest)
            nearest[hit] = distance[hit]
            face[hit] = owner
        return face
