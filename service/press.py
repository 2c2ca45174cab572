"""From the units' results to files: frames, the animation, the manifest."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterable, Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from crystal_core import sequence
from crystal_core.output.images import (
    animation_frame_ms,
    decode_png,
    encode_animated_webp,
    encode_png,
    encode_webp,
)
from crystal_core.spectra.colour import to_srgb8
from service.artifacts import ArtifactStore
from service.records import FrameRow, Product, frame_name

__all__ = ["MANIFEST", "SEQUENCE", "manifest_bytes", "print_frame", "print_sequence"]

MANIFEST = "manifest.json"
SEQUENCE = "sequence.webp"


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
    rgb8, clipped_fraction = to_srgb8(frame.linear)
    png = _keep(store, frame_name(index, "png"), encode_png(rgb8), "image/png")
    webp = _keep(store, frame_name(index, "webp"), encode_webp(rgb8), "image/webp")
    row = FrameRow(
        index=index,
        angle_deg=sequence.frame_angle_deg(request, index),
        error_estimate=frame.error_estimate,
        seconds=frame.seconds,
        sha256=png.sha256,
        clipped_fraction=clipped_fraction,
    )
    return row, (png, webp)


def print_sequence(
    request: sequence.RenderRequest, frames: Sequence[FrameRow], store: ArtifactStore, stop: threading.Event
) -> tuple[Product, ...]:
    """Make the animation and the manifest of a finished run from its frames, and keep them.

    Parameters
    ----------
    request : RenderRequest
        What was rendered.
    frames : sequence of FrameRow
        All its frames.
    store : ArtifactStore
        Where the files are and go.
    stop : Event
        Set from another thread, it ends the work: a long film takes longer than a stopping service may.

    Returns
    -------
    tuple of Product
        The two files.

    Raises
    ------
    InterruptedError
        ``stop`` was set.
    OSError
        A frame's file is missing, or the disk is full or not writable.
    """
    film = encode_animated_webp(_KeptFrames(store, frames, stop), animation_frame_ms(len(frames)))
    return (
        _keep(store, SEQUENCE, film, "image/webp"),
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
            clipped_fraction=frame.clipped_fraction,
        )
        for frame in frames
    ]
    manifest: dict[str, Any] = sequence.manifest(request, records, complete)
    return (json.dumps(manifest, indent=2, ensure_ascii=False) + "\n").encode()


def _keep(store: ArtifactStore, name: str, data: bytes, media_type: str) -> Product:
    return Product(name=name, sha256=store.put(data), media_type=media_type, size=len(data))


class _KeptFrames(Sequence[NDArray[np.uint8]]):
    """The pictures of finished frames, each read when it is asked for: a long film need not fit into memory."""

    def __init__(self, store: ArtifactStore, frames: Sequence[FrameRow], stop: threading.Event) -> None:
        self._stop = stop
        self._files = [store.path(frame.sha256) for frame in frames]

    def __len__(self) -> int:
        return len(self._files)

    @overload
    def __getitem__(self, index: int) -> NDArray[np.uint8]: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[NDArray[np.uint8]]: ...

    def __getitem__(self, index: int | slice) -> NDArray[np.uint8] | Sequence[NDArray[np.uint8]]:
        if isinstance(index, slice):
            return [self[one] for one in range(len(self))[index]]
        if self._stop.is_set():
            raise InterruptedError("the service is stopping")
        return decode_png(self._files[index].read_bytes())
