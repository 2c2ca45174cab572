"""The outermost layer of the HTTP interface: security headers, the limit of bodies, what nobody caught."""

from __future__ import annotations

from collections.abc import Mapping

import structlog
from fastapi import Request
from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.problems import ProblemError, problem_response

__all__ = ["HEADERS", "Shield"]

HEADERS = {
    # Everything from here, nothing inline. Frames may be shown from memory (blob:), small drawings as data:.
    "Content-Security-Policy": (
        "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}


class Shield:
    """ASGI middleware.

    Parameters
    ----------
    app : ASGI application
        What it shields.
    max_body_bytes : int
        A larger body is answered with a problem (413) and not read to its end.
    larger : mapping of str to int
        Paths that take another number of bytes.
    """

    def __init__(self, app: ASGIApp, max_body_bytes: int, larger: Mapping[str, int] | None = None) -> None:
        self._app = app
        self._limit = max_body_bytes
        self._larger = dict(larger or {})
        self._log = structlog.get_logger("isogyre.http")

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        limit = self._larger.get(scope["path"].rstrip("/"), self._limit)
        started = False
        read = 0

        async def guarded_receive() -> Message:
            nonlocal read
            message = await receive()
            read += len(message.get("body", b""))
            if read > limit:
                raise HTTPException(413, _too_large(limit))
            return message

        async def guarded_send(message: Message) -> None:
            nonlocal started
            if message["type"] == "http.response.start":
                started = True
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)
                # What says nothing else may be kept, but must be asked for again: pages and lists change.
                headers.setdefault("Cache-Control", "no-cache")
            await send(message)

        declared = Headers(scope=scope).get("content-length", "0")
        if not declared.isdecimal() or len(declared) > 18 or int(declared) > limit:
            error = ProblemError(413, "too-large", _too_large(limit), headers={"Connection": "close"})
            await problem_response(error)(scope, receive, guarded_send)
            return
        try:
            await self._app(scope, guarded_receive, guarded_send)
        except Exception:
            request = Request(scope)
            self._log.exception("internal error", method=request.method, path=request.url.path)
            if started:
                raise
            error = ProblemError(500, "internal", "This is a fault of the service; its log says more.")
            await problem_response(error)(scope, receive, guarded_send)


def _too_large(limit: int) -> str:
    return f"The body of a request may hold {limit} bytes"
