"""The commands of docs/probes.md, run as they stand there, and what they print."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
import uvicorn

from service.app import create_app
from service.settings import Settings
from tests.docs.blocks import FENCE, ROOT
from tests.service.helpers import wait_until

PAGE = ROOT / "docs" / "probes.md"
SERVED_AT = "http://127.0.0.1:8000"
NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Serve on a free port; nothing is rendered, so that the workshop stays closed."""
    settings = Settings(data_dir=tmp_path_factory.mktemp("data"), workers=1, log_level="error")
    server = uvicorn.Server(uvicorn.Config(create_app(settings), port=0, lifespan="off", log_config=None))
    thread = threading.Thread(target=server.run)
    thread.start()
    try:
        wait_until(lambda: server.started or not thread.is_alive())
        assert server.started
        (port,) = (sock.getsockname()[1] for listener in server.servers for sock in listener.sockets)
        yield f"http://127.0.0.1:{port}"
    finally:
        server.should_exit = True
        thread.join()


def commands() -> list[tuple[str, str]]:
    """Return each block of commands with the block of text after it."""
    blocks = FENCE.findall(PAGE.read_text(encoding="utf-8"))
    return [(body, blocks[number + 1][1]) for number, (language, body) in enumerate(blocks) if language == "sh"]


def run(command: str, folder: Path, address: str) -> str:
    """Run commands; return what they print, on stdout and stderr alike."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", command.replace(SERVED_AT, address)],
        cwd=folder,
        env={**os.environ, "PATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
        check=False,
    )
    return done.stdout


def test_every_command_prints_what_the_page_says(tmp_path: Path, address: str) -> None:
    blocks = commands()
    assert len(blocks) == 9
    for command, expected in blocks:
        printed = run(command, tmp_path, address)
        assert NUMBER.sub("#", printed) == NUMBER.sub("#", expected)
        numbers, of_page = ([float(text) for text in NUMBER.findall(found)] for found in (printed, expected))
        assert numbers == pytest.approx(of_page, abs=2e-6)
