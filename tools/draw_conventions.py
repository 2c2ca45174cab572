"""Draw the pictures of docs/conventions.md: the frames, and the waves at a face.

    python tools/draw_conventions.py [FOLDER]

writes frames.svg and waves.svg, into docs/pictures if no folder is given. What can be computed is: the waves of the
second picture are those of `crystal_core.optics` for calcite.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from drawing import AXIS, CRYSTAL, EXTRAORDINARY, INK, LIGHT, ORDINARY, QUIET, Drawing, Isometry, by
from numpy.typing import ArrayLike, NDArray

import minerals_db
from crystal_core.geometry.boxes import box
from crystal_core.materials import SODIUM_D_NM, medium
from crystal_core.optics import Medium, scatter

VIEW_AZIMUTH_DEG = -72
"""From where the reader sees the world: a little from the right of the camera."""

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"

Real = NDArray[np.float64]


def frames() -> Drawing:
    """Return the picture of the four frames."""
    drawing = Drawing(
        1160,
        1010,
        "The frames of Isogyre",
        "Four panels: world, stage and camera; the picture and the analyser; the frame of an interface; coherency.",
    )
    drawing.line(((580, 30), (580, 980)), "#e2e2dc", 1)
    drawing.line(((30, 540), (1130, 540)), "#e2e2dc", 1)
    _world(drawing)
    _picture(drawing, np.array((620.0, 50.0)))
    _interface(drawing, np.array((285.0, 775.0)))
    _polarization(drawing, np.array((620.0, 570.0)))
    return drawing


def _world(drawing: Drawing) -> None:
    """Draw the page, the block on the stage, optic axis, camera."""
    drawing.text((40, 50), "World, stage, camera", size=18)
    view = Isometry((262, 385), 8.6, VIEW_AZIMUTH_DEG, 27)
    stage_deg, tilt_deg = 30.0, 44.64
    cos, sin = np.cos(np.deg2rad(stage_deg)), np.sin(np.deg2rad(stage_deg))
    turn = np.array(((cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)))
    page = np.array(((-20, -15, 0), (20, -15, 0), (20, 15, 0), (-20, 15, 0)), float)
    drawing.area(view(page), "#f3f2ec", "#b9b8ae", 1.2)
    for y in (-9, -3, 3, 9):
        drawing.line(view(((-20, y, 0), (20, y, 0))), "#dedcd2", 1)
    drawing.text(view((-19.3, -14.2, 0)), "page, *z* = 0", QUIET, 13)

    body = box((15, 15, 9.5)).body.transformed(turn, np.array((0, 0, 6.2)))
    azimuth = np.deg2rad(VIEW_AZIMUTH_DEG)
    towards = np.array((np.cos(azimuth), np.sin(azimuth), 0.5))
    for front in (False, True):
        for normal, ring in zip(body.normals, body.faces, strict=True):
            if (normal @ towards > 0) == front:
                corners = body.vertices[list(ring)]
                drawing.area(view(corners), CRYSTAL, ORDINARY if front else "#9fc4c4", 1.2, 0.55 if front else 0.5)

    # The stage angle, from the world's x to the block's own.
    own = turn @ np.array((1.0, 0, 0))
    drawing.line(view((np.zeros(3), 19.0 * own)), QUIET, 1.2, dashed=True)
    sweep = np.deg2rad(np.linspace(0, stage_deg, 30))
    drawing.arc(view(np.stack((16.5 * np.cos(sweep), 16.5 * np.sin(sweep), 0 * sweep), axis=-1)), QUIET)
    drawing.text(by(view((17.0 * np.cos(0.2), 17.0 * np.sin(0.2), 0)), 6, 4), "stage angle", QUIET, 13)

    for axis, label, shift in (((24, 0, 0), "*x*", (6, 8)), ((0, 19, 0), "*y*", (6, 2)), ((0, 0, 23), "*z*", (-18, 4))):
        drawing.arrow(view((0, 0, 0)), view(axis), INK, 1.8)
        drawing.text(view(axis) + shift, label, size=17)

    centre = np.array((0, 0, 6.2))
    tilt = np.deg2rad(tilt_deg)
    c = np.array((np.sin(tilt), 0, np.cos(tilt)))
    drawing.arrow(view(centre - 9 * turn @ c), view(centre + 17 * turn @ c), AXIS, 2.4)
    drawing.text(by(view(centre + 17 * turn @ c), 8, 4), "optic axis *c*", AXIS, 15)
    lean = np.linspace(0, tilt, 25)
    spokes = np.stack((np.sin(lean), 0 * lean, np.cos(lean)), axis=-1) @ turn.T
    drawing.arc(view(centre + 11.5 * spokes), AXIS, 1.4, head=False)
    drawing.text(by(view(centre + 13.0 * spokes[12]), -6, 2), "tilt", AXIS, 13)

    # The camera, far nearer than it stands.
    lean_deg = 22.0
    f = -np.array((0, -np.sin(np.deg2rad(lean_deg)), np.cos(np.deg2rad(lean_deg))))
    r = np.array((1.0, 0, 0))
    u = np.cross(r, f)
    eye = centre - 35 * f
    drawing.line(view((eye, centre)), LIGHT, 1.2, dashed=True)
    for vector, label, shift in ((r, "*r*", (7, 6)), (u, "*u*", (-5, -8)), (f, "*f*", (-17, 8))):
        drawing.arrow(view(eye), view(eye + 7.0 * vector), LIGHT, 2.2)
        drawing.text(view(eye + 7.0 * vector) + shift, label, LIGHT, 17)
    drawing.dot(view(eye), 4, LIGHT)
    drawing.text(by(view(eye), -10, 4), "eye", LIGHT, 14, "end")
    drawing.lines(
        (40, 500),
        (
            "The stage turns body, lattice and indicatrix together,",
            "counter-clockwise seen from +*z*. The camera stands far nearer here than it does.",
        ),
        QUIET,
        12.5,
    )


def _picture(drawing: Drawing, at: Real) -> None:
    """Draw the pixels, and the analyser's direction."""
    drawing.text(at, "Picture and analyser", size=18)
    left, top, cell, across, down = at[0] + 60, at[1] + 62, 42, 8, 7
    drawing.area(_rectangle(left, top, cell * across, cell * down), "#f6f5f0", "#b9b8ae", 1.4)
    for i in range(1, across):
        drawing.line(((left + i * cell, top), (left + i * cell, top + down * cell)), "#e4e2d9", 1)
    for j in range(1, down):
        drawing.line(((left, top + j * cell), (left + across * cell, top + j * cell)), "#e4e2d9", 1)
    drawing.area(_rectangle(left, top, cell, cell), "#f0dfbd", LIGHT, 1.4)
    drawing.dot((left + cell / 2, top + cell / 2), 2.6, LIGHT)
    drawing.text((left + cell + 6, top + 26), "pixel (0, 0)", LIGHT, 13.5)
    drawing.arrow((left, top - 16), (left + 96, top - 16), QUIET, 1.6)
    drawing.text((left + 104, top - 11), "*i*, columns", QUIET, 14)
    drawing.arrow((left - 18, top), (left - 18, top + 96), QUIET, 1.6)
    drawing.text((left - 22, top + 116), "*j*, rows", QUIET, 14, "middle")

    centre = np.array((left + cell * across / 2, top + cell * down / 2))
    angle = np.deg2rad(35)
    along = np.array((np.cos(angle), -np.sin(angle)))
    drawing.arrow(centre, by(centre, 118, 0), INK, 1.8)
    drawing.text(by(centre, 126, 5), "*r*", size=17)
    drawing.arrow(centre, by(centre, 0, -118), INK, 1.8)
    drawing.text(by(centre, 9, -108), "*u*", size=17)
    drawing.line((centre - 118 * along, centre + 118 * along), LIGHT, 3)
    drawing.text(centre + 122 * along + (2, -4), "analyser", LIGHT, 14)
    sweep = np.linspace(0, angle, 25)
    drawing.arc(centre + 66 * np.stack((np.cos(sweep), -np.sin(sweep)), axis=-1), LIGHT)
    drawing.text(by(centre, 74, -16), "*α*", LIGHT, 17)
    drawing.lines(
        (at[0], top + cell * down + 42),
        (
            "The centre of pixel (*i*, *j*) of a *W* × *H* picture looks along",
            "*f* + tan(vfov/2) · [(2(*i*+½)/*W* − 1) · *W*/*H* · *r* + (1 − 2(*j*+½)/*H*) · *u*].",
            "The analyser passes the field along cos *α* *r* + sin *α* *u*,",
            "made transverse to the ray.",
        ),
        QUIET,
        12.5,
    )


