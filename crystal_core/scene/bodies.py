"""Bodies: what has a volume. A crystal specimen, a piece of glass, a drop of oil."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import Field

import minerals_db
from crystal_core.scene.media import Made
from crystal_core.scene.orientation import Indices, Orientation, Turn
from crystal_core.scene.parts import Choice, Coordinate, Location, Name
from crystal_core.scene.shapes import Shape

__all__ = ["GAP_MM", "Body", "Twin"]

GAP_MM = 0.02
"""Of air under a body that rests on something: optical contact is not had by laying one thing on another."""


class Twin(Choice):
    """A second individual in contact: by a law of the mineral's entry, or by its twin element."""

    choices = ("law", "plane_hkl", "axis_uvw")

    law: Annotated[str, Field(strict=True, min_length=1, max_length=200)] | None = Field(
        default=None, description="Name of a law of the entry"
    )
    plane_hkl: Indices | None = Field(default=None, description="Twin plane: one individual mirrors the other in it")
    axis_uvw: Indices | None = Field(default=None, description="Twin axis: half a turn about it")
    contact_hkl: Indices | None = Field(
        default=None, description="Plane through the centre in which the two meet [default: the twin plane]"
    )

    def after(self) -> Iterator[tuple[Location, str]]:
        """Ask where the individuals of a twin by an axis meet."""
        if self.axis_uvw is not None and self.contact_hkl is None:
            yield ("contact_hkl",), "required with axis_uvw: the plane in which the two individuals meet"


class Body(Made):
    """A body: what it is made of, its shape, how its crystal stands and where it is.

    The body is made, turned by `turns` about its centre, one after the other, and moved to its place.
    """

    shape: Shape
    twin: Twin | None = None
    orientation: Orientation | None = Field(
        default=None,
        description="How the crystal stands; a grown or cleaved body stands with it, a cut or mesh does not",
    )
    turns: Annotated[tuple[Turn, ...], Field(max_length=20)] = ()
    position_mm: Annotated[tuple[Coordinate, ...], Field(min_length=2, max_length=3)] | None = Field(
        default=None,
        description="Of the centre: [x, y, z], or [x, y] with rests_on [default: the origin]",
    )
    rests_on: Name | None = Field(default=None, description="A horizontal surface, or a body on whose top it lies")
    gap_mm: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=1000)] | None = Field(
        default=None, description=f"Of air under a body that rests on something [default: {GAP_MM}]"
    )
    inside: Name | None = Field(default=None, description="The body that surrounds this one wholly")
    joined_to: Name | None = Field(default=None, description="The body that one face of this one is cemented to")

    @classmethod
    def before(cls, raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
        """Refuse keys that do not go together."""
        yield from super().before(raw)
        if raw.get("rests_on") is None and raw.get("gap_mm") is not None:
            yield ("gap_mm",), "goes with rests_on"
        if raw.get("rests_on") is not None:
            for key in ("inside", "joined_to"):
                if raw.get(key) is not None:
                    yield (key,), "does not go with rests_on: give its position_mm"
        if raw.get("inside") is not None and raw.get("joined_to") is not None:
            yield ("joined_to",), "does not go with inside"

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse a lattice shape, a direction or a twin without the entry that it needs."""
        faults = list(super().after())
        yield from faults
        wanted, reason = (2, "a body that rests on something finds its own z") if self.rests_on else (3, "give x, y, z")
        if self.position_mm is not None and len(self.position_mm) != wanted:
            yield ("position_mm",), f"must have {wanted} numbers: {reason}"
        if not faults:
            yield from self._lattice_faults()

    def _lattice_faults(self) -> Iterator[tuple[Location, str]]:
        entry = self.entry
        has_cell = entry is not None and entry.cell is not None
        who = self.mineral or "a medium by its indices"
        if self.shape.grows and not has_cell:
            yield ("shape", self.shape.kind), f"{who} has no lattice: give it a cut"
        for axis in ("x", "y", "z"):
            direction = None if self.orientation is None else getattr(self.orientation, axis)
            if direction is not None and direction.kind in {"hkl", "uvw"} and not has_cell:
                yield ("orientation", axis, direction.kind), f"{who} has no lattice"
        habit = self.shape.habit
        if entry is not None and habit is not None and has_cell and habit.forms is None:
            names = [known.name for known in entry.habits]
            if not names:
                yield ("shape", "habit"), f"{self.mineral} has no habit in its entry: give forms"
            elif habit.name is not None and habit.name not in names:
                yield ("shape", "habit", "name"), f"{self.mineral} has no such habit; it has {', '.join(names)}"
        if self.twin is not None:
            if habit is None or entry is None:
                yield ("twin",), "goes with the shape habit"
            elif self.twin.law is not None:
                yield from self._law_faults(self.twin.law, entry)

    def _law_faults(self, wanted: str, entry: minerals_db.Mineral) -> Iterator[tuple[Location, str]]:
        assert self.twin is not None
        law = next((twin for twin in entry.twinning if twin.law == wanted), None)
        if law is None:
            laws = ", ".join(twin.law for twin in entry.twinning)
            yield ("twin", "law"), f"{self.mineral} has no such law; {f'it has {laws}' if laws else 'none is known'}"
        elif law.axis_uvw is not None and self.twin.contact_hkl is None:
            yield ("twin", "contact_hkl"), "required with a twin axis: the plane in which the two individuals meet"

    @property
    def gap(self) -> float:
        """Height of the lowest point above what it rests on, mm."""
        return GAP_MM if self.gap_mm is None else self.gap_mm
