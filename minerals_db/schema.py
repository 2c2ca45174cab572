"""What a mineral's data file holds.

Units stand in the field names; every number stands in a record with ``source`` and ``status``. Miller indices always
refer to the ``cell`` of the same entry, which is structural: the classical (morphological) ones, where they differ,
stand beside them for readers. The checks that need more than one field are here too, so that an entry which loads can
be trusted in its symmetry.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

import numpy as np
import numpy.typing as npt
from pydantic import Field, PrivateAttr, ValidationInfo, field_validator

from minerals_db.absorption import Absorption
from minerals_db.curve import FloatArray
from minerals_db.dispersion import AnyDispersion
from minerals_db.fields import Entry, Key, Status, Text
from minerals_db.indicatrix import SODIUM_D_NM, angle_about_gamma_deg
from minerals_db.morphology import Cell, Cleavage, Habit, Twin
from minerals_db.optical_rotation import OpticalRotation
from minerals_db.orientation import (
    AnyOrientation,
    MonoclinicOrientation,
    Orientation,
    OrthorhombicOrientation,
    TriclinicOrientation,
)
from minerals_db.properties import (
    Appearance,
    AxialAngle,
    AxialDispersion,
    Density,
    Hardness,
    Luminescence,
    Pleochroism,
    ThinSection,
)
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

__all__ = ["VARIETY_OWN", "Mineral", "Names", "Origin", "Source", "Status"]

TWO_V_BOUND_DEG = 5.0
"""How far the 2V of the indices may lie outside a measured interval before the entry must explain it. An error of
0.0005 in one index of a birefringence of 0.01 moves 2V by about as much."""

VARIETY_OWN = frozenset(
    {"id", "names", "variety_of", "appearance", "absorption", "pleochroism", "luminescence", "sources"}
)
"""The fields that a variety does not take from its mineral: its names, and what gives it its colour."""

Origin = Literal["built-in", "own"]

_ORIENTATIONS: Mapping[CrystalSystem, type[Orientation]] = {
    "orthorhombic": OrthorhombicOrientation,
    "monoclinic": MonoclinicOrientation,
    "triclinic": TriclinicOrientation,
}
_PLEOCHROIC_NAMES: Mapping[OpticalClass, frozenset[str]] = {
    "isotropic": frozenset(),
    "uniaxial": frozenset({"o", "e"}),
    "biaxial": frozenset({"alpha", "beta", "gamma"}),
}


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


class Mineral(Entry):
    """A mineral, a variety of one, a synthetic crystal or a glass."""

    id: Key
    names: Names
    kind: Literal["mineral", "synthetic", "glass"] = Field("mineral", description="A variety is of its mineral's kind")
    variety_of: Key | None = Field(None, description="The mineral whose fields it shares unless it states its own")
    group: Key | None = Field(None, description="The family it belongs to")
    formula: Text
    ima_status: Literal["approved", "grandfathered", "not-a-mineral"] | None = None
    strunz: Annotated[str, Field(pattern=r"^\d{1,2}\.[A-Z]{2}(\.\d{1,3}[a-z]?)?$")] | None = Field(
        None, description="Class of Strunz and Nickel, 9th ed."
    )
    system: CrystalSystem
    point_group: PointGroup | None = Field(None, validate_default=True, description="Crystal class; None of a glass")
    optical_class: OpticalClass
    cell: Cell | None = Field(None, validate_default=True, description="Of the structure; None of a glass")
    density: Density | None = None
    hardness: Hardness | None = None
    appearance: Appearance | None = None
    luminescence: Luminescence | None = None
    dispersion: Mapping[str, AnyDispersion] = Field(
        description="Principal refractive indices: n; o, e; by axis of the cell a, b, c; or alpha, beta, gamma, named "
        "by their order at the D line"
    )
    optic_sign: Literal["positive", "negative"] | None = Field(
        None, validate_default=True, description="Of the birefringence; None where isotropic"
    )
    orientation: AnyOrientation | None = Field(
        None, validate_default=True, description="Of the indicatrix of a biaxial crystal; None for others"
    )
    axial_angle: tuple[AxialAngle, ...] = Field((), description="Measured angles between the optic axes")
    axial_dispersion: AxialDispersion | None = None
    optical_rotation: OpticalRotation | None = Field(
        None, description="Optical activity; None if it has none or unknown"
    )
    absorption: Absorption | None = Field(None, description="None if colourless in a section, or unknown")
    pleochroism: Pleochroism | None = None
    cleavage: tuple[Cleavage, ...] = ()
    twinning: tuple[Twin, ...] = ()
    habits: tuple[Habit, ...] = ()
    thin_section: ThinSection | None = None
    sources: Mapping[Key, Source] = Field(description="Every source that this entry names, by key")

    _origin: Origin = PrivateAttr("built-in")

    @property
    def origin(self) -> Origin:
        """Whether the entry belongs to the package or to the user's own folder."""
        return self._origin

    @property
    def is_variety(self) -> bool:
        """Whether the entry describes a variety of a mineral that has an entry of its own."""
        return self.variety_of is not None

    def principal_axes(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the principal directions of the indicatrix in the crystal frame.

        Parameters
        ----------
        wavelength_nm : array_like, shape () or (N,)
            Vacuum wavelengths, nm.

        Returns
        -------
        float64 array, shape (3, 3), or (3, 3, N) where the axes turn with N wavelengths
            A right-handed frame: row i is the direction of the i-th curve of a biaxial crystal. Uniaxial: the last row
            is the optic axis, along c. Isotropic: any frame serves, and the crystal's own is given.
        """
        return self._axes(self.orientation, wavelength_nm)

    def absorption_axes(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the principal directions of absorption in the crystal frame, in the manner of `principal_axes`.

        They are those of the indicatrix, unless the entry gives the absorption a frame of its own, as symmetry allows
        in monoclinic and triclinic crystals.
        """
        own = self.absorption.frame if self.absorption is not None else None
        return self._axes(own or self.orientation, wavelength_nm)

    def _axes(self, orientation: Orientation | None, wavelength_nm: npt.ArrayLike) -> FloatArray:
        if isinstance(orientation, MonoclinicOrientation):
            assert self.cell is not None  # every monoclinic entry has one
            return orientation.axes(self.cell.beta_deg, wavelength_nm)
        if isinstance(orientation, TriclinicOrientation):
            return orientation.axes()
        return np.eye(3)

    @field_validator("point_group")
    @classmethod
    def _point_group_fits(cls, group: PointGroup | None, info: ValidationInfo) -> PointGroup | None:
        system: CrystalSystem | None = info.data.get("system")
        if system is None:
            return group
        if (group is None) != (system == "amorphous"):
            raise ValueError("a crystal belongs to one of the 32 classes, and a glass to none")
        if group is not None and group not in POINT_GROUPS[system]:
            raise ValueError(f"{group} is no {system} class; those are {', '.join(POINT_GROUPS[system])}")
        return group

    @field_validator("optical_class")
    @classmethod
    def _optical_class_fits(cls, optical_class: OpticalClass, info: ValidationInfo) -> OpticalClass:
        system: CrystalSystem | None = info.data.get("system")
        if system is not None and optical_class != OPTICAL_CLASS[system]:
            what = "a glass is" if system == "amorphous" else f"{system} crystals are"
            raise ValueError(f"{what} {OPTICAL_CLASS[system]}, not {optical_class}")
        return optical_class

    @field_validator("cell")
    @classmethod
    def _cell_fits(cls, cell: Cell | None, info: ValidationInfo) -> Cell | None:
        system: CrystalSystem | None = info.data.get("system")
        if system is None:
            return cell
        if (cell is None) != (system == "amorphous"):
            raise ValueError("a crystal has a cell, and a glass has none")
        if cell is None:
            return None
        shape = CELL_SHAPE[system]
        wrong = [
            f"{name} must be {angle:g}, not {getattr(cell, name):g}"
            for name, angle in shape.angles.items()
            if angle is not None and getattr(cell, name) != angle
        ]
        if len({getattr(cell, name) for name in shape.equal}) > 1:
            wrong.append(f"{' and '.join(shape.equal)} must be equal")
        if system == "monoclinic" and cell.beta_deg < 90.0:
            wrong.append(f"beta_deg must be the obtuse angle, not {cell.beta_deg:g}")
        if wrong:
            raise ValueError(f"not a {system} cell: {'; '.join(wrong)}")
        return cell

    @field_validator("dispersion")
    @classmethod
    def _curves_fit(cls, dispersion: Mapping[str, AnyDispersion], info: ValidationInfo) -> Mapping[str, AnyDispersion]:
        system: CrystalSystem | None = info.data.get("system")
        if system is None:
            return dispersion
        wanted = PRINCIPAL_AXES[system]
        if set(dispersion) != set(wanted):
            has = "minerals have" if system != "amorphous" else "materials have"
            raise ValueError(
                f"{system} {has} the {'index' if len(wanted) == 1 else 'indices'} {', '.join(wanted)}, "
                f"not {', '.join(sorted(dispersion))}"
            )
        if wanted == ("alpha", "beta", "gamma"):
            _must_rise({axis: float(dispersion[axis].index(SODIUM_D_NM)) for axis in wanted})
        return {axis: dispersion[axis] for axis in wanted}

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
        told = ", ".join(f"n_{axis} is {value:.5f}" for axis, value in n.items())
        if optical_class == "uniaxial" and n["o"] != n["e"] and (n["e"] > n["o"]) != (sign == "positive"):
            raise ValueError(f"{sign}, but {told} at {SODIUM_D_NM} nm")
        if optical_class == "biaxial" and (angle_about_gamma_deg(sorted(n.values())) < 90.0) != (sign == "positive"):
            raise ValueError(f"{sign}, but {told} at {SODIUM_D_NM} nm")
        return sign

    @field_validator("orientation")
    @classmethod
    def _orientation_agrees(cls, orientation: Orientation | None, info: ValidationInfo) -> Orientation | None:
        system: CrystalSystem | None = info.data.get("system")
        dispersion: Mapping[str, AnyDispersion] | None = info.data.get("dispersion")
        if system is None:
            return orientation
        wanted = _ORIENTATIONS.get(system)
        if wanted is None:
            if orientation is not None:
                raise ValueError(f"a {system} crystal has none: symmetry fixes its indicatrix")
            return None
        if not isinstance(orientation, wanted):
            fields = ", ".join(name for name in wanted.model_fields if name not in ("source", "status", "note"))
            raise ValueError(f"{system} minerals have an orientation with the fields {fields}")
        if isinstance(orientation, OrthorhombicOrientation) and dispersion is not None:
            axes = (orientation.alpha, orientation.beta, orientation.gamma)
            _must_rise({axis: float(dispersion[axis].index(SODIUM_D_NM)) for axis in axes})
        return orientation

    @field_validator("axial_angle")
    @classmethod
    def _axial_angle_agrees(cls, angles: tuple[AxialAngle, ...], info: ValidationInfo) -> tuple[AxialAngle, ...]:
        optical_class: OpticalClass | None = info.data.get("optical_class")
        dispersion: Mapping[str, AnyDispersion] | None = info.data.get("dispersion")
        if angles and optical_class not in ("biaxial", None):
            raise ValueError(f"a {optical_class} crystal has no two optic axes")
        if dispersion is None or optical_class is None:
            return angles
        for number, angle in enumerate(angles):
            at = angle.wavelength_nm or SODIUM_D_NM
            about_gamma = float(angle_about_gamma_deg(sorted(float(curve.index(at)) for curve in dispersion.values())))
            ours = about_gamma if angle.bisectrix == "gamma" else 180.0 - about_gamma
            lowest, highest = angle.two_v_deg
            outside = max(lowest - ours, ours - highest, 0.0)
            if (outside > TWO_V_BOUND_DEG) != (angle.disagreement is not None):
                told = f"entry {number}: the indices give 2V_{angle.bisectrix} = {ours:.1f} at {at:g} nm"
                raise ValueError(
                    f"{told}, {outside:.1f} outside the interval; more than {TWO_V_BOUND_DEG:g} needs a disagreement"
                    if angle.disagreement is None
                    else f"{told}, which agrees: the disagreement is none"
                )
        return angles

    @field_validator("axial_dispersion")
    @classmethod
    def _is_biaxial(cls, dispersion: AxialDispersion | None, info: ValidationInfo) -> AxialDispersion | None:
        if dispersion is not None and info.data.get("optical_class") not in ("biaxial", None):
            raise ValueError(f"a {info.data['optical_class']} crystal has no angle between optic axes")
        if dispersion is not None and dispersion.kind is not None and info.data.get("system") != "monoclinic":
            raise ValueError("only the bisectrices of a monoclinic crystal disperse in one of these ways")
        return dispersion

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

    @field_validator("absorption")
    @classmethod
    def _absorption_fits(cls, absorption: Absorption | None, info: ValidationInfo) -> Absorption | None:
        system: CrystalSystem | None = info.data.get("system")
        if absorption is None or system is None:
            return absorption
        wanted = PRINCIPAL_AXES[system]
        for part in absorption.parts:
            if set(part.axes) != set(wanted):
                raise ValueError(f"{part.name}: a {system} crystal absorbs along {', '.join(wanted)}")
        if absorption.frame is not None and (
            system not in ("monoclinic", "triclinic") or not isinstance(absorption.frame, _ORIENTATIONS[system])
        ):
            raise ValueError(f"symmetry leaves the absorption of a {system} crystal no such frame of its own")
        return absorption

    @field_validator("pleochroism")
    @classmethod
    def _names_directions(cls, pleochroism: Pleochroism | None, info: ValidationInfo) -> Pleochroism | None:
        optical_class: OpticalClass | None = info.data.get("optical_class")
        if pleochroism is None or optical_class is None:
            return pleochroism
        strange = sorted(set(pleochroism.colours) - _PLEOCHROIC_NAMES[optical_class])
        if strange:
            raise ValueError(f"a {optical_class} crystal has no direction {', '.join(strange)}")
        return pleochroism

    @field_validator("habits")
    @classmethod
    def _habits_have_names(cls, habits: tuple[Habit, ...]) -> tuple[Habit, ...]:
        names = [habit.name for habit in habits]
        if len(set(names)) < len(names):
            raise ValueError(f"each habit has a name of its own, not twice {max(names, key=names.count)}")
        return habits


def _must_rise(indices: Mapping[str, float]) -> None:
    """Raise where indices, named α, β, γ in this order, do not rise at the D line."""
    if list(indices.values()) != sorted(indices.values()):
        told = ", ".join(f"n_{axis} is {value:.5f}" for axis, value in indices.items())
        raise ValueError(f"the indices must rise from alpha to gamma, but {told} at {SODIUM_D_NM} nm")
