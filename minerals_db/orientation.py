"""How the axes of the indicatrix, or of the absorption, lie in the crystal.

**Crystal frame.** Right-handed, x ∥ a, z ∥ c*, y = z × x (so that y ∥ b in a monoclinic crystal). The axes of `cell`
are meant: settings differ in books.

**What symmetry leaves free** (Neumann's principle; Nye, Physical Properties of Crystals, 1957, ch. 1): nothing in an
orthorhombic crystal but which axis is which; one angle about b in a monoclinic one; everything in a triclinic one.
"""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt
from pydantic import Discriminator, Field, Tag, model_validator

from minerals_db.curve import FloatArray, Table
from minerals_db.fields import Entry, Known, Number

__all__ = [
    "AnyOrientation",
    "AxisName",
    "Direction",
    "FreeOrientation",
    "MonoclinicOrientation",
    "Orientation",
    "OrthorhombicOrientation",
    "PrincipalName",
    "TriclinicOrientation",
    "TurningAngle",
]

AxisName = Literal["a", "b", "c"]
PrincipalName = Literal["alpha", "beta", "gamma"]

RIGHT_ANGLE_TOLERANCE_DEG = 0.5
"""How far two directions of a triclinic crystal may stand from a right angle: sources round them to half a degree."""


class OrthorhombicOrientation(Known):
    """Which axis of the cell waves of each principal index vibrate along, at the D line: X, Y, Z of mineralogists.

    The curves of `dispersion` are keyed by the same axes, so that this says again what they say; it carries the source
    of the orientation, which is seldom that of the indices.
    """

    alpha: AxisName = Field(description="Axis of the smallest index, X")
    beta: AxisName = Field(description="Axis of the middle index, Y")
    gamma: AxisName = Field(description="Axis of the largest index, Z")

    @model_validator(mode="after")
    def _names_each_axis_once(self) -> Self:
        if len({self.alpha, self.beta, self.gamma}) != 3:
            raise ValueError(
                f"alpha, beta, gamma must be a, b, c in some order, not {self.alpha}{self.beta}{self.gamma}"
            )
        return self


class TurningAngle(Table):
    """An angle that changes with the wavelength: the dispersion of the axes."""

    values_field: ClassVar[str] = "angles_deg"

    angles_deg: tuple[Number, ...] = Field(min_length=2, description="One for each wavelength")

    def degrees(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the angle, degrees, shape of the wavelengths (nm), which are clamped to the range."""
        return self._at(wavelength_nm)


_Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-90.0, le=90.0)]


def _is_table(value: object) -> str:
    return "table" if isinstance(value, dict | TurningAngle) else "number"


class MonoclinicOrientation(Known):
    """One principal direction along b, and the angle of another one in the plane (010).

    The angle is positive when the direction is turned from the named axis about +b by the right hand: from +c towards
    +a, through the obtuse angle β. A positive angle from +a therefore leads on, out of β; a negative one into it.
    """

    parallel_to_b: PrincipalName = Field(description="The principal direction along b")
    direction: PrincipalName = Field(description="One of the other two, whose angle is given")
    from_axis: Literal["a", "c"] = Field(description="The axis that the angle is counted from")
    angle_deg: Annotated[
        Annotated[_Angle, Tag("number")] | Annotated[TurningAngle, Tag("table")], Discriminator(_is_table)
    ] = Field(description="From the axis to the direction, degrees; a table where it changes with the wavelength")

    @model_validator(mode="after")
    def _names_two_directions(self) -> Self:
        if self.direction == self.parallel_to_b:
            raise ValueError(f"direction must be another than {self.parallel_to_b}, which is along b")
        return self

    def axes(self, beta_deg: float, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the directions α, β, γ in the crystal frame.

        Parameters
        ----------
        beta_deg : float
            Angle β of the cell, degrees.
        wavelength_nm : array_like, shape () or (N,)
            Vacuum wavelengths, nm.

        Returns
        -------
        float64 array, shape (3, 3), or (3, 3, N) where the axes turn with N wavelengths
            A right-handed frame: row i is the direction of α, β, γ.
        """
        # Angles from z = c* towards x = a, that is about +y = +b: a lies at 90°, c at 90° − β.
        start = 90.0 if self.from_axis == "a" else 90.0 - beta_deg
        turn = self.angle_deg.degrees(wavelength_nm) if isinstance(self.angle_deg, TurningAngle) else self.angle_deg
        angle = np.asarray(np.radians(start + turn))
        zero = np.zeros_like(angle)
        along_b = np.stack((zero, zero + 1.0, zero))
        known = np.stack((np.sin(angle), zero, np.cos(angle)))
        names = ("alpha", "beta", "gamma")
        place_b, place = names.index(self.parallel_to_b), names.index(self.direction)
        other = 3 - place_b - place
        rows = {place_b: along_b, place: known}
        # The third axis closes a right-handed triple: e_i = e_j × e_k for cyclic (i, j, k).
        rows[other] = np.cross(rows[(other + 1) % 3], rows[(other + 2) % 3], axis=0)
        return np.stack((rows[0], rows[1], rows[2]))


class Direction(Entry):
    """A direction in the crystal frame, by its spherical angles."""

    polar_deg: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.0, le=180.0)] = Field(
        description="From c* (z), degrees"
    )
    azimuth_deg: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-360.0, le=360.0)] = Field(
        description="About c*, from a (x) towards y = z × x, degrees"
    )

    def unit(self) -> FloatArray:
        """Return the unit vector, shape (3,)."""
        polar, azimuth = math.radians(self.polar_deg), math.radians(self.azimuth_deg)
        return np.array(
            (math.sin(polar) * math.cos(azimuth), math.sin(polar) * math.sin(azimuth), math.cos(polar)), np.float64
        )


