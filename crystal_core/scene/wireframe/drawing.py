"""A scene drawn in lines, as crystals are drawn: what is in front solid, what is behind in thin dashes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import Body
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.scene.staged.body import NOBODY, StagedBody
from crystal_core.scene.staged.stage import StagedDocument
from crystal_core.scene.wireframe.directions import cell_axes, indicatrix_section, optic_axes
from crystal_core.scene.wireframe.edges import body_lines, front_faces
from crystal_core.scene.wireframe.hidden import Hider, behind_itself, pieces
from crystal_core.scene.wireframe.lens import Lens, View, camera_lens, fitted_lens
from crystal_core.scene.wireframe.paper import ACCENT, FAINT, INK, OVERLINE, Paper, Style
from crystal_core.scene.wireframe.symbols import (
    draw_analyser,
    draw_camera,
    draw_light,
    draw_sheet,
    draw_surface,
    outline,
)

__all__ = ["wireframe"]

Real = NDArray[np.float64]

FRONT = Style("front", 1.5)
FRONT_SMALL = Style("front", 0.7)
BACK = Style("back", 0.7, "#555", "4 3")
AXIS_INSIDE = Style("axis-inside", 0.7, INK, "9 2.5 1.5 2.5")
AXIS = Style("axis", 0.8)
OPTIC_AXIS_INSIDE = Style("optic-axis-inside", 0.9, ACCENT, "9 2.5 1.5 2.5")
OPTIC_AXIS = Style("optic-axis", 1.1, ACCENT)
SECTION = Style("indicatrix", 1.1, ACCENT)

MANY_CRYSTALS = 6
"""Of more crystals neither axes nor names are drawn: nobody could read them."""

BEYOND = 0.3
"""How far axes stand out of their body, in its radii."""

SMALL = 45.0
"""A body of a smaller radius on the sheet is drawn in thin lines, without what is behind."""

SECTION_PART = 0.45
"""Radius of a section of the indicatrix, of that of its body."""

GROUND = 0.9
"""A surface whose normal is so near to the vertical lies below the things that are shown: it may be cut off."""

NEAR, FAR_BEAMS = 1.3, 4.0
"""A straight view makes room for lights and the camera within so many radii of the rest, for beams and areas within
the second."""


def wireframe(scene: StagedDocument, view: View = "camera", *, indicatrix: bool = False) -> str:
    """Return a schematic drawing of a scene, without light transport.

    Front edges are solid, those behind in thin dashes; round bodies show their outline. Axes of the cell start at a
    body's centre, optic axes go through it, both in dash and dot inside. Names, lights, polarizer directions and a
    scale bar are there; endless surfaces and the sky are not.

    Parameters
    ----------
    scene : StagedDocument
        At the frame to be drawn.
    view : str
        "camera": as the scene's camera sees it, the sheet as wide as high as its picture; "plan" from above, "front"
        from −y, "side" from +x: parallel lines of sight, all of the scene.
    indicatrix : bool
        Whether to draw each crystal's section of the indicatrix across the line of sight at 589.3 nm.

    Returns
    -------
    str
        SVG, the same bytes for the same scene.
    """
    lens = camera_lens(scene.camera, scene.document.render.size_px) if view == "camera" else _straight(scene, view)
    paper = Paper(lens.width, lens.height)
    hiders = [Hider(body.solid.body, lens) for body in scene.bodies]
    for surface in scene.surfaces:
        draw_surface(paper, lens, surface, hiders)
    for sheet in scene.sheets:
        draw_sheet(paper, lens, sheet, hiders)
    for number, body in enumerate(scene.bodies):
        _draw_body(paper, lens, body, _others(scene.bodies, hiders, number))
    crystals = _crystals(scene)
    for body, way, arm in _arms(scene, crystals):
        _draw_arm(paper, lens, body, way, arm, hiders)
    exaggerations = set()
    if indicatrix:
        for body in crystals:
            exaggerations |= set(_draw_section(paper, lens, scene, body))
    middle = _middle(scene)
    for light in scene.lights:
        draw_light(paper, lens, light, scene, middle)
    if view == "camera":
        draw_analyser(paper, scene.camera)
    else:
        draw_camera(paper, lens, scene.camera, middle)
    if len(scene.bodies) <= MANY_CRYSTALS:
        _name_bodies(paper, lens, scene)
    return paper.svg(
        _title(scene), _caption(scene, view, exaggerations), _scale_bar(lens, middle, paper), framed=view == "camera"
    )


def _straight(scene: StagedDocument, view: View) -> Lens:
    """Return a lens that shows bodies, sheets and screens, and what is near them of grounds, lights and the camera."""
    planes = [surface.plane for surface in scene.surfaces if np.isfinite(surface.plane.width_mm)]
    things = [body.solid.body.vertices for body in scene.bodies]
    crystals = _crystals(scene)
    things += [_tip(body, way, BEYOND * _radius(body))[1][None] for body, way, _ in _arms(scene, crystals)]
    things += [outline(sheet.plane) for sheet in scene.sheets]
    things += [outline(plane) for plane in planes if abs(plane.normal[2]) < GROUND]
    if not things:
        things = [outline(plane) for plane in planes] or [scene.surfaces[0].plane.centre[None]]
    around = np.concatenate(things)
    middle = 0.5 * (around.min(axis=0) + around.max(axis=0))
    radius = max(float(np.linalg.norm(around - middle, axis=1).max()), 1.0)
    places = [(outline(light.plane), FAR_BEAMS) for light in scene.lights if light.plane is not None]
    places += [(light.place[None], NEAR) for light in scene.lights if light.position is not None]
    places.append((scene.camera.eye[None], NEAR))
    things += [place for place, far in places if np.linalg.norm(place - middle, axis=1).max() < far * radius]
    return fitted_lens(view, things)


def _others(bodies: Sequence[StagedBody], hiders: Sequence[Hider], number: int) -> list[Hider]:
    """Return what can hide a body: others before it, but not those that it is inside of, which are looked through."""
    around = {number}
    host = bodies[number].host
    while host != NOBODY:
        around.add(host)
        host = bodies[host].host
    own = hiders[number]
    return [hider for other, hider in enumerate(hiders) if other not in around and hider.may_hide(own)]


def _draw_body(paper: Paper, lens: Lens, body: StagedBody, hiders: Sequence[Hider]) -> None:
    shape = body.solid.body
    small = lens.units_per_mm(body.centre) * _radius(body) < SMALL
    front: list[tuple[Real, Real]] = []
    for line in body_lines(shape, lens):
        seen = lens.before_eye(line.start, line.end)
        if seen is None:
            continue
        for start, end, behind in _stretches(shape, lens, *seen, line.is_front, hiders):
            if behind is None:
                continue
            if not behind:
                front.append((start, end))
            elif not small:
                paper.line(BACK, lens.project(np.stack((start, end))))
    for start, end in front:
        paper.line(FRONT_SMALL if small else FRONT, lens.project(np.stack((start, end))))
    _name_faces(paper, lens, body)


def _stretches(
    shape: Body, lens: Lens, start: Real, end: Real, is_front: bool, hiders: Sequence[Hider]
) -> Iterator[tuple[Real, Real, bool | None]]:
    """Yield the parts of an edge: seen, hidden, or (None) hidden twice over, where nobody looks for it."""
    for a, b, behind in pieces(start, end, hiders):
        if isinstance(shape, Mesh) and is_front:
            for c, d, itself in behind_itself(shape, lens, a, b):
                yield c, d, None if behind and itself else behind or itself
        else:
            yield a, b, None if behind and not is_front else behind or not is_front


def _name_faces(paper: Paper, lens: Lens, body: StagedBody) -> None:
    """Write the Miller indices on the faces that are turned to the eye and have room for them."""
    solid = body.solid
    if not isinstance(solid.body, ConvexPolyhedron) or not any(solid.hkl):
        return
    turned = front_faces(solid.body, lens)
    for face, ring in enumerate(solid.body.faces):
        hkl = solid.hkl[face]
        if hkl is None or not turned[face]:
            continue
        corners = solid.body.vertices[list(ring)]
        if lens.is_pinhole and lens.depth(corners).min() <= 0.0:
            continue
        paper.within(_indices(hkl), lens.project(corners), size=10.0, colour=FAINT)


def _indices(hkl: tuple[int, int, int]) -> str:
    """Return Miller indices as they are printed: a bar over the negative ones."""
    return " ".join("".join(digit + OVERLINE for digit in str(-i)) if i < 0 else str(i) for i in hkl)


@dataclass(frozen=True)
class _Arm:
    """A line out of a body's centre: its name, None of one without, whether it is optical, whether it has a head."""

    name: str | None
    is_optical: bool
    has_head: bool


