"""The pixels of one tile: passes over all of them, then over those whose error is still too large."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.render.illumination import Illumination
from crystal_core.render.level import Level
from crystal_core.render.quality import Quality
from crystal_core.render.sampling import random_numbers
from crystal_core.render.tracer import Roulette, Stopwatch
from crystal_core.scene import StagedScene

__all__ = ["TilePixels", "render_pixels"]


@dataclass(frozen=True)
class TilePixels:
    """What one tile came to.

    Parameters
    ----------
    pixels : NDArray
        Linear sRGB, shape (h, w, 3), float32.
    squared_error : float
        Sum over the pixels of the estimated squared error, the mean of the three channels.
    stages : dict
        Seconds per stage.
    events : int
        Rays that met a face of the specimen.
    """

    pixels: NDArray[np.float32]
    squared_error: float
    stages: dict[str, float]
    events: int


def render_pixels(
    scene: StagedScene,
    illumination: Illumination,
    quality: Quality,
    size: tuple[int, int],
    box: tuple[int, int, int, int],
    key: tuple[int, int, int],
) -> TilePixels:
    """Return the pixels of a tile; a function of its arguments alone, to the last bit.

    Parameters
    ----------
    scene : StagedScene
        At the frame's stage angle.
    illumination : Illumination
        Of that scene; the tiles of a frame share it.
    quality : Quality
        The sampling.
    size : tuple of int
        Width and height of the picture.
    box : tuple of int
        x0, y0, x1, y1 of the tile; (0, 0) is the picture's top left corner.
    key : tuple of int
        (seed, frame, tile): keys the random numbers.
    """
    x0, y0, x1, y1 = box
    across = np.tile(np.arange(x0, x1, dtype=np.float64), y1 - y0)
    down = np.repeat(np.arange(y0, y1, dtype=np.float64), x1 - x0)
    count = across.size
    watch = Stopwatch()
    total, samples = np.zeros((3, count)), np.zeros(count)
    error = np.zeros(count)
    chosen = np.arange(count)
    events = 0
    for level, side in enumerate(quality.sides):
        roulette = Roulette(quality.roulette_below, random_numbers(*key, level))
        seen = Level(scene, illumination, size, side, quality.wavelengths, key[0], watch).render(
            across[chosen], down[chosen], roulette
        )
        events += seen.events
        total[:, chosen] += seen.total
        samples[chosen] += side * side
        error[chosen] = seen.error
        chosen = chosen[seen.edge | (seen.error > quality.refine_above)]
        watch.stop("film")
        if not chosen.size:
            break
    pixels = np.ascontiguousarray((total / samples).T, np.float32).reshape(y1 - y0, x1 - x0, 3)
    return TilePixels(pixels, float(np.sum(error**2)), watch.seconds, events)
