"""The events of a render as a stream that ends with it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Any

from fastapi.concurrency import run_in_threadpool
from fastapi.sse import ServerSentEvent

from service.records import Event, FrameRow, Job
from service.views import frame_view, progress_view
from service.workshop import Workshop

__all__ = ["watch"]

_PAUSE_S = 0.05
"""Least time between two looks at the ledger: units may end much faster than anybody can look at a progress bar."""


async def watch(workshop: Workshop, job_id: str, after: int) -> AsyncIterator[ServerSentEvent]:
    """Give the events of a job's run that come after the one of this number, and its progress, until it has ended.

    Parameters
    ----------
    workshop : Workshop
        Where the job is.
    job_id : str
        An existing job.
    after : int
        Number of the last event that the caller has; 0 for none.

    Yields
    ------
    ServerSentEvent
        ``frame``, ``progress`` or ``status``; the last one is a ``status`` that is final, unless the service stops.
    """
    told: Any = None
    first = await run_in_threadpool(workshop.ledger.job, job_id)
    assert first is not None
    with workshop.bell.listen(first.run.id) as news:
        while True:
            news.clear()
            job, events, frames = await run_in_threadpool(_look, workshop, job_id, after)
            for event in events:
                if job.dismissed_at is None or event.kind == "frame":
                    yield ServerSentEvent(
                        event=event.kind, id=str(event.number), data=_data(job, event, frames), retry=1000
                    )
                after = event.number
            progress = progress_view(job.run)
            if progress != told:
                told = progress
                yield ServerSentEvent(event="progress", id=str(after), data=progress.model_dump())
            if not job.live:
                if job.dismissed_at is not None:
                    yield ServerSentEvent(event="status", id=str(after), data={"status": "dismissed", "problem": None})
                return
            if workshop.bell.closed:
                return
            await news.wait()
            await asyncio.sleep(_PAUSE_S)


def _look(workshop: Workshop, job_id: str, after: int) -> tuple[Job, list[Event], dict[int, FrameRow]]:
    # The job first: if it has ended by then, its last event is among those read after it.
    job = workshop.ledger.job(job_id)
    assert job is not None
    events = workshop.ledger.events(job.run.id, after)
    wanted = any(event.kind == "frame" for event in events)
    frames = workshop.ledger.frames(job.run.id) if wanted else []
    return job, events, {frame.index: frame for frame in frames}


def _data(job: Job, event: Event, frames: dict[int, FrameRow]) -> dict[str, Any]:
    if event.kind != "frame":
        return {"problem": None, **event.data}
    view = frame_view(job, frames[event.data["index"]])
    return {**view.model_dump(), "href": view.links.webp}
