"""From a staged scene to linear sRGB pixels: backward rays in structure-of-arrays wavefronts."""

from crystal_core.render.illumination import Illumination
from crystal_core.render.memory import keep_freed_memory
from crystal_core.render.pilot import tuned_quality
from crystal_core.render.quality import QUALITIES, Quality
from crystal_core.render.tile import TilePixels, render_pixels

__all__ = ["QUALITIES", "Illumination", "Quality", "TilePixels", "keep_freed_memory", "render_pixels", "tuned_quality"]
