"""What an accepted job survives: the service closes (or dies) in the middle and is opened again on the same data."""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np
import pytest
from fastapi.testclient import TestClient

from crystal_core import sequence
from crystal_core.errors import InputError
from crystal_core.output.images import decode_png
from service import press
from service.app import create_app
from service.engine import InlineEngine
from service.ledger import Ledger
from service.settings import Settings
from service.workshop import Workshop
from tests.service import fake_sequence
from tests.service.helpers import ask, finish, wait_until


@contextmanager
def opened(settings: Settings) -> Iterator[TestClient]:
    with TestClient(create_app(settings, workshop=Workshop(settings, InlineEngine))) as client:
        yield client


def units(notes: Path) -> list[str]:
    return notes.read_text(encoding="utf-8").split("\n")[:-1] if notes.exists() else []


def leave_half_done(settings: Settings, tmp_path: Path) -> tuple[str, Path]:
    """Render at least one frame and a few tiles of 15 frames of four tiles, then close."""
    notes = tmp_path / "notes"
    with opened(settings) as client:
        address = ask(client, frames=15, parameters={"notes": str(notes), "delay_s": 0.03})
        wait_until(lambda: client.get(address).json()["progress"]["frames_done"] >= 1)
        wait_until(lambda: client.get(address).json()["progress"]["tiles_done"] >= 7)
    return address, notes


@pytest.mark.usefixtures("fake")
def test_finished_units_and_frames_are_kept(settings: Settings, tmp_path: Path) -> None:
    address, notes = leave_half_done(settings, tmp_path)
    before = units(notes)
    with closing(Ledger(settings.data_dir / "ledger.sqlite")) as ledger:
        left = ledger.job(address.rpartition("/")[2])
    assert left is not None
    assert left.status == "running"
    done = left.run.tiles_done
    assert 7 <= done < 60
    with opened(settings) as client:
        job = finish(client, address)
        assert job["status"] == "successful"
        assert job["progress"]["tiles_done"] == 60
        manifest = client.get(f"{address}/manifest.json").json()
    again = units(notes)[len(before) :]
    # Only what had not been noted when the service closed: the unit that was running then is done twice.
    assert len(again) == 60 - done
    assert set(before) | set(again) == {f"{frame} {tile}" for frame in range(15) for tile in range(4)}

    whole = tmp_path / "whole"
    with opened(Settings(data_dir=whole, workers=1)) as client:
        undisturbed = ask(client, frames=15, parameters={"notes": str(notes), "delay_s": 0.03})
        finish(client, undisturbed)
        reference = client.get(f"{undisturbed}/manifest.json").json()
    assert [frame["sha256"] for frame in manifest["frames"]] == [frame["sha256"] for frame in reference["frames"]]


@pytest.mark.usefixtures("fake")
def test_a_damaged_and_a_missing_result_are_made_again(settings: Settings, tmp_path: Path) -> None:
    notes = tmp_path / "notes"
    with opened(settings) as client:
        address = ask(client, size=[128, 128], frames=1, parameters={"notes": str(notes), "delay_s": 0.02})
        wait_until(lambda: client.get(address).json()["progress"]["tiles_done"] >= 4)
    kept = sorted((settings.data_dir / "units").glob("*/*"))
    assert len(kept) >= 4
    kept[0].write_bytes(b"half a")
    kept[1].unlink()
    with opened(settings) as client:
        assert finish(client, address)["status"] == "successful"
        assert client.get(address).json()["progress"]["tiles_done"] == 64
    assert sorted(set(units(notes))) == sorted(f"0 {tile}" for tile in range(64))
    assert {unit for unit in units(notes) if units(notes).count(unit) > 1} >= {"0 0", "0 1"}


