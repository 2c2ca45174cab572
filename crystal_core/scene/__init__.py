"""The scene description language and its staging into arrays.

    >>> scene = read_scene(Path("calcite.yaml"))
    >>> staged = stage_scene(scene, SceneFiles(folder=Path(".")))

`drawable` turns a staged scene into what the renderer works on, a `StagedScene`: one specimen over a page; or it says
what cannot be drawn yet.
"""

from crystal_core.scene.document import SceneDocument, scene_schema
from crystal_core.scene.drawable import drawable
from crystal_core.scene.scene_files import SceneFiles, parse_scene, read_scene
from crystal_core.scene.staged import StagedDocument, stage_scene
from crystal_core.scene.tabletop import StagedCamera, StagedPage, StagedScene, StagedSpecimen

__all__ = [
    "SceneDocument",
    "SceneFiles",
    "StagedCamera",
    "StagedDocument",
    "StagedPage",
    "StagedScene",
    "StagedSpecimen",
    "drawable",
    "parse_scene",
    "read_scene",
    "scene_schema",
    "stage_scene",
]
