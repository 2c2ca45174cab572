"""Everything behind the HTTP interface, put together."""

from __future__ import annotations

import concurrent.futures
import fcntl
import os
from collections.abc import Callable, Mapping
from typing import Self, TypeVar

import structlog

from crystal_core import sequence
from crystal_core.errors import InputError
from service.artifacts import ArtifactStore, make_folder
from service.assets.shelf import AssetShelf
from service.engine import DaskEngine, Engine, EngineClosedError, UnitLostError
from service.events import Bell
from service.jobs import Runner
from service.ledger import Ledger
from service.problems import ProblemError
from service.scenes.validation import checked_request
from service.settings import Settings
from service.tile_shelf import TileShelf
from service.warmth import warm_up

__all__ = ["Workshop"]

T = TypeVar("T")

PATIENCE_S = 60.0
"""How long somebody who waits for an answer waits for a worker's."""

_ASKED = 10
"""Priority of what somebody waits for, over the units of renders."""


class Workshop:
    """Ledger, artifacts, engine and runner under one data directory; closed until `open` is called.

    Parameters
    ----------
    settings : Settings
        Where and how many.
    make_engine : callable or None
        Makes the engine; None: a `DaskEngine` after the settings.
    """

    settings: Settings
    bell: Bell
    ledger: Ledger
    store: ArtifactStore
    runner: Runner
    assets: AssetShelf

    def __init__(self, settings: Settings, make_engine: Callable[[], Engine] | None = None) -> None:
        self.settings = settings
        self.bell = Bell()
        self.is_open = False
        self._make_engine = make_engine or self._dask_engine
        self._log = structlog.get_logger("isogyre.workshop")

    def open(self) -> None:
        """Open the ledger, start the engine, take up what is unfinished.

        Raises
        ------
        InputError
            The data directory cannot be used, or another service uses it.
        """
        folder = self.settings.data_dir
        try:
            for name in ("", "artifacts", "units", "scratch"):
                make_folder(folder / name)
            self._lock = os.open(folder / "lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        except OSError as error:
            raise InputError.at("ISOGYRE_DATA_DIR", f"{folder} cannot be used: {error.strerror}") from error
        try:
            self._take_lock()
            self.ledger = Ledger(folder / "ledger.sqlite")
        except BaseException:
            os.close(self._lock)
            raise
        try:
            self.store = ArtifactStore(folder / "artifacts")
            self.assets = AssetShelf(folder / "assets")
            self.assets.sweep()
            self._engine = self._make_engine()
            shelf = TileShelf(folder / "units")
            self.runner = Runner(self.ledger, self._engine, self.store, shelf, self.bell, self.assets.folder)
            self.runner.open()
        except BaseException:
            self.ledger.close()
            os.close(self._lock)
            raise
        self.is_open = True
        self._log.info("open", data_dir=str(folder), workers=self._engine.workers)

    def close(self) -> None:
        """Stop; what has not ended is taken up at the next start."""
        if not self.is_open:
            return
        self.is_open = False
        self.bell.close()
        self.runner.close()
        self._engine.close()
        self.ledger.close()
        os.close(self._lock)
        self._log.info("closed")

    def read_request(self, body: Mapping[str, object]) -> sequence.RenderRequest:
        """Return the request of a render, checked; scenes and pictures are looked at in a worker.

        Raises
        ------
        InputError, NotSupportedError
            What is wrong with it, as `parse_request` tells it.
        ProblemError
            The workers are busy.
        """
        parameters = body.get("parameters")
        names_asset = isinstance(parameters, Mapping) and any(
            isinstance(value, str) and value.startswith("asset:") for value in parameters.values()
        )
        if "scene" in body or names_asset:
            return self.work_out(checked_request, body, self.assets.folder)
        return sequence.parse_request(body, self.assets.folder)

    def work_out(self, function: Callable[..., T], *args: object) -> T:
        """Return what a function makes of its arguments, in a worker, before anything that is being rendered.

        Parameters
        ----------
        function : callable
            A module-level function; it and its arguments must pickle.
        *args : object
            Its arguments.

        Raises
        ------
        ProblemError
            503: the workers are busy. 422: the function ended the processes that tried it.
        """
        try:
            future = self._engine.submit(function, *args, key=function.__name__, priority=_ASKED)
        except EngineClosedError as error:
            raise ProblemError(503, "not-ready", "The service is stopping") from error
        try:
            return future.result(PATIENCE_S)
        except TimeoutError:
            future.cancel()
            detail = f"No worker had an answer within {PATIENCE_S:g} s"
            raise ProblemError(503, "not-ready", detail, headers={"Retry-After": "10"}) from None
        except UnitLostError as error:
            raise ProblemError(422, "too-demanding", "It takes more memory than a worker has") from error

    def check(self) -> str | None:
        """Return why no render would be done now, None if all is well."""
        if not self.is_open:
            return "The service is starting or stopping"
        if not self.runner.alive:
            return "The runner has failed; the service must be started again"
        self.ledger.check()
        return None

    def __enter__(self) -> Self:
        """Open it."""
        self.open()
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    def _take_lock(self) -> None:
        # Two services on one ledger would do every job twice. The lock goes with the process, however it ends.
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            folder = self.settings.data_dir
            raise InputError.at("ISOGYRE_DATA_DIR", f"{folder} is in use by another running service") from None

    def _dask_engine(self) -> Engine:
        settings = self.settings
        engine = DaskEngine(settings.workers, niceness=settings.worker_niceness, scratch=settings.data_dir / "scratch")
        for _ in range(settings.workers):  # the workers are equally free: each gets one
            warmth = engine.submit(warm_up, key="warm-up")
            warmth.add_done_callback(self._tell_of_cold)
        return engine

    def _tell_of_cold(self, warmth: concurrent.futures.Future[None]) -> None:
        if not warmth.cancelled() and (error := warmth.exception()) is not None:
            self._log.warning("a worker could not warm up", exc_info=error)
