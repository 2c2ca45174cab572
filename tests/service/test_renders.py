"""Renders through the HTTP interface, with a stand-in for the renderer and the inline engine."""

from __future__ import annotations

import errno
import hashlib
import io
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from PIL import Image

from crystal_core.spectra.colour import to_srgb8
from service.artifacts import ArtifactStore
from service.settings import Settings
from service.workshop import Workshop
from tests.service import fake_sequence
from tests.service.helpers import ask, finish, wait_until


def expected_picture(frame: int, **request: Any) -> np.ndarray:
    asked = fake_sequence.parse_request({"demonstration": "fake", **request})
    tiles = range(len(fake_sequence.tile_grid(asked)))
    results = [fake_sequence.render_tile(asked, frame, tile) for tile in tiles]
    return to_srgb8(fake_sequence.assemble(asked, results).linear)[0]


def test_a_post_is_answered_with_202_and_where_to_look(client: TestClient) -> None:
    response = client.post("/v1/renders", json={"demonstration": "fake", "frames": 2})
    assert response.status_code == 202
    job = response.json()
    assert response.headers["location"] == f"/v1/renders/{job['id']}" == job["links"]["self"]
    assert response.headers["retry-after"] == "1"
    assert len(job["id"]) == 26
    assert job["request"] == fake_sequence.parse_request({"demonstration": "fake", "frames": 2}).canonical()
    assert job["status"] in ("accepted", "running", "successful")


def test_a_render_runs_to_its_end(client: TestClient) -> None:
    address = ask(client, frames=3, size=[40, 24])
    job = finish(client, address)
    assert job["status"] == "successful"
    assert job["progress"] == {"frames_done": 3, "frames": 3, "tiles_done": 18, "tiles": 18, "fraction": 1.0}
    assert job["problem"] is None
    assert job["created_at"] <= job["started_at"] <= job["ended_at"]
    assert [frame["index"] for frame in job["frames"]] == [0, 1, 2]
    assert [frame["angle_deg"] for frame in job["frames"]] == [0, 120, 240]
    assert [frame["error_estimate"] for frame in job["frames"]] == [0.1] * 3
    for frame in job["frames"]:
        png = client.get(frame["links"]["png"])
        assert png.headers["content-type"] == "image/png"
        assert hashlib.sha256(png.content).hexdigest() == frame["sha256"]
        picture = np.asarray(Image.open(io.BytesIO(png.content)))
        assert np.array_equal(picture, expected_picture(frame["index"], frames=3, size=[40, 24]))
        webp = client.get(frame["links"]["webp"])
        assert webp.headers["content-type"] == "image/webp"
        assert Image.open(io.BytesIO(webp.content)).size == (40, 24)
    animation = Image.open(io.BytesIO(client.get(job["links"]["sequence"]).content))
    assert animation.n_frames == 3
    manifest = client.get(job["links"]["manifest"]).json()
    assert manifest["complete"] is True
    assert [frame["sha256"] for frame in manifest["frames"]] == [frame["sha256"] for frame in job["frames"]]
    assert manifest["frames"][1]["file"] == "frame-0001.png"


def test_nothing_of_the_units_is_left_after_the_end(client: TestClient, settings: Settings) -> None:
    finish(client, ask(client))
    wait_until(lambda: not list((settings.data_dir / "units").iterdir()))
    assert not [path for path in settings.data_dir.rglob("*") if path.name.endswith(".part")]


def test_results_are_immutable_and_validated_by_strong_tags(client: TestClient) -> None:
    address = ask(client)
    job = finish(client, address)
    for link in (job["frames"][0]["links"]["webp"], job["links"]["sequence"], job["links"]["manifest"]):
        answer = client.get(link)
        assert answer.status_code == 200
        etag = answer.headers["etag"]
        assert etag == f'"{hashlib.sha256(answer.content).hexdigest()}"'
        assert answer.headers["cache-control"] == "public, max-age=31536000, immutable"
        for known in (etag, f'"other", {etag}', f"W/{etag}", "*"):
            again = client.get(link, headers={"If-None-Match": known})
            assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", etag)
        assert client.get(link, headers={"If-None-Match": '"other"'}).status_code == 200


def test_what_is_not_ready_says_that_it_is_coming(client: TestClient, tmp_path: Path) -> None:
    gate = tmp_path / "gate"
    address = ask(client, parameters={"gate": str(gate)})
    assert client.get(address).headers["retry-after"] == "1"
    assert client.get(address).headers["cache-control"] == "no-store"
    for path in ("/frames/0.webp", "/frames/2.png", "/sequence.webp"):
        answer = client.get(address + path)
        assert answer.status_code == 404
        assert answer.headers["retry-after"] == "1"
        assert answer.headers["cache-control"] == "no-store"
        assert answer.json()["type"] == "urn:isogyre:problem:not-yet"
        assert "still to come" in answer.json()["detail"]
    partial = client.get(f"{address}/manifest.json")
    assert partial.headers["cache-control"] == "no-store"
    assert partial.json()["complete"] is False
    assert partial.json()["frames"] == []
    gate.touch()
    finish(client, address)
    for path in ("/frames/3.webp", "/frames/359.png", "/frames/360.png", "/frames/-1.png", "/frames/x.png"):
        answer = client.get(address + path)
        assert answer.status_code == 404
        assert "retry-after" not in answer.headers


