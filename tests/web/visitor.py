"""Someone who uses the page, and notices whatever goes wrong in it."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable
from typing import Any
from urllib.parse import urlencode

from playwright.sync_api import Browser, ConsoleMessage, Locator, Page, Request, Route

__all__ = ["TINY", "Visitor"]

TINY = {"quality": "draft", "size": "32x32", "frames": "4"}
"""A link's settings that cost next to nothing."""

WAIT_MS = 60_000


class Visitor:
    """A browser context with one page open at a time.

    Parameters
    ----------
    browser : Browser
        A running browser.
    address : str
        Of the service, with a slash at its end.
    locale, width, motion : str, int, str
        Language of the browser, width of its window in pixels, ``no-preference`` or ``reduce``.
    """

    def __init__(
        self, browser: Browser, address: str, *, locale: str, width: int = 1280, motion: str = "no-preference"
    ) -> None:
        self.address = address
        self.context = browser.new_context(
            locale=locale,
            viewport={"width": width, "height": 800},
            reduced_motion=motion,  # type: ignore[arg-type]
        )
        self.context.set_default_timeout(WAIT_MS)
        self.context.route(re.compile(".*"), self._guard)
        self.page: Page = self.context.new_page()
        self.asked: list[dict[str, Any]] = []
        self.outside: list[str] = []
        self.wrong: list[str] = []
        self.expected: list[str] = []
        """Patterns of console errors that the test brings about on purpose."""
        self.page.on("console", self._heard)
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("request", self._noted)

    def _guard(self, route: Route) -> None:
        if route.request.url.startswith((self.address, "data:", "blob:")):
            route.continue_()
        else:
            self.outside.append(route.request.url)
            route.abort()

    def _heard(self, message: ConsoleMessage) -> None:
        if message.type in ("error", "warning"):
            self.wrong.append(message.text)

    def _noted(self, request: Request) -> None:
        if request.method == "POST" and request.url.endswith("/v1/renders"):
            self.asked.append(json.loads(request.post_data or "null"))

    def open(self, link: dict[str, str] | None = None) -> Visitor:
        """Open the page, by default at a tiny render that stands still at 0°; ``{}`` opens it as it is."""
        keys = {**TINY, "angle": "0"} if link is None else link
        self.page.goto(self.address + ("#" + urlencode(keys) if keys else ""))
        return self

    def leave(self) -> None:
        """Complain of whatever went wrong unexpectedly."""
        assert self.outside == []
        assert [text for text in self.wrong if not any(re.search(known, text) for known in self.expected)] == []

    def close(self) -> None:
        self.context.close()

    # ---- what is to be seen

    @property
    def canvas(self) -> Locator:
        return self.page.locator("canvas")

    @property
    def words(self) -> Locator:
        return self.page.locator(".words").first

    def wait_done(self, status: str = "successful") -> None:
        self.page.locator(f'.words[data-status="{status}"]').wait_for()

    def wait_angle(self, angle: float) -> None:
        """Wait until the picture of exactly this angle stands on the stage."""
        self.page.locator(f'.frame[data-state="exact"] canvas[data-angle="{angle:g}"]').wait_for()

    @property
    def angle(self) -> float:
        """Angle of the picture that stands on the stage, degrees."""
        return float(self.canvas.get_attribute("data-angle") or "nan")

    def until(self, condition: Callable[[], bool], seconds: float = 30) -> None:
        """Wait for something that the page brings about."""
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "it did not come to pass in time"
            self.page.wait_for_timeout(20)  # unlike a sleep, this lets the browser's events through

    def pixels(self) -> list[int]:
        """Return the picture on the stage, row by row, RGBA."""
        # By way of a canvas of the test's own: the page's is not meant to be read, and Chromium would say so.
        found: list[int] = self.canvas.evaluate(
            """c => {
                const copy = new OffscreenCanvas(c.width, c.height).getContext('2d', {willReadFrequently: true});
                copy.drawImage(c, 0, 0);
                return Array.from(copy.getImageData(0, 0, c.width, c.height).data);
            }"""
        )
        return found

    def job(self) -> str:
        """Return the address of the render on the stage."""
        path: str = self.run("document.querySelector('isogyre-app').studio.film.job.links.self")
        return self.address.rstrip("/") + path

    def run(self, script: str, argument: Any = None) -> Any:
        """Run an expression in the page."""
        return self.page.evaluate(script, argument)
