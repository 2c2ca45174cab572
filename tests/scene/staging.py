"""Small scenes for the tests of staging."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from crystal_core.errors import InputError
from crystal_core.scene import SceneFiles, StagedDocument, parse_scene, stage_scene

Mapping = dict[str, Any]

CALCITE: Mapping = {"mineral": "calcite", "shape": {"habit": {"size_mm": 10}}}
BOX: Mapping = {"optics": {"n": 1.5}, "shape": {"box": {"size_mm": [10, 10, 10]}}}
BALL: Mapping = {"optics": {"n": 1.5}, "shape": {"sphere": {"diameter_mm": 10}}}
TABLE: Mapping = {"reflectance": 0.5, "shape": {"endless": {}}}


def body(base: Mapping, **more: Any) -> Mapping:
    return copy.deepcopy(base) | more


def scene(**parts: Any) -> Mapping:
    return {"isogyre": 1, **parts}


def bodies(**named: Mapping) -> Mapping:
    return scene(bodies=named)


def staged(mapping: Mapping, files: SceneFiles | None = None) -> StagedDocument:
    return stage_scene(parse_scene(mapping, paths=files is not None), files)


def refused(mapping: Mapping, files: SceneFiles | None = None) -> dict[str, str]:
    """Return the faults of a scene by their pointers; nothing if it has none."""
    try:
        staged(mapping, files)
    except InputError as error:
        return {fault.pointer: fault.message for fault in error.faults}
    return {}


def close(a: Any, b: Any, tolerance: float = 1e-9) -> bool:
    return bool(np.allclose(a, b, rtol=0, atol=tolerance))
