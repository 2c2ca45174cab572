"""Scenes: their language, and whether one is written rightly."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field

from crystal_core.scene import scene_schema
from service.problems import ProblemFault
from service.routes.common import TheWorkshop, json_body, problem_answers
from service.scenes.validation import checked_scene

__all__ = ["router"]

router = APIRouter(prefix="/v1/scenes", tags=["scenes"])


class ValidScene(BaseModel):
    """What a valid scene holds."""

    valid: bool = Field(default=True, description="Always true: what is wrong is a problem")
    summary: dict[str, Any] = Field(
        description="Bodies with their faces, volume, extent and directions in the first frame; surfaces, sheets, "
        "lights, camera"
    )
    warnings: list[ProblemFault] = Field(
        description="Meshes that were mended, and what this version cannot render yet, with JSON pointers"
    )


_EXAMPLE: dict[str, Any] = {
    "isogyre": 1,
    "bodies": {
        "crystal": {
            "mineral": "calcite",
            "shape": {"cleavage": {"spacing_mm": [12, 20, 20]}},
            "orientation": {"z": {"hkl": [1, 0, 4]}},
            "rests_on": "page",
        }
    },
    "surfaces": {"page": {"print": "digits"}},
}


@router.post(
    "/validate",
    summary="Check a scene",
    response_model=ValidScene,
    responses=problem_answers(400, 413, 415, 422, 503),
    openapi_extra={
        "requestBody": {
            "required": True,
            "content": {
                "application/json": {
                    "schema": {"type": "object", "description": "After /v1/scenes/schema"},
                    "example": _EXAMPLE,
                }
            },
        }
    },
)
async def validate(request: Request, workshop: TheWorkshop) -> Response:
    """Check a scene and everything that shows when it is put together, in all of its frames; nothing is rendered.

    What is wrong is a problem whose ``errors`` carry JSON pointers into the scene. Files are named as assets.
    """
    body = await json_body(request)
    answer = await run_in_threadpool(workshop.work_out, checked_scene, body, workshop.assets.folder)
    return JSONResponse({"valid": True, **answer}, headers={"Cache-Control": "no-store"})


@router.get("/schema", summary="The language of scenes", response_model=dict[str, Any])
def schema() -> Response:
    """Return the JSON Schema (draft 2020-12) of the scene description language."""
    return JSONResponse(scene_schema(), media_type="application/schema+json")
