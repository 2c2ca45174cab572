"""Renders: asked for, watched, fetched, dismissed."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Header, Path, Request, Response
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import FileResponse, JSONResponse
from fastapi.sse import EventSourceResponse, ServerSentEvent

from crystal_core import sequence
from crystal_core.errors import InputError
from crystal_core.sequence.request import MAX_FRAMES, MAX_SIDE, MIN_SIDE
from service.press import MANIFEST, SEQUENCE, manifest_bytes
from service.problems import ProblemError
from service.records import Job, frame_name
from service.routes.common import IMMUTABLE, TheWorkshop, is_known, json_body, problem_answers, unchanged
from service.streams import watch
from service.views import Render, render_view
from service.workshop import Workshop

__all__ = ["router"]

router = APIRouter(prefix="/v1/renders", tags=["renders"])

_SETTINGS: dict[str, Any] = {
    "frames": {"type": "integer", "minimum": 1, "maximum": MAX_FRAMES},
    "size": {
        "type": "array",
        "description": "Width and height in pixels",
        "items": {"type": "integer", "minimum": MIN_SIDE, "maximum": MAX_SIDE},
        "minItems": 2,
        "maxItems": 2,
    },
    "quality": {"type": "string", "enum": ["draft", "standard", "fine"]},
    "seed": {"type": "integer", "minimum": 0, "maximum": 2**63 - 1},
}

_DEFAULTS: dict[str, Any] = {"frames": 36, "size": [512, 512], "quality": "standard", "seed": 0}

_REQUEST_SCHEMA: dict[str, Any] = {
    "oneOf": [
        {
            "title": "A demonstration",
            "type": "object",
            "required": ["demonstration"],
            "properties": {
                "demonstration": {"type": "string", "description": "A name from /v1/demonstrations"},
                "parameters": {"type": "object", "description": "After the demonstration's schema", "default": {}},
                **{key: {**schema, "default": _DEFAULTS[key]} for key, schema in _SETTINGS.items()},
            },
            "additionalProperties": False,
        },
        {
            "title": "A scene",
            "type": "object",
            "required": ["scene"],
            "description": "What stands beside the scene replaces what it says of itself",
            "properties": {
                "scene": {"type": "object", "description": "After /v1/scenes/schema; files are named as assets"},
                **_SETTINGS,
            },
            "additionalProperties": False,
        },
    ],
    "example": {"demonstration": "rotating-calcite", "frames": 12, "size": [256, 256], "quality": "draft"},
}


async def _the_job(render_id: str, workshop: TheWorkshop) -> Job:
    job = await run_in_threadpool(workshop.ledger.job, render_id)
    if job is None:
        raise ProblemError(404, "unknown-render", f"There is no render {render_id}")
    return job


TheJob = Annotated[Job, Depends(_the_job)]


@router.post(
    "",
    status_code=202,
    summary="Ask for a render",
    response_model=Render,
    responses=problem_answers(400, 413, 415, 422, 503),
    openapi_extra={"requestBody": {"required": True, "content": {"application/json": {"schema": _REQUEST_SCHEMA}}}},
)
async def create(request: Request, workshop: TheWorkshop) -> Response:
    """Accept a render; ``Location`` says where it can be watched.

    A demonstration with parameters, or a scene. A texture or a mesh of one's own is handed over first, at
    ``/v1/assets``, and named by its digest. Equal requests share their work: the second one is answered from what the
    first has done.
    """
    body = await json_body(request)
    job = await run_in_threadpool(_submit, workshop, body)
    view = await run_in_threadpool(_view, workshop, job)
    headers = {"Location": view.links.self, "Retry-After": "1", "Cache-Control": "no-store"}
    return JSONResponse(view.model_dump(mode="json"), 202, headers)


@router.get("/{render_id}", summary="How a render is getting on", response_model=Render, responses=problem_answers(404))
def show(job: TheJob, workshop: TheWorkshop) -> Response:
    """Return status, progress and the finished frames."""
    headers = {"Cache-Control": "no-store"} | ({"Retry-After": "1"} if job.live else {})
    return JSONResponse(_view(workshop, job).model_dump(mode="json"), headers=headers)


@router.delete("/{render_id}", status_code=204, summary="Dismiss a render", responses=problem_answers(404))
def dismiss(job: TheJob, workshop: TheWorkshop) -> None:
    """Let go of a render; work on it stops unless another caller wants the same. What is finished stays readable."""
    workshop.runner.dismiss(job.id)


@router.get(
    "/{render_id}/events",
    summary="Watch a render",
    response_class=EventSourceResponse,
    responses=problem_answers(404),
)
async def events(
    job: TheJob, workshop: TheWorkshop, last_event_id: Annotated[str | None, Header()] = None
) -> AsyncIterator[ServerSentEvent]:
    """Stream events until the render has ended.

    ``frame`` (a finished frame and its ``href``) and ``status`` are numbered and replayed after ``Last-Event-ID``;
    ``progress`` carries the number of the event before it and is not replayed.
    """
    after = int(last_event_id) if last_event_id and last_event_id.isdecimal() and len(last_event_id) < 10 else 0
    async for item in watch(workshop, job.id, after):
        yield item


@router.get(
    "/{render_id}/frames/{index}.{kind}",
    summary="A finished frame",
    response_class=FileResponse,
    responses={200: {"content": {"image/webp": {}, "image/png": {}}}, 304: {}, **problem_answers(404)},
)
def frame(
    request: Request,
    job: TheJob,
    workshop: TheWorkshop,
    index: Annotated[int, Path(ge=0, lt=MAX_FRAMES)],
    kind: Literal["webp", "png"],
) -> Response:
    """Return a frame's picture; it never changes."""
    if index >= job.run.frames:
        raise ProblemError(404, "not-found", f"This render has the frames 0 to {job.run.frames - 1}")
    return _file(request, workshop, job, frame_name(index, kind), f"frame {index}")


