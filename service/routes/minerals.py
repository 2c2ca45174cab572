"""The minerals: found, told whole, and their optics at any wavelength."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal
from urllib.parse import urlencode

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

import minerals_db
from crystal_core.errors import InputError
from minerals_db import Mineral
from minerals_db.query import Query, find
from service.minerals.optics import mineral_optics, read_concentrations
from service.minerals.pages import answer_version, digest_of, page
from service.minerals.parameters import openapi_parameters, query_parameter, read_parameters, single_values
from service.minerals.summaries import COLUMNS, entry_document, summary, summary_rows
from service.minerals.tables import CSV_MEDIA_TYPE, csv_text
from service.minerals.wavelengths import MAX_WAVELENGTHS, read_wavelengths
from service.problems import ProblemError
from service.routes.common import is_known, preferred_type, problem_answers, unchanged

__all__ = ["router"]

router = APIRouter(prefix="/v1", tags=["catalogue"])

DEFAULT_LIMIT, MAX_LIMIT = 100, 500
_CONCENTRATION = "concentration."

_Format = Annotated[
    Literal["json", "csv"] | None, Field(description="In place of the header Accept (application/json, text/csv)")
]


class MineralsRequest(Query):
    """What the list of minerals is asked for."""

    limit: int | None = Field(
        default=None,
        ge=1,
        le=MAX_LIMIT,
        description=f"Most minerals of a page; {DEFAULT_LIMIT} unless it is said, and as CSV all of them",
    )
    cursor: str | None = Field(
        default=None, max_length=1000, description="Where to go on, as `links.next` says; as long as the data stay"
    )
    format: _Format = None


def _wavelengths(value: object) -> object:
    if not isinstance(value, str):
        return value
    try:
        return read_wavelengths(value)
    except ValueError as error:
        raise PydanticCustomError("description", "{reason}", {"reason": str(error)}) from None


class OpticsRequest(BaseModel):
    """What the optics of a mineral are asked for."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    wavelengths_nm: Annotated[
        tuple[float, ...],
        BeforeValidator(_wavelengths),
        WithJsonSchema({"type": "string", "default": "486.1,589.3,656.3", "examples": ["400,500,600", "400:700:10"]}),
    ] = Field(
        default=(486.1, 589.3, 656.3),
        description="Vacuum wavelengths, nm: numbers with commas between, start:stop:step with both ends; at most "
        f"{MAX_WAVELENGTHS}",
    )
    format: _Format = None


class EntryRequest(BaseModel):
    """A mineral's entry is asked for by its address alone."""

    model_config = ConfigDict(frozen=True, extra="forbid")


_ETAG = {"ETag": {"description": "Of these data, this code and this question", "schema": {"type": "string"}}}
_NOT_MODIFIED: dict[int | str, dict[str, Any]] = {304: {"description": "As If-None-Match says, it is known already"}}


def _answers(description: str, example: Mapping[str, Any], csv: str | None = None) -> dict[int | str, dict[str, Any]]:
    """Return the OpenAPI description of an answer in JSON and, where there is one, in CSV."""
    content: dict[str, Any] = {"application/json": {"schema": {"type": "object"}, "example": dict(example)}}
    if csv is not None:
        content["text/csv"] = {"schema": {"type": "string", "description": csv}}
    return {200: {"description": description, "content": content, "headers": _ETAG}, **_NOT_MODIFIED}


@router.get(
    "/minerals",
    summary="Find minerals",
    responses={
        **_answers(
            "A page of what was found: `total` counts all of it, `links.next` leads on. Facts are those at 589.3 nm",
            {"minerals": [{"id": "calcite", "names": {"en": "Calcite", "ru": "Кальцит"}}], "total": 1, "links": {}},
            f"A header row and a row for each mineral. Columns: {', '.join(COLUMNS)}",
        ),
        **problem_answers(422),
    },
    openapi_extra={"parameters": openapi_parameters(MineralsRequest)},
)
def minerals(request: Request) -> Response:
    """Return the minerals that fulfil every condition, all of them without any.

    `next` is also in the header `Link`. A cursor that belongs to another query, or that is older than the data, is
    refused.
    """
    asked = read_parameters(MineralsRequest, single_values(request.query_params.multi_items()), query_parameter)
    csv = _is_csv(request, asked.format)
    query = asked.model_dump(mode="json", exclude={"limit", "cursor", "format"})
    etag = _etag("minerals", [query, asked.limit, asked.cursor, csv])
    if is_known(request, etag):
        return unchanged(etag, "no-cache")
    found = find(minerals_db.minerals(), asked)
    limit = asked.limit or (max(len(found), 1) if csv else DEFAULT_LIMIT)
    part = page(found, query, limit, asked.cursor, query_parameter("cursor"))
    headers = {"ETag": etag, "Vary": "Accept"}
    links = {"self": _address(request)}
    if part.next_cursor is not None:
        links["next"] = _address(request, cursor=part.next_cursor)
        headers["Link"] = f'<{links["next"]}>; rel="next"'
    if csv:
        return _csv(csv_text(COLUMNS, summary_rows(part.minerals)), "minerals", headers)
    told = [{**summary(mineral), "links": _links(mineral)} for mineral in part.minerals]
    return JSONResponse({"minerals": told, "total": len(found), "links": links}, headers=headers)


