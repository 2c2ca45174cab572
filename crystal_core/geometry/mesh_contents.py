"""What a file says it holds, read cheaply before anything is unpacked; and its triangles."""

from __future__ import annotations

import json
import re
import struct
import warnings
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError

__all__ = ["MAX_BYTES", "MAX_FACES", "SUFFIXES", "mesh_triangles"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]

SUFFIXES = (".obj", ".ply", ".stl", ".glb", ".gltf")

MAX_FACES = 20_000
"""Triangles of a mesh."""

MAX_BYTES = 16 * 2**20
"""Of a file: 20,000 triangles in words take 6 MB."""

_MAX_CORNERS = 3 * MAX_FACES
_MAX_NUMBERS = 40 * MAX_FACES
_MAX_NODES = 1000
_GLB_MAGIC, _GLB_JSON = 0x46546C67, 0x4E4F534A


def mesh_triangles(data: bytes, suffix: str, *, pointer: str = "") -> tuple[Real, Index, tuple[str, ...]]:
    """Return the triangles of a file.

    Nothing but the bytes is read: materials and pictures are passed over, and no name in a file is followed.

    Parameters
    ----------
    data : bytes
        The file.
    suffix : str
        One of `SUFFIXES`, which tells the format.
    pointer : str
        Where the mesh stands in the input.

    Returns
    -------
    vertices : Real
        Shape (V, 3).
    triangles : NDArray of int
        Shape (T, 3).
    notes : tuple of str
        What was left out.

    Raises
    ------
    InputError
        At the pointer: another format, too large, of too many faces, in several files, or not to be read.
    """
    kind = suffix.lower().removeprefix(".")
    if f".{kind}" not in SUFFIXES:
        raise InputError.at(pointer, f"a mesh is a file {', '.join(SUFFIXES)}, not {suffix!r}")
    if kind in ("glb", "gltf"):
        _check_bytes(data, pointer)
        _check_gltf(data, kind, pointer)
    else:
        faces, corners = {"stl": _stl, "ply": _ply, "obj": _obj}[kind](data, pointer)
        _check_counts(faces, corners, pointer)
        _check_bytes(data, pointer)
    return _parsed(data, kind, pointer)


def _check_bytes(data: bytes, pointer: str) -> None:
    if len(data) > MAX_BYTES:
        raise InputError.at(pointer, f"the file has {len(data)} bytes, more than {MAX_BYTES}")


def _check_counts(faces: int, corners: int, pointer: str) -> None:
    if faces > MAX_FACES:
        raise InputError.at(pointer, f"the mesh has {faces} faces, more than {MAX_FACES}")
    if corners > _MAX_CORNERS:
        raise InputError.at(pointer, f"the mesh has {corners} corners, more than {_MAX_CORNERS}")


def _no_mesh(kind: str, reason: str, pointer: str) -> InputError:
    return InputError.at(pointer, f"not {kind.upper()} data that can be read: {reason}")


def _stl(data: bytes, pointer: str) -> tuple[int, int]:
    """Return the numbers of faces and corners."""
    if len(data) >= 84:
        (count,) = struct.unpack_from("<I", data, 80)
        if len(data) == 84 + 50 * count:
            return count, 3 * count
    if data.lstrip()[:5].lower() != b"solid":
        raise _no_mesh("stl", "neither the length of a binary file nor the word 'solid'", pointer)
    count = max(data.count(b"endfacet"), data.count(b"ENDFACET"))
    return count, max(3 * count, data.count(b"vertex"), data.count(b"VERTEX"))


def _ply(data: bytes, pointer: str) -> tuple[int, int]:
    header, found, _ = data[: 2**16].partition(b"end_header")
    if not data.startswith(b"ply") or not found:
        raise _no_mesh("ply", "no header", pointer)
    elements = {name: int(count) for name, count in re.findall(rb"(?m)^\s*element\s+(\S+)\s+(\d{1,18})\s*$", header)}
    others = max((count for name, count in elements.items() if name not in (b"face", b"vertex")), default=0)
    if others > _MAX_CORNERS:
        raise InputError.at(pointer, f"the file has {others} elements of one kind, more than {_MAX_CORNERS}")
    return elements.get(b"face", 0), elements.get(b"vertex", 0)


def _obj(data: bytes, pointer: str) -> tuple[int, int]:
    faces, corners = len(re.findall(rb"\nf[ \t]", b"\n" + data)), len(re.findall(rb"\nv[ \t]", b"\n" + data))
    if faces <= MAX_FACES and corners <= _MAX_CORNERS:
        # Polygons become fans of triangles.
        polygons = _obj_lines(data, b"f")
        if any(b"-" in polygon for polygon in polygons):
            raise InputError.at(pointer, "relative (negative) numbers of corners are not read: number them from 1")
        faces = sum(max(len(polygon.split()) - 2, 1) for polygon in polygons)
    return faces, corners


def _obj_lines(data: bytes, kind: bytes) -> list[bytes]:
    """Return what follows `kind` in the lines of it."""
    joined = re.sub(rb"\\\r?\n", b" ", data)
    return re.findall(rb"(?m)^[ \t]*" + kind + rb"[ \t]+([^\r\n]*)", joined)


