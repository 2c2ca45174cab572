"""Demonstrations and what is asked of them; a scene and what moves, turned into frames."""

from crystal_core.sequence.catalogue import demonstrations
from crystal_core.sequence.demonstration import Demonstration
from crystal_core.sequence.frames import Frame, Tile, TileResult, assemble, frame_angle_deg, render_tile, tile_grid
from crystal_core.sequence.manifest import FrameRecord, manifest
from crystal_core.sequence.request import RenderRequest, parse_request

__all__ = [
    "Demonstration",
    "Frame",
    "FrameRecord",
    "RenderRequest",
    "Tile",
    "TileResult",
    "assemble",
    "demonstrations",
    "frame_angle_deg",
    "manifest",
    "parse_request",
    "render_tile",
    "tile_grid",
]
