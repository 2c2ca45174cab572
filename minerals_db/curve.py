"""A measured quantity as a function of the wavelength, known in a range: what indices and rotatory powers share.

**Range.** A curve is known only inside its ``range_nm``. Outside it the value at the nearer end is returned: formulas
are meaningless near their poles, and a constant is the one continuation that cannot run away.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, ClassVar, Self

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator

from minerals_db.fields import Known, Number, Positive

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

__all__ = ["Curve", "FloatArray", "Table"]

FloatArray = npt.NDArray[np.float64]


class Curve(Known, ABC):
    """A quantity as a function of the wavelength."""

    range_nm: Annotated[tuple[Positive, Positive], Field(description="Shortest and longest wavelength known, nm")]
    temperature_celsius: Number | None = Field(None, description="Temperature of the specimen, if the source says it")

    @abstractmethod
    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        """Return the quantity at wavelengths inside the range; elementwise, NaN of NaN."""

    def _at(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the quantity, shape of the wavelengths (nm), which are clamped to the range; NaN gives NaN."""
        shortest, longest = self.range_nm
        clamped = np.clip(np.asarray(wavelength_nm, dtype=np.float64), shortest, longest)
        return np.asarray(self._value(clamped), dtype=np.float64)

    def covers(self, shortest_nm: float, longest_nm: float) -> bool:
        """Tell whether the curve is known over the whole interval (nm), so that nothing is clamped."""
        return self.range_nm[0] <= shortest_nm and longest_nm <= self.range_nm[1]

    @model_validator(mode="after")
    def _range_is_ordered(self) -> Self:
        if self.range_nm[0] >= self.range_nm[1]:
            raise ValueError(f"range_nm must rise, not {self.range_nm[0]:g} to {self.range_nm[1]:g}")
        return self


class Table(Curve):
    """Measured values, joined by monotone cubics (PCHIP; Fritsch and Carlson, SIAM J. Numer. Anal. 17, 238 (1980))."""

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
    def _curve(self) -> PchipInterpolator:
        from scipy.interpolate import PchipInterpolator  # 0.3 s: only for those who use a table

        return PchipInterpolator(np.asarray(self.wavelengths_nm), np.asarray(self._values))

    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        known, values = np.asarray(self.wavelengths_nm), np.asarray(self._values)
        place = np.searchsorted(known, wavelength_nm).clip(max=known.size - 1)
        tabulated = known[place] == wavelength_nm
        if tabulated.all():  # the checks of the schema, at the D line: they must not cost the import of SciPy
            return np.asarray(values[place])
        return np.where(tabulated, values[place], self._curve(wavelength_nm))
