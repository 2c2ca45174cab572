"""Lights, sheets, surfaces and the camera as symbols on a drawing."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.scene.staged.flat import Plane, StagedSheet, StagedSurface
from crystal_core.scene.staged.lamp import StagedLight
from crystal_core.scene.staged.stage import StagedDocument
from crystal_core.scene.staged.view import StagedView
from crystal_core.scene.wireframe.directions import indicatrix_section
from crystal_core.scene.wireframe.hidden import Hider, pieces
from crystal_core.scene.wireframe.lens import Lens
from crystal_core.scene.wireframe.paper import ACCENT, FAINT, INK, Paper, Style

__all__ = ["draw_analyser", "draw_camera", "draw_light", "draw_sheet", "draw_surface", "outline"]

Real = NDArray[np.float64]

SURFACE = Style("surface", 0.8, FAINT)
SHEET = Style("sheet", 1.0)
VIBRATION = Style("vibration", 1.4, ACCENT)
PLATE = Style("plate-vibrations", 1.0, ACCENT)
BEAM = Style("beam", 1.0)
LIGHT = Style("light", 0.9)
CAMERA = Style("camera", 0.9, FAINT)

DISC_POINTS = 72
ARROW = 36.0
"""Length of the arrows of an area light, in units of the sheet."""

RIM = 14.0
"""How far from the rim of the sheet an arrow ends that tells where something outside of it is."""


def outline(plane: Plane) -> Real:
    """Return the outline of a plane thing, closed, shape (N, 3)."""
    if plane.is_disc:
        angles = np.linspace(0.0, 2.0 * np.pi, DISC_POINTS + 1)
        ring = np.outer(np.cos(angles), plane.frame[:, 0]) + np.outer(np.sin(angles), plane.frame[:, 1])
        return np.asarray(plane.centre + 0.5 * plane.width_mm * ring)
    corners = plane.corners
    return np.concatenate((corners, corners[:1]))


def draw_surface(paper: Paper, lens: Lens, surface: StagedSurface, hiders: Sequence[Hider]) -> None:
    """Draw the outline of a surface where no body stands before it; an endless one has none."""
    if not np.isfinite(surface.plane.width_mm):
        return
    ring = outline(surface.plane)
    _draw(paper, lens, SURFACE, ring, hiders)
    if surface.surface.shape.room is not None:
        return
    middle = _spot(lens, surface.plane.centre)
    corner = _shown(paper, lens, ring)
    if corner is not None:
        away = None if middle is None else _unit(corner - middle)
        paper.label(surface.name, corner, size=11.0, colour=FAINT, away=away)


def draw_sheet(paper: Paper, lens: Lens, sheet: StagedSheet, hiders: Sequence[Hider]) -> None:
    """Draw the outline of a sheet and what it does to vibrations: what passes, or the slow and the fast one."""
    plane, told = sheet.plane, sheet.sheet
    _draw(paper, lens, SHEET, outline(plane), hiders)
    text, angle = sheet.name, None
    if told.polarizer is not None:
        angle = told.polarizer.angle_deg
        text = f"polarizer {angle:g}°" if sheet.name == "polarizer" else f"{sheet.name} (polarizer {angle:g}°)"
    elif told.retarder is not None:
        text = f"{sheet.name} ({told.retarder.retardation_nm:g} nm, slow {told.retarder.slow_deg:g}°)"
        angle = told.retarder.slow_deg
    if angle is not None:
        turned = np.deg2rad(angle)
        way = np.cos(turned) * plane.frame[:, 0] + np.sin(turned) * plane.frame[:, 1]
        half = 0.42 * min(plane.width_mm, plane.height_mm)
        _arrow(paper, lens, VIBRATION, plane.centre - half * way, plane.centre + half * way, double=True)
    if sheet.medium is not None and (section := indicatrix_section(sheet.medium, plane.normal)) is not None:
        half = 0.3 * min(plane.width_mm, plane.height_mm)
        slow, fast = (half * way for way in section.directions)
        _arrow(paper, lens, PLATE, plane.centre - slow, plane.centre + slow, double=True)
        _draw(paper, lens, PLATE, np.stack((plane.centre - fast, plane.centre + fast)), ())
        text = f"{sheet.name} (arrow: slow)"
    middle = _spot(lens, plane.centre)
    spot = _shown(paper, lens, outline(plane))
    if spot is None:
        spot = middle
    if spot is not None:
        paper.label(text, spot, away=None if middle is None else _unit(spot - middle))


def draw_light(paper: Paper, lens: Lens, light: StagedLight, scene: StagedDocument, middle: Real) -> None:
    """Draw a light: a star, an arrow at the rim towards one that is not on the sheet, a beam with its arrows."""
    name = light.name
    if light.light.polarization is not None:
        name += " (polarized)"
    if light.kind == "sky":
        return
    if light.kind == "point":
        _place_or_point_to(paper, lens, light.place, name, middle, star=True)
        return
    assert light.plane is not None
    ring = outline(light.plane)
    _draw(paper, lens, LIGHT, ring, ())
    centre, way = light.plane.centre, light.plane.normal
    if light.kind == "area":
        half = 0.35 * min(light.plane.width_mm, light.plane.height_mm)
        length = ARROW / lens.units_per_mm(centre)
        for side in (-1.0, 0.0, 1.0):
            start = centre + side * half * light.plane.frame[:, 0]
            _arrow(paper, lens, LIGHT, start, start + length * way)
        _place_or_point_to(paper, lens, centre, name, middle, star=False)
        return
    far = _reach(scene, centre, way)
    half = 0.5 * min(light.plane.width_mm, light.plane.height_mm)
    for side in (-1.0, 1.0):
        start = centre + side * half * light.plane.frame[:, 0]
        _draw(paper, lens, BEAM, np.stack((start, start + far * way)), ())
    _arrow(paper, lens, BEAM, centre, centre + 0.5 * far * way)
    seen = lens.before_eye(centre, centre + far * way)
    shown = None if seen is None else paper.cut(*lens.project(np.stack(seen)))
    if shown is None:
        _place_or_point_to(paper, lens, centre, name, middle, star=False)
    else:
        paper.label(name, shown[0], size=11.0)


def draw_camera(paper: Paper, lens: Lens, camera: StagedView, middle: Real) -> None:
    """Draw where the scene's camera stands and what it sees."""
    eye = _spot(lens, camera.eye)
    if eye is None or not paper.holds(eye):
        _place_or_point_to(paper, lens, camera.eye, "camera", middle, star=False)
        return
    paper.dot(CAMERA, eye, 3.0)
    looks = lens.project(np.stack((camera.eye, camera.eye + camera.forward / lens.units_per_mm(camera.eye))))
    way = looks[1] - looks[0]
    if np.hypot(*way) > 0.2:
        paper.arrow(CAMERA, eye + 4.0 * _unit(way), eye + 34.0 * _unit(way), 5.0)
    paper.label("camera", eye, size=11.0, colour=FAINT, away=-_unit(way))