def _crystals(scene: StagedDocument) -> list[StagedBody]:
    """Return the bodies whose directions differ from each other."""
    return [
        body
        for body in scene.bodies
        if not scene.media[body.medium].is_isotropic or cell_axes(scene.media[body.medium])
    ]


def _arms(scene: StagedDocument, crystals: Sequence[StagedBody]) -> Iterator[tuple[StagedBody, Real, _Arm]]:
    """Yield the axes of the cells, in their positive directions, and both ways of the optic axes."""
    if len(crystals) > MANY_CRYSTALS:
        return
    for body in crystals:
        medium = scene.media[body.medium]
        prime = "′" if body.individual else ""
        optical = optic_axes(medium)
        shared = set()
        for name, way in cell_axes(medium):
            along = next((i for i, axis in enumerate(optical) if abs(float(axis @ way)) > 1.0 - 1e-6), None)
            if along is None:
                yield body, way, _Arm(name + prime, is_optical=False, has_head=True)
            else:
                shared.add(along)
                yield body, way, _Arm(f"{name}{prime} = optic axis", is_optical=True, has_head=True)
                yield body, -way, _Arm(None, is_optical=True, has_head=False)
        for number, axis in enumerate(optical):
            if number not in shared:
                which = "" if len(optical) == 1 else f" {number + 1}"
                yield body, axis, _Arm(f"optic axis{which}{prime}", is_optical=True, has_head=False)
                yield body, -axis, _Arm(None, is_optical=True, has_head=False)


