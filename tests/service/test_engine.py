"""One contract, two engines."""

from __future__ import annotations

import concurrent.futures
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest

from crystal_core.errors import InputError
from service.engine import DaskEngine, Engine, EngineClosedError, InlineEngine, UnitLostError, open_engine
from tests.service import engine_units

MAKERS: dict[str, Callable[[], Engine]] = {"inline": InlineEngine, "dask": lambda: DaskEngine(1)}


@pytest.fixture(scope="module", params=MAKERS)
def engine(request: pytest.FixtureRequest) -> Iterator[Engine]:
    with MAKERS[request.param]() as engine:
        yield engine


def test_a_result_comes_back(engine: Engine) -> None:
    assert engine.submit(engine_units.add, 2, 3, key="sum").result(90) == 5


def test_one_key_twice_is_two_units(engine: Engine) -> None:
    first = engine.submit(engine_units.add, 2, 3, key="sum")
    assert first.result(90) == 5
    assert engine.submit(engine_units.add, 2, 4, key="sum").result(90) == 6


def test_an_exception_comes_back_and_the_engine_lives_on(engine: Engine) -> None:
    with pytest.raises(ValueError, match="no such crystal"):
        engine.submit(engine_units.fail, "no such crystal", key="bad").result(90)
    assert engine.submit(engine_units.add, 1, 1, key="after").result(90) == 2


