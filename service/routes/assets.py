"""Assets: pictures and meshes of one's own, for scenes and demonstrations to name."""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import Annotated, Any, Literal
from urllib.parse import unquote

from fastapi import APIRouter, Path, Query, Request, Response
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field

from crystal_core.errors import InputError
from crystal_core.geometry.mesh_contents import MAX_BYTES as MAX_MESH_BYTES
from crystal_core.scene.contents import file_suffix
from crystal_core.scene.texture import MAX_BYTES as MAX_PICTURE_BYTES
from service.assets.shelf import Asset, ShelfBusyError
from service.problems import ProblemError
from service.routes.common import IMMUTABLE, TheWorkshop, is_known, problem_answers, unchanged

__all__ = ["router"]

router = APIRouter(prefix="/v1/assets", tags=["assets"])

TYPES = {
    "image/png": ".png",
    "image/jpeg": ".jpg",
    "model/obj": ".obj",
    "model/ply": ".ply",
    "application/ply": ".ply",
    "model/stl": ".stl",
    "model/gltf-binary": ".glb",
    "model/gltf+json": ".gltf",
}
"""Media types that tell what a file is; of PLY none is registered, these are in use."""

ANYTHING = ("", "application/octet-stream")
"""Say nothing: the name of the file may, and its content must."""

_NAMES = {".png": "PNG", ".jpg": "JPEG", ".obj": "OBJ", ".ply": "PLY", ".stl": "STL", ".glb": "GLB", ".gltf": "glTF"}
_PICTURES = (".png", ".jpg")

FileNameQuery = Annotated[
    str | None, Query(max_length=255, description="Name of the file, whose ending tells what it is; not kept")
]


class AssetView(BaseModel):
    """An asset."""

    asset: str = Field(description="What scenes and parameters call it: asset: and the SHA-256 of its bytes")
    kind: Literal["texture", "mesh"]
    size: int = Field(description="Bytes")
    facts: dict[str, Any] = Field(
        description="Of a texture: format, width_px, height_px, colour, mean_reflectance. Of a mesh: format, faces "
        "(triangles in one plane are one), triangles, corners, convex, extent along x, y, z in the file's numbers, "
        "filled_fraction (volume over that of the cube of its largest extent)"
    )
    notes: list[str] = Field(description="What is mended or left out when it is used")


_BODY = {
    "required": True,
    "description": "The file itself: a picture of at most 8 MiB and 16 million pixels, or a closed mesh of at most "
    "16 MiB and 20,000 triangles",
    "content": {kind: {"schema": {"type": "string", "format": "binary"}} for kind in (*TYPES, ANYTHING[1])},
}


@router.post(
    "",
    status_code=201,
    summary="Hand over a picture or a mesh",
    response_model=AssetView,
    responses={
        200: {"model": AssetView, "description": "It was there already"},
        **problem_answers(413, 415, 422, 503),
    },
    openapi_extra={"requestBody": _BODY},
)
async def create(request: Request, workshop: TheWorkshop, filename: FileNameQuery = None) -> Response:
    """Check a file and keep it under the digest of its bytes.

    The media type or the name of the file tells what it is, and the content must agree. A mesh must be closed; what
    can be mended is mended, and ``notes`` say so. Nothing of a refused file is kept.
    """
    declared = _declared(request, filename)
    data = await request.body()
    suffix = _agreed(declared, file_suffix(data))
    limit = MAX_PICTURE_BYTES if suffix in _PICTURES else MAX_MESH_BYTES
    if len(data) > limit:
        raise ProblemError(413, "too-large", f"The file has {len(data)} bytes; at most {limit} are taken")
    try:
        asset, new = await run_in_threadpool(workshop.assets.put, data, suffix)
    except InputError as error:
        raise ProblemError(422, "asset", "; ".join(fault.message for fault in error.faults)) from None
    except ShelfBusyError as error:
        raise ProblemError(503, "not-ready", f"{error}; try again", headers={"Retry-After": "5"}) from None
    headers = {"Location": f"/v1/assets/{asset.name}", "Cache-Control": "no-store"}
    return JSONResponse(_view(asset), 201 if new else 200, headers)


@router.get(
    "/{asset}",
    summary="What an asset is",
    response_model=AssetView,
    responses={304: {}, **problem_answers(404)},
)
def show(
    request: Request,
    workshop: TheWorkshop,
    asset: Annotated[
        str, Path(pattern="^(asset:)?[0-9a-f]{64}$", description="Its name, with or without the leading asset:")
    ],
) -> Response:
    """Return its facts; they never change."""
    digest = asset.removeprefix("asset:")
    found = workshop.assets.get(digest)
    if found is None:
        raise ProblemError(404, "unknown-asset", f"There is no asset {digest}")
    etag = f'"{digest}"'
    if is_known(request, etag):
        return unchanged(etag, IMMUTABLE)
    return JSONResponse(_view(found), headers={"ETag": etag, "Cache-Control": IMMUTABLE})


def _declared(request: Request, filename: str | None) -> str | None:
    """Return what the request says of the file, None if it says nothing."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind in TYPES:
        return TYPES[kind]
    if kind not in ANYTHING:
        raise ProblemError(415, "media-type", f"{kind} is not taken; known: {', '.join(TYPES)}")
    name = filename or _disposed(request.headers.get("content-disposition", ""))
    if not name:
        return None
    suffix = PurePosixPath(name).suffix.lower().replace(".jpeg", ".jpg")
    if suffix not in _NAMES:
        raise ProblemError(415, "media-type", f"A file *{suffix} is not taken; known: {', '.join(_NAMES)}")
    return suffix


def _disposed(header: str) -> str | None:
    """Return the file name of a ``Content-Disposition`` (RFC 6266)."""
    found = re.search(r"filename\*\s*=\s*[\w-]+'[^']*'([^;\s]+)", header)
    if found:
        return unquote(found[1])
    found = re.search(r'filename\s*=\s*(?:"([^"]*)"|([^;\s]+))', header)
    return (found[1] or found[2]) if found else None


def _agreed(declared: str | None, found: str | None) -> str:
    """Return what a file is, by what is said of it and what it looks like."""
    if found is None and declared is None:
        known = ", ".join(_NAMES.values())
        raise ProblemError(415, "media-type", f"The file is none of {known}, and its media type and name say nothing")
    if found is None or (declared is not None and declared != found):
        assert declared is not None
        looks = "" if found is None else f": it looks like {_NAMES[found]}"
        raise ProblemError(422, "asset", f"The file is no {_NAMES[declared]}{looks}")
    return found


def _view(asset: Asset) -> dict[str, Any]:
    view = AssetView.model_validate(
        {"asset": asset.name, "kind": asset.kind, "size": asset.size, "facts": asset.facts, "notes": asset.notes}
    )
    return view.model_dump(mode="json")
