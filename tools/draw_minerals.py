"""Draw the pictures of docs/minerals.md: the angle of a monoclinic indicatrix, and chromium in ruby.

    python tools/draw_minerals.py [FOLDER]

writes orientation.svg and chromium.svg, into docs/pictures if no folder is given. Axes, angles and colours are those of
the data.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from drawing import AXIS, CRYSTAL, EXTRAORDINARY, INK, ORDINARY, QUIET, Drawing, by
from numpy.typing import NDArray

import minerals_db
from crystal_core.materials import SODIUM_D_NM, swatches
from crystal_core.materials.swatches import hexadecimal
from minerals_db import MonoclinicOrientation

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"

Real = NDArray[np.float64]

NAMES = {"alpha": "*α*", "beta": "*β*", "gamma": "*γ*"}


def orientation() -> Drawing:
    """Return the picture of two monoclinic crystals, seen against +b."""
    drawing = Drawing(
        1160,
        470,
        "Angles of a monoclinic indicatrix",
        "Two sections across b with the axes a and c, and the direction whose angle the entry gives.",
    )
    drawing.line(((580, 30), (580, 440)), "#e2e2dc", 1)
    _section(
        drawing,
        np.array((0.0, 0.0)),
        "augite",
        "Augite",
        ("turned from +*c* by +{0:g}°,", "through the angle *β* of the cell"),
    )
    _section(
        drawing,
        np.array((580.0, 0.0)),
        "orthoclase",
        "Orthoclase",
        ("turned from +*a* by −{0:g}°,", "into the angle *β* of the cell"),
    )
    return drawing


def _section(drawing: Drawing, at: Real, key: str, name: str, words: tuple[str, str]) -> None:
    """Draw the plane (010): c up, a to the left, +b towards the reader."""
    mineral = minerals_db.mineral(key)
    told = mineral.orientation
    assert isinstance(told, MonoclinicOrientation)
    assert isinstance(told.angle_deg, float)
    assert mineral.cell is not None
    beta = mineral.cell.beta_deg
    centre = by(at, 300, 225)

    def place(degrees: float, radius: float) -> Real:
        """Return the point at an angle from +c, turned as the right hand turns about +b."""
        turn = np.deg2rad(degrees)
        return by(centre, -radius * np.sin(turn), -radius * np.cos(turn))

    def sweep(start: float, end: float, radius: float) -> Real:
        return np.array([place(degrees, radius) for degrees in np.linspace(start, end, 40)])

    drawing.text(by(at, 40, 50), name, size=18)
    drawing.area(np.concatenate((centre[None], sweep(0.0, beta, 52))), CRYSTAL)
    drawing.arc(sweep(0.0, beta, 52), QUIET, 1.2, head=False)
    drawing.text(by(place(0.5 * beta, 34), -8, 5), "*β*", QUIET, 15)
    for degrees, label, shift in ((0.0, "*c*", (8, 6)), (beta, "*a*", (-20, 12))):
        drawing.arrow(place(degrees + 180.0, 60), place(degrees, 170), INK, 1.8)
        drawing.text(by(place(degrees, 170), *shift), label, size=17)
    drawing.towards_reader(centre)
    drawing.text(by(centre, 34, 12), f"*b* ∥ {NAMES[told.parallel_to_b]}", INK, 15)

    start = beta if told.from_axis == "a" else 0.0
    along = start + told.angle_deg
    other = next(axis for axis in NAMES if axis not in (told.direction, told.parallel_to_b))
    frame = mineral.principal_axes(SODIUM_D_NM)
    rest = np.rad2deg(np.arctan2(*frame[list(NAMES).index(other)][[0, 2]])) - (90.0 - beta)
    for degrees, label, colour in ((along, NAMES[told.direction], AXIS), (float(rest), NAMES[other], QUIET)):
        drawing.line((place(degrees + 180.0, 125), place(degrees, 125)), colour, 2.6 if colour == AXIS else 1.6)
        drawing.text(by(place(degrees, 146), -6, 6), label, colour, 17)
    drawing.arc(sweep(start, along, 96), EXTRAORDINARY, 2.0)
    drawing.lines(
        by(at, 40, 395),
        (
            f"{NAMES[told.direction]} {words[0].format(abs(told.angle_deg))} {words[1]}, {beta:.1f}°;",
            "+*b* comes out of the paper, and the arrow turns with +b by the right hand."
            if told.angle_deg > 0
            else "against the right hand about +*b*, so that the number is negative.",
        ),
        QUIET,
        13.5,
    )


def chromium() -> Drawing:
    """Return the picture of ruby by its chromium: o and e through three thicknesses."""
    drawing = Drawing(
        760,
        340,
        "Ruby by its content of chromium",
        "Colours of light that vibrates across and along the optic axis, for three contents and three thicknesses.",
    )
    ruby = minerals_db.mineral("ruby")
    thicknesses, contents = (1.0, 3.0, 10.0), (0.05, 0.2, 0.8)
    drawing.text((40, 46), "Ruby, light that vibrates as *o* and as *e*", size=18)
    for column, thickness in enumerate(thicknesses):
        drawing.text((262 + 170 * column, 86), f"{thickness:g} mm", QUIET, 14, "middle")
    for row, content in enumerate(contents):
        y = 100 + 70 * row
        drawing.text((40, y + 34), f"{content:g} % Cr_{{2}}O_{{3}}", INK, 15)
        for column, thickness in enumerate(thicknesses):
            colours = swatches(ruby, thickness, {"chromium": content})
            for place, (axis, ink) in enumerate((("o", ORDINARY), ("e", EXTRAORDINARY))):
                x = 190 + 170 * column + 74 * place
                drawing.area(
                    ((x, y), (x + 70, y), (x + 70, y + 56), (x, y + 56)), hexadecimal(colours[axis]), "#8a8f90", 1.0
                )
                if row == 0:
                    drawing.text((x + 35, y + 34), f"*{axis}*", ink, 16, "middle")
    drawing.text(
        (40, 322),
        "Daylight (D65), no reflections. Beer's law: four times the content is four times the way.",
        QUIET,
        13,
    )
    return drawing


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES
    orientation().save(folder / "orientation.svg")
    chromium().save(folder / "chromium.svg")
