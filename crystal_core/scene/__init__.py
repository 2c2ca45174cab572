"""The scene description and its staging into arrays."""

from crystal_core.scene.description import Camera, Page, PointLight, Scene, Shape, Sky, Specimen
from crystal_core.scene.staging import StagedScene, StagedSpecimen, stage

__all__ = [
    "Camera",
    "Page",
    "PointLight",
    "Scene",
    "Shape",
    "Sky",
    "Specimen",
    "StagedScene",
    "StagedSpecimen",
    "stage",
]
