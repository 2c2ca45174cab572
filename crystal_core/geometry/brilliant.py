"""The round brilliant: 57 facets and a girdle, from its proportions."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, tan

from crystal_core.errors import InputError
from crystal_core.geometry.facets import Facet, check_between, compass, cut_stone, sloping, upright
from crystal_core.geometry.habit import check_size
from crystal_core.geometry.solid import Solid

__all__ = ["MODERN", "PROPORTIONS", "TOLKOWSKY", "Proportions", "brilliant"]

_COS_EIGHTH, _COS_SIXTEENTH = cos(pi / 8), cos(pi / 16)


@dataclass(frozen=True)
class Proportions:
    """What a cutter sets. Percentages are of the diameter of the girdle unless something else is said.

    Parameters
    ----------
    table_percent : float
        Width of the table from corner to opposite corner.
    crown_deg : float
        Angle of the eight kites to the girdle's plane.
    pavilion_deg : float
        Angle of the eight pavilion mains to it.
    girdle_percent : float
        Height of the girdle where a kite and a main meet it, its thickest places.
    star_percent : float
        Length of the stars seen from above, percent of the way from the table's edge to the girdle.
    lower_half_percent : float
        Length of the lower halves seen from below, percent of the way from the girdle to the axis.
    culet_percent : float
        Width of the culet from side to side; 0: a point.
    girdle_facets : int or None
        16 or a multiple of it. None: 32, or 16 where the girdle is too thin for more: a cylinder's surface comes
        down between the places where 16 facets meet it, and the girdle would run out there.
    """

    table_percent: float = 53.0
    crown_deg: float = 34.5
    pavilion_deg: float = 40.75
    girdle_percent: float = 0.7
    star_percent: float = 50.0
    lower_half_percent: float = 75.0
    culet_percent: float = 0.0
    girdle_facets: int | None = None

    @property
    def crown_height_percent(self) -> float:
        """Height from the girdle to the table."""
        return 0.5 * (100.0 - self.table_percent) * tan(radians(self.crown_deg))

    @property
    def pavilion_depth_percent(self) -> float:
        """Depth from the girdle to the culet."""
        return 0.5 * (100.0 - self.culet_percent) * tan(radians(self.pavilion_deg))

    @property
    def depth_percent(self) -> float:
        """Height of the whole stone."""
        return self.crown_height_percent + self.girdle_percent + self.pavilion_depth_percent


TOLKOWSKY = Proportions()
"""M. Tolkowsky, Diamond Design (1919): table and angles. The lengths of stars and lower halves are our choice."""

MODERN = Proportions(57.0, 34.5, 40.8, 3.5, 55.0, 80.0)
"""Typical of what is cut today, chosen by us."""

PROPORTIONS = {"tolkowsky": TOLKOWSKY, "modern": MODERN}


def brilliant(diameter_mm: float, proportions: Proportions = TOLKOWSKY, *, pointer: str = "") -> Solid:
    """Return a round brilliant, its table up (+z), a kite and a main towards +x, its centre of mass at the origin.

    All meet points are exact: kite, two stars and the table; kite, star and two upper halves; kite, main, upper and
    lower halves at the girdle, whose corners lie on the circle.

    Parameters
    ----------
    diameter_mm : float
        Of the girdle, from corner to opposite corner.
    proportions : Proportions
        Of the cut.
    pointer : str
        Where diameter and proportions stand in the input, for errors.

    Returns
    -------
    Solid
        Faces table, star 1 … 8, kite 1 … 8, upper half 1 … 16, girdle 1 …, lower half 1 … 16, main 1 … 8, and the
        culet where there is one; each kind counter-clockwise from +x. A girdle of no height has no faces.

    Raises
    ------
    InputError
        At ``/diameter_mm`` and at the name of a proportion: out of its range, or none with which the facets meet.
    """
    check_size(diameter_mm, f"{pointer}/diameter_mm")
    _check(proportions, pointer)
    radius = 0.5 * diameter_mm
    table, star = proportions.table_percent / 100, proportions.star_percent / 100
    lower, culet = proportions.lower_half_percent / 100, proportions.culet_percent / 100
    crown_slope, main_slope = tan(radians(proportions.crown_deg)), tan(radians(proportions.pavilion_deg))

    # In units of the radius, heights over the girdle's upper edge (crown), depths under its lower edge (pavilion).
    top = (1 - table) * crown_slope
    star_tip = table * _COS_EIGHTH + star * (1 - table * _COS_EIGHTH)
    star_height = (1 - star_tip * _COS_EIGHTH) * crown_slope
    star_slope = (top - star_height) / (star_tip - table * _COS_EIGHTH)
    if star_slope <= 0:
        shortest = 100 * table * (1 / _COS_EIGHTH - _COS_EIGHTH) / (1 - table * _COS_EIGHTH)
        raise InputError.at(
            f"{pointer}/star_percent", f"stars so short do not fall from the table: more than {shortest:.3g} %"
        )
    upper_slope = star_height / (_COS_SIXTEENTH * (1 - star_tip))
    lower_tip = 1 - lower
    if culet >= lower_tip * _COS_EIGHTH:
        longest = 100 * (1 - culet / _COS_EIGHTH)
        raise InputError.at(
            f"{pointer}/lower_half_percent", f"halves so long run into the culet: less than {longest:.3g} %"
        )
    lower_slope = (1 - lower_tip * _COS_EIGHTH) * main_slope / (_COS_SIXTEENTH * lower)
    bottom = (1 - culet) * main_slope

    girdle = 2 * proportions.girdle_percent / 100
    sides = _girdle_facets(proportions, upper_slope + lower_slope, pointer)
    high, low = 0.5 * girdle * radius, -0.5 * girdle * radius

    table_z, culet_z = high + top * radius, low - bottom * radius
    facets = [Facet("table", (0.0, 0.0, 1.0), table_z)]
    for number in range(8):
        towards = compass(2 * number + 1, 16)
        edge = (table * _COS_EIGHTH * radius * towards[0], table * _COS_EIGHTH * radius * towards[1], table_z)
        facets.append(sloping(f"star {number + 1}", towards, star_slope, edge, up=True))
    mains = [compass(number, 8) for number in range(8)]
    halves = [compass(2 * number + 1, 32) for number in range(16)]
    for number, towards in enumerate(mains):
        corner = (radius * towards[0], radius * towards[1], high)
        facets.append(sloping(f"kite {number + 1}", towards, crown_slope, corner, up=True))
    chord = _COS_SIXTEENTH * radius
    for number, towards in enumerate(halves):
        middle = (chord * towards[0], chord * towards[1], high)
        facets.append(sloping(f"upper half {number + 1}", towards, upper_slope, middle, up=True))
    if girdle > 0:
        facets += [
            upright(f"girdle {number + 1}", compass(2 * number + 1, 2 * sides), radius * cos(pi / sides))
            for number in range(sides)
        ]
    for number, towards in enumerate(halves):
        middle = (chord * towards[0], chord * towards[1], low)
        facets.append(sloping(f"lower half {number + 1}", towards, lower_slope, middle, up=False))
    for number, towards in enumerate(mains):
        corner = (radius * towards[0], radius * towards[1], low)
        facets.append(sloping(f"main {number + 1}", towards, main_slope, corner, up=False))
    if culet > 0:
        facets.append(Facet("culet", (0.0, 0.0, -1.0), -culet_z))
    return cut_stone(facets, (0.0, 0.0, 0.0), pointer=pointer)


def _check(proportions: Proportions, pointer: str) -> None:
    for name in ("table_percent", "star_percent", "lower_half_percent"):
        check_between(getattr(proportions, name), 0.0, 100.0, "percent", f"{pointer}/{name}")
    for name in ("crown_deg", "pavilion_deg"):
        check_between(getattr(proportions, name), 0.0, 90.0, "degrees", f"{pointer}/{name}")
    for name in ("girdle_percent", "culet_percent"):
        if not 0.0 <= getattr(proportions, name) < 100.0:
            raise InputError.at(
                f"{pointer}/{name}", f"must be at least 0 and less than 100 percent, not {getattr(proportions, name)!r}"
            )
    sides = proportions.girdle_facets
    if sides is not None and (sides not in range(16, 129, 16)):
        raise InputError.at(f"{pointer}/girdle_facets", f"must be a multiple of 16 up to 128, not {sides}")


def _girdle_facets(proportions: Proportions, slopes: float, pointer: str) -> int:
    """Return the number of facets of the girdle; `slopes` is the sum of those of upper and lower halves."""
    asked = proportions.girdle_facets
    for sides in (32, 16) if asked is None else (asked,):
        # Azimuths of the corners from the middle of a half facet: the nearest has the thinnest girdle.
        nearest = min(abs(2 * pi * corner / sides - pi / 16) for corner in range(sides // 16 + 1))
        least = 50.0 * slopes * (cos(nearest) - _COS_SIXTEENTH)
        if sides == 16 or proportions.girdle_percent > least:
            return sides
    raise InputError.at(
        f"{pointer}/girdle_percent",
        f"a girdle of {asked} facets runs out between the kites at {proportions.girdle_percent:g} %: "
        f"more than {least:.3g} %, or 16 facets",
    )