def test_submit_returns_at_once_and_from_any_thread(engine: Engine, tmp_path: Path) -> None:
    gate = tmp_path / "gate"
    futures: list[concurrent.futures.Future[str]] = []
    started = time.monotonic()

    def submit() -> None:
        futures.append(engine.submit(engine_units.wait_for, gate, "open", key="gate"))

    threads = [threading.Thread(target=submit) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert time.monotonic() - started < 2
    assert not any(future.done() for future in futures)
    gate.touch()
    assert [future.result(90) for future in futures] == ["open"] * 4


def test_a_cancelled_unit_never_runs(engine: Engine, tmp_path: Path) -> None:
    gate, notes = tmp_path / "gate", tmp_path / "notes"
    blocker = engine.submit(engine_units.wait_for, gate, "open", key="blocker")
    doomed = engine.submit(engine_units.note, notes, "doomed", key="doomed")
    spared = engine.submit(engine_units.note, notes, "spared", key="spared")
    assert doomed.cancel()
    assert doomed.cancelled()
    time.sleep(0.3)  # the word of it must reach the worker before the unit's turn comes
    gate.touch()
    assert blocker.result(90) == "open"
    assert spared.result(90) == "spared"
    assert engine.submit(engine_units.note, notes, "last", key="last").result(90) == "last"
    assert notes.read_text(encoding="utf-8").split() == ["spared", "last"]


def test_higher_priority_goes_first_and_equal_ones_in_order(engine: Engine, tmp_path: Path) -> None:
    gate, notes = tmp_path / "gate", tmp_path / "notes"
    engine.submit(engine_units.wait_for, gate, "open", key="blocker", priority=100)
    futures = [
        engine.submit(engine_units.note, notes, word, key=word, priority=priority)
        for word, priority in [("low-1", 0), ("low-2", 0), ("high", 5), ("low-3", 0)]
    ]
    time.sleep(0.2)  # let all of them reach the worker's queue before the gate opens
    gate.touch()
    concurrent.futures.wait(futures, timeout=90)
    order = notes.read_text(encoding="utf-8").split()
    assert order.index("high") <= 1  # one unit may have been handed to the worker before
    order.remove("high")
    assert order == ["low-1", "low-2", "low-3"]


def test_workers_is_one(engine: Engine) -> None:
    assert engine.workers == 1


@pytest.mark.parametrize("kind", MAKERS)
def test_close_cancels_what_waits_and_refuses_more(kind: str, tmp_path: Path) -> None:
    gate, notes = tmp_path / "gate", tmp_path / "notes"
    engine = MAKERS[kind]()
    running = engine.submit(engine_units.wait_for, gate, "open", key="running")
    waiting = engine.submit(engine_units.note, notes, "never", key="waiting")
    time.sleep(0.3)
    threading.Timer(0.3, gate.touch).start()
    engine.close()
    engine.close()  # closing twice is closing once
    assert waiting.cancelled()
    assert running.done()
    assert not notes.exists()
    with pytest.raises(EngineClosedError):
        engine.submit(engine_units.add, 1, 1, key="late")


def test_open_engine_chooses_by_the_number_of_workers() -> None:
    with open_engine(1) as engine:
        assert isinstance(engine, InlineEngine)
    with open_engine(2) as engine:
        assert isinstance(engine, DaskEngine)
        assert engine.workers == 2
        pids = {engine.submit(engine_units.surroundings, key="who").result(90)["pid"] for _ in range(2)}
        assert os.getpid() not in pids
    with pytest.raises(InputError, match="at least 1"):
        open_engine(0)


def test_dask_workers_are_nice_single_threaded_and_deaf_to_ctrl_c() -> None:
    with DaskEngine(1, niceness=3) as engine:
        seen = engine.submit(engine_units.surroundings, key="who").result(90)
        assert isinstance(seen["pid"], int)
        assert seen["nice"] == os.nice(0) + 3
        assert seen["threads"] == seen["omp"] == "1"
        assert seen["interrupt_blocked"]
        assert os.getpgid(seen["pid"]) != os.getpgid(0)
        os.kill(seen["pid"], signal.SIGINT)
        assert engine.submit(engine_units.surroundings, key="who").result(90)["pid"] == seen["pid"]


def test_dask_listens_on_loopback_only_and_leaves_no_process() -> None:
    me = psutil.Process()
    before = set(me.children(recursive=True))
    ports_before = {c.laddr for c in me.net_connections("inet") if c.status == psutil.CONN_LISTEN}
    with DaskEngine(2) as engine:
        engine.submit(engine_units.add, 1, 1, key="warm").result(90)
        family = [me, *me.children(recursive=True)]
        listening = {
            c.laddr for process in family for c in process.net_connections("inet") if c.status == psutil.CONN_LISTEN
        } - ports_before
        assert listening
        assert {address.ip for address in listening} == {"127.0.0.1"}
    left = {p for p in set(me.children(recursive=True)) - before if "resource_tracker" not in " ".join(p.cmdline())}
    assert left == set()


def test_a_unit_that_kills_its_processes_fails_alone() -> None:
    with DaskEngine(1) as engine:
        with pytest.raises(UnitLostError, match="poison"):
            engine.submit(engine_units.die, key="poison").result(90)
        assert engine.submit(engine_units.add, 2, 2, key="after").result(90) == 4


def test_units_beside_one_that_kills_are_not_blamed(tmp_path: Path) -> None:
    with DaskEngine(1) as engine:  # one worker: what waits there is there at every death
        gate = tmp_path / "gate"
        engine.submit(engine_units.wait_for, gate, "open", key="gate")
        poison = engine.submit(engine_units.die, key="poison")
        beside = [engine.submit(engine_units.add, 1, n, key=f"beside-{n}") for n in range(4)]
        gate.touch()
        assert isinstance(poison.exception(90), UnitLostError)
        assert [future.result(90) for future in beside] == [1, 2, 3, 4]


def test_dask_leaves_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with DaskEngine(1):
        assert [path.name.split("-")[0] for path in tmp_path.iterdir()] == ["isogyre"]
    assert list(tmp_path.iterdir()) == []


def test_dask_leaves_nothing_on_stderr() -> None:
    code = (
        "from tests.service import engine_units\n"
        "from service.engine import DaskEngine\n"
        "if __name__ == '__main__':\n"
        "    with DaskEngine(2) as engine:\n"
        "        print(engine.submit(engine_units.add, 40, 2, key='sum').result(90))\n"
        "        engine.submit(engine_units.fail, 'x', key='bad').exception(90)\n"
    )
    script = subprocess.run(
        [sys.executable, "-W", "error", "-X", "dev", "-c", code],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
    )
    assert (script.stdout, script.stderr, script.returncode) == ("42\n", "", 0)
