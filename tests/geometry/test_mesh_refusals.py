"""Meshes that are refused, each for a reason of its own, and before any work where they are too large."""

import json
import struct

import numpy as np
import pytest
import trimesh

from crystal_core.errors import InputError
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.mesh_contents import MAX_BYTES, MAX_FACES
from crystal_core.geometry.mesh_file import load_mesh
from tests.geometry.mesh_files import BOX, SUFFIXES, TORUS, file_of, mesh_of


def _refused(data: bytes, suffix: str = ".ply", size_mm: float | None = None) -> str:
    with pytest.raises(InputError) as caught:
        load_mesh(data, suffix, size_mm, pointer="/bodies/stone/shape/mesh")
    (fault,) = caught.value.faults
    assert fault.pointer == "/bodies/stone/shape/mesh"
    assert "\n" not in fault.message
    return fault.message


def _klein_bottle(count: int = 13) -> trimesh.Trimesh:
    """Return a closed surface with one side: a tube whose ends meet the wrong way round."""
    angles = 2 * np.pi * np.arange(count) / count
    u, v = np.meshgrid(angles, angles, indexing="ij")
    place = np.stack(((3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v) * np.cos(u / 2)), axis=-1)

    def corner(i: int, j: int) -> int:
        return (-j) % count if i == count else i * count + j % count

    faces = []
    for i in range(count):
        for j in range(count):
            a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
            faces += [[a, b, c], [a, c, d]]
    return mesh_of(place.reshape(-1, 3), faces)


def _through() -> trimesh.Trimesh:
    """Return a box with a corner pulled out through the opposite side."""
    vertices = BOX.vertices.copy()
    vertices[vertices.sum(axis=1).argmax()] = (-3.0, -1.0, -2.5)
    return mesh_of(vertices, BOX.faces)


def _with_nan() -> trimesh.Trimesh:
    vertices = BOX.vertices.copy()
    vertices[3] = np.nan
    return mesh_of(vertices, BOX.faces)


TWO = trimesh.util.concatenate([BOX, BOX.copy().apply_translation((9.0, 0.0, 0.0))])
TOUCHING = trimesh.util.concatenate([BOX, BOX.copy().apply_translation((2.0, 0.0, 0.0))])
FLAT = mesh_of([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 3, 2], [0, 2, 3], [0, 3, 1]])


@pytest.mark.parametrize(
    ("mesh", "told"),
    [
        (
            mesh_of(BOX.vertices, np.delete(BOX.faces, 3, axis=0)),
            "3 edges of one triangle only, around a hole near (-0.3333, -0.5, -2); holes are not",
        ),
        (
            mesh_of(BOX.vertices, np.delete(BOX.faces, [0, 11], axis=0)),
            "the mesh is open: 6 edges of one triangle only, around 2 holes",
        ),
        (TOUCHING, "more than two triangles meet at 4 edges, the first near (1, -1.5, 0)"),
        (TWO, "the mesh holds 2 separate surfaces"),
        (_klein_bottle(), "one side only"),
        (_through(), "the surface of the mesh passes through itself, for instance near"),
        (_with_nan(), "the place of 1 corner of the mesh is not three finite numbers"),
        (mesh_of(BOX.vertices * 1e35, BOX.faces), "the place of 8 corners of the mesh is not three finite numbers"),
        (FLAT, "encloses no volume"),
        (mesh_of(BOX.vertices * (1.0, 1.0, 1e-6), BOX.faces), "encloses no volume, or hardly any"),
        (mesh_of(BOX.vertices * 0.0 + 5.0, BOX.faces), "all corners of the mesh lie in one place"),
        (mesh_of([[0, 0, 0], [1, 0, 0], [5, 5, 5]], [[0, 0, 1], [2, 2, 1]]), "no triangle of the mesh has an area"),
        (mesh_of(BOX.vertices * 1e-6, BOX.faces), "5.39e-06 mm across if its numbers are mm; say size_mm"),
        (mesh_of(BOX.vertices * 1e4, BOX.faces), "mm across if its numbers are mm; say size_mm"),
    ],
)
def test_each_fault_has_its_own_message(mesh: trimesh.Trimesh, told: str) -> None:
    assert told in _refused(file_of(mesh, ".ply"))


