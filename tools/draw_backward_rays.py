"""Draw the picture of docs/backward-rays.md: one ray through a block of calcite, forward and backward.

    python tools/draw_backward_rays.py [FOLDER]

writes backward-rays.svg, into docs/pictures if no folder is given. Directions and lengths are those that
`crystal_core.optics` gives for the extraordinary wave; beside them stands the rule of the paper.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from drawing import AXIS, CRYSTAL, EXTRAORDINARY, INK, LIGHT, ORDINARY, QUIET, Drawing, by
from numpy.typing import NDArray

from crystal_core.optics import Medium, scatter

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"

N_O, N_E = 1.6584, 1.4864
"""Calcite at 589.3 nm."""

TANGENTIAL_K = np.array((0.5, 0.0, 0.0))
"""Of light that comes in at 30°; x along it, z into the block."""

OPTIC_AXIS = np.array((np.sqrt(6.0), np.sqrt(2.0), np.sqrt(8.0))) / 4.0
"""45° from the normal, 30° out of the plane of incidence."""

THICKNESS_MM = 10.0

WRONG = "#b42318"

Real = NDArray[np.float64]


@dataclass(frozen=True)
class Trace:
    """The extraordinary wave in the block, and directions in air, all unit vectors of shape (3,)."""

    k: Real
    ray: Real
    outside: Real
    by_paper: Real

    def foot(self) -> Real:
        """Return where the ray that enters at the origin meets the lower face, mm."""
        return np.asarray(THICKNESS_MM * self.ray / self.ray[2])

    def error_deg(self) -> float:
        """Return the angle between the right direction and that by the paper's rule."""
        return float(np.rad2deg(np.arccos(self.outside @ self.by_paper)))


def trace() -> Trace:
    """Return the extraordinary wave of the block, and how it leaves by either rule.

    The faces are parallel, so the direction that it came with is the direction that it leaves with. By the paper's rule
    the exit lies in the plane of the ray and the normal, and obeys Snell's law with the angle of the ray and |k|.
    """
    wave = scatter((0.0, 0.0, 1.0), TANGENTIAL_K[:, None], Medium.isotropic(1.0), _calcite()).transmitted[1]
    k, ray = wave.k[:, 0], wave.ray[:, 0]
    return Trace(k, ray, _in_air(k), _in_air(np.linalg.norm(k) * ray))


def _calcite() -> Medium:
    return Medium.uniaxial(N_O, N_E, OPTIC_AXIS)


def _in_air(k: Real) -> Real:
    """Return the direction in air of a wave whose tangential part is that of k."""
    return np.array((k[0], k[1], np.sqrt(1.0 - k[0] ** 2 - k[1] ** 2)))


def picture() -> Drawing:
    """Return the picture: the block from the side, the same from above, and words."""
    drawing = Drawing(
        1160,
        760,
        "A ray through calcite, forward and backward",
        "The extraordinary ray through a block from the side and from above; the right exit and that by the paper.",
    )
    drawing.line(((570, 30), (570, 730)), "#e2e2dc", 1)
    path = trace()
    _side(drawing, path)
    _above(drawing, path)
    _words(drawing, path)
    return drawing


def _side(drawing: Drawing, path: Trace) -> None:
    """Draw the plane of x and z, z down on the paper."""
    drawing.text((40, 50), "From the side", size=18)
    drawing.text((182, 50), "along the tangential part of *k*, 10 mm thick", QUIET, 13)
    unit, origin = 30.0, np.array((230.0, 230.0))

    def paper(v: Real) -> Real:
        return np.asarray(origin + unit * v[[0, 2]])

    left, right = 60.0, 540.0
    bottom = origin[1] + unit * THICKNESS_MM
    drawing.area(((left, origin[1]), (right, origin[1]), (right, bottom), (left, bottom)), CRYSTAL)
    for y in (origin[1], bottom):
        drawing.line(((left, y), (right, y)), ORDINARY, 1.6)
    drawing.text((left + 6, origin[1] - 10), "air", QUIET, 13)
    drawing.text((left + 6, bottom - 12), "calcite", QUIET, 13)

    enter, leave = np.zeros(3), path.foot()
    for end, down in ((enter, 3.4), (leave, 5.0)):
        drawing.line((by(paper(end), 0, -unit * down * 0.6), by(paper(end), 0, unit * down * 0.6)), "#a8adad", 1, True)
    axis = np.array((-4.2, 0.0, 4.6))
    drawing.arrow(paper(axis), paper(axis + 3.2 * OPTIC_AXIS), AXIS, 2.0)
    drawing.text(by(paper(axis + 3.2 * OPTIC_AXIS), -8, 20), "optic axis", AXIS, 14, "middle")

    # Forward, one line of light through the block.
    drawing.arrow(paper(-5.6 * path.outside), paper(enter), LIGHT, 2.6)
    drawing.arrow(paper(enter), paper(leave), EXTRAORDINARY, 2.6)
    drawing.arrow(paper(leave), paper(leave + 6.2 * path.outside), LIGHT, 2.6)
    drawing.arrow(paper(leave), paper(leave + 6.2 * path.by_paper), WRONG, 1.8, dashed=True)
    # Backward, beside it: the same lines the other way.
    beside = 0.3 * np.array((path.outside[2], 0.0, -path.outside[0]))
    within = 0.3 * np.array((path.ray[2], 0.0, -path.ray[0])) / np.hypot(path.ray[0], path.ray[2])
    drawing.arrow(paper(leave + 6.2 * path.outside + beside), paper(leave + 0.4 * path.outside + beside), INK, 1.5)
    drawing.arrow(paper(leave + within - 0.2 * path.ray), paper(enter + within + 0.3 * path.ray), INK, 1.5)
    drawing.arrow(paper(enter + beside - 0.2 * path.outside), paper(beside - 5.6 * path.outside), INK, 1.5)
    drawing.arrow(paper(enter + beside), paper(beside - 5.6 * path.by_paper), WRONG, 1.8, dashed=True)

    drawing.text(by(paper(-5.6 * path.outside), -10, 4), "light, 30°", LIGHT, 14, "end")
    drawing.text(by(paper(beside - 5.6 * path.by_paper), 9, 4), "backward, by the paper", WRONG, 14)
    drawing.text(by(paper(0.55 * leave), 18, 0), "ray", EXTRAORDINARY, 15)
    drawing.text(by(paper(0.55 * leave), 18, 19), "backward: the same", INK, 13)
    drawing.text(by(paper(leave + 6.2 * path.outside), 12, 2), "forward", LIGHT, 14)
    drawing.text(by(paper(leave + 6.2 * path.by_paper), -4, 20), "forward, by the paper", WRONG, 14, "end")
    _scale(drawing, np.array((470.0, bottom - 14)), unit)