def _interface(drawing: Drawing, origin: Real) -> None:
    """Draw the frame of an interface with the three kinds of waves, z downward on the paper."""
    drawing.text((40, 590), "Interface and plane of incidence", size=18)
    drawing.area(_rectangle(origin[0] - 245, origin[1], 490, 190), CRYSTAL)
    drawing.line((by(origin, -245, 0), by(origin, 245, 0)), ORDINARY, 1.6)
    drawing.text(by(origin, -240, -10), "source", QUIET, 13)
    drawing.text(by(origin, -240, 22), "target", QUIET, 13)

    drawing.arrow(origin, by(origin, 150, 0), INK, 1.8)
    drawing.text(by(origin, 156, -8), "*x* ∥ tangential *k*", size=14)
    drawing.arrow(origin, by(origin, 0, 165), INK, 1.8)
    drawing.text(by(origin, 10, 172), "*z*, normal from source into target", size=14)
    drawing.towards_reader(origin, INK, 8)
    drawing.text(by(origin, -14, 26), "*y* = *z* × *x*", size=14, anchor="end")

    inside = np.arcsin(np.sin(np.deg2rad(52)) / 1.6)
    for direction_deg, tail, colour, label in (
        (52.0, True, LIGHT, "incident"),
        (180.0 - 52.0, False, QUIET, "reflected"),
        (np.rad2deg(inside), False, ORDINARY, "transmitted"),
    ):
        a = np.deg2rad(direction_deg)
        k = np.array((np.sin(a), np.cos(a)))  # on the paper z points down
        p = np.array((np.cos(a), -np.sin(a)))
        length = 168.0
        start, end = (origin - length * k, origin - 12 * k) if tail else (origin + 12 * k, origin + length * k)
        drawing.arrow(start, end, colour, 2.2)
        foot = origin + (-0.62 if tail else 0.66) * length * k
        drawing.arrow(foot, foot + 46 * p, colour, 1.8)
        drawing.text(foot + 58 * p + (0, 5), "*p*", colour, 16, "middle")
        drawing.towards_reader(foot, colour)
        drawing.text(foot - 17 * p + (0, 5), "*s*", colour, 16, "middle")
        far = start if tail else end
        drawing.text(
            far + ((-8, -2) if tail else (8, -2) if far[1] < origin[1] else (10, -6)),
            label,
            colour,
            13.5,
            "end" if tail else "start",
        )


