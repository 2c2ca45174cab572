"""What a mineral's data file holds.

Units stand in the field names; every number stands in a record with ``source`` and ``status``. Miller indices always
refer to the ``cell`` of the same entry, which is structural: the classical (morphological) ones, where they differ,
stand beside them for readers. The checks that need more than one field are here too, so that an entry which loads can
be trusted in its symmetry.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from minerals_db.dispersion import AnyDispersion
from minerals_db.fields import Entry, Key, Known, Positive, Status, Text
from minerals_db.optical_rotation import OpticalRotation
from minerals_db.symmetry import (
    CELL_SHAPE,
    GYROTROPIC_ALONG_AXIS,
    OPTICAL_CLASS,
    POINT_GROUPS,
    PRINCIPAL_AXES,
    CrystalSystem,
    OpticalClass,
    PointGroup,
)

__all__ = ["SODIUM_D_NM", "Cell", "Cleavage", "Mineral", "Names", "Orientation", "Source", "Status"]

SODIUM_D_NM = 589.3
"""The wavelength at which optic signs and orientations are checked: the mean of the sodium D lines, nm."""

Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0.0, lt=180.0)]
CrystalAxis = Literal["a", "b", "c"]
Hkl = tuple[Annotated[int, Field(strict=True)], Annotated[int, Field(strict=True)], Annotated[int, Field(strict=True)]]


class Source(Entry):
    """Where numbers come from, and on what terms they may be used."""

    citation: Text = Field(description="The primary source, as one would print it")
    doi: Annotated[str, Field(pattern=r"^10\.\d{4,9}/\S+$")] | None = None
    url: Annotated[str, Field(pattern=r"^https?://\S+$")] | None = None
    via: Key | None = Field(
        None, description="Key of the collection that carries the numbers, if not the source itself"
    )
    licence: Text = Field(description="Terms of use; bare facts and numbers carry none")


class Names(Entry):
    """What people call the mineral."""

    en: Text
    ru: Text


class Cell(Known):
    """The unit cell of the structure."""

    a_angstrom: Positive
    b_angstrom: Positive
    c_angstrom: Positive
    alpha_deg: Angle
    beta_deg: Angle
    gamma_deg: Angle
    space_group: Text = Field(description="Hermann-Mauguin symbol in the setting of the cell")


class Cleavage(Known):
    """A form along whose faces the crystal cleaves."""

    hkl: Hkl = Field(description="Miller indices of one face, on the axes of the cell")
    morphological_hkl: Hkl | None = Field(None, description="The classical indices, where the axes differ")
    quality: Literal["perfect", "good", "distinct", "imperfect", "poor"]

    @field_validator("hkl", "morphological_hkl")
    @classmethod
    def _is_a_face(cls, hkl: tuple[int, int, int] | None) -> tuple[int, int, int] | None:
        if hkl == (0, 0, 0):
            raise ValueError("(0 0 0) is no face")
        return hkl


class Orientation(Known):
    """Which axis of the cell waves of each principal index vibrate along, at the D line: X, Y, Z of mineralogists.

    The curves of `dispersion` are keyed by the same axes, so that this says again what they say; it carries the source
    of the orientation, which is seldom that of the indices. The axes are those of `cell`: settings differ in books.
    """

    alpha: CrystalAxis = Field(description="Axis of the smallest index, X")
    beta: CrystalAxis = Field(description="Axis of the middle index, Y")
    gamma: CrystalAxis = Field(description="Axis of the largest index, Z")

    @model_validator(mode="after")
    def _names_each_axis_once(self) -> Self:
        if len({self.alpha, self.beta, self.gamma}) != 3:
            raise ValueError(
                f"alpha, beta, gamma must be a, b, c in some order, not {self.alpha}{self.beta}{self.gamma}"
            )
        return self


class Mineral(Entry):
    """A mineral or a variety of one."""

    id: Key
    names: Names
    formula: Text
    system: CrystalSystem
    point_group: PointGroup
    optical_class: OpticalClass
    cell: Cell
    dispersion: Mapping[str, AnyDispersion] = Field(
        description="Principal refractive indices: n; o and e; or by crystal axis a, b, c"
    )
    optic_sign: Literal["positive", "negative"] | None = Field(
        None, validate_default=True, description="Of the birefringence; None where isotropic"
    )
    orientation: Orientation | None = Field(
        None, validate_default=True, description="Of the indicatrix of an orthorhombic mineral; None for others"
    )
    optical_rotation: OpticalRotation | None = Field(
        None, description="Optical activity; None if it has none or unknown"
    )
    cleavage: tuple[Cleavage, ...] = ()
    sources: Mapping[Key, Source] = Field(description="Every source that this entry names, by key")

    @field_validator("point_group")
    @classmethod
    def _point_group_fits(cls, group: PointGroup, info: ValidationInfo) -> PointGroup:
        system: CrystalSystem | None = info.data.get("system")
        if system is not None and group not in POINT_GROUPS[system]:
            raise ValueError(f"{group} is no {system} class; those are {', '.join(POINT_GROUPS[system])}")
        return group

    @field_validator("optical_class")
    @classmethod
    def _optical_class_fits(cls, optical_class: OpticalClass, info: ValidationInfo) -> OpticalClass:
        system: CrystalSystem | None = info.data.get("system")
        if system is not None and optical_class != OPTICAL_CLASS[system]:
            raise ValueError(f"{system} crystals are {OPTICAL_CLASS[system]}, not {optical_class}")
        return optical_class

    @field_validator("cell")
    @classmethod
    def _cell_fits(cls, cell: Cell, info: ValidationInfo) -> Cell:
        system: CrystalSystem | None = info.data.get("system")
        if system is None:
            return cell
        shape = CELL_SHAPE[system]
        wrong = [
            f"{name} must be {angle:g}, not {getattr(cell, name):g}"
            for name, angle in shape.angles.items()
            if angle is not None and getattr(cell, name) != angle
        ]
        if len({getattr(cell, name) for name in shape.equal}) > 1:
            wrong.append(f"{' and '.join(shape.equal)} must be equal")
        if wrong:
            raise ValueError(f"not a {system} cell: {'; '.join(wrong)}")
        return cell

    @field_validator("dispersion")
    @classmethod
    def _axes_fit(cls, dispersion: Mapping[str, AnyDispersion], info: ValidationInfo) -> Mapping[str, AnyDispersion]:
        system: CrystalSystem | None = info.data.get("system")
        if system is None:
            return dispersion
        if system not in PRINCIPAL_AXES:
            raise ValueError(f"{system} indices need an orientation of the indicatrix, which entries cannot give yet")
        if set(dispersion) != PRINCIPAL_AXES[system]:
            wanted = ", ".join(sorted(PRINCIPAL_AXES[system], reverse=system != "orthorhombic"))
            raise ValueError(f"{system} minerals have the indices {wanted}, not {', '.join(sorted(dispersion))}")
        return dispersion

    @field_validator("optic_sign")
    @classmethod
    def _sign_agrees(cls, sign: str | None, info: ValidationInfo) -> str | None:
        optical_class: OpticalClass | None = info.data.get("optical_class")
        dispersion: Mapping[str, AnyDispersion] | None = info.data.get("dispersion")
        if optical_class == "isotropic" and sign is not None:
            raise ValueError("an isotropic mineral has no optic sign")
        if optical_class in ("uniaxial", "biaxial") and sign is None:
            raise ValueError(f"a {optical_class} mineral has an optic sign, positive or negative")
        if dispersion is None or optical_class == "isotropic":
            return sign
        n = {axis: float(curve.index(SODIUM_D_NM)) for axis, curve in dispersion.items()}
        told = ", ".join(f"n_{axis} is {n[axis]:.5f}" for axis in sorted(n, reverse="o" in n))
        if optical_class == "uniaxial" and n["o"] != n["e"] and (n["e"] > n["o"]) != (sign == "positive"):
            raise ValueError(f"{sign}, but {told} at {SODIUM_D_NM} nm")
        if optical_class == "biaxial" and _is_biaxial_positive(tuple(n.values())) != (sign == "positive"):
            raise ValueError(f"{sign}, but {told} at {SODIUM_D_NM} nm")
        return sign

    @field_validator("orientation")
    @classmethod
    def _orientation_agrees(cls, orientation: Orientation | None, info: ValidationInfo) -> Orientation | None:
        system: CrystalSystem | None = info.data.get("system")
        dispersion: Mapping[str, AnyDispersion] | None = info.data.get("dispersion")
        if system is None or dispersion is None:
            return orientation
        if (system == "orthorhombic") != (orientation is not None):
            raise ValueError("an orthorhombic mineral has an orientation, and no other has")
        if orientation is not None:
            axes = (orientation.alpha, orientation.beta, orientation.gamma)
            n = [float(dispersion[axis].index(SODIUM_D_NM)) for axis in axes]
            if n != sorted(n):
                told = ", ".join(f"n_{axis} is {value:.5f}" for axis, value in zip(axes, n, strict=True))
                raise ValueError(f"the indices must rise from alpha to gamma, but {told} at {SODIUM_D_NM} nm")
        return orientation

    @field_validator("optical_rotation")
    @classmethod
    def _symmetry_allows_rotation(
        cls, rotation: OpticalRotation | None, info: ValidationInfo
    ) -> OpticalRotation | None:
        group: PointGroup | None = info.data.get("point_group")
        if rotation is not None and group is not None and group not in GYROTROPIC_ALONG_AXIS:
            allowed = ", ".join(sorted(GYROTROPIC_ALONG_AXIS))
            raise ValueError(f"class {group} turns nothing along an optic axis; those that do are {allowed}")
        return rotation


def _is_biaxial_positive(indices: tuple[float, ...]) -> bool:
    """Tell whether γ is the acute bisectrix, tan² V_z = (α⁻² − β⁻²)/(β⁻² − γ⁻²) < 1 (Born & Wolf, §15.3.3, eq. 11)."""
    alpha, beta, gamma = sorted(indices)
    return alpha**-2 - beta**-2 < beta**-2 - gamma**-2
