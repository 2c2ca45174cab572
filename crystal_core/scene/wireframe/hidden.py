"""What hides what: the part of an edge that stands behind a convex body, exactly.

The lines of sight to the points of an edge fill a triangle (a pinhole) or a strip (parallel lines of sight). The body
cuts a convex polygon out of it; seen from the eye, that polygon covers one stretch of the edge.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from crystal_core.geometry.body import Body
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.scene.wireframe.lens import Lens

__all__ = ["Hider", "behind_itself", "pieces"]

Real = NDArray[np.float64]
Polygon = list[tuple[float, float]]

SHRUNK = 1e-6
"""A body hides as if it were smaller by this part: an edge on its surface is not behind it."""


SAMPLED = 6.0
"""Length of the pieces, in units of the sheet, in which a line of a mesh is looked at for being hidden by the mesh."""


OFF = 1e-5
"""How far off a mesh, in its sizes, a line of sight starts: what it meets then is not the edge that it starts from."""


@dataclass(frozen=True)
class Hider:
    """A body as something to stand behind; a curved one or a mesh as the convex hull of its corners.

    Parameters
    ----------
    body : Body
        In the world.
    lens : Lens
        Who looks.
    """

    body: Body
    lens: Lens

    @cached_property
    def half_spaces(self) -> tuple[Real, Real]:
        """Normals (F, 3) and offsets (F,) of a body slightly smaller."""
        vertices = self.body.vertices
        spare = SHRUNK * float(np.ptp(vertices, axis=0).max())
        if isinstance(self.body, ConvexPolyhedron):
            return self.body.normals, self.body.offsets - spare
        planes = np.unique(ConvexHull(vertices).equations.round(12), axis=0)
        return planes[:, :3], -planes[:, 3] - spare

    @cached_property
    def extent(self) -> tuple[Real, float]:
        """The box about the body on the sheet, (xmin, ymin, xmax, ymax), and how far its nearest corner is, mm."""
        depth = self.lens.depth(self.body.vertices)
        if self.lens.is_pinhole and depth.min() <= 0.0:
            return np.array((-np.inf, -np.inf, np.inf, np.inf)), -np.inf
        places = self.lens.project(self.body.vertices)
        return np.concatenate((places.min(axis=0), places.max(axis=0))), float(depth.min())

    def may_hide(self, other: Hider) -> bool:
        """Tell whether the other body can stand behind this one at all."""
        (box, nearest), (theirs, _) = self.extent, other.extent
        farthest = float(self.lens.depth(other.body.vertices).max())
        return bool(np.all(box[:2] <= theirs[2:]) and np.all(theirs[:2] <= box[2:]) and nearest <= farthest)

    def hidden(self, start: Real, end: Real) -> tuple[float, float] | None:
        """Return the stretch t0 … t1 of the segment, 0 at its start and 1 at its end, that stands behind the body."""
        box, nearest = self.extent
        ends = np.stack((start, end))
        if self.lens.depth(ends).max() <= nearest:
            return None
        places = self.lens.project(ends)
        if np.any(places.max(axis=0) < box[:2]) or np.any(places.min(axis=0) > box[2:]):
            return None
        normals, offsets = self.half_spaces
        along = normals @ (end - start)
        if self.lens.is_pinhole:  # x = eye + s·(start − eye) + u·(end − start), 0 ≤ u ≤ s ≤ 1; the edge's t is u/s
            rows = np.stack((normals @ self.lens.eye - offsets, normals @ (start - self.lens.eye), along), axis=1)
            polygon: Polygon = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
        else:  # x = start − s·reach·forward + u·(end − start), 0 ≤ s, u ≤ 1; the edge's t is u
            reach = float(self.lens.depth(ends).max()) - nearest
            rows = np.stack((normals @ start - offsets, -reach * (normals @ self.lens.forward), along), axis=1)
            polygon = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
        for constant, by_s, by_u in rows.tolist():
            polygon = _clipped(polygon, constant, by_s, by_u)
            if not polygon:
                return None
        stretch = [u / s if self.lens.is_pinhole else u for s, u in polygon if s > 0.0 or not self.lens.is_pinhole]
        if not stretch or max(stretch) - min(stretch) < 1e-9:
            return None
        return min(stretch), max(stretch)


def pieces(start: Real, end: Real, hiders: Iterable[Hider]) -> list[tuple[Real, Real, bool]]:
    """Return the pieces of a segment in their order, and whether each stands behind something."""
    covered = sorted(stretch for hider in hiders if (stretch := hider.hidden(start, end)) is not None)
    cuts: list[tuple[float, float, bool]] = []
    at = 0.0
    for low, high in covered:
        if low > at:
            cuts.append((at, low, False))
        if high > at:
            cuts.append((max(low, at), high, True))
            at = high
    if at < 1.0:
        cuts.append((at, 1.0, False))
    return [(start + a * (end - start), start + b * (end - start), behind) for a, b, behind in cuts if b - a > 1e-9]


def behind_itself(mesh: Mesh, lens: Lens, start: Real, end: Real) -> list[tuple[Real, Real, bool]]:
    """Return short pieces of a segment on a mesh, and whether the mesh hides their middles, runs of a kind joined."""
    length = float(np.hypot(*np.diff(lens.project(np.stack((start, end))), axis=0)[0]))
    count = int(np.clip(length / SAMPLED, 1, 40))
    steps = np.linspace(0.0, 1.0, count + 1)
    middles = start + 0.5 * (steps[:-1] + steps[1:])[:, None] * (end - start)
    sight = lens.towards_eye(middles)
    off = middles + OFF * mesh.tree.size * sight  # off the surface, to the side on which the eye is
    limit = np.linalg.norm(lens.eye - off, axis=1) if lens.is_pinhole else np.inf
    behind = np.minimum(mesh.entry(off.T, sight.T)[0], mesh.exit(off.T, sight.T)[0]) < limit
    ends = [0, *(int(i) + 1 for i in np.flatnonzero(behind[1:] != behind[:-1])), count]
    return [
        (start + steps[a] * (end - start), start + steps[b] * (end - start), bool(behind[a]))
        for a, b in itertools.pairwise(ends)
    ]


def _clipped(polygon: Polygon, constant: float, by_s: float, by_u: float) -> Polygon:
    """Return the part of a convex polygon where constant + by_s·s + by_u·u ≤ 0 (Sutherland and Hodgman)."""
    values = [constant + by_s * s + by_u * u for s, u in polygon]
    kept: Polygon = []
    for (point, value), (after, next_value) in zip(
        zip(polygon, values, strict=True),
        zip(polygon[1:] + polygon[:1], values[1:] + values[:1], strict=True),
        strict=True,
    ):
        if value <= 0.0:
            kept.append(point)
        if (value < 0.0 < next_value) or (next_value < 0.0 < value):
            t = value / (value - next_value)
            kept.append((point[0] + t * (after[0] - point[0]), point[1] + t * (after[1] - point[1])))
    return kept