@pytest.mark.usefixtures("fake")
def test_another_version_of_the_code_begins_anew(
    settings: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    address, notes = leave_half_done(settings, tmp_path)
    before = len(units(notes))
    with monkeypatch.context() as patch:
        patch.setitem(fake_sequence.VERSION, "code", "2")
        with opened(settings) as client:
            job = finish(client, address)
        assert job["digest"] == fake_sequence.parse_request(job["request"]).digest()
    assert job["status"] == "successful"
    assert len(units(notes)) == before + 60  # nothing of the old code's work was used


@pytest.mark.usefixtures("fake")
def test_a_request_that_this_version_refuses_fails_with_the_reason(
    settings: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    address, _ = leave_half_done(settings, tmp_path)

    def refuse(_: object) -> None:
        raise InputError.at("/parameters/delay_s", "is gone")

    with monkeypatch.context() as patch:
        patch.setattr(sequence, "read_request", refuse)
        with opened(settings) as client:
            job = finish(client, address)
    assert job["status"] == "failed"
    assert "is gone" in job["problem"]["detail"]
    assert job["problem"]["errors"] == [{"pointer": "/parameters/delay_s", "detail": "is gone"}]


@pytest.mark.usefixtures("fake")
def test_ended_jobs_stay_as_they_are(settings: Settings, tmp_path: Path) -> None:
    gate = tmp_path / "gate"
    with opened(settings) as client:
        dismissed = ask(client, parameters={"gate": str(gate)})
        client.delete(dismissed)
        gate.touch()
        done = ask(client, frames=1)
        finish(client, done)
        picture = client.get(f"{done}/frames/0.png").content
    with opened(settings) as client:
        assert client.get(dismissed).json()["status"] == "dismissed"
        assert client.get(done).json()["status"] == "successful"
        assert client.get(f"{done}/frames/0.png").content == picture


@pytest.mark.usefixtures("fake")
def test_a_film_that_is_being_made_does_not_hold_up_the_end(
    settings: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reached = tmp_path / "reached"

    def slowly(data: bytes) -> np.ndarray:
        reached.touch()
        time.sleep(0.1)
        return decode_png(data)

    with monkeypatch.context() as patch:
        patch.setattr(press, "decode_png", slowly)
        with opened(settings) as client:
            address = ask(client, frames=200, size=[16, 16])  # the film would take 20 seconds
            wait_until(reached.exists)
            started = time.monotonic()
        assert time.monotonic() - started < 10
    with opened(settings) as client:
        assert finish(client, address)["status"] == "successful"
        assert client.get(f"{address}/sequence.webp").status_code == 200


@pytest.mark.usefixtures("fake")
def test_leftovers_of_a_dead_process_are_swept(settings: Settings) -> None:
    stray = settings.data_dir / "units" / "01ARZ3NDEKTSV4RRFFQ69G5FAV" / "0000-00000"
    half = settings.data_dir / "artifacts" / "ab" / ".abcdef.123.part"
    for path in (stray, half):
        path.parent.mkdir(parents=True)
        path.write_bytes(b"x")
    with opened(settings):
        assert not stray.parent.exists()
        assert not half.exists()


@pytest.mark.usefixtures("fake")
def test_two_services_cannot_share_a_data_directory(settings: Settings) -> None:
    with Workshop(settings, InlineEngine), pytest.raises(InputError, match="in use by another running service"):
        Workshop(settings, InlineEngine).open()
    Workshop(settings, InlineEngine).__enter__().close()  # and the lock is free again


@pytest.mark.usefixtures("fake")
def test_an_unusable_data_directory_is_one_clear_error(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("no folder")
    with pytest.raises(InputError, match="cannot be used: Not a directory"):
        Workshop(Settings(data_dir=file / "data"), InlineEngine).open()


@pytest.mark.usefixtures("fake")
@pytest.mark.parametrize("spoil", ["garbage", "version"])
def test_a_ledger_that_is_none_of_ours_is_refused(settings: Settings, spoil: str) -> None:
    settings.data_dir.mkdir()
    path = settings.data_dir / "ledger.sqlite"
    if spoil == "garbage":
        path.write_bytes(b"this is no database, " * 100)
    else:
        with closing(sqlite3.connect(path)) as connection:
            connection.execute("PRAGMA user_version = 99")
    with pytest.raises(InputError, match="ledger" if spoil == "garbage" else "version 99"):
        Workshop(settings, InlineEngine).open()
    if spoil == "garbage":
        assert path.read_bytes() == b"this is no database, " * 100
    else:
        with closing(sqlite3.connect(path)) as connection:
            assert connection.execute("PRAGMA user_version").fetchone() == (99,)
            assert connection.execute("SELECT * FROM sqlite_master").fetchall() == []
