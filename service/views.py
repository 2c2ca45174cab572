"""What the interface answers: the models behind its JSON, and how they are made from the ledger's rows."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Any, Literal

from pydantic import BaseModel, Field

from service.press import MANIFEST, SEQUENCE
from service.problems import Problem
from service.records import FrameRow, Job, Run

__all__ = ["Frame", "FrameLinks", "Progress", "Render", "RenderLinks", "frame_view", "progress_view", "render_view"]

Status = Literal["accepted", "running", "successful", "failed", "dismissed"]


class Progress(BaseModel):
    """How far a render is."""

    frames_done: int
    frames: int
    tiles_done: int
    tiles: int
    fraction: float = Field(description="Share of the tiles that are done, 0 to 1")


class FrameLinks(BaseModel):
    """Where the files of a frame are."""

    webp: str
    png: str


class Frame(BaseModel):
    """A finished frame."""

    index: int
    angle_deg: float
    error_estimate: float = Field(description="Estimated RMS error in linear sRGB, white = 1")
    seconds: float = Field(description="Processor time spent on it, s")
    sha256: str = Field(description="SHA-256 of its PNG file")
    links: FrameLinks


class RenderLinks(BaseModel):
    """Where a render's resources are; those that are not ready yet answer 404 with Retry-After."""

    self: str
    events: str
    sequence: str
    manifest: str


class Render(BaseModel):
    """A render: one caller's job."""

    id: str = Field(description="ULID")
    status: Status
    digest: str = Field(description="Request digest: equal requests to the same version of code and data share it")
    request: dict[str, Any] = Field(description="The request with all defaults filled in")
    progress: Progress
    frames: list[Frame] = Field(description="Those that are finished")
    problem: Problem | None = Field(description="Why it failed")
    created_at: datetime
    started_at: datetime | None
    ended_at: datetime | None
    links: RenderLinks


def render_view(job: Job, frames: Sequence[FrameRow]) -> Render:
    """Return the view of a job and its finished frames."""
    run, base = job.run, _base(job)
    return Render.model_validate(
        {
            "id": job.id,
            "status": job.status,
            "digest": run.digest,
            "request": run.request,
            "progress": progress_view(run),
            "frames": [frame_view(job, frame) for frame in frames],
            "problem": run.problem,
            "created_at": _time(job.created_at),
            "started_at": _time(run.started_at),
            "ended_at": _time(job.dismissed_at or run.ended_at),
            "links": {
                "self": base,
                "events": f"{base}/events",
                "sequence": f"{base}/{SEQUENCE}",
                "manifest": f"{base}/{MANIFEST}",
            },
        }
    )


def frame_view(job: Job, frame: FrameRow) -> Frame:
    """Return the view of a finished frame."""
    base = f"{_base(job)}/frames/{frame.index}"
    return Frame(
        index=frame.index,
        angle_deg=frame.angle_deg,
        error_estimate=frame.error_estimate,
        seconds=frame.seconds,
        sha256=frame.sha256,
        links=FrameLinks(webp=f"{base}.webp", png=f"{base}.png"),
    )


def progress_view(run: Run) -> Progress:
    """Return how far a run is."""
    return Progress(
        frames_done=run.frames_done,
        frames=run.frames,
        tiles_done=run.tiles_done,
        tiles=run.tiles,
        fraction=run.tiles_done / run.tiles,
    )


def _base(job: Job) -> str:
    return f"/v1/renders/{job.id}"


def _time(seconds: float | None) -> datetime | None:
    return None if seconds is None else datetime.fromtimestamp(seconds, UTC)
