"""Where units of work run: one thread of this process, or processes of their own under Dask.

Both engines honour one contract, tested once for both in ``tests/service/test_engine.py``:

- ``submit`` may be called from any thread and returns at once;
- a unit's result or exception arrives in a ``concurrent.futures.Future``;
- ``future.cancel()`` stops a unit that has not begun (one that has begun runs on, and a Dask engine drops its result);
- a higher ``priority`` goes first, equal ones in the order of submission (each worker may have been handed one unit
  ahead of its turn, so that it never waits);
- ``close`` cancels what has not begun and returns when nothing of the engine is left.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import heapq
import importlib
import itertools
import logging
import os
import signal
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol, Self, TypeVar

from crystal_core.errors import InputError, IsogyreError

__all__ = ["DaskEngine", "Engine", "EngineClosedError", "InlineEngine", "UnitLostError", "open_engine"]

T = TypeVar("T")

WORKER_MEMORY = "2 GiB"
"""A unit that makes its process grow beyond this loses the process."""

ATTEMPTS = 2
"""A unit that was at hand when this many worker processes died is suspected and tried again, apart from other suspects;
if as many die again, it is given up."""

_TRIAL_PRIORITY = 1_000_000

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"), "1")

_DASK_CONFIG = {
    # A unit that kills its process fails alone after this many deaths; the rest goes on.
    "distributed.scheduler.allowed-failures": ATTEMPTS - 1,
    # The HTTP pages of scheduler and workers are of no use here: nothing is served but by us.
    "distributed.scheduler.http.routes": [],
    "distributed.worker.http.routes": [],
    "distributed.worker.profile.enabled": False,
    "distributed.diagnostics.nvml": False,
}


class EngineClosedError(IsogyreError):
    """A unit was submitted to an engine that has been closed."""


class UnitLostError(IsogyreError):
    """A unit ended every worker process that tried it; it has no result."""


class Engine(Protocol):
    """Runs units of work."""

    @property
    def workers(self) -> int:
        """Number of units that can run at the same time."""
        ...

    def submit(
        self, function: Callable[..., T], /, *args: object, key: str, priority: int = 0
    ) -> concurrent.futures.Future[T]:
        """Queue ``function(*args)``.

        Parameters
        ----------
        function : callable
            A module-level function; it and its arguments must pickle.
        *args : object
            Its arguments.
        key : str
            The unit's name in logs and errors; two submissions of one key are two units.
        priority : int
            Higher goes first.

        Returns
        -------
        concurrent.futures.Future
            The result or the exception of the unit.

        Raises
        ------
        EngineClosedError
            After ``close``.
        """
        ...

    def close(self) -> None:
        """Cancel what has not begun, wait for what has, end all processes and threads of the engine."""
        ...

    def __enter__(self) -> Self:
        """Return the engine itself."""
        ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the engine."""
        ...


class _Closing:
    """Makes an engine a context manager."""

    def close(self) -> None:
        raise NotImplementedError

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class InlineEngine(_Closing):
    """One background thread of this process; for the command line and for tests."""

    def __init__(self) -> None:
        self._order = itertools.count()
        self._queue: list[tuple[int, int, Callable[[], None]]] = []
        self._waiting: dict[int, concurrent.futures.Future[Any]] = {}
        self._closed = False
        self._wake = threading.Condition()
        self._thread = threading.Thread(target=self._loop, name="isogyre-inline-engine", daemon=True)
        self._thread.start()

    @property
    def workers(self) -> int:
        """Number of units that can run at the same time: one."""
        return 1

    def submit(
        self, function: Callable[..., T], /, *args: object, key: str, priority: int = 0
    ) -> concurrent.futures.Future[T]:
        """Queue ``function(*args)``; see `Engine.submit`."""
        future: concurrent.futures.Future[T] = concurrent.futures.Future()

        def run() -> None:
            if not future.set_running_or_notify_cancel():
                return
            try:
                result = function(*args)
            except BaseException as error:  # the thread must outlive any unit; the caller gets the error
                future.set_exception(error)
            else:
                future.set_result(result)

        with self._wake:
            if self._closed:
                raise EngineClosedError(f"unit {key}: the engine has been closed")
            order = next(self._order)
            self._waiting[order] = future
            heapq.heappush(self._queue, (-priority, order, run))
            self._wake.notify()
        return future

    def _loop(self) -> None:
        while True:
            with self._wake:
                self._wake.wait_for(lambda: self._closed or bool(self._queue))
                if not self._queue:
                    return
                _, order, run = heapq.heappop(self._queue)
                del self._waiting[order]
            run()
            del run  # an idle engine holds on to no result

    def close(self) -> None:
        """Cancel what waits and let the running unit end."""
        with self._wake:
            self._closed = True
            waiting = list(self._waiting.values())
            self._wake.notify()
        for future in waiting:
            future.cancel()
        if threading.current_thread() is not self._thread:
            self._thread.join()


def _settle_in_worker(niceness: int) -> None:
    """Set up a worker process: below the service in priority, out of the terminal's process group.

    Ctrl-C goes to every process of the terminal's group; workers must live on until their service stops them.
    """
    with contextlib.suppress(PermissionError):  # a session leader stays where it is
        os.setpgid(0, 0)
    os.nice(niceness)


