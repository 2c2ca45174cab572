"""Tells waiting event streams that a run has something new. What is new stands in the ledger."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Iterator

__all__ = ["Bell"]


class Bell:
    """Wakes the streams of a run.

    Rung from any thread; listened to from event loops.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._listeners: dict[str, set[tuple[asyncio.AbstractEventLoop, asyncio.Event]]] = {}
        self._closed = False

    @property
    def closed(self) -> bool:
        """Whether the service is going down and streams are to end."""
        return self._closed

    @contextlib.contextmanager
    def listen(self, run_id: str) -> Iterator[asyncio.Event]:
        """Give an event that is set whenever the run has something new; within a running event loop."""
        ear = (asyncio.get_running_loop(), asyncio.Event())
        with self._lock:
            self._listeners.setdefault(run_id, set()).add(ear)
        if self._closed:
            ear[1].set()
        try:
            yield ear[1]
        finally:
            with self._lock:
                ears = self._listeners[run_id]
                ears.discard(ear)
                if not ears:
                    del self._listeners[run_id]

    def ring(self, run_id: str) -> None:
        """Wake all who listen to this run."""
        with self._lock:
            ears = list(self._listeners.get(run_id, ()))
        _wake(ears)

    def close(self) -> None:
        """Wake everybody for the last time."""
        with self._lock:
            self._closed = True
            ears = [ear for group in self._listeners.values() for ear in group]
        _wake(ears)


def _wake(ears: list[tuple[asyncio.AbstractEventLoop, asyncio.Event]]) -> None:
    for loop, event in ears:
        with contextlib.suppress(RuntimeError):  # the loop has ended meanwhile, and its stream with it
            loop.call_soon_threadsafe(event.set)
