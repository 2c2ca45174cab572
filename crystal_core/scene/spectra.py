"""Spectra of lights: CIE illuminants, lines, black bodies, tables. Only their shape counts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Discriminator, Field, Tag

from crystal_core.scene.curves import Table
from crystal_core.scene.parts import BRANCH, Choice, Location, Part, Positive, Wavelength
from crystal_core.spectra.illuminants import d65
from crystal_core.spectra.thermal import black_body, illuminant_a

__all__ = ["BlackBody", "Illuminant", "Line", "Spectrum", "SpectrumOf", "relative_power"]

Real = NDArray[np.float64]

Illuminant = Literal["D65", "A", "E"]
"""CIE daylight and incandescent light, and equal energy."""


class Line(Part):
    """A monochromatic line and its power relative to the others."""

    wavelength_nm: Wavelength
    power: Positive = 1.0


class BlackBody(Part):
    """Planck's radiator."""

    temperature_k: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=500, le=50000)]


class SpectrumOf(Choice):
    """A spectrum that has no name; a table is 0 outside its wavelengths."""

    choices = ("lines", "black_body", "table")

    lines: Annotated[tuple[Line, ...], Field(min_length=1, max_length=100)] | None = None
    black_body: BlackBody | None = None
    table: Table | None = None

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse negative powers and spectra that cannot be seen."""
        if self.table is None:
            return
        faults = list(self.table.outside(0.0, 1e12))
        yield from ((("table", *place), reason) for place, reason in faults)
        seen = [w for w, v in zip(self.table.wavelengths_nm, self.table.values, strict=False) if v > 0]
        if not faults and not any(360 <= w <= 830 for w in seen):
            yield ("table", "values"), "there is no light between 360 and 830 nm"


def relative_power(spectrum: Spectrum, wavelength_nm: ArrayLike) -> Real:
    """Return the power per wavelength of a spectrum without lines, in any unit.

    Parameters
    ----------
    spectrum : Spectrum
        An illuminant, a black body or a table (0 outside its wavelengths).
    wavelength_nm : array_like, shape (...)
        Wavelengths, nm.

    Raises
    ------
    ValueError
        The spectrum is one of lines, which have no power per wavelength.
    """
    wavelengths = np.asarray(wavelength_nm, np.float64)
    if isinstance(spectrum, str):
        if spectrum == "E":
            return np.ones(wavelengths.shape)
        return d65(wavelengths) if spectrum == "D65" else illuminant_a(wavelengths)
    if spectrum.black_body is not None:
        return black_body(wavelengths, spectrum.black_body.temperature_k)
    if spectrum.table is None:
        raise ValueError("lines have no power per wavelength")
    table = spectrum.table
    return np.asarray(np.interp(wavelengths, table.wavelengths_nm, table.values, 0.0, 0.0), np.float64)


def _tell(value: object) -> str:
    return BRANCH + ("mapping" if isinstance(value, dict | Part) else "name")


Spectrum = Annotated[
    Annotated[Illuminant, Tag(BRANCH + "name")] | Annotated[SpectrumOf, Tag(BRANCH + "mapping")], Discriminator(_tell)
]
