"""Facets as a cutter lays them on: planes with names, which together bound a stone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, hypot, isfinite, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError
from crystal_core.geometry.habit import centroid, check_size
from crystal_core.geometry.half_spaces import bounded_body
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.solid import Solid

__all__ = ["Facet", "check_between", "check_sizes", "compass", "cut_stone", "sloping", "upright"]

Real = NDArray[np.float64]


@dataclass(frozen=True)
class Facet:
    """A plane that bounds a stone: n·x ≤ offset.

    Parameters
    ----------
    label : str
        Its name.
    normal : tuple of float
        Outward, of length 1.
    offset : float
        Distance of the plane from the origin along the normal, mm.
    """

    label: str
    normal: tuple[float, float, float]
    offset: float


def compass(step: int, steps: int) -> tuple[float, float]:
    """Return x and y of the unit vector at azimuth 360°·step/steps.

    Directions that mirror each other in x = 0, y = 0 or x = y have the same digits where `steps` allows it, so that
    facets of one kind are exactly symmetric.
    """
    step %= steps
    if steps % 4:
        return cos(2 * pi * step / steps), sin(2 * pi * step / steps)
    quarter, rest = divmod(step, steps // 4)
    if 8 * rest == steps:
        x = y = sqrt(0.5)
    elif 8 * rest < steps:
        x, y = cos(2 * pi * rest / steps), sin(2 * pi * rest / steps)
    else:
        left = steps // 4 - rest
        y, x = cos(2 * pi * left / steps), sin(2 * pi * left / steps)
    return ((x, y), (-y, x), (-x, -y), (y, -x))[quarter]


def sloping(
    label: str, towards: tuple[float, float], slope: float, through: tuple[float, float, float], *, up: bool
) -> Facet:
    """Return a facet that falls (crown) or rises (pavilion) outwards.

    Parameters
    ----------
    label : str
        Its name.
    towards : tuple of float
        The azimuth that it faces, a unit vector.
    slope : float
        Tangent of its angle to the girdle's plane.
    through : tuple of float
        A point on it, mm.
    up : bool
        Whether it belongs to the crown.
    """
    length = hypot(1.0, slope)
    normal = (slope * towards[0] / length, slope * towards[1] / length, (1.0 if up else -1.0) / length)
    return Facet(label, normal, sum(a * b for a, b in zip(normal, through, strict=True)))


def upright(label: str, towards: tuple[float, float], distance: float) -> Facet:
    """Return a facet that stands upright at a distance (mm) from the axis, facing a unit vector."""
    return Facet(label, (*towards, 0.0), distance)


def cut_stone(facets: Sequence[Facet], inside: tuple[float, float, float], *, pointer: str = "") -> Solid:
    """Return the stone that facets bound, its centre of mass at the origin.

    Parameters
    ----------
    facets : sequence of Facet
        All of them.
    inside : tuple of float
        A point well inside.
    pointer : str
        Where the cut stands in the input.

    Raises
    ------
    InputError
        At the pointer: one of the facets bounds nothing.
    """
    normals = np.array([facet.normal for facet in facets])
    offsets = np.array([facet.offset for facet in facets])
    body, kept = bounded_body(normals, offsets, np.array(inside))
    if len(kept) < len(facets):
        idle = next(facet.label for number, facet in enumerate(facets) if number not in kept)
        raise InputError.at(pointer, f"with these proportions the facet {idle!r} is cut away by the others")
    centre = centroid(body)
    # What symmetry puts on the axis stays there: rounding must not make facets unequal.
    centre[np.abs(centre) < 1e-12 * float(np.ptp(body.vertices, axis=0).max())] = 0.0
    stone = ConvexPolyhedron(normals, offsets - normals @ centre, body.vertices - centre, body.faces)
    return Solid(stone, tuple(facet.label for facet in facets), (None,) * len(facets))


def check_sizes(sizes_mm: Sequence[float], pointer: str) -> None:
    """Raise an InputError at the pointer of the first of several lengths that is not a positive number."""
    for number, size in enumerate(sizes_mm):
        check_size(size, f"{pointer}/{number}")


def check_between(value: float, low: float, high: float, unit: str, pointer: str) -> None:
    """Raise an InputError at the pointer where a value does not lie strictly between two others."""
    if not (isfinite(value) and low < value < high):
        raise InputError.at(pointer, f"must lie between {low:g} and {high:g} {unit}, not {value!r}")
