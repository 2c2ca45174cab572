"""How a refractive index depends on the wavelength.

One frozen model per kind of curve, told apart in the data by ``model``. The formulas are those numbered by the
refractiveindex.info database (M. N. Polyanskiy, Sci. Data 11, 94 (2024), doi:10.1038/s41597-023-02898-2), with λ in µm,
so that published coefficients go in with their own digits. Indices are relative to air, as the sources give them
(vacuum or air wavelength differ by 3e-4 λ, which moves an index by less than 1e-4 even in diamond).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator

from minerals_db.curve import Curve, FloatArray, Table
from minerals_db.fields import Entry, Number, Positive

__all__ = ["AnyDispersion", "Dispersion", "ResonancesAndPowers", "Sellmeier1", "Sellmeier2", "TabulatedIndex"]


class Dispersion(Curve):
    """A refractive index as a function of the wavelength; the base of every kind of curve."""

    def index(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the refractive index.

        Parameters
        ----------
        wavelength_nm : array_like, shape (...)
            Vacuum wavelengths, nm. Outside ``range_nm`` the value at the nearer end is returned; NaN gives NaN.

        Returns
        -------
        float64 array, shape (...)
            Indices relative to air. Each is computed by itself: its bits do not depend on its neighbours.
        """
        return self._at(wavelength_nm)


class _Formula(Dispersion):
    """A formula for n²; checked to give real indices above zero over its whole range."""

    @abstractmethod
    def _squared(self, squared_um2: FloatArray) -> FloatArray:
        """Return n² at λ² (µm²)."""

    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        wavelength_um = wavelength_nm * 1e-3
        return np.asarray(np.sqrt(self._squared(wavelength_um * wavelength_um)), dtype=np.float64)

    @abstractmethod
    def _poles_um2(self) -> tuple[float, ...]:
        """Return the λ² (µm²) at which the formula is infinite."""

    @model_validator(mode="after")
    def _is_a_real_index(self) -> Self:
        shortest, longest = (end * 1e-3 for end in self.range_nm)
        for pole in self._poles_um2():
            # Rounding must not put a pole at an end of the range outside it.
            if shortest**2 * (1.0 - 1e-9) <= pole <= longest**2 * (1.0 + 1e-9):
                raise ValueError(f"the formula has a pole at {1e3 * math.sqrt(pole):.6g} nm, inside range_nm")
        squared = self._squared(np.linspace(shortest, longest, 257) ** 2)
        if not bool(np.all(squared > 0.0)):  # also where NaN
            raise ValueError("the formula gives no real index over the whole of range_nm")
        return self


class ResonanceUm(Entry):
    """A term B λ²/(λ² − C²)."""

    strength: Number = Field(description="B, without unit")
    resonance_um: Number = Field(description="C, µm")


class ResonanceUm2(Entry):
    """A term B λ²/(λ² − C)."""

    strength: Number = Field(description="B, without unit")
    resonance_um2: Number = Field(description="C, µm²")


class Sellmeier1(_Formula):
    """n² = 1 + offset + Σ B λ²/(λ² − C²); formula 1 of refractiveindex.info."""

    model: Literal["sellmeier-1"]
    offset: Number = 0.0
    terms: tuple[ResonanceUm, ...] = Field(min_length=1)

    def _squared(self, squared_um2: FloatArray) -> FloatArray:
        total = np.full_like(squared_um2, 1.0 + self.offset)
        for term in self.terms:
            total += term.strength * squared_um2 / (squared_um2 - term.resonance_um * term.resonance_um)
        return total

    def _poles_um2(self) -> tuple[float, ...]:
        return tuple(term.resonance_um**2 for term in self.terms)


class Sellmeier2(_Formula):
    """n² = 1 + offset + Σ B λ²/(λ² − C); formula 2 of refractiveindex.info."""

    model: Literal["sellmeier-2"]
    offset: Number = 0.0
    terms: tuple[ResonanceUm2, ...] = Field(min_length=1)

    def _squared(self, squared_um2: FloatArray) -> FloatArray:
        total = np.full_like(squared_um2, 1.0 + self.offset)
        for term in self.terms:
            total += term.strength * squared_um2 / (squared_um2 - term.resonance_um2)
        return total

    def _poles_um2(self) -> tuple[float, ...]:
        return tuple(term.resonance_um2 for term in self.terms)


class PowerResonance(Entry):
    """A term B λᵖ/(λ² − C² ) or B λᵖ/(λ² − C): the source gives either C in µm or C in µm²."""

    strength: Number = Field(description="B, µm^(2 − power)")
    power: Literal[0, 2] = Field(description="p")
    resonance_um: Number | None = Field(None, description="C, µm, squared in the formula")
    resonance_um2: Number | None = Field(None, description="C, µm², taken as it is")

    @model_validator(mode="after")
    def _one_resonance(self) -> Self:
        if (self.resonance_um is None) == (self.resonance_um2 is None):
            raise ValueError("give either resonance_um or resonance_um2")
        return self

    @property
    def pole_um2(self) -> float:
        """The λ² (µm²) of the pole."""
        if self.resonance_um2 is not None:
            return self.resonance_um2
        assert self.resonance_um is not None  # by _one_resonance
        return self.resonance_um * self.resonance_um


class Power(Entry):
    """A term A λᵖ."""

    coefficient: Number = Field(description="A, µm^(−power)")
    power: Literal[-6, -4, -2, 2, 4, 6] = Field(description="p")


class ResonancesAndPowers(_Formula):
    """n² = constant + Σ B λᵖ/(λ² − C) + Σ A λᵖ; formula 4 of refractiveindex.info, with even powers."""

    model: Literal["resonances-and-powers"]
    constant: Number
    resonances: tuple[PowerResonance, ...] = ()
    powers: tuple[Power, ...] = ()

    def _squared(self, squared_um2: FloatArray) -> FloatArray:
        total = np.full_like(squared_um2, self.constant)
        for term in self.resonances:
            numerator = term.strength * squared_um2 if term.power == 2 else np.full_like(squared_um2, term.strength)
            total += numerator / (squared_um2 - term.pole_um2)
        for power in self.powers:
            # Products instead of np.power: exact to rounding, so the same bits for every batch length.
            product = np.ones_like(squared_um2)
            for _ in range(abs(power.power) // 2):
                product = product * squared_um2
            total += power.coefficient * product if power.power > 0 else power.coefficient / product
        return total

    def _poles_um2(self) -> tuple[float, ...]:
        return tuple(term.pole_um2 for term in self.resonances)


class TabulatedIndex(Table, Dispersion):
    """Measured indices, joined by monotone cubics."""

    values_field: ClassVar[str] = "indices"

    model: Literal["table"]
    indices: tuple[Positive, ...] = Field(min_length=2, description="One for each wavelength")


AnyDispersion = Annotated[
    Sellmeier1 | Sellmeier2 | ResonancesAndPowers | TabulatedIndex,
    Field(discriminator="model"),
]
