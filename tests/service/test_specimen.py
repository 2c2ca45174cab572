"""`isogyre specimen`, and the habits of a mineral over HTTP."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from fastapi.testclient import TestClient

import minerals_db
from crystal_core.scene.specimen import specimen_solid
from service.cli import run


def told(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert run(["specimen", *arguments]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert run(["specimen", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("isogyre: ")
    return err.removeprefix("isogyre: ").rstrip("\n")


def check_document(document: dict[str, Any], mineral_id: str, habit: str, size_mm: float) -> None:
    body = specimen_solid(minerals_db.mineral(mineral_id), habit, size_mm).body
    assert (document["mineral"], document["habit"], document["size_mm"]) == (mineral_id, habit, size_mm)
    assert document["volume_mm3"] == body.volume_mm3
    corners = np.array(document["vertices_mm"])
    assert len(corners) - len(document["edges"]) + len(document["faces"]) == 2
    assert document["area_mm2"] == pytest.approx(sum(face["area_mm2"] for face in document["faces"]))
    np.testing.assert_allclose(document["extent_mm"], np.ptp(corners, axis=0))
    for face in document["faces"]:
        assert all(isinstance(index, int) for index in face["hkl"])
        ring = np.array(face["vertices_mm"])
        np.testing.assert_array_equal(ring, corners[face["vertices"]])
        np.testing.assert_allclose(ring @ face["normal"], face["distance_mm"], atol=1e-12 * size_mm)
        around = sum(np.cross(ring[i - 1], ring[i]) for i in range(len(ring))) / 2.0
        np.testing.assert_allclose(around, face["area_mm2"] * np.array(face["normal"]), atol=1e-9)
        assert document["forms"][face["form"]]["hkl"] in [
            other["hkl"] for other in document["faces"] if other["form"] == face["form"]
        ]
    for edge in document["edges"]:
        one, other = (document["faces"][number] for number in edge["faces"])
        assert set(edge["vertices"]) <= set(one["vertices"]) & set(other["vertices"])
        cosine = np.dot(one["normal"], other["normal"])
        assert edge["angle_deg"] == pytest.approx(np.rad2deg(np.arccos(cosine)), abs=1e-6)
        i, j = edge["vertices"]
        assert edge["length_mm"] == pytest.approx(np.linalg.norm(corners[i] - corners[j]))


def test_json(capsys: pytest.CaptureFixture[str]) -> None:
    document = json.loads(told(capsys, "quartz", "--habit", "prismatic", "--size", "20", "--json"))
    check_document(document, "quartz", "prismatic", 20.0)
    assert len(document["faces"]) == 18
    assert document["point_group"] == "321"


def test_the_first_habit_of_the_entry(capsys: pytest.CaptureFixture[str]) -> None:
    document = json.loads(told(capsys, "calcite", "--json"))
    check_document(document, "calcite", minerals_db.mineral("calcite").habits[0].name, 10.0)
    assert {face["label"] for face in document["faces"]} >= {"r 1 0 4", "r -1 0 -4"}


def test_page_for_people(capsys: pytest.CaptureFixture[str]) -> None:
    page = told(capsys, "quartz", "--habit", "prismatic").splitlines()
    assert page[0] == "quartz, prismatic"
    assert page[1] == "class 321; 18 faces, 48 edges, 32 corners"
    assert any(line.split()[-3:-1] == ["1.9", "6"] for line in page)
    assert any(line.endswith(" 38.21°") and "1 0 0 ∧" in line for line in page)


@pytest.mark.parametrize("mineral_id", ["quartz", "albite", "almandine"])
def test_mesh(capsys: pytest.CaptureFixture[str], tmp_path: Path, mineral_id: str) -> None:
    """Another library reads the file, and finds it closed, turned outwards and of our volume."""
    out = tmp_path / "crystal.PLY"
    document = json.loads(told(capsys, mineral_id, "--size", "7.5", "--json", "--mesh", str(out)))
    mesh = trimesh.load(out)
    assert isinstance(mesh, trimesh.Trimesh)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(document["volume_mm3"], rel=1e-12)
    assert len(mesh.vertices) == len(document["vertices_mm"])
    lines = out.read_text("ascii").splitlines()
    assert f"element face {len(document['faces'])}" in lines  # polygons, not triangles
    assert [int(word) for word in lines[-1].split()[-3:]] == document["faces"][-1]["hkl"]


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["quarz"], "MINERAL: no mineral 'quarz'"),
        (["quartz", "--habit", "cube"], "--habit: quartz has no habit 'cube'; those known are prismatic"),
        (["bbo"], "--habit: no habit of bbo is known"),
        (["soda-lime-glass"], "MINERAL: soda-lime-glass is a glass"),
        (["quartz", "--size", "0"], "--size: must be a length"),
        (["quartz", "--size", "nan"], "--size: must be a length"),
        (["quartz", "--mesh", "crystal.obj"], "--mesh: must end in .ply"),
        (["quartz", "--mesh", "/nowhere/at/all/crystal.ply"], "--mesh: /nowhere/at/all/crystal.ply cannot be written"),
    ],
)
def test_refusals(capsys: pytest.CaptureFixture[str], arguments: list[str], complaint: str) -> None:
    assert refused(capsys, *arguments).startswith(complaint)


def test_a_habit_that_does_not_close(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """As it may stand in an entry of one's own."""
    quartz = minerals_db.mineral("quartz")
    prism = quartz.habits[0].model_copy(update={"forms": quartz.habits[0].forms[:1]})
    monkeypatch.setattr(minerals_db, "mineral", lambda _: quartz.model_copy(update={"habits": (prism,)}))
    assert refused(capsys, "quartz").startswith("--habit: {1 0 0} in class 321 do not close")


