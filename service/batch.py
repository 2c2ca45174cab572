"""Renders a sequence into a folder."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import overload

import numpy as np
from numpy.typing import NDArray

from crystal_core import sequence
from crystal_core.errors import IsogyreError
from crystal_core.output.images import animation_frame_ms, decode_png, encode_animated_webp, encode_png
from crystal_core.spectra.colour import to_srgb8
from service.batch_folder import BatchFolder
from service.engine import Engine

__all__ = ["Batch", "BatchError"]

UNITS_PER_WORKER = 4
"""Units in flight for each worker: it never waits while a frame is being written, and little is lost at an end."""

_PATIENCE_S = 0.2
"""How long the batch may go without a look at whether it is to stop, s."""


class BatchError(IsogyreError):
    """A unit failed; the frames finished before are kept."""


class Batch:
    """The frames that are missing in a folder, and the way to make them.

    Parameters
    ----------
    folder : BatchFolder
        Where they go.
    assets : Path
        Folder of the files that the request names.
    keep_on : callable
        Called often; raises to stop.
    """

    def __init__(self, folder: BatchFolder, assets: Path, keep_on: Callable[[], None]) -> None:
        self.folder = folder
        self.request = folder.request
        self.tiles = len(sequence.tile_grid(self.request))
        self.frames = folder.missing
        self._assets = assets
        self._keep_on = keep_on

    @property
    def units(self) -> int:
        """Number of units of work to be done."""
        return len(self.frames) * self.tiles

    def render(self, engine: Engine, on_unit: Callable[[], None]) -> None:
        """Render the missing frames; each is in the folder as soon as its last unit is done.

        Parameters
        ----------
        engine : Engine
            Where the units run.
        on_unit : callable
            Called after each.

        Raises
        ------
        BatchError
            A unit failed.
        OSError
            A file could not be written.
        """
        units = ((frame, tile) for frame in self.frames for tile in range(self.tiles))
        flying: dict[concurrent.futures.Future[sequence.TileResult], tuple[int, int]] = {}
        results: dict[int, list[sequence.TileResult]] = {}
        try:
            while self._launch(engine, units, flying):
                self._keep_on()
                ended, _ = concurrent.futures.wait(flying, _PATIENCE_S, concurrent.futures.FIRST_COMPLETED)
                for future in sorted(ended, key=flying.__getitem__):  # what is told of a failure is told of the first
                    frame, tile = flying.pop(future)
                    of_frame = results.setdefault(frame, [])
                    of_frame.append(self._result(future, frame, tile))
                    if len(of_frame) == self.tiles:
                        self._write(frame, results.pop(frame))
                    on_unit()
        finally:
            for future in flying:
                future.cancel()

    def finish(self) -> None:
        """Make the animation of all frames, and call the sequence complete.

        Raises
        ------
        OSError
            A file could not be read or written.
        """
        frame_ms = animation_frame_ms(self.request.frames)
        self.folder.finish(encode_animated_webp(_WrittenFrames(self.folder, self._keep_on), frame_ms), frame_ms)

    def _launch(
        self,
        engine: Engine,
        units: Iterator[tuple[int, int]],
        flying: dict[concurrent.futures.Future[sequence.TileResult], tuple[int, int]],
    ) -> bool:
        """Fill up what is in flight; return whether anything is."""
        while len(flying) < UNITS_PER_WORKER * engine.workers and (unit := next(units, None)) is not None:
            frame, tile = unit
            future = engine.submit(
                sequence.render_tile, self.request, frame, tile, self._assets, key=f"frame-{frame}-tile-{tile}"
            )
            flying[future] = unit
        return bool(flying)

    def _result(
        self, future: concurrent.futures.Future[sequence.TileResult], frame: int, tile: int
    ) -> sequence.TileResult:
        try:
            return future.result()
        except Exception as error:
            raise BatchError(f"frame {frame}, tile {tile} failed: {type(error).__name__}: {error}") from error

    def _write(self, index: int, results: Sequence[sequence.TileResult]) -> None:
        frame = sequence.assemble(self.request, results)
        rgb8, clipped_fraction = to_srgb8(frame.linear)
        self.folder.add_frame(
            index,
            encode_png(rgb8),
            seconds=frame.seconds,
            error_estimate=frame.error_estimate,
            clipped_fraction=clipped_fraction,
        )


class _WrittenFrames(Sequence[NDArray[np.uint8]]):
    """The frames of a folder, read when they are asked for: a long film does not fit into memory."""

    def __init__(self, folder: BatchFolder, keep_on: Callable[[], None]) -> None:
        self._folder = folder
        self._keep_on = keep_on

    def __len__(self) -> int:
        return self._folder.request.frames

    @overload
    def __getitem__(self, index: int) -> NDArray[np.uint8]: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[NDArray[np.uint8]]: ...
    def __getitem__(self, index: int | slice) -> NDArray[np.uint8] | Sequence[NDArray[np.uint8]]:
        if isinstance(index, slice):
            return [self[one] for one in range(len(self))[index]]
        self._keep_on()
        return decode_png(self._folder.read_frame(range(len(self))[index]))
