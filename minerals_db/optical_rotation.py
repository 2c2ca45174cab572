"""How a crystal turns the plane of polarization of light that goes along its optic axis.

**Sense.** A right crystal turns it clockwise for an observer who faces the source (dextrorotatory), a left one
counter-clockwise. The rotatory power is given for the crystal of the entry's hand and is positive in either; that of
its mirror image is as large.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

import numpy.typing as npt
from pydantic import Field, model_validator

from minerals_db.curve import Curve, FloatArray, Table
from minerals_db.fields import Entry, Known, Number, Positive

__all__ = [
    "AcrossToAlong",
    "AnyRotatoryPower",
    "DrudeRotation",
    "Hand",
    "OpticalRotation",
    "RotatoryPower",
    "TabulatedRotation",
]


class RotatoryPower(Curve):
    """A rotatory power as a function of the wavelength; the base of every kind of curve."""

    def degrees_per_mm_at(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the rotatory power along the optic axis.

        Parameters
        ----------
        wavelength_nm : array_like, shape (...)
            Vacuum wavelengths, nm. Outside ``range_nm`` the value at the nearer end is returned; NaN gives NaN.

        Returns
        -------
        float64 array, shape (...)
            Degrees per mm of way, above zero, whatever the hand.
        """
        return self._at(wavelength_nm)


class DrudeRotation(RotatoryPower):
    """ρ = strength/(λ² − resonance²) + constant, λ in µm; P. Drude, Lehrbuch der Optik (1900), 2nd part, ch. 6."""

    model: Literal["drude"]
    strength: Number = Field(description="Degrees µm² per mm")
    resonance_um: Positive = Field(description="µm")
    constant: Number = Field(0.0, description="Degrees per mm")

    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        wavelength_um = wavelength_nm * 1e-3
        return self.strength / (wavelength_um * wavelength_um - self.resonance_um * self.resonance_um) + self.constant

    @model_validator(mode="after")
    def _turns_over_its_range(self) -> Self:
        self._refuse_poles((self.resonance_um,))
        # Between poles it is monotone, so that its ends are its extremes.
        if min(float(self._at(end)) for end in self.range_nm) <= 0.0:
            raise ValueError(
                "the formula must be above zero over the whole of range_nm; the hand is a field of its own"
            )
        return self


class TabulatedRotation(Table, RotatoryPower):
    """Measured rotatory powers, joined by monotone cubics."""

    values_field: ClassVar[str] = "degrees_per_mm"

    model: Literal["table"]
    degrees_per_mm: tuple[Positive, ...] = Field(min_length=2, description="One for each wavelength")


AnyRotatoryPower = Annotated[DrudeRotation | TabulatedRotation, Field(discriminator="model")]


class Hand(Known):
    """The hand of the crystal that the entry describes: the one whose space group its cell names."""

    sense: Literal["right", "left"] = Field(description="Right: clockwise for an observer who faces the source")


class AcrossToAlong(Known):
    """How strong the activity is across the optic axis: the ratio g11/g33 of the gyration tensor, taken constant."""

    ratio: Number


class OpticalRotation(Entry):
    """The optical activity of a crystal with one optic axis.

    Symmetry leaves the classes 3, 32, 4, 422, 6 and 622 the gyrations g33 along the axis and g11 across it.
    """

    along_axis: AnyRotatoryPower
    hand: Hand
    across_to_along: AcrossToAlong
