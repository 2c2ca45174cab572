from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from crystal_core import sequence
from service.app import create_app
from service.engine import InlineEngine
from service.settings import Settings
from service.workshop import Workshop
from tests.service import fake_sequence


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
