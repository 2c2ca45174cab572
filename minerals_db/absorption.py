"""How strongly a crystal absorbs light that vibrates along a principal axis.

**Quantity.** α in mm⁻¹, natural and of the intensity: behind d mm of a wave that vibrates along the axis exp(−α d) is
left; κ = α λ/(4π). A decadic absorbance A over d mm is α = ln 10 · A/d.

**Parts.** The coefficients of an axis are the sum of its parts. A part may be caused by chromophores, ions or pairs of
ions whose concentration is given: it grows with the product of the concentrations, each relative to the one that it is
given for (Beer's law; with two of them the law of pairs, as of Fe²⁺ beside Fe³⁺ in tourmaline).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt
from pydantic import Field, model_validator

from minerals_db.curve import Curve, FloatArray, Table
from minerals_db.fields import Entry, Key, Known, Positive, Text
from minerals_db.orientation import FreeOrientation

__all__ = [
    "Absorption",
    "AbsorptionAxis",
    "AbsorptionCurve",
    "AnyAbsorptionCurve",
    "Band",
    "Chromophore",
    "Edge",
    "Part",
    "SpectralBands",
    "TabulatedAbsorption",
]

NotNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.0)]
Percent = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0.0, le=100.0)]
AbsorptionAxis = Literal["n", "o", "e", "a", "b", "c", "alpha", "beta", "gamma"]

PER_CM_NM = 1e7
"""Wavenumber in cm⁻¹ times wavelength in nm."""


class AbsorptionCurve(Curve):
    """An absorption coefficient as a function of the wavelength; the base of every kind of curve."""

    baseline_removed_per_mm: NotNegative | None = Field(
        None, description="Constant of the source (scattering, instrument) that is not in these numbers, per mm"
    )
    fit_rms_per_mm: NotNegative | None = Field(None, description="RMS residual of the fit, per mm")

    def coefficient_per_mm(self, wavelength_nm: npt.ArrayLike) -> FloatArray:
        """Return the absorption coefficient of the intensity, natural.

        Parameters
        ----------
        wavelength_nm : array_like, shape (...)
            Vacuum wavelengths, nm. Outside ``range_nm`` the value at the nearer end is returned; NaN gives NaN.

        Returns
        -------
        float64 array, shape (...)
            mm⁻¹, not negative. Each is computed by itself: its bits do not depend on its neighbours.
        """
        return self._at(wavelength_nm)


class Band(Entry):
    """One band over the wavenumber ν: with x = 2 (ν − centre)/fwhm, peak · 2^(−x²) (Gaussian) or peak/(1 + x²)."""

    shape: Literal["gaussian", "lorentzian"]
    centre_per_cm: Positive = Field(description="cm⁻¹")
    fwhm_per_cm: Positive = Field(description="Full width at half maximum, cm⁻¹")
    peak_per_mm: NotNegative = Field(description="Coefficient at the centre, natural, per mm")
    assignment: Text | None = Field(None, description="What absorbs, if the source says it")

    def per_mm(self, wavenumber_per_cm: FloatArray) -> FloatArray:
        """Return the coefficient, mm⁻¹, at wavenumbers (cm⁻¹) of any shape."""
        offset = (wavenumber_per_cm - self.centre_per_cm) * (2.0 / self.fwhm_per_cm)
        if self.shape == "gaussian":
            return np.asarray(self.peak_per_mm * np.exp(-math.log(2.0) * offset * offset), dtype=np.float64)
        return np.asarray(self.peak_per_mm / (1.0 + offset * offset), dtype=np.float64)


class Edge(Entry):
    """An edge: plateau · exp((ν − edge)/width) below it (F. Urbach, Phys. Rev. 92, 1324 (1953)), plateau above."""

    edge_per_cm: Positive = Field(description="cm⁻¹")
    width_per_cm: Positive = Field(description="Over which the coefficient falls to 1/e, cm⁻¹")
    plateau_per_mm: NotNegative = Field(description="Coefficient from the edge on, natural, per mm")
    assignment: Text | None = Field(None, description="What absorbs, if the source says it")

    def per_mm(self, wavenumber_per_cm: FloatArray) -> FloatArray:
        """Return the coefficient, mm⁻¹, at wavenumbers (cm⁻¹) of any shape."""
        below = np.minimum(wavenumber_per_cm - self.edge_per_cm, 0.0)
        return np.asarray(self.plateau_per_mm * np.exp(below / self.width_per_cm), dtype=np.float64)


class SpectralBands(AbsorptionCurve):
    """Bands and edges over the wavenumber, added up: what fits to measured spectra are made of."""

    model: Literal["bands"]
    bands: tuple[Band, ...] = ()
    edges: tuple[Edge, ...] = ()

    @model_validator(mode="after")
    def _has_terms(self) -> Self:
        if not self.bands and not self.edges:
            raise ValueError("give at least one band or edge")
        return self

    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        wavenumber = PER_CM_NM / wavelength_nm
        total = np.zeros_like(wavenumber)
        for band in self.bands:
            total += band.per_mm(wavenumber)
        for edge in self.edges:
            total += edge.per_mm(wavenumber)
        return total


class TabulatedAbsorption(Table, AbsorptionCurve):
    """Measured coefficients, joined by monotone cubics."""

    values_field: ClassVar[str] = "coefficients_per_mm"

    model: Literal["table"]
    coefficients_per_mm: tuple[NotNegative, ...] = Field(min_length=2, description="One for each wavelength, natural")

    def _value(self, wavelength_nm: FloatArray) -> FloatArray:
        # Monotone cubics stay between their points; their rounding need not.
        return np.maximum(super()._value(wavelength_nm), 0.0)


AnyAbsorptionCurve = Annotated[SpectralBands | TabulatedAbsorption, Field(discriminator="model")]


class Chromophore(Known):
    """What absorbs, and how much of it the crystal holds for which the parts are given."""

    formula: Text = Field(description="Of the oxide or ion that is counted, plain text")
    weight_percent: Percent = Field(description="Share of the crystal's weight, %")


class Part(Entry):
    """A share of the absorption that has one cause."""

    name: Text
    proportional_to: tuple[Key, ...] = Field(
        (), max_length=4, description="Chromophores: it grows with the product of their relative concentrations"
    )
    axes: dict[AbsorptionAxis, AnyAbsorptionCurve] = Field(min_length=1, description="Curve of every principal axis")


class Absorption(Entry):
    """The absorption coefficients of a crystal along its principal axes of absorption.

    Parameters
    ----------
    sample : str
        The crystal measured, or what the numbers were made to look like.
    chromophores : mapping of str to Chromophore
        By key.
    frame : MonoclinicOrientation or TriclinicOrientation, optional
        How the axes lie in the crystal, where they are not those of the indicatrix.
    parts : tuple of Part
        What adds up; all with the same axes.
    """

    sample: Text
    chromophores: dict[Key, Chromophore] = Field(default_factory=dict)
    frame: FreeOrientation | None = Field(
        None,
        description="Of the principal axes of absorption, in a monoclinic or triclinic crystal; None: the indicatrix",
    )
    parts: tuple[Part, ...] = Field(min_length=1)

    @property
    def axes(self) -> tuple[AbsorptionAxis, ...]:
        """The names of the principal axes, in the order of the first part."""
        return tuple(self.parts[0].axes)

    def per_mm(
        self, axis: str, wavelength_nm: npt.ArrayLike, concentrations: Mapping[str, float] | None = None
    ) -> FloatArray:
        """Return the absorption coefficient of one principal axis, α = Σ αₚ(λ) Π (c/c₀).

        Parameters
        ----------
        axis : str
            One of :attr:`axes`.
        wavelength_nm : array_like, shape (...)
            Vacuum wavelengths, nm. Outside the range of a part the value at the nearer end is taken; NaN gives NaN.
        concentrations : mapping of str to float, optional
            Weight % by the key of a chromophore; those not named keep the entry's own.

        Returns
        -------
        float64 array, shape (...)
            mm⁻¹, natural, of the intensity; not negative. Each is computed by itself.

        Raises
        ------
        ValueError
            An axis or a chromophore that is not there (those that are there are named), or a concentration that is
            negative or not finite.
        """
        if axis not in self.axes:
            raise ValueError(f"no axis {axis!r}; the axes are {', '.join(self.axes)}")
        relative = self._relative(concentrations or {})
        total = np.zeros(np.shape(wavelength_nm))
        for part in self.parts:
            share = math.prod(relative[key] for key in part.proportional_to)
            total = total + share * part.axes[axis].coefficient_per_mm(wavelength_nm)
        return total

    def covers(self, shortest_nm: float, longest_nm: float) -> bool:
        """Tell whether every curve is known over the whole interval (nm), so that nothing is clamped."""
        return all(curve.covers(shortest_nm, longest_nm) for part in self.parts for curve in part.axes.values())

    def _relative(self, concentrations: Mapping[str, float]) -> dict[str, float]:
        """Return every concentration as a multiple of the entry's own."""
        known = ", ".join(self.chromophores) or "none"
        for key, value in concentrations.items():
            if key not in self.chromophores:
                raise ValueError(f"no chromophore {key!r}; those with a concentration: {known}")
            if not (math.isfinite(value) and value >= 0.0):
                raise ValueError(f"the concentration of {key} must be a number from 0 up, not {value:g}")
        return {
            key: concentrations.get(key, chromophore.weight_percent) / chromophore.weight_percent
            for key, chromophore in self.chromophores.items()
        }

    @model_validator(mode="after")
    def _parts_agree(self) -> Self:
        axes = set(self.axes)
        for part in self.parts:
            if set(part.axes) != axes:
                told = f"{', '.join(part.axes)} in {part.name!r}, but {', '.join(self.axes)} in {self.parts[0].name!r}"
                raise ValueError(f"every part has the same axes: {told}")
        names = [part.name for part in self.parts]
        if len(set(names)) < len(names):
            raise ValueError("no two parts have the same name")
        return self

    @model_validator(mode="after")
    def _chromophores_agree(self) -> Self:
        used = {key for part in self.parts for key in part.proportional_to}
        if unknown := sorted(used - set(self.chromophores)):
            known = ", ".join(self.chromophores) or "none"
            raise ValueError(f"proportional_to names {', '.join(unknown)}; the chromophores are {known}")
        if idle := sorted(set(self.chromophores) - used):
            raise ValueError(f"no part is proportional_to {', '.join(idle)}")
        return self
