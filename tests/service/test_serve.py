"""The service as a process of its own, with worker processes: how it starts, and how it ends."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx2
import psutil
import pytest

from service.serve import _listen
from tests.service.helpers import wait_until

ROOT = Path(__file__).parents[2]

# One client: each new one reads the system's certificates.
HTTP = httpx2.Client(timeout=10, trust_env=False, verify=False)


@pytest.fixture(scope="module", autouse=True)
def _close_http() -> Iterator[None]:
    with HTTP:
        yield


WATCH_CONNECTIONS = """
import os, sys

def watch(event, args):
    if event == "socket.connect" or event == "socket.getaddrinfo":
        address = args[1] if event == "socket.connect" else args[0]
        with open(os.environ["TEST_CONNECTIONS"], "a", encoding="utf-8") as file:
            file.write(f"{event} {address[0] if isinstance(address, tuple) else address}\\n")

sys.addaudithook(watch)
"""


class Service:
    """A running service."""

    def __init__(self, folder: Path, host: str = "127.0.0.1", port: int = 0, **environment: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.service.serve_fake", host, str(port)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={
                **os.environ,
                "ISOGYRE_DATA_DIR": str(folder / "data"),
                "ISOGYRE_WORKERS": "2",
                "PYTHONPATH": f"{folder}{os.pathsep}{ROOT}",
                "PYTHONWARNINGS": "error",
                **environment,
            },
        )
        assert self.process.stdout is not None
        self.line = self.process.stdout.readline()
        self.address = self.line.removeprefix("Isogyre: ").strip()
        self.family = psutil.Process(self.process.pid).children(recursive=True) if self.line else []

    def ask(self, **request: Any) -> str:
        answer = HTTP.post(f"{self.address}v1/renders", json={"demonstration": "fake", **request})
        assert answer.status_code == 202, answer.text
        return self.address.rstrip("/") + answer.headers["location"]

    def end(self, timeout: float = 90) -> tuple[int, str, str]:
        out, err = self.process.communicate(timeout=timeout)
        return self.process.returncode, out, err

    def assert_no_orphans(self) -> None:
        _, alive = psutil.wait_procs(self.family, timeout=15)
        assert alive == []


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Service]:
    with running(tmp_path) as service:
        yield service


@contextlib.contextmanager
def running(folder: Path, host: str = "127.0.0.1", port: int = 0, **environment: str) -> Iterator[Service]:
    service = Service(folder, host, port, **environment)
    try:
        yield service
    finally:
        if service.process.poll() is None:
            service.process.kill()
            service.process.communicate(timeout=10)
        for process in service.family:
            with contextlib.suppress(psutil.NoSuchProcess):
                process.wait(10)


def job(address: str) -> dict[str, Any]:
    answer: dict[str, Any] = HTTP.get(address).json()
    return answer


def test_it_serves_says_where_and_ends_cleanly_on_sigterm_with_an_open_stream(service: Service, tmp_path: Path) -> None:
    assert service.line.startswith("Isogyre: http://127.0.0.1:")
    assert service.line.endswith("/\n")
    assert HTTP.get(f"{service.address}readyz").status_code == 200
    assert HTTP.get(service.address).headers["content-type"].startswith("text/html")

    done = service.ask(frames=1)
    wait_until(lambda: job(done)["status"] == "successful")
    endless = service.ask(frames=2, parameters={"gate": str(tmp_path / "never")})
    told: list[str] = []

    def listen() -> None:
        with HTTP.stream("GET", f"{endless}/events", timeout=30) as answer:
            told.extend(answer.iter_lines())

    listener = threading.Thread(target=listen)
    listener.start()
    wait_until(lambda: any("running" in line for line in told))
    threading.Timer(
        1.0, (tmp_path / "never").touch
    ).start()  # a running unit is waited for; real ones take half a second
    service.process.send_signal(signal.SIGTERM)
    code, out, err = service.end()
    listener.join(30)
    assert not listener.is_alive()
    assert code == 0
    assert out == ""
    service.assert_no_orphans()
    for line in err.splitlines():
        assert json.loads(line)["level"] == "info", err


def test_ctrl_c_ends_it_with_130(service: Service) -> None:
    service.process.send_signal(signal.SIGINT)
    code, out, err = service.end()
    assert (code, out) == (130, "")
    assert "Traceback" not in err
    service.assert_no_orphans()


@pytest.mark.parametrize(("number", "expected"), [(signal.SIGINT, 130), (signal.SIGTERM, 0)])
def test_signals_while_it_starts_end_it_too(tmp_path: Path, number: int, expected: int) -> None:
    environment = {**os.environ, "ISOGYRE_DATA_DIR": str(tmp_path / "data"), "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.service.serve_fake", "127.0.0.1", "0"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    )
    wait_until((tmp_path / "data" / "lock").exists)
    process.send_signal(number)
    out, err = process.communicate(timeout=90)
    assert process.returncode == expected
    assert (out, "Traceback" in err) == ("", False)
    assert not [
        p
        for p in psutil.process_iter(["environ"])
        if (p.info["environ"] or {}).get("ISOGYRE_DATA_DIR") == str(tmp_path / "data")
    ]


def test_a_taken_port_is_one_clear_line_and_code_1(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with running(tmp_path, port=port) as service:
            code, out, err = service.end()
    assert (code, out) == (1, "")
    assert err == f"isogyre: cannot listen at 127.0.0.1 port {port}: Address already in use\n"


def test_answers_do_not_wait_for_acknowledgements() -> None:
    with _listen("127.0.0.1", 0) as listener, socket.create_connection(listener.getsockname()):
        connection, _ = listener.accept()
        with connection:
            assert connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY) != 0


def test_other_hosts_get_one_line_of_warning(tmp_path: Path) -> None:
    with running(tmp_path, host="0.0.0.0") as service:
        assert service.line.startswith("Isogyre: http://localhost:")
        service.process.send_signal(signal.SIGTERM)
        code, _, err = service.end()
    assert code == 0
    warnings = [line for line in err.splitlines() if "warning" in line]
    assert warnings == ["isogyre: warning: anybody who reaches 0.0.0.0 can use this service; there are no API keys yet"]


def test_a_killed_service_loses_no_job_and_leaves_no_worker(tmp_path: Path) -> None:
    notes = tmp_path / "notes"
    request = {"frames": 5, "parameters": {"notes": str(notes), "delay_s": 0.1}}
    with running(tmp_path) as service:
        path = service.ask(**request).removeprefix(service.address)
        wait_until(lambda: job(service.address + path)["progress"]["frames_done"] >= 2)
        service.process.kill()
        service.end()
        service.assert_no_orphans()
    before = len(notes.read_text(encoding="utf-8").splitlines())
    with running(tmp_path) as service:
        wait_until(lambda: job(service.address + path)["status"] == "successful")
        seen = job(service.address + path)
        assert seen["progress"]["frames_done"] == 5
        for frame in seen["frames"]:
            assert HTTP.get(service.address.rstrip("/") + frame["links"]["png"]).status_code == 200
    again = len(notes.read_text(encoding="utf-8").splitlines()) - before
    assert again <= 20 - 8  # the two finished frames were kept


def test_a_killed_worker_costs_only_its_unit(service: Service) -> None:
    address = service.ask(frames=5, parameters={"delay_s": 0.1})
    wait_until(lambda: job(address)["progress"]["tiles_done"] >= 2)
    worker = next(p for p in service.family if "spawn_main" in " ".join(p.cmdline()))
    worker.kill()
    wait_until(lambda: job(address)["status"] == "successful")
    poison = service.ask(frames=2, parameters={"die": [1, 0]})
    wait_until(lambda: job(poison)["status"] == "failed")
    assert "frame 1, tile 0: UnitLostError" in job(poison)["problem"]["detail"]
    after = service.ask(frames=1, seed=1)
    wait_until(lambda: job(after)["status"] == "successful")


def test_no_connection_leaves_the_machine(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(WATCH_CONNECTIONS, encoding="utf-8")
    seen = tmp_path / "connections"
    with running(tmp_path, TEST_CONNECTIONS=str(seen)) as service:
        address = service.ask(frames=2)
        wait_until(lambda: job(address)["status"] == "successful")
        service.process.send_signal(signal.SIGTERM)
        assert service.end()[0] == 0
    connections = set(seen.read_text(encoding="utf-8").splitlines())
    assert "socket.connect 127.0.0.1" in connections  # the workers to their scheduler: the watch works
    assert {line.split()[1] for line in connections} <= {"127.0.0.1", "localhost", "None"}
