"""The step or emerald cut: a rectangle with cut corners, steps with level edges, a keel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import radians, sqrt, tan

from crystal_core.errors import InputError
from crystal_core.geometry.facets import Facet, check_between, check_sizes, compass, cut_stone, sloping, upright
from crystal_core.geometry.solid import Solid

__all__ = ["StepProportions", "step_cut"]

MAX_STEPS = 8
"""On either side of the girdle."""

_SIDES = ("+x", "+x+y", "+y", "-x+y", "-x", "-x-y", "-y", "+x-y")


@dataclass(frozen=True)
class StepProportions:
    """What a cutter sets. Percentages are of the width, the smaller side of the outline.

    Parameters
    ----------
    table_percent : float
        Width of the table.
    crown_deg : tuple of float
        Angles of the crown's steps to the girdle's plane, on the sides, from the girdle up; they fall.
    pavilion_deg : tuple of float
        Those of the pavilion's, from the girdle down to the keel; they fall.
    girdle_percent : float
        Height of the girdle.
    corner_percent : float
        What a cut corner takes from either side.

    Notes
    -----
    The steps of crown and pavilion are equally wide, seen from above. Corners grow narrower towards the keel in
    proportion to the width and end in its end points; this makes them a little less steep than the sides.
    """

    table_percent: float = 62.0
    crown_deg: tuple[float, ...] = (42.0, 35.0, 28.0)
    pavilion_deg: tuple[float, ...] = (48.0, 44.5, 41.0)
    girdle_percent: float = 3.0
    corner_percent: float = 15.0

    @property
    def crown_height_percent(self) -> float:
        """Height from the girdle to the table."""
        return 0.5 * (100.0 - self.table_percent) * sum(map(_slope, self.crown_deg)) / len(self.crown_deg)

    @property
    def pavilion_depth_percent(self) -> float:
        """Depth from the girdle to the keel."""
        return 50.0 * sum(map(_slope, self.pavilion_deg)) / len(self.pavilion_deg)

    @property
    def depth_percent(self) -> float:
        """Height of the whole stone."""
        return self.crown_height_percent + self.girdle_percent + self.pavilion_depth_percent


def step_cut(size_mm: tuple[float, float], proportions: StepProportions | None = None, *, pointer: str = "") -> Solid:
    """Return a step cut, its table up (+z), its centre of mass at the origin.

    Parameters
    ----------
    size_mm : tuple of float
        Of the outline along x and y; the keel runs along the longer one, and a square has a point.
    proportions : StepProportions, optional
        Of the cut.
    pointer : str
        Where size and proportions stand in the input, for errors.

    Returns
    -------
    Solid
        Faces table, ``crown 1 +x`` … (step 1 lies at the girdle), ``girdle +x`` …, ``pavilion 1 +x`` …; of each eight,
        counter-clockwise from +x, corners named like ``+x+y``.

    Raises
    ------
    InputError
        At ``/size_mm`` and at the name of a proportion: out of its range.
    """
    check_sizes(size_mm, f"{pointer}/size_mm")
    chosen = proportions or StepProportions()
    _check(chosen, pointer)
    width = min(size_mm)
    half = 0.5 * width
    leg = chosen.corner_percent / 100 * width
    reach = (0.5 * size_mm[0], 0.5 * size_mm[1])
    # Distances of the eight sides from the axis at the girdle, and how far each moves in on the way to the keel.
    corner = (reach[0] + reach[1] - leg) / sqrt(2)
    start = tuple(reach[0] if side in (0, 4) else reach[1] if side in (2, 6) else corner for side in range(8))
    inset = tuple((width - leg) / sqrt(2) if side % 2 else half for side in range(8))

    high = 0.005 * chosen.girdle_percent * width
    table_z = high + chosen.crown_height_percent / 100 * width
    facets = [Facet("table", (0.0, 0.0, 1.0), table_z)]
    facets += _steps("crown", chosen.crown_deg, 1 - chosen.table_percent / 100, start, inset, high, half)
    facets += [upright(f"girdle {name}", compass(side, 8), start[side]) for side, name in enumerate(_SIDES)]
    facets += _steps("pavilion", chosen.pavilion_deg, 1.0, start, inset, -high, half)
    return cut_stone(facets, (0.0, 0.0, 0.0), pointer=pointer)


def _steps(
    part: str,
    angles_deg: Sequence[float],
    inward: float,
    start: Sequence[float],
    inset: Sequence[float],
    height: float,
    half: float,
) -> list[Facet]:
    """Return the steps of crown or pavilion from the girdle on; `inward` is the share of the way to the keel."""
    up = height > 0
    facets = []
    for step, angle in enumerate(angles_deg):
        share = inward * step / len(angles_deg)
        for side, name in enumerate(_SIDES):
            towards = compass(side, 8)
            distance = start[side] - share * inset[side]
            slope = _slope(angle) * half / inset[side]
            edge = (distance * towards[0], distance * towards[1], height)
            facets.append(sloping(f"{part} {step + 1} {name}", towards, slope, edge, up=up))
        rise = _slope(angle) * inward / len(angles_deg) * half
        height += rise if up else -rise
    return facets


def _slope(angle_deg: float) -> float:
    return tan(radians(angle_deg))


def _check(proportions: StepProportions, pointer: str) -> None:
    check_between(proportions.table_percent, 0.0, 100.0, "percent", f"{pointer}/table_percent")
    check_between(proportions.girdle_percent, 0.0, 100.0, "percent", f"{pointer}/girdle_percent")
    check_between(proportions.corner_percent, 0.0, 50.0, "percent", f"{pointer}/corner_percent")
    for name in ("crown_deg", "pavilion_deg"):
        angles: tuple[float, ...] = getattr(proportions, name)
        if not 1 <= len(angles) <= MAX_STEPS:
            raise InputError.at(f"{pointer}/{name}", f"must have 1 to {MAX_STEPS} steps, not {len(angles)}")
        for number, angle in enumerate(angles):
            check_between(angle, 0.0, 90.0, "degrees", f"{pointer}/{name}/{number}")
        for number, (outer, inner) in enumerate(pairwise(angles)):
            if inner >= outer:
                raise InputError.at(
                    f"{pointer}/{name}/{number + 1}", f"steps grow flatter from the girdle on: less than {outer:g}°"
                )
