"""A small drawing board for the docs' pictures: lines, arrows and labelled text, written as SVG."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "AXIS",
    "CRYSTAL",
    "EXTRAORDINARY",
    "INK",
    "LIGHT",
    "ORDINARY",
    "PAPER",
    "QUIET",
    "Drawing",
    "Isometry",
    "by",
]

INK, QUIET, PAPER = "#1b1d1e", "#6d7374", "#fdfdfb"
ORDINARY, EXTRAORDINARY, AXIS = "#0b6268", "#c2410c", "#6b3fa0"
CRYSTAL, LIGHT = "#e3f0f0", "#b7791f"

Real = NDArray[np.float64]

MARKUP = re.compile(r"\*(?P<italic>[^*]+)\*|_\{(?P<sub>[^}]+)\}|\^\{(?P<super>[^}]+)\}|(?P<plain>[^*_^]+|.)")


class Drawing:
    """An SVG picture; x to the right, y down, in pixels.

    Text may hold ``*italic*``, ``_{below}`` and ``^{above}``.
    """

    def __init__(self, width: int, height: int, title: str, description: str) -> None:
        self._size = (width, height)
        self._title, self._description = title, description
        self._parts: list[str] = []

    def save(self, path: Path) -> None:
        """Write the picture."""
        width, height = self._size
        text = "\n".join(
            (
                f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
                f'height="{height}" role="img" font-family="DejaVu Sans, Verdana, sans-serif" stroke-linecap="round" '
                'stroke-linejoin="round">',
                f"<title>{escape(self._title)}</title>",
                f"<desc>{escape(self._description)}</desc>",
                f'<rect width="{width}" height="{height}" rx="10" fill="{PAPER}"/>',
                *self._parts,
                "</svg>\n",
            )
        )
        path.write_text(text, encoding="utf-8")

    def line(self, points: ArrayLike, colour: str = INK, width: float = 1.4, dashed: bool = False) -> None:
        """Draw straight lines through points, shape (N, 2)."""
        self._path(points, "none", colour, width, dashed, closed=False)

    def area(
        self, points: ArrayLike, fill: str, colour: str = "none", width: float = 1.0, opacity: float = 1.0
    ) -> None:
        """Fill a polygon, shape (N, 2)."""
        self._path(points, fill, colour, width, False, closed=True, opacity=opacity)

    def arrow(
        self, start: ArrayLike, end: ArrayLike, colour: str = INK, width: float = 2.0, dashed: bool = False
    ) -> None:
        """Draw an arrow from start to end, each (2,)."""
        a, b = np.asarray(start, float), np.asarray(end, float)
        along = (b - a) / np.linalg.norm(b - a)
        head = 5.0 + 2.2 * width
        self.line((a, b - 0.8 * head * along), colour, width, dashed)
        self._head(b, along, head, colour)

    def arc(self, points: ArrayLike, colour: str = INK, width: float = 1.4, head: bool = True) -> None:
        """Draw a curve through many points, shape (N, 2); with an arrow head at its end."""
        curve = np.asarray(points, float)
        self.line(curve if not head else curve[:-1], colour, width)
        if head:
            along = curve[-1] - curve[-3]
            self._head(curve[-1], along / np.linalg.norm(along), 5.0 + 2.2 * width, colour)

    def dot(self, at: ArrayLike, radius: float = 3.0, colour: str = INK) -> None:
        """Draw a filled disc."""
        x, y = np.asarray(at, float)
        self._parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{colour}"/>')

    def towards_reader(self, at: ArrayLike, colour: str = INK, radius: float = 6.0) -> None:
        """Draw a vector that comes out of the paper."""
        x, y = np.asarray(at, float)
        self._parts.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{PAPER}" stroke="{colour}" stroke-width="1.6"/>'
        )
        self.dot(at, 2.2, colour)

    def text(self, at: ArrayLike, text: str, colour: str = INK, size: float = 15, anchor: str = "start") -> None:
        """Write a line of text; `at` is the left end, middle or right end of its base line by `anchor`."""
        x, y = np.asarray(at, float)
        spans, back = [], 0.0
        for match in MARKUP.finditer(text):
            shift = {"sub": 0.28 * size, "super": -0.38 * size}.get(str(match.lastgroup), 0.0)
            style = f' dy="{shift + back:.1f}"' if shift + back else ""
            back = -shift
            if match.lastgroup == "italic":
                style += ' font-style="italic" font-family="DejaVu Serif, Georgia, serif"'
            elif match.lastgroup in {"sub", "super"}:
                style += f' font-size="{0.72 * size:.1f}"'
            spans.append(f"<tspan{style}>{escape(match.group(str(match.lastgroup)))}</tspan>")
        self._parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" font-size="{size}" text-anchor="{anchor}" '
            # A rim of paper keeps letters apart from the lines that they stand on.
            f'stroke="{PAPER}" stroke-width="3" paint-order="stroke" xml:space="preserve">{"".join(spans)}</text>'
        )

    def lines(self, at: ArrayLike, lines: Iterable[str], colour: str = INK, size: float = 13.5) -> None:
        """Write lines of text below each other."""
        x, y = np.asarray(at, float)
        for number, line in enumerate(lines):
            self.text((x, y + 1.5 * size * number), line, colour, size)

    def _head(self, tip: Real, along: Real, length: float, colour: str) -> None:
        across = np.array((-along[1], along[0]))
        base = tip - length * along
        self.area((tip, base + 0.36 * length * across, base - 0.36 * length * across), colour)

    def _path(
        self,
        points: ArrayLike,
        fill: str,
        colour: str,
        width: float,
        dashed: bool,
        closed: bool,
        opacity: float = 1.0,
    ) -> None:
        data = "M" + "L".join(f"{x:.1f},{y:.1f}" for x, y in np.asarray(points, float)) + ("Z" if closed else "")
        dashes = ' stroke-dasharray="5 5"' if dashed else ""
        faint = f' fill-opacity="{opacity}"' if opacity < 1.0 else ""
        self._parts.append(f'<path d="{data}" fill="{fill}"{faint} stroke="{colour}" stroke-width="{width}"{dashes}/>')


class Isometry:
    """Parallel projection of space (z up) onto the paper.

    Parameters
    ----------
    origin : array_like
        Where the world's origin stands on the paper, (2,).
    scale : float
        Pixels per unit.
    azimuth_deg, elevation_deg : float
        Where the reader stands, azimuth counter-clockwise from x.
    """

    def __init__(self, origin: ArrayLike, scale: float, azimuth_deg: float, elevation_deg: float) -> None:
        a, e = np.deg2rad((azimuth_deg, elevation_deg))
        self._origin, self._scale = np.asarray(origin, float), scale
        self._right = np.array((-np.sin(a), np.cos(a), 0.0))
        self._up = np.array((-np.cos(a) * np.sin(e), -np.sin(a) * np.sin(e), np.cos(e)))

    def __call__(self, points: ArrayLike) -> Real:
        """Return the paper's points, shape (..., 2), of points in space, shape (..., 3)."""
        p = np.asarray(points, float)
        flat = np.stack((p @ self._right, -(p @ self._up)), axis=-1)
        result: Real = self._origin + self._scale * flat
        return result


def by(point: ArrayLike, right: float, down: float) -> Real:
    """Return a point of the paper, shape (2,), moved by so many pixels."""
    x, y = np.asarray(point, float)
    return np.array((x + right, y + down))
