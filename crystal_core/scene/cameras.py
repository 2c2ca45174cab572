"""Cameras, and the analyser in front of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from crystal_core.scene.parts import Angle, Choice, Direction, Length, Location, Part, Point
from crystal_core.scene.surfaces import parallel

__all__ = ["Eye", "Fitted", "Orthographic", "Perspective", "ViewCamera"]

_FieldOfView = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.01, le=120)]


class Fitted(Part):
    """A perspective camera that finds its own distance: the bodies fill seven tenths of the picture's shorter side.

    It looks at their middle from `tilt_deg` beside the vertical: from −y at azimuth 0, from +x at azimuth 90.
    """

    tilt_deg: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=180)] = 15.0
    azimuth_deg: Angle = 0.0
    vfov_deg: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1, le=90)] = 16.0


class Eye(Part):
    """Base of cameras that are placed by hand; `up` is the top of the picture [default: z; y if they look along z]."""

    eye_mm: Point
    target_mm: Point = (0.0, 0.0, 0.0)
    up: Direction | None = None

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse cameras without a line of sight or a top."""
        sight = tuple(b - a for a, b in zip(self.eye_mm, self.target_mm, strict=True))
        if sum(c * c for c in sight) < 1e-12:
            yield ("target_mm",), "must not be the eye"
        elif self.up is not None and parallel(self.up, (sight[0], sight[1], sight[2])):
            yield ("up",), "must not be parallel to the line of sight"


class Perspective(Eye):
    """A pinhole."""

    vfov_deg: _FieldOfView = 16.0


class Orthographic(Eye):
    """Parallel lines of sight; the height is that of the picture in the scene."""

    height_mm: Length = 30.0


class ViewCamera(Choice):
    """A camera."""

    choices = ("fitted", "perspective", "orthographic")

    fitted: Fitted | None = None
    perspective: Perspective | None = None
    orthographic: Orthographic | None = None
    analyser_deg: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-3600, le=3600)] | None = Field(
        default=None,
        description="Direction that an analyser in front passes, from the picture's right, counter-clockwise",
    )
