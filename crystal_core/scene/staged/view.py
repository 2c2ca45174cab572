"""Cameras in the world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from crystal_core.scene.cameras import Eye, ViewCamera
from crystal_core.scene.staged.stance import facing_frame

__all__ = ["StagedView", "staged_view"]

Real = NDArray[np.float64]

FILLED = 0.7
"""Part of the picture's shorter side that a fitted camera lets the bodies fill."""

SMALLEST_MM = 0.5
"""Radius that a fitted camera takes for smaller things: it does not creep up to them."""


@dataclass(frozen=True)
class StagedView:
    """A camera: unit vectors right, up, forward; a pinhole at `eye` or parallel lines of sight.

    Parameters
    ----------
    eye, forward, right, up : Real
        Shape (3,); an orthographic camera's rays start in the plane through `eye`.
    tan_half : float or None
        tan(vfov/2) of a pinhole.
    half_height_mm : float or None
        Half of the picture's height in the scene, of an orthographic camera.
    analyser_deg : float or None
        Direction that the analyser passes, from `right`, counter-clockwise as seen in the picture.
    pointer : str
        Where the scene says where it stands.
    """

    eye: Real
    forward: Real
    right: Real
    up: Real
    tan_half: float | None
    half_height_mm: float | None
    analyser_deg: float | None
    pointer: str

    @property
    def analyser(self) -> Real | None:
        """Direction that the analyser passes, unit, shape (3,); None without one."""
        if self.analyser_deg is None:
            return None
        angle = np.deg2rad(self.analyser_deg)
        return np.asarray(np.cos(angle) * self.right + np.sin(angle) * self.up, np.float64)

    def with_analyser(self, angle_deg: float) -> StagedView:
        """Return the camera with its analyser at another angle."""
        return replace(self, analyser_deg=angle_deg)


def staged_view(camera: ViewCamera, corners: Sequence[Real], size_px: tuple[int, int]) -> StagedView:
    """Return the camera in the world.

    Parameters
    ----------
    camera : ViewCamera
        As written.
    corners : sequence of Real
        What a fitted camera shows, points of shape (n, 3).
    size_px : tuple of int
        Width and height of the picture.
    """
    if camera.fitted is not None:
        fitted = camera.fitted
        tilt, azimuth = np.deg2rad((fitted.tilt_deg, fitted.azimuth_deg))
        towards = np.array((np.sin(tilt) * np.sin(azimuth), -np.sin(tilt) * np.cos(azimuth), np.cos(tilt)))
        points = np.concatenate(corners)
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        radius = max(float(np.linalg.norm(points - middle, axis=1).max()), SMALLEST_MM)
        tan_half = float(np.tan(0.5 * np.deg2rad(fitted.vfov_deg)))
        shorter = tan_half * min(1.0, size_px[0] / size_px[1])
        distance = radius / np.sin(np.arctan(FILLED * shorter))
        up = (np.sin(azimuth) * -1.0, np.cos(azimuth), 0.0) if abs(np.sin(tilt)) < 1e-9 else None
        frame = facing_frame(towards, up)
        return _view(frame, middle + distance * towards, tan_half, None, camera)
    eye: Eye | None = camera.perspective or camera.orthographic
    assert eye is not None
    at = np.asarray(eye.eye_mm, np.float64)
    frame = facing_frame(at - np.asarray(eye.target_mm, np.float64), eye.up)
    if camera.perspective is not None:
        opening = float(np.tan(0.5 * np.deg2rad(camera.perspective.vfov_deg)))
        return _view(frame, at, opening, None, camera)
    assert camera.orthographic is not None
    return _view(frame, at, None, 0.5 * camera.orthographic.height_mm, camera)


def _view(frame: Real, eye: Real, tan_half: float | None, half_height: float | None, camera: ViewCamera) -> StagedView:
    pointer = "/camera/fitted" if camera.fitted is not None else f"/camera/{camera.kind}/eye_mm"
    return StagedView(eye, -frame[:, 2], frame[:, 0], frame[:, 1], tan_half, half_height, camera.analyser_deg, pointer)
