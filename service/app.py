"""The HTTP application."""

from __future__ import annotations

import importlib.metadata
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from fastapi import FastAPI
from fastapi.concurrency import run_in_threadpool

import service
from crystal_core.errors import InputError
from service.problems import Problem, add_handlers
from service.routes import assets, catalogue, habits, health, minerals, optics, renders, scenes
from service.settings import Settings
from service.shield import Shield
from service.workshop import Workshop

__all__ = ["create_app", "page_folder"]

_DESCRIPTION = """\
What light really does inside a crystal, rendered. A render is a job: `POST /v1/renders` answers 202 with its
`Location`; watch it there or by server-sent events, fetch frames as they come. Every error is an RFC 9457 problem.

There is no `/docs` page: it would load its scripts from elsewhere, and this service neither needs nor makes any
connection to the outside. This document, `/openapi.json`, can be opened in any OpenAPI viewer.
"""


def create_app(settings: Settings, *, workshop: Workshop | None = None) -> FastAPI:
    """Make the application.

    Parameters
    ----------
    settings : Settings
        The service's settings.
    workshop : Workshop or None
        What does the work. One that is open already is left open; otherwise the application opens it when it starts
        and closes it when it ends. None: one after the settings.

    Returns
    -------
    FastAPI
        An ASGI application; the page is at ``/``.

    Raises
    ------
    InputError
        If the page's files are not there.
    """
    shop = workshop or Workshop(settings)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:  # noqa: ARG001
        if shop.is_open:
            yield
            return
        await run_in_threadpool(shop.open)
        try:
            yield
        finally:
            await run_in_threadpool(shop.close)

    app = FastAPI(
        title="Isogyre",
        summary="Crystals as light sees them",
        description=_DESCRIPTION,
        version=importlib.metadata.version("isogyre"),
        license_info={"name": "Apache-2.0", "identifier": "Apache-2.0"},
        docs_url=None,
        redoc_url=None,
        lifespan=lifespan,
    )
    app.state.workshop = shop
    for module in (catalogue, minerals, habits, scenes, assets, renders, optics, health):
        app.include_router(module.router)
    app.frontend("/", directory=page_folder(), fallback=None, check_dir=True)
    _describe_answers(app)
    add_handlers(app)
    app.add_middleware(Shield, max_body_bytes=settings.max_body_bytes, larger={"/v1/assets": settings.max_asset_bytes})
    return app


def _describe_answers(app: FastAPI) -> None:
    """Correct the API's description where FastAPI cannot know better.

    Problems are raised, no route returns them; FastAPI's own 422 never leaves this service; and the schema of an event
    stream's items is a word of OpenAPI 3.2.
    """
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is not None:
            return app.openapi_schema
        document = plain()
        problem = Problem.model_json_schema(ref_template="#/components/schemas/{model}")
        schemas: dict[str, Any] = document["components"]["schemas"]
        schemas |= {**problem.pop("$defs"), "Problem": problem}
        for name in ("HTTPValidationError", "ValidationError"):
            schemas.pop(name, None)
        for operations in document["paths"].values():
            for operation in operations.values():
                answers = operation["responses"]
                if "application/json" in answers.get("422", {}).get("content", {}):
                    del answers["422"]
                if "text/event-stream" in (content := answers.get("200", {}).get("content", {})):
                    content["text/event-stream"] = {"schema": {"type": "string"}}
        return document

    app.openapi = openapi  # type: ignore[method-assign]


def page_folder() -> Path:
    """Return the folder of the page: inside the package where it is installed, beside it in a checkout.

    Raises
    ------
    InputError
        If neither holds an ``index.html``.
    """
    package = Path(service.__file__).parent
    candidates = (package / "web", package.parent / "web")
    for folder in candidates:
        if (folder / "index.html").is_file():
            return folder
    raise InputError.at("", f"the page is missing: no index.html in {' or '.join(map(str, candidates))}")
