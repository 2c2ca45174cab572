"""Whether a scene can be put together; the work of a worker process, where a scene may be large."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from crystal_core.scene import SceneFiles, parse_scene, stage_scene
from service.scenes.summary import summary, warnings_of

__all__ = ["checked_scene"]


def checked_scene(scene: Mapping[str, Any], assets: Path) -> dict[str, Any]:
    """Return summary and warnings of a scene that names assets only, as JSON-able values.

    Raises
    ------
    InputError
        With a JSON pointer for every fault.
    NotSupportedError
        A twin that cannot be made.
    """
    staged = stage_scene(parse_scene(scene), SceneFiles(assets=assets))
    warnings = [{"pointer": fault.pointer, "detail": fault.message} for fault in warnings_of(staged)]
    return {"summary": summary(staged), "warnings": warnings}
