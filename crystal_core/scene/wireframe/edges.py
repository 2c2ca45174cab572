"""The lines of a body: its edges and, where it is round, the outline that the eye sees."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import Body
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.scene.wireframe.lens import Lens

__all__ = ["Line", "body_lines", "front_faces"]

Real = NDArray[np.float64]

GRAZING = 1e-7
"""A face whose normal stands across the line of sight to within this cosine is seen edge-on."""

MANY_FACES = 300
"""A mesh of more faces is a rounded thing in facets: only its sharp edges and its outline are drawn."""

SHARP_DEG = 30.0


@dataclass(frozen=True)
class Line:
    """A straight piece of a body's drawing, both ends in the world.

    Parameters
    ----------
    start, end : Real
        Shape (3,), mm.
    is_front : bool
        Whether one of the faces at it is turned to the eye, or seen edge-on.
    """

    start: Real
    end: Real
    is_front: bool


def body_lines(body: Body, lens: Lens) -> list[Line]:
    """Return edges and outlines of a body in a fixed order."""
    if isinstance(body, ConvexPolyhedron):
        front = _facing(body, lens) > -GRAZING
        return [
            Line(body.vertices[i], body.vertices[j], bool(front[one] or front[other]))
            for (i, j), (one, other) in sorted(body.edges.items())
        ]
    return list(_mesh_lines(body, lens))


def front_faces(body: Body, lens: Lens) -> NDArray[np.bool_]:
    """Tell which faces of a body with flat faces are turned to the eye, shape (F,)."""
    return np.asarray(_facing(body, lens) > GRAZING)


def _facing(body: Body, lens: Lens) -> Real:
    """Return the cosine between the normal of every flat face and the line of sight to it, shape (F,)."""
    triangles, owners = body.triangles
    _, first = np.unique(owners, return_index=True)
    points = body.vertices[triangles[first, 0]]
    normals = body.normal(owners[first].astype(np.intp), points.T).T
    return np.asarray(np.einsum("fi,fi->f", normals, lens.towards_eye(points)))


def _mesh_lines(body: Body, lens: Lens) -> Iterator[Line]:
    """Yield the lines of a body that triangles stand for: edges between its faces, outlines of its round ones."""
    triangles, owners = body.triangles
    corners = body.vertices[triangles]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    # The cosine of every triangle's corners to the line of sight, by the normal of the true surface.
    points = corners.reshape(-1, 3)
    with np.errstate(invalid="ignore"):  # a round face has no normal in the middle of a body; flat ones are not asked
        true = body.normal(np.repeat(owners, 3).astype(np.intp), points.T).T
    facing = np.einsum("ni,ni->n", true, lens.towards_eye(points)).reshape(-1, 3)
    is_round = np.abs(np.einsum("tci,ti->tc", true.reshape(-1, 3, 3), flat)).min(axis=1) < 1.0 - 1e-9
    many = body.face_count > MANY_FACES
    sides: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for number, ring in enumerate(triangles.tolist()):
        for place in range(3):
            i, j = ring[place], ring[(place + 1) % 3]
            sides.setdefault((min(i, j), max(i, j)), []).append((number, place))
    for (i, j), meeting in sorted(sides.items()):
        if len({int(owners[number]) for number, _ in meeting}) < 2:
            continue
        turned = [max(facing[number, place], facing[number, (place + 1) % 3]) > -GRAZING for number, place in meeting]
        if many:
            normals = flat[[number for number, _ in meeting]]
            if all(turned) == any(turned) and normals[0] @ normals[-1] > np.cos(np.deg2rad(SHARP_DEG)):
                continue
        yield Line(body.vertices[i], body.vertices[j], any(turned))
    for number in np.flatnonzero(is_round).tolist():
        crossing = [
            corners[number, a]
            + (corners[number, b] - corners[number, a]) * facing[number, a] / (facing[number, a] - facing[number, b])
            for a, b in ((0, 1), (1, 2), (2, 0))
            if (facing[number, a] > 0.0) != (facing[number, b] > 0.0)
        ]
        if len(crossing) == 2 and np.linalg.norm(crossing[1] - crossing[0]) > 0.0:
            yield Line(crossing[0], crossing[1], True)
