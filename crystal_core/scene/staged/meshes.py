"""Meshes beside other bodies: whether they meet, by their edges and triangles.

Bodies meet where an edge of one passes through a face of the other, or where one lies inside the other. How deep they
overlap is not told, nor whether they only touch.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.cabochon import Cabochon
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.sphere import Sphere
from crystal_core.scene.staged.flat import Plane

__all__ = ["cuts_plane", "holds", "meets"]

Real = NDArray[np.float64]

_ASIDE = np.array((0.3719, 0.2417, 0.8963))
"""A direction along no axis and no plane that people choose: lines along edges are few."""


def holds(mesh: Mesh, points: Real) -> NDArray[np.bool_]:
    """Tell which points, shape (n, 3), lie inside a mesh: a line from there leaves it once more than it enters."""
    ahead = np.broadcast_to(_ASIDE[:, None], (3, len(points)))
    found = mesh.tree.crossings(np.ascontiguousarray(points.T), np.ascontiguousarray(ahead), least=0.0)
    forward = found.distance > 0.0
    turns = np.where(found.leaves[forward], 1, -1)
    return np.bincount(found.ray[forward], turns, minlength=len(points)) > 0


def meets(mesh: Mesh, other: ConvexPolyhedron | Sphere | Cabochon | Mesh) -> bool:
    """Tell whether the surfaces of a mesh and another body cross; a curved body by the triangles that stand for it."""
    low = np.maximum(mesh.vertices.min(axis=0), other.vertices.min(axis=0))
    high = np.minimum(mesh.vertices.max(axis=0), other.vertices.max(axis=0))
    if isinstance(other, Mesh):
        return _pierced(mesh, *_edges(other, low, high)) or _pierced(other, *_edges(mesh, low, high))
    start, along = _edges(mesh, low, high)
    enters, leaves, *_ = other.span(start, along)
    inside = (np.maximum(enters, 0.0) < np.minimum(leaves, 1.0)) & ((enters > 0.0) | (leaves < 1.0))
    return bool(inside.any()) or _pierced(mesh, *_edges(other, low, high))


def cuts_plane(mesh: Mesh, plane: Plane) -> bool:
    """Tell whether a mesh passes through a plane's outline."""
    height = (mesh.vertices - plane.centre) @ plane.normal
    first, second = (np.concatenate([mesh.corners[:, (i + k) % 3] for i in range(3)]) for k in (0, 1))
    crossing = (height[first] < 0.0) != (height[second] < 0.0)
    a, b = mesh.vertices[first[crossing]], mesh.vertices[second[crossing]]
    if not len(a):
        return False
    part = height[first[crossing]] / (height[first[crossing]] - height[second[crossing]])
    points = a + part[:, None] * (b - a)
    normals, offsets = plane.sides
    if bool(np.all(points @ normals.T <= offsets, axis=1).any()):
        return True
    ring = plane.corners
    return _pierced(mesh, ring.T, (np.roll(ring, -1, axis=0) - ring).T) or bool(holds(mesh, plane.centre[None])[0])


def _edges(body: ConvexPolyhedron | Sphere | Cabochon | Mesh, low: Real, high: Real) -> tuple[Real, Real]:
    """Return starts and lengths, (3, n) each, of the triangles' edges that come near a box."""
    triangles = body.triangles[0]
    ends = np.concatenate([triangles[:, (0, 1)], triangles[:, (1, 2)], triangles[:, (2, 0)]])
    ends = ends[ends[:, 0] < ends[:, 1]]
    start, end = body.vertices[ends[:, 0]], body.vertices[ends[:, 1]]
    near = np.all((np.minimum(start, end) <= high) & (np.maximum(start, end) >= low), axis=1)
    return np.ascontiguousarray(start[near].T), np.ascontiguousarray((end - start)[near].T)


def _pierced(mesh: Mesh, start: Real, along: Real) -> bool:
    """Tell whether one of some edges passes through a triangle."""
    if not start.shape[1]:
        return False
    found = mesh.tree.crossings(np.ascontiguousarray(start), np.ascontiguousarray(along), least=0.0, until=1.0)
    return bool(((found.distance >= 0.0) & (found.distance <= 1.0)).any())
