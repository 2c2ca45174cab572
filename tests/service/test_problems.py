"""Every error is an RFC 9457 problem, and every answer carries the security headers."""

from __future__ import annotations

import json
from typing import Any

import pytest
from fastapi.testclient import TestClient

from service.app import create_app
from service.settings import Settings
from service.shield import HEADERS
from service.workshop import Workshop
from tests.service.helpers import ask, finish

JSON = {"Content-Type": "application/json"}
LIMIT = 1_048_576


def padded(size: int) -> bytes:
    body = json.dumps({"demonstration": "fake", "frames": 1}).encode()
    return body + b" " * (size - len(body))


CASES: dict[str, tuple[str, str, dict[str, Any], int, str]] = {
    "no such address": ("GET", "/v2/renders", {}, 404, "not-found"),
    "no such file": ("GET", "/nothing.css", {}, 404, "not-found"),
    "traversal": ("GET", "/..%2f..%2fpyproject.toml", {}, 404, "not-found"),
    "no such render": ("GET", "/v1/renders/01ARZ3NDEKTSV4RRFFQ69G5FAV", {}, 404, "unknown-render"),
    "no render of this shape": ("GET", "/v1/renders/..%2fx", {}, 404, "not-found"),
    "events of no render": ("GET", "/v1/renders/x/events", {}, 404, "unknown-render"),
    "frame of no render": ("GET", "/v1/renders/x/frames/0.png", {}, 404, "unknown-render"),
    "dismiss no render": ("DELETE", "/v1/renders/x", {}, 404, "unknown-render"),
    "no such mineral": ("GET", "/v1/minerals/kryptonite", {}, 404, "unknown-mineral"),
    "method": ("GET", "/v1/renders", {}, 405, "method-not-allowed"),
    "method besides": ("PATCH", "/v1/renders/x", {}, 405, "method-not-allowed"),
    "no content type": ("POST", "/v1/renders", {"content": b"{}"}, 415, "media-type"),
    "a form": ("POST", "/v1/renders", {"data": {"demonstration": "fake"}}, 415, "media-type"),
    "no JSON": ("POST", "/v1/renders", {"content": b"{", "headers": JSON}, 400, "json"),
    "empty": ("POST", "/v1/renders", {"content": b"", "headers": JSON}, 400, "json"),
    "not UTF-8": ("POST", "/v1/renders", {"content": b'{"a": "\xff"}', "headers": JSON}, 400, "json"),
    "too deep": ("POST", "/v1/renders", {"content": b"[" * 60000, "headers": JSON}, 400, "json"),
    "a list": ("POST", "/v1/renders", {"json": []}, 422, "input"),
    "nothing asked": ("POST", "/v1/renders", {"json": {}}, 422, "input"),
    "too large": ("POST", "/v1/renders", {"content": padded(LIMIT + 1), "headers": JSON}, 413, "too-large"),
}


@pytest.mark.parametrize("case", CASES)
def test_errors_are_problems(client: TestClient, case: str) -> None:
    method, path, more, status, kind = CASES[case]
    answer = client.request(method, path, **more)
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert set(problem) == {"type", "title", "status", "detail", "errors"}
    assert problem["type"] == f"urn:isogyre:problem:{kind}"
    assert problem["status"] == status
    assert problem["title"]
    assert problem["detail"]
    for name, value in HEADERS.items():
        assert answer.headers[name] == value


def test_every_wrong_place_is_named(client: TestClient) -> None:
    answer = client.post("/v1/renders", json={"demonstration": "nope", "size": [0, 100000], "colour": "red"})
    assert answer.status_code == 422
    assert {fault["pointer"] for fault in answer.json()["errors"]} == {"/demonstration", "/size", "/colour"}
    assert all(fault["detail"] for fault in answer.json()["errors"])


def test_lone_surrogates_do_not_break_the_answer(client: TestClient) -> None:
    body = b'{"demonstration": "fake", "\\ud800": 1}'
    answer = client.post("/v1/renders", content=body, headers=JSON)
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["pointer"] == "/\ud800"


def test_a_body_of_exactly_the_limit_is_read(client: TestClient) -> None:
    answer = client.post("/v1/renders", content=padded(LIMIT), headers=JSON)
    assert answer.status_code == 202


def test_a_body_without_a_length_is_cut_off_too(client: TestClient) -> None:
    sent = 0

    def endless() -> Any:
        nonlocal sent
        for _ in range(2 * LIMIT // 1024):
            sent += 1024
            yield b" " * 1024

    answer = client.post("/v1/renders", content=endless(), headers=JSON)
    assert answer.status_code == 413
    assert answer.json()["type"] == "urn:isogyre:problem:too-large"


def test_a_405_names_the_methods_there_are(client: TestClient) -> None:
    assert client.get("/v1/renders").headers["allow"] == "POST"


def test_a_fault_of_ours_is_a_problem_without_innards(
    client: TestClient, inline_workshop: Workshop, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(_: str) -> None:
        raise RuntimeError("secret innards")

    monkeypatch.setattr(inline_workshop.ledger, "job", broken)
    answer = client.get("/v1/renders/x")
    assert answer.status_code == 500
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert answer.json()["type"] == "urn:isogyre:problem:internal"
    assert "secret" not in answer.text


def test_good_answers_carry_the_headers_too(client: TestClient) -> None:
    job = finish(client, ask(client))
    for path in ("/", "/v1/minerals", "/v1/demonstrations", "/healthz", "/openapi.json", job["links"]["sequence"]):
        answer = client.get(path)
        assert answer.status_code == 200, path
        for name, value in HEADERS.items():
            assert answer.headers[name] == value
    assert "script-src" not in HEADERS["Content-Security-Policy"]  # default-src 'self' covers it: nothing inline
    assert "unsafe" not in HEADERS["Content-Security-Policy"]


def test_ready_only_while_renders_are_worked_on(client: TestClient, inline_workshop: Workshop) -> None:
    assert client.get("/healthz").json() == {"status": "ok"}
    assert client.get("/readyz").json() == {"status": "ready"}
    inline_workshop.runner.close()
    answer = client.get("/readyz")
    assert answer.status_code == 503
    assert answer.headers["retry-after"] == "5"
    assert answer.json()["type"] == "urn:isogyre:problem:not-ready"
    assert client.get("/healthz").status_code == 200


def test_not_ready_before_the_start(settings: Settings) -> None:
    client = TestClient(create_app(settings))  # without its lifespan
    assert client.get("/readyz").status_code == 503
