"""Bodies: what has a volume. A crystal specimen, a piece of glass, a drop of oil."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Annotated, Any

from pydantic import Field

from crystal_core.errors import InputError
from crystal_core.scene.media import Made
from crystal_core.scene.orientation import Indices, Orientation, Turn
from crystal_core.scene.parts import Choice, Coordinate, Location, Name
from crystal_core.scene.shapes import Shape
from crystal_core.scene.specimen import habit_of, twin_law

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
    composition_hkl: Indices | None = Field(
        default=None, description="Plane in which the two meet [default: the twin plane, or one along the axis]"
    )


class Body(Made):
    """A body: what it is made of, its shape, how its crystal stands and where it is.

    The body is made, turned by `turns` about its centre, one after the other, and moved to its place. The centre is the
    middle of the shape's own frame: the centroid of a crystal.
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
        description="Of the centre, from the origin, or from the centre of the body that it is inside or joined to: "
        "[x, y, z]; [x, y] with rests_on [default: 0]",
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
        if self.twin is not None and self.shape.habit is None:
            yield ("twin",), "goes with the shape habit"
        if entry is None or not has_cell:
            return
        habit = self.shape.habit
        if habit is not None and habit.forms is None:
            place: Location = ("shape", "habit") if habit.name is None else ("shape", "habit", "name")
            yield from _refused(place, lambda: habit_of(entry, habit.name))
        if self.twin is not None and self.twin.law is not None:
            law = self.twin.law
            yield from _refused(("twin", "law"), lambda: twin_law(entry, law))

    @property
    def depends_on(self) -> str | None:
        """Name of what its place counts from: what it rests on, its host, or what it is joined to."""
        return self.rests_on or self.inside or self.joined_to

    @property
    def gap(self) -> float:
        """Height of the lowest point above what it rests on, mm."""
        return GAP_MM if self.gap_mm is None else self.gap_mm


def _refused(place: Location, look_up: Callable[[], object]) -> Iterator[tuple[Location, str]]:
    """Yield the reason why a look-up in the entry fails, if it does."""
    try:
        look_up()
    except InputError as error:
        yield place, error.faults[0].message
