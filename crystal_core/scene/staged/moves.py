"""What moves, at a frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from crystal_core.scene.document import SceneDocument
from crystal_core.scene.motions import Motion, Move
from crystal_core.scene.spectra import Line, SpectrumOf
from crystal_core.scene.staged.body import StagedBody
from crystal_core.scene.staged.flat import StagedSheet, StagedSurface
from crystal_core.scene.staged.lamp import StagedLight
from crystal_core.scene.staged.medium import StagedMedium
from crystal_core.scene.staged.stance import about
from crystal_core.scene.staged.view import StagedView

if TYPE_CHECKING:
    from crystal_core.scene.staged.stage import StagedDocument

__all__ = ["Parts", "moved"]

Real = NDArray[np.float64]
Pose = tuple[Real, Real]
"""A rotation and a shift, of points x to rotation·x + shift."""


@dataclass(frozen=True)
class Parts:
    """What can move."""

    media: tuple[StagedMedium, ...]
    bodies: tuple[StagedBody, ...]
    surfaces: tuple[StagedSurface, ...]
    sheets: tuple[StagedSheet, ...]
    lights: tuple[StagedLight, ...]
    camera: StagedView

    @classmethod
    def of(cls, scene: StagedDocument) -> Parts:
        """Return those of a scene."""
        return cls(scene.media, scene.bodies, scene.surfaces, scene.sheets, scene.lights, scene.camera)


def moved(motion: Motion, frame: int, document: SceneDocument, still: Parts) -> Parts:
    """Return the parts at a frame: shifts come first, then turns, then the stage."""
    time = motion.time(frame)
    parts = still
    order = ("shift", "turn", "stage", "analyser", "wavelength")
    for move in sorted(motion.moves, key=lambda move: order.index(move.kind)):
        parts = _MOVERS[move.kind](parts, move, time, document)
    return parts


def _shift(parts: Parts, move: Move, time: float, document: SceneDocument) -> Parts:
    assert move.shift is not None
    name = move.shift.what
    wanted = np.array(move.shift.when(time))
    rotation = np.eye(3)
    if name in document.bodies:
        start = np.asarray(document.bodies[name].position_mm or (0.0, 0.0, 0.0))
        return _bodies(parts, dict.fromkeys(_followers(name, document), (rotation, wanted - start)))
    if name in document.sheets:
        by = wanted - np.asarray(document.sheets[name].position_mm)
        return replace(parts, sheets=tuple(_sheet(s, rotation, by) if s.name == name else s for s in parts.sheets))
    if name in document.surfaces:
        by = wanted - np.asarray(document.surfaces[name].position_mm)
        surfaces = (replace(s, plane=s.plane.moved(rotation, by)) if s.name == name else s for s in parts.surfaces)
        return replace(parts, surfaces=tuple(surfaces))
    lights = (light.moved(rotation, wanted - light.place) if light.name == name else light for light in parts.lights)
    return replace(parts, lights=tuple(lights))


def _turn(parts: Parts, move: Move, time: float, document: SceneDocument) -> Parts:
    assert move.turn is not None
    name, (angle,) = move.turn.what, move.turn.when(time)
    if name in document.bodies:
        centre = next(body.centre for body in parts.bodies if body.name == name)
        rotation = about(move.turn.about or (0.0, 0.0, 1.0), angle)
        return _bodies(parts, dict.fromkeys(_followers(name, document), (rotation, centre - rotation @ centre)))
    if name in document.sheets:
        return replace(parts, sheets=tuple(_spun(s, angle) if s.name == name else s for s in parts.sheets))
    assert move.turn.about is not None
    rotation = about(move.turn.about, angle)
    lights = (
        light.moved(rotation, light.place - rotation @ light.place) if light.name == name else light
        for light in parts.lights
    )
    return replace(parts, lights=tuple(lights))


def _stage(parts: Parts, move: Move, time: float, document: SceneDocument) -> Parts:
    assert move.stage is not None
    rotation = about((0.0, 0.0, 1.0), move.stage.when(time)[0])
    centre = np.array((*move.stage.centre_mm, 0.0))
    shift = centre - rotation @ centre
    sheets = (s if s.medium is None else _sheet(s, rotation, shift) for s in parts.sheets)
    return _bodies(replace(parts, sheets=tuple(sheets)), dict.fromkeys(document.bodies, (rotation, shift)))


def _analyser(parts: Parts, move: Move, time: float, _: SceneDocument) -> Parts:
    assert move.analyser is not None
    return replace(parts, camera=parts.camera.with_analyser(move.analyser.when(time)[0]))


def _wavelength(parts: Parts, move: Move, time: float, _: SceneDocument) -> Parts:
    assert move.wavelength is not None
    name = move.wavelength.of
    spectrum = SpectrumOf(lines=(Line(wavelength_nm=move.wavelength.when(time)[0]),))
    lights = (replace(light, spectrum=spectrum) if light.name == name else light for light in parts.lights)
    return replace(parts, lights=tuple(lights))


_MOVERS = {"shift": _shift, "turn": _turn, "stage": _stage, "analyser": _analyser, "wavelength": _wavelength}


def _bodies(parts: Parts, poses: Mapping[str, Pose]) -> Parts:
    media = list(parts.media)
    bodies = []
    for body in parts.bodies:
        if body.name in poses:
            rotation, shift = poses[body.name]
            medium = media[body.medium]
            media[body.medium] = replace(medium, rotation=rotation @ medium.rotation)
            body = body.moved(rotation, shift)
        bodies.append(body)
    return replace(parts, media=tuple(media), bodies=tuple(bodies))


def _sheet(sheet: StagedSheet, rotation: Real, shift: Real) -> StagedSheet:
    medium = sheet.medium
    if medium is not None:
        medium = replace(medium, rotation=rotation @ medium.rotation)
    return replace(sheet, plane=sheet.plane.moved(rotation, shift), medium=medium)


def _spun(sheet: StagedSheet, angle: float) -> StagedSheet:
    rotation = about(sheet.plane.normal, angle)
    return _sheet(sheet, rotation, sheet.plane.centre - rotation @ sheet.plane.centre)


def _followers(name: str, document: SceneDocument) -> set[str]:
    """Return a body, what is inside it, what it is joined to, and so on."""
    group: set[str] = set()
    more = {name}
    while more:
        group |= more
        bodies = document.bodies.items()
        more = {other for other, body in bodies if body.inside in group or body.joined_to in group}
        more |= {partner for member in group if (partner := document.bodies[member].joined_to) is not None}
        more -= group
    return group
