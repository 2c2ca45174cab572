"""Event streams: what they tell, what they replay, when they end."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from fastapi.testclient import TestClient

from tests.service.helpers import ask, finish


def events(text: str) -> list[dict[str, Any]]:
    """Read an event stream as the HTML standard says."""
    found = []
    for block in text.split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.split("\n") if line and not line.startswith(":"))
        if "data" in fields:
            found.append({"event": fields["event"], "id": int(fields["id"]), "data": json.loads(fields["data"])})
    return found


def stream(client: TestClient, address: str, **headers: str) -> list[dict[str, Any]]:
    answer = client.get(f"{address}/events", headers=headers)
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/event-stream")
    return events(answer.text)


def test_a_stream_tells_everything_and_ends(client: TestClient) -> None:
    address = ask(client, frames=4, parameters={"delay_s": 0.01})
    told = stream(client, address)  # returns when the stream has ended
    job = client.get(address).json()
    assert job["status"] == "successful"
    statuses = [event["data"] for event in told if event["event"] == "status"]
    assert [data["status"] for data in statuses] == ["accepted", "running", "successful"]
    assert all(data["problem"] is None for data in statuses)
    frames = [event["data"] for event in told if event["event"] == "frame"]
    assert [{key: data[key] for key in data if key != "href"} for data in frames] == job["frames"]
    assert all(client.get(data["href"]).headers["content-type"] == "image/webp" for data in frames)
    progress = [event["data"] for event in told if event["event"] == "progress"]
    assert progress[-1] == job["progress"]
    steps = [(data["tiles_done"], data["frames_done"]) for data in progress]
    assert steps == sorted(set(steps))  # forward only, and nothing twice
    numbered = [event["id"] for event in told if event["event"] != "progress"]
    assert numbered == list(range(1, 8))
    assert [event["id"] for event in told] == sorted(event["id"] for event in told)


def test_a_stream_goes_on_where_it_broke_off(client: TestClient) -> None:
    address = ask(client, frames=3)
    finish(client, address)
    whole = [event for event in stream(client, address) if event["event"] != "progress"]
    for last in range(len(whole)):
        replayed = stream(client, address, **{"Last-Event-ID": str(last)})
        assert [event for event in replayed if event["event"] != "progress"] == whole[last:]
    for nonsense in ("x", "-1", "", "9" * 40):
        assert [e for e in stream(client, address, **{"Last-Event-ID": nonsense}) if e["event"] != "progress"] == whole


def test_a_failure_is_told_with_its_problem(client: TestClient) -> None:
    told = stream(client, ask(client, parameters={"fail": [0, 1]}))
    assert told[-1]["event"] == "status"
    assert told[-1]["data"]["status"] == "failed"
    assert "the lattice came apart" in told[-1]["data"]["problem"]["detail"]


def test_a_dismissed_job_ends_its_stream_though_the_run_goes_on(client: TestClient, tmp_path: Path) -> None:
    gate = tmp_path / "gate"
    first, second = (ask(client, parameters={"gate": str(gate)}) for _ in range(2))
    client.delete(first)
    told = stream(client, first)
    assert told[-1] == {"event": "status", "id": told[-1]["id"], "data": {"status": "dismissed", "problem": None}}
    gate.touch()
    assert finish(client, second)["status"] == "successful"
    again = [event["data"]["status"] for event in stream(client, first) if event["event"] == "status"]
    assert again == ["dismissed"]


def test_the_last_job_dismissed_ends_its_stream(client: TestClient, tmp_path: Path) -> None:
    address = ask(client, parameters={"gate": str(tmp_path / "never")})
    client.delete(address)
    (tmp_path / "never").touch()
    assert stream(client, address)[-1]["data"]["status"] == "dismissed"
