"""What several tests of the service do."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from fastapi.testclient import TestClient


def ask(client: TestClient, **request: Any) -> str:
    """Ask for a render of the stand-in; return its address."""
    response = client.post("/v1/renders", json={"demonstration": "fake", **request})
    assert response.status_code == 202, response.text
    return response.headers["location"]


def wait_until(condition: Callable[[], bool], seconds: float = 90) -> None:
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
