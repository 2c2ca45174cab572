"""The habits of a mineral, and the crystal of a habit face by face."""

from __future__ import annotations

from typing import Any
from urllib.parse import quote

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field

import minerals_db
from crystal_core.errors import InputError
from crystal_core.geometry.habit import MAX_SIZE_MM, MIN_SIZE_MM
from crystal_core.scene.specimen import habit_of, specimen_solid
from minerals_db import Habit, Mineral
from service.minerals.habits import habit_document, habit_summary
from service.minerals.pages import answer_version, digest_of
from service.minerals.parameters import openapi_parameters, query_parameter, read_parameters, single_values
from service.problems import ProblemError
from service.routes.common import is_known, problem_answers, unchanged

__all__ = ["router"]

router = APIRouter(prefix="/v1", tags=["catalogue"])


class HabitsRequest(BaseModel):
    """The habits of a mineral are asked for by their address alone."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class HabitRequest(BaseModel):
    """What the crystal of a habit is asked for."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    size_mm: float = Field(
        10.0,
        ge=MIN_SIZE_MM,
        le=MAX_SIZE_MM,
        allow_inf_nan=False,
        description="The greatest distance between two corners of the crystal, mm",
    )


_ETAG = {"ETag": {"description": "Of these data, this code and this question", "schema": {"type": "string"}}}


def _answers(description: str, example: dict[str, Any]) -> dict[int | str, dict[str, Any]]:
    content = {"application/json": {"schema": {"type": "object"}, "example": example}}
    return {
        200: {"description": description, "content": content, "headers": _ETAG},
        304: {"description": "As If-None-Match says, it is known already"},
        **problem_answers(404, 422),
    }


@router.get(
    "/minerals/{mineral_id}/habits",
    summary="The habits of a mineral",
    responses=_answers(
        "The forms of each habit, on the axes of the entry's cell, with their distances from the centre",
        {
            "mineral": "calcite",
            "habits": [
                {
                    "name": "cleavage rhombohedron",
                    "forms": [{"hkl": [1, 0, 4], "name": "r", "central_distance": 1.0}],
                    "links": {"self": "/v1/minerals/calcite/habits/cleavage%20rhombohedron"},
                }
            ],
        },
    ),
)
def habits(request: Request, mineral_id: str) -> Response:
    """Return what the entry says of each habit; a mineral may have none."""
    entry = _entry(mineral_id)
    read_parameters(HabitsRequest, single_values(request.query_params.multi_items()), query_parameter)
    etag = _etag("habits", [entry.id])
    if is_known(request, etag):
        return unchanged(etag, "no-cache")
    told = [{**habit_summary(habit), "links": {"self": _address(entry, habit)}} for habit in entry.habits]
    links = {"self": f"/v1/minerals/{entry.id}/habits", "mineral": f"/v1/minerals/{entry.id}"}
    return JSONResponse({"mineral": entry.id, "habits": told, "links": links}, headers={"ETag": etag})


@router.get(
    "/minerals/{mineral_id}/habits/{name}",
    summary="The crystal of a habit, face by face",
    responses=_answers(
        "Faces with hkl, outward normal, area and corners (counter-clockwise from outside), edges with the angle "
        "between the normals, volume; in the crystal frame (x along a, z along c*, y = z × x), the centroid at the "
        "origin",
        {
            "mineral": "halite",
            "habit": "cube",
            "size_mm": 10.0,
            "volume_mm3": 192.45008972987526,
            "faces": [{"hkl": [1, 0, 0], "normal": [1.0, 0.0, 0.0], "area_mm2": 33.333333333333336}],
        },
    ),
    openapi_extra={"parameters": openapi_parameters(HabitRequest)},
)
def habit(request: Request, mineral_id: str, name: str) -> Response:
    """Return the polyhedron that the forms of a habit enclose.

    The name may be written in any case, and with hyphens for its blanks. The size is the greatest distance between two
    corners.
    """
    entry = _entry(mineral_id)
    try:
        known = habit_of(entry, name)
    except InputError as error:
        raise ProblemError(404, "unknown-habit", error.faults[0].message) from None
    asked = read_parameters(HabitRequest, single_values(request.query_params.multi_items()), query_parameter)
    etag = _etag("habit", [entry.id, known.name, asked.size_mm])
    if is_known(request, etag):
        return unchanged(etag, "no-cache")
    document = habit_document(entry, known, asked.size_mm, specimen_solid(entry, known.name, asked.size_mm))
    links = {"self": _address(entry, known), "mineral": f"/v1/minerals/{entry.id}"}
    return JSONResponse({**document, "links": links}, headers={"ETag": etag})


def _entry(mineral_id: str) -> Mineral:
    try:
        return minerals_db.mineral(mineral_id)
    except minerals_db.UnknownMineralError as error:
        raise ProblemError(404, "unknown-mineral", str(error)) from None


def _etag(kind: str, question: object) -> str:
    return f'"{digest_of([answer_version(), kind, question])}"'


def _address(mineral: Mineral, habit: Habit) -> str:
    return f"/v1/minerals/{mineral.id}/habits/{quote(habit.name, safe='')}"
