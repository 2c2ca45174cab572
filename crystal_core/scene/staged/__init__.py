"""Scenes turned into arrays: bodies in the world, both sides of every face, and everything checked before rendering."""

from crystal_core.scene.staged.body import NOBODY, StagedBody
from crystal_core.scene.staged.flat import Plane, StagedSheet, StagedSurface
from crystal_core.scene.staged.lamp import StagedLight
from crystal_core.scene.staged.medium import StagedMedium
from crystal_core.scene.staged.stage import StagedDocument, stage_scene
from crystal_core.scene.staged.view import StagedView

__all__ = [
    "NOBODY",
    "Plane",
    "StagedBody",
    "StagedDocument",
    "StagedLight",
    "StagedMedium",
    "StagedSheet",
    "StagedSurface",
    "StagedView",
    "stage_scene",
]
