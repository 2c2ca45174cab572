"""Spheres and cabochons as ellipsoids, whole or cut by a plane: how far they reach, and planes that touch them.

The points are x = c + A u with |u| ≤ 1 and, of a cabochon, u_z ≥ floor.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.cabochon import Cabochon
from crystal_core.geometry.sphere import Sphere

__all__ = ["Rounded", "rounded"]

Real = NDArray[np.float64]

CLIMBS = 50
"""Steps towards the point of a body that comes nearest to the surface around it; each start takes about ten."""


@dataclass(frozen=True)
class Rounded:
    """An ellipsoid above a plane: `centre` (3,), `axes` A (3, 3), `floor` −1 for a whole one."""

    centre: Real
    axes: Real
    floor: float

    @property
    def flats(self) -> tuple[Real, Real]:
        """The half-space that the base is, (k, 3) and (k,): none of a whole ellipsoid."""
        if self.floor <= -1.0:
            return np.empty((0, 3)), np.empty(0)
        up = self.axes[:, 2] / np.linalg.norm(self.axes[:, 2])
        return -up[None], np.array([-up @ (self.centre + self.floor * self.axes[:, 2])])

    def support(self, direction: Real) -> Real:
        """Return the point that lies furthest in a direction, shape (3,)."""
        u = self.axes.T @ direction
        u = u / np.linalg.norm(u)
        if u[2] < self.floor:
            radius, across = np.sqrt(1.0 - self.floor**2), np.hypot(u[0], u[1])
            scale = radius / across if across > 0 else 0.0
            u = np.array((u[0] * scale, u[1] * scale, self.floor))
        return np.asarray(self.centre + self.axes @ u, np.float64)

    def tangents(self, point: Real) -> tuple[Real, Real]:
        """Return planes that touch the body, (k, 3) and (k,), of which the point is inside of all or outside of one."""
        u = self._stretched(point)
        normal = np.linalg.solve(self.axes.T, u if np.any(u) else np.array((0.0, 0.0, 1.0)))
        normal = normal / np.linalg.norm(normal)
        offset = normal @ self.centre + np.linalg.norm(self.axes.T @ normal)
        flat_normals, flat_offsets = self.flats
        return np.concatenate((normal[None], flat_normals)), np.concatenate(([offset], flat_offsets))

    def room(self, points: Real, support: Callable[[Real], Real]) -> float:
        """Return the least distance to this surface of a convex body inside, negative where it sticks out, mm.

        Parameters
        ----------
        points : Real
            Some of its points, to start from, shape (n, 3).
        support : callable
            Its furthest point in a direction. The body's point of greatest |u| is climbed to: |u| is convex, so that
            the furthest point along its gradient lies higher.
        """
        normals, offsets = self.flats
        rooms = [float(o - n @ support(n)) for n, o in zip(normals, offsets, strict=True)]
        heights = np.linalg.norm(np.linalg.solve(self.axes, (points - self.centre).T), axis=0)
        for start in np.argsort(heights)[-8:]:
            point = points[start]
            for _ in range(CLIMBS):
                u = self._stretched(point)
                if not np.any(u):
                    u = np.array((0.0, 0.0, 1.0))
                higher = support(np.asarray(np.linalg.solve(self.axes.T, u), np.float64))
                if np.linalg.norm(self._stretched(higher)) <= np.linalg.norm(u) * (1.0 + 1e-15):
                    break
                point = higher
            rooms.append(self._depth(point))
        return min(rooms)

    def _depth(self, point: Real) -> float:
        normals, offsets = self.tangents(point)
        return float(offsets[0] - normals[0] @ point)

    def _stretched(self, point: Real) -> Real:
        return np.asarray(np.linalg.solve(self.axes, point - self.centre), np.float64)


def rounded(body: Sphere | Cabochon) -> Rounded:
    """Return a sphere or a cabochon as an ellipsoid."""
    if isinstance(body, Sphere):
        return Rounded(body.centre, body.radius_mm * np.eye(3), -1.0)
    return Rounded(body.centre, body.rotation * body.semi_axes_mm, body.floor)