def draw_analyser(paper: Paper, camera: StagedView) -> None:
    """Draw the direction that the analyser before the camera passes, in the upper right corner of its picture."""
    if camera.analyser_deg is None:
        return
    centre = np.array((paper.width - 40.0, 40.0))
    angle = np.deg2rad(camera.analyser_deg)
    half = 26.0 * np.array((np.cos(angle), -np.sin(angle)))
    paper.dot(VIBRATION, centre, 30.0)
    paper.arrow(VIBRATION, centre - half, centre + half, double=True)
    text = f"analyser {camera.analyser_deg:g}°"
    paper.label(text, centre + np.array((0.0, 30.0)), colour=ACCENT, size=11.0, away=np.array((0.0, 1.0)))


def _draw(paper: Paper, lens: Lens, style: Style, points: Real, hiders: Sequence[Hider]) -> None:
    """Draw a line through points of the world, shape (N, 3), where nothing hides it."""
    for start, end in itertools.pairwise(points):
        seen = lens.before_eye(start, end)
        if seen is None:
            continue
        for a, b, behind in pieces(*seen, hiders):
            if not behind:
                paper.line(style, lens.project(np.stack((a, b))))


def _arrow(paper: Paper, lens: Lens, style: Style, start: Real, end: Real, *, double: bool = False) -> None:
    seen = lens.before_eye(start, end)
    if seen is not None:
        paper.arrow(style, *lens.project(np.stack(seen)), double=double)


def _spot(lens: Lens, point: Real) -> Real | None:
    """Return where a point is on the sheet, None if it is behind a pinhole."""
    if lens.before_eye(point, point) is None:
        return None
    return np.asarray(lens.project(point[None])[0])


def _shown(paper: Paper, lens: Lens, points: Real) -> Real | None:
    """Return where the first of the points that can be seen stands on the sheet, None if none can."""
    spots = (_spot(lens, point) for point in points)
    return next((spot for spot in spots if spot is not None and paper.holds(spot)), None)


def _place_or_point_to(paper: Paper, lens: Lens, point: Real, name: str, middle: Real, *, star: bool) -> None:
    """Draw something at its place, or point to it from within the sheet and tell how far away it is."""
    spot = _spot(lens, point)
    if spot is not None and paper.holds(spot):
        if star:
            paper.dot(LIGHT, spot, 3.5)
            for angle in np.arange(8) * np.pi / 4.0:
                way = np.array((np.cos(angle), np.sin(angle)))
                paper.line(LIGHT, np.stack((spot + 5.5 * way, spot + 9.5 * way)))
        paper.label(name, spot, size=11.0)
        return
    across = point - lens.eye
    way = np.array((across @ lens.right, -(across @ lens.up)))
    if np.hypot(*way) < 1e-9:
        return
    way = _unit(way)
    half = np.array((0.5 * paper.width, 0.5 * paper.height))
    tip = half + float(np.min((half - RIM) / np.maximum(np.abs(way), 1e-9))) * way
    paper.arrow(LIGHT, tip - 26.0 * way, tip, 6.0)
    far = float(np.linalg.norm(point - middle))
    paper.label(f"{name}, {far:.3g} mm away", tip - 26.0 * way, size=11.0, colour=INK, away=-way)


def _reach(scene: StagedDocument, start: Real, way: Real) -> float:
    """Return how far a beam goes until it meets a body or a surface; twice the scene's size if it meets nothing."""
    found = list(_meetings(scene, start, way))
    size = max((float(np.linalg.norm(body.centre - start)) for body in scene.bodies), default=10.0)
    return min(found, default=2.0 * size)


def _meetings(scene: StagedDocument, start: Real, way: Real) -> Iterator[float]:
    for body in scene.bodies:
        if isinstance(body.solid.body, ConvexPolyhedron):
            enters, leaves, _, _ = body.solid.body.span(start[:, None], way[:, None])
            if 0.0 < enters[0] < leaves[0]:
                yield float(enters[0])
    for surface in scene.surfaces:
        speed = float(way @ surface.plane.normal)
        if speed != 0.0:
            distance = float((surface.plane.centre - start) @ surface.plane.normal) / speed
            if distance > 0.0 and surface.plane.covers(start + distance * way):
                yield distance


def _unit(vector: Real) -> Real:
    length = float(np.hypot(*vector))
    return np.asarray(vector / length) if length > 0.0 else np.array((0.0, -1.0))
