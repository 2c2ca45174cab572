"""Quality levels: how many samples a pixel gets, and the error they are to reach."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

__all__ = ["QUALITIES", "Quality"]


@dataclass(frozen=True)
class Quality:
    """Sampling of a picture.

    Parameters
    ----------
    name : str
        "draft", "standard" or "fine".
    target_error : float
        Bound on the RMS difference in linear sRGB (white = 1, box pixel filter) from the converged picture.
    positions : tuple of int
        Positions per pixel: of every pixel first, then, one level after the other, of the pixels whose estimated
        error still exceeds `refine_above`. Powers of 4, or 2: then the points are stratified.
    wavelengths : int
        Wavelengths per position; those of the positions of a level interleave.
    refine_above : float
        Estimated standard error above which a pixel goes on to the next level.
    roulette_below : float
        Weight of a branch, as a part of its pixel's wavelength, below which it is ended at random without bias.
    """

    name: str
    target_error: float
    positions: tuple[int, ...]
    wavelengths: int
    refine_above: float
    roulette_below: float


QUALITIES: Mapping[str, Quality] = MappingProxyType(
    {
        "draft": Quality("draft", 0.06, (2,), 4, 1.0, 0.15),
        "standard": Quality("standard", 0.015, (4, 16), 4, 0.06, 0.1),
        "fine": Quality("fine", 0.004, (16, 64), 8, 0.006, 0.03),
    }
)