class DaskEngine(_Closing):
    """Worker processes on this machine, one thread each, under a Dask scheduler on loopback.

    Parameters
    ----------
    workers : int
        Number of processes, at least 1.
    niceness : int
        Added to the niceness of each worker, so that the service answers while they render.
    scratch : Path or None
        Folder for Dask's scratch files (workers keep none unless memory runs short). Files that a killed service left
        there are removed at the next start. None: a temporary folder of its own.

    Notes
    -----
    A scheduler's port runs code for whoever reaches it; this one listens on 127.0.0.1 only.
    ``OMP_NUM_THREADS`` and its kin are set to 1 in this process's environment too, for the workers to inherit: numeric
    libraries read them when they are loaded, before a worker could set them itself.
    """

    def __init__(self, workers: int, *, niceness: int = 5, scratch: Path | None = None) -> None:
        if workers < 1:
            raise InputError.at("/workers", f"must be at least 1, got {workers}")
        # Imported late: half a second that the inline engine need not spend. Dask is untyped, hence Any.
        dask: Any = importlib.import_module("dask")
        distributed: Any = importlib.import_module("distributed")

        class Settle(distributed.WorkerPlugin):  # type: ignore[misc]
            name = "isogyre-settle"

            def setup(self, worker: object) -> None:  # noqa: ARG002
                _settle_in_worker(niceness)

        self._workers = workers
        self._order = itertools.count()
        self._pending: set[concurrent.futures.Future[Any]] = set()
        self._lock = threading.Lock()
        self._closed = False
        self._trial = asyncio.Lock()
        self._own_scratch = None if scratch else tempfile.TemporaryDirectory(prefix="isogyre-engine-")
        folder = str(scratch) if scratch else self._own_scratch and self._own_scratch.name
        self._killed_worker: type[Exception] = distributed.KilledWorker
        self._cancelled_by_dask: type[Exception] = distributed.client.FutureCancelledError
        self._quiet = _QuietLogs()
        os.environ.update(_ONE_THREAD)
        with dask.config.set({**_DASK_CONFIG, "temporary-directory": folder}), _blocked_interrupts():
            self._cluster = distributed.LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                scheduler_kwargs={"dashboard": False},
                dashboard_address="127.0.0.1:0",
                worker_dashboard_address=None,
                memory_limit=WORKER_MEMORY,
                local_directory=folder,
                silence_logs=logging.CRITICAL,
            )
            self._client: Any = distributed.Client(self._cluster, set_as_default=False)
            self._client.register_plugin(Settle())

    @property
    def workers(self) -> int:
        """Number of units that can run at the same time."""
        return self._workers

    def submit(
        self, function: Callable[..., T], /, *args: object, key: str, priority: int = 0
    ) -> concurrent.futures.Future[T]:
        """Queue ``function(*args)``; see `Engine.submit`.

        The future's exception is `UnitLostError` if the unit ended twice ``ATTEMPTS`` processes.
        """
        with self._lock:
            if self._closed:
                raise EngineClosedError(f"unit {key}: the engine has been closed")

            def start(order: int) -> Any:
                # A key that Dask has not seen: it would answer a known one with the old result.
                name = f"unit-{next(self._order)}-{key}"
                return self._client.submit(function, *args, key=name, priority=order, pure=False, retries=0)

            carrying = self._carry(start, start(priority), key)
            future = asyncio.run_coroutine_threadsafe(carrying, self._client.loop.asyncio_loop)
            self._pending.add(future)
        future.add_done_callback(self._forget)
        return future

    def _forget(self, future: concurrent.futures.Future[Any]) -> None:
        with self._lock:
            self._pending.discard(future)

    async def _carry(self, start: Callable[[int], Any], task: Any, key: str) -> Any:
        """Wait for a Dask task on Dask's loop and let go of it, whatever becomes of it.

        Dask blames the death of a worker on every unit that was there, also on one that only waited for its turn. So a
        blamed unit has another trial: at once, and never together with another one that has been blamed.
        """
        try:
            try:
                return await task._result()
            except self._killed_worker:
                async with self._trial:
                    task.release()
                    task = start(_TRIAL_PRIORITY)
                    return await task._result()
        except self._killed_worker:
            raise UnitLostError(f"unit {key} ended {2 * ATTEMPTS} worker processes and was given up") from None
        except self._cancelled_by_dask as error:  # not by us: that cancels this coroutine
            raise UnitLostError(f"unit {key} was lost by the scheduler: {error}") from None
        finally:
            task.release()

    def close(self) -> None:
        """Cancel what waits, let running units end, end the workers."""
        with self._lock:
            if self._closed:
                return
            self._closed = True
            pending = list(self._pending)
        for future in pending:
            future.cancel()
        self._client.close()
        self._cluster.close()
        self._quiet.restore()
        if self._own_scratch:
            self._own_scratch.cleanup()


@contextlib.contextmanager
def _blocked_interrupts() -> Iterator[None]:
    """Start threads and processes with SIGINT blocked: Ctrl-C is this process's to handle, also while workers start."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _QuietLogs:
    """Keeps Dask's own log lines off stderr while an engine lives: what matters reaches the future of the unit."""

    _names = ("distributed", "distributed.client", "distributed.gc", "tornado", "tornado.application")

    def __init__(self) -> None:
        self._levels = {name: logging.getLogger(name).level for name in self._names}
        for name in self._names:
            logging.getLogger(name).setLevel(logging.CRITICAL)

    def restore(self) -> None:
        for name, level in self._levels.items():
            logging.getLogger(name).setLevel(level)


def open_engine(workers: int) -> Engine:
    """Return an engine for the command line.

    Parameters
    ----------
    workers : int
        1: this process (`InlineEngine`); more: that many processes (`DaskEngine`).

    Returns
    -------
    Engine

    Raises
    ------
    InputError
        If ``workers`` is below 1.
    """
    return InlineEngine() if workers == 1 else DaskEngine(workers)
