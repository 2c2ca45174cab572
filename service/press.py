"""From the units' results to files: frames, the animation, the manifest."""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from crystal_core import sequence
from crystal_core.output.images import encode_animated_webp, encode_png, encode_webp
from crystal_core.spectra.colour import to_srgb8
from service.artifacts import ArtifactStore
from service.records import FrameRow, Product, frame_name

__all__ = ["MANIFEST", "SEQUENCE", "manifest_bytes", "print_frame", "print_sequence"]

MANIFEST = "manifest.json"
SEQUENCE = "sequence.webp"

FRAME_MS = 100
"""How long a picture of the animation stands, ms."""


def print_frame(
    request: sequence.RenderRequest, index: int, results: Iterable[sequence.TileResult], store: ArtifactStore
) -> tuple[FrameRow, tuple[Product, ...]]:
    """Assemble a frame and keep it as PNG and WebP.

    Parameters
    ----------
    request : RenderRequest
        What is rendered.
    index : int
        Which frame.
    results : iterable of TileResult
        Those of all its tiles, in any order.
    store : ArtifactStore
        Where the files go.

    Returns
    -------
    FrameRow
        For the ledger.
    tuple of Product
        The two files.

    Raises
    ------
    OSError
        The disk is full or not writable.
    """
    frame = sequence.assemble(request, results)
    rgb8, _ = to_srgb8(frame.linear)
    png = _keep(store, frame_name(index, "png"), encode_png(rgb8), "image/png")
    webp = _keep(store, frame_name(index, "webp"), encode_webp(rgb8), "image/webp")
    row = FrameRow(
        index=index,
        angle_deg=sequence.frame_angle_deg(request, index),
        error_estimate=frame.error_estimate,
        seconds=frame.seconds,
        sha256=png.sha256,
    )
    return row, (png, webp)


def print_sequence(
    request: sequence.RenderRequest, frames: Sequence[FrameRow], store: ArtifactStore
) -> tuple[Product, ...]:
    """Make the animation and the manifest of a finished run from its frames, and keep them.

    Raises
    ------
    OSError
        A frame's file is missing, or the disk is full or not writable.
    """
    pictures = [_read_png(store.path(frame.sha256).read_bytes()) for frame in frames]
    return (
        _keep(store, SEQUENCE, encode_animated_webp(pictures, FRAME_MS), "image/webp"),
        _keep(store, MANIFEST, manifest_bytes(request, frames, complete=True), "application/json"),
    )


def manifest_bytes(request: sequence.RenderRequest, frames: Sequence[FrameRow], *, complete: bool) -> bytes:
    """Return the manifest of the frames there are, as UTF-8 JSON."""
    records = [
        sequence.FrameRecord(
            index=frame.index,
            angle_deg=frame.angle_deg,
            file=frame_name(frame.index, "png"),
            sha256=frame.sha256,
            seconds=frame.seconds,
            error_estimate=frame.error_estimate,
        )
        for frame in frames
    ]
    manifest: dict[str, Any] = sequence.manifest(request, records, complete)
    return (json.dumps(manifest, indent=2, ensure_ascii=False) + "\n").encode()


def _keep(store: ArtifactStore, name: str, data: bytes, media_type: str) -> Product:
    return Product(name=name, sha256=store.put(data), media_type=media_type, size=len(data))


def _read_png(data: bytes) -> NDArray[np.uint8]:
    with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
        return np.asarray(picture.convert("RGB"))
