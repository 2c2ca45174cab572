"""A scene turned into what a renderer works on; everything that can be wrong with it is told before any rendering."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from crystal_core.errors import Fault, InputError
from crystal_core.scene.document import SceneDocument
from crystal_core.scene.scene_files import SceneFiles
from crystal_core.scene.staged.body import MadeBody, StagedBody, made_body
from crystal_core.scene.staged.checks import check_scene
from crystal_core.scene.staged.convex import corners
from crystal_core.scene.staged.flat import StagedSheet, StagedSurface, staged_sheet, staged_surfaces
from crystal_core.scene.staged.lamp import StagedLight, staged_light
from crystal_core.scene.staged.medium import StagedMedium
from crystal_core.scene.staged.moves import Parts, moved
from crystal_core.scene.staged.places import placed_bodies
from crystal_core.scene.staged.view import StagedView, staged_view

__all__ = ["MAX_FACES", "StagedDocument", "stage_scene"]

MAX_FACES = 100_000
"""Of all bodies of a scene together."""


@dataclass(frozen=True)
class StagedDocument:
    """A scene at one of its frames.

    Parameters
    ----------
    document : SceneDocument
        As written.
    media : tuple of StagedMedium
        Number 0 is what surrounds everything.
    bodies : tuple of StagedBody
        Two of them for a twin.
    surfaces : tuple of StagedSurface
        Six of them for a room; of those in one plane the smaller covers the larger.
    sheets : tuple of StagedSheet
        In the order of the scene.
    lights : tuple of StagedLight
        In the order of the scene.
    camera : StagedView
        The camera.
    notes : tuple of Fault
        What was mended: of meshes.
    frame : int
        Number of the frame.
    still : StagedDocument or None
        The scene without its motion; None if this is it.
    """

    document: SceneDocument
    media: tuple[StagedMedium, ...]
    bodies: tuple[StagedBody, ...]
    surfaces: tuple[StagedSurface, ...]
    sheets: tuple[StagedSheet, ...]
    lights: tuple[StagedLight, ...]
    camera: StagedView
    notes: tuple[Fault, ...] = ()
    frame: int = 0
    still: StagedDocument | None = None

    @property
    def frames(self) -> int:
        """Number of frames."""
        return self.document.frames

    def at(self, frame: int) -> StagedDocument:
        """Return the scene at a frame, checked.

        Raises
        ------
        InputError
            There is no such frame; or the motion brings two things together, or a light or the camera into a body.
        """
        if not 0 <= frame < self.frames:
            raise InputError.at("/motion/frames", f"there is no frame {frame} of {self.frames}")
        still = self.still or self
        motion = self.document.motion
        if motion is None:
            return self
        parts = moved(motion, frame, self.document, Parts.of(still))
        now = replace(
            still,
            media=parts.media,
            bodies=parts.bodies,
            surfaces=parts.surfaces,
            sheets=parts.sheets,
            lights=parts.lights,
            camera=parts.camera,
            frame=frame,
            still=still,
        )
        check_scene(now.bodies, now.surfaces, now.sheets, now.lights, now.camera, f" in frame {frame}")
        return now


def stage_scene(document: SceneDocument, files: SceneFiles | None = None) -> StagedDocument:
    """Return the scene at its first frame, all its frames checked.

    Parameters
    ----------
    document : SceneDocument
        The scene.
    files : SceneFiles, optional
        Where the files are that it names.

    Raises
    ------
    InputError
        With a JSON pointer for every fault: forms that do not close, a mesh with a hole, too many faces, bodies that
        overlap, an inclusion that sticks out, faces that should meet and do not, a camera or a light in a body or a
        wall, in any of the frames.
    NotSupportedError
        A twin whose individuals do not meet in one face.
    """
    still = _still(document, files or SceneFiles())
    if document.motion is None:
        check_scene(still.bodies, still.surfaces, still.sheets, still.lights, still.camera, "")
        return still
    moves = any(move.kind in {"shift", "turn", "stage"} for move in document.motion.moves)
    first, *_ = [still.at(frame) for frame in range(document.frames if moves else 1)]
    return first


def _still(document: SceneDocument, files: SceneFiles) -> StagedDocument:
    """Return the scene without its motion, not yet checked; faults of its parts are told together."""
    faults: list[Fault] = []
    made: dict[str, MadeBody] = {}
    surfaces: list[StagedSurface] = []
    sheets: list[StagedSheet] = []
    dispersion = document.render.dispersion
    for name, body in document.bodies.items():
        try:
            made[name] = made_body(body, files, dispersion, f"/bodies/{name}")
        except InputError as error:
            faults += error.faults
    for name, surface in document.surfaces.items():
        try:
            surfaces += staged_surfaces(name, surface, files)
        except InputError as error:
            faults += error.faults
    for name, sheet in document.sheets.items():
        try:
            sheets.append(staged_sheet(name, sheet, dispersion))
        except InputError as error:
            faults += error.faults
    count = sum(len(solid.labels) for body in made.values() for solid in body.solids)
    if count > MAX_FACES:
        faults.append(Fault("/bodies", f"the bodies have {count} faces; at most {MAX_FACES} are taken"))
    if faults:
        raise InputError(faults)
    surroundings = StagedMedium(document.surroundings, np.eye(3), dispersion=dispersion)
    placed = placed_bodies(document, made, surfaces)
    media = (surroundings, *(medium for body in made.values() for medium in body.media))
    planes = [thing.plane for thing in surfaces] + [thing.plane for thing in sheets]
    points = [corners(body.solid.body) for body in placed] or [plane.corners for plane in planes]
    lights = tuple(staged_light(name, light) for name, light in document.lights.items())
    camera = staged_view(document.camera, points, document.render.size_px)
    notes = tuple(Fault(f"/bodies/{name}/shape/mesh", note) for name, body in made.items() for note in body.notes)
    return StagedDocument(document, media, placed, tuple(surfaces), tuple(sheets), lights, camera, notes)
