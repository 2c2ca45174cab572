"""How far bodies reach, what lies in them, and whether two of them overlap.

Two convex bodies overlap where one point is inside both. The point that is deepest inside both is a linear programme
over their faces; a curved body takes part with planes that touch it, more of them where the last answer was found
(J. E. Kelley, J. SIAM 8, 703 (1960)). Of a mesh it is only told whether it meets another body: infinity stands for yes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from crystal_core.geometry.cabochon import Cabochon
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.sphere import Sphere
from crystal_core.scene.staged.flat import Plane
from crystal_core.scene.staged.meshes import cuts_plane, holds, meets
from crystal_core.scene.staged.rounded import rounded

__all__ = ["Outlines", "contains", "corners", "depth_in", "highest", "overlap", "support"]

Real = NDArray[np.float64]
Body = ConvexPolyhedron | Sphere | Cabochon | Mesh

ROUNDS = 100
"""Of touching planes at most; a sphere on a sphere takes about ten."""

SURE_MM = 1e-8
"""A deepest point is found when a further touching plane would change its depth by less."""

NEAR_ENOUGH = 0.003
"""Part of a depth to which it is found: its sign is what counts."""

_AXES = np.concatenate((np.eye(3), -np.eye(3)))


class Outlines:
    """The axis-parallel boxes about bodies."""

    def __init__(self, bodies: Sequence[Body]) -> None:
        reach = np.array([[highest(body, axis) for axis in _AXES] for body in bodies]).reshape(-1, 6)
        self._low, self._high = -reach[:, 3:], reach[:, :3]

    def near_pairs(self, gap_mm: float) -> Iterator[tuple[int, int]]:
        """Yield the pairs i < j whose boxes are not further apart than the gap."""
        for j in range(1, len(self._low)):
            apart = np.maximum(self._low[:j] - self._high[j], self._low[j] - self._high[:j]).max(axis=1)
            yield from ((int(i), j) for i in np.flatnonzero(apart <= gap_mm))


def corners(body: Body) -> Real:
    """Return points that span a body, shape (n, 3): its corners, or those of the box about a curved one."""
    if isinstance(body, ConvexPolyhedron | Mesh):
        return body.vertices
    low, high = ([sign * highest(body, sign * axis) for axis in np.eye(3)] for sign in (-1.0, 1.0))
    return np.stack(np.meshgrid(*zip(low, high, strict=True)), axis=-1).reshape(-1, 3)


def support(body: Body, direction: Real) -> Real:
    """Return the point of a body that lies furthest in a direction, shape (3,)."""
    if isinstance(body, ConvexPolyhedron | Mesh):
        return np.asarray(body.vertices[np.argmax(body.vertices @ direction)], np.float64)
    return rounded(body).support(direction)


def highest(body: Body, direction: Real) -> float:
    """Return the greatest n·x of a body's points x, for a unit vector n."""
    return float(direction @ support(body, direction))


def contains(body: Body, point: Real) -> bool:
    """Tell whether a point lies inside or on a body."""
    if isinstance(body, ConvexPolyhedron):
        return bool(np.all(body.normals @ point <= body.offsets))
    if isinstance(body, Mesh):
        return bool(holds(body, point[None])[0])
    normals, offsets = rounded(body).tangents(point)
    return bool(np.all(normals @ point <= offsets))


def depth_in(host: Body, inner: Body) -> float:
    """Return the least distance from a body to the faces of its host, negative where it sticks out, mm."""
    if isinstance(host, ConvexPolyhedron):
        return min(float(o) - highest(inner, n) for n, o in zip(host.normals, host.offsets, strict=True))
    if isinstance(host, Mesh):
        return np.inf if holds(host, inner.vertices[:1])[0] and not meets(host, inner) else -np.inf
    return rounded(host).room(inner.vertices, lambda direction: support(inner, direction))


def overlap(one: Body, other: Body | Plane) -> float:
    """Return the radius of the largest ball inside both, or inside one with its middle on a plane, mm.

    Negative where they do not meet: then −2 × it is about their distance. Its sign is exact; where an ellipsoid takes
    part its size is right to a few percent.
    """
    if isinstance(one, Mesh):
        return _overlap_of_mesh(one, other)
    if isinstance(other, Mesh):
        return _overlap_of_mesh(other, one)
    planes = [_planes(one)]
    on_plane = None
    if isinstance(other, Plane):
        level = float(other.normal @ other.centre)
        straddles = min(highest(one, other.normal) - level, highest(one, -other.normal) + level)
        if straddles < 0:
            return straddles
        planes.append(other.sides)
        on_plane = other.normal, level
    else:
        planes.append(_planes(other))
    normals, offsets = (np.concatenate(parts) for parts in zip(*planes, strict=True))
    curved = [rounded(body) for body in (one, other) if isinstance(body, Sphere | Cabochon)]
    for _ in range(ROUNDS):
        radius, middle = _deepest(normals, offsets, on_plane)
        more = [body.tangents(middle) for body in curved]
        slack = min((float((o - n @ middle).min()) for n, o in more), default=radius)
        if slack >= radius - max(SURE_MM, NEAR_ENOUGH * abs(radius)):
            break
        normals = np.concatenate((normals, *(n for n, _ in more)))
        offsets = np.concatenate((offsets, *(o for _, o in more)))
    return radius


def _overlap_of_mesh(mesh: Mesh, other: Body | Plane) -> float:
    if isinstance(other, Plane):
        return np.inf if cuts_plane(mesh, other) else -np.inf
    inside = contains(mesh, other.vertices[0]) or contains(other, mesh.vertices[0])
    return np.inf if inside or meets(mesh, other) else -np.inf


def _planes(body: ConvexPolyhedron | Sphere | Cabochon) -> tuple[Real, Real]:
    """Return half-spaces that hold a body: its faces, or some planes that touch a curved one."""
    if isinstance(body, ConvexPolyhedron):
        return body.normals, body.offsets
    flat_normals, flat_offsets = rounded(body).flats
    touching = [highest(body, axis) for axis in _AXES]
    return np.concatenate((_AXES, flat_normals)), np.concatenate((touching, flat_offsets))


def _deepest(normals: Real, offsets: Real, on_plane: tuple[Real, float] | None) -> tuple[float, Real]:
    """Return the greatest s with normals·x + s ≤ offsets, and its x."""
    found = linprog(
        (0.0, 0.0, 0.0, -1.0),
        A_ub=np.column_stack((normals, np.ones(len(normals)))),
        b_ub=offsets,
        A_eq=None if on_plane is None else np.array([[*on_plane[0], 0.0]]),
        b_eq=None if on_plane is None else np.array([on_plane[1]]),
        bounds=[(None, None)] * 4,
    )
    if found.x is None:
        raise ArithmeticError(f"the deepest point of two bodies was not found: {found.message}")
    return float(found.x[3]), np.asarray(found.x[:3])
