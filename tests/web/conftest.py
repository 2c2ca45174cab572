"""The real service in a process of its own, and real Chromium before it."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect, sync_playwright

from tests.web.visitor import Visitor

CHROMIUM_ARGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
STOP_S = 60


@pytest.fixture(scope="session")
def chromium_path() -> str:
    """Give the path of a Chromium; without one the tests are skipped, or fail where a browser is required."""
    path = os.environ.get("ISOGYRE_CHROMIUM") or shutil.which("chromium")
    if path is None:
        if os.environ.get("ISOGYRE_REQUIRE_BROWSER"):
            pytest.fail("ISOGYRE_REQUIRE_BROWSER is set, and there is no chromium")
        pytest.skip("there is no chromium (ISOGYRE_CHROMIUM names another browser's path)")
    return path


@pytest.fixture(scope="session")
def service(chromium_path: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:  # noqa: ARG001
    """Give the address of a service that renders, with a data directory of its own."""
    environment = {**os.environ, "ISOGYRE_DATA_DIR": str(tmp_path_factory.mktemp("data"))}
    log = tmp_path_factory.mktemp("log") / "service.log"
    command = [str(Path(sys.executable).with_name("isogyre")), "serve", "--host", "127.0.0.1", "--port", "0"]
    with (
        log.open("wb") as errors,
        subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=errors, text=True) as process,
    ):
        try:
            assert process.stdout is not None
            # The service prints its address once it accepts renders, and ends its output if it cannot.
            address = process.stdout.readline().removeprefix("Isogyre: ").strip()
            assert address.startswith("http://127.0.0.1:"), log.read_text()[-4000:]
            yield address
        finally:
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(STOP_S)
            except subprocess.TimeoutExpired:
                process.kill()


# For one module at a time: Playwright's loop counts as running for as long as it is open, and would be in the way of
# any asyncio in tests of other folders.
@pytest.fixture(scope="module")
def chromium(chromium_path: str) -> Iterator[Browser]:
    with sync_playwright() as playwright:
        expect.set_options(timeout=30_000)  # a busy machine is slow, not wrong
        browser = playwright.chromium.launch(executable_path=chromium_path, args=CHROMIUM_ARGS)
        try:
            yield browser
        finally:
            browser.close()


@pytest.fixture
def visitor(chromium: Browser, service: str) -> Iterator[Visitor]:
    """Give someone who opens the page in English; at the end nothing may have gone wrong unnoticed."""
    visitor = Visitor(chromium, service, locale="en-GB")
    try:
        yield visitor
        visitor.leave()
    finally:
        visitor.close()
