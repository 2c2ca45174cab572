"""What a scene holds: for people and programs that look at it before anything is rendered."""

from __future__ import annotations

from typing import Any

import numpy as np

from crystal_core.errors import Fault, NotSupportedError
from crystal_core.scene import StagedDocument, drawable
from crystal_core.scene.staged import NOBODY, StagedBody, StagedLight, StagedSheet, StagedSurface
from crystal_core.scene.staged.convex import highest
from crystal_core.scene.wireframe.directions import cell_axes, optic_axes

__all__ = ["summary", "warnings_of"]


def summary(scene: StagedDocument) -> dict[str, Any]:
    """Return what there is in a scene at its frame, as JSON-able values; lengths in mm, directions as unit vectors.

    Parameters
    ----------
    scene : StagedDocument
        The scene; angles and places are those of its frame.
    """
    document, camera = scene.document, scene.camera
    return {
        "title": document.title,
        "frames": scene.frames,
        "frame": scene.frame,
        "size_px": list(document.render.size_px),
        "quality": document.render.quality,
        "surroundings": document.surroundings.mineral or "optics",
        "bodies": [_body(scene, body) for body in scene.bodies],
        "surfaces": [_surface(surface) for surface in _once(scene.surfaces)],
        "sheets": [_sheet(sheet) for sheet in scene.sheets],
        "lights": [_light(light) for light in scene.lights],
        "camera": {
            "kind": document.camera.kind,
            "eye_mm": _rounded(camera.eye),
            "forward": _rounded(camera.forward),
            "up": _rounded(camera.up),
            "vfov_deg": None if camera.tan_half is None else _number(2 * np.rad2deg(np.arctan(camera.tan_half))),
            "height_mm": None if camera.half_height_mm is None else _number(2.0 * camera.half_height_mm),
            "analyser_deg": camera.analyser_deg,
        },
        "moves": [] if document.motion is None else [move.kind for move in document.motion.moves],
    }


def warnings_of(scene: StagedDocument) -> list[Fault]:
    """Return what is worth saying of a valid scene: meshes that were mended, what this version cannot draw."""
    warnings = list(scene.notes)
    try:
        for frame in range(scene.frames):
            drawable(scene.at(frame))
    except NotSupportedError as error:
        pointer, colon, reason = str(error).partition(": ")
        told = (pointer, reason) if colon and pointer.startswith("/") else ("", str(error))
        warnings.append(Fault(told[0], f"cannot be rendered by this version: {told[1]}"))
    return warnings


def _body(scene: StagedDocument, body: StagedBody) -> dict[str, Any]:
    written, medium, solid = scene.document.bodies[body.name], scene.media[body.medium], body.solid
    axes = np.eye(3)
    high = [highest(solid.body, axis) for axis in axes]
    low = [-highest(solid.body, -axis) for axis in axes]
    touching = sorted({int(number) for number in body.neighbour if number != NOBODY})
    return {
        "name": body.name,
        "individual": body.individual,
        "material": written.mineral or "optics",
        "optical_class": _optical_class(len(medium.at(np.array([589.3])).indices)),
        "shape": written.shape.kind,
        "faces": len(solid.labels),
        "volume_mm3": float(f"{solid.body.volume_mm3:.8g}"),
        "extent_mm": [_number(b - a) for a, b in zip(low, high, strict=True)],
        "centre_mm": _rounded(body.centre),
        "lowest_mm": _number(low[2]),
        "rotation": [_rounded(row) for row in medium.rotation],
        "cell_axes": {name: _rounded(way) for name, way in cell_axes(medium)},
        "optic_axes": [_rounded(way) for way in optic_axes(medium)],
        "rests_on": written.rests_on,
        "inside": None if body.host == NOBODY else scene.bodies[body.host].name,
        "touches": [scene.bodies[number].name for number in touching],
    }


def _surface(surface: StagedSurface) -> dict[str, Any]:
    room = surface.surface.shape.room
    plane = surface.plane
    size: list[float] | None = None
    if room is not None:
        size = list(room.size_mm)
    elif np.isfinite(plane.width_mm):
        size = [_number(plane.width_mm), _number(plane.height_mm)]
    return {
        "name": surface.name,
        "kind": surface.surface.kind,
        "shape": surface.surface.shape.kind,
        "size_mm": size,
        "position_mm": list(surface.surface.position_mm) if room is not None else _rounded(plane.centre),
        "facing": None if room is not None else _rounded(plane.normal),
    }


def _sheet(sheet: StagedSheet) -> dict[str, Any]:
    return {
        "name": sheet.name,
        "kind": sheet.sheet.kind,
        "position_mm": _rounded(sheet.plane.centre),
        "facing": _rounded(sheet.plane.normal),
        "right": _rounded(sheet.plane.frame[:, 0]),
    }


def _light(light: StagedLight) -> dict[str, Any]:
    spectrum = light.spectrum
    return {
        "name": light.name,
        "kind": light.kind,
        "position_mm": None if light.kind == "sky" else _rounded(light.place),
        "direction": None if light.plane is None else _rounded(light.plane.normal),
        "spectrum": spectrum if isinstance(spectrum, str) else spectrum.kind,
        "polarized": light.light.polarization is not None,
    }


def _once(surfaces: tuple[StagedSurface, ...]) -> list[StagedSurface]:
    """Return one plane of each surface."""
    return list({surface.name: surface for surface in reversed(surfaces)}.values())[::-1]


def _optical_class(count: int) -> str:
    return ("isotropic", "uniaxial", "biaxial")[count - 1]


def _rounded(vector: np.typing.NDArray[np.float64]) -> list[float]:
    return [_number(value) for value in vector]


def _number(value: float) -> float:
    return round(float(value), 9) + 0.0  # + 0.0: no −0