class TriclinicOrientation(Known):
    """The directions of α and γ; that of β is at right angles to both."""

    alpha: Direction
    gamma: Direction

    @model_validator(mode="after")
    def _is_a_right_angle(self) -> Self:
        cosine = float(np.dot(self.alpha.unit(), self.gamma.unit()))
        between = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
        if abs(between - 90.0) > RIGHT_ANGLE_TOLERANCE_DEG:
            raise ValueError(f"alpha and gamma must be at right angles, not at {between:.2f} degrees")
        return self

    def axes(self) -> FloatArray:
        """Return the directions α, β, γ in the crystal frame.

        The rounding of the two directions is shared between them, so that the frame is orthonormal.

        Returns
        -------
        float64 array, shape (3, 3)
            A right-handed frame: row i is the direction of α, β, γ.
        """
        alpha, gamma = self.alpha.unit(), self.gamma.unit()
        total, difference = alpha + gamma, alpha - gamma  # at right angles, both vectors being units
        total, difference = total / np.sqrt(np.dot(total, total)), difference / np.sqrt(np.dot(difference, difference))
        alpha, gamma = (total + difference) / math.sqrt(2.0), (total - difference) / math.sqrt(2.0)
        return np.stack((alpha, np.cross(gamma, alpha), gamma))


Orientation = OrthorhombicOrientation | MonoclinicOrientation | TriclinicOrientation


def _kind(value: object) -> str:
    """Tell the three kinds apart by the fields they have, so that faults are told of the one that is meant."""
    if isinstance(value, Orientation):
        return type(value).__name__
    fields = value if isinstance(value, dict) else {}
    if "parallel_to_b" in fields or "direction" in fields:
        return "MonoclinicOrientation"
    return "TriclinicOrientation" if isinstance(fields.get("alpha"), dict) else "OrthorhombicOrientation"


_Monoclinic = Annotated[MonoclinicOrientation, Tag("MonoclinicOrientation")]
_Triclinic = Annotated[TriclinicOrientation, Tag("TriclinicOrientation")]
AnyOrientation = Annotated[
    Annotated[OrthorhombicOrientation, Tag("OrthorhombicOrientation")] | _Monoclinic | _Triclinic, Discriminator(_kind)
]
"""A field that holds an orientation of any kind."""

FreeOrientation = Annotated[_Monoclinic | _Triclinic, Discriminator(_kind)]
"""A field that holds an orientation which symmetry leaves free, as that of the absorption against the indicatrix."""
