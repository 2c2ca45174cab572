"""The installed command as a process of its own: exit codes, streams, signals, worker processes, a terminal."""

from __future__ import annotations

import contextlib
import os
import pty
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from crystal_core import __version__
from tests.service.batch_tools import contents, read_manifest, snapshot
from tests.service.helpers import wait_until

ISOGYRE = Path(sys.executable).with_name("isogyre")

LONG = ("render", "rotating-calcite", "--frames", "20", "--size", "64x48", "--quality", "draft")
SHORT = ("render", "rotating-calcite", "--frames", "3", "--size", "160x130", "--quality", "draft", "--seed", "5")

PATIENCE_S = 120


@contextlib.contextmanager
def started(*arguments: object) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [ISOGYRE, *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONWARNINGS": "error"},
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def isogyre(*arguments: object) -> tuple[int, str, str]:
    with started(*arguments) as process:
        out, err = process.communicate(timeout=PATIENCE_S)
        return process.returncode, out, err


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The long sequence, rendered in one go."""
    path = tmp_path_factory.mktemp("whole") / "out"
    assert isogyre(*LONG, "--workers", 1, "--out", path) == (0, "", "")
    return path


def finished_frames(folder: Path) -> int:
    try:
        return len(read_manifest(folder)["frames"])
    except FileNotFoundError:
        return 0


def is_sound(folder: Path) -> None:
    """The manifest names exactly the frames that are there, and says that there are more to come."""
    manifest = read_manifest(folder)
    assert manifest["complete"] is False
    assert sorted(snapshot(folder)) == [*(frame["file"] for frame in manifest["frames"]), "manifest.json"]
    assert 1 <= len(manifest["frames"]) < 20


def test_exit_codes_and_streams(tmp_path: Path) -> None:
    assert isogyre("--version") == (0, f"isogyre {__version__}\n", "")
    code, out, err = isogyre("render", "rotating-topaz", "--out", tmp_path / "out")
    assert (code, out, err.count("\n")) == (2, "", 1)
    code, out, err = isogyre(*SHORT, "--size", "abc", "--out", tmp_path / "out")
    assert (code, out, err.count("\n")) == (2, "", 1)
    code, out, err = isogyre("render")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert not list(tmp_path.iterdir())


def test_one_and_two_workers_make_the_same_files(tmp_path: Path) -> None:
    assert isogyre(*SHORT, "--workers", 1, "--out", tmp_path / "one") == (0, "", "")
    assert isogyre(*SHORT, "--workers", 2, "--out", tmp_path / "two") == (0, "", "")
    assert contents(tmp_path / "one") == contents(tmp_path / "two")
    assert sorted(contents(tmp_path / "two")) == [*(f"frame-{index:04d}.png" for index in range(3)), "sequence.webp"]
    one, two = read_manifest(tmp_path / "one"), read_manifest(tmp_path / "two")
    for manifest in (one, two):
        assert manifest["complete"]
        assert manifest["reproducible"]
        for frame in manifest["frames"]:
            assert frame.pop("seconds") > 0
    assert one == two


def test_one_worker_is_this_process(tmp_path: Path) -> None:
    with started(*LONG, "--workers", 1, "--out", tmp_path / "out") as process:
        wait_until(lambda: finished_frames(tmp_path / "out") >= 1, PATIENCE_S)
        assert psutil.Process(process.pid).children() == []


@pytest.mark.parametrize(
    ("number", "workers", "code"),
    [(signal.SIGINT, 1, 130), (signal.SIGINT, 2, 130), (signal.SIGTERM, 2, 143), (signal.SIGHUP, 1, 129)],
)
def test_an_interrupted_run_goes_on_to_the_same_files(
    tmp_path: Path, whole: Path, number: signal.Signals, workers: int, code: int
) -> None:
    out = tmp_path / "out"
    with started(*LONG, "--workers", workers, "--out", out) as process:
        wait_until(lambda: finished_frames(out) >= 2, PATIENCE_S)
        family = psutil.Process(process.pid).children(recursive=True)
        process.send_signal(number)
        stdout, stderr = process.communicate(timeout=PATIENCE_S)
        assert (process.returncode, stdout) == (code, "")
        assert stderr == f"isogyre: interrupted; what is finished is in {out}, and the same command goes on\n"
    assert len(family) >= workers - 1
    wait_until(lambda: not any(member.is_running() for member in family))
    is_sound(out)
    kept = {name: entry for name, entry in snapshot(out).items() if name != "manifest.json"}
    # Another one is refused as long as it is unfinished, too.
    before = snapshot(out)
    assert isogyre(*LONG, "--seed", 1, "--out", out)[0] == 2
    assert snapshot(out) == before
    assert isogyre(*LONG, "--workers", 1, "--out", out) == (0, "", "")
    after = snapshot(out)
    assert {name: after[name] for name in kept} == kept
    assert contents(out) == contents(whole)
    assert read_manifest(out)["complete"]


def test_ctrl_c_of_a_terminal_reaches_the_whole_group(tmp_path: Path) -> None:
    out = tmp_path / "out"
    process = subprocess.Popen(
        [ISOGYRE, *LONG, "--workers", "2", "--out", out],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        wait_until(lambda: finished_frames(out) >= 1, PATIENCE_S)
        os.killpg(process.pid, signal.SIGINT)
        stdout, stderr = process.communicate(timeout=PATIENCE_S)
    finally:
        process.kill()
        process.communicate()
    assert (process.returncode, stdout, stderr.count("\n")) == (130, "", 1)
    is_sound(out)


def test_a_killed_run_goes_on_to_the_same_files(tmp_path: Path, whole: Path) -> None:
    out = tmp_path / "out"
    with started(*LONG, "--workers", 1, "--out", out) as process:
        wait_until(lambda: finished_frames(out) >= 2, PATIENCE_S)
        process.kill()
        process.communicate(timeout=PATIENCE_S)
    assert isogyre(*LONG, "--workers", 1, "--out", out) == (0, "", "")
    assert contents(out) == contents(whole)


def test_a_second_run_into_the_same_folder_is_refused(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with started(*LONG, "--workers", 1, "--out", out) as process:
        wait_until(lambda: finished_frames(out) >= 1, PATIENCE_S)
        code, stdout, stderr = isogyre(*LONG, "--workers", 1, "--out", out)
        assert (code, stdout) == (2, "")
        assert stderr == f"isogyre: --out: {out} is being filled by another isogyre\n"
        assert process.poll() is None


def read_terminal(descriptor: int) -> str:
    """Read what a terminal is shown until the last program has left it."""
    shown = b""
    with contextlib.suppress(OSError):  # Linux says EIO at the end
        while block := os.read(descriptor, 65536):
            shown += block
    return shown.decode()


def test_a_terminal_is_shown_how_long_it_will_take(tmp_path: Path) -> None:
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        [ISOGYRE, *SHORT, "--workers", "1", "--out", tmp_path / "out"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=theirs,
        env={**os.environ, "TERM": "xterm", "COLUMNS": "100"},
    ) as process:
        os.close(theirs)
        shown = read_terminal(ours)
        os.close(ours)
        assert process.stdout is not None
        assert process.stdout.read() == b""
    assert process.returncode == 0
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", shown)
    assert "0/3 frames" in text
    assert "3/3 frames" in text
    assert re.search(r"left \d:\d\d:\d\d", text)


def test_serve_answers_and_ends(tmp_path: Path) -> None:
    environment = {
        **os.environ,
        "ISOGYRE_DATA_DIR": str(tmp_path),
        "ISOGYRE_WORKERS": "1",
        "ISOGYRE_LOG_LEVEL": "error",
    }
    with subprocess.Popen(
        [ISOGYRE, "serve", "--port", "0"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment
    ) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline().startswith("Isogyre: http://127.0.0.1:")
            process.send_signal(signal.SIGINT)
            started_at = time.monotonic()
            _, err = process.communicate(timeout=PATIENCE_S)
        finally:
            process.kill()
    assert (process.returncode, err) == (130, "")
    assert time.monotonic() - started_at < 60
