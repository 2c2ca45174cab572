"""A pilot: some hundred pixels of a frame, rendered to learn how much work it needs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crystal_core.render.illumination import Illumination
from crystal_core.render.level import Level
from crystal_core.render.quality import Quality
from crystal_core.render.sampling import random_numbers
from crystal_core.render.tracer import Roulette, Stopwatch
from crystal_core.scene import StagedScene

__all__ = ["tuned_quality"]

PIXELS = 400

PLASTIC = 1.32471795724474602596
"""Root of x³ = x + 1: its powers spread points evenly over a square (M. Roberts, R2 sequence, 2018)."""

GROWTH_EXPONENT = 1.2
"""The squared error grows with the roulette's threshold by at least about this power, on all faces of calcite."""

LOWEST = 0.02

PILOT_LEVEL = 2**32
"""Stands in the random numbers' key where other passes have their level."""


def tuned_quality(
    scene: StagedScene, illumination: Illumination, quality: Quality, size: tuple[int, int], key: tuple[int, int]
) -> Quality:
    """Return the quality adjusted so that this frame keeps its promise.

    How much light goes round inside the specimen, and how much of the picture shows it, depends on view and mineral.
    Where the quality's own settings would not do, roulette gets gentler and more pixels go on to the next level. The
    decision is taken once per frame, from the request alone.

    Parameters
    ----------
    scene : StagedScene
        At the frame's stage angle.
    illumination : Illumination
        Of that scene.
    quality : Quality
        Of the request.
    size : tuple of int
        Width and height of the picture.
    key : tuple of int
        (seed, frame).
    """
    step = np.arange(1, PIXELS + 1)
    across = np.floor(size[0] * ((0.5 + step / PLASTIC) % 1.0))
    down = np.floor(size[1] * ((0.5 + step / PLASTIC**2) % 1.0))
    level = Level(scene, illumination, size, quality.sides[0], quality.wavelengths, key[0], Stopwatch())
    seed, frame = key
    roulette = Roulette(quality.roulette_below, random_numbers(seed, frame, 0, PILOT_LEVEL))
    seen = level.render(across, down, roulette)
    squared = np.sort(seen.error**2)[::-1]
    # The estimate takes the print that two halves of a pixel see for error, which it is not: that is the reserve.
    allowed = PIXELS * quality.target_error**2
    if len(quality.sides) == 1:
        lower = allowed / float(squared.sum())
        return quality if lower >= 1 else replace(quality, roulette_below=_lowered(quality, lower))
    # Squared error of the frame if its n worst pixels go on to the next level, for every n.
    gain = 1.0 + (quality.sides[1] / quality.sides[0]) ** 2
    total = float(squared.sum())
    left = total - np.concatenate(((0.0,), np.cumsum(squared))) * (1.0 - 1.0 / gain)
    planned = int(np.count_nonzero(seen.edge | (seen.error > quality.refine_above)))
    if left[planned] <= allowed:
        return quality
    # Half of the way by gentler roulette, which does nothing for edges and print; all of it by more pixels that go on.
    enough = int(np.argmax(left <= allowed)) if left[-1] <= allowed else PIXELS
    return replace(
        quality,
        roulette_below=_lowered(quality, max(allowed / left[planned], 0.5)),
        refine_above=min(quality.refine_above, float(np.sqrt(squared[min(enough, PIXELS - 1)]))),
    )


def _lowered(quality: Quality, factor: float) -> float:
    """Return the roulette's threshold that makes the squared error about `factor` times what it is."""
    below: float = quality.roulette_below * factor ** (1.0 / GROWTH_EXPONENT)
    return max(below, LOWEST)
