"""Demonstrations and what is asked of them; a scene and what moves, turned into frames."""

from crystal_core.sequence.catalogue import demonstrations
from crystal_core.sequence.demonstration import Demonstration
from crystal_core.sequence.demonstration_request import DemonstrationRequest
from crystal_core.sequence.frames import Frame, Tile, TileResult, assemble, frame_angle_deg, render_tile, tile_grid
from crystal_core.sequence.manifest import FrameRecord, manifest
from crystal_core.sequence.parsing import parse_request, read_request
from crystal_core.sequence.request import RenderRequest
from crystal_core.sequence.scene_request import SceneRequest

__all__ = [
    "Demonstration",
    "DemonstrationRequest",
    "Frame",
    "FrameRecord",
    "RenderRequest",
    "SceneRequest",
    "Tile",
    "TileResult",
    "assemble",
    "demonstrations",
    "frame_angle_deg",
    "manifest",
    "parse_request",
    "read_request",
    "render_tile",
    "tile_grid",
]
