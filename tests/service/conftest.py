from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import fake_sequence
import pytest
from fastapi.testclient import TestClient

from crystal_core import sequence
from service.app import create_app
from service.engine import InlineEngine
from service.settings import Settings
from service.workshop import Workshop


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put the stand-in in the place of the renderer."""
    for name in fake_sequence.NAMES:
        monkeypatch.setattr(sequence, name, getattr(fake_sequence, name), raising=False)


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(data_dir=tmp_path / "data", workers=1, log_level="error")


@pytest.fixture
def inline_workshop(settings: Settings) -> Workshop:
    return Workshop(settings, InlineEngine)


@pytest.fixture
def client(fake: None, settings: Settings, inline_workshop: Workshop) -> Iterator[TestClient]:  # noqa: ARG001
    with TestClient(create_app(settings, workshop=inline_workshop)) as client:
        yield client


def ask(client: TestClient, **request: Any) -> str:
    """Ask for a render of the stand-in; return its address."""
    response = client.post("/v1/renders", json={"demonstration": "fake", **request})
    assert response.status_code == 202, response.text
    return response.headers["location"]


def wait_until(condition: Callable[[], bool], seconds: float = 20) -> None:
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "it did not come to pass in time"
        time.sleep(0.01)


def finish(client: TestClient, address: str) -> dict[str, Any]:
    """Wait for the end of a render; return it."""
    job: dict[str, Any] = {}

    def ended() -> bool:
        job.update(client.get(address).json())
        return job["status"] not in ("accepted", "running")

    wait_until(ended)
    return job
