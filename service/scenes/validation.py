"""Whether a scene can be put together; the work of a worker process, where a scene may be large."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from crystal_core import sequence
from crystal_core.errors import InputError
from crystal_core.scene import SceneDocument, SceneFiles, parse_scene, stage_scene
from service.scenes.summary import summary, warnings_of

__all__ = ["MAX_COST", "checked_request", "checked_scene"]

MAX_COST = 200_000
"""Frames times the square of the number of bodies: every pair of them is looked at in every frame."""


def checked_scene(scene: Mapping[str, Any], assets: Path) -> dict[str, Any]:
    """Return summary and warnings of a scene that names assets only, as JSON-able values.

    Raises
    ------
    InputError
        With a JSON pointer for every fault.
    NotSupportedError
        A twin that cannot be made.
    """
    document = parse_scene(scene)
    _refuse_costly(document, "")
    staged = stage_scene(document, SceneFiles(assets=assets))
    warnings = [{"pointer": fault.pointer, "detail": fault.message} for fault in warnings_of(staged)]
    return {"summary": summary(staged), "warnings": warnings}


def checked_request(body: Mapping[str, Any], assets: Path) -> sequence.RenderRequest:
    """Return the request of a render that names assets only, as `crystal_core.sequence.parse_request` does.

    Raises
    ------
    InputError, NotSupportedError
        As `parse_request` says; a scene that it would take too long to look at.
    """
    request = sequence.read_request(body)
    if isinstance(request, sequence.SceneRequest):
        _refuse_costly(request.scene, "/scene")
    return sequence.parse_request(body, assets)


def _refuse_costly(scene: SceneDocument, prefix: str) -> None:
    cost = scene.frames * len(scene.bodies) ** 2
    if cost > MAX_COST:
        raise InputError.at(
            f"{prefix}/bodies",
            f"{len(scene.bodies)} bodies in {scene.frames} frames cost {cost} (frames × bodies²); "
            f"at most {MAX_COST} are taken here, the command line takes any",
        )
