"""Lights: a point, a parallel beam, an area, the sky; each with a spectrum and a polarization."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from crystal_core.scene.parts import Choice, Direction, Fraction, Location, Part, Point
from crystal_core.scene.spectra import Spectrum
from crystal_core.scene.surfaces import Disc, Outline, Rectangle, parallel

__all__ = ["AreaLight", "Beam", "Light", "PointSource", "Polarization", "SkyLight"]

_Lux = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=1e9)]


class PointSource(Part):
    """A point, the same in all directions; its illuminance is that of a plane at the origin that faces it."""

    position_mm: Point = (-90.0, 130.0, 380.0)
    illuminance_lx: _Lux = 700.0

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse a point at the origin, where its illuminance would be endless."""
        if sum(c * c for c in self.position_mm) < 1.0:
            yield ("position_mm",), "must be at least 1 mm from the origin, where its illuminance is told"


class Beam(Part):
    """Parallel light from a cross-section; `up` is the top of the cross-section."""

    position_mm: Point
    direction: Direction
    shape: Outline = Outline(disc=Disc(diameter_mm=2.0))
    up: Direction | None = None
    illuminance_lx: _Lux = Field(default=10000.0, description="In its cross-section")

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse an up along the beam."""
        if self.up is not None and parallel(self.up, self.direction):
            yield ("up",), "must not be parallel to direction"


class AreaLight(Part):
    """A plane that shines on the side it faces, equally bright from everywhere (Lambert)."""

    position_mm: Point
    facing: Direction = (0.0, 0.0, -1.0)
    up: Direction | None = None
    shape: Outline = Outline(rectangle=Rectangle(width_mm=100.0))
    exitance_lx: _Lux = Field(default=10000.0, description="Luminous flux that leaves it, per area (lm/m²)")

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse an up along the normal."""
        if self.up is not None and parallel(self.up, self.facing):
            yield ("up",), "must not be parallel to facing"


class SkyLight(Part):
    """Light of equal radiance from everywhere; its illuminance is that of a plane that nothing shades."""

    illuminance_lx: _Lux = 300.0


class Polarization(Choice):
    """Of light: linear or circular, whole or in part (the rest is unpolarized)."""

    choices = ("vibration", "circular")

    vibration: Direction | None = Field(default=None, description="Of the field, made transverse to each ray")
    circular: Literal["clockwise", "counter-clockwise"] | None = Field(
        default=None, description="How the field turns for an observer who faces the source"
    )
    degree: Fraction = 1.0


class Light(Choice):
    """A light."""

    choices = ("point", "beam", "area", "sky")

    point: PointSource | None = None
    beam: Beam | None = None
    area: AreaLight | None = None
    sky: SkyLight | None = None
    spectrum: Spectrum = "D65"
    polarization: Polarization | None = None
