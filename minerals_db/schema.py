"""What a mineral's data file holds.

Units stand in the field names; every number stands in a record with ``source`` and ``status``. Miller indices always
refer to the ``cell`` of the same entry, which is structural: the classical (morphological) ones, where they differ,
stand beside them for readers. The checks that need more than one field are here too, so that an entry which loads can
be trusted in its symmetry.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from minerals_db.dispersion import AnyDispersion
from minerals_db.fields import Entry, Key, Known, Positive, Status, Text
from minerals_db.symmetry import (
    CELL_SHAPE,
    OPTICAL_CLASS,
    POINT_GROUPS,
    PRINCIPAL_AXES,
    CrystalSystem,
    OpticalClass,
    PointGroup,
)

__all__ = ["SODIUM_D_NM", "Cell", "Cleavage", "Mineral", "Names", "Source", "Status"]

SODIUM_D_NM = 589.3
"""The wavelength at which optic signs are checked: the mean of the sodium D lines, nm."""

Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0.0, lt=180.0)]
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
        if optical_class == "uniaxial" and dispersion is not None:
            n_o, n_e = (float(dispersion[axis].index(SODIUM_D_NM)) for axis in ("o", "e"))
            if n_o != n_e and (n_e > n_o) != (sign == "positive"):
                raise ValueError(f"{sign}, but n_o is {n_o:.5f} and n_e is {n_e:.5f} at {SODIUM_D_NM} nm")
        return sign
