"""Draw the picture of docs/conventions.md of biaxial media: indicatrix, index surface, vibrations, absorption surface.

    python tools/draw_indicatrix.py [FOLDER]

writes indicatrix.svg, into docs/pictures if no folder is given. All curves and directions are computed by
`crystal_core.optics`; in three panels for a medium whose indices lie further apart than those of any mineral, so that
the eye can tell them.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from drawing import AXIS, EXTRAORDINARY, INK, LIGHT, ORDINARY, QUIET, Drawing, Isometry, by
from numpy.typing import NDArray

from crystal_core.optics import Medium, scatter
from crystal_core.optics.directions import waves_along
from crystal_core.optics.indicatrix import BiaxialIndicatrix, dissipation

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"

INDICES = (1.2, 1.42, 2.2)
MEDIUM = Medium.biaxial(INDICES, np.eye(3))
"""α along x, β along y, γ along z."""

SLOW, FAST = ORDINARY, EXTRAORDINARY

Real = NDArray[np.float64]


def picture() -> Drawing:
    """Return the picture of four panels."""
    drawing = Drawing(
        1160,
        1060,
        "Biaxial media",
        "Four panels: the indicatrix with its optic axes; a section of the index surface; vibrations; absorption.",
    )
    drawing.line(((580, 30), (580, 1030)), "#e2e2dc", 1)
    drawing.line(((30, 540), (1130, 540)), "#e2e2dc", 1)
    _indicatrix(drawing)
    _sheets(drawing, np.array((620.0, 0.0)))
    _vibrations(drawing, np.array((40.0, 550.0)))
    _absorption(drawing, np.array((620.0, 550.0)))
    return drawing


def _circle(count: int = 181) -> tuple[Real, Real]:
    turn = np.linspace(0.0, 2.0 * np.pi, count)
    return np.cos(turn), np.sin(turn)


def _indicatrix(drawing: Drawing) -> None:
    """Draw the ellipsoid by its principal sections and its circular ones, with the optic axes."""
    drawing.text((40, 50), "Indicatrix and optic axes", size=18)
    indicatrix = BiaxialIndicatrix.of(MEDIUM)
    view = Isometry((290, 285), 76, -62, 17)
    cos, sin = _circle()
    lengths = np.array(INDICES)
    for first, second in ((0, 1), (0, 2), (1, 2)):
        ring = np.zeros((len(cos), 3))
        ring[:, first], ring[:, second] = lengths[first] * cos, lengths[second] * sin
        drawing.line(view(ring), "#7d8a8b", 1.2)
    axes = [np.asarray(axis) for axis in indicatrix.optic_axes()]
    for axis, name, shift in zip(axes, ("*o*_{1}", "*o*_{2}"), ((8, 4), (-22, -4)), strict=True):
        across = np.cross(axis, (0.0, 1.0, 0.0))
        section = INDICES[1] * (cos[:, None] * across + sin[:, None] * np.array((0.0, 1.0, 0.0)))
        drawing.area(view(section), "#efe9f6", AXIS, 1.3, 0.5)
        drawing.arrow(view(np.zeros(3)), view(2.35 * axis), AXIS, 2.4)
        drawing.text(by(view(2.35 * axis), *shift), name, AXIS, 16)
    for i, (name, shift) in enumerate((("*α*", (8, 12)), ("*β*", (8, 4)), ("*γ*", (8, 2)))):
        end = np.zeros(3)
        end[i] = 1.25 * lengths[i]
        drawing.arrow(view(np.zeros(3)), view(end), INK, 1.8)
        drawing.text(by(view(end), *shift), name, INK, 17)
    sweep = np.linspace(0.0, float(indicatrix.v_z), 25)
    for side in (1.0, -1.0):
        drawing.arc(view(1.05 * np.stack((side * np.sin(sweep), 0 * sweep, np.cos(sweep)), axis=-1)), AXIS, head=False)
    drawing.text(by(view((0.5, 0.0, 1.05)), 2, -2), "*V*_{z}", AXIS, 15)
    drawing.lines(
        (40, 490),
        (
            "Semi-axes *n*_{α} ≤ *n*_{β} ≤ *n*_{γ}; the sections across *o*_{1} and *o*_{2} are circles.",
            f"Here {INDICES[0]}, {INDICES[1]}, {INDICES[2]}: *V*_{{z}} = {np.rad2deg(indicatrix.v_z):.1f}°, "
            f"2*V* = {np.rad2deg(indicatrix.two_v()):.1f}°, {'positive' if indicatrix.is_positive() else 'negative'}.",
        ),
        QUIET,
        12.5,
    )


def _sheets(drawing: Drawing, at: Real) -> None:
    """Draw the section of the index surface with α and γ, and a line through the dimple at an optic axis."""
    drawing.text(by(at, 0, 50), "Index surface, section with *α* and *γ*", size=18)
    unit, origin = 178.0, by(at, 60, 420)

    def paper(v: Real) -> Real:
        return np.asarray(origin + unit * np.stack((v[..., 0], -v[..., 2]), axis=-1))

    turn = np.linspace(0.0, 0.5 * np.pi, 241)
    s = np.stack((np.sin(turn), 0 * turn, np.cos(turn)))
    slow, fast = waves_along(MEDIUM, s)
    drawing.line(paper(slow.k.T), SLOW, 2.0)
    drawing.line(paper(fast.k.T), FAST, 2.0)
    for end, name, shift in (((2.42, 0, 0), "*α*", (8, 5)), ((0, 0, 1.92), "*γ*", (8, 8))):
        drawing.arrow(origin, paper(np.array(end)), INK, 1.6)
        drawing.text(by(paper(np.array(end)), *shift), name, INK, 17)
    axis = np.asarray(BiaxialIndicatrix.of(MEDIUM).optic_axes()[0])
    drawing.arrow(origin, paper(1.95 * axis), AXIS, 2.2)
    drawing.text(by(paper(1.95 * axis), 8, 2), "*o*_{1}", AXIS, 16)
    drawing.text(by(paper(slow.k[:, 215]), 8, -2), "slow", SLOW, 14)
    drawing.text(by(paper(fast.k[:, 215]), -8, 4), "fast", FAST, 14, "end")

    # The common tangent of both curves is across the biradial m. A line a little nearer passes through the dimple: all
    # four waves of a face with that normal are on the outer sheet.
    alpha, beta, gamma = INDICES
    m = np.sqrt(np.array((beta**2 - alpha**2, 0.0, gamma**2 - beta**2)) / (gamma**2 - alpha**2))
    tangential = (beta - 0.016) * m
    normal = np.array((m[2], 0.0, -m[0]))
    event = scatter(normal, tangential[:, None], MEDIUM, Medium.isotropic(1.0))
    drawing.line(paper(np.stack((tangential - 0.8 * normal, tangential + 1.45 * normal))), QUIET, 1.2, dashed=True)
    drawing.text(by(paper(tangential + 1.45 * normal), 8, 4), "normal of a face", QUIET, 13)
    for wave in (*event.incident, *event.reflected):
        k, ray = wave.k[:, 0], wave.ray[:, 0]
        drawing.arrow(paper(k), paper(k + 0.3 * ray), LIGHT, 1.8)
        drawing.dot(paper(k), 3.4)
        way, below = np.sign(ray @ normal) * normal, k - 0.1 * m
        drawing.arrow(paper(below - 0.07 * way), paper(below + 0.09 * way), INK, 1.4)
    drawing.lines(
        by(at, 0, 490),
        (
            "The sheets touch on the optic axes, at the bottom of a dimple. A normal through it",
            "meets the outer sheet four times; along it the rays (yellow) go to and fro by turns.",
        ),
        QUIET,
        12.5,
    )


def _vibrations(drawing: Drawing, at: Real) -> None:
    """Draw what one sees who faces a wave: the directions u and the vibrations that halve their angles."""
    drawing.text(by(at, 0, 30), "Vibrations of the two waves of a wave normal", size=18)
    drawing.text(by(at, 0, 56), "seen against the wave normal *s*, which comes out of the paper", QUIET, 13)
    s = np.array((0.31, -0.42, 0.0))
    s[2] = np.sqrt(1.0 - s @ s)
    slow, fast = waves_along(MEDIUM, s[:, None])
    right = np.cross((0.0, 1.0, 0.0), s)
    right /= np.linalg.norm(right)
    up = np.cross(s, right)
    centre, unit = by(at, 240, 245), 150.0

    def flat(v: Real) -> Real:
        return np.array((v @ right, -(v @ up)))

    for axis, name in zip(BiaxialIndicatrix.of(MEDIUM).optic_axes(), ("1", "2"), strict=True):
        seen = flat(np.asarray(axis))
        along = seen / np.linalg.norm(seen)
        drawing.line((centre - 1.02 * unit * along, centre + 1.02 * unit * along), AXIS, 1.2, dashed=True)
        drawing.dot(centre + unit * seen, 4, AXIS)
        drawing.text(by(centre + unit * seen, 9, 5), f"*o*_{{{name}}}", AXIS, 16)
        u = np.cross(s, axis)
        u = flat(u / np.linalg.norm(u))
        drawing.arrow(centre, centre + 0.72 * unit * u, INK, 1.8)
        drawing.text(by(centre + 0.80 * unit * u, -6, 6), f"*u*_{{{name}}}", INK, 16)
    for wave, colour, name in ((slow, SLOW, "*D* slow"), (fast, FAST, "*D* fast")):
        d = flat(wave.d[:, 0] / np.linalg.norm(wave.d[:, 0]))
        d = d if d[0] > 0 else -d
        drawing.line((centre - 1.1 * unit * d, centre + 1.1 * unit * d), colour, 3.0)
        drawing.text(by(centre + 1.1 * unit * d, 9, 5), name, colour, 15)
    drawing.towards_reader(centre, INK, 8)
    drawing.text(by(centre, 10, 26), "*s*", INK, 16)
    drawing.lines(
        by(at, 0, 430),
        (
            "Dashed: the planes through *s* and each optic axis. *u*_{i} ∥ *s* × *o*_{i} stands across them.",
            "*D* of the fast wave halves the angle of *u*_{1} and *u*_{2}, *D* of the slow wave is across it.",
        ),
        QUIET,
        12.5,
    )


def _absorption(drawing: Drawing, at: Real) -> None:
    """Draw the section of an indicatrix with the absorption surface on a frame of its own."""
    drawing.text(by(at, 0, 30), "Absorption surface on its own frame", size=18)
    drawing.text(
        by(at, 0, 56), "a section across *β* of a monoclinic crystal; *a* of waves that vibrate there", QUIET, 13
    )
    turn = np.deg2rad(28.0)
    u = np.array(((np.cos(turn), 0.0, np.sin(turn)), (0.0, 1.0, 0.0), (-np.sin(turn), 0.0, np.cos(turn))))
    # Indices of an ordinary mineral: with the exaggerated ones a wave's E and D would point elsewhere.
    medium = Medium.biaxial((1.60, 1.62, 1.65), np.eye(3)).absorbing((0.35, 1.0, 1.5), u)
    tensor = dissipation(medium)
    centre, unit = by(at, 230, 245), 100.0

    def paper(v: Real) -> Real:
        return np.asarray(centre + unit * np.stack((v[..., 0], -v[..., 2]), axis=-1))

    cos, sin = _circle()
    e = np.stack((cos, 0 * cos, sin), axis=-1)
    absorbed = np.einsum("ni,ij,nj->n", e, tensor, e) / 1.62
    drawing.area(paper(absorbed[:, None] * e), "#f6ead2", LIGHT, 1.8, 0.7)
    drawing.line(paper(np.stack((1.15 * cos, 0 * cos, 1.38 * sin), axis=-1)), "#7d8a8b", 1.2)
    for end, name, shift in (
        (1.5 * np.array((1.0, 0, 0)), "*α*", (6, 5)),
        (1.72 * np.array((0, 0, 1.0)), "*γ*", (-18, 4)),
    ):
        drawing.arrow(centre, paper(end), INK, 1.6)
        drawing.text(by(paper(end), *shift), name, INK, 17)
    for axis, name, shift in ((u[0], "*u*_{1}, *a*_{1}", (8, 2)), (u[2], "*u*_{3}, *a*_{3}", (-10, -4))):
        drawing.arrow(centre, paper(1.75 * axis), LIGHT, 2.2)
        drawing.text(by(paper(1.75 * axis), *shift), name, LIGHT, 16, "start" if shift[0] > 0 else "end")
    drawing.text(by(paper(np.array((1.0, 0.0, -1.05))), 16, 22), "indicatrix", "#566263", 13.5)
    drawing.lines(
        by(at, 0, 430),
        (
            "*k*_{0}*ε*″ = Σ *n*(*u*_{i}) *a*_{i} *u*_{i}*u*_{i}^{T},   *n*(*u*) = (*u*·*ε*′^{−1}·*u*)^{−1/2}.",
            "A wave that vibrates along *u*_{i} is absorbed by *a*_{i}, where the frames agree.",
        ),
        QUIET,
        12.5,
    )


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES
    picture().save(folder / "indicatrix.svg")
