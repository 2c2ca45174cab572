"""Where a surface passes through itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import dot
from crystal_core.geometry.surface import COINCIDENT, Surface, paired_edges
from crystal_core.geometry.triangle_tree import TriangleTree

__all__ = ["crossing_places"]

Real = NDArray[np.float64]


def crossing_places(surface: Surface) -> Real:
    """Return points where edges go through triangles of which they are no part, shape (P, 3).

    An edge counts when its ends lie on either side of the triangle by more than `COINCIDENT`: parts that touch are not
    found, nor such as overlap in one plane.
    """
    vertices, triangles = surface.vertices, surface.triangles
    ends, _ = paired_edges(triangles)
    start, stop = vertices[ends[:, 0]], vertices[ends[:, 1]]
    found = TriangleTree(vertices[triangles]).crossings(start.T, (stop - start).T, least=0.0, until=1.0)
    within = (found.distance > 0.0) & (found.distance < 1.0)
    edge, triangle, distance = found.ray[within], found.triangle[within], found.distance[within]
    apart = (triangles[triangle][:, :, None] != ends[edge][:, None, :]).all(axis=(1, 2))
    edge, triangle, distance = edge[apart], triangle[apart], distance[apart]
    a, b, c = (vertices[triangles[triangle, i]] for i in range(3))
    crossed = np.cross(b - a, c - a)
    normal = crossed / np.maximum(np.linalg.norm(crossed, axis=1), 1e-300)[:, None]
    before, after = dot(normal.T, (start[edge] - a).T), dot(normal.T, (stop[edge] - a).T)
    least = COINCIDENT * float(np.ptp(vertices, axis=0).max())
    through = (before * after < 0.0) & (np.minimum(np.abs(before), np.abs(after)) > least)
    edge, distance = edge[through], distance[through]
    return np.asarray(start[edge] + distance[:, None] * (stop[edge] - start[edge]))
