"""One run at work: which units are to be done, which results have come, which frames are whole."""

from __future__ import annotations

import concurrent.futures
from collections.abc import Iterator
from typing import Any

from crystal_core import sequence

__all__ = ["LiveRun"]

MOST_UNFINISHED_FRAMES = 4
"""No unit of a further frame begins while this many are waiting to be written: their pictures lie in memory."""


class LiveRun:
    """A run in the runner's hands; used by the runner's thread alone.

    Parameters
    ----------
    run_id : str
        Its id in the ledger.
    request : RenderRequest
        What is rendered.
    tiles : int
        Tiles of one frame.
    frames_done : set of int
        Frames that are finished already.
    results : dict of dict
        Results that are there already, by frame and tile, of unfinished frames.
    """

    def __init__(
        self,
        run_id: str,
        request: sequence.RenderRequest,
        tiles: int,
        frames_done: set[int],
        results: dict[int, dict[int, sequence.TileResult]],
    ) -> None:
        self.id = run_id
        self.request = request
        self.tiles = tiles
        self.started = False
        self.over = False
        self.in_flight: dict[tuple[int, int], concurrent.futures.Future[sequence.TileResult]] = {}
        self._frames_done = frames_done
        self._results = results
        self._writing = {frame for frame in results if len(results[frame]) == tiles}
        self._units = self._open_units()
        self._next: tuple[int, int] | None = next(self._units, None)

    @property
    def has_units(self) -> bool:
        """Whether a unit can begin now."""
        return not self.over and self._next is not None and len(self._writing) < MOST_UNFINISHED_FRAMES

    @property
    def complete(self) -> bool:
        """Whether all frames are finished."""
        return len(self._frames_done) == self.request.frames

    def take_unit(self) -> tuple[int, int]:
        """Return the next unit (frame, tile); only if there is one."""
        assert self._next is not None
        unit, self._next = self._next, next(self._units, None)
        return unit

    def add(self, frame: int, tile: int, result: sequence.TileResult) -> bool:
        """Take a unit's result; return whether its frame is whole by it and is to be written."""
        results = self._results.setdefault(frame, {})
        results[tile] = result
        if len(results) < self.tiles:
            return False
        self._writing.add(frame)
        return True

    def results(self, frame: int) -> list[sequence.TileResult]:
        """Return the results of a whole frame in the order of its tiles."""
        return [result for _, result in sorted(self._results[frame].items())]

    def whole_frames(self) -> list[int]:
        """Return the frames that are whole but not finished, by index."""
        return sorted(self._writing)

    def frame_done(self, frame: int) -> None:
        """Note that a frame is written, and let go of its results."""
        self._frames_done.add(frame)
        self._writing.discard(frame)
        del self._results[frame]

    def stop(self) -> None:
        """Begin no more units, cancel those that have not begun."""
        self.over = True
        for future in list(self.in_flight.values()):
            future.cancel()

    def _open_units(self) -> Iterator[tuple[int, int]]:
        here: dict[int, Any] = {frame: set(tiles) for frame, tiles in self._results.items()}
        for frame in range(self.request.frames):
            if frame not in self._frames_done:
                yield from ((frame, tile) for tile in range(self.tiles) if tile not in here.get(frame, ()))
