"""How far a batch is and how long it will take, on a terminal."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from service.batch import Batch
from service.batch_folder import FILM

__all__ = ["BatchProgress"]

_SPEED_PERIOD_S = 60.0
"""Time left is reckoned from the speed over this long: the first seconds, while workers warm up, are soon forgotten."""


class BatchProgress:
    """A progress bar on stderr if that is a terminal, nothing otherwise.

    Parameters
    ----------
    batch : Batch
        What is being rendered.
    """

    def __init__(self, batch: Batch) -> None:
        self._batch = batch
        self._progress = Progress(
            TextColumn("[bold]{task.description}"),
            BarColumn(bar_width=None),
            TextColumn("{task.fields[frames]}"),
            TimeElapsedColumn(),
            TextColumn("[dim]left[/]"),
            TimeRemainingColumn(),
            console=Console(stderr=True),
            disable=not sys.stderr.isatty(),  # not Rich's own judgement, which variables of the environment can bend
            expand=True,
            speed_estimate_period=_SPEED_PERIOD_S,
        )
        self._task = self._progress.add_task(batch.request.name, total=batch.units, frames=self._frames())

    def advance(self) -> None:
        """Note that a unit is done."""
        self._progress.update(self._task, advance=1, frames=self._frames())

    def begin_film(self) -> None:
        """Note that the animation is being made."""
        self._progress.update(self._task, description=FILM)

    def __enter__(self) -> Self:
        """Show the bar."""
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave the bar as it stands."""
        self._progress.stop()

    def _frames(self) -> str:
        total = self._batch.request.frames
        return f"{total - len(self._batch.folder.missing)}/{total} frames"