@router.get(
    "/minerals/{mineral_id}",
    summary="One mineral with all its numbers and their sources",
    responses={
        **_answers(
            "The whole entry, and what follows from it: indices at 589.3 nm, birefringence, 2V, quality of the data",
            {"id": "calcite", "indices": {"wavelength_nm": 589.3, "o": 1.658345, "e": 1.486093}},
        ),
        **problem_answers(404, 422),
    },
)
def mineral(request: Request, mineral_id: str) -> Response:
    """Return a mineral's whole entry with what follows from it."""
    entry = _entry(mineral_id)
    read_parameters(EntryRequest, single_values(request.query_params.multi_items()), query_parameter)
    etag = _etag("mineral", entry.id)
    if is_known(request, etag):
        return unchanged(etag, "no-cache")
    return JSONResponse({**entry_document(entry), "links": _links(entry)}, headers={"ETag": etag})


@router.get(
    "/minerals/{mineral_id}/optics",
    summary="Indices, birefringence, 2V and absorption of a mineral at any wavelength",
    responses={
        **_answers(
            "`optics` holds an object for each wavelength, in their order",
            {
                "mineral": "calcite",
                "optical_class": "uniaxial",
                "concentrations_weight_percent": {},
                "optics": [
                    {
                        "wavelength_nm": 589.3,
                        "indices": {"o": 1.658345, "e": 1.486093},
                        "group_indices": {"o": 1.690, "e": 1.501},
                        "birefringence": 0.172252,
                        "two_v_deg": None,
                        "optic_sign": "negative",
                        "absorption_per_mm": None,
                        "clamped": False,
                    }
                ],
            },
            "A header row and a row for each wavelength; n_o, group_index_o, absorption_o_per_mm and so on by axis",
        ),
        **problem_answers(404, 422),
    },
    openapi_extra={
        "parameters": [
            *openapi_parameters(OpticsRequest),
            {
                "name": f"{_CONCENTRATION}KEY",
                "in": "query",
                "required": False,
                "description": "Weight % of a chromophore in place of the entry's own; KEY is its key in "
                "`absorption.chromophores`, as in `concentration.chromium=0.2`",
                "schema": {"type": "number", "minimum": 0, "maximum": 100},
            },
        ]
    },
)
def optics(request: Request, mineral_id: str) -> Response:
    """Return what a mineral does to light of the wavelengths asked for.

    Indices, group indices and absorption are told by principal axis, as the entry's curves are called. Absorption is
    natural, of the intensity, in mm⁻¹: null where the entry has none. `clamped` says that a wavelength lies outside the
    range for which a curve is known, so that its value at the nearer end was taken.
    """
    entry = _entry(mineral_id)
    given = single_values(request.query_params.multi_items())
    texts = {name.removeprefix(_CONCENTRATION): text for name, text in given.items() if name.startswith(_CONCENTRATION)}
    concentrations, faults = read_concentrations(entry, texts, lambda key: query_parameter(_CONCENTRATION + key))
    try:
        others = {name: text for name, text in given.items() if not name.startswith(_CONCENTRATION)}
        asked = read_parameters(OpticsRequest, others, query_parameter)
    except InputError as error:
        raise InputError((*error.faults, *faults)) from None
    if faults:
        raise InputError(faults)
    csv = _is_csv(request, asked.format)
    etag = _etag("optics", [entry.id, asked.wavelengths_nm, concentrations, csv])
    if is_known(request, etag):
        return unchanged(etag, "no-cache")
    found = mineral_optics(entry, asked.wavelengths_nm, concentrations, query_parameter("wavelengths_nm"))
    headers = {"ETag": etag, "Vary": "Accept"}
    if csv:
        return _csv(csv_text(found.columns(), found.rows()), f"{entry.id}-optics", headers)
    links = {"self": _address(request), "mineral": _links(entry)["self"]}
    return JSONResponse({**found.document(), "links": links}, headers=headers)


@router.get("/schemas/mineral", summary="JSON Schema of a mineral's entry", response_model=dict[str, Any])
def entry_schema(request: Request) -> Response:
    """Return what a data file of a mineral holds, as JSON Schema (draft 2020-12)."""
    etag = _etag("schema", None)
    if is_known(request, etag):
        return unchanged(etag, "no-cache")
    return JSONResponse(minerals_db.entry_schema(), headers={"ETag": etag}, media_type="application/schema+json")


def _entry(mineral_id: str) -> Mineral:
    try:
        return minerals_db.mineral(mineral_id)
    except minerals_db.UnknownMineralError as error:
        raise ProblemError(404, "unknown-mineral", str(error)) from None


def _is_csv(request: Request, asked: str | None) -> bool:
    if asked is not None:
        return asked == "csv"
    return preferred_type(request, ("application/json", "text/csv")) == "text/csv"


def _etag(kind: str, question: object) -> str:
    return f'"{digest_of([answer_version(), kind, question])}"'


def _links(mineral: Mineral) -> dict[str, str]:
    address = f"/v1/minerals/{mineral.id}"
    return {"self": address, "optics": f"{address}/optics", "habits": f"{address}/habits"}


def _address(request: Request, **instead: str) -> str:
    """Return the address of a request, with other values of some parameters."""
    pairs = [(name, value) for name, value in request.query_params.multi_items() if name not in instead]
    query = urlencode([*pairs, *instead.items()])
    return f"{request.url.path}?{query}" if query else request.url.path


def _csv(text: str, name: str, headers: Mapping[str, str]) -> Response:
    disposition = {"Content-Disposition": f'inline; filename="{name}.csv"'}
    return Response(text, media_type=CSV_MEDIA_TYPE, headers={**headers, **disposition})
