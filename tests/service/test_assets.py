"""Assets over HTTP: checked in a process of its own, kept under their digest, named by scenes and demonstrations."""

from __future__ import annotations

import errno
import hashlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from crystal_core.scene.contents import file_suffix
from service.app import create_app
from service.assets import shelf as shelf_module
from service.assets.shelf import AssetShelf, CheckerFailedError
from service.settings import Settings
from service.workshop import Workshop
from tests.service.asset_files import cube, heavy_stl, jpeg, png
from tests.service.helpers import finish


@pytest.fixture
def real(settings: Settings, inline_workshop: Workshop) -> Iterator[TestClient]:
    with TestClient(create_app(settings, workshop=inline_workshop)) as client:
        yield client


def put(client: TestClient, data: bytes, kind: str = "application/octet-stream", **more: Any) -> Any:
    return client.post("/v1/assets", content=data, headers={"content-type": kind, **more})


def kept(settings: Settings) -> list[str]:
    return sorted(path.name for path in (settings.data_dir / "assets").iterdir())


@pytest.mark.parametrize(
    ("data", "suffix"),
    [
        (png(), ".png"),
        (jpeg(), ".jpg"),
        *((cube(kind), f".{kind}") for kind in ("ply", "stl", "obj", "glb")),
        (cube("stl_ascii"), ".stl"),
        (b"ply\r\nformat ascii 1.0\r\n", ".ply"),
        (b"# a comment\nv 0 0 0\n", ".obj"),
        (b"solid x" + bytes(73) + (1).to_bytes(4, "little") + bytes(50), ".stl"),
        (b'\n{"scenes": [], "asset": {"version": "2.0"}}', ".gltf"),
        (b"GIF89a", None),
        (b"<svg/>", None),
        (b"plywood", None),
        (b"", None),
        (bytes(200), None),
        (b"vanish 1 2 3", None),
    ],
)
def test_files_are_told_by_their_content(data: bytes, suffix: str | None) -> None:
    assert file_suffix(data) == suffix


def test_a_picture_is_kept_and_kept_once(real: TestClient, settings: Settings) -> None:
    data = png((32, 16))
    name = f"asset:{hashlib.sha256(data).hexdigest()}"
    answer = put(real, data, "image/png")
    assert answer.status_code == 201, answer.text
    assert answer.headers["location"] == f"/v1/assets/{name}"
    told = answer.json()
    assert (told["asset"], told["kind"], told["size"], told["notes"]) == (name, "texture", len(data), [])
    assert told["facts"] == {
        "format": "PNG",
        "width_px": 32,
        "height_px": 16,
        "colour": False,
        "mean_reflectance": pytest.approx(0.2159, abs=1e-4),  # sRGB 128: IEC 61966-2-1
    }
    again = put(real, data)
    assert (again.status_code, again.json()) == (200, told)
    shown = real.get(answer.headers["location"])
    assert (shown.status_code, shown.json()) == (200, told)
    assert real.get(f"/v1/assets/{name.removeprefix('asset:')}").json() == told
    assert "immutable" in shown.headers["cache-control"]
    assert real.get(f"/v1/assets/{name}", headers={"if-none-match": shown.headers["etag"]}).status_code == 304
    digest = name.removeprefix("asset:")
    assert kept(settings) == [digest, f"{digest}.json"]
    assert (settings.data_dir / "assets" / digest).read_bytes() == data


@pytest.mark.parametrize("kind", ["ply", "stl", "obj", "glb"])
def test_a_mesh_tells_its_faces(real: TestClient, kind: str) -> None:
    answer = put(real, cube(kind))
    assert answer.status_code == 201, answer.text
    told = answer.json()
    assert told["kind"] == "mesh"
    facts = told["facts"]
    assert (facts["format"], facts["faces"], facts["corners"], facts["convex"]) == (kind.upper(), 6, 8, True)
    assert facts["extent"] == [2, 2, 2]
    assert facts["filled_fraction"] == 1


def test_what_is_mended_is_told(real: TestClient) -> None:
    answer = put(real, cube(inside_out=True))
    assert answer.status_code == 201
    assert answer.json()["notes"]


