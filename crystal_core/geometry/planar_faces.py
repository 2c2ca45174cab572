"""Triangles in one plane are one face."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from crystal_core.geometry.surface import Surface, paired_edges

__all__ = ["FLAT", "PlanarFaces", "planar_faces"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]

FLAT = 1e-5
"""Corners of a face lie within this of its plane, in units of the largest extent: ten times what merges corners."""


@dataclass(frozen=True)
class PlanarFaces:
    """The faces of a surface, by falling area.

    Parameters
    ----------
    owners : NDArray of int
        Face of each triangle, shape (T,).
    normals : Real
        Outward unit normals of the faces, shape (F, 3).
    offsets : Real
        Shape (F,).
    folded : bool
        Whether the surface folds back on itself somewhere: neighbours in one plane on the same side of their edge.
    """

    owners: Index
    normals: Real
    offsets: Real
    folded: bool


def planar_faces(surface: Surface) -> PlanarFaces:
    """Return the planar faces of a surface: connected triangles whose corners lie within `FLAT` of one plane."""
    vertices, triangles = surface.vertices, surface.triangles
    flat = FLAT * float(np.ptp(vertices, axis=0).max())
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    crossed = np.cross(b - a, c - a)
    doubled = np.linalg.norm(crossed, axis=1)
    longest = np.sqrt(np.maximum.reduce([np.sum(side * side, axis=1) for side in (b - a, c - b, a - c)]))
    sliver = doubled <= flat * longest  # lower than the tolerance: its own plane says nothing
    if sliver.all():
        sliver = doubled == 0.0
    normals = crossed / np.where(doubled > 0.0, doubled, 1.0)[:, None]

    _, sides = paired_edges(triangles)
    count = len(triangles)
    one, other = sides[:, 0] % count, sides[:, 1] % count
    # The larger triangle's plane, and the corner of the smaller one that is not on the edge.
    swap = doubled[one] < doubled[other]
    large, small = np.where(swap, other, one), np.where(swap, one, other)
    place = np.where(swap, sides[:, 0], sides[:, 1])
    opposite = triangles[small, (place // count + 2) % 3]
    height = np.sum(normals[large] * (vertices[opposite] - a[large]), axis=1)
    level = (np.abs(height) <= flat) & ~sliver[one] & ~sliver[other]
    agree = np.sum(normals[one] * normals[other], axis=1)
    folded = bool((level & (agree < -0.5)).any())
    joined = level & (agree > 0.5)

    links = coo_array((np.ones(int(joined.sum())), (one[joined], other[joined])), shape=(count, count))
    groups, group = connected_components(links, directed=False)
    order = np.argsort(group, kind="stable")
    faces: list[_Face] = []
    neighbours: list[list[int]] | None = None
    for some in np.split(order, np.searchsorted(group[order], np.arange(1, groups))):
        if sliver[some[0]]:
            continue
        face = _face(vertices, triangles, crossed, some, 0.1 * flat)
        if face.misses <= flat:
            faces.append(face)
            continue
        # A chain of triangles that bends by and by: faces grow from the largest triangle on, each about one plane.
        if neighbours is None:
            neighbours = _lists(one[joined], other[joined], count)
        pieces = _grown(vertices, triangles, normals, doubled, some, neighbours, flat)
        faces += [_face(vertices, triangles, crossed, piece, 0.1 * flat) for piece in pieces]
    areas = np.array([doubled[face.members].sum() for face in faces])
    # Equal faces keep the order of the file, whatever rounding says of their areas.
    falling = np.lexsort((np.array([face.members.min() for face in faces]), -np.round(areas / areas.max(), 9)))
    faces = [faces[number] for number in falling.tolist()]
    owners = np.full(count, -1, np.intp)
    for number, face in enumerate(faces):
        owners[face.members] = number
    if sliver.any():
        _give_slivers(vertices, triangles, owners, _lists(one, other, count))
    return PlanarFaces(
        owners, np.array([face.normal for face in faces]), np.array([face.offset for face in faces]), folded
    )


@dataclass(frozen=True)
class _Face:
    """Triangles, their plane, and the greatest distance of a corner from it."""

    members: Index
    normal: Real
    offset: float
    misses: float


def _lists(one: Index, other: Index, count: int) -> list[list[int]]:
    """Return the neighbours of each triangle."""
    neighbours: list[list[int]] = [[] for _ in range(count)]
    for i, j in zip(one.tolist(), other.tolist(), strict=True):
        neighbours[i].append(j)
        neighbours[j].append(i)
    return neighbours


def _give_slivers(vertices: Real, triangles: Index, owners: Index, neighbours: list[list[int]]) -> None:
    """Give triangles without a plane of their own to the face across their longest edge, in whose plane they lie."""
    slivers = np.flatnonzero(owners < 0).tolist()
    hanging: dict[int, list[int]] = {}
    for sliver in slivers:
        across = max((_shared_length(vertices, triangles, sliver, near), near) for near in neighbours[sliver])[1]
        hanging.setdefault(across, []).append(sliver)
    known = deque(across for across in hanging if owners[across] >= 0)
    while known:
        across = known.popleft()
        for sliver in hanging.get(across, ()):
            owners[sliver] = owners[across]
            known.append(sliver)
    # Slivers that lie across from each other: any neighbour that has a face will do.
    known = deque(near for sliver in slivers if owners[sliver] < 0 for near in neighbours[sliver] if owners[near] >= 0)
    while known:
        near = known.popleft()
        for sliver in neighbours[near]:
            if owners[sliver] < 0:
                owners[sliver] = owners[near]
                known.append(sliver)


def _shared_length(vertices: Real, triangles: Index, one: int, other: int) -> float:
    ends = np.intersect1d(triangles[one], triangles[other])
    return float(np.linalg.norm(np.ptp(vertices[ends], axis=0)))


def _face(vertices: Real, triangles: Index, crossed: Real, some: Index, good: float) -> _Face:
    """Return triangles as a face: in the plane of their area if that is good enough, else in that of least squares."""
    points = vertices[triangles[some].reshape(-1)]
    middle = points.mean(axis=0)
    outward = crossed[some].sum(axis=0)
    # What is exact but for rounding stays as it is: the normals of a cube keep their noughts.
    normal = outward / np.sqrt(outward @ outward)
    spokes = points - middle
    misses = float(np.abs(spokes @ normal).max())
    if misses > good:
        fitted = np.linalg.svd(spokes, full_matrices=False)[2][2]
        better = float(np.abs(spokes @ fitted).max())
        if better < misses:
            normal, misses = fitted * np.sign(fitted @ normal), better
    return _Face(some, normal, float(middle @ normal), misses)


def _grown(
    vertices: Real,
    triangles: Index,
    normals: Real,
    doubled: Real,
    some: Index,
    neighbours: list[list[int]],
    flat: float,
) -> list[Index]:
    """Return groups of triangles about the planes of the largest that is left each time."""
    left = set(some.tolist())
    pieces = []
    for seed in some[np.argsort(-doubled[some], kind="stable")].tolist():
        if seed not in left:
            continue
        left.remove(seed)
        piece, waiting = [seed], deque([seed])
        normal, offset = normals[seed], float(vertices[triangles[seed, 0]] @ normals[seed])
        while waiting:
            for near in neighbours[waiting.popleft()]:
                if near not in left or normals[near] @ normal <= 0.5:
                    continue
                if np.abs(vertices[triangles[near]] @ normal - offset).max() <= 0.5 * flat:
                    left.remove(near)
                    piece.append(near)
                    waiting.append(near)
        pieces.append(np.array(piece))
    return pieces
