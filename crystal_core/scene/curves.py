"""Functions of the wavelength that a scene writes down: tables, refractive indices, reflectances."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Discriminator, Field, Tag

from crystal_core.scene.parts import BRANCH, Choice, Fraction, Location, Number, Part

__all__ = ["Absorbed", "Cauchy", "Index", "IndexCurve", "Reflectance", "ReflectanceCurve", "Table", "absorbed", "index"]

Real = NDArray[np.float64]

_TabledWavelength = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=100, le=1e5)]
_PlainIndex = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.1, le=10)]
_PlainAbsorption = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1e6)]


def number_or(kind: str) -> Discriminator:
    """Return what tells a plain number from a mapping."""

    def tell(value: object) -> str:
        return BRANCH + (kind if isinstance(value, dict | Part) else "number")

    return Discriminator(tell)


class Table(Part):
    """Values at wavelengths in nm, straight lines between them, the end values outside."""

    wavelengths_nm: Annotated[tuple[_TabledWavelength, ...], Field(min_length=2, max_length=2000)]
    values: Annotated[tuple[Number, ...], Field(min_length=2, max_length=2000)]

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse wavelengths that do not rise, and another number of values."""
        if len(self.values) != len(self.wavelengths_nm):
            yield ("values",), f"has {len(self.values)} values for {len(self.wavelengths_nm)} wavelengths"
        for number, (low, high) in enumerate(zip(self.wavelengths_nm, self.wavelengths_nm[1:], strict=False)):
            if high <= low:
                yield ("wavelengths_nm", number + 1), f"wavelengths must rise: {high:g} comes after {low:g}"

    def outside(self, low: float, high: float) -> Iterator[tuple[Location, str]]:
        """Yield the values outside [low, high], as faults."""
        for number, value in enumerate(self.values):
            if not low <= value <= high:
                yield ("values", number), f"must be {low:g} … {high:g}, not {value:g}"

    def at(self, wavelength_nm: ArrayLike) -> Real:
        """Return the values at wavelengths in nm, any shape."""
        return np.asarray(
            np.interp(np.asarray(wavelength_nm, np.float64), self.wavelengths_nm, self.values), np.float64
        )


class Cauchy(Part):
    """n = a + b/λ² + c/λ⁴ with λ in µm (Cauchy 1836)."""

    a: _PlainIndex
    b_um2: Number = 0.0
    c_um4: Number = 0.0

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse an index that leaves 0.1 … 10 between 360 and 830 nm."""
        n = self.at(np.linspace(360.0, 830.0, 48))
        if n.min() < 0.1 or n.max() > 10:
            yield (), f"the index goes from {n.min():g} to {n.max():g} between 360 and 830 nm: must be 0.1 … 10"

    def at(self, wavelength_nm: ArrayLike) -> Real:
        """Return the index at wavelengths in nm, any shape."""
        square = (np.asarray(wavelength_nm, np.float64) * 1e-3) ** 2
        return np.asarray(self.a + self.b_um2 / square + self.c_um4 / square**2, np.float64)


class IndexCurve(Choice):
    """A refractive index as a function of the wavelength."""

    choices = ("cauchy", "table")

    cauchy: Cauchy | None = None
    table: Table | None = None

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse indices outside 0.1 … 10."""
        if self.table is not None:
            yield from ((("table", *place), reason) for place, reason in self.table.outside(0.1, 10.0))


class AbsorptionCurve(Part):
    """An absorption coefficient as a function of the wavelength."""

    table: Table

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse negative coefficients."""
        yield from ((("table", *place), reason) for place, reason in self.table.outside(0.0, 1e6))


class ReflectanceCurve(Choice):
    """The share of light that a diffuse surface sends back."""

    choices = ("srgb", "table")

    srgb: tuple[Fraction, Fraction, Fraction] | None = Field(
        default=None, description="Colour as written in sRGB (0 … 1, not linear), made a spectrum"
    )
    table: Table | None = None

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse reflectances outside 0 … 1."""
        if self.table is not None:
            yield from ((("table", *place), reason) for place, reason in self.table.outside(0.0, 1.0))


Index = Annotated[
    Annotated[_PlainIndex, Tag(BRANCH + "number")] | Annotated[IndexCurve, Tag(BRANCH + "curve")], number_or("curve")
]
Absorbed = Annotated[
    Annotated[_PlainAbsorption, Tag(BRANCH + "number")] | Annotated[AbsorptionCurve, Tag(BRANCH + "curve")],
    number_or("curve"),
]
Reflectance = Annotated[
    Annotated[Fraction, Tag(BRANCH + "number")] | Annotated[ReflectanceCurve, Tag(BRANCH + "curve")],
    number_or("curve"),
]


def index(value: Index, wavelength_nm: ArrayLike) -> Real:
    """Return an index at wavelengths in nm, any shape."""
    if isinstance(value, IndexCurve):
        curve = value.cauchy or value.table
        assert curve is not None
        return curve.at(wavelength_nm)
    return np.full(np.shape(wavelength_nm), float(value))


def absorbed(value: Absorbed, wavelength_nm: ArrayLike) -> Real:
    """Return an absorption coefficient (natural, mm⁻¹) at wavelengths in nm, any shape."""
    if isinstance(value, AbsorptionCurve):
        return value.table.at(wavelength_nm)
    return np.full(np.shape(wavelength_nm), float(value))