@router.get(
    "/{render_id}/" + SEQUENCE,
    summary="All frames as one animation",
    response_class=FileResponse,
    responses={200: {"content": {"image/webp": {}}}, 304: {}, **problem_answers(404)},
)
def animation(request: Request, job: TheJob, workshop: TheWorkshop) -> Response:
    """Return the animated WebP; it is there once the render is successful, and never changes."""
    return _file(request, workshop, job, SEQUENCE, "the animation")


@router.get(
    "/{render_id}/" + MANIFEST,
    summary="What was rendered, how, and with what error",
    response_model=dict[str, Any],
    responses={304: {}, **problem_answers(404)},
)
def manifest(request: Request, job: TheJob, workshop: TheWorkshop) -> Response:
    """Return the manifest; until the render is successful it says ``"complete": false`` and names the frames so far."""
    if workshop.ledger.product(job.run.id, MANIFEST) is not None:
        return _file(request, workshop, job, MANIFEST, "the manifest")
    try:
        content = manifest_bytes(
            sequence.read_request(job.run.request), workshop.ledger.frames(job.run.id), complete=False
        )
    except InputError as error:  # not the caller's fault: the request was accepted by another version
        raise ProblemError(404, "not-found", f"This version cannot describe the request: {error}") from error
    return Response(content, media_type="application/json", headers={"Cache-Control": "no-store"})


def _submit(workshop: Workshop, body: dict[str, Any]) -> Job:
    return workshop.runner.submit(workshop.read_request(body))


def _view(workshop: Workshop, job: Job) -> Render:
    return render_view(job, workshop.ledger.frames(job.run.id))


def _file(request: Request, workshop: Workshop, job: Job, name: str, what: str) -> Response:
    product = workshop.ledger.product(job.run.id, name)
    if product is None:
        if job.live:
            detail = f"{what.capitalize()} is still to come: the render is {job.status}"
            raise ProblemError(404, "not-yet", detail, headers={"Retry-After": "1"})
        raise ProblemError(404, "not-found", f"{what.capitalize()} was not rendered: the render is {job.status}")
    etag = f'"{product.sha256}"'
    if is_known(request, etag):
        return unchanged(etag, IMMUTABLE)
    headers = {"ETag": etag, "Cache-Control": IMMUTABLE}
    return FileResponse(workshop.store.path(product.sha256), headers=headers, media_type=product.media_type)
