"""The cabochon: a dome over a flat base, exactly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError
from crystal_core.geometry.body import dot, moved, turned
from crystal_core.geometry.facets import check_sizes
from crystal_core.geometry.habit import check_size
from crystal_core.geometry.solid import Solid
from crystal_core.geometry.sphere import fan, ring_points, strips
from crystal_core.geometry.sphere_chord import sphere_chord

__all__ = ["Cabochon", "cabochon"]

Real = NDArray[np.float64]

DOME, BASE = 0, 1

_PARALLELS, _MERIDIANS = 16, 64
"""Of the triangles that stand for the dome in drawings."""


@dataclass(frozen=True)
class Cabochon:
    """What a plane leaves of an ellipsoid above it; face 0 is the dome, face 1 the base.

    In stretched coordinates u, in which the ellipsoid is the unit sphere, these are the points with |u| ≤ 1 and
    u_z ≥ floor; x = centre + rotation·(semi_axes_mm u).

    Parameters
    ----------
    centre : Real
        Of the ellipsoid, mm, shape (3,).
    rotation : Real
        Its axes as columns, a proper rotation, shape (3, 3); the third is the dome's up.
    semi_axes_mm : Real
        Shape (3,).
    floor : float
        Height of the base in units of the third semi-axis, over the ellipsoid's centre; −1 < floor < 1.
    """

    centre: Real
    rotation: Real
    semi_axes_mm: Real
    floor: float

    @property
    def face_count(self) -> int:
        """Return 2."""
        return 2

    @property
    def volume_mm3(self) -> float:
        """Return the volume."""
        return float(np.prod(self.semi_axes_mm)) * _cap_volume(self.floor)

    @property
    def vertices(self) -> Real:
        """Return the corners of `triangles`, on the surface, shape (V, 3)."""
        return moved(self._mesh[0] * self.semi_axes_mm, self.rotation, self.centre)

    @property
    def triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Return triangles for drawing, inscribed, shape (T, 3), and the face of each, shape (T,)."""
        return self._mesh[1], self._mesh[2]

    @property
    def edges(self) -> dict[tuple[int, int], tuple[int, int]]:
        """Return the rim in pieces: corners of `vertices`, with the two faces."""
        first = len(self._mesh[0]) - 1 - _MERIDIANS
        return {(first + i, first + (i + 1) % _MERIDIANS): (DOME, BASE) for i in range(_MERIDIANS)}

    @cached_property
    def _mesh(self) -> tuple[Real, NDArray[np.int32], NDArray[np.int32]]:
        polar = np.linspace(0.0, np.arccos(self.floor), _PARALLELS + 1)[1:]
        rings = ring_points(np.sin(polar), np.cos(polar), _MERIDIANS)
        vertices = np.concatenate((((0.0, 0.0, 1.0),), rings, ((0.0, 0.0, self.floor),)))
        last = len(vertices) - 1
        dome = np.concatenate((fan(0, 1, _MERIDIANS), strips(1, _PARALLELS, _MERIDIANS)))
        base = fan(last, last - _MERIDIANS, _MERIDIANS)[:, ::-1]
        owners = np.repeat(np.array((DOME, BASE), np.int32), (len(dome), len(base)))
        return vertices, np.concatenate((dome, base)), owners

    def transformed(self, rotation: Real, shift_mm: Real) -> Cabochon:
        """Return the body with every point x moved to rotation·x + shift, shapes (3, 3) and (3,)."""
        centre = turned(rotation, self.centre) + shift_mm
        return Cabochon(centre, rotation @ self.rotation, self.semi_axes_mm, self.floor)

    def normal(self, face: NDArray[np.intp], point: Real) -> Real:
        """Return outward unit normals, shape (3, N), of faces, shape (N,), at points on them, shape (3, N)."""
        gradient = self._own(point - self.centre[:, None]) / self.semi_axes_mm[:, None]
        length = np.sqrt(dot(gradient, gradient))
        gradient /= np.where(length > 0.0, length, 1.0)  # 0 at the ellipsoid's centre, which lies on a base
        return np.where(face == DOME, turned(self.rotation, gradient), -self.rotation[:, 2:])

    def span(self, point: Real, direction: Real) -> tuple[Real, Real, NDArray[np.intp], NDArray[np.intp]]:
        """Return where straight lines enter and leave, and by which face: as `ConvexPolyhedron.span`."""
        start, ahead = self._own(point - self.centre[:, None]), self._own(direction)
        enters, leaves = sphere_chord(start, ahead)
        height, speed = start[2] - self.floor, ahead[2]
        # A line along the base or nearly: ±inf, or NaN on its plane.
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            base = -height / speed
        entry, exit_ = np.full(len(base), DOME, np.intp), np.full(len(base), DOME, np.intp)
        later, sooner = (speed > 0.0) & (base > enters), (speed < 0.0) & (base < leaves)
        entry[later], exit_[sooner] = BASE, BASE
        enters, leaves = np.where(later, base, enters), np.where(sooner, base, leaves)
        return enters, np.where((speed == 0.0) & (height < 0.0), -np.inf, leaves), entry, exit_

    def exit(self, point: Real, direction: Real) -> tuple[Real, NDArray[np.intp]]:
        """Return where rays that start inside or on the body leave it: as `ConvexPolyhedron.exit`."""
        start, ahead = self._own(point - self.centre[:, None]), self._own(direction)
        # On the dome and along it: rounding may see a miss.
        leaves = np.maximum(sphere_chord(start, ahead)[1], 0.0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            base = np.maximum((self.floor - start[2]) / ahead[2], 0.0)
        down = (ahead[2] < 0.0) & (base < leaves)
        return np.where(down, base, leaves), np.where(down, BASE, DOME)

    def _own(self, vectors: Real) -> Real:
        """Return vectors, shape (3, N), in stretched coordinates."""
        return turned(self.rotation.T, vectors) / self.semi_axes_mm[:, None]


def cabochon(
    size_mm: tuple[float, float],
    height_mm: float,
    *,
    profile: Literal["ellipsoid", "cap"] = "ellipsoid",
    pointer: str = "",
) -> Solid[Cabochon]:
    """Return a cabochon, its dome up (+z), its centre of mass at the origin.

    Parameters
    ----------
    size_mm : tuple of float
        Axes of its elliptic outline, along x and y.
    height_mm : float
        Of the dome over the base.
    profile : str
        ellipsoid: half an ellipsoid, its sides upright at the base. cap: what a plane cuts off a sphere, stretched
        along the longer axis of the outline; its sides lean.
    pointer : str
        Where the cabochon stands in the input, for errors.

    Returns
    -------
    Solid
        Faces dome and base.

    Raises
    ------
    InputError
        At ``/size_mm`` or ``/height_mm``: not a length. At ``/height_mm``: a cap higher than half a sphere.
    """
    check_sizes(size_mm, f"{pointer}/size_mm")
    check_size(height_mm, f"{pointer}/height_mm")
    half = np.array((0.5 * size_mm[0], 0.5 * size_mm[1]))
    floor = 0.0
    if profile == "cap":
        steepness = height_mm / float(half.min())
        if steepness > 1.0:
            raise InputError.at(
                f"{pointer}/height_mm", f"a cap is at most as high as half its smaller size, {half.min():g} mm"
            )
        floor = (1.0 - steepness**2) / (1.0 + steepness**2)
    semi_axes = np.array((*(half / sqrt(1.0 - floor**2)), height_mm / (1.0 - floor)))
    # Centre of mass of the unit sphere above the floor.
    middle = 3.0 * (1.0 + floor) ** 2 / (4.0 * (2.0 + floor))
    centre = np.array((0.0, 0.0, -middle * semi_axes[2]))
    return Solid(Cabochon(centre, np.eye(3), semi_axes, floor), ("dome", "base"), (None, None))


def _cap_volume(floor: float) -> float:
    """Return the volume of the unit sphere above a height."""
    return pi * (1.0 - floor) ** 2 * (2.0 + floor) / 3.0