def _obj_geometry(data: bytes) -> bytes:
    """Return the corners and faces of an OBJ file alone: no groups, materials, texture coordinates or normals."""
    corners = [b"v " + b" ".join(line.split()[:3]) for line in _obj_lines(data, b"v")]
    faces = [b"f " + b" ".join(corner.split(b"/")[0] for corner in line.split()) for line in _obj_lines(data, b"f")]
    return b"\n".join((*corners, *faces, b""))


def _check_gltf(data: bytes, kind: str, pointer: str) -> None:
    """Raise for a glTF document that would grow when it is unpacked, or that needs other files."""
    text = data
    if kind == "glb":
        if len(data) < 20:
            raise _no_mesh(kind, "shorter than a header", pointer)
        magic, _, _, length, chunk = struct.unpack_from("<5I", data)
        if magic != _GLB_MAGIC or chunk != _GLB_JSON:
            raise _no_mesh(kind, "no header", pointer)
        text = data[20 : 20 + length]
    try:
        tree: Any = json.loads(text)
        _check_tree(tree, pointer)
    except InputError:
        raise
    except (ValueError, TypeError, KeyError, AttributeError, IndexError, RecursionError) as error:
        raise _no_mesh(kind, f"{type(error).__name__} in its JSON", pointer) from error


def _check_tree(tree: dict[str, Any], pointer: str) -> None:
    for name in ("buffers", "bufferViews", "accessors", "meshes", "nodes", "scenes"):
        if len(tree.get(name, [])) > _MAX_NODES:
            raise InputError.at(pointer, f"the file has {len(tree[name])} {name}, more than {_MAX_NODES}")
    for buffer in tree.get("buffers", []):
        uri = buffer.get("uri")
        if uri is not None and not uri.startswith("data:"):
            raise InputError.at(pointer, f"the mesh lies in another file, {uri[:80]!r}: use a .glb that holds it all")
    required = tree.get("extensionsRequired", [])
    if required:
        raise InputError.at(
            pointer, f"the file needs extensions that are not read: {', '.join(map(str, required))[:200]}"
        )
    views = sum(int(view["byteLength"]) for view in tree.get("bufferViews", []))
    if views > 4 * MAX_BYTES:
        raise InputError.at(pointer, f"the file's views have {views} bytes, more than {4 * MAX_BYTES}")
    accessors = tree.get("accessors", [])
    if any("sparse" in accessor for accessor in accessors):
        raise InputError.at(pointer, "sparse accessors are not read")
    counts = [int(accessor["count"]) for accessor in accessors]
    if min(counts, default=0) < 0 or sum(counts) > _MAX_NUMBERS:
        raise InputError.at(pointer, f"the file has {sum(counts)} items of data, more than {_MAX_NUMBERS}")
    nodes = tree.get("nodes", [])
    children = [int(child) for node in nodes for child in node.get("children", [])]
    if len(set(children)) < len(children) or _turns_back(nodes):
        raise InputError.at(pointer, "the nodes of the file are no tree")
    faces = corners = 0
    for node in nodes:
        for primitive in tree["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            corners += counts[primitive["attributes"]["POSITION"]]
            if primitive.get("mode", 4) == 4:
                faces += counts[primitive.get("indices", primitive["attributes"]["POSITION"])] // 3
            elif primitive["mode"] in (5, 6):
                faces += counts[primitive.get("indices", primitive["attributes"]["POSITION"])]
    _check_counts(faces, corners, pointer)


def _turns_back(nodes: list[dict[str, Any]]) -> bool:
    """Tell whether nodes, each the child of at most one, go round in a circle."""
    parent = {int(child): number for number, node in enumerate(nodes) for child in node.get("children", [])}
    for number in parent:
        place, steps = number, 0
        while place in parent:
            place, steps = parent[place], steps + 1
            if steps > len(nodes):
                return True
    return False


def _parsed(data: bytes, kind: str, pointer: str) -> tuple[Real, Index, tuple[str, ...]]:
    import trimesh  # half a second: only who reads a mesh pays for it

    try:
        # A warning means that something was not read as it stands.
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("error")
            text = _obj_geometry(data) if kind == "obj" else data
            scene = trimesh.load_scene(
                BytesIO(text), file_type=kind, resolver=None, allow_remote=False, process=False, skip_materials=True
            )
            parts = scene.dump()
    except Exception as error:  # whatever a parser stumbles over, the file is not readable
        raise _no_mesh(kind, f"{type(error).__name__}: {str(error)[:200]}".rstrip(": "), pointer) from error
    meshes = [part for part in parts if isinstance(part, trimesh.Trimesh)]
    notes = []
    if len(meshes) < len(parts):
        notes.append(f"left out {len(parts) - len(meshes)} part(s) that are lines or points")
    if kind == "obj" and re.search(rb"(?m)^[ \t]*mtllib", data):
        notes.append("left out the materials of another file")
    if not any(len(mesh.faces) for mesh in meshes):
        raise InputError.at(pointer, "the file holds no triangles")
    if any(mesh.vertices.shape[1:] != (3,) or mesh.faces.shape[1:] != (3,) for mesh in meshes):
        raise _no_mesh(kind, "corners are not three numbers each", pointer)
    vertices = np.concatenate([np.asarray(mesh.vertices, np.float64) for mesh in meshes])
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    triangles = np.concatenate(
        [np.asarray(mesh.faces, np.intp) + start for mesh, start in zip(meshes, starts, strict=True)]
    )
    _check_counts(len(triangles), len(vertices), pointer)
    return vertices, triangles, tuple(notes)
