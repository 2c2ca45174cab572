"""What there is to render: minerals and demonstrations."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse

import minerals_db
from crystal_core import sequence
from service.problems import ProblemError
from service.routes.common import is_known, problem_answers, unchanged

__all__ = ["router"]

router = APIRouter(prefix="/v1", tags=["catalogue"])

_SODIUM_D_NM = 589.3


@router.get("/minerals", summary="All minerals", response_model=dict[str, Any])
def minerals(request: Request) -> Response:
    """Return every mineral of the database, shortly."""
    return _constant(
        request,
        {
            "minerals": [
                {
                    "id": mineral.id,
                    "names": mineral.names.model_dump(),
                    "formula": mineral.formula,
                    "system": mineral.system,
                    "point_group": mineral.point_group,
                    "optical_class": mineral.optical_class,
                    "optic_sign": mineral.optic_sign,
                    "links": {"self": f"/v1/minerals/{mineral.id}"},
                }
                for mineral in minerals_db.minerals().values()
            ]
        },
    )


@router.get(
    "/minerals/{mineral_id}",
    summary="One mineral with all its numbers and their sources",
    response_model=dict[str, Any],
    responses=problem_answers(404),
)
def mineral(request: Request, mineral_id: str) -> Response:
    """Return a mineral's whole entry, and its principal indices at the D line."""
    try:
        entry = minerals_db.mineral(mineral_id)
    except minerals_db.UnknownMineralError as error:
        raise ProblemError(404, "unknown-mineral", str(error)) from None
    indices = {axis: round(float(curve.index(_SODIUM_D_NM)), 6) for axis, curve in entry.dispersion.items()}
    return _constant(
        request,
        {
            **entry.model_dump(mode="json"),
            "indices": {"wavelength_nm": _SODIUM_D_NM, **indices},
            "links": {"self": f"/v1/minerals/{entry.id}"},
        },
    )


@router.get("/demonstrations", summary="What can be rendered", response_model=dict[str, Any])
def demonstrations() -> dict[str, Any]:
    """Return every demonstration with the JSON Schema of its parameters and their defaults."""
    return {
        "demonstrations": [
            {
                "name": demonstration.name,
                "title": demonstration.title,
                "summary": demonstration.summary,
                "parameters": demonstration.Parameters.model_json_schema(),
            }
            for demonstration in sequence.demonstrations().values()
        ]
    }


def _constant(request: Request, content: dict[str, Any]) -> Response:
    """Answer with something that changes with the mineral data only."""
    etag = f'"{minerals_db.data_digest()}"'
    if is_known(request, etag):
        return unchanged(etag, "no-cache")
    return JSONResponse(content, headers={"ETag": etag})
