"""The optics asked at once: interfaces and plates, one question or many."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool
from pydantic import BaseModel

from crystal_core.errors import Fault, InputError, NotSupportedError
from service.probes.documents import BadDocument, InvalidJsonError, read_document, read_documents, read_lines
from service.probes.interface import INTERFACE, InterfaceAnswer
from service.probes.plate import PLATE, PlateAnswer
from service.probes.probe import Probe, UnanswerableError, encode
from service.problems import ProblemError
from service.routes.common import problem_answers

__all__ = ["router"]

router = APIRouter(prefix="/v1/optics", tags=["optics"])

JSON_LINES = ("application/jsonl", "application/x-ndjson", "application/ndjson", "application/x-jsonlines")
"""Media types of JSON Lines; none is registered, these are in use."""

MAX_FAULTS = 100


def _schema(model: type[BaseModel]) -> dict[str, Any]:
    """Return a model's JSON schema with all it refers to inside: a request's schema belongs to no response."""
    schema = model.model_json_schema(mode="validation", by_alias=True)
    definitions = schema.pop("$defs", {})
    return _resolved(schema, definitions)  # type: ignore[no-any-return]


def _resolved(node: Any, definitions: dict[str, Any]) -> Any:
    if isinstance(node, list):
        return [_resolved(item, definitions) for item in node]
    if not isinstance(node, dict):
        return node
    if "$ref" in node:
        target = definitions[node["$ref"].rpartition("/")[2]]
        return _resolved({**target, **{key: value for key, value in node.items() if key != "$ref"}}, definitions)
    return {key: _resolved(value, definitions) for key, value in node.items()}


def _described(probe: Probe[Any]) -> dict[str, Any]:
    """Return what a route says of itself in the API's description."""
    lines = {"schema": {"type": "string", "description": "JSON Lines: a document of application/json on each line"}}
    body: dict[str, Any] = {"application/json": {"schema": _schema(probe.request)}}
    return {
        "responses": {
            200: {"description": "The answer; of JSON Lines one on each line", "content": {JSON_LINES[0]: lines}},
            **problem_answers(400, 413, 415, 422),
        },
        "openapi_extra": {"requestBody": {"required": True, "content": body | dict.fromkeys(JSON_LINES, lines)}},
    }


@router.post(
    "/interface",
    summary="The waves at the plane face between two media",
    response_model=InterfaceAnswer,
    **_described(INTERFACE),
)
async def interface(request: Request) -> Response:
    """Return incident, reflected and transmitted waves, with the powers and amplitudes of each.

    A body of JSON Lines (`application/jsonl`, `application/x-ndjson`; `application/json` will do) is answered line by
    line, in order; if one line is wrong, the answer is a problem.
    """
    return await _answer(INTERFACE, request)


@router.post(
    "/plate",
    summary="What plane-parallel plates do to light along their normal",
    response_model=PlateAnswer,
    **_described(PLATE),
)
async def plate(request: Request) -> Response:
    """Return transmittance, colour, retardation, Jones and Mueller matrices of a stack of plates.

    A body of JSON Lines (`application/jsonl`, `application/x-ndjson`; `application/json` will do) is answered line by
    line, in order; if one line is wrong, the answer is a problem.
    """
    return await _answer(PLATE, request)


async def _answer(probe: Probe[Any], request: Request) -> Response:
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    many = kind in JSON_LINES
    if not many and kind != "application/json" and not (kind.startswith("application/") and kind.endswith("+json")):
        raise ProblemError(415, "media-type", f"The body must be declared as application/json or {JSON_LINES[0]}")
    data = await request.body()
    text, lines = await run_in_threadpool(_many if many else _one, probe, data)
    media_type = kind if many else JSON_LINES[0] if lines else "application/json"
    return Response(text, media_type=media_type, headers={"Cache-Control": "no-store"})


def _one(probe: Probe[Any], data: bytes) -> tuple[str, bool]:
    """Return the answer to one document, and whether it was none, but lines of them."""
    try:
        value = read_document(data)
    except InvalidJsonError as error:
        if read_documents(data)[0]:
            return _many(probe, data)
        raise ProblemError(400, "json", f"The body is not JSON: {_reason(error)}") from None
    return encode(probe.ask(value)), False


def _many(probe: Probe[Any], data: bytes) -> tuple[str, bool]:
    documents, bad = read_lines(data)
    count = len(documents) + len(bad)
    if not count:
        raise ProblemError(400, "json", "There is nothing in the body; JSON Lines are expected")
    if count > probe.most_lines:
        raise InputError.at("", f"the body has {count} lines; at most {probe.most_lines} are answered at once")
    try:
        return "".join(encode(answer) + "\n" for answer in probe.ask_all(documents, bad)), True
    except UnanswerableError as error:
        raise _problem(error.documents) from None


def _problem(bad: Sequence[BadDocument]) -> ProblemError:
    """Return the problem of lines that cannot be answered; its faults tell the line, pointers lead into it."""
    first = bad[0]
    detail = f"line {first.line}: {_reason(first.error)}"
    if len(bad) > 1:
        detail = f"{len(bad)} lines cannot be answered, the first of them {detail}"
    faults = []
    for document in bad:
        found = document.error.faults if isinstance(document.error, InputError) else (Fault("", str(document.error)),)
        faults += [Fault(fault.pointer, f"line {document.line}: {fault.message}") for fault in found]
    if isinstance(first.error, InvalidJsonError):
        return ProblemError(400, "json", detail, faults=faults[:MAX_FAULTS])
    kind = "not-supported" if isinstance(first.error, NotSupportedError) else "input"
    return ProblemError(422, kind, detail, faults=faults[:MAX_FAULTS])


def _reason(error: Exception) -> str:
    if isinstance(error, InvalidJsonError):
        return error.faults[0].message.removeprefix("not JSON: ")
    return str(error)
