"""A request for the sequence of a scene that is written down."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
from pydantic import BaseModel, ConfigDict, Field

from crystal_core.errors import Fault, InputError, NotSupportedError
from crystal_core.scene import (
    SceneDocument,
    SceneFiles,
    StagedDocument,
    StagedScene,
    drawable,
    parse_scene,
    stage_scene,
)
from crystal_core.sequence.request import MAX_FRAMES, MAX_SEED, MAX_SIDE, MIN_SIDE, RenderRequest, faults_of

__all__ = ["SceneRequest", "read_scene_request"]

PixelCount = Annotated[int, Field(ge=MIN_SIDE, le=MAX_SIDE, strict=True)]

_SCENE = "/scene"


class _Envelope(BaseModel):
    """The request with its scene not looked at yet; what is given replaces what the scene says."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    scene: dict[str, Any]
    frames: Annotated[int, Field(ge=1, le=MAX_FRAMES, strict=True)] | None = None
    size: tuple[PixelCount, PixelCount] | None = None
    quality: Literal["draft", "standard", "fine"] | None = None
    seed: Annotated[int, Field(ge=0, le=MAX_SEED, strict=True)] | None = None


class SceneRequest(RenderRequest):
    """A scene asked for.

    Parameters
    ----------
    scene : SceneDocument
        It names assets only, no paths; its motion and render settings are those of the request.
    """

    scene: SceneDocument

    @property
    def name(self) -> str:
        """The word "scene": a title may be anything."""
        return "scene"

    @cached_property
    def _text(self) -> str:
        return json.dumps(self.canonical(), sort_keys=True)

    def __hash__(self) -> int:
        """Return the hash of the canonical request: a scene holds mappings, which have none."""
        return hash(self._text)

    def __eq__(self, other: object) -> bool:
        """Tell whether the other is the same request."""
        return isinstance(other, SceneRequest) and self._text == other._text

    def angle_deg(self, index: int) -> float:
        """Return the angle of a frame by the scene's first move of the stage, else by its first turn, else 0."""
        motion = self.scene.motion
        if motion is None:
            return 0.0
        stages = [move.stage for move in motion.moves if move.stage is not None]
        turns = [move.turn for move in motion.moves if move.turn is not None]
        first = next(iter((*stages, *turns)), None)
        return 0.0 if first is None else first.when(motion.time(index))[0]

    def staged(self, index: int, assets: Path | None) -> StagedScene:
        """Return what a frame shows; see `RenderRequest.staged`."""
        return drawable(_staged(self, assets).at(index))

    def described(self) -> dict[str, Any]:
        """Return what a manifest says of the scene; see `RenderRequest.described`."""
        return {"title": self.scene.title, "document": self.scene.to_mapping(full=True)}

    def canonical(self) -> dict[str, Any]:
        """Return the request as JSON-able values, every default filled in."""
        return {
            "scene": self.scene.to_mapping(full=True),
            "frames": self.frames,
            "size": list(self.size),
            "quality": self.quality,
            "seed": self.seed,
        }


def read_scene_request(obj: Mapping[str, object], *, staging: bool, assets: Path | None = None) -> SceneRequest:
    """Return the request that `obj` describes; see `parse_request`.

    Parameters
    ----------
    obj : mapping
        With the key ``scene``; ``frames``, ``size``, ``quality`` and ``seed`` beside it replace those in it.
    staging : bool
        Whether to find out what shows in staging only, and whether the renderer can draw it.
    assets : Path, optional
        Folder of files that the scene may name as ``asset:<sha256>``.

    Raises
    ------
    InputError
        One fault for every wrong place, each with its JSON pointer into `obj`.
    NotSupportedError
        The renderer cannot draw such a scene; the message begins with the pointer.
    """
    faults: list[Fault] = []
    envelope: _Envelope | None = None
    try:
        envelope = _Envelope.model_validate(obj)
    except pydantic.ValidationError as error:
        faults += faults_of(error, "")
    raw = obj.get("scene")
    scene: SceneDocument | None = None
    if isinstance(raw, Mapping):
        try:
            scene = parse_scene(raw)
        except InputError as error:
            faults += [Fault(_SCENE + fault.pointer, fault.message) for fault in error.faults]
    if scene is not None and scene.motion is None and envelope is not None and envelope.frames not in (None, 1):
        faults.append(Fault("/frames", "the scene has no motion: one frame is all there is"))
    if faults:
        raise InputError(faults)
    assert envelope is not None
    assert scene is not None
    request = _request(scene, envelope)
    if staging:
        try:
            staged = _staged(request, assets)
        except InputError as error:
            raise InputError(Fault(_SCENE + fault.pointer, fault.message) for fault in error.faults) from None
        try:
            for frame in range(request.frames):
                drawable(staged.at(frame))
        except NotSupportedError as error:
            told = str(error)
            raise NotSupportedError(_SCENE + told if told.startswith("/") else told) from None
    return request


def _request(scene: SceneDocument, envelope: _Envelope) -> SceneRequest:
    """Return the request, its settings the same in the scene and beside it."""
    given = {"size_px": envelope.size, "quality": envelope.quality, "seed": envelope.seed}
    render = scene.render.model_copy(update={key: value for key, value in given.items() if value is not None})
    motion = scene.motion
    if motion is not None and envelope.frames is not None:
        motion = motion.model_copy(update={"frames": envelope.frames})
    settled = scene.model_copy(update={"render": render, "motion": motion})
    return SceneRequest(
        scene=settled, frames=settled.frames, size=render.size_px, quality=render.quality, seed=render.seed
    )


@lru_cache(maxsize=2)
def _staged(request: SceneRequest, assets: Path | None) -> StagedDocument:
    """Stage what all frames share, once per process."""
    return stage_scene(request.scene, SceneFiles(assets=assets))
