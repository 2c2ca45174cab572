"""The dispersion formulas numbered by the refractiveindex.info database, with fields that speak.

They are those of M. N. Polyanskiy, Sci. Data 11, 94 (2024), doi:10.1038/s41597-023-02898-2, with λ in µm, so that
published coefficients C1, C2, ... go in with their own digits. Each is a sum of a constant and of terms, of which n is
a function: the root, the sum itself, or what the Lorentz-Lorenz relation makes of it.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import Final, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from minerals_db.curve import FloatArray
from minerals_db.fields import Number
from minerals_db.refractive_index import Dispersion
from minerals_db.terms import (
    GasResonance,
    HerzbergerResonance,
    LineResonance,
    Power,
    PowerResonance,
    ResonanceUm,
    ResonanceUm2,
    Term,
)

__all__ = [
    "Cauchy",
    "Exotic",
    "Gas",
    "Herzberger",
    "Polynomial",
    "ResonancesAndPowers",
    "Retro",
    "Sellmeier1",
    "Sellmeier2",
    "SquaredFormula",
]

_PLACES: Final = np.linspace(0.0, 1.0, 129)
"""Where on the logarithmic scale between its ends a formula is checked: the visible is a small part of a long range."""


class _Formula(Dispersion):
    """A formula for the index; checked to be finite, real and an index over its whole range."""

    @property
    @abstractmethod
    def _constant(self) -> float:
        """What the terms are added to."""

    @property
    @abstractmethod
    def _terms(self) -> tuple[Term, ...]:
        """The terms of the sum."""

    @abstractmethod
    def _index_of(self, total: FloatArray) -> FloatArray:
        """Return the index at the values of the sum."""

    @abstractmethod
    def _index_slope(self, total: FloatArray) -> FloatArray:
        """Return the derivative of the index by the sum."""

    def _sum(self, wavelength_um: FloatArray) -> FloatArray:
        total = np.full_like(wavelength_um, self._constant)
        for term in self._terms:
            total += term.value(wavelength_um)
        return total

    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        return np.asarray(self._index_of(self._sum(wavelength_nm * 1e-3)), dtype=np.float64)

    def _log_slope(self, wavelength_nm: FloatArray) -> FloatArray:
        wavelength_um = wavelength_nm * 1e-3
        slope = np.zeros_like(wavelength_um)
        for term in self._terms:
            slope += term.log_slope(wavelength_um)
        return self._index_slope(self._sum(wavelength_um)) * slope

    @model_validator(mode="after")
    def _is_a_real_index(self) -> Self:
        self._refuse_poles(pole for term in self._terms for pole in term.poles_um())
        shortest, longest = self.range_nm
        with np.errstate(all="ignore"):  # what comes out is looked at
            indices = self._value(shortest * np.power(longest / shortest, _PLACES))
        self._refuse_indices(float(indices.min()), float(indices.max()))
        return self


class SquaredFormula(_Formula):
    """A formula whose sum is n²."""

    def _index_of(self, total: FloatArray) -> FloatArray:
        return np.sqrt(total)

    def _index_slope(self, total: FloatArray) -> FloatArray:
        return 0.5 / np.sqrt(total)


class _PlainFormula(_Formula):
    """A formula whose sum is n."""

    def _index_of(self, total: FloatArray) -> FloatArray:
        return total

    def _index_slope(self, total: FloatArray) -> FloatArray:
        return np.ones_like(total)


class _OverOne(_Formula):
    """A formula for what an index has over that of empty space."""

    offset: Number = Field(0.0, description="Added to the terms and to 1")

    @property
    def _constant(self) -> float:
        return 1.0 + self.offset


class _OverConstant(_Formula):
    """A formula with a constant of its own."""

    constant: Number = Field(description="Added to the terms")

    @property
    def _constant(self) -> float:
        return self.constant


class Sellmeier1(SquaredFormula, _OverOne):
    """n² = 1 + offset + Σ B λ²/(λ² − C²); formula 1 of refractiveindex.info."""

    model: Literal["sellmeier-1"]
    terms: tuple[ResonanceUm, ...] = Field(min_length=1)

    @property
    def _terms(self) -> tuple[Term, ...]:
        return self.terms


class Sellmeier2(SquaredFormula, _OverOne):
    """n² = 1 + offset + Σ B λ²/(λ² − C); formula 2 of refractiveindex.info."""

    model: Literal["sellmeier-2"]
    terms: tuple[ResonanceUm2, ...] = Field(min_length=1)

    @property
    def _terms(self) -> tuple[Term, ...]:
        return self.terms


class Polynomial(SquaredFormula, _OverConstant):
    """n² = constant + Σ A λᵖ; formula 3 of refractiveindex.info."""

    model: Literal["polynomial"]
    powers: tuple[Power, ...] = Field(min_length=1)

    @property
    def _terms(self) -> tuple[Term, ...]:
        return self.powers


class ResonancesAndPowers(SquaredFormula, _OverConstant):
    """n² = constant + Σ B λᵖ/(λ² − C) + Σ A λᵖ; formula 4 of refractiveindex.info."""

    model: Literal["resonances-and-powers"]
    resonances: tuple[PowerResonance, ...] = ()
    powers: tuple[Power, ...] = ()

    @property
    def _terms(self) -> tuple[Term, ...]:
        return (*self.resonances, *self.powers)


class Cauchy(_PlainFormula, _OverConstant):
    """n = constant + Σ A λᵖ; formula 5 of refractiveindex.info."""

    model: Literal["cauchy"]
    powers: tuple[Power, ...] = ()

    @property
    def _terms(self) -> tuple[Term, ...]:
        return self.powers


class Gas(_PlainFormula, _OverOne):
    """n = 1 + offset + Σ B/(C − λ⁻²); formula 6 of refractiveindex.info."""

    model: Literal["gas"]
    terms: tuple[GasResonance, ...] = Field(min_length=1)

    @property
    def _terms(self) -> tuple[Term, ...]:
        return self.terms


class Herzberger(_PlainFormula, _OverConstant):
    """n = constant + A L + B L² + Σ C λᵖ, L = 1/(λ² − 0.028); formula 7 of refractiveindex.info, where p is 2, 4, 6."""

    model: Literal["herzberger"]
    resonance: HerzbergerResonance
    powers: tuple[Power, ...] = ()

    @property
    def _terms(self) -> tuple[Term, ...]:
        return (self.resonance, *self.powers)


class Retro(_OverConstant):
    """(n² − 1)/(n² + 2) = constant + B λ²/(λ² − C) + Σ A λᵖ; formula 8 of refractiveindex.info, where p is 2."""

    model: Literal["retro"]
    resonance: ResonanceUm2
    powers: tuple[Power, ...] = ()

    @property
    def _terms(self) -> tuple[Term, ...]:
        return (self.resonance, *self.powers)

    def _index_of(self, total: FloatArray) -> FloatArray:
        return np.sqrt((1.0 + 2.0 * total) / (1.0 - total))

    def _index_slope(self, total: FloatArray) -> FloatArray:
        rest = 1.0 - total
        return 1.5 / (self._index_of(total) * rest * rest)


class Exotic(SquaredFormula, _OverConstant):
    """n² = constant + B λᵖ/(λ² − C) + S (λ − M)/((λ − M)² + W); formula 9 of refractiveindex.info, where p is 0."""

    model: Literal["exotic"]
    resonance: PowerResonance
    line: LineResonance

    @property
    def _terms(self) -> tuple[Term, ...]:
        return (self.resonance, self.line)
