"""What of the scene language the renderer can draw yet.

One convex body over a flat page or table, a point light, a sky, a perspective camera with or without an analyser.
Everything else is a `NotSupportedError` that names the construct and its place.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import NotSupportedError
from crystal_core.geometry import ConvexPolyhedron, face_finder
from crystal_core.scene.lights import Light
from crystal_core.scene.shapes import Plate, Wedge
from crystal_core.scene.staged.body import StagedBody
from crystal_core.scene.staged.flat import StagedSurface
from crystal_core.scene.staged.lamp import StagedLight
from crystal_core.scene.staged.stage import StagedDocument
from crystal_core.scene.tabletop import StagedCamera, StagedPage, StagedScene, StagedSpecimen
from crystal_core.scene.texture import Texture

__all__ = ["drawable"]

Real = NDArray[np.float64]

EXPOSURE = 0.85
"""Of a scene that has none: the picture value of white paper under its lights. Behind an analyser it is doubled, as a
camera's would be: half of unpolarized light passes."""

SAME_PLANE_MM = 1.0
"""A table so little below the page counts as the table around it."""

THIN_UM = 1000.0
"""Plates and wedges thinner than this are about interference, which the renderer does not know yet."""

ABOVE_MM = 1e5
"""Height of the light that stands for none: above all bodies."""

PLAIN_MM = 64.0
"""Width of the page that stands for a table alone."""


def drawable(scene: StagedDocument) -> StagedScene:
    """Return a scene, at its frame, as the renderer takes it.

    Raises
    ------
    NotSupportedError
        The scene has something that cannot be drawn yet; the message begins with its JSON pointer.
    """
    body, shape = _body(scene)
    page, table = _ground(scene)
    lamp, sky = _lights(scene)
    camera = scene.camera
    if camera.tan_half is None:
        raise _refused("/camera/orthographic", "an orthographic camera cannot be drawn yet")
    under = page or table
    assert under is not None
    ground = under.plane
    # The renderer's page lies in z = 0, centred on the origin, x to its right.
    rotation, shift = ground.frame.T, -ground.frame.T @ ground.centre
    # Under a sky alone the light's place plays no part.
    light = np.array((0.0, 0.0, ABOVE_MM)) if lamp is None else rotation @ lamp.place + shift
    solid = shape.transformed(rotation, shift)
    filling = scene.media[body.medium]
    filling = replace(filling, rotation=rotation @ filling.rotation)
    eye = rotation @ camera.eye + shift
    if eye[2] <= 0:
        raise _refused(camera.pointer, "a camera below the page cannot be drawn")
    if lamp is not None and light[2] <= solid.vertices[:, 2].max():
        raise _refused(
            f"{lamp.pointer}/point/position_mm", "a light that is not higher than the body cannot be drawn yet"
        )
    if solid.vertices[:, 2].min() <= 0:
        raise _refused(body.pointer, "a body that is not above the page cannot be drawn yet")
    forward, right, up = rotation @ camera.forward, rotation @ camera.right, rotation @ camera.up
    analyser = None if camera.analyser is None else rotation @ camera.analyser
    lamp_lx, sky_lx = _illuminances(lamp, light, sky)
    exposure = EXPOSURE * (1.0 if analyser is None else 2.0)
    if scene.document.render.exposure is not None:
        exposure = scene.document.render.exposure * (lamp_lx + sky_lx) / 1000.0
    return StagedScene(
        StagedSpecimen(solid, face_finder(solid), filling),
        _page(page, table),
        light,
        sky_lx / (lamp_lx + sky_lx),
        StagedCamera(eye, forward, right, up, camera.tan_half, analyser),
        exposure,
    )


def _body(scene: StagedDocument) -> tuple[StagedBody, ConvexPolyhedron]:
    if not scene.bodies:
        raise _refused("/bodies", "a scene without a body cannot be drawn yet")
    for sheet in scene.sheets:
        raise _refused(sheet.pointer, f"a {sheet.sheet.kind} as a sheet cannot be drawn yet")
    body, *more = scene.bodies
    for other in more:
        what = f"{other.pointer}/twin" if other.name == body.name else other.pointer
        raise _refused(what, "only one body can be drawn yet")
    written = scene.document.bodies[body.name]
    shape = body.solid.body
    if not isinstance(shape, ConvexPolyhedron):
        raise _refused(
            f"{body.pointer}/shape/{written.shape.kind}", "only convex bodies of plane faces can be drawn yet"
        )
    thin = written.shape.plate or written.shape.wedge
    if thin is not None and scene.document.render.interference and _thickest(thin) < THIN_UM:
        reason = "interference in thin bodies cannot be drawn yet; without it: /render/interference: false"
        raise _refused(f"{body.pointer}/shape/{written.shape.kind}", reason)
    around = scene.document.surroundings
    if around.optics is None or around.optics.n != 1.0:
        raise _refused("/surroundings", "only surroundings of air (n: 1) can be drawn yet")
    return body, shape


