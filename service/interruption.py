"""Ctrl-C and its kin as a question that the work asks, not as an exception out of nowhere."""

from __future__ import annotations

import signal
from types import FrameType, TracebackType
from typing import Any, Self

from crystal_core.errors import IsogyreError

__all__ = ["Interruption", "InterruptionError"]


class InterruptionError(IsogyreError):
    """The work ended early because a signal asked for it."""


class Interruption:
    """Takes SIGINT, SIGTERM and SIGHUP while it is entered, and remembers the first; main thread only.

    A second Ctrl-C raises `KeyboardInterrupt`, for whoever cannot wait. A SIGHUP that is ignored (nohup) stays so.
    """

    def __init__(self) -> None:
        self._signal: int | None = None
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Self:
        """Take the signals."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:
                self._before[number] = signal.signal(number, self._take)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the signals back."""
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def __bool__(self) -> bool:
        """Whether a signal has come."""
        return self._signal is not None

    @property
    def exit_code(self) -> int:
        """Exit code of a program that the signal ended, 128 + its number: 130 after Ctrl-C.

        Raises
        ------
        ValueError
            No signal has come.
        """
        if self._signal is None:
            raise ValueError("no signal has come")
        return 128 + self._signal

    def check(self) -> None:
        """Raise `InterruptionError` if a signal has come."""
        if self:
            raise InterruptionError("interrupted")

    def _take(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        if self._signal is not None and number == signal.SIGINT:
            raise KeyboardInterrupt
        self._signal = self._signal or number
