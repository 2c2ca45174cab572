"""The shapes of crystals: cell, forms, cleavage, twins. Miller indices refer to the axes of the entry's cell."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from minerals_db.fields import Entry, Known, Positive, Text

__all__ = ["Cell", "Cleavage", "Form", "Habit", "Hkl", "Twin"]

Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0.0, lt=180.0)]
Length = Annotated[
    float, Field(strict=True, allow_inf_nan=False, ge=1.0, le=200.0)
]  # in Å: nm or pm in their place fall outside
_Index = Annotated[int, Field(strict=True)]


def _not_zero(indices: tuple[int, int, int]) -> tuple[int, int, int]:
    if indices == (0, 0, 0):
        raise ValueError("(0 0 0) is no direction")
    return indices


Hkl = Annotated[tuple[_Index, _Index, _Index], AfterValidator(_not_zero)]
"""Three integers, not all zero."""


class Cell(Known):
    """The unit cell of the structure."""

    a_angstrom: Length
    b_angstrom: Length
    c_angstrom: Length
    alpha_deg: Angle
    beta_deg: Angle
    gamma_deg: Angle
    space_group: Text = Field(description="Hermann-Mauguin symbol in the setting of the cell")


class Cleavage(Known):
    """A form along whose faces the crystal cleaves."""

    hkl: Hkl = Field(description="Miller indices of one face, on the axes of the cell")
    morphological_hkl: Hkl | None = Field(None, description="The classical indices, where the axes differ")
    quality: Literal["perfect", "good", "distinct", "imperfect", "poor"]


class Twin(Known):
    """A law by which two individuals grow together."""

    law: Text = Field(description="Its name")
    plane_hkl: Hkl | None = Field(None, description="Twin plane: one individual mirrors the other in it")
    axis_uvw: Hkl | None = Field(None, description="Twin axis, a zone axis of the cell: half a turn about it")
    description: Text | None = None

    @model_validator(mode="after")
    def _has_one_element(self) -> Self:
        if (self.plane_hkl is None) == (self.axis_uvw is None):
            raise ValueError("give either plane_hkl or axis_uvw")
        return self


class Form(Entry):
    """All faces that symmetry makes of one, at the same distance from the centre."""

    hkl: Hkl
    name: Text | None = Field(None, description="Its letter or name")
    central_distance: Positive = Field(description="Of its faces, relative to the other forms of the habit")


class Habit(Known):
    """A typical shape: forms that close a polyhedron."""

    name: Text
    forms: tuple[Form, ...] = Field(min_length=1)