def _tip(body: StagedBody, way: Real, beyond: float) -> tuple[Real, Real]:
    """Return where a line out of a body's centre comes to its surface, and where it ends beyond it."""
    start = body.solid.body.vertices.mean(axis=0)
    with np.errstate(over="ignore"):  # a face almost along the line is very far away
        leaves = float(body.solid.body.exit(start[:, None], way[:, None])[0][0])
    surface = start + (leaves if np.isfinite(leaves) else 0.0) * way
    return surface, surface + beyond * way


def _draw_arm(paper: Paper, lens: Lens, body: StagedBody, way: Real, arm: _Arm, hiders: Sequence[Hider]) -> None:
    """Draw a line from a body's centre out of it."""
    inside, outside = (OPTIC_AXIS_INSIDE, OPTIC_AXIS) if arm.is_optical else (AXIS_INSIDE, AXIS)
    surface, end = _tip(body, way, BEYOND * _radius(body))
    seen = lens.before_eye(body.solid.body.vertices.mean(axis=0), surface)
    if seen is not None:
        paper.line(inside, lens.project(np.stack(seen)))
    seen = lens.before_eye(surface, end)
    for a, b, behind in [] if seen is None else pieces(*seen, hiders):
        spots = lens.project(np.stack((a, b)))
        if behind:
            paper.line(inside, spots)
        elif arm.has_head and np.allclose(b, end):
            paper.arrow(outside, spots[0], spots[1], 6.0)
        else:
            paper.line(outside, spots)
    if arm.name is not None:
        _label_tip(paper, lens, body, end, arm.name, ACCENT if arm.is_optical else INK)


def _label_tip(paper: Paper, lens: Lens, body: StagedBody, tip: Real, text: str, colour: str) -> None:
    centre = body.solid.body.vertices.mean(axis=0)
    if lens.before_eye(tip, tip) is None or lens.before_eye(centre, centre) is None:
        return
    spots = lens.project(np.stack((centre, tip)))
    way = spots[1] - spots[0]
    length = float(np.hypot(*way))
    italic = "optic" not in text
    size = 14.0 if italic else 11.0
    if length < 4.0:  # the axis points to the eye
        paper.dot(Style("axis-end", 1.0, colour), spots[1], 2.5)
    paper.label(text, spots[1], size=size, colour=colour, italic=italic, away=way / length if length > 0 else None)


