"""Settings from the environment."""

from __future__ import annotations

import io
import json
import logging
import os
from pathlib import Path

import pytest
import structlog

from crystal_core.errors import InputError
from service.log import set_up_logging
from service.settings import Settings, load_settings


@pytest.fixture(autouse=True)
def _bare(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in os.environ if name.startswith("ISOGYRE_")]:
        monkeypatch.delenv(name)


def test_data_go_where_the_users_data_go(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    assert load_settings().data_dir == tmp_path / "isogyre"
    monkeypatch.setenv("XDG_DATA_HOME", "relative/is/ignored")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert load_settings().data_dir == tmp_path / "home/.local/share/isogyre"
    monkeypatch.delenv("XDG_DATA_HOME")
    assert load_settings().data_dir == tmp_path / "home/.local/share/isogyre"


def test_the_environment_decides(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ISOGYRE_DATA_DIR", "here")
    monkeypatch.setenv("ISOGYRE_WORKERS", "3")
    settings = load_settings()
    assert settings.data_dir == tmp_path / "here"
    assert settings.workers == 3


def test_all_processors_by_default() -> None:
    assert load_settings().workers == len(os.sched_getaffinity(0))


def test_every_unusable_variable_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ISOGYRE_WORKERS", "0")
    monkeypatch.setenv("ISOGYRE_LOG_LEVEL", "loud")
    with pytest.raises(InputError) as caught:
        load_settings()
    assert {fault.pointer for fault in caught.value.faults} == {"ISOGYRE_WORKERS", "ISOGYRE_LOG_LEVEL"}


def test_log_lines_are_json_with_their_ids_and_libraries_speak_from_warnings_up(tmp_path: Path) -> None:
    root = logging.getLogger()
    handlers, level = root.handlers, root.level
    stream = io.StringIO()
    try:
        set_up_logging(Settings(data_dir=tmp_path, log_level="info"), stream)
        structlog.get_logger("isogyre.jobs").debug("not said")
        structlog.get_logger("isogyre.jobs").info("accepted", job="J", run="R")
        logging.getLogger("uvicorn.error").info("not said either")
        logging.getLogger("uvicorn.error").warning("said")
    finally:
        structlog.reset_defaults()
        root.handlers, root.level = handlers, level
    lines = [json.loads(line) for line in stream.getvalue().splitlines()]
    assert [line["event"] for line in lines] == ["accepted", "said"]
    assert (lines[0]["job"], lines[0]["run"], lines[0]["level"]) == ("J", "R", "info")
