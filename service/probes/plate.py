"""The probe of plates: a stack of plane-parallel plates in light along its normal, between polars or without."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from crystal_core.errors import InputError, IsogyreError, NotSupportedError
from crystal_core.materials.description import MediumDescription
from crystal_core.materials.plate_colour import plate_colours, transmittance
from crystal_core.optics.arrays import Real
from crystal_core.optics.plates import Plate, plate_stack
from crystal_core.optics.retardation import retardation_nm
from service.probes.interface import Complex, Wavelength
from service.probes.probe import Answer, Probe

__all__ = ["PLATE", "PlateAnswer", "PlateDescription", "PlateRequest"]

MAX_PLATES = 64
MAX_WAVELENGTHS = 2_000
MAX_THICKNESS_UM = 100_000.0

Degrees = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-360, le=360)]


class PlateDescription(MediumDescription):
    """A plate: the keys of a medium, and its thickness."""

    thickness_um: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=MAX_THICKNESS_UM)] = Field(
        description="Thickness, µm"
    )

    def plate(self, wavelength_nm: Real) -> Plate:
        """Return the plate at wavelengths of shape (N,)."""
        return Plate(self.medium(wavelength_nm), self.thickness_um)


class PlateRequest(BaseModel):
    """A stack of plates; light goes along +z, through the first plate first. Angles are counted from x towards y."""

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        json_schema_extra={
            "examples": [
                {
                    "plates": [
                        {
                            "mineral": "quartz",
                            "rotation": [[0.8, 0, 0.6], [0.6, 0, -0.8], [0, 1, 0]],
                            "thickness_um": 30,
                        }
                    ],
                    "mount_index": 1.54,
                    "polarizer_deg": 0,
                    "analyser_deg": 90,
                }
            ]
        },
    )

    plates: Annotated[tuple[PlateDescription, ...], Field(min_length=1, max_length=MAX_PLATES)] = Field(
        description="In the order in which the light meets them, in optical contact"
    )
    mount_index: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.01, le=100)] = Field(
        default=1.0, description="Index of the isotropic medium before and behind the stack; 1.54 for a thin section"
    )
    polarizer_deg: Degrees | None = Field(
        default=0.0, description="Direction of the field that the polarizer passes; null: none, unpolarized light"
    )
    analyser_deg: Degrees | None = Field(
        default=90.0, description="Direction of the field that the analyser passes; null: none, all light counts"
    )
    coherent: Literal["exact", "single-pass", "incoherent"] = Field(
        default="single-pass",
        description="exact: all multiple beams interfere. single-pass: the modes of the direct path interfere, what is "
        "reflected inside comes after it as an incoherent sum, as in a thick or rough sample. incoherent: powers "
        "add up",
    )
    wavelengths_nm: Annotated[tuple[Wavelength, ...], Field(min_length=1, max_length=MAX_WAVELENGTHS)] = Field(
        default=tuple(float(nm) for nm in range(380, 781, 5)),
        description="Vacuum wavelengths of the answer's lists, nm; the colour has a grid of its own",
    )


JonesMatrix = tuple[tuple[Complex, Complex], tuple[Complex, Complex]]
MuellerRow = tuple[float, float, float, float]


class PlateAnswer(BaseModel):
    """What the stack does to light; lists go with `wavelengths_nm`."""

    wavelengths_nm: list[float]
    transmittance: list[float] = Field(description="1 is what the same polars, parallel, let through without a stack")
    xyz: tuple[float, float, float] = Field(
        description="CIE 1931 2°, D65; Y = 1 is the open field between parallel polars"
    )
    srgb: tuple[float, float, float] = Field(description="0 to 1, encoded, clipped")
    retardation_nm: list[float] | None = Field(
        description="Of the slow wave behind the fast one, nm; null if the plates do not share their axes"
    )
    jones: list[JonesMatrix] | None = Field(
        description="Transmission, of fields (x, y); of the direct path if single-pass; null if incoherent"
    )
    mueller: list[tuple[MuellerRow, MuellerRow, MuellerRow, MuellerRow]] = Field(
        description="Transmission of Stokes vectors, all light"
    )


def _compute(requests: Sequence[PlateRequest]) -> list[Answer | IsogyreError]:
    answers: list[Answer | IsogyreError] = []
    for request in requests:
        try:
            answers.append(_answer(request))
        except (InputError, NotSupportedError) as error:
            answers.append(error)
    return answers


def _answer(request: PlateRequest) -> Answer:
    def stack(wavelengths: Real) -> list[Plate]:
        return [description.plate(wavelengths) for description in request.plates]

    wavelengths = np.array(request.wavelengths_nm)
    plates = stack(wavelengths)
    optics = plate_stack(plates, wavelengths, request.mount_index, coherent=request.coherent)
    polars = request.polarizer_deg, request.analyser_deg
    colour = plate_colours(stack, request.mount_index, *polars, request.coherent)
    retardation = retardation_nm(plates, wavelengths)
    jones = optics.jones_transmitted
    return {
        "wavelengths_nm": wavelengths.tolist(),
        "transmittance": _plain(transmittance(optics.mueller_transmitted, *polars)),
        "xyz": _plain(colour.xyz),
        "srgb": _plain(colour.srgb),
        "retardation_nm": None if retardation is None else _plain(retardation),
        "jones": None if jones is None else _plain(np.moveaxis(np.stack((jones.real, jones.imag), axis=2), -1, 0)),
        "mueller": _plain(np.moveaxis(optics.mueller_transmitted, -1, 0)),
    }


def _plain(values: Real) -> Any:
    return (np.asarray(values, np.float64) + 0.0).tolist()  # no -0.0


PLATE = Probe("plate", PlateRequest, PlateAnswer, _compute, most_lines=200)
