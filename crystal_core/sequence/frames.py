"""Frames cut into tiles: the task grid, the work of one tile, and the frame put together again."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from crystal_core.render import QUALITIES, Illumination, Quality, keep_freed_memory, render_pixels, tuned_quality
from crystal_core.scene import StagedScene
from crystal_core.sequence.request import RenderRequest

__all__ = ["Frame", "Tile", "TileResult", "assemble", "frame_angle_deg", "render_tile", "tile_grid"]

TILE_SIDE = {"draft": 128, "standard": 96, "fine": 32}
"""Pixels a side, so that the slowest tile takes about half a second: a unit of work cannot be interrupted."""


@dataclass(frozen=True)
class Tile:
    """A rectangle of pixels, x0 ≤ column < x1, y0 ≤ row < y1; (0, 0) is top left."""

    x0: int
    y0: int
    x1: int
    y1: int


@dataclass(frozen=True)
class TileResult:
    """A rendered tile.

    Parameters
    ----------
    tile : Tile
        Its place.
    pixels : NDArray
        Linear sRGB, float32, shape (h, w, 3).
    squared_error : float
        Sum over the pixels of the estimated squared error, the mean of the three channels.
    seconds : float
        Time it took.
    stages : dict
        Seconds per stage of the renderer.
    events : int
        Rays that met a face of the specimen.
    """

    tile: Tile
    pixels: NDArray[np.float32]
    squared_error: float
    seconds: float
    stages: dict[str, float]
    events: int


@dataclass(frozen=True)
class Frame:
    """A whole frame: linear sRGB, float32, (H, W, 3); estimated RMS error; seconds of work (not of waiting)."""

    linear: NDArray[np.float32]
    error_estimate: float
    seconds: float


def frame_angle_deg(request: RenderRequest, index: int) -> float:
    """Return the stage angle of a frame, in degrees, counter-clockwise seen from above."""
    return request.angle_deg(index)


def tile_grid(request: RenderRequest) -> tuple[Tile, ...]:
    """Return the tiles of every frame of the request, row by row; they depend on the request alone."""
    width, height = request.size
    side = TILE_SIDE[request.quality]
    return tuple(
        Tile(x, y, min(x + side, width), min(y + side, height))
        for y in range(0, height, side)
        for x in range(0, width, side)
    )


def render_tile(request: RenderRequest, frame: int, tile: int, assets: Path | None = None) -> TileResult:
    """Render one tile: the same bits on every worker of one kind of machine.

    Parameters
    ----------
    request : RenderRequest
        What was asked for.
    frame, tile : int
        Index of the frame, and of the tile in `tile_grid`.
    assets : Path, optional
        Folder of files that parameters name as ``asset:<sha256>``.
    """
    started = perf_counter()
    keep_freed_memory()
    scene, illumination, quality = _staged_frame(request, frame, assets)
    place = tile_grid(request)[tile]
    done = render_pixels(
        scene,
        illumination,
        quality,
        request.size,
        (place.x0, place.y0, place.x1, place.y1),
        (request.seed, frame, tile),
    )
    return TileResult(place, done.pixels, done.squared_error, perf_counter() - started, done.stages, done.events)


def assemble(request: RenderRequest, results: Iterable[TileResult]) -> Frame:
    """Return the frame that the tiles make, in whatever order they come.

    Raises
    ------
    ValueError
        A tile is missing or comes twice.
    """
    grid = tile_grid(request)
    by_tile = {result.tile: result for result in results}
    if set(by_tile) != set(grid):
        raise ValueError(f"{len(by_tile)} different tiles of {len(grid)} make no frame")
    width, height = request.size
    linear = np.empty((height, width, 3), np.float32)
    squared, seconds = 0.0, 0.0
    for tile in grid:  # sums in the order of the grid: their bits do not depend on who was first
        result = by_tile[tile]
        linear[tile.y0 : tile.y1, tile.x0 : tile.x1] = result.pixels
        squared += result.squared_error
        seconds += result.seconds
    return Frame(linear, float(np.sqrt(squared / (width * height))), seconds)


@lru_cache(maxsize=3)
def _staged_frame(request: RenderRequest, frame: int, assets: Path | None) -> tuple[StagedScene, Illumination, Quality]:
    """Stage one frame, once per process: its tiles share it."""
    scene = request.staged(frame, assets)
    illumination = Illumination(scene)
    quality = QUALITIES[request.quality]
    return scene, illumination, tuned_quality(scene, illumination, quality, request.size, (request.seed, frame))
