"""What several routes need."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Annotated, Any

from fastapi import Depends, Request, Response

from crystal_core.errors import InputError
from service.problems import MEDIA_TYPE, ProblemError
from service.workshop import Workshop

__all__ = ["IMMUTABLE", "TheWorkshop", "is_known", "json_body", "preferred_type", "problem_answers", "unchanged"]

IMMUTABLE = "public, max-age=31536000, immutable"
"""``Cache-Control`` of what never changes under its address."""


def _workshop(request: Request) -> Workshop:
    workshop: Workshop = request.app.state.workshop
    return workshop


TheWorkshop = Annotated[Workshop, Depends(_workshop)]


def is_known(request: Request, etag: str) -> bool:
    """Return whether the caller has the content of this entity tag already (``If-None-Match``, RFC 9110 13.1.2)."""
    asked = request.headers.get("if-none-match", "")
    tags = [tag.strip().removeprefix("W/") for tag in asked.split(",")]
    return "*" in tags or etag in tags


async def json_body(request: Request) -> dict[str, Any]:
    """Return the JSON object that is the body of a request.

    Raises
    ------
    ProblemError, InputError
        It is not declared as JSON, is none, or is no object.
    """
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json" and not (kind.startswith("application/") and kind.endswith("+json")):
        raise ProblemError(415, "media-type", "The body must be declared as application/json")
    try:
        body = json.loads(await request.body())
    except (ValueError, RecursionError) as error:  # a UnicodeDecodeError is a ValueError
        raise ProblemError(400, "json", f"The body is not JSON: {error}") from None
    if not isinstance(body, dict):
        raise InputError.at("", "the body must be an object")
    return body


def unchanged(etag: str, cache_control: str) -> Response:
    """Return the answer to a caller who has the content already."""
    return Response(status_code=304, headers={"ETag": etag, "Cache-Control": cache_control})


def preferred_type(request: Request, offered: Sequence[str]) -> str:
    """Return the media type that the caller likes best (``Accept``, RFC 9110 12.5.1), of equals the first.

    Parameters
    ----------
    request : Request
        The request; one that accepts none of them is answered with the first, as the RFC allows.
    offered : sequence of str
        Media types there are, without parameters.
    """
    wanted: dict[str, float] = {}
    for part in request.headers.get("accept", "*/*").lower().split(","):
        kind, *parameters = (piece.strip() for piece in part.split(";"))
        quality = next((text[2:] for text in parameters if text.startswith("q=")), "1")
        try:
            wanted[kind] = float(quality)
        except ValueError:
            wanted[kind] = 0.0

    def liking(kind: str) -> float:
        ranges = (kind, f"{kind.partition('/')[0]}/*", "*/*")
        return next((wanted[name] for name in ranges if name in wanted), 0.0)

    return max(offered, key=liking)


def problem_answers(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Return the OpenAPI description of answers that are problems."""
    return {
        status: {
            "description": {
                404: "There is nothing of this name (yet)",
                413: "The body is too large",
                415: "The body is not declared as what it must be",
                422: "The request cannot be carried out as it stands; `errors` names every wrong place",
                400: "The body is not JSON",
                503: "It cannot be done now; try again",
            }[status],
            "content": {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}},
        }
        for status in statuses
    }