def _thickest(thin: Plate | Wedge) -> float:
    return thin.thickness_um if isinstance(thin, Plate) else thin.thickness_um[1]


def _ground(scene: StagedDocument) -> tuple[StagedSurface | None, StagedSurface | None]:
    """Return the page and the table around it; one of them may be missing."""
    endless = [s for s in scene.surfaces if s.surface.shape.endless is not None]
    pages = [s for s in scene.surfaces if s.surface.shape.endless is None]
    if not scene.surfaces:
        raise _refused("/surfaces", "a scene without a page or a table cannot be drawn yet")
    for extra in (*pages[1:], *endless[1:]):
        raise _refused(extra.pointer, "only one page, and one table around it, can be drawn yet")
    page, table = next(iter(pages), None), next(iter(endless), None)
    for surface in (*pages, *endless):
        if not isinstance(surface.surface.reflectance, float | None):
            raise _refused(f"{surface.pointer}/reflectance", "only grey surfaces and prints can be drawn yet")
    if page is not None:
        plane = page.plane
        if page.surface.shape.rectangle is None or (page.texture is None and plane.width_mm != plane.height_mm):
            raise _refused(f"{page.pointer}/shape", "only prints and square pages can be drawn yet")
    if page is not None and table is not None:
        below = float((page.plane.centre - table.plane.centre) @ page.plane.normal)
        level = abs(float(page.plane.normal @ table.plane.normal)) > 1.0 - 1e-9
        if not level or not 0 <= below <= SAME_PLANE_MM:
            raise _refused(table.pointer, f"only a table at most {SAME_PLANE_MM:g} mm below the page can be drawn yet")
    return page, table


def _lights(scene: StagedDocument) -> tuple[StagedLight | None, StagedLight | None]:
    for light in scene.lights:
        if light.kind in {"beam", "area"}:
            raise _refused(f"{light.pointer}/{light.kind}", f"light of the kind {light.kind} cannot be drawn yet")
        if light.spectrum != "D65":
            raise _refused(f"{light.pointer}/spectrum", "only daylight (D65) can be drawn yet")
        if light.light.polarization is not None:
            raise _refused(f"{light.pointer}/polarization", "only unpolarized light can be drawn yet")
    lamps = [light for light in scene.lights if light.kind == "point"]
    skies = [light for light in scene.lights if light.kind == "sky"]
    for extra in (*lamps[1:], *skies[1:]):
        raise _refused(extra.pointer, "only one point light and one sky can be drawn yet")
    return next(iter(lamps), None), next(iter(skies), None)


def _illuminances(lamp: StagedLight | None, light: Real, sky: StagedLight | None) -> tuple[float, float]:
    """Return the illuminance of the page's centre by the lamp, which stands at `light` from there, and by the sky."""
    sky_lx = 0.0 if sky is None or sky.light.sky is None else sky.light.sky.illuminance_lx
    if lamp is None:
        return 0.0, sky_lx
    source: Light = lamp.light
    assert source.point is not None
    written = np.asarray(source.point.position_mm)
    candela_mm2 = source.point.illuminance_lx * float(written @ written)
    return candela_mm2 * float(light[2]) / float(light @ light) ** 1.5, sky_lx


def _page(page: StagedSurface | None, table: StagedSurface | None) -> StagedPage:
    around = 0.0 if table is None else _grey(table)
    if page is None:
        return StagedPage(_plain(around, PLAIN_MM), around)
    return StagedPage(page.texture or _plain(_grey(page), page.plane.width_mm), around)


def _grey(surface: StagedSurface) -> float:
    assert isinstance(surface.surface.reflectance, float)
    return surface.surface.reflectance


def _plain(reflectance: float, width_mm: float) -> Texture:
    return Texture(np.full((2, 2, 1), reflectance, np.float32), width_mm)


def _refused(pointer: str, reason: str) -> NotSupportedError:
    return NotSupportedError(f"{pointer}: {reason}")
