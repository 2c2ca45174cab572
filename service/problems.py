"""Errors as RFC 9457 problems: one shape for every answer that is not what was asked for."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, Field
from starlette.exceptions import HTTPException

from crystal_core.errors import Fault, InputError, NotSupportedError

__all__ = ["MEDIA_TYPE", "Problem", "ProblemError", "ProblemFault", "add_handlers", "problem_response"]

MEDIA_TYPE = "application/problem+json"

_PREFIX = "urn:isogyre:problem:"


class ProblemFault(BaseModel):
    """One wrong place in a request."""

    pointer: str = Field(description="JSON pointer (RFC 6901) into the request's body, empty for the whole of it")
    detail: str


class Problem(BaseModel):
    """What went wrong (RFC 9457)."""

    type: str = Field(description="A URN that names the kind of problem and never changes")
    title: str
    status: int
    detail: str
    errors: list[ProblemFault] = Field(default=[], description="Every wrong place that was found")


class ProblemError(Exception):
    """Ends a request with a problem.

    Parameters
    ----------
    status : int
        HTTP status.
    kind : str
        Last part of the problem's URN, such as ``unknown-render``.
    detail : str
        What is wrong and, if it can be mended, how; one line.
    faults : sequence of Fault
        Wrong places in the request's body.
    headers : mapping
        Headers of the answer besides.
    """

    def __init__(
        self,
        status: int,
        kind: str,
        detail: str,
        *,
        faults: Sequence[Fault] = (),
        headers: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(detail)
        self.headers = dict(headers or {})
        self.problem = Problem(
            type=_PREFIX + kind,
            title=_TITLES.get(kind) or HTTPStatus(status).phrase,
            status=status,
            detail=detail,
            errors=[ProblemFault(pointer=fault.pointer, detail=fault.message) for fault in faults],
        )

    @classmethod
    def of(cls, error: Exception) -> ProblemError | None:
        """Return the problem of an error that its caller can mend, None for any other."""
        if isinstance(error, ProblemError):
            return error
        if isinstance(error, InputError):
            count = len(error.faults)
            detail = str(error.faults[0]) if count == 1 else f"{count} places of the request are wrong: {error}"
            return cls(422, "input", detail, faults=error.faults)
        if isinstance(error, NotSupportedError):
            return cls(422, "not-supported", str(error))
        return None

    @classmethod
    def of_failure(cls, error: BaseException, where: str) -> ProblemError:
        """Return the problem of a run that failed.

        Parameters
        ----------
        error : exception
            What happened.
        where : str
            What was being done, such as ``frame 3, tile 5``.
        """
        said = str(error).strip().partition("\n")[0]
        name = type(error).__name__
        faults = error.faults if isinstance(error, InputError) else ()
        return cls(500, "rendering-failed", f"{where}: {name}: {said}" if said else f"{where}: {name}", faults=faults)


_TITLES = {
    "input": "The request cannot be carried out as it stands",
    "json": "The body is not JSON",
    "not-supported": "Not supported by this version",
    "not-yet": "Not ready yet",
    "unknown-render": "No such render",
    "unknown-mineral": "No such mineral",
    "unknown-asset": "No such asset",
    "asset": "The file cannot serve as an asset",
    "unknown-habit": "No such habit",
    "rendering-failed": "Rendering failed",
    "internal": "The service has failed",
}

_KINDS = {400: "bad-request", 404: "not-found", 405: "method-not-allowed", 413: "too-large", 503: "not-ready"}


def problem_response(error: ProblemError) -> Response:
    """Return the answer that carries a problem."""
    # ASCII: what a caller sent may hold lone surrogates, which have no place in UTF-8.
    content = json.dumps(error.problem.model_dump(), ensure_ascii=True).encode("ascii")
    headers = {"Cache-Control": "no-store", **error.headers}
    return Response(content, error.problem.status, headers, media_type=MEDIA_TYPE)


def add_handlers(app: FastAPI) -> None:
    """Make every error of an application a problem."""

    async def expected(request: Request, error: Exception) -> Response:  # noqa: ARG001
        problem = ProblemError.of(error)
        assert problem is not None
        return problem_response(problem)

    async def http(request: Request, error: Exception) -> Response:
        assert isinstance(error, HTTPException)
        kind = _KINDS.get(error.status_code, "http")
        phrase = HTTPStatus(error.status_code).phrase
        detail = {
            404: f"Nothing is at {request.url.path}",
            405: f"{request.method} is not possible at {request.url.path}",
        }.get(error.status_code, error.detail or phrase)
        return problem_response(ProblemError(error.status_code, kind, detail, headers=error.headers))

    async def validation(request: Request, error: Exception) -> Response:
        assert isinstance(error, RequestValidationError)
        faults = [Fault(_pointer(fault["loc"]), fault["msg"]) for fault in error.errors()]
        if any(fault["loc"][:1] == ("path",) for fault in error.errors()):
            return problem_response(ProblemError(404, "not-found", f"Nothing is at {request.url.path}"))
        return problem_response(ProblemError(422, "input", "; ".join(map(str, faults)), faults=faults))

    for kind in (ProblemError, InputError, NotSupportedError):
        app.add_exception_handler(kind, expected)
    app.add_exception_handler(HTTPException, http)
    app.add_exception_handler(RequestValidationError, validation)


def _pointer(location: Sequence[Any]) -> str:
    """Return where a fault of the HTTP layer lies: a header or query parameter by its name."""
    return "/".join(str(part) for part in location)