def test_habits_over_http(client: TestClient) -> None:
    answer = client.get("/v1/minerals/calcite/habits").json()
    entry = minerals_db.mineral("calcite")
    assert [habit["name"] for habit in answer["habits"]] == [habit.name for habit in entry.habits]
    assert answer["habits"][0]["forms"][0]["hkl"] == [1, 0, 4]
    assert answer["habits"][0]["status"] == "estimated"
    for habit in answer["habits"]:
        document = client.get(f"{habit['links']['self']}?size_mm=4").json()
        check_document(document, "calcite", habit["name"], 4.0)
        assert document["links"]["self"] == habit["links"]["self"]


def test_a_habit_is_found_however_its_name_is_written(client: TestClient) -> None:
    answers = [
        client.get(f"/v1/minerals/calcite/habits/{name}")
        for name in ("cleavage-rhombohedron", "Cleavage%20rhombohedron")
    ]
    assert answers[0].json() == answers[1].json()
    etag = answers[0].headers["etag"]
    assert answers[1].headers["etag"] == etag
    again = client.get("/v1/minerals/calcite/habits/cleavage-rhombohedron", headers={"If-None-Match": etag})
    assert (again.status_code, again.content) == (304, b"")
    other = client.get("/v1/minerals/calcite/habits/cleavage-rhombohedron?size_mm=11", headers={"If-None-Match": etag})
    assert other.status_code == 200


def test_a_mineral_without_habits(client: TestClient) -> None:
    assert client.get("/v1/minerals/bbo/habits").json()["habits"] == []


@pytest.mark.parametrize(
    ("path", "status", "kind", "pointer"),
    [
        ("/v1/minerals/quarz/habits", 404, "unknown-mineral", None),
        ("/v1/minerals/quarz/habits/prismatic", 404, "unknown-mineral", None),
        ("/v1/minerals/quartz/habits/cube", 404, "unknown-habit", None),
        ("/v1/minerals/bbo/habits/cube", 404, "unknown-habit", None),
        ("/v1/minerals/quartz/habits?size_mm=1", 422, "input", "query/size_mm"),
        ("/v1/minerals/quartz/habits/prismatic?size_mm=0", 422, "input", "query/size_mm"),
        ("/v1/minerals/quartz/habits/prismatic?size_mm=nan", 422, "input", "query/size_mm"),
        ("/v1/minerals/quartz/habits/prismatic?size=3", 422, "input", "query/size"),
    ],
)
def test_problems(client: TestClient, path: str, status: int, kind: str, pointer: str | None) -> None:
    answer = client.get(path)
    assert answer.status_code == status
    problem = answer.json()
    assert problem["type"] == f"urn:isogyre:problem:{kind}"
    if pointer is not None:
        assert [fault["pointer"] for fault in problem["errors"]] == [pointer]


def test_described(client: TestClient) -> None:
    paths = client.get("/openapi.json").json()["paths"]
    parameters = paths["/v1/minerals/{mineral_id}/habits/{name}"]["get"]["parameters"]
    assert [parameter["name"] for parameter in parameters if parameter["in"] == "query"] == ["size_mm"]
