"""The sphere, exactly: no facets where it is traced."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import turned
from crystal_core.geometry.habit import check_size
from crystal_core.geometry.solid import Solid
from crystal_core.geometry.sphere_chord import sphere_chord

__all__ = ["Sphere", "sphere"]

Real = NDArray[np.float64]

_PARALLELS, _MERIDIANS = 32, 64
"""Of the triangles that stand for it in drawings: they lie at most 0.25 % of the radius inside."""


@dataclass(frozen=True)
class Sphere:
    """The points within a distance of a centre; face 0 is all of its surface.

    Parameters
    ----------
    centre : Real
        In mm, shape (3,).
    radius_mm : float
        Its radius.
    """

    centre: Real
    radius_mm: float

    @property
    def face_count(self) -> int:
        """Return 1."""
        return 1

    @property
    def edges(self) -> dict[tuple[int, int], tuple[int, int]]:
        """Return nothing: it has none."""
        return {}

    @property
    def volume_mm3(self) -> float:
        """Return the volume."""
        return 4.0 / 3.0 * pi * self.radius_mm**3

    @property
    def vertices(self) -> Real:
        """Return the corners of `triangles`, on the sphere, shape (V, 3)."""
        return self.centre + self.radius_mm * self._mesh[0]

    @property
    def triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Return triangles for drawing, inscribed, shape (T, 3), and the face of each, shape (T,)."""
        corners = self._mesh[1]
        return corners, np.zeros(len(corners), np.int32)

    @cached_property
    def _mesh(self) -> tuple[Real, NDArray[np.int32]]:
        polar = np.linspace(0.0, pi, _PARALLELS + 1)[1:-1]
        rings = ring_points(np.sin(polar), np.cos(polar), _MERIDIANS)
        vertices = np.concatenate((((0.0, 0.0, 1.0),), rings, ((0.0, 0.0, -1.0),)))
        corners = np.concatenate(
            (
                fan(0, 1, _MERIDIANS),
                strips(1, _PARALLELS - 1, _MERIDIANS),
                fan(len(vertices) - 1, len(vertices) - 1 - _MERIDIANS, _MERIDIANS)[:, ::-1],
            )
        )
        return vertices, corners

    def transformed(self, rotation: Real, shift_mm: Real) -> Sphere:
        """Return the sphere with every point x moved to rotation·x + shift, shapes (3, 3) and (3,)."""
        return Sphere(turned(rotation, self.centre) + shift_mm, self.radius_mm)

    def normal(self, face: NDArray[np.intp], point: Real) -> Real:  # noqa: ARG002  (a body of several faces needs it)
        """Return outward unit normals at points on it, shape (3, N)."""
        outward = point - self.centre[:, None]
        return np.asarray(outward / np.sqrt(np.sum(outward * outward, axis=0)))

    def span(self, point: Real, direction: Real) -> tuple[Real, Real, NDArray[np.intp], NDArray[np.intp]]:
        """Return where straight lines enter and leave, and by which face: as `ConvexPolyhedron.span`."""
        enters, leaves = sphere_chord((point - self.centre[:, None]) / self.radius_mm, direction / self.radius_mm)
        face = np.zeros(point.shape[1], np.intp)
        return enters, leaves, face, face

    def exit(self, point: Real, direction: Real) -> tuple[Real, NDArray[np.intp]]:
        """Return where rays that start inside or on the sphere leave it: as `ConvexPolyhedron.exit`."""
        _, leaves, _, face = self.span(point, direction)
        # On the sphere and along it: rounding may see a miss.
        return np.maximum(leaves, 0.0), face


def sphere(diameter_mm: float, *, pointer: str = "") -> Solid[Sphere]:
    """Return a sphere about the origin.

    Parameters
    ----------
    diameter_mm : float
        Of the sphere.
    pointer : str
        Where the sphere stands in the input, for errors.

    Raises
    ------
    InputError
        At ``/diameter_mm``: not a length.
    """
    check_size(diameter_mm, f"{pointer}/diameter_mm")
    return Solid(Sphere(np.zeros(3), 0.5 * diameter_mm), ("sphere",), (None,))


def ring_points(radii: Real, heights: Real, count: int) -> Real:
    """Return points on horizontal circles, shape (R·count, 3), counter-clockwise from +x, a circle after the other."""
    angle = 2.0 * pi * np.arange(count) / count
    x, y = np.multiply.outer(radii, np.cos(angle)), np.multiply.outer(radii, np.sin(angle))
    return np.stack((x, y, np.broadcast_to(heights[:, None], x.shape)), axis=-1).reshape(-1, 3)


def fan(tip: int, first: int, count: int) -> NDArray[np.int32]:
    """Return triangles from a tip above to a circle of points, counter-clockwise from above, shape (count, 3)."""
    step = np.arange(count)
    return np.stack((np.full(count, tip), first + step, first + (step + 1) % count), axis=-1).astype(np.int32)


def strips(first: int, circles: int, count: int) -> NDArray[np.int32]:
    """Return triangles between circles of points that follow each other downwards, seen from outside, shape (T, 3)."""
    upper = first + count * np.arange(circles - 1)[:, None] + np.arange(count)
    upper_next = first + count * np.arange(circles - 1)[:, None] + (np.arange(count) + 1) % count
    lower, lower_next = upper + count, upper_next + count
    both = (np.stack((upper, lower, lower_next), axis=-1), np.stack((upper, lower_next, upper_next), axis=-1))
    return np.concatenate(both).reshape(-1, 3).astype(np.int32)