@pytest.mark.parametrize(
    ("data", "headers", "query", "status", "words"),
    [
        (png(), {"content-type": "image/gif"}, "", 415, "image/gif is not taken"),
        (png(), {"content-type": "multipart/form-data; boundary=x"}, "", 415, "multipart/form-data is not taken"),
        (b"GIF89a", {}, "", 415, "none of PNG, JPEG"),
        (b"GIF89a", {}, "?filename=a.gif", 415, "*.gif is not taken"),
        (png(), {"content-disposition": 'attachment; filename="a.tiff"'}, "", 415, "*.tiff is not taken"),
        (png(), {"content-type": "image/jpeg"}, "", 422, "no JPEG: it looks like PNG"),
        (png(), {}, "?filename=stone.ply", 422, "no PLY: it looks like PNG"),
        (b"", {"content-type": "image/png"}, "", 422, "no PNG"),
        (png((300, 300))[:60], {"content-type": "image/png"}, "", 422, "picture"),
        (png((4001, 4000), "1"), {"content-type": "image/png"}, "", 422, "at most 16000000"),
        (png() + bytes(9_000_000), {"content-type": "image/png"}, "", 413, "8388608"),
        (bytes(17_000_000), {}, "", 413, "16777216"),
        (cube(hole=True), {}, "", 422, "around a hole"),
        (heavy_stl(20_001), {}, "", 422, "20001"),
        (b"ply\nformat ascii 1.0\nend_header\n", {"content-type": "model/ply"}, "", 422, ""),
        (b"v 0 0 0\nf 1 1 1\n", {"content-type": "model/obj"}, "", 422, ""),
    ],
)
def test_what_cannot_serve_is_refused_with_the_reason(
    real: TestClient, settings: Settings, data: bytes, headers: dict[str, str], query: str, status: int, words: str
) -> None:
    answer = real.post(f"/v1/assets{query}", content=data, headers=headers)
    assert (answer.status_code, answer.headers["content-type"]) == (status, "application/problem+json"), answer.text
    assert words in answer.json()["detail"]
    assert kept(settings) == []


def test_only_assets_may_be_so_large(real: TestClient) -> None:
    answer = real.post("/v1/renders", content=bytes(1_048_577), headers={"content-type": "application/json"})
    assert answer.status_code == 413


def test_names_that_are_none_are_not_found(real: TestClient) -> None:
    for name in ("asset:" + "0" * 64, "0" * 64):
        answer = real.get(f"/v1/assets/{name}")
        assert (answer.status_code, answer.json()["type"]) == (404, "urn:isogyre:problem:unknown-asset")
    for name in ("asset:../../ledger.sqlite", "..%2Fledger.sqlite", "asset:" + "A" * 64, "0" * 63, "x.json"):
        assert real.get(f"/v1/assets/{name}").status_code == 404


def test_a_full_disk_keeps_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shelf = AssetShelf(tmp_path / "assets")
    written: list[str] = []

    def write(path: Path, data: bytes) -> str:
        written.append(path.name)
        if len(written) == 2:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        path.write_bytes(data)
        return ""

    monkeypatch.setattr(shelf_module, "write_atomically", write)
    data = png()
    digest = hashlib.sha256(data).hexdigest()
    with pytest.raises(OSError, match="space"):
        shelf.put(data, ".png")
    assert shelf.get(digest) is None
    assert shelf.put(data, ".png")[1]
    assert shelf.get(digest) is not None


def test_a_checker_that_takes_too_long_or_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shelf = AssetShelf(tmp_path / "assets")
    program = tmp_path / "checker"
    monkeypatch.setattr(sys, "executable", str(program))
    monkeypatch.setattr(shelf_module, "PATIENCE_S", 0.2)
    for script, error, words in (
        ("sleep 60", ValueError, "more than 0.2 s"),
        ("kill -9 $$", ValueError, "too much memory"),
        ("echo first >&2; echo the reason >&2; exit 1", CheckerFailedError, "^the reason$"),
    ):
        program.write_text(f"#!/bin/sh\nexec </dev/null\n{script}\n", encoding="utf-8")
        program.chmod(0o755)
        with pytest.raises(error, match=words):
            shelf.put(png(), ".png")
    assert list((tmp_path / "assets").iterdir()) == []


def test_leftovers_are_swept(tmp_path: Path) -> None:
    shelf = AssetShelf(tmp_path)
    (tmp_path / ".abc.0123.part").write_bytes(b"half")
    assert shelf.sweep() == 1
    assert list(tmp_path.iterdir()) == []


def test_a_demonstration_prints_an_asset(real: TestClient) -> None:
    name = put(real, png((64, 64)), "image/png").json()["asset"]
    request = {
        "demonstration": "rotating-calcite",
        "parameters": {"texture": name},
        "frames": 1,
        "size": [16, 16],
        "quality": "draft",
    }
    answer = real.post("/v1/renders", json=request)
    assert answer.status_code == 202, answer.text
    job = finish(real, answer.headers["location"])
    assert job["status"] == "successful", job["problem"]
    assert job["request"]["parameters"]["texture"] == name
    assert real.get(job["links"]["manifest"]).json()["parameters"]["texture"] == name
    unknown = real.post("/v1/renders", json={**request, "parameters": {"texture": "asset:" + "0" * 64}})
    assert (unknown.status_code, unknown.json()["errors"][0]["pointer"]) == (422, "/parameters/texture")
    path = real.post("/v1/renders", json={**request, "parameters": {"texture": "/etc/passwd"}})
    assert (path.status_code, path.json()["errors"][0]["pointer"]) == (422, "/parameters/texture")
