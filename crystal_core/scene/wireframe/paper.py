"""A sheet of paper: strokes by kind, arrows, names that find a free place, and the SVG of it all."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

__all__ = ["ACCENT", "FAINT", "INK", "OVERLINE", "Paper", "Style"]

Real = NDArray[np.float64]
Points = Sequence[tuple[float, float]]
Box = tuple[float, float, float, float]
"""Left, top, right, bottom."""

SMALLEST = 0.05
"""Strokes shorter than this, in units of the sheet, are points: edges seen along their length."""

FONT = "'DejaVu Sans', 'Helvetica Neue', Arial, sans-serif"
LETTER = 0.58
"""Mean width of a letter, in heights of the font."""

OVERLINE = "\u0305"
"""Stands over the digit before it, as on negative Miller indices."""

CROWDED = 3.0
"""Cost of a place from which on a text is rather left out."""

INK, ACCENT, FAINT = "#111", "#b3261e", "#666"


@dataclass(frozen=True)
class Style:
    """How strokes of one kind look.

    Parameters
    ----------
    name : str
        The class of their group.
    width : float
        Of the stroke.
    colour : str
        Of the stroke.
    dashes : str or None
        Lengths of dashes and gaps.
    """

    name: str
    width: float
    colour: str = INK
    dashes: str | None = None


@dataclass
class _Label:
    text: str
    anchor: tuple[float, float]
    size: float
    colour: str
    italic: bool
    away: tuple[float, float] | None


@dataclass
class _Inset:
    text: str
    corners: Real
    size: float
    colour: str


@dataclass
class Paper:
    """A sheet being drawn on; what leaves it is cut off at its rim.

    Parameters
    ----------
    width, height : float
        Of the sheet.
    """

    width: float
    height: float
    _strokes: dict[Style, list[list[tuple[float, float]]]] = field(default_factory=dict)
    _fills: list[tuple[str, Points]] = field(default_factory=list)
    _labels: list[_Label] = field(default_factory=list)
    _insets: list[_Inset] = field(default_factory=list)
    _fixed: list[str] = field(default_factory=list)

    def line(self, style: Style, points: Real) -> None:
        """Draw a line through points, shape (N, 2)."""
        for start, end in itertools.pairwise(points):
            inside = self.cut(start, end)
            if inside is not None:
                self._strokes.setdefault(style, []).append([_place(inside[0]), _place(inside[1])])

    def arrow(self, style: Style, start: Real, end: Real, head: float = 7.0, *, double: bool = False) -> None:
        """Draw an arrow from start to end, shape (2,), or one with a head at both ends."""
        self.line(style, np.stack((start, end)))
        length = float(np.hypot(*(end - start)))
        if length < head:
            return
        along = (end - start) / length
        across = np.array((-along[1], along[0]))
        tips = ((end, along), (start, -along)) if double else ((end, along),)
        for tip, way in tips:
            if self.holds(tip):
                back = tip - head * way
                wings = (back + 0.35 * head * across, tip, back - 0.35 * head * across)
                self._fills.append((style.colour, [_place(p) for p in wings]))

    def dot(self, style: Style, centre: Real, radius: float) -> None:
        """Draw a small circle."""
        if self.holds(centre):
            x, y = _place(centre)
            self._fixed.append(
                f'<circle class="{style.name}" cx="{_text(x)}" cy="{_text(y)}" r="{_text(radius)}" fill="none" '
                f'stroke="{style.colour}" stroke-width="{_text(style.width)}"/>'
            )

    def label(
        self,
        text: str,
        anchor: Real,
        *,
        size: float = 12.0,
        colour: str = INK,
        italic: bool = False,
        away: Real | None = None,
    ) -> None:
        """Write a text beside a point, on the side `away` points to if it can be had; where it fits is found later."""
        if self.holds(anchor):
            way = None if away is None else (float(away[0]), float(away[1]))
            self._labels.append(_Label(text, _place(anchor), size, colour, italic, way))

    def within(self, text: str, corners: Real, *, size: float, colour: str) -> None:
        """Write a text inside a convex outline, shape (N, 2), if all else leaves a free place for it."""
        self._insets.append(_Inset(text, corners, size, colour))

    def holds(self, point: Real) -> bool:
        """Tell whether a point lies on the sheet."""
        return bool(0.0 <= point[0] <= self.width and 0.0 <= point[1] <= self.height)

    def svg(self, title: str, caption: Sequence[str], footer: str, *, framed: bool) -> str:
        """Return the sheet as SVG: the drawing, and below it a strip with the caption and what stands at its right."""
        strip = 16.0 * len(caption) + 20.0
        total = self.height + max(strip, 44.0)
        out = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_text(self.width)} {_text(total)}" role="img" '
            f'font-family="{escape(FONT)}">',
            f"<title>{escape(title)}</title>",
            f'<rect class="paper" width="{_text(self.width)}" height="{_text(total)}" fill="#fff"/>',
        ]
        for style, strokes in self._strokes.items():
            dashes = f' stroke-dasharray="{style.dashes}"' if style.dashes else ""
            path = "".join(_path(chain) for chain in _chains(strokes))
            out.append(
                f'<path class="{style.name}" fill="none" stroke="{style.colour}" stroke-width="{_text(style.width)}"'
                f'{dashes} stroke-linecap="round" stroke-linejoin="round" d="{path}"/>'
            )
        out += [f'<path class="head" fill="{colour}" d="{_path(points)}z"/>' for colour, points in self._fills]
        out += self._fixed
        out += self._texts()
        if framed:
            out.append(
                f'<rect class="frame" x="0.5" y="0.5" width="{_text(self.width - 1)}" '
                f'height="{_text(self.height - 1)}" fill="none" stroke="{FAINT}" stroke-width="0.6"/>'
            )
        for row, text in enumerate(caption):
            size, colour = (13.0, INK) if row == 0 else (11.0, FAINT)
            y = self.height + 20.0 + 16.0 * row
            out.append(_written(text, 8.0, y, size, colour, False, "start", halo=False))
        return "\n".join([*out, footer, "</svg>"]) + "\n"

    def cut(self, start: Real, end: Real) -> tuple[Real, Real] | None:
        """Return the part of a stroke on the sheet (Liang and Barsky), ends of shape (2,); None if none to speak of."""
        low, high = 0.0, 1.0
        step = end - start
        for axis, limit in ((0, self.width), (1, self.height)):
            for sign, bound in ((-1.0, start[axis]), (1.0, limit - start[axis])):
                speed = sign * step[axis]
                if speed == 0.0:
                    if bound < 0.0:
                        return None
                    continue
                t = bound / speed
                low, high = (max(low, t), high) if speed < 0.0 else (low, min(high, t))
        if high <= low or (high - low) * float(np.hypot(*step)) < SMALLEST:
            return None
        return start + low * step, start + high * step

    def _texts(self) -> list[str]:
        """Return all labels where they cover least, of equal places the nearest, and what fits into its outline."""
        ink = _samples(stroke for strokes in self._strokes.values() for stroke in strokes)
        taken: list[Box] = []
        texts = []
        for label in self._labels:
            _, x, y, where, box = min(
                ((self._cost(box, ink, taken) + cost, x, y, where, box) for cost, x, y, where, box in _around(label)),
                key=lambda place: place[0],
            )
            taken.append(box)
            texts.append(_written(label.text, x, y, label.size, label.colour, label.italic, where, halo=True))
        for inset in self._insets:
            cost, x, y, box = min(
                ((self._cost(box, ink, taken) + cost, x, y, box) for cost, x, y, box in _inside(inset)),
                key=lambda place: place[0],
                default=(np.inf, 0.0, 0.0, (0.0, 0.0, 0.0, 0.0)),
            )
            if cost < CROWDED:
                taken.append(box)
                texts.append(_written(inset.text, x, y, inset.size, inset.colour, False, "middle", halo=False))
        return texts

    def _cost(self, box: Box, ink: Real, taken: list[Box]) -> float:
        x0, y0, x1, y1 = box
        over = (
            max(0.0, 3.0 - x0) + max(0.0, x1 - self.width + 3.0) + max(0.0, 3.0 - y0) + max(0.0, y1 - self.height + 3)
        )
        cost = 50.0 * (over > 0.0) + over
        cost += sum(
            60.0 for a0, b0, a1, b1 in taken if min(x1, a1) > max(x0, a0) - 2.0 and min(y1, b1) > max(y0, b0) - 1.0
        )
        within = (ink[:, 0] > x0) & (ink[:, 0] < x1) & (ink[:, 1] > y0) & (ink[:, 1] < y1)
        return cost + 0.5 * float(np.count_nonzero(within))


def _place(point: Real) -> tuple[float, float]:
    return round(float(point[0]), 1) + 0.0, round(float(point[1]), 1) + 0.0  # + 0.0: no −0


def _text(number: float) -> str:
    return f"{number:.2f}".rstrip("0").rstrip(".")


def _path(points: Points) -> str:
    (x, y), *rest = points
    return f"M{_text(x)} {_text(y)}" + "".join(f"L{_text(a)} {_text(b)}" for a, b in rest)


def _chains(strokes: list[list[tuple[float, float]]]) -> list[list[tuple[float, float]]]:
    """Join strokes end to end wherever just two of them meet, each stroke once, so that dashes run on round a curve."""
    unique = list({(min(a, b), max(a, b)): (a, b) for a, b in strokes}.values())
    at: dict[tuple[float, float], list[int]] = {}
    for number, ends in enumerate(unique):
        for end in ends:
            at.setdefault(end, []).append(number)
    used = [False] * len(unique)
    chains = []
    # Open chains first: from ends where one stroke stops or several meet. What is left then is rings.
    order = [n for n, ends in enumerate(unique) if any(len(at[end]) != 2 for end in ends)] + list(range(len(unique)))
    for number in order:
        if used[number]:
            continue
        used[number] = True
        first, last = unique[number]
        if len(at[first]) == 2:
            first, last = last, first
        chain = [first, last]
        while len(at[chain[-1]]) == 2:
            following = next((n for n in at[chain[-1]] if not used[n]), None)
            if following is None:
                break
            used[following] = True
            a, b = unique[following]
            chain.append(b if a == chain[-1] else a)
        chains.append(chain)
    return chains


def _samples(strokes: Iterable[list[tuple[float, float]]]) -> Real:
    """Return points along all strokes, about 5 units apart, shape (N, 2)."""
    found = [np.empty((0, 2))]
    for a, b in strokes:
        start, end = np.array(a), np.array(b)
        count = max(2, int(np.hypot(*(end - start)) / 5.0))
        found.append(start + np.linspace(0.0, 1.0, count)[:, None] * (end - start))
    return np.concatenate(found)


def _around(label: _Label) -> Iterator[tuple[float, float, float, str, Box]]:
    """Yield places about the anchor of a label: how far from the best, x, y, text-anchor and box."""
    wide = _wide(label.text, label.size)
    for distance in (6.0, 11.0, 18.0, 28.0, 42.0):
        for step in range(16):
            angle = 2.0 * np.pi * step / 16
            way = np.array((np.cos(angle), np.sin(angle)))
            where = "start" if way[0] > 0.3 else "end" if way[0] < -0.3 else "middle"
            x = label.anchor[0] + distance * float(way[0])
            y = label.anchor[1] + distance * float(way[1]) + 0.36 * label.size * (1.0 + float(way[1]))
            left = x - {"start": 0.0, "middle": 0.5, "end": 1.0}[where] * wide
            turned = 0.0 if label.away is None else 1.5 * (1.0 - float(way @ label.away))
            yield 0.12 * distance + turned, x, y, where, _box(left, y, wide, label.size)


def _inside(inset: _Inset) -> Iterator[tuple[float, float, float, Box]]:
    """Yield places of a text inside its outline: how far from its middle, x, y and box."""
    wide = _wide(inset.text, inset.size)
    corners = inset.corners
    middle = corners.mean(axis=0)
    edges = np.roll(corners, -1, axis=0) - corners
    across = np.stack((edges[:, 1], -edges[:, 0]), axis=1) / np.maximum(np.linalg.norm(edges, axis=1), 1e-9)[:, None]
    across *= np.sign(np.einsum("ni,ni->n", across, corners - middle))[:, None]
    reach = np.einsum("ni,ni->n", across, corners)
    places = [middle, *(middle + part * (corner - middle) for part in (0.2, 0.4, 0.55) for corner in corners)]
    half = np.array((0.5 * wide + 2.0, 0.5 * inset.size + 1.0))
    for place in places:
        if np.all(across @ place + np.abs(across) @ half <= reach):
            x, y = float(place[0]), float(place[1]) + 0.36 * inset.size
            yield 0.02 * float(np.hypot(*(place - middle))), x, y, _box(x - 0.5 * wide, y, wide, inset.size)


def _box(left: float, baseline: float, wide: float, size: float) -> Box:
    return left, baseline - 0.82 * size, left + wide, baseline + 0.28 * size


def _wide(text: str, size: float) -> float:
    return LETTER * size * sum(1 for letter in text if letter != OVERLINE)


def _written(text: str, x: float, y: float, size: float, colour: str, italic: bool, where: str, *, halo: bool) -> str:
    style = ' font-style="italic" font-family="\'DejaVu Serif\', Georgia, serif"' if italic else ""
    around = ' stroke="#fff" stroke-width="3" stroke-linejoin="round" paint-order="stroke"' if halo else ""
    return (
        f'<text x="{_text(round(x, 1))}" y="{_text(round(y, 1))}" font-size="{_text(size)}" fill="{colour}" '
        f'text-anchor="{where}"{style}{around}>{escape(text)}</text>'
    )
