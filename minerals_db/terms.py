"""The terms that dispersion formulas are sums of, each with its derivative and its poles.

λ is in µm. In place of dy/dλ a term gives λ dy/dλ = dy/d(ln λ), which has the unit of the term itself and is simpler:
a power λᵖ gives p λᵖ.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Annotated, ClassVar, Self

import numpy as np
from pydantic import Field, model_validator

from minerals_db.curve import FloatArray
from minerals_db.fields import Entry, Number

__all__ = [
    "Exponent",
    "GasResonance",
    "HerzbergerResonance",
    "LineResonance",
    "Power",
    "PowerResonance",
    "ResonanceUm",
    "ResonanceUm2",
    "Term",
]

Exponent = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-16.0, le=16.0)]
"""An exponent of λ. Those published lie between -8 and 8: a larger one is a slip of the columns."""


def _scaled_power(factor: float, wavelength_um: FloatArray, exponent: float) -> FloatArray:
    """Return factor · λ^exponent, shape of the wavelengths."""
    size = abs(exponent)
    if size.is_integer():
        # Products instead of np.power: exact to rounding, so the same bits for every batch length.
        squared = wavelength_um * wavelength_um
        power = np.ones_like(wavelength_um)
        for _ in range(int(size) // 2):
            power = power * squared
        if int(size) % 2:
            power = power * wavelength_um
    else:
        power = np.power(wavelength_um, size)
    return np.asarray(factor * power if exponent >= 0.0 else factor / power)


def _poles_um(pole_um2: float) -> tuple[float, ...]:
    """Return the wavelengths (µm) at which λ² is the number (µm²): none below zero."""
    return (math.sqrt(pole_um2),) if pole_um2 > 0.0 else ()


class Term(Entry, ABC):
    """A term of a dispersion formula."""

    @abstractmethod
    def value(self, wavelength_um: FloatArray) -> FloatArray:
        """Return the term at the wavelengths (µm), shape as theirs."""

    @abstractmethod
    def log_slope(self, wavelength_um: FloatArray) -> FloatArray:
        """Return λ times the derivative of the term by λ at the wavelengths (µm), shape as theirs."""

    @abstractmethod
    def poles_um(self) -> tuple[float, ...]:
        """Return the wavelengths (µm) at which the term is infinite."""


class _Resonance(Term):
    """B λᵖ/(λ² − P)."""

    strength: Number

    @property
    @abstractmethod
    def pole_um2(self) -> float:
        """The λ² (µm²) of the pole, P."""

    def _exponent(self) -> float:
        """Return p."""
        return 2.0

    def value(self, wavelength_um: FloatArray) -> FloatArray:
        distance = wavelength_um * wavelength_um - self.pole_um2
        return _scaled_power(self.strength, wavelength_um, self._exponent()) / distance

    def log_slope(self, wavelength_um: FloatArray) -> FloatArray:
        squared = wavelength_um * wavelength_um
        distance = squared - self.pole_um2
        # λ d/dλ of B λᵖ/(λ² - P) = B λᵖ/(λ² - P) · (p - 2 λ²/(λ² - P)); one fraction, for it cancels far from the pole
        exponent = self._exponent()
        factor = ((exponent - 2.0) * squared - exponent * self.pole_um2) / distance
        return _scaled_power(self.strength, wavelength_um, exponent) / distance * factor

    def poles_um(self) -> tuple[float, ...]:
        return _poles_um(self.pole_um2)


class ResonanceUm(_Resonance):
    """A term B λ²/(λ² − C²)."""

    strength: Number = Field(description="B, without unit")
    resonance_um: Number = Field(description="C, µm")

    @property
    def pole_um2(self) -> float:
        """The λ² (µm²) of the pole, C²."""
        return self.resonance_um * self.resonance_um


class ResonanceUm2(_Resonance):
    """A term B λ²/(λ² − C)."""

    strength: Number = Field(description="B, without unit")
    resonance_um2: Number = Field(description="C, µm²")

    @property
    def pole_um2(self) -> float:
        """The λ² (µm²) of the pole, C."""
        return self.resonance_um2


class PowerResonance(_Resonance):
    """A term B λᵖ/(λ² − C²) or B λᵖ/(λ² − C): the source gives either C in µm or C in µm²."""

    strength: Number = Field(description="B, µm^(2 − power)")
    power: Exponent = Field(description="p")
    resonance_um: Number | None = Field(None, description="C, µm, squared in the formula")
    resonance_um2: Number | None = Field(None, description="C, µm², taken as it is; may be negative")

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

    def _exponent(self) -> float:
        return self.power


class Power(Term):
    """A term A λᵖ."""

    coefficient: Number = Field(description="A, µm^(−power)")
    power: Exponent = Field(description="p")

    def value(self, wavelength_um: FloatArray) -> FloatArray:
        """Return the term at the wavelengths (µm)."""
        return _scaled_power(self.coefficient, wavelength_um, self.power)

    def log_slope(self, wavelength_um: FloatArray) -> FloatArray:
        """Return λ times the derivative by λ at the wavelengths (µm)."""
        return self.power * self.value(wavelength_um)

    def poles_um(self) -> tuple[float, ...]:
        """Return the wavelengths (µm) at which the term is infinite."""
        return ()


class GasResonance(Term):
    """A term B/(C − λ⁻²)."""

    strength_per_um2: Number = Field(description="B, µm⁻²")
    resonance_per_um2: Number = Field(description="C, µm⁻²: the square of the resonance's wave number")

    def value(self, wavelength_um: FloatArray) -> FloatArray:
        """Return the term at the wavelengths (µm)."""
        return self.strength_per_um2 / (self.resonance_per_um2 - 1.0 / (wavelength_um * wavelength_um))

    def log_slope(self, wavelength_um: FloatArray) -> FloatArray:
        """Return λ times the derivative by λ at the wavelengths (µm)."""
        wave_number_squared = 1.0 / (wavelength_um * wavelength_um)
        distance = self.resonance_per_um2 - wave_number_squared
        return -2.0 * self.strength_per_um2 * wave_number_squared / (distance * distance)

    def poles_um(self) -> tuple[float, ...]:
        """Return the wavelengths (µm) at which the term is infinite."""
        return _poles_um(1.0 / self.resonance_per_um2) if self.resonance_per_um2 > 0.0 else ()


class LineResonance(Term):
    """A term S (λ − M)/((λ − M)² + W): a resonance of some width."""

    strength_um: Number = Field(description="S, µm")
    centre_um: Number = Field(description="M, µm")
    width_um2: Number = Field(description="W, µm²")

    def value(self, wavelength_um: FloatArray) -> FloatArray:
        """Return the term at the wavelengths (µm)."""
        offset = wavelength_um - self.centre_um
        return self.strength_um * offset / (offset * offset + self.width_um2)

    def log_slope(self, wavelength_um: FloatArray) -> FloatArray:
        """Return λ times the derivative by λ at the wavelengths (µm)."""
        offset = wavelength_um - self.centre_um
        squared = offset * offset
        whole = squared + self.width_um2
        return wavelength_um * self.strength_um * (self.width_um2 - squared) / (whole * whole)

    def poles_um(self) -> tuple[float, ...]:
        """Return the wavelengths (µm) at which the term is infinite."""
        if self.width_um2 > 0.0:
            return ()
        half = math.sqrt(-self.width_um2)
        return self.centre_um - half, self.centre_um + half


class HerzbergerResonance(Term):
    """The terms A L + B L², L = 1/(λ² − 0.028 µm²); M. Herzberger, Opt. Acta 6, 197 (1959)."""

    pole_um2: ClassVar[float] = 0.028
    """The λ² (µm²) of the pole: the same for every material."""

    first_order_um2: Number = Field(description="A, µm²")
    second_order_um4: Number = Field(description="B, µm⁴")

    def value(self, wavelength_um: FloatArray) -> FloatArray:
        """Return the term at the wavelengths (µm)."""
        inverse = 1.0 / (wavelength_um * wavelength_um - self.pole_um2)
        return (self.first_order_um2 + self.second_order_um4 * inverse) * inverse

    def log_slope(self, wavelength_um: FloatArray) -> FloatArray:
        """Return λ times the derivative by λ at the wavelengths (µm)."""
        squared = wavelength_um * wavelength_um
        inverse = 1.0 / (squared - self.pole_um2)
        # λ dL/dλ = -2 λ² L²
        return (self.first_order_um2 + 2.0 * self.second_order_um4 * inverse) * (-2.0 * squared) * (inverse * inverse)

    def poles_um(self) -> tuple[float, ...]:
        """Return the wavelengths (µm) at which the term is infinite."""
        return _poles_um(self.pole_um2)
