"""What every curve of a refractive index answers: the index, the group index, the Abbe number.

Indices are relative to air, as the sources give them (vacuum or air wavelength differ by 3e-4 λ, which moves an index
by less than 1e-4 even in diamond).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import ClassVar, Final, Literal, Self

import numpy.typing as npt
from pydantic import Field, model_validator

from minerals_db.curve import Curve, FloatArray, OutsideRangeError, Table
from minerals_db.fields import Positive

__all__ = ["FRAUNHOFER_NM", "Dispersion", "TabulatedIndex"]

FRAUNHOFER_NM: Final = {"F": 486.13, "d": 587.56, "D": 589.3, "C": 656.28}
"""Wavelengths, nm, of the lines that dispersions are quoted for: hydrogen F and C, helium d, the sodium pair D."""


class Dispersion(Curve):
    """A refractive index as a function of the wavelength; the base of every kind of curve."""

    least_index: ClassVar[float] = 1.0
    largest_index: ClassVar[float] = 5.0
    """What transparent matter has; outside it a unit or a column of the source was taken for another."""

    @abstractmethod
    def _log_slope(self, wavelength_nm: FloatArray) -> FloatArray:
        """Return λ dn/dλ at wavelengths inside the range; elementwise, NaN of NaN."""

    def index(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the refractive index.

        Parameters
        ----------
        wavelength_nm : array_like, shape (...)
            Vacuum wavelengths, nm. Outside ``range_nm`` the value at the nearer end is returned, unless the curve's
            ``outside_range`` is ``refuse``; NaN gives NaN.

        Returns
        -------
        float64 array, shape (...)
            Indices relative to air. Each is computed by itself: its bits do not depend on its neighbours.

        Raises
        ------
        OutsideRangeError
            If a wavelength lies outside the range of a curve that refuses it.
        """
        return self._at(wavelength_nm)

    def group_index(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the group index n − λ dn/dλ: the speed of light in vacuum over that of a pulse.

        The derivative is that of the formula, not a difference; that of a table is that of its cubics.

        Parameters
        ----------
        wavelength_nm : array_like, shape (...)
            Vacuum wavelengths, nm. Outside ``range_nm`` the value at the nearer end is returned, with the derivative
            just inside it, unless the curve's ``outside_range`` is ``refuse``; NaN gives NaN.

        Returns
        -------
        float64 array, shape (...)
            Group indices relative to air. The bits of each do not depend on its neighbours.

        Raises
        ------
        OutsideRangeError
            If a wavelength lies outside the range of a curve that refuses it.

        References
        ----------
        M. Born, E. Wolf, *Principles of Optics*, 7th ed. (1999), section 1.3.4.
        """
        known = self._known(wavelength_nm)
        return self._value(known) - self._log_slope(known)

    def abbe_number(self, line: Literal["D", "d"] = "D") -> float:
        """Return the Abbe number (n − 1)/(n_F − n_C), infinite without dispersion.

        Parameters
        ----------
        line : {"D", "d"}
            The line of n: D of sodium, 589.3 nm, as mineralogists have it, or d of helium, 587.56 nm, as makers of
            glass do.

        Returns
        -------
        float
            The Abbe number; F and C are the lines of hydrogen, 486.13 and 656.28 nm.

        Raises
        ------
        OutsideRangeError
            If the curve is not known from F to C, whatever its ``outside_range``: an Abbe number of values kept from
            elsewhere says nothing.

        References
        ----------
        M. Born, E. Wolf, *Principles of Optics*, 7th ed. (1999), section 4.7.
        """
        for name in ("F", "C"):
            if not self.covers(FRAUNHOFER_NM[name], FRAUNHOFER_NM[name]):
                raise OutsideRangeError(FRAUNHOFER_NM[name], self.range_nm, f"Fraunhofer's line {name}")
        n_f, n, n_c = (float(n) for n in self.index([FRAUNHOFER_NM[name] for name in ("F", line, "C")]))
        return (n - 1.0) / (n_f - n_c) if n_f != n_c else math.inf

    def _refuse_indices(self, least: float, largest: float) -> None:
        """Raise a ValueError if the extreme indices are none of transparent matter, or are not real (NaN)."""
        if math.isnan(least) or math.isnan(largest):
            raise ValueError("the formula gives no real index over the whole of range_nm")
        if least < self.least_index or largest > self.largest_index:
            raise ValueError(
                f"indices from {least:.6g} to {largest:.6g} over range_nm, but those of transparent matter lie from "
                f"{self.least_index:g} to {self.largest_index:g}: are the coefficients for µm, and range_nm in nm?"
            )


class TabulatedIndex(Table, Dispersion):
    """Measured indices, joined by monotone cubics."""

    values_field: ClassVar[str] = "indices"

    model: Literal["table"]
    indices: tuple[Positive, ...] = Field(min_length=2, description="One for each wavelength")

    def _log_slope(self, wavelength_nm: FloatArray) -> FloatArray:
        return wavelength_nm * self._slope_per_nm(wavelength_nm)

    @model_validator(mode="after")
    def _is_an_index(self) -> Self:
        self._refuse_indices(min(self.indices), max(self.indices))  # monotone cubics go no further
        return self