def test_polygons_that_fold_back() -> None:
    """An L drawn as one polygon: the fan of triangles from its first corner leaves it."""
    ring = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    ring = ring[4:] + ring[:4]
    lines = [f"v {x} {y} {z}" for z in (0, 1) for x, y in ring]
    lines += ["f 6 5 4 3 2 1", "f 7 8 9 10 11 12"] + [
        f"f {i + 1} {(i + 1) % 6 + 1} {(i + 1) % 6 + 7} {i + 7}" for i in range(6)
    ]
    assert "folds back on itself" in _refused("\n".join(lines).encode(), ".obj")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_is_no_mesh(suffix: str) -> None:
    text = b"This is a letter, not a mesh, and it is a good deal longer than the header of a binary file of triangles."
    kinds = {".obj": "the file holds no triangles"}
    assert kinds.get(suffix, f"not {suffix[1:].upper()} data that can be read") in _refused(text, suffix)
    assert kinds.get(suffix, "data that can be read") in _refused(b"", suffix)
    whole = file_of(BOX, suffix)
    assert _refused(whole[: len(whole) * 2 // 3], suffix)


def test_other_formats() -> None:
    assert _refused(b"solid", ".step") == "a mesh is a file .obj, .ply, .stl, .glb, .gltf, not '.step'"
    assert "no triangles" in _refused(b"v 0 0 0\nv 1 0 0\nl 1 2\n", ".obj")
    assert "IndexError" in _refused(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n", ".obj")
    assert "not three numbers each" in _refused(b"v 0 0\nv 1 0\nv 1 1\nf 1 2 3\n", ".obj")
    assert "relative (negative)" in _refused(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf -1 -2 -3\n", ".obj")
    ply = file_of(BOX, ".ply")
    assert _refused(ply.replace(b"element face 12", b"element face 11"))


@pytest.mark.parametrize("size", [0.0, -1.0, float("nan"), float("inf")])
def test_wrong_size(size: float) -> None:
    with pytest.raises(InputError, match="must be a length") as caught:
        load_mesh(file_of(BOX, ".ply"), ".ply", size, pointer="/m")
    assert caught.value.faults[0].pointer == "/m/size_mm"


# Limits, and nothing but the bytes.


def _stated(count: int, suffix: str) -> bytes:
    """Return a file that says it has as many faces, cheaply."""
    if suffix == ".stl":
        return bytes(80) + struct.pack("<I", count) + bytes(50 * count)
    if suffix == ".ply":
        return b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nelement face %d\nend_header\n" % count
    if suffix == ".obj":
        return b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + b"f 1 2 3\n" * count
    tree = {
        "asset": {"version": "2.0"},
        "accessors": [{"count": 3, "componentType": 5126, "type": "VEC3"}, {"count": 3 * count, "componentType": 5125}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0}],
    }
    text = json.dumps(tree).encode()
    head = struct.pack("<5I", 0x46546C67, 2, 20 + len(text), len(text), 0x4E4F534A)
    return text if suffix == ".gltf" else head + text


@pytest.fixture
def no_parser(monkeypatch: pytest.MonkeyPatch) -> None:
    def parse(*_: object, **__: object) -> None:
        raise AssertionError("the file was unpacked")

    monkeypatch.setattr(trimesh, "load_scene", parse)


@pytest.mark.usefixtures("no_parser")
@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("count", [MAX_FACES + 1, 1_000_000])
def test_too_many_faces_are_refused_before_any_work(suffix: str, count: int) -> None:
    message = _refused(_stated(count, suffix), suffix)
    if count > MAX_FACES + 1 and suffix in (".glb", ".gltf"):
        assert message == f"the file has {3 * count + 3} items of data, more than 800000"
    else:
        assert message == f"the mesh has {count} faces, more than {MAX_FACES}"


@pytest.mark.usefixtures("no_parser")
def test_what_would_grow_is_refused_before_any_work() -> None:
    assert f"more than {MAX_BYTES}" in _refused(b"# nothing\n" * (MAX_BYTES // 10 + 1), ".obj")
    assert "corners, more than 60000" in _refused(b"v 0 0 0\n" * 60_001, ".obj")
    polygon = b"v 0 0 0\nf" + b" 1" * (MAX_FACES + 3)
    assert f"{MAX_FACES + 1} faces" in _refused(polygon, ".obj")
    assert "corners, more than 60000" in _refused(
        b"ply\nformat ascii 1.0\nelement vertex 999999999999\nproperty float x\nend_header\n"
    )
    assert "elements of one kind" in _refused(
        b"ply\nformat ascii 1.0\nelement leaf 99999999\nproperty float x\nend_header\n"
    )
    tree = json.loads(_stated(12, ".gltf"))
    for change, told in [
        (
            {
                "nodes": [{"mesh": 0}] * 999 + [{"children": list(range(999))}],
                "accessors": [{"count": 3}, {"count": 99}],
            },
            "32967 faces",
        ),
        ({"nodes": [{"mesh": 0}] * 1001}, "1001 nodes"),
        ({"nodes": [{"mesh": 0, "children": [1]}, {"children": [0]}]}, "no tree"),
        ({"nodes": [{"children": [2]}, {"children": [2]}, {"mesh": 0}]}, "no tree"),
        ({"bufferViews": [{"byteLength": MAX_BYTES}] * 5}, "views have"),
        ({"accessors": [{"count": -3}, {"count": 9}]}, "items of data"),
        ({"accessors": [{"count": 3, "sparse": {}}, {"count": 9}]}, "sparse"),
        ({"extensionsRequired": ["KHR_draco_mesh_compression"]}, "KHR_draco_mesh_compression"),
        ({"buffers": [{"uri": "https://example.org/stone.bin", "byteLength": 9}]}, "lies in another file"),
        ({"buffers": [{"uri": "file:///stone.bin", "byteLength": 9}]}, "lies in another file"),
        ({"meshes": 7}, "data that can be read: TypeError"),
    ]:
        assert told in _refused(json.dumps(tree | change).encode(), ".gltf")


def test_twenty_thousand_triangles_are_taken() -> None:
    whole = trimesh.creation.torus(3.0, 1.0, major_sections=100, minor_sections=100)
    assert len(whole.faces) == MAX_FACES
    body = load_mesh(file_of(whole, ".ply"), ".ply").solid.body
    assert isinstance(body, Mesh)
    assert len(body.corners) == MAX_FACES


def test_nothing_outside_is_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    """Materials, pictures and buffers of other files are named; no file is opened and no address looked up."""
    data = b"mtllib stone.mtl\nusemtl red\n" + file_of(BOX, ".obj")
    textured = json.loads(file_of(BOX, ".gltf"))
    textured["images"] = [{"uri": "stone.png"}]
    textured["textures"] = [{"source": 0}]
    textured["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    ply = file_of(BOX, ".ply").replace(b"end_header", b"comment TextureFile stone.png\nend_header")
    load_mesh(data, ".obj")  # whatever is imported lazily is there now

    def refuse(*arguments: object, **_: object) -> None:
        raise AssertionError(f"something was opened: {arguments}")

    monkeypatch.setattr("builtins.open", refuse)
    monkeypatch.setattr("socket.socket", refuse)
    monkeypatch.setattr("pathlib.Path.open", refuse)
    assert load_mesh(data, ".obj").notes == ("left out the materials of another file",)
    for bytes_, suffix in ((json.dumps(textured).encode(), ".gltf"), (ply, ".ply")):
        assert load_mesh(bytes_, suffix).solid.body.volume_mm3 == pytest.approx(24.0, rel=1e-6)


def test_tangles_are_refused_in_bounded_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("crystal_core.geometry.crossing_edges._MOST_PAIRS", 1000)
    assert _refused(file_of(TORUS, ".ply")) == "too many triangles of the mesh lie over each other"
