"""A convex mesh as the polyhedron of its planes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.planar_faces import FLAT, PlanarFaces
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.surface import Surface

__all__ = ["MOST_PLANES", "as_polyhedron"]

Real = NDArray[np.float64]

MOST_PLANES = 256
"""A body of more planes is traced faster as a mesh."""


def as_polyhedron(surface: Surface, faces: PlanarFaces) -> ConvexPolyhedron | None:
    """Return the polyhedron that a surface is, None where it is not convex or has more than `MOST_PLANES` faces.

    The planes are exact; the corners are moved onto them, as nearly as more than three of them agree.
    """
    normals, offsets = faces.normals, faces.offsets
    flat = FLAT * float(np.ptp(surface.vertices, axis=0).max())
    if len(normals) > MOST_PLANES or (surface.vertices @ normals.T - offsets).max() > 2.0 * flat:
        return None
    following, touching = _outlines(surface, faces)
    # A corner of the file on a straight edge or in a face is none of the body.
    corners = [vertex for vertex, some in enumerate(touching) if len(some) >= 3]
    numbers = {vertex: number for number, vertex in enumerate(corners)}
    rings = []
    for outline in following:
        ring = _ring(outline)
        if ring is None:
            return None
        rings.append(tuple(numbers[vertex] for vertex in ring if vertex in numbers))
    edges = sum(map(len, rings)) // 2
    if min(map(len, rings)) < 3 or len(corners) - edges + len(rings) != 2:
        return None
    vertices = np.array(
        [_onto(surface.vertices[v], normals[list(touching[v])], offsets[list(touching[v])]) for v in corners]
    )
    moved = np.abs(vertices - surface.vertices[corners]).max()
    if moved > 100.0 * flat or (vertices @ normals.T - offsets).max() > 2.0 * flat:
        return None
    return ConvexPolyhedron(normals, offsets, vertices, tuple(rings))


def _outlines(surface: Surface, faces: PlanarFaces) -> tuple[list[dict[int, list[int]]], list[set[int]]]:
    """Return for each face what follows each corner on its outline, and for each corner the faces that it touches."""
    owners: dict[tuple[int, int], int] = {}
    touching: list[set[int]] = [set() for _ in surface.vertices]
    for (a, b, c), owner in zip(surface.triangles.tolist(), faces.owners.tolist(), strict=True):
        for ends in ((a, b), (b, c), (c, a)):
            owners[ends] = owner
            touching[ends[0]].add(owner)
    following: list[dict[int, list[int]]] = [{} for _ in faces.normals]
    for (start, end), owner in owners.items():
        if owners[end, start] != owner:
            following[owner].setdefault(start, []).append(end)
    return following, touching


def _ring(outline: dict[int, list[int]]) -> list[int] | None:
    """Return the corners of an outline in order; None where it is not one closed line."""
    if not outline or any(len(ends) > 1 for ends in outline.values()):
        return None
    start = next(iter(outline))
    ring = [start]
    while (following := outline[ring[-1]][0]) != start:
        if len(ring) == len(outline) or following not in outline:
            return None
        ring.append(following)
    return ring if len(ring) == len(outline) else None


def _onto(point: Real, normals: Real, offsets: Real) -> Real:
    """Return the point moved by as little as it takes to lie on planes."""
    return np.asarray(point + np.linalg.lstsq(normals, offsets - normals @ point, rcond=1e-6)[0])
