"""Draw the picture of docs/conventions.md of plates: the stack in its mount, angles, the sense of optical rotation.

    python tools/draw_plates.py [FOLDER]

writes plates.svg, into docs/pictures if no folder is given. How far quartz turns the vibration is computed by
`crystal_core.optics`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from drawing import AXIS, CRYSTAL, EXTRAORDINARY, INK, LIGHT, ORDINARY, QUIET, Drawing, by
from numpy.typing import NDArray

import minerals_db
from crystal_core.materials import medium
from crystal_core.optics.plates import Plate, plate_stack

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"

POLARIZER_DEG, ANALYSER_DEG, QUARTZ_MM, SODIUM_NM = 20.0, 110.0, 1.0, 589.3

Real = NDArray[np.float64]


def picture() -> Drawing:
    """Return the picture of three panels."""
    drawing = Drawing(
        1160,
        470,
        "Plates",
        "Three panels: a stack between its mount; polarizer and analyser; the sense of optical rotation.",
    )
    for x in (400, 780):
        drawing.line(((x, 30), (x, 440)), "#e2e2dc", 1)
    _stack(drawing, np.array((40.0, 50.0)))
    _angles(drawing, np.array((425.0, 50.0)))
    _rotation(drawing, np.array((805.0, 50.0)))
    return drawing


def _stack(drawing: Drawing, at: Real) -> None:
    """Draw the half-spaces and the plates, light from the left."""
    drawing.text(at, "A stack of plates", size=18)
    top, bottom, left = at[1] + 50, at[1] + 250, at[0] + 84
    shades = (("1", 56.0, CRYSTAL, ORDINARY), ("2", 84.0, "#f6ead2", LIGHT))
    x = left
    for name, width, fill, edge in shades:
        drawing.area(((x, top), (x + width, top), (x + width, bottom), (x, bottom)), fill, edge, 1.4)
        drawing.text((x + width / 2, top + 24), name, INK, 15, "middle")
        x += width
    for foot, anchor in ((left - 12, "end"), (x + 12, "start")):
        drawing.text((foot, bottom - 10), "mount", QUIET, 13.5, anchor)
    middle = 0.5 * (top + bottom)
    drawing.arrow((left - 84, middle), (left - 6, middle), LIGHT, 2.6)
    drawing.arrow((x + 6, middle), (x + 84, middle), LIGHT, 2.6)
    drawing.arrow((left - 6, middle + 26), (left - 74, middle + 26), QUIET, 1.8, dashed=True)
    drawing.text((left - 82, middle - 12), "light", LIGHT, 14)
    drawing.text((left - 82, middle + 48), "reflected", QUIET, 13)
    corner = np.array((left + 30.0, bottom + 48))
    drawing.arrow(corner, by(corner, 70, 0), INK, 1.8)
    drawing.text(by(corner, 78, 5), "*z*", size=16)
    drawing.arrow(corner, by(corner, 0, -34), INK, 1.8)
    drawing.text(by(corner, 8, -24), "*x*", size=16)
    drawing.towards_reader(corner, INK, 7)
    # z to the right, x up: z × x = y comes towards the reader
    drawing.text(by(corner, -12, 6), "*y*", INK, 16, "end")
    drawing.lines(
        by(at, 0, 340),
        (
            "One isotropic medium on both sides: the mount.",
            "Plates in the order in which light meets them;",
            "their axes are given in the same *x*, *y*, *z*.",
        ),
        QUIET,
        12.5,
    )


def _frame(drawing: Drawing, centre: Real) -> None:
    drawing.arrow(by(centre, -120, 0), by(centre, 130, 0), INK, 1.8)
    drawing.text(by(centre, 137, 5), "*x*", size=17)
    drawing.arrow(by(centre, 0, 120), by(centre, 0, -125), INK, 1.8)
    drawing.text(by(centre, 9, -117), "*y*", size=17)


def _direction(degrees: float, length: float = 1.0) -> Real:
    a = np.deg2rad(degrees)
    return np.asarray(length * np.array((np.cos(a), -np.sin(a))))


def _swept(start: float, end: float, radius: float) -> Real:
    return np.stack([_direction(float(a), radius) for a in np.linspace(start, end, 40)])


def _angles(drawing: Drawing, at: Real) -> None:
    """Draw polarizer and analyser as one sees them who faces the source."""
    drawing.text(at, "Polarizer and analyser", size=18)
    drawing.text(by(at, 0, 26), "facing the source: light comes out of the paper", QUIET, 13)
    centre = by(at, 160, 175)
    _frame(drawing, centre)
    for degrees, radius, colour, name in (
        (POLARIZER_DEG, 62.0, LIGHT, "polarizer"),
        (ANALYSER_DEG, 40.0, ORDINARY, "analyser"),
    ):
        reach = _direction(degrees, 108)
        drawing.line((centre - reach, centre + reach), colour, 3)
        drawing.arc(centre + _swept(0, degrees, radius), colour)
        left = degrees > 90
        foot = by(centre + _direction(degrees, 114), -4 if left else 2, 0)
        drawing.text(foot, name, colour, 14, "end" if left else "start")
    drawing.towards_reader(centre, INK, 8)
    drawing.lines(
        by(at, 0, 340),
        (
            "Angles are those of the field that passes, from *x*",
            "towards *y*: counter-clockwise. *z* comes towards you.",
            "White: the open field between parallel polars.",
        ),
        QUIET,
        12.5,
    )


def _rotation(drawing: Drawing, at: Real) -> None:
    """Draw what 1 mm of right-handed quartz, cut across its axis, does to light that vibrates along x."""
    drawing.text(at, "Optical rotation", size=18)
    drawing.text(by(at, 0, 26), "facing the source: light comes out of the paper", QUIET, 13)
    wavelength = np.array((SODIUM_NM,))
    quartz = medium(minerals_db.mineral("quartz"), wavelength)
    jones = plate_stack([Plate(quartz, 1e3 * QUARTZ_MM)], wavelength, 1.5442, coherent="single-pass").jones_transmitted
    assert jones is not None
    ex, ey = jones[:, 0, 0]
    turned = 0.5 * np.rad2deg(np.arctan2(2 * (ex * np.conj(ey)).real, abs(ex) ** 2 - abs(ey) ** 2))
    centre = by(at, 160, 175)
    _frame(drawing, centre)
    drawing.line((by(centre, -108, 0), by(centre, 108, 0)), LIGHT, 3)
    reach = _direction(float(turned), 108)
    drawing.line((centre - reach, centre + reach), EXTRAORDINARY, 3)
    drawing.arc(centre + _swept(0, float(turned), 70), EXTRAORDINARY)
    drawing.text(by(centre, 60, -12), "before", LIGHT, 14)
    drawing.text(by(centre + reach, -18, 24), "behind", EXTRAORDINARY, 14)
    drawing.text(by(centre, 80, 22), f"{abs(turned):.2f}°", EXTRAORDINARY, 14)
    drawing.towards_reader(centre, INK, 8)
    drawing.text(by(centre, -14, 24), "*c*", AXIS, 16, "end")
    drawing.lines(
        by(at, 0, 340),
        (
            f"{QUARTZ_MM:.0f} mm of right quartz, cut across *c*; {SODIUM_NM} nm.",
            "Dextrorotatory, *G* > 0: clockwise to one who",
            "faces the source; *ρ* = π*G*/(*λn*). Left quartz: *G* < 0.",
        ),
        QUIET,
        12.5,
    )


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES
    picture().save(folder / "plates.svg")
