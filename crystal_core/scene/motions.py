"""What changes from frame to frame."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from pydantic import Field

from crystal_core.scene.parts import (
    Angle,
    Choice,
    Coordinate,
    Direction,
    Fraction,
    Location,
    Name,
    Part,
    Point,
    Wavelength,
)

__all__ = [
    "MAX_FRAMES",
    "AnalyserMotion",
    "Keyframes",
    "Motion",
    "Move",
    "Shift",
    "StageMotion",
    "TurnMotion",
    "WavelengthMotion",
]

MAX_FRAMES = 360

_Angles = Annotated[tuple[Angle, ...], Field(min_length=2, max_length=MAX_FRAMES)]


class Keyframes(Part):
    """Base of what runs through values: straight lines between them, evenly spaced unless `at` says when."""

    at: Annotated[tuple[Fraction, ...], Field(min_length=2, max_length=MAX_FRAMES)] | None = Field(
        default=None, description="When each value is reached: from 0, the first frame, rising to 1"
    )

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse times that do not belong to the values, or do not go from 0 to 1."""
        if self.at is None:
            return
        if len(self.at) != len(self.values):
            yield ("at",), f"has {len(self.at)} times for {len(self.values)} values"
        if self.at[0] != 0 or self.at[-1] != 1:
            yield ("at",), "must go from 0 to 1"
        if any(b <= a for a, b in zip(self.at, self.at[1:], strict=False)):
            yield ("at",), "must rise"

    @property
    def values(self) -> tuple[object, ...]:
        """The values, one for each time."""
        name = next(
            name for name in type(self).model_fields if name in {"angles_deg", "positions_mm", "wavelengths_nm"}
        )
        values: tuple[object, ...] = getattr(self, name)
        return values

    def when(self, time: float) -> tuple[float, ...]:
        """Return the value at a time 0 … 1: one number, or three of a position."""
        values = np.asarray(self.values, np.float64).reshape(len(self.values), -1)
        times = np.linspace(0.0, 1.0, len(values)) if self.at is None else np.asarray(self.at)
        return tuple(float(np.interp(time, times, column)) for column in values.T)


class TurnMotion(Keyframes):
    """Turns one thing about itself: a body, and what is inside it or joined to it, a sheet, a light."""

    what: Name
    about: Direction | None = Field(
        default=None, description="For bodies [default: z] and lights; sheets have their normal"
    )
    angles_deg: _Angles


class StageMotion(Keyframes):
    """Turns all bodies and plates about a vertical axis, as the stage of a microscope does."""

    angles_deg: _Angles
    centre_mm: tuple[Coordinate, Coordinate] = (0.0, 0.0)


class AnalyserMotion(Keyframes):
    """Turns the analyser."""

    angles_deg: _Angles


class Shift(Keyframes):
    """Moves a body, a sheet or a light through positions."""

    what: Name
    positions_mm: Annotated[tuple[Point, ...], Field(min_length=2, max_length=MAX_FRAMES)]


class WavelengthMotion(Keyframes):
    """Runs the one line of a light through wavelengths."""

    of: Name
    wavelengths_nm: Annotated[tuple[Wavelength, ...], Field(min_length=2, max_length=MAX_FRAMES)]


class Move(Choice):
    """One thing that changes."""

    choices = ("turn", "stage", "analyser", "shift", "wavelength")

    turn: TurnMotion | None = None
    stage: StageMotion | None = None
    analyser: AnalyserMotion | None = None
    shift: Shift | None = None
    wavelength: WavelengthMotion | None = None


class Motion(Part):
    """The frames and what changes in them.

    Frame i of N is at time i/N when the motion is cyclic, so that the end is not repeated, else at i/(N − 1).
    """

    frames: Annotated[int, Field(strict=True, ge=1, le=MAX_FRAMES)] = 36
    cyclic: bool = Field(default=True, strict=True)
    moves: Annotated[tuple[Move, ...], Field(min_length=1, max_length=50)]

    def time(self, frame: int) -> float:
        """Return the time 0 … 1 of a frame."""
        return frame / self.frames if self.cyclic else frame / max(self.frames - 1, 1)
