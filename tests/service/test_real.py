"""The service with the real renderer, at small sizes."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image

from crystal_core import sequence
from crystal_core.spectra.colour import to_srgb8
from service.app import create_app
from service.engine import DaskEngine, Engine, InlineEngine
from service.settings import Settings
from service.workshop import Workshop
from tests.service.helpers import finish

REQUEST = {"demonstration": "rotating-calcite", "frames": 3, "size": [48, 40], "quality": "draft", "seed": 7}


def opened(folder: Path, engine: Callable[[], Engine]) -> TestClient:
    where = Settings(data_dir=folder, workers=2)
    return TestClient(create_app(where, workshop=Workshop(where, engine)))


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    with opened(tmp_path_factory.mktemp("data"), InlineEngine) as client:
        yield client


def render(client: TestClient, **request: Any) -> dict[str, Any]:
    answer = client.post("/v1/renders", json={**REQUEST, **request})
    assert answer.status_code == 202, answer.text
    return finish(client, answer.headers["location"])


def test_frames_are_those_of_the_renderer(client: TestClient) -> None:
    job = render(client)
    assert job["status"] == "successful", job["problem"]
    request = sequence.parse_request(REQUEST)
    assert job["request"] == request.canonical()
    for frame in job["frames"]:
        results = [sequence.render_tile(request, frame["index"], n) for n in range(len(sequence.tile_grid(request)))]
        whole = sequence.assemble(request, results)
        picture = np.asarray(Image.open(io.BytesIO(client.get(frame["links"]["png"]).content)))
        assert np.array_equal(picture, to_srgb8(whole.linear)[0])
        assert frame["error_estimate"] == whole.error_estimate
        assert frame["angle_deg"] == 120.0 * frame["index"]
    manifest = client.get(job["links"]["manifest"]).json()
    assert manifest["complete"] is True
    assert manifest["parameters"] == job["request"]["parameters"]
    assert manifest["request_digest"] == job["digest"]
    assert [frame["sha256"] for frame in manifest["frames"]] == [frame["sha256"] for frame in job["frames"]]


def test_what_the_ledger_keeps_is_the_same_request_again() -> None:
    # Taking up an interrupted run rests on it: another digest would throw away what has been done.
    request = sequence.parse_request({**REQUEST, "parameters": {"marks": [[1, 2.5], [-3, 0]], "analyser_deg": 30}})
    again = sequence.parse_request(json.loads(json.dumps(request.canonical())))
    assert again == request
    assert again.digest() == request.digest()


def test_worker_processes_give_the_same_bits(client: TestClient, tmp_path: Path) -> None:
    def two() -> Engine:
        return DaskEngine(2)

    request = {"size": [160, 144], "frames": 2}  # four tiles a frame
    with opened(tmp_path, two) as other:
        theirs = render(other, **request)
    ours = render(client, **request)
    assert ours["progress"]["tiles"] == 8
    assert [frame["sha256"] for frame in ours["frames"]] == [frame["sha256"] for frame in theirs["frames"]]


BAD: dict[str, tuple[dict[str, Any], set[str]]] = {
    "demonstration": ({"demonstration": "rotating-cheese"}, {"/demonstration"}),
    "no demonstration": ({"demonstration": None}, {"/demonstration"}),
    "mineral": ({"parameters": {"mineral": "kryptonite"}}, {"/parameters/mineral"}),
    "parameter": ({"parameters": {"colour": "red"}}, {"/parameters/colour"}),
    "parameters": ({"parameters": []}, {"/parameters"}),
    "axis": ({"parameters": {"axis_tilt_deg": "steep"}}, {"/parameters/axis_tilt_deg"}),
    "size 0": ({"size": [0, 512]}, {"/size/0"}),
    "size 100000": ({"size": [512, 100000]}, {"/size/1"}),
    "size of one": ({"size": [512]}, {"/size/1"}),
    "frames": ({"frames": 361}, {"/frames"}),
    "frames as text": ({"frames": "36"}, {"/frames"}),
    "quality": ({"quality": "perfect"}, {"/quality"}),
    "seed": ({"seed": -1}, {"/seed"}),
    "huge seed": ({"seed": 2**63}, {"/seed"}),
    "unknown key": ({"colour": "red"}, {"/colour"}),
    "own picture": ({"parameters": {"texture": "asset:" + "0" * 64}}, {"/parameters/texture"}),
    "path": ({"parameters": {"texture": "../../etc/passwd"}}, {"/parameters/texture"}),
    "two at once": ({"frames": 0, "parameters": {"mineral": "kryptonite"}}, {"/frames", "/parameters/mineral"}),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_a_problem_with_pointers(client: TestClient, case: str) -> None:
    change, pointers = BAD[case]
    answer = client.post("/v1/renders", json={**REQUEST, **change})
    assert answer.status_code == 422, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert {fault["pointer"] for fault in answer.json()["errors"]} == pointers


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999", "-1e999"])
def test_numbers_that_are_none_are_refused(client: TestClient, number: str) -> None:
    body = f'{{"demonstration": "rotating-calcite", "parameters": {{"gap_mm": {number}}}}}'
    answer = client.post("/v1/renders", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["pointer"] == "/parameters/gap_mm"


JSON_VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)
KEYS = st.sampled_from(["demonstration", "parameters", "frames", "size", "quality", "seed", "else"])
PARAMETERS = st.sampled_from(sorted(sequence.demonstrations()["rotating-calcite"].Parameters.model_fields))


@given(
    body=st.dictionaries(KEYS, JSON_VALUES), parameters=st.none() | st.dictionaries(PARAMETERS, JSON_VALUES, min_size=1)
)
@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_no_body_breaks_the_service(
    client: TestClient, body: dict[str, Any], parameters: dict[str, Any] | None
) -> None:
    if parameters is not None:
        body = {"demonstration": "rotating-calcite", "frames": 1, "size": [16, 16], "parameters": parameters}
    answer = client.post("/v1/renders", content=json.dumps(body), headers={"Content-Type": "application/json"})
    assert answer.status_code in (202, 422), answer.text
    if answer.status_code == 422:
        assert answer.json()["errors"]
    else:
        client.delete(answer.headers["location"])


@pytest.mark.parametrize(
    ("change", "status"),
    [({"size": [16, 16]}, 202), ({"size": [15, 16]}, 422), ({"frames": 1}, 202), ({"frames": 0}, 422)],
)
def test_limits_are_where_they_are_said_to_be(client: TestClient, change: dict[str, Any], status: int) -> None:
    answer = client.post("/v1/renders", json={**REQUEST, **change})
    assert answer.status_code == status


def test_the_schema_tells_the_limits_of_the_renderer(client: TestClient) -> None:
    schema = client.get("/openapi.json").json()["paths"]["/v1/renders"]["post"]["requestBody"]
    properties = schema["content"]["application/json"]["schema"]["oneOf"][0]["properties"]
    defaults = sequence.parse_request({"demonstration": "rotating-calcite"}).canonical()
    for name in ("frames", "size", "quality", "seed"):
        assert properties[name]["default"] == defaults[name]


def test_demonstrations_come_with_the_schema_of_their_parameters(client: TestClient) -> None:
    (calcite,) = client.get("/v1/demonstrations").json()["demonstrations"]
    assert calcite["name"] == "rotating-calcite"
    assert set(calcite["title"]) == set(calcite["summary"]) == {"en", "ru"}
    defaults = sequence.parse_request({"demonstration": "rotating-calcite"}).canonical()["parameters"]
    properties = calcite["parameters"]["properties"]
    assert {name: spec["default"] for name, spec in properties.items()} == defaults