def _above(drawing: Drawing, path: Trace) -> None:
    """Draw the face as the light sees it, looking along z: x to the right, y down."""
    drawing.text((605, 50), "From above", size=18)
    drawing.text((728, 50), "looking along the normal: *x* right, *y* down", QUIET, 13)
    unit, origin = 74.0, np.array((700.0, 250.0))

    def paper(v: Real) -> Real:
        return np.asarray(origin + unit * v[:2])

    drawing.area(((605, 75), (1120, 75), (1120, 385), (605, 385)), CRYSTAL)
    drawing.line((by(origin, -80, 0), by(origin, 400, 0)), "#a8adad", 1, True)
    drawing.text((1112, origin[1] + 38), "plane of *k* and the normal", QUIET, 13, "end")
    leave = path.foot()
    drawing.line((paper(np.zeros(3)), paper(2.05 * leave)), "#a8adad", 1, dashed=True)
    drawing.text((1112, 122), "plane of the ray and the normal", QUIET, 13, "end")

    drawing.arrow(by(origin, -80, 0), origin, LIGHT, 2.6)
    drawing.arrow(origin, paper(1.0 * leave), EXTRAORDINARY, 2.6)
    drawing.text(by(paper(0.52 * leave), -18, 26), "ray", EXTRAORDINARY, 15)
    drawing.arrow(paper(leave), paper(leave + 2.9 * path.outside), LIGHT, 2.6)
    drawing.arrow(paper(leave), paper(leave + 2.9 * path.by_paper), WRONG, 1.8, dashed=True)
    drawing.text(by(paper(leave + 2.9 * path.outside), 6, 5), "exit", LIGHT, 15)
    drawing.text(by(paper(leave + 2.9 * path.by_paper), 8, 2), "by the paper", WRONG, 14)
    drawing.arrow(by(origin, 0, 74), by(paper(path.k), 0, 74), INK, 2.0)
    drawing.text(by(origin, 0, 98), "tangential *k*: the same for all waves", INK, 13.5)
    drawing.arrow(paper(np.zeros(3)), paper(1.7 * OPTIC_AXIS), AXIS, 1.6)
    drawing.text(by(paper(1.7 * OPTIC_AXIS), 8, 8), "optic axis", AXIS, 14)
    drawing.dot(origin, 3.5)
    drawing.text(by(origin, -6, -10), "enters", INK, 13, "end")
    _scale(drawing, np.array((1030.0, 368.0)), unit)


def _words(drawing: Drawing, path: Trace) -> None:
    """Write what the two views show."""
    sideways = np.rad2deg(np.arctan2(-path.ray[1], path.ray[0]))
    drawing.text((605, 436), "Which plane, which angle", size=18)
    drawing.lines(
        (605, 472),
        (
            f"Calcite, *n*_{{o}} {N_O}, *n*_{{e}} {N_E}; the optic axis stands 45° from the normal",
            "and 30° out of the plane of incidence. Drawn is the extraordinary wave.",
            "",
            f"Its *k* = {_told(path.k)} stays in the plane of incidence.",
            f"Its ray, {_told(path.ray)}, does not: seen from above",
            f"it is {sideways:.2f}° off.",
            "",
            "The exit has the tangential part of *k*, so it lies in the plane of *k* and the",
            f"normal: {_told(path.outside)}, parallel to the light that came.",
            "Followed backward it comes out where the light came in.",
            "",
            "Snell's law with the ray's angle, in the plane of the ray and the normal, gives",
            f"{_told(path.by_paper)}: wrong by {path.error_deg():.2f}°, at either end.",
        ),
        INK,
        13.5,
    )


def _told(v: Real) -> str:
    return "(" + ", ".join(f"{x:.4f}".replace("-", "−") for x in v) + ")"


def _scale(drawing: Drawing, at: Real, unit: float) -> None:
    drawing.line((at, by(at, unit, 0)), QUIET, 2.4)
    drawing.text(by(at, unit / 2, -7), "1 mm", QUIET, 12, "middle")


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES
    picture().save(folder / "backward-rays.svg")
