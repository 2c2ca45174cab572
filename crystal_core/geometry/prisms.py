"""Prisms: the three-sided one that refracts, and columns of any number of sides."""

from __future__ import annotations

from math import cos, pi, radians, sin

from crystal_core.errors import InputError
from crystal_core.geometry.facets import Facet, check_between, compass, cut_stone, upright
from crystal_core.geometry.habit import check_size
from crystal_core.geometry.solid import Solid

__all__ = ["column", "prism"]

MAX_SIDES = 128
"""More sides than this look round, and every one costs time."""


def prism(apex_deg: float, side_mm: float, length_mm: float, *, pointer: str = "") -> Solid:
    """Return an isosceles prism: edge of refraction up (+z) and along y, base down, centre of mass at the origin.

    Parameters
    ----------
    apex_deg : float
        Angle between the two refracting faces.
    side_mm : float
        Of the refracting faces, in the cross-section.
    length_mm : float
        Along y.
    pointer : str
        Where the prism stands in the input, for errors.

    Returns
    -------
    Solid
        Faces left (−x), right (+x), base, end +y, end -y.

    Raises
    ------
    InputError
        At ``/apex_deg``: not between 0 and 180. At ``/side_mm`` or ``/length_mm``: not a length.
    """
    check_between(apex_deg, 0.0, 180.0, "degrees", f"{pointer}/apex_deg")
    check_size(side_mm, f"{pointer}/side_mm")
    check_size(length_mm, f"{pointer}/length_mm")
    half = radians(0.5 * apex_deg)
    height = side_mm * cos(half)
    facets = [
        Facet("left", (-cos(half), 0.0, sin(half)), height * sin(half)),
        Facet("right", (cos(half), 0.0, sin(half)), height * sin(half)),
        Facet("base", (0.0, 0.0, -1.0), 0.0),
        Facet("end +y", (0.0, 1.0, 0.0), 0.5 * length_mm),
        Facet("end -y", (0.0, -1.0, 0.0), 0.5 * length_mm),
    ]
    return cut_stone(facets, (0.0, 0.0, height / 3.0), pointer=pointer)


def column(sides: int, diameter_mm: float, length_mm: float, *, pointer: str = "") -> Solid:
    """Return a regular upright prism, its centre at the origin, one of its side faces towards +x.

    Parameters
    ----------
    sides : int
        Number of side faces, 3 to 128.
    diameter_mm : float
        Of the circle through its corners.
    length_mm : float
        Along z.
    pointer : str
        Where the column stands in the input, for errors.

    Returns
    -------
    Solid
        Faces upper, lower, side 1 … side n, counter-clockwise from +x.

    Raises
    ------
    InputError
        At ``/sides``: too few or too many. At ``/diameter_mm`` or ``/length_mm``: not a length.
    """
    if not 3 <= sides <= MAX_SIDES:
        raise InputError.at(f"{pointer}/sides", f"a column has 3 to {MAX_SIDES} sides, not {sides}")
    check_size(diameter_mm, f"{pointer}/diameter_mm")
    check_size(length_mm, f"{pointer}/length_mm")
    distance = 0.5 * diameter_mm * cos(pi / sides)
    facets = [
        Facet("upper", (0.0, 0.0, 1.0), 0.5 * length_mm),
        Facet("lower", (0.0, 0.0, -1.0), 0.5 * length_mm),
    ]
    facets += [upright(f"side {number + 1}", compass(number, sides), distance) for number in range(sides)]
    return cut_stone(facets, (0.0, 0.0, 0.0), pointer=pointer)
