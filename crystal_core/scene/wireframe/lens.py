"""How a drawing looks at a scene: the scene's own camera, or straight from above, from the front, from the right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from crystal_core.scene.staged.view import StagedView

__all__ = ["MARGIN", "WIDTH", "Lens", "View", "camera_lens", "fitted_lens"]

Real = NDArray[np.float64]
View = Literal["camera", "plan", "front", "side"]

WIDTH = 720.0
"""Of every drawing, in its own units."""

MARGIN = 64.0
"""Around what a fitted drawing shows: room for names and arrows."""

NEAR_MM = 1e-3
"""What is nearer to a pinhole than this, or behind it, is not drawn."""

_FRAMES: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "plan": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    "front": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "side": ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
}
"""Right and up of the three straight views: from +z, from −y, from +x."""


@dataclass(frozen=True)
class Lens:
    """A projection onto a sheet of `width` × `height` units, its origin top left, y down.

    Parameters
    ----------
    eye, forward, right, up : Real
        Shape (3,); without a pinhole any point in the middle of the picture, and the way that everybody looks.
    half_height : float
        Half of the sheet's height in the plane at distance 1 (a pinhole) or in mm (parallel lines of sight).
    is_pinhole : bool
        Whether all lines of sight meet in the eye.
    width, height : float
        Of the sheet.
    """

    eye: Real
    forward: Real
    right: Real
    up: Real
    half_height: float
    is_pinhole: bool
    width: float
    height: float

    def depth(self, points: Real) -> Real:
        """Return how far points, shape (N, 3), lie before the eye, mm, shape (N,)."""
        return np.asarray((points - self.eye) @ self.forward)

    def project(self, points: Real) -> Real:
        """Return where points, shape (N, 3), stand on the sheet, shape (N, 2); a pinhole's must lie before it."""
        across = (points - self.eye) @ np.stack((self.right, self.up), axis=1)
        if self.is_pinhole:
            across = across / self.depth(points)[:, None]
        unit = 0.5 * self.height / self.half_height
        return np.asarray((0.5 * self.width, 0.5 * self.height) + unit * across * (1.0, -1.0))

    def towards_eye(self, points: Real) -> Real:
        """Return unit vectors from points, shape (N, 3), to who looks at them, shape (N, 3)."""
        if not self.is_pinhole:
            return np.broadcast_to(-self.forward, points.shape)
        sight = self.eye - points
        return np.asarray(sight / np.linalg.norm(sight, axis=1, keepdims=True))

    def units_per_mm(self, point: Real) -> float:
        """Return the length on the sheet of 1 mm across the line of sight at a point."""
        distance = float(self.depth(point[None])[0]) if self.is_pinhole else 1.0
        return 0.5 * self.height / (self.half_height * max(distance, NEAR_MM))

    def before_eye(self, start: Real, end: Real) -> tuple[Real, Real] | None:
        """Return the part of a segment that a pinhole can show, None if none."""
        if not self.is_pinhole:
            return start, end
        first, second = self.depth(np.stack((start, end)))
        if first < NEAR_MM and second < NEAR_MM:
            return None
        if first < NEAR_MM:
            start = end + (start - end) * (second - NEAR_MM) / (second - first)
        elif second < NEAR_MM:
            end = start + (end - start) * (first - NEAR_MM) / (first - second)
        return start, end


def camera_lens(view: StagedView, size_px: tuple[int, int]) -> Lens:
    """Return the lens of a scene's camera: the sheet is the picture, so that the two can be laid on each other."""
    height = WIDTH * size_px[1] / size_px[0]
    half = view.tan_half if view.tan_half is not None else view.half_height_mm
    assert half is not None
    return Lens(view.eye, view.forward, view.right, view.up, half, view.tan_half is not None, WIDTH, height)


def fitted_lens(view: View, points: Sequence[Real]) -> Lens:
    """Return a lens from above, from the front or from the right that shows all of the points, each of shape (n, 3)."""
    right, up = (np.array(vector) for vector in _FRAMES[view])
    shown = np.concatenate(points)
    across = shown @ np.stack((right, up), axis=1)
    low, high = across.min(axis=0), across.max(axis=0)
    width, height = np.maximum(high - low, 1e-3)
    unit = (WIDTH - 2.0 * MARGIN) / max(width, height / 1.1)  # a drawing much higher than wide fills no page well
    tall = max(unit * height + 2.0 * MARGIN, 260.0)
    forward = -np.cross(right, up)
    middle = 0.5 * (low + high)
    eye = middle[0] * right + middle[1] * up + float((shown @ forward).min()) * forward
    return Lens(eye, forward, right, up, 0.5 * tall / unit, False, WIDTH, float(tall))