def _polarization(drawing: Drawing, at: Real) -> None:
    """Draw the coherency frame and the signs of Stokes's parameters."""
    drawing.text(by(at, 0, 20), "Coherency and Stokes parameters", size=18)
    drawing.text(by(at, 0, 48), "seen by an observer who faces the source: light comes out of the paper", QUIET, 13)
    centre = by(at, 130, 220)
    drawing.arrow(by(centre, -110, 0), by(centre, 125, 0), INK, 1.8)
    drawing.text(by(centre, 131, 5), "*x*", size=17)
    drawing.arrow(by(centre, 0, 110), by(centre, 0, -125), INK, 1.8)
    drawing.text(by(centre, 8, -120), "*y*", size=17)
    turn = np.linspace(0.3, 2 * np.pi + 0.12, 90)
    field = np.stack((96 * np.cos(turn), -96 * np.sin(turn)), axis=-1)
    drawing.arc(centre + field, EXTRAORDINARY, 2.2)
    drawing.towards_reader(centre, INK, 9)
    drawing.text(by(centre, 11, 26), "propagation", INK, 12)
    drawing.text(by(centre, 74, -78), "*E* = (1, *i*)", EXTRAORDINARY, 15)

    column = by(at, 300, 112)
    shapes = (
        ("*S*_{1} > 0", "*E* along *x*", np.array(((-1, 0), (1, 0)))),
        ("*S*_{2} > 0", "*E* along *x* + *y*", np.array(((-0.7, 0.7), (0.7, -0.7)))),
        ("*S*_{3} > 0", "counter-clockwise", None),
    )
    for number, (sign, meaning, shape) in enumerate(shapes):
        middle = by(column, 26, 72 * number + 8)
        drawing.line((by(middle, -28, 0), by(middle, 28, 0)), "#d5d3c9", 1)
        drawing.line((by(middle, 0, -28), by(middle, 0, 28)), "#d5d3c9", 1)
        if shape is None:
            drawing.arc(middle + field * (24 / 96), EXTRAORDINARY, 2.0)
        else:
            drawing.line(middle + 26 * shape, EXTRAORDINARY, 2.6)
        drawing.text(by(middle, 46, -1), sign, size=15)
        drawing.text(by(middle, 46, 19), meaning, QUIET, 12.5)
    drawing.lines(
        by(at, 0, 366),
        (
            "Fields vary as exp(*i*(*k*·*r* − *ωt*)), *C* = ⟨*E* *E*^{†}⟩;",
            "(*x*, *y*, propagation) is right-handed:",
            "*S*_{0} = *C*_{xx} + *C*_{yy},  *S*_{1} = *C*_{xx} − *C*_{yy},  "
            "*S*_{2} = 2 Re *C*_{xy},  *S*_{3} = −2 Im *C*_{xy}.",
        ),
        QUIET,
        12.5,
    )


