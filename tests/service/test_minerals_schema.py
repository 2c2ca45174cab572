"""The schema of entries, on the command line and over HTTP."""

from __future__ import annotations

import json

import pytest
from fastapi.testclient import TestClient

import minerals_db
from service.cli import run


def test_it_is_the_schema_that_entries_are_checked_by(capsys: pytest.CaptureFixture[str], client: TestClient) -> None:
    capsys.readouterr()  # what the service said when it opened
    assert run(["minerals", "schema"]) == 0
    printed = json.loads(capsys.readouterr().out)
    answer = client.get("/v1/schemas/mineral")
    assert answer.headers["content-type"] == "application/schema+json"
    assert printed == answer.json() == minerals_db.entry_schema()
    assert client.get("/v1/schemas/mineral", headers={"If-None-Match": answer.headers["etag"]}).status_code == 304
