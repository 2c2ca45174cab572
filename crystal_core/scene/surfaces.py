"""Diffuse surfaces: pages, screens, tables, rooms. They have no volume and scatter on both sides."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import Field

from crystal_core.scene.curves import Reflectance
from crystal_core.scene.parts import Choice, Coordinate, Direction, FileName, Length, Location, Part, Point
from crystal_core.scene.shapes import check_file_name

__all__ = ["PICTURE_SUFFIXES", "Disc", "Outline", "Placed", "Rectangle", "Room", "Surface", "SurfaceShape"]

PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg")


class Rectangle(Part):
    """A rectangle; without a height, a picture's own or a square."""

    width_mm: Length = 64.0
    height_mm: Length | None = None

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm, of a rectangle without a picture."""
        return self.width_mm, self.height_mm or self.width_mm


class Disc(Part):
    """A disc."""

    diameter_mm: Length = 30.0


class Endless(Part):
    """A plane without end."""


class Room(Part):
    """The six inner walls of a box along x, y, z; its position is its middle."""

    size_mm: tuple[Length, Length, Length] = (200.0, 200.0, 200.0)


class Outline(Choice):
    """The outline of a plane thing."""

    choices = ("rectangle", "disc")

    rectangle: Rectangle | None = None
    disc: Disc | None = None


class SurfaceShape(Choice):
    """The shape of a surface."""

    choices = ("rectangle", "disc", "endless", "room")

    rectangle: Rectangle | None = None
    disc: Disc | None = None
    endless: Endless | None = None
    room: Room | None = None


class Placed(Choice):
    """Base of plane things that stand somewhere and face some way.

    `up` is the direction of their top edge, as near as it can be [default: z; y for what faces z or −z]; their right is
    up × facing.
    """

    position_mm: Point = (0.0, 0.0, 0.0)
    facing: Direction = (0.0, 0.0, 1.0)
    up: Direction | None = None

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse a top edge that points where the thing faces."""
        if self.up is not None and parallel(self.up, self.facing):
            yield ("up",), "must not be parallel to facing"


class Surface(Placed):
    """A surface of one reflectance, or printed with a picture."""

    choices = ("reflectance", "print")

    reflectance: Reflectance | None = Field(default=None, description="0 … 1, a colour or a spectrum")
    print: FileName | None = Field(default=None, description="digits, a picture's path or asset:…")
    marks_mm: Annotated[tuple[tuple[Coordinate, Coordinate], ...], Field(max_length=64)] = Field(
        default=(), description="Centres of black dots on the print, from its middle"
    )
    mark_diameter_mm: Length | None = Field(default=None, description="Of the dots [default: 0.4]")
    shape: SurfaceShape = SurfaceShape(rectangle=Rectangle())

    @classmethod
    def before(cls, raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
        """Refuse dots on what is not printed."""
        yield from super().before(raw)
        if raw.get("print") is None and raw.get("marks_mm"):
            yield ("marks_mm",), "goes with print"
        if not raw.get("marks_mm") and raw.get("mark_diameter_mm") is not None:
            yield ("mark_diameter_mm",), "goes with marks_mm"

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse prints on shapes that take none, and rooms that are turned."""
        yield from super().after()
        if self.print is not None and self.print != "digits":
            reason = check_file_name(self.print, PICTURE_SUFFIXES)
            if reason is not None:
                yield ("print",), f"{reason}, or digits"
        if self.print is not None and self.shape.rectangle is None:
            yield ("shape", self.shape.kind), "a print is a rectangle"
        if self.print is not None and self.shape.rectangle is not None and self.shape.rectangle.height_mm is not None:
            yield ("shape", "rectangle", "height_mm"), "does not go with print: the height is the picture's"
        if self.shape.room is not None and (self.facing != (0.0, 0.0, 1.0) or self.up is not None):
            yield ("facing" if self.up is None else "up",), "does not go with a room: its walls stand along x, y, z"


def parallel(a: Point, b: Point) -> bool:
    """Tell whether two directions are parallel to 1e-9."""
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    lengths = sum(c * c for c in a) * sum(c * c for c in b)
    return sum(c * c for c in cross) <= 1e-18 * lengths