def waves() -> Drawing:
    """Return the picture of the four waves of calcite at a face, by their wave vectors and rays."""
    drawing = Drawing(
        1160,
        600,
        "Waves at a face of calcite",
        "Section through the wave vector surfaces of air and calcite with the waves of one tangential wave vector.",
    )
    turned, kappa = np.deg2rad(-35.0), 0.7
    sin, cos = np.sin(turned), np.cos(turned)
    rotation = np.array(((cos, 0.0, sin), (0.0, 1.0, 0.0), (-sin, 0.0, cos)))
    axis = rotation[:, 2]
    calcite = medium(minerals_db.mineral("calcite"), SODIUM_D_NM, rotation)
    event = scatter((0.0, 0.0, 1.0), np.array(((kappa,), (0.0,), (0.0,))), Medium.isotropic(1.0), calcite)
    n_o, n_e = (float(n) for n in calcite.indices)
    origin, unit = np.array((345.0, 215.0)), 165.0

    def paper(v: ArrayLike) -> Real:
        """Return the paper's point of a wave vector, shape (3,) or (N, 3), z down."""
        flat = np.asarray(v, float)[..., [0, 2]]
        point: Real = origin + unit * flat
        return point

    drawing.area(_rectangle(40, origin[1], 610, 345), CRYSTAL)
    drawing.line(((40, origin[1]), (650, origin[1])), ORDINARY, 1.6)
    drawing.text((44, origin[1] - 12), "air", QUIET, 14)
    drawing.text((636, origin[1] + 24), "calcite", QUIET, 14, "end")

    turn = np.linspace(0, np.pi, 181)
    circle = np.stack((np.cos(turn), 0 * turn, np.sin(turn)), axis=-1)
    drawing.line(paper(circle * (1, 1, -1)), QUIET, 1.4)
    drawing.line(paper(n_o * circle), ORDINARY, 1.6)
    eps = n_o**2 * np.eye(3) + (n_e**2 - n_o**2) * np.outer(axis, axis)
    length = n_o * n_e / np.sqrt(np.einsum("ni,ij,nj->n", circle, eps, circle))
    drawing.line(paper(length[:, None] * circle), EXTRAORDINARY, 1.6)
    drawing.line((paper((kappa, 0, -1.05)), paper((kappa, 0, 1.72))), QUIET, 1.2, dashed=True)
    drawing.text(by(paper((kappa, 0, -1.05)), 8, 6), "the same *κ* for all waves", QUIET, 13.5)
    drawing.arrow(paper((0, 0, 0)), paper(1.95 * axis), AXIS, 2.0)
    drawing.text(by(paper(1.95 * axis), -10, 2), "optic axis *c*", AXIS, 15, "end")

    drawing.arrow(paper((0, 0, 0)), paper((kappa, 0, 0)), INK, 1.8)
    drawing.text(by(paper((0.5 * kappa, 0, 0)), 4, -9), "*κ*", INK, 16, "middle")

    incident, (ordinary, extraordinary) = event.incident[0], event.transmitted
    k_in = incident.k[:, 0]
    drawing.arrow(paper(-k_in), paper((0, 0, 0)), LIGHT, 2.4)
    drawing.text(by(paper(-k_in), -6, -8), "incident *k*", LIGHT, 15, "end")
    for wave, colour, at_k, at_ray in (
        (ordinary, ORDINARY, "", "*k*_{o} ∥ ray_{o}"),
        (extraordinary, EXTRAORDINARY, "*k*_{e}", "ray_{e}"),
    ):
        k, tip = paper(wave.k[:, 0]), paper(wave.k[:, 0] + 0.5 * wave.ray[:, 0])
        drawing.arrow(paper((0, 0, 0)), k, colour, 2.4)
        drawing.arrow(k, tip, colour, 2.0, dashed=True)
        drawing.text(by(k, 12, 2), at_k, colour, 16)
        drawing.text(by(tip, 8, 6), at_ray, colour, 16)
    walk_off = np.rad2deg(np.arccos(np.sum(extraordinary.k[:, 0] * extraordinary.ray[:, 0]) / extraordinary.index[0]))

    drawing.text((705, 58), "Refraction belongs to *k*, energy to the ray", size=18)
    drawing.lines(
        (705, 98),
        (
            "Section through the surfaces on which wave vectors end,",
            f"calcite at {SODIUM_D_NM} nm: air |*k*| = 1, ordinary |*k*| = {n_o:.4f},",
            "extraordinary *k*·*ε*·*k* = *ε*_{o}*ε*_{e}:",
            f"from {n_e:.4f} across *c* to {n_o:.4f} along it.",
            "",
            f"The tangential part *κ* = {kappa} of *k* goes through the face",
            "unchanged; it is all that refraction needs. Of the two points",
            "where the dashed line cuts a surface, the transmitted wave",
            "is the one whose ray goes away from the face.",
            "",
            "The ray is the outward normal of the surface: along *k* for",
            "the ordinary wave, along *ε**k* for the extraordinary. They",
            f"differ here by a walk-off of {walk_off:.2f}°. Specimens are",
            "crossed along rays.",
        ),
        INK,
        14,
    )
    drawing.lines(
        (705, 450),
        (
            "ordinary:   *E* = *m*,   *H* = *k* × *m*,   ray ∥ *k*",
            "extraordinary:   *H* = *m*,   *E* = *ε*^{−1}(−*k* × *m*),   ray ∥ *ε**k*",
            "with *m* = *k* × *c*.",
        ),
        QUIET,
        14,
    )
    return drawing


def _rectangle(x: float, y: float, width: float, height: float) -> Real:
    return np.array(((x, y), (x + width, y), (x + width, y + height), (x, y + height)))


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES
    frames().save(folder / "frames.svg")
    waves().save(folder / "waves.svg")
