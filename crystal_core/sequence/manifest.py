"""The manifest of a sequence: what was asked, what was made, and what repeats the geometry by hand."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import crystal_core
import minerals_db
from crystal_core.sequence.request import RenderRequest, code_digest

__all__ = ["FrameRecord", "manifest"]


@dataclass(frozen=True)
class FrameRecord:
    """One finished frame.

    Parameters
    ----------
    index : int
        Its place in the sequence.
    angle_deg : float
        Stage angle.
    file, sha256 : str
        Name of its file, and the file's sha256 (hex).
    seconds : float
        Seconds of work, those of all workers together.
    error_estimate : float
        Estimated RMS error in linear sRGB, white = 1.
    clipped_fraction : float
        Part of the pixels that the gamut rule changed.
    """

    index: int
    angle_deg: float
    file: str
    sha256: str
    seconds: float
    error_estimate: float
    clipped_fraction: float


def manifest(request: RenderRequest, frames: Sequence[FrameRecord], complete: bool) -> dict[str, Any]:
    """Return the manifest as JSON-able values.

    Parameters
    ----------
    request : RenderRequest
        What was asked for.
    frames : sequence of FrameRecord
        The finished frames, in any order.
    complete : bool
        Whether all frames and the animation are there.
    """
    ordered = sorted(frames, key=lambda record: record.index)
    return {
        **request.described(),
        "seed": request.seed,
        "versions": {
            "isogyre": crystal_core.__version__,
            "code": code_digest(),
            "minerals": minerals_db.data_digest(),
            "python": platform.python_version(),
            "numpy": np.__version__,
        },
        "request_digest": request.digest(),
        "size": list(request.size),
        "frame_count": request.frames,
        "quality": request.quality,
        "error_estimate": max((record.error_estimate for record in ordered), default=None),
        "reproducible": True,
        "gamut": "linear sRGB clipped to 0–1 per channel",
        "frames": [asdict(record) for record in ordered],
        "complete": complete,
    }
