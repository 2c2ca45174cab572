"""Corners of the convex body that half-spaces bound, from a point known to lie inside: by duality, a convex hull."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from crystal_core.geometry.polyhedron import ConvexPolyhedron

__all__ = ["bounded_body", "is_bounded"]

Real = NDArray[np.float64]

_ON_PLANE = 1e-9
"""Corners within this of a plane, in units of the body's size, lie on it: far above rounding, far below any edge."""


def is_bounded(normals: Real) -> bool:
    """Return whether planes with these outward normals, shape (F, 3), can close a body: one against every side."""
    hull = _hull(normals)
    return hull is not None and bool((hull[:, 3] < -_ON_PLANE).all())


def bounded_body(normals: Real, offsets: Real, inside: Real) -> tuple[ConvexPolyhedron, NDArray[np.intp]]:
    """Return the body that the half-spaces normals·x ≤ offsets bound, and which of them bound it.

    Parameters
    ----------
    normals : Real
        Outward unit normals, shape (F, 3), such that `is_bounded`.
    offsets : Real
        Shape (F,), in any unit of length.
    inside : Real
        A point strictly inside, shape (3,).

    Returns
    -------
    body : ConvexPolyhedron
        With the planes that bound it, as they were given.
    kept : NDArray of int
        Their numbers, rising; planes that touch the body in an edge or a corner alone are not among them.

    Raises
    ------
    ValueError
        The point does not lie inside, or the body is not bounded.
    """
    distances = offsets - normals @ inside
    # The corners of a body are the faces of its dual, the hull of the points n/d (H. S. M. Coxeter, Regular Polytopes).
    hull = _hull(normals / distances[:, None]) if (distances > 0.0).all() else None
    if hull is None or not (hull[:, 3] < 0.0).all():
        raise ValueError("the point does not lie inside a bounded body")
    corners = _distinct(-hull[:, :3] / hull[:, 3:])
    size = float(np.ptp(corners, axis=0).max())
    gaps = corners @ normals.T - distances
    on = np.abs(gaps) < _ON_PLANE * size
    corners = _refined(corners, normals, distances, on)
    kept = np.flatnonzero(on.sum(axis=0) >= 3)
    faces = tuple(_ring(corners, np.flatnonzero(on[:, face]), normals[face]) for face in kept)
    return ConvexPolyhedron(normals[kept], offsets[kept], corners + inside, faces), kept


def _hull(points: Real) -> Real | None:
    """Return the outward planes of the hull of points, rows n, −distance; None where the points lie in a plane."""
    if len(points) < 4:
        return None
    try:
        return np.asarray(ConvexHull(points).equations, np.float64)
    except QhullError:
        return None


def _distinct(corners: Real) -> Real:
    """Merge corners that fall together: more than three planes through a point make several triangles of the dual."""
    size = float(np.ptp(corners, axis=0).max())
    near = (np.abs(corners[:, None] - corners[None]) < _ON_PLANE * size).all(axis=2)
    return np.asarray(corners[near.argmax(axis=1) == np.arange(len(corners))])


def _refined(corners: Real, normals: Real, distances: Real, on: NDArray[np.bool_]) -> Real:
    """Return the corners moved onto all of their planes, as nearly as those agree: two steps of Newton's method."""
    weights = on.astype(np.float64)
    squares = np.einsum("vf,fi,fj->vij", weights, normals, normals)
    for _ in range(2):
        gaps = (distances - corners @ normals.T) * weights
        corners = corners + np.linalg.solve(squares, (gaps @ normals)[:, :, None])[:, :, 0]
    return corners


def _ring(corners: Real, members: NDArray[np.intp], normal: Real) -> tuple[int, ...]:
    """Return the members counter-clockwise about `normal`."""
    spokes = corners[members] - corners[members].mean(axis=0)
    x = spokes[0] / np.linalg.norm(spokes[0])
    # normal × x, written out: np.cross would be half of the time that a body takes.
    y = np.array([normal[i] * x[j] - normal[j] * x[i] for i, j in ((1, 2), (2, 0), (0, 1))])
    angles = np.arctan2(spokes @ y, spokes @ x)
    return tuple(members[np.argsort(angles)].tolist())
