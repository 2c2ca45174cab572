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
    sides : tuple of int
        A pixel is cut into side × side cells, one position in each: first every pixel, then, one level after the
        other, the pixels whose estimated error exceeds `refine_above` or in which positions meet different faces.
    wavelengths : int
        Per position; those of the positions of a level interleave.
    refine_above : float
        Estimated standard error above which a pixel goes on to the next level.
    roulette_below : float
        Importance of a branch, as a part of its pixel's, below which it is ended at random without bias.
    """

    name: str
    target_error: float
    sides: tuple[int, ...]
    wavelengths: int
    refine_above: float
    roulette_below: float


QUALITIES: Mapping[str, Quality] = MappingProxyType(
    {
        "draft": Quality("draft", 0.06, (2,), 2, 1.0, 0.2),
        "standard": Quality("standard", 0.015, (2, 4), 4, 0.1, 0.25),
        "fine": Quality("fine", 0.004, (4, 8), 8, 0.006, 0.03),
    }
)
