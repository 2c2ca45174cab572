"""Turns accepted jobs into units of work and their results into frames."""

from __future__ import annotations

import concurrent.futures
import functools
import queue
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import structlog
from sqlalchemy.exc import SQLAlchemyError

from crystal_core import sequence
from service.artifacts import ArtifactStore
from service.engine import Engine, InlineEngine
from service.events import Bell
from service.ledger import Ledger
from service.press import print_frame, print_sequence
from service.problems import ProblemError
from service.records import FrameRow, Job, Product, Run
from service.runs import LiveRun
from service.tile_shelf import TileShelf

__all__ = ["Runner"]

UNITS_PER_WORKER = 3
"""Units handed to the engine per worker: enough that none waits, few enough that a new run soon has its share."""


class Runner:
    """Works on the ledger's live runs, in one thread of its own that is the only one to change them.

    Parameters
    ----------
    ledger : Ledger
        Knows the runs.
    engine : Engine
        Does the units.
    store : ArtifactStore
        Takes frames, animation and manifest.
    shelf : TileShelf
        Takes the results of units until their frame is finished.
    bell : Bell
        Told whenever a run has something new.
    assets : Path
        Folder of pictures that requests name by digest.
    """

    def __init__(
        self, ledger: Ledger, engine: Engine, store: ArtifactStore, shelf: TileShelf, bell: Bell, assets: Path
    ) -> None:
        self._ledger = ledger
        self._engine = engine
        self._store = store
        self._shelf = shelf
        self._bell = bell
        self._assets = assets
        self._log = structlog.get_logger("isogyre.jobs")
        self._inbox: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._runs: dict[str, LiveRun] = {}
        self._in_flight = 0
        self._stop = threading.Event()
        self._press = InlineEngine()  # encoding keeps its thread busy, and the runner's must stay free
        self._thread = threading.Thread(target=self._loop, name="isogyre-runner", daemon=True)

    @property
    def alive(self) -> bool:
        """Whether accepted jobs are being worked on."""
        return self._thread.is_alive()

    def open(self) -> None:
        """Take up the live runs that an earlier process left, and begin to work."""
        live = self._ledger.live_runs()
        swept = self._shelf.sweep(run.id for run in live) + self._store.sweep()
        if live or swept:
            self._log.info("taking up", runs=[run.id for run in live], leftovers_removed=swept)
        for run in live:
            self._inbox.put(functools.partial(self._take_up, run))
        self._thread.start()

    def close(self) -> None:
        """Stop; what has not ended stays live in the ledger for the next process."""
        self._stop.set()
        self._inbox.put(None)
        if self._thread.ident is not None:
            self._thread.join()
        self._press.close()

    def submit(self, request: sequence.RenderRequest) -> Job:
        """Accept a job for a request; from any thread.

        Returns
        -------
        Job
            It is in the ledger on return.
        """
        frames, tiles = request.frames, len(sequence.tile_grid(request))
        job, new = self._ledger.submit(request.canonical(), request.digest(), frames=frames, tiles=frames * tiles)
        self._log.info("accepted", job=job.id, run=job.run.id, shared=not new, frames=frames, tiles=frames * tiles)
        if new:
            self._inbox.put(functools.partial(self._take_up, job.run))
        return job

    def dismiss(self, job_id: str) -> None:
        """Detach a job from its run; the run stops with its last job. From any thread."""
        ended = self._ledger.dismiss(job_id)
        self._log.info("dismissed", job=job_id, run=ended.id if ended else None)
        if ended is not None:
            self._inbox.put(functools.partial(self._drop, ended.id))

    # Everything below runs in the runner's thread.

    def _loop(self) -> None:
        try:
            while (step := self._inbox.get()) is not None:
                step()
        except Exception:
            self._log.critical("the runner has failed; jobs wait until the service is started again", exc_info=True)
            raise

    def _guarded(self, run_id: str, where: str, step: Callable[[], None], unit: tuple[int, int] | None = None) -> None:
        """Do a step; what goes wrong in it fails its run alone."""
        try:
            step()
        except Exception as error:
            self._fail(run_id, where, error, unit)

    def _take_up(self, stored: Run) -> None:
        self._guarded(stored.id, "taking up the request", lambda: self._prepare(stored))
        self._pump()

    def _prepare(self, stored: Run) -> None:
        request = sequence.read_request(stored.request)  # an InputError, if another version accepted it
        tiles = len(sequence.tile_grid(request))
        if request.digest() != stored.digest:
            self._log.warning("begun anew: code or data have changed", run=stored.id)
            self._shelf.drop_run(stored.id)
            self._ledger.restart(stored.id, request.digest(), request.frames * tiles)
        frames_done = {frame.index for frame in self._ledger.frames(stored.id)}
        run = LiveRun(stored.id, request, tiles, frames_done, self._kept_results(stored.id, frames_done))
        run.started = stored.status == "running"
        self._runs[run.id] = run
        for frame in run.whole_frames():
            self._write_frame(run, frame)
        if run.complete:
            self._write_sequence(run)

    def _kept_results(self, run_id: str, frames_done: set[int]) -> dict[int, dict[int, sequence.TileResult]]:
        results: dict[int, dict[int, sequence.TileResult]] = {}
        lost: list[tuple[int, int]] = []
        for unit in self._ledger.units(run_id):
            if unit.frame in frames_done:
                continue
            result = self._shelf.get(run_id, unit.frame, unit.tile, unit.sha256)
            if result is None:
                lost.append((unit.frame, unit.tile))
            else:
                results.setdefault(unit.frame, {})[unit.tile] = result
        if lost:
            self._log.warning("results of units are gone and will be made again", run=run_id, units=len(lost))
            self._ledger.lose_units(run_id, lost)
        return results

    def _pump(self) -> None:
        """Hand units to the engine while it has room: to the run that has the fewest there, the oldest first."""
        while self._in_flight < UNITS_PER_WORKER * self._engine.workers:
            ready = [run for run in self._runs.values() if run.has_units]
            if not ready:
                return
            run = min(ready, key=lambda run: len(run.in_flight))
            frame, tile = run.take_unit()
            self._guarded(run.id, f"frame {frame}, tile {tile}", functools.partial(self._hand_over, run, frame, tile))

    def _hand_over(self, run: LiveRun, frame: int, tile: int) -> None:
        if not run.started:
            run.started = True
            self._ledger.start(run.id)
            self._bell.ring(run.id)
        key = f"{run.id}/{frame}/{tile}"
        future = self._engine.submit(sequence.render_tile, run.request, frame, tile, self._assets, key=key)
        run.in_flight[frame, tile] = future
        self._in_flight += 1
        future.add_done_callback(
            lambda future: self._inbox.put(functools.partial(self._unit_ended, run, frame, tile, future))
        )

    def _unit_ended(
        self, run: LiveRun, frame: int, tile: int, future: concurrent.futures.Future[sequence.TileResult]
    ) -> None:
        self._in_flight -= 1
        del run.in_flight[frame, tile]
        if not run.over:

            def step() -> None:
                self._keep(run, frame, tile, future.result())

            self._guarded(run.id, f"frame {frame}, tile {tile}", step, (frame, tile))
        self._pump()

    def _keep(self, run: LiveRun, frame: int, tile: int, result: sequence.TileResult) -> None:
        digest = self._shelf.put(run.id, frame, tile, result)  # first the file, then the row that says it is there
        if not self._ledger.finish_unit(run.id, frame, tile, sha256=digest, seconds=result.seconds):
            self._drop(run.id)
            return
        self._log.debug("unit finished", run=run.id, frame=frame, tile=tile, seconds=result.seconds)
        self._bell.ring(run.id)
        if run.add(frame, tile, result):
            self._write_frame(run, frame)

    def _write_frame(self, run: LiveRun, frame: int) -> None:
        def done(written: tuple[FrameRow, tuple[Product, ...]]) -> None:
            row, products = written
            if not self._ledger.finish_frame(run.id, row, products):
                self._drop(run.id)
                return
            run.frame_done(frame)
            self._shelf.drop_frame(run.id, frame)
            self._log.info("frame finished", run=run.id, frame=frame, error_estimate=row.error_estimate)
            self._bell.ring(run.id)
            if run.complete:
                self._write_sequence(run)

        future = self._press.submit(
            print_frame, run.request, frame, run.results(frame), self._store, key=f"{run.id}/{frame}", priority=1
        )
        self._when_pressed(run, f"frame {frame}", future, done)

    def _write_sequence(self, run: LiveRun) -> None:
        def done(products: tuple[Product, ...]) -> None:
            if self._ledger.succeed(run.id, products):
                self._log.info("finished", run=run.id)
            self._drop(run.id)

        frames = self._ledger.frames(run.id)
        key = f"{run.id}/sequence"
        future = self._press.submit(print_sequence, run.request, frames, self._store, self._stop, key=key)
        self._when_pressed(run, "the animation", future, done)

    def _when_pressed(
        self, run: LiveRun, where: str, future: concurrent.futures.Future[Any], done: Callable[[Any], None]
    ) -> None:
        def ended() -> None:
            if not run.over and not self._stop.is_set():
                self._guarded(run.id, where, lambda: done(future.result()))
            self._pump()

        future.add_done_callback(lambda _: self._inbox.put(ended))

    def _fail(self, run_id: str, where: str, error: Exception, unit: tuple[int, int] | None) -> None:
        self._log.error("failed", run=run_id, where=where, exc_info=error)
        try:
            self._ledger.fail(run_id, ProblemError.of_failure(error, where).problem.model_dump(), unit)
        except SQLAlchemyError:  # such as a full disk: the run stays live in the ledger, for the next start
            self._log.critical("the ledger does not take a failure", run=run_id, exc_info=True)
        self._drop(run_id)

    def _drop(self, run_id: str) -> None:
        """Let go of a run that has ended, whatever its end."""
        run = self._runs.pop(run_id, None)
        if run is not None:
            run.stop()
        self._shelf.drop_run(run_id)
        self._bell.ring(run_id)
