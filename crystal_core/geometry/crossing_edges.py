"""Where a surface passes through itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import dot
from crystal_core.geometry.surface import COINCIDENT, Surface, paired_edges
from crystal_core.geometry.triangle_tree import TriangleTree

__all__ = ["crossing_place"]

Real = NDArray[np.float64]

_MOST_PAIRS = 5_000_000
"""Pairs of an edge and a triangle near it: a sensible mesh of 20,000 triangles has a tenth of them."""


def crossing_place(surface: Surface) -> Real | None:
    """Return a point where an edge goes through a triangle of which it is no part, shape (3,); None if there is none.

    An edge counts when its ends lie on either side of the triangle by more than `COINCIDENT`: parts that touch are not
    found, nor such as overlap in one plane.

    Raises
    ------
    OverflowError
        So many triangles lie over each other that they cannot all be looked at.
    """
    vertices, triangles = surface.vertices, surface.triangles
    least = COINCIDENT * float(np.ptp(vertices, axis=0).max())
    ends, _ = paired_edges(triangles)
    start, stop = vertices[ends[:, 0]], vertices[ends[:, 1]]
    tree = TriangleTree(vertices[triangles])
    for found in tree.in_parts(start.T, (stop - start).T, least=0.0, until=1.0, most=_MOST_PAIRS):
        edge, corners = found.ray, triangles[found.triangle]
        apart = (corners[:, :, None] != ends[edge][:, None, :]).all(axis=(1, 2))
        a, b, c = (vertices[corners[:, i]] for i in range(3))
        crossed = np.cross(b - a, c - a)
        normal = crossed / np.maximum(np.linalg.norm(crossed, axis=1), 1e-300)[:, None]
        before, after = dot(normal.T, (start[edge] - a).T), dot(normal.T, (stop[edge] - a).T)
        through = apart & (before * after < 0.0) & (np.minimum(np.abs(before), np.abs(after)) > least)
        if through.any():
            first = through.argmax()
            one, other = start[edge[first]], stop[edge[first]]
            return np.asarray(one + found.distance[first] * (other - one))
    return None
