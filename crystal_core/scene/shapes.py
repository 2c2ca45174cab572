"""Shapes of bodies: habits and cleavage bodies of the lattice, cuts, meshes of one's own.

Lattice shapes stand in the crystal frame, cuts and meshes in their own frame, centred on its origin.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag

from crystal_core.scene.orientation import Indices
from crystal_core.scene.parts import BRANCH, Choice, FileName, Length, Location, Part, Positive

__all__ = [
    "MESH_SUFFIXES",
    "Box",
    "Brilliant",
    "Cabochon",
    "Cleavage",
    "Column",
    "Form",
    "Habit",
    "MeshFile",
    "Plate",
    "Prism",
    "Shape",
    "Sphere",
    "StepCut",
    "Wedge",
    "check_file_name",
]

MESH_SUFFIXES = (".obj", ".ply", ".stl", ".glb", ".gltf")

_Pair = tuple[Length, Length]
_Percent = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=100)]
_Slope = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, lt=90)]
_EdgeMicrometres = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1e6)]
_Micrometres = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.1, le=1e6)]


def check_file_name(name: str, suffixes: tuple[str, ...]) -> str | None:
    """Return what is wrong with the name of a file, None if nothing is."""
    if name.startswith("asset:"):
        digest = name.removeprefix("asset:")
        if len(digest) == 64 and set(digest) <= set("0123456789abcdef"):
            return None
        return "an asset is named asset: and the 64 hex digits of its sha256"
    if not name.lower().endswith(suffixes):
        return f"must be a file {', '.join(suffixes)}, or an asset:…"
    if name.startswith(("/", "\\", "~")) or ":" in name or "\0" in name:
        return "must be a path relative to the file of the scene"
    return None


class Form(Part):
    """All faces that symmetry makes of one, at one distance from the centre."""

    hkl: Indices
    central_distance: Positive = 1.0


class Habit(Choice):
    """A grown crystal: a habit of the mineral's entry [default: its first], or forms of one's own."""

    choices = ("name", "forms")
    optional_choice = True

    name: Annotated[str, Field(strict=True, min_length=1, max_length=200)] | None = None
    forms: Annotated[tuple[Form, ...], Field(min_length=1, max_length=100)] | None = None
    size_mm: Length = Field(default=20.0, description="Greatest distance between two corners")


def _several(value: object) -> object:
    return (value,) if isinstance(value, int | float) and not isinstance(value, bool) else value


class Cleavage(Part):
    """A body between cleavage planes of the mineral."""

    hkl: Indices | None = Field(
        default=None, description="One plane of the cleavage [default: the entry's best that encloses a body]"
    )

    spacing_mm: Annotated[
        tuple[Length, ...],
        Field(min_length=1, max_length=12),
        BeforeValidator(_several, json_schema_input_type=Length | tuple[Length, ...]),
    ] = Field(default=(20.0,), description="Between the faces of each parallel pair; one number: of all pairs")


class Box(Part):
    """A rectangular block."""

    size_mm: tuple[Length, Length, Length] = (20.0, 20.0, 20.0)


def _tell_plate(value: object) -> str:
    return BRANCH + ("pair" if isinstance(value, list | tuple) else "diameter")


class Plate(Part):
    """A plane-parallel plate, its faces horizontal: thickness in µm."""

    size_mm: Annotated[
        Annotated[Length, Tag(BRANCH + "diameter")] | Annotated[_Pair, Tag(BRANCH + "pair")],
        Discriminator(_tell_plate),
    ] = Field(default=20.0, description="Diameter of a round plate, or lengths along x and y")
    thickness_um: _Micrometres


class Wedge(Part):
    """A wedge on a horizontal face, its thickness growing along x from the first value to the second."""

    size_mm: _Pair = (30.0, 10.0)
    thickness_um: tuple[_EdgeMicrometres, _Micrometres] = Field(description="At the ends −x and +x")

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse a wedge that does not grow."""
        if self.thickness_um[0] >= self.thickness_um[1]:
            yield ("thickness_um",), "the thickness must grow: a plate has one, a wedge two rising values"


class Prism(Part):
    """A three-sided prism along y, its base down and its edge of refraction up."""

    apex_deg: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1, le=170)] = 60.0
    side_mm: Length = Field(default=30.0, description="Of the two faces that meet at the apex, in the cross-section")
    length_mm: Length = 40.0


class Column(Part):
    """A regular upright prism."""

    sides: Annotated[int, Field(strict=True, ge=3, le=128)] = 6
    diameter_mm: Length = Field(default=20.0, description="Of the circle through its corners")
    length_mm: Length = 30.0


class Sphere(Part):
    """A sphere."""

    diameter_mm: Length = 20.0


class Cabochon(Part):
    """A dome over a flat base, its outline an ellipse with axes x and y; the dome is up.

    An ellipsoid's sides are upright at the base, those of a cap, which a plane cuts off a stretched sphere, lean.
    """

    size_mm: _Pair = (12.0, 10.0)
    height_mm: Length = 5.0
    profile: Literal["ellipsoid", "cap"] = "ellipsoid"


class Brilliant(Part):
    """A round brilliant of 57 facets, its table up; single proportions replace those of the named set.

    Percentages are of the diameter.
    """

    diameter_mm: Length = 6.5
    proportions: Literal["tolkowsky", "modern"] = "tolkowsky"
    table_percent: _Percent | None = None
    crown_deg: _Slope | None = None
    pavilion_deg: _Slope | None = None
    girdle_percent: _Percent | None = None
    star_percent: _Percent | None = None
    lower_half_percent: _Percent | None = None
    culet_percent: _Percent | None = None
    girdle_facets: Annotated[int, Field(strict=True, ge=16, le=128, multiple_of=16)] | None = None


class StepCut(Part):
    """A step (emerald) cut with its table up; angles are those of the steps, from the girdle on.

    Percentages are of the width, the smaller side. What is left out is that of a usual cut.
    """

    size_mm: _Pair = (9.0, 7.0)
    table_percent: _Percent | None = None
    crown_deg: Annotated[tuple[_Slope, ...], Field(min_length=1, max_length=8)] | None = None
    pavilion_deg: Annotated[tuple[_Slope, ...], Field(min_length=1, max_length=8)] | None = None
    girdle_percent: _Percent | None = None
    corner_percent: _Percent | None = None


class MeshFile(Part):
    """A mesh of one's own: closed, oriented triangles."""

    file: FileName
    size_mm: Length | None = Field(
        default=None, description="Greatest distance between two corners [default: the file's numbers are mm]"
    )

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse names that are no mesh's."""
        reason = check_file_name(self.file, MESH_SUFFIXES)
        if reason is not None:
            yield ("file",), reason


class Shape(Choice):
    """The shape of a body, one of several."""

    choices = (
        "habit",
        "cleavage",
        "box",
        "plate",
        "wedge",
        "prism",
        "column",
        "sphere",
        "cabochon",
        "brilliant",
        "step_cut",
        "mesh",
    )

    habit: Habit | None = None
    cleavage: Cleavage | None = None
    box: Box | None = None
    plate: Plate | None = None
    wedge: Wedge | None = None
    prism: Prism | None = None
    column: Column | None = None
    sphere: Sphere | None = None
    cabochon: Cabochon | None = None
    brilliant: Brilliant | None = None
    step_cut: StepCut | None = None
    mesh: MeshFile | None = None

    @property
    def grows(self) -> bool:
        """Whether the lattice makes the faces: they turn with the crystal."""
        return self.kind in {"habit", "cleavage"}
