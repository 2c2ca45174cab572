"""A measured quantity as a function of the wavelength, known in a range: what indices and rotatory powers share.

**Range.** A curve is known only inside its ``range_nm``: formulas are meaningless near their poles. Outside it the
value at the nearer end is returned (``outside_range: clamp``), the one continuation that cannot run away, or the
question is refused (``outside_range: refuse``).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from functools import cached_property
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator

from minerals_db.fields import Known, Number, Positive
from minerals_db.monotone import MonotoneCubics

__all__ = ["Curve", "FloatArray", "OutsideRangeError", "Table"]

FloatArray = npt.NDArray[np.float64]


class OutsideRangeError(ValueError):
    """A question for a wavelength at which the curve is not known.

    Parameters
    ----------
    wavelength_nm : float
        The wavelength asked for, nm.
    range_nm : tuple of two floats
        Where the curve is known, nm.
    name : str
        What the wavelength is called, if it has a name.
    """

    def __init__(self, wavelength_nm: float, range_nm: tuple[float, float], name: str = "") -> None:
        self.wavelength_nm = wavelength_nm
        self.range_nm = range_nm
        self.name = name
        super().__init__(wavelength_nm, range_nm, name)

    def __str__(self) -> str:
        """Return a sentence that names the wavelength and the range."""
        # Nine digits: a wavelength just outside must not read as the end of the range.
        shortest, longest = self.range_nm
        there = f"{self.name}, {self.wavelength_nm:.9g} nm" if self.name else f"{self.wavelength_nm:.9g} nm"
        return f"the curve is known from {shortest:.9g} to {longest:.9g} nm, not at {there}"


class Curve(Known, ABC):
    """A quantity as a function of the wavelength."""

    range_nm: Annotated[tuple[Positive, Positive], Field(description="Shortest and longest wavelength known, nm")]
    temperature_celsius: Number | None = Field(None, description="Temperature of the specimen, if the source says it")
    outside_range: Literal["clamp", "refuse"] = Field(
        "clamp", description="Outside range_nm: the value at the nearer end, or an error"
    )

    @abstractmethod
    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        """Return the quantity at wavelengths inside the range; elementwise, NaN of NaN."""

    def _known(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the wavelengths (nm) at which to answer: clamped to the range, or refused; NaN stays NaN."""
        shortest, longest = self.range_nm
        asked = np.asarray(wavelength_nm, dtype=np.float64)
        if self.outside_range == "refuse":
            outside = asked[(asked < shortest) | (asked > longest)]
            if outside.size:
                raise OutsideRangeError(float(outside[0]), self.range_nm)
        return np.asarray(np.clip(asked, shortest, longest), dtype=np.float64)

    def _at(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the quantity, shape of the wavelengths (nm); outside the range as ``outside_range`` says."""
        return np.asarray(self._value(self._known(wavelength_nm)), dtype=np.float64)

    def covers(self, shortest_nm: float, longest_nm: float) -> bool:
        """Tell whether the curve is known over the whole interval (nm), so that nothing is clamped."""
        return self.range_nm[0] <= shortest_nm and longest_nm <= self.range_nm[1]

    @model_validator(mode="after")
    def _range_is_ordered(self) -> Self:
        if self.range_nm[0] >= self.range_nm[1]:
            raise ValueError(f"range_nm must rise, not {self.range_nm[0]:g} to {self.range_nm[1]:g}")
        return self

    def _refuse_poles(self, poles_um: Iterable[float]) -> None:
        """Raise a ValueError if the formula is infinite at one of the wavelengths (µm) inside the range."""
        shortest, longest = self.range_nm
        for pole in poles_um:
            # Rounding must not put a pole at an end of the range outside it.
            if shortest * (1.0 - 1e-9) <= 1e3 * pole <= longest * (1.0 + 1e-9):
                raise ValueError(f"the formula has a pole at {1e3 * pole:.6g} nm, inside range_nm")


class Table(Curve):
    """Measured values, joined by monotone cubics (`minerals_db.monotone`)."""

    values_field: ClassVar[str]
    """Name of the field that holds the values."""

    wavelengths_nm: tuple[Positive, ...] = Field(min_length=2, description="Rising, from end to end of range_nm")

    @property
    def _values(self) -> tuple[float, ...]:
        values: tuple[float, ...] = getattr(self, self.values_field)
        return values

    @model_validator(mode="after")
    def _is_a_table(self) -> Self:
        if len(self.wavelengths_nm) != len(self._values):
            raise ValueError(f"{len(self.wavelengths_nm)} wavelengths_nm but {len(self._values)} {self.values_field}")
        if any(later <= earlier for earlier, later in zip(self.wavelengths_nm, self.wavelengths_nm[1:], strict=False)):
            raise ValueError("wavelengths_nm must rise")
        if self.range_nm != (self.wavelengths_nm[0], self.wavelengths_nm[-1]):
            raise ValueError("range_nm must be the first and the last of wavelengths_nm")
        return self

    @cached_property
    def _curve(self) -> MonotoneCubics:
        return MonotoneCubics(np.asarray(self.wavelengths_nm), np.asarray(self._values))

    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        return self._curve.value(wavelength_nm)

    def _slope_per_nm(self, wavelength_nm: FloatArray) -> FloatArray:
        """Return the derivative of the cubics by the wavelength (1/nm) inside the range; NaN of NaN."""
        return self._curve.slope(wavelength_nm)