def _draw_section(paper: Paper, lens: Lens, scene: StagedDocument, body: StagedBody) -> Iterator[int]:
    """Draw the section of the indicatrix across the line of sight, and yield by how much it is exaggerated."""
    centre = body.solid.body.vertices.mean(axis=0)
    section = indicatrix_section(scene.media[body.medium], lens.towards_eye(centre[None])[0])
    if section is None or lens.before_eye(centre, centre) is None:
        return
    radius = SECTION_PART * _radius(body)
    semi = [radius * r * way for r, way in zip(section.radii, section.directions, strict=True)]
    angles = np.linspace(0.0, 2.0 * np.pi, 73)
    ring = centre + np.outer(np.cos(angles), semi[0]) + np.outer(np.sin(angles), semi[1])
    paper.line(SECTION, lens.project(ring))
    for half, n, name in zip(semi, section.indices, ("n₁", "n₂"), strict=True):
        spots = lens.project(np.stack((centre - half, centre + half)))
        paper.line(SECTION, spots)
        if spots[1][1] > spots[0][1]:
            spots = spots[::-1]
        way = (spots[1] - spots[0]) / max(float(np.hypot(*(spots[1] - spots[0]))), 1e-9)
        paper.label(f"{name} {n:.3f}", spots[1], size=10.0, colour=ACCENT, away=way)
    yield section.exaggeration


def _name_bodies(paper: Paper, lens: Lens, scene: StagedDocument) -> None:
    for body in scene.bodies:
        medium = scene.media[body.medium]
        if body.individual:
            continue
        vertices = body.solid.body.vertices
        if lens.is_pinhole and lens.depth(vertices).min() <= 0.0:
            continue
        places = lens.project(vertices)
        middle = places.mean(axis=0)
        lowest = places[int(np.argmax(places[:, 1] + 0.3 * np.abs(places[:, 0] - middle[0])))]
        what = medium.mineral.id if medium.mineral is not None else None
        text = body.name if what is None or what == body.name else f"{body.name} ({what})"
        paper.label(text, lowest, away=np.array((0.0, 1.0)))


def _scale_bar(lens: Lens, point: Real, paper: Paper) -> str:
    """Return a bar of a round length at the lower right, true for what is as far away as the middle of the bodies."""
    unit = lens.units_per_mm(point)
    length = next(m * 10.0**p for p in range(-5, 6) for m in (1, 2, 5) if m * 10.0**p * unit >= 55.0)
    right, y = paper.width - 12.0, paper.height + 30.0
    left = right - length * unit
    text = f"{length:g} mm" if length >= 0.01 else f"{length * 1000.0:g} µm"
    return (
        f'<path class="scale" fill="none" stroke="{INK}" stroke-width="1.2" '
        f'd="M{left:.1f} {y - 4:.1f}v8M{left:.1f} {y:.1f}H{right:.1f}m0 -4v8"/>\n'
        f'<text x="{0.5 * (left + right):.1f}" y="{y - 8:.1f}" font-size="11" fill="{INK}" text-anchor="middle">'
        f"{text}</text>"
    )


def _title(scene: StagedDocument) -> str:
    title = scene.document.title or "Scene"
    return "".join(letter if letter.isprintable() else " " for letter in title)


def _caption(scene: StagedDocument, view: View, exaggerations: set[int]) -> list[str]:
    how = {
        "camera": "as the camera sees it",
        "plan": "plan, from above; x right, y up",
        "front": "from the front; x right, z up",
        "side": "from the right; y right, z up",
    }[view]
    if scene.frames > 1:
        how += f"; frame {scene.frame} of {scene.frames}"
    lines = [_title(scene), how]
    if exaggerations:
        factors = " and ".join(f"{factor} times" for factor in sorted(exaggerations))
        larger = "" if exaggerations == {1} else f"; differences of the indices drawn {factors} larger"
        lines.append(f"sections of the indicatrix across the line of sight, 589.3 nm{larger}")
    return lines


def _middle(scene: StagedDocument) -> Real:
    if scene.bodies:
        return np.asarray(np.mean([body.centre for body in scene.bodies], axis=0))
    planes = [surface.plane for surface in scene.surfaces] + [sheet.plane for sheet in scene.sheets]
    return np.asarray(np.mean([plane.centre for plane in planes], axis=0))


def _radius(body: StagedBody) -> float:
    vertices = body.solid.body.vertices
    return float(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1).max())
