"""The ledger by itself."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from service.ledger import Ledger
from service.records import FrameRow, Product

REQUEST = {"demonstration": "fake"}


@pytest.fixture
def ledger(tmp_path: Path) -> Iterator[Ledger]:
    ledger = Ledger(tmp_path / "ledger.sqlite")
    yield ledger
    ledger.close()


def test_it_is_kept_durably(ledger: Ledger) -> None:
    with ledger._engine.connect() as connection:
        assert connection.exec_driver_sql("PRAGMA journal_mode").scalar_one() == "wal"
        assert connection.exec_driver_sql("PRAGMA synchronous").scalar_one() == 2  # FULL
        assert connection.exec_driver_sql("PRAGMA foreign_keys").scalar_one() == 1


def test_fifty_equal_submissions_at_once_share_one_run(ledger: Ledger) -> None:
    with ThreadPoolExecutor(16) as threads:
        answers = list(threads.map(lambda _: ledger.submit(REQUEST, "d" * 64, frames=1, tiles=4), range(50)))
    assert sum(new for _, new in answers) == 1
    assert len({job.run.id for job, _ in answers}) == 1
    assert len({job.id for job, _ in answers}) == 50


def test_units_of_many_threads_are_all_counted(ledger: Ledger) -> None:
    job, _ = ledger.submit(REQUEST, "d" * 64, frames=1, tiles=40)
    with ThreadPoolExecutor(8) as threads:
        done = threads.map(
            lambda tile: ledger.finish_unit(job.run.id, 0, tile, sha256="a" * 64, seconds=0.1), range(40)
        )
        assert all(done)
    seen = ledger.job(job.id)
    assert seen is not None
    assert seen.run.tiles_done == 40
    assert {unit.tile for unit in ledger.units(job.run.id)} == set(range(40))


@pytest.mark.parametrize("end", ["dismissed", "failed", "successful"])
def test_an_ended_run_takes_nothing_more(ledger: Ledger, end: str) -> None:
    job, _ = ledger.submit(REQUEST, "d" * 64, frames=1, tiles=1)
    run = job.run.id
    assert ledger.start(run)
    if end == "dismissed":
        ended = ledger.dismiss(job.id)
        assert ended is not None
        assert ended.status == "dismissed"
    elif end == "failed":
        assert ledger.fail(run, {"detail": "why"}, (0, 0))
    else:
        assert ledger.succeed(run, ())
    product = Product("frame-0000.png", "a" * 64, "image/png", 1)
    assert not ledger.start(run)
    assert not ledger.finish_unit(run, 0, 0, sha256="a" * 64, seconds=0.1)
    assert not ledger.finish_frame(run, FrameRow(0, 0.0, 0.1, 0.1, "a" * 64, 0.0), [product])
    assert not ledger.succeed(run, [product])
    assert not ledger.fail(run, {"detail": "late"})
    assert ledger.product(run, product.name) is None
    assert ledger.live_runs() == []
    seen = ledger.job(job.id)
    assert seen is not None
    assert seen.status == end
    assert (seen.run.frames_done, seen.run.tiles_done) == (0, 0)
    assert [event.number for event in ledger.events(run, 0)] == [1, 2, 3]


@pytest.mark.parametrize("end", ["dismissed", "failed"])
def test_a_run_that_did_not_succeed_is_not_shared(ledger: Ledger, end: str) -> None:
    job, _ = ledger.submit(REQUEST, "d" * 64, frames=1, tiles=1)
    if end == "dismissed":
        ledger.dismiss(job.id)
    else:
        ledger.fail(job.run.id, {"detail": "why"})
    again, new = ledger.submit(REQUEST, "d" * 64, frames=1, tiles=1)
    assert new
    assert again.run.id != job.run.id


def test_equal_files_of_two_frames_are_one_artifact(ledger: Ledger) -> None:
    job, _ = ledger.submit(REQUEST, "d" * 64, frames=2, tiles=2)
    for index in range(2):
        product = Product(f"frame-{index:04d}.png", "a" * 64, "image/png", 7)
        assert ledger.finish_frame(job.run.id, FrameRow(index, 180.0 * index, 0.1, 0.1, "a" * 64, 0.0), [product])
    assert [frame.sha256 for frame in ledger.frames(job.run.id)] == ["a" * 64] * 2


def test_a_reader_does_not_wait_for_a_writer(ledger: Ledger, tmp_path: Path) -> None:
    job, _ = ledger.submit(REQUEST, "d" * 64, frames=1, tiles=1)
    other = sqlite3.connect(tmp_path / "ledger.sqlite", isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    seen = ledger.job(job.id)
    other.execute("ROLLBACK")
    other.close()
    assert seen == job
