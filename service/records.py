"""What the ledger tells: runs, jobs, frames, products, events."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Row

from service.tables import LIVE

__all__ = ["Event", "FrameRow", "Job", "Problem", "Product", "Run", "UnitRow", "as_run", "frame_name"]

Problem = Mapping[str, Any]
"""An RFC 9457 object."""


@dataclass(frozen=True, slots=True)
class Run:
    """The work behind one or more jobs."""

    id: str
    digest: str
    request: Mapping[str, Any]
    status: str
    problem: Problem | None
    frames: int
    tiles: int
    frames_done: int
    tiles_done: int
    last_event: int
    created_at: float
    started_at: float | None
    ended_at: float | None

    @property
    def live(self) -> bool:
        """Whether it is still to be worked on."""
        return self.status in LIVE


@dataclass(frozen=True, slots=True)
class Job:
    """What one caller asked for, and the run behind it."""

    id: str
    created_at: float
    dismissed_at: float | None
    run: Run

    @property
    def status(self) -> str:
        """One of accepted, running, successful, failed, dismissed."""
        return self.run.status if self.dismissed_at is None else "dismissed"

    @property
    def live(self) -> bool:
        """Whether more is to come."""
        return self.status in LIVE


@dataclass(frozen=True, slots=True)
class UnitRow:
    """A unit that has ended."""

    frame: int
    tile: int
    sha256: str | None


@dataclass(frozen=True, slots=True)
class FrameRow:
    """A finished frame; ``sha256`` is that of its PNG file, ``clipped_fraction`` what the gamut rule changed."""

    index: int
    angle_deg: float
    error_estimate: float
    seconds: float
    sha256: str
    clipped_fraction: float


@dataclass(frozen=True, slots=True)
class Product:
    """A named artifact of a run."""

    name: str
    sha256: str
    media_type: str
    size: int


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened to a run; ``number`` counts from 1 within it."""

    number: int
    kind: str
    data: Mapping[str, Any]


def frame_name(index: int, kind: str) -> str:
    """Return the name of a frame's product: ``frame-0003.png``, as the command line names its files."""
    return f"frame-{index:04d}.{kind}"


def as_run(row: Row[Any]) -> Run:
    """Return a row of the run table as a `Run`."""
    fields = dict(row._mapping)
    fields["request"] = json.loads(fields["request"])
    fields["problem"] = None if fields["problem"] is None else json.loads(fields["problem"])
    return Run(**fields)
