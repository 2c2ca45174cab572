"""Scenes over HTTP: the language, the check, renders of scenes."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any

import pytest
from fastapi.testclient import TestClient

from crystal_core.scene import scene_schema
from service import workshop as workshop_module
from service.app import create_app
from service.settings import Settings
from service.workshop import Workshop
from tests.service.asset_files import cube, png
from tests.service.helpers import finish

SCENE: dict[str, Any] = {
    "isogyre": 1,
    "title": "Calcite over a page",
    "bodies": {
        "crystal": {
            "mineral": "calcite",
            "shape": {"cleavage": {"spacing_mm": [12, 20, 20]}},
            "orientation": {"z": {"hkl": [1, 0, 4]}},
            "rests_on": "page",
        }
    },
    "surfaces": {"page": {"print": "digits"}},
    "render": {"size_px": [24, 16], "quality": "draft"},
}
SPHERE = {"mineral": "quartz", "shape": {"sphere": {"diameter_mm": 5}}, "position_mm": [0, 0, 30]}


@pytest.fixture
def real(settings: Settings, inline_workshop: Workshop) -> Iterator[TestClient]:
    with TestClient(create_app(settings, workshop=inline_workshop)) as client:
        yield client


def changed(path: str, value: object) -> dict[str, Any]:
    """Return the scene with another value at a JSON pointer."""
    scene = copy.deepcopy(SCENE)
    *above, key = path[1:].split("/")
    holder = scene
    for step in above:
        holder = holder.setdefault(step, {})
    holder[key] = value
    return scene


def test_the_schema_is_published(real: TestClient) -> None:
    answer = real.get("/v1/scenes/schema")
    assert answer.headers["content-type"] == "application/schema+json"
    assert answer.json() == scene_schema()


def test_a_valid_scene_is_summed_up(real: TestClient) -> None:
    answer = real.post("/v1/scenes/validate", json=SCENE)
    assert answer.status_code == 200, answer.text
    told = answer.json()
    assert (told["valid"], told["warnings"]) == (True, [])
    (body,) = told["summary"]["bodies"]
    assert (body["name"], body["material"], body["optical_class"], body["faces"]) == (
        "crystal",
        "calcite",
        "uniaxial",
        6,
    )
    assert body["extent_mm"][2] == pytest.approx(12)
    assert body["lowest_mm"] == pytest.approx(0.02)
    # The pole of the cleavage (104) stands 44.6° from c: calcite's rhombohedron.
    assert body["optic_axes"][0][2] == pytest.approx(0.7115, abs=2e-3)
    assert [light["name"] for light in told["summary"]["lights"]] == ["lamp", "sky"]


def test_what_cannot_be_rendered_yet_is_a_warning(real: TestClient) -> None:
    answer = real.post("/v1/scenes/validate", json=changed("/bodies/ball", SPHERE))
    assert answer.status_code == 200
    (warning,) = answer.json()["warnings"]
    assert warning["pointer"] == "/bodies/ball"
    assert "only one body" in warning["detail"]


@pytest.mark.parametrize(
    ("scene", "pointers"),
    [
        ({}, ["/isogyre"]),
        (changed("/bodies/crystal/colour", "red"), ["/bodies/crystal/colour"]),
        (changed("/bodies/crystal/mineral", "calzite"), ["/bodies/crystal/mineral"]),
        (changed("/bodies/ball", {**SPHERE, "position_mm": [0, 0, 6]}), ["/bodies/ball"]),
        (changed("/surfaces/page", {"print": "photo.png"}), ["/surfaces/page/print"]),
        (changed("/surfaces/page", {"print": "../../etc/passwd.png"}), ["/surfaces/page/print"]),
        (changed("/surfaces/page", {"print": "asset:" + "0" * 64}), ["/surfaces/page/print"]),
        (changed("/camera", {"perspective": {"eye_mm": [0, 0, 5]}}), ["/camera/perspective/eye_mm"]),
        ([], [""]),
    ],
)
def test_what_is_wrong_is_told_by_its_place(real: TestClient, scene: Any, pointers: list[str]) -> None:
    answer = real.post("/v1/scenes/validate", json=scene)
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert [error["pointer"] for error in answer.json()["errors"]][: len(pointers)] == pointers
    if isinstance(scene, dict):
        asked = real.post("/v1/renders", json={"scene": scene})
        assert asked.status_code == 422
        assert [error["pointer"] for error in asked.json()["errors"]][: len(pointers)] == [
            f"/scene{p}" for p in pointers
        ]


def test_a_body_that_is_no_json(real: TestClient) -> None:
    header = {"content-type": "application/json"}
    for route in ("/v1/scenes/validate", "/v1/renders"):
        assert real.post(route, content=b"{", headers=header).status_code == 400
        assert real.post(route, content=b"[" * 100_000, headers=header).status_code == 400
        assert real.post(route, content=b"isogyre: 1").status_code == 415


def test_a_scene_is_rendered(real: TestClient) -> None:
    answer = real.post("/v1/renders", json={"scene": SCENE})
    assert answer.status_code == 202, answer.text
    job = finish(real, answer.headers["location"])
    assert job["status"] == "successful", job["problem"]
    assert (job["request"]["size"], job["request"]["quality"], job["request"]["frames"]) == ([24, 16], "draft", 1)
    assert real.get(job["links"]["manifest"]).json()["document"]["title"] == "Calcite over a page"
    assert real.get(job["frames"][0]["links"]["png"]).status_code == 200
    # The same with every default written out, and with the settings beside it.
    for same in (job["request"], {"scene": {**SCENE, "render": {}}, "size": [24, 16], "quality": "draft"}):
        again = real.post("/v1/renders", json=same).json()
        assert (again["digest"], again["status"]) == (job["digest"], "successful")


def test_frames_of_a_scene_come_from_its_motion(real: TestClient) -> None:
    motion = {"frames": 4, "moves": [{"turn": {"what": "crystal", "angles_deg": [0, 360]}}]}
    job = finish(real, real.post("/v1/renders", json={"scene": changed("/motion", motion)}).headers["location"])
    assert [frame["angle_deg"] for frame in job["frames"]] == [0, 90, 180, 270]
    assert len({frame["sha256"] for frame in job["frames"]}) == 4
    fewer = real.post("/v1/renders", json={"scene": changed("/motion", motion), "frames": 2}).json()
    assert fewer["request"]["scene"]["motion"]["frames"] == fewer["progress"]["frames"] == 2


@pytest.mark.parametrize(
    ("request_", "pointer", "words"),
    [
        ({"scene": SCENE, "frames": 2}, "/frames", "no motion"),
        ({"scene": SCENE, "frames": 0}, "/frames", "1"),
        ({"scene": SCENE, "size": [8, 16]}, "/size/0", "16"),
        ({"scene": SCENE, "demonstration": "rotating-calcite"}, "/demonstration", "does not go with scene"),
        ({"scene": SCENE, "parameters": {}}, "/parameters", "does not go with scene"),
        ({"scene": SCENE, "colour": 1}, "/colour", "unknown key"),
        ({"scene": "calcite.yaml"}, "/scene", "dictionary"),
    ],
)
def test_requests_of_scenes_are_checked(real: TestClient, request_: dict[str, Any], pointer: str, words: str) -> None:
    answer = real.post("/v1/renders", json=request_)
    assert answer.status_code == 422
    (error,) = answer.json()["errors"]
    assert error["pointer"] == pointer
    assert words in error["detail"]


def test_a_scene_that_cannot_be_drawn_is_refused_by_its_place(real: TestClient) -> None:
    answer = real.post("/v1/renders", json={"scene": changed("/bodies/ball", SPHERE)})
    assert (answer.status_code, answer.json()["type"]) == (422, "urn:isogyre:problem:not-supported")
    assert answer.json()["detail"].startswith("/scene/bodies/ball: ")


def test_a_scene_that_takes_too_long_to_look_at_is_refused_with_the_number(real: TestClient) -> None:
    small = {"mineral": "quartz", "shape": {"sphere": {"diameter_mm": 1}}}
    bodies = {f"b{i}": {**small, "position_mm": [2 * i, 0, 0]} for i in range(24)}
    motion = {"frames": 360, "moves": [{"stage": {"angles_deg": [0, 1]}}]}
    scene = {"isogyre": 1, "bodies": bodies, "motion": motion}
    for route, body, pointer in (
        ("/v1/scenes/validate", scene, "/bodies"),
        ("/v1/renders", {"scene": scene}, "/scene/bodies"),
    ):
        answer = real.post(route, json=body)
        assert answer.status_code == 422
        (error,) = answer.json()["errors"]
        assert error["pointer"] == pointer
        assert "24 bodies in 360 frames cost 207360" in error["detail"]


def test_scenes_name_assets(real: TestClient) -> None:
    picture = real.post("/v1/assets?filename=a.png", content=png((40, 20))).json()["asset"]
    mesh = real.post("/v1/assets?filename=a.ply", content=cube("ply", inside_out=True)).json()["asset"]
    scene = changed("/surfaces/page", {"print": picture, "shape": {"rectangle": {"width_mm": 60}}})
    scene["bodies"]["crystal"]["shape"] = {"mesh": {"file": mesh, "size_mm": 10}}
    answer = real.post("/v1/scenes/validate", json=scene)
    assert answer.status_code == 200, answer.text
    told = answer.json()
    assert told["summary"]["surfaces"][0]["size_mm"] == [60, 30]
    assert told["summary"]["bodies"][0]["faces"] == 6
    assert [warning["pointer"] for warning in told["warnings"]] == ["/bodies/crystal/shape/mesh"]
    job = finish(real, real.post("/v1/renders", json={"scene": scene}).headers["location"])
    assert job["status"] == "successful", job["problem"]
    # A mesh where a picture should be.
    wrong = real.post("/v1/scenes/validate", json=changed("/surfaces/page", {"print": mesh}))
    assert [error["pointer"] for error in wrong.json()["errors"]] == ["/surfaces/page/print"]


def test_workers_that_have_no_time_are_a_503(
    real: TestClient, inline_workshop: Workshop, monkeypatch: pytest.MonkeyPatch
) -> None:
    import threading

    gate = threading.Event()
    inline_workshop._engine.submit(gate.wait, key="busy")
    monkeypatch.setattr(workshop_module, "PATIENCE_S", 0.05)
    answer = real.post("/v1/scenes/validate", json=SCENE)
    gate.set()
    assert (answer.status_code, answer.json()["type"]) == (503, "urn:isogyre:problem:not-ready")
    assert answer.headers["retry-after"]
    monkeypatch.undo()
    assert real.post("/v1/scenes/validate", json=SCENE).status_code == 200


def test_the_api_tells_of_scenes_and_assets(real: TestClient) -> None:
    document = real.get("/openapi.json").json()
    assert {"/v1/scenes/validate", "/v1/scenes/schema", "/v1/assets", "/v1/assets/{asset}"} <= set(document["paths"])
    body = document["paths"]["/v1/renders"]["post"]["requestBody"]["content"]["application/json"]["schema"]
    assert [kind["required"] for kind in body["oneOf"]] == [["demonstration"], ["scene"]]
