"""The probes over HTTP: the same answers as at the command line, problems with pointers, the API's description."""

from __future__ import annotations

import json
from typing import Any

import pytest
from fastapi.testclient import TestClient

from service.probes.interface import INTERFACE
from service.probes.plate import PLATE
from service.probes.probe import Probe
from tests.service.interface_questions import CALCITE

STACK = {"plates": [{"indices": [1.5], "thickness_um": 30}], "wavelengths_nm": [500]}
QUESTIONS: dict[str, dict[str, Any]] = {"interface": CALCITE, "plate": STACK}
PROBES: dict[str, Probe[Any]] = {"interface": INTERFACE, "plate": PLATE}


def ask(client: TestClient, probe: str, content: bytes, kind: str = "application/json") -> Any:
    return client.post(f"/v1/optics/{probe}", content=content, headers={"Content-Type": kind})


@pytest.mark.parametrize("probe", QUESTIONS)
def test_one_object_has_one_answer(client: TestClient, probe: str) -> None:
    answer = client.post(f"/v1/optics/{probe}", json=QUESTIONS[probe])
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "application/json"
    assert answer.headers["cache-control"] == "no-store"
    assert answer.json() == PROBES[probe].ask(QUESTIONS[probe])


@pytest.mark.parametrize("probe", QUESTIONS)
@pytest.mark.parametrize("kind", ["application/jsonl", "application/x-ndjson", "Application/JSONL; charset=utf-8"])
def test_lines_are_answered_in_order(client: TestClient, probe: str, kind: str) -> None:
    other = {"interface": {**CALCITE, "to": {"indices": [1.7]}}, "plate": {**STACK, "mount_index": 1.7}}[probe]
    lines = [QUESTIONS[probe], other, QUESTIONS[probe]]
    answer = ask(client, probe, "\n\n".join(map(json.dumps, lines)).encode(), kind)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"].startswith(kind.partition(";")[0].lower())
    assert answer.text.endswith("\n")
    assert [json.loads(line) for line in answer.text.splitlines()] == [PROBES[probe].ask(line) for line in lines]


def test_lines_are_known_by_themselves(client: TestClient) -> None:
    other = {**CALCITE, "to": {"indices": [1.7]}}
    answer = ask(client, "interface", f"{json.dumps(CALCITE)}\n{json.dumps(other)}".encode())
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "application/jsonl"
    assert [json.loads(line) for line in answer.text.splitlines()] == [INTERFACE.ask(CALCITE), INTERFACE.ask(other)]


@pytest.mark.parametrize(
    ("change", "pointers"),
    [
        ({"normal": [0, 0, 0]}, ["/normal"]),
        ({"to": {"indices": [1.5, 0], "axes": [[1, 0, 0]] * 3}, "x": 1}, ["/to/indices/1", "/to/axes", "/x"]),
        ({"from": {"indices": [1.5, 1.6]}}, ["/from/axes"]),
        ({"normal": [0, 0, float("nan")]}, ["/normal/2"]),
    ],
)
def test_every_wrong_place_has_its_pointer(client: TestClient, change: dict[str, Any], pointers: list[str]) -> None:
    answer = ask(client, "interface", json.dumps({**CALCITE, **change}).encode())
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert problem["type"] == "urn:isogyre:problem:input"
    assert [fault["pointer"] for fault in problem["errors"]] == pointers
    assert all(fault["detail"] for fault in problem["errors"])


def test_wrong_lines_are_told_by_number(client: TestClient) -> None:
    lines = [CALCITE, {**CALCITE, "normal": [0, 0, 0]}, CALCITE, {**CALCITE, "to": 5, "y": 1}]
    answer = ask(client, "interface", "\n".join(map(json.dumps, lines)).encode(), "application/jsonl")
    assert answer.status_code == 422
    problem = answer.json()
    assert problem["detail"].startswith("2 lines cannot be answered, the first of them line 2: /normal: must be a unit")
    assert [fault["pointer"] for fault in problem["errors"]] == ["/normal", "/to", "/y"]
    assert [fault["detail"].partition(":")[0] for fault in problem["errors"]] == ["line 2", "line 4", "line 4"]


@pytest.mark.parametrize(
    ("content", "kind", "status", "problem"),
    [
        (b"{}", "text/plain", 415, "media-type"),
        (b"{}", "", 415, "media-type"),
        (b"", "application/json", 400, "json"),
        (b"{", "application/json", 400, "json"),
        (b"\xff", "application/json", 400, "json"),
        (b"[" * 60_000, "application/json", 400, "json"),
        (b"{}\n{}", "application/json", 422, "input"),
        (b"{\n}\n}", "application/json", 400, "json"),
        (b"[]", "application/json", 422, "input"),
        (b"", "application/jsonl", 400, "json"),
        (b"{}\n{\n", "application/jsonl", 422, "input"),
        (b"{\n{}\n", "application/jsonl", 400, "json"),
        (b"\n" + b" " * 1_048_576, "application/jsonl", 413, "too-large"),
    ],
)
@pytest.mark.parametrize("probe", QUESTIONS)
def test_bodies_that_are_no_questions(
    client: TestClient, probe: str, content: bytes, kind: str, status: int, problem: str
) -> None:
    answer = ask(client, probe, content, kind)
    assert answer.status_code == status, answer.text
    assert answer.json()["type"] == f"urn:isogyre:problem:{problem}"


def test_too_many_lines(client: TestClient) -> None:
    answer = ask(client, "plate", b"{}\n" * 201, "application/jsonl")
    assert answer.status_code == 422
    assert answer.json()["detail"] == "(input): the body has 201 lines; at most 200 are answered at once"


def test_the_description_knows_requests_and_answers(client: TestClient) -> None:
    document = client.get("/openapi.json").json()
    for probe, model in (("interface", "InterfaceAnswer"), ("plate", "PlateAnswer")):
        post = document["paths"][f"/v1/optics/{probe}"]["post"]
        body = post["requestBody"]["content"]
        lines = {"application/jsonl", "application/x-ndjson", "application/ndjson", "application/x-jsonlines"}
        assert set(body) == {"application/json"} | lines
        schema = body["application/json"]["schema"]
        assert "$ref" not in json.dumps(schema)
        for example in schema["examples"]:
            assert client.post(f"/v1/optics/{probe}", json=example).status_code == 200, example
        for key, value in schema["properties"].items():
            assert value.get("description"), key
        answers = post["responses"]
        assert answers["200"]["content"]["application/json"]["schema"]["$ref"].endswith(f"/{model}")
        assert {"400", "413", "415", "422"} <= set(answers)
        assert model in document["components"]["schemas"]
    schema = document["paths"]["/v1/optics/interface"]["post"]["requestBody"]["content"]["application/json"]["schema"]
    assert schema["required"] == ["wavelength_nm", "normal", "from", "to"]
    assert schema["additionalProperties"] is False
    for example in schema["properties"]["to"]["examples"]:
        assert client.post("/v1/optics/interface", json={**CALCITE, "to": example}).status_code == 200, example
