"""The scene description language and its staging into arrays.

    >>> scene = read_scene(Path("calcite.yaml"))
    >>> staged = stage_scene(scene, SceneFiles(folder=Path(".")))

`Scene` and `stage` are those of the renderer as it stands: one specimen over a page. `drawable` turns a staged scene of
the language into them where it can.
"""

from crystal_core.scene.description import Camera, Page, PointLight, Scene, Shape, Sky, Specimen
from crystal_core.scene.document import SceneDocument, scene_schema
from crystal_core.scene.drawable import drawable
from crystal_core.scene.scene_files import SceneFiles, parse_scene, read_scene
from crystal_core.scene.staged import StagedDocument, stage_scene
from crystal_core.scene.staging import StagedScene, StagedSpecimen, stage

__all__ = [
    "Camera",
    "Page",
    "PointLight",
    "Scene",
    "SceneDocument",
    "SceneFiles",
    "Shape",
    "Sky",
    "Specimen",
    "StagedDocument",
    "StagedScene",
    "StagedSpecimen",
    "drawable",
    "parse_scene",
    "read_scene",
    "scene_schema",
    "stage",
    "stage_scene",
]
