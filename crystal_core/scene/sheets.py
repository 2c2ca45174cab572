"""Thin optical elements: ideal polarizers and retarders, and plates whose thickness only the optics sees."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from crystal_core.scene.media import Made
from crystal_core.scene.orientation import Orientation
from crystal_core.scene.parts import Angle, Fraction, Location, Part
from crystal_core.scene.surfaces import Disc, Outline, Placed

__all__ = ["Polarizer", "Retarder", "Sheet", "SheetPlate"]


class Polarizer(Part):
    """Passes the field along one direction; `extinction` is the share of the power of the other that leaks through."""

    angle_deg: Angle = Field(default=0.0, description="From its right, counter-clockwise seen from the side it faces")
    transmission: Fraction = 1.0
    extinction: Fraction = 0.0

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse a leak larger than what is passed."""
        if self.extinction > self.transmission:
            yield ("extinction",), f"must be at most the transmission, {self.transmission:g}"


class Retarder(Part):
    """Delays the field along its slow direction against the other by one length at all wavelengths."""

    retardation_nm: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1e6)]
    slow_deg: Angle = Field(default=45.0, description="From its right, counter-clockwise seen from the side it faces")


class SheetPlate(Made):
    """A plane-parallel plate; the orientation's x, y, z are the sheet's right, up and facing."""

    thickness_um: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.1, le=1e5)]
    orientation: Orientation | None = None

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse lattice directions of what has no lattice."""
        faults = list(super().after())
        yield from faults
        if faults or (self.entry is not None and self.entry.cell is not None):
            return
        for axis in ("x", "y", "z"):
            direction = None if self.orientation is None else getattr(self.orientation, axis)
            if direction is not None and direction.kind in {"hkl", "uvw"}:
                yield (
                    ("orientation", axis, direction.kind),
                    f"{self.mineral or 'a medium by its indices'} has no lattice",
                )


class Sheet(Placed):
    """A thin element without thickness in the scene."""

    choices = ("polarizer", "retarder", "plate")

    polarizer: Polarizer | None = None
    retarder: Retarder | None = None
    plate: SheetPlate | None = None
    shape: Outline = Outline(disc=Disc())