def test_equal_requests_share_their_work(client: TestClient, tmp_path: Path) -> None:
    gate, notes = tmp_path / "gate", tmp_path / "notes"
    how = {"gate": str(gate), "notes": str(notes)}
    first = ask(client, parameters=how)
    second = ask(client, parameters={**how, "delay_s": 0.0})  # the default, said aloud
    gate.touch()
    jobs = [finish(client, first), finish(client, second)]
    third = client.post("/v1/renders", json={"demonstration": "fake", "parameters": how}).json()
    assert third["status"] == "successful"
    assert len({job["id"] for job in [*jobs, third]}) == 3
    assert len({job["digest"] for job in [*jobs, third]}) == 1
    units = notes.read_text(encoding="utf-8").split("\n")[:-1]
    assert sorted(units) == sorted({f"{frame} {tile}" for frame in range(3) for tile in range(4)})


def test_the_run_stops_when_its_last_job_is_dismissed(
    client: TestClient, inline_workshop: Workshop, tmp_path: Path
) -> None:
    gate, notes = tmp_path / "gate", tmp_path / "notes"
    how = {"gate": str(gate), "notes": str(notes)}
    first, second = ask(client, parameters=how), ask(client, parameters=how)
    wait_until(notes.exists)
    assert client.delete(first).status_code == 204
    assert client.delete(first).status_code == 204
    assert client.get(first).json()["status"] == "dismissed"
    assert client.get(second).json()["status"] == "running"
    assert client.delete(second).status_code == 204
    assert client.get(second).json()["status"] == "dismissed"
    wait_until(lambda: not inline_workshop.runner._runs)
    gate.touch()
    marker = finish(client, ask(client, frames=1))  # the engine has come to what was asked for later
    assert marker["status"] == "successful"
    assert len(notes.read_text(encoding="utf-8").split("\n")[:-1]) == 1  # only the one that had begun
    again = finish(client, ask(client, parameters=how))
    assert again["status"] == "successful"
    assert again["digest"] == client.get(first).json()["digest"]


def test_a_run_goes_on_while_another_job_wants_it(client: TestClient, tmp_path: Path) -> None:
    gate = tmp_path / "gate"
    first, second = (ask(client, parameters={"gate": str(gate)}) for _ in range(2))
    client.delete(first)
    gate.touch()
    assert finish(client, second)["status"] == "successful"
    assert client.get(first).json()["status"] == "dismissed"
    assert client.get(f"{first}/frames/0.png").status_code == 200


def test_a_failing_unit_fails_its_job_alone_and_says_why(client: TestClient, tmp_path: Path) -> None:
    gate = tmp_path / "gate"
    failing = ask(client, parameters={"fail": [1, 2], "gate": str(gate)})
    other = ask(client, parameters={"gate": str(gate)})
    gate.touch()
    job = finish(client, failing)
    assert job["status"] == "failed"
    assert job["problem"]["type"] == "urn:isogyre:problem:rendering-failed"
    assert job["problem"]["detail"] == "frame 1, tile 2: RuntimeError: the lattice came apart"
    never = client.get(f"{failing}/frames/1.png")
    assert never.status_code == 404
    assert "retry-after" not in never.headers
    assert "the render is failed" in never.json()["detail"]
    assert finish(client, other)["status"] == "successful"
    anew = finish(client, ask(client, parameters={"fail": [1, 2], "gate": str(gate)}))
    assert anew["status"] == "failed"
    assert anew["digest"] == job["digest"]


def test_a_full_disk_fails_the_job_and_leaves_nothing_half(
    client: TestClient, settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: ArtifactStore, data: bytes) -> str:  # noqa: ARG001
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(ArtifactStore, "put", full)
        job = finish(client, ask(client))
    assert job["status"] == "failed"
    assert "No space left on device" in job["problem"]["detail"]
    assert not list((settings.data_dir / "artifacts").glob("*/*"))
    assert finish(client, ask(client))["status"] == "successful"


def test_a_small_render_does_not_wait_for_a_large_one(client: TestClient) -> None:
    large = ask(client, frames=200, parameters={"delay_s": 0.01})
    wait_until(lambda: client.get(large).json()["progress"]["tiles_done"] > 0)
    small = finish(client, ask(client, frames=1))
    assert small["status"] == "successful"
    assert client.get(large).json()["status"] == "running"
    client.delete(large)
