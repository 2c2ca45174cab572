"""The probe of an interface: one plane wave at the plane face between two media."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, field_validator

from crystal_core.materials.description import MediumDescription
from crystal_core.materials.written_frames import UNIT_TOLERANCE, Vector, wrong
from service.probes.probe import Probe
from service.probes.scattering import scatter_requests

__all__ = ["INTERFACE", "IncidentWave", "InterfaceAnswer", "InterfaceRequest", "ScatteredWave", "Wavelength"]

NORMAL_PART = 1e-9
"""Largest normal component of a tangential wave vector that is taken for rounding."""

LARGEST_K = 100.0
"""Largest component of a tangential wave vector: no described medium has a larger index."""

Wavelength = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=100, le=100_000)]
"""Vacuum wavelength, nm."""

_EXAMPLE: dict[str, Any] = {
    "wavelength_nm": 589.3,
    "normal": [0, 0, 1],
    "wave_normal": [0.5, 0, 0.8660254],
    "from": {"indices": [1.0]},
    "to": {"indices": [1.6584, 1.4864], "axes": [[0, 0, -1], [0.6, 0.8, 0], [0.8, -0.6, 0]]},
}


class InterfaceRequest(BaseModel):
    """A plane wave that falls on a plane face.

    The order of the fields is that in which they are checked: each check may use the fields before it.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", json_schema_extra={"examples": [_EXAMPLE]})

    wavelength_nm: Wavelength = Field(description="Vacuum wavelength, nm")
    normal: Vector = Field(description="Unit normal of the face, from `from` into `to`")
    source: MediumDescription = Field(alias="from", description="Medium that the light comes from")
    target: MediumDescription = Field(alias="to", description="Medium on the other side")
    wave_normal: Vector | None = Field(
        default=None,
        validate_default=True,
        description="Direction of the incident wave vector, unit, positive along `normal`; if and only if `from` is "
        "isotropic",
    )
    tangential_k: Vector | None = Field(
        default=None,
        validate_default=True,
        description="Part of the incident wave vector in the face, in units of 2π/λ; if and only if `from` is "
        "anisotropic",
    )

    @field_validator("normal")
    @classmethod
    def _unit(cls, value: Vector) -> Vector:
        return _unit_vector(value)

    @field_validator("wave_normal")
    @classmethod
    def _towards_the_face(cls, value: Vector | None, info: ValidationInfo) -> Vector | None:
        source, normal = info.data.get("source"), info.data.get("normal")
        if source is not None and value is None and source.is_isotropic:
            raise wrong("required: `from` is isotropic")
        if source is not None and value is not None and not source.is_isotropic:
            raise wrong("is for an isotropic `from`; of an anisotropic one give tangential_k")
        if value is not None:
            _unit_vector(value)  # not scaled: n times this is the wave vector
            if normal is not None and not _dot(value, normal) > 0:
                raise wrong("must have a positive component along normal, which points from `from` into `to`")
        return value

    @field_validator("tangential_k")
    @classmethod
    def _in_the_face(cls, value: Vector | None, info: ValidationInfo) -> Vector | None:
        source, normal = info.data.get("source"), info.data.get("normal")
        if source is not None and value is None and not source.is_isotropic:
            raise wrong("required: `from` is anisotropic")
        if source is not None and value is not None and source.is_isotropic:
            raise wrong("is for an anisotropic `from`; of an isotropic one give wave_normal")
        if value is not None:
            if max(map(abs, value)) > LARGEST_K:
                raise wrong(f"must have components of at most {LARGEST_K:g}: it is in units of 2π/λ")
            if normal is not None and abs(_dot(value, normal)) > NORMAL_PART:
                raise wrong(f"must lie in the face: its component along normal is {_dot(value, normal):.6g}")
        return value


Complex = tuple[float, float]
"""Real and imaginary part."""
Mode = Literal["s", "p", "ordinary", "extraordinary", "slow", "fast"]


class IncidentWave(BaseModel):
    """A wave that comes in: all of the request's tangential wave vector that propagate into the face."""

    mode: Mode
    k: Vector = Field(description="Wave vector in units of 2π/λ")
    ray: Vector = Field(description="Unit vector of the energy flow")
    index: float = Field(description="Length of k")
    field: tuple[Complex, Complex, Complex] = Field(
        description="Electric field, |E| = 1, its largest component real and positive; H = k × field"
    )


class ScatteredWave(BaseModel):
    """A wave that goes out."""

    kind: Literal["transmitted", "reflected"]
    mode: Mode
    k: Vector = Field(description="Wave vector in units of 2π/λ, real part")
    k_imag: Vector = Field(description="Imaginary part: an evanescent wave decays along it")
    ray: Vector | None = Field(description="Unit vector of the energy flow; null if evanescent")
    index: float | None = Field(description="Length of k; null if evanescent")
    field: tuple[Complex, Complex, Complex] = Field(
        description="Electric field, |E| = 1, its largest component real and positive; H = (k + i k_imag) × field"
    )
    power: list[float] = Field(
        description="Share of each incident wave's flux through the face; 0 if evanescent", min_length=1, max_length=2
    )
    amplitude: list[Complex] = Field(
        description="Amplitude for each incident wave: the tangential parts of its field and Σ amplitude·field of the "
        "reflected waves equal Σ amplitude·field of the transmitted ones, and so do those of H",
        min_length=1,
        max_length=2,
    )
    evanescent: bool
    absorption_per_mm: float | None = Field(description="Of intensity, natural, along the ray; null if evanescent")


class InterfaceAnswer(BaseModel):
    """The waves at the face: one or two that come in, two transmitted ones, two reflected ones."""

    incident: list[IncidentWave] = Field(min_length=1, max_length=2)
    scattered: list[ScatteredWave] = Field(min_length=4, max_length=4)


INTERFACE = Probe("interface", InterfaceRequest, InterfaceAnswer, scatter_requests, most_lines=10_000)


def _unit_vector(value: Vector) -> Vector:
    """Return the vector with its length corrected to 1."""
    length = math.hypot(*value)
    if not abs(length - 1.0) <= UNIT_TOLERANCE:
        raise wrong(f"must be a unit vector, to {UNIT_TOLERANCE:g}; its length is {length:.6g}")
    return value[0] / length, value[1] / length, value[2] / length


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
