"""A medium as people and programs write it down: indices on axes, or a mineral turned into the world."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationInfo, WithJsonSchema, field_validator

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials.constants import medium as mineral_medium
from crystal_core.materials.written_frames import Matrix, is_right_handed, matrix_of, orthonormal, wrong
from crystal_core.optics import Medium
from crystal_core.optics.arrays import dot

__all__ = ["Family", "MediumDescription", "joint_medium"]

Real = NDArray[np.float64]

_SYMMETRY_TOLERANCE = 1e-12
_CLASSES = {"isotropic": 1, "uniaxial": 2, "biaxial": 3}
_IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True, slots=True)
class Family:
    """What the media have in common that are computed in one go.

    Parameters
    ----------
    indices : int
        1 isotropic, 2 uniaxial, 3 biaxial.
    mineral : str or None
        Id of the mineral, None where indices are given.
    absorbing, active : bool
        Whether absorption or gyration is given (a mineral's entry tells by itself: False).
    concentrations : tuple of pairs
        Chromophores of the mineral whose weight percent is given, sorted by key.
    """

    indices: int
    mineral: str | None
    absorbing: bool
    active: bool
    concentrations: tuple[tuple[str, float], ...] = ()


def _gyration(value: object) -> object:
    """Return three principal values as a diagonal tensor; anything else as it is."""
    if isinstance(value, list | tuple) and len(value) == 3 and not any(isinstance(row, list | tuple) for row in value):
        if not all(isinstance(g, int | float) and not isinstance(g, bool) and abs(g) <= 1 for g in value):
            raise wrong("must be three principal values or a symmetric 3 × 3 tensor, of numbers from -1 to 1")
        return tuple(tuple(float(g) if i == j else 0.0 for j in range(3)) for i, g in enumerate(value))
    return value


_GYRATION_SCHEMA: dict[str, Any] = {
    "anyOf": [
        {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
        {
            "type": "array",
            "items": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
            "minItems": 3,
            "maxItems": 3,
        },
        {"type": "null"},
    ]
}


class MediumDescription(BaseModel):
    """A medium: either `indices` (with `axes`, absorption and gyration where there are any), or a `mineral`.

    All directions are in the world's frame.
    """

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        json_schema_extra={
            "oneOf": [{"required": ["indices"]}, {"required": ["mineral"]}],
            "examples": [
                {"indices": [1.0]},
                {"indices": [1.6584, 1.4864], "axes": [[1, 0, 0], [0, 0, -1], [0, 1, 0]]},
                {"mineral": "calcite", "rotation": [[1, 0, 0], [0, 0, -1], [0, 1, 0]]},
            ],
        },
    )

    mineral: str | None = Field(default=None, description="Id of a mineral of the database, instead of `indices`")
    rotation: Matrix | None = Field(
        default=None,
        description="R of v_world = R v_crystal, a proper rotation (crystal frame: x ∥ a, z ∥ c*, y = z × x) "
        "[default: the identity]",
    )
    concentrations: Mapping[str, Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=100)]] | None = (
        Field(default=None, description="Weight percent of chromophores of the mineral [default: those of its entry]")
    )
    indices: (
        Annotated[
            tuple[Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.01, le=100)], ...],
            Field(min_length=1, max_length=3),
        ]
        | None
    ) = Field(
        default=None,
        description="Principal indices: one (isotropic), two (n_o, n_e) or three (biaxial, in any order)",
        validate_default=True,
    )
    gyration: Annotated[Matrix | None, BeforeValidator(_gyration), WithJsonSchema(_GYRATION_SCHEMA)] = Field(
        default=None,
        description="Gyration tensor on the rows of `axes`: its three principal values, or symmetric 3 × 3",
    )
    axes: Matrix | None = Field(
        default=None,
        description="Rows: principal directions of n_1, n_2, n_3, orthonormal (uniaxial: the third is the optic axis); "
        "required unless isotropic; of either handedness, right-handed if a gyration is given",
        validate_default=True,
    )
    absorption_per_mm: (
        Annotated[
            tuple[Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1e6)], ...],
            Field(min_length=1, max_length=3),
        ]
        | None
    ) = Field(
        default=None,
        description="Principal absorption coefficients (natural, of intensity, mm⁻¹): three; of an isotropic medium "
        "one, or three equal ones [default: transparent]",
    )
    absorption_axes: Matrix | None = Field(
        default=None, description="Rows: directions of the three coefficients, orthonormal [default: `axes`]"
    )

    @field_validator("mineral")
    @classmethod
    def _known(cls, value: str | None) -> str | None:
        if value is not None and value not in minerals_db.minerals():
            raise wrong(str(minerals_db.UnknownMineralError(value, minerals_db.minerals())))
        return value

    @field_validator("rotation")
    @classmethod
    def _proper(cls, value: Matrix | None, info: ValidationInfo) -> Matrix | None:
        if value is None:
            return None
        if info.data.get("mineral", "") is None:
            raise wrong("turns a mineral; of a medium given by its indices, turn the axes")
        turned = orthonormal(value, "the rotation")
        if not is_right_handed(turned):
            raise wrong("must be a proper rotation: its determinant is -1, that of a mirror image")
        return turned

    @field_validator("concentrations")
    @classmethod
    def _chromophores(cls, value: Mapping[str, float] | None, info: ValidationInfo) -> Mapping[str, float] | None:
        if value is None or "mineral" not in info.data:
            return value
        if info.data["mineral"] is None:
            raise wrong("those of a mineral; a medium given by its indices has its absorption_per_mm")
        absorption = minerals_db.mineral(info.data["mineral"]).absorption
        known = () if absorption is None else tuple(absorption.chromophores)
        if not set(value) <= set(known):
            has = f"has the chromophores {', '.join(known)}" if known else "has none"
            raise wrong(f"{info.data['mineral']} {has}, not {', '.join(sorted(set(value) - set(known)))}")
        return value

    @field_validator("indices")
    @classmethod
    def _either(cls, value: tuple[float, ...] | None, info: ValidationInfo) -> tuple[float, ...] | None:
        if "mineral" in info.data:
            if value is None and info.data["mineral"] is None:
                raise wrong("required, unless a mineral is named")
            _refuse_beside_mineral(value, info)
        return value

    @field_validator("gyration")
    @classmethod
    def _symmetric(cls, value: Matrix | None, info: ValidationInfo) -> Matrix | None:
        _refuse_beside_mineral(value, info)
        if value is None:
            return None
        g = np.array(value)
        if np.abs(g).max() > 1:
            raise wrong("must be three principal values or a symmetric 3 × 3 tensor, of numbers from -1 to 1")
        if np.abs(g - g.T).max() > _SYMMETRY_TOLERANCE:
            raise wrong("must be symmetric")
        rows: list[list[float]] = (0.5 * (g + g.T)).tolist()
        return matrix_of(rows)

    @field_validator("axes")
    @classmethod
    def _frame(cls, value: Matrix | None, info: ValidationInfo) -> Matrix | None:
        _refuse_beside_mineral(value, info)
        if value is None:
            if len(info.data.get("indices") or ()) > 1:
                raise wrong("required: the medium is anisotropic")
            return None
        frame = orthonormal(value, "the axes")
        if info.data.get("gyration") is not None and not is_right_handed(frame):
            raise wrong("must be right-handed, as a gyration is given")
        return frame

    @field_validator("absorption_per_mm")
    @classmethod
    def _one_or_three(cls, value: tuple[float, ...] | None, info: ValidationInfo) -> tuple[float, ...] | None:
        _refuse_beside_mineral(value, info)
        if value is not None:
            isotropic = len(info.data.get("indices") or (1.0, 1.0)) == 1
            if isotropic and len({*value}) > 1:
                raise wrong("an isotropic medium has one coefficient, or three equal ones")
            if len(value) == 2 or (len(value) == 1 and not isotropic):
                raise wrong(f"must be three coefficients, not {len(value)}")
        return value

    @field_validator("absorption_axes")
    @classmethod
    def _absorption_frame(cls, value: Matrix | None, info: ValidationInfo) -> Matrix | None:
        _refuse_beside_mineral(value, info)
        return None if value is None else orthonormal(value, "the absorption axes")

    @property
    def family(self) -> Family:
        """What this medium shares with others of `joint_medium`."""
        if self.mineral is not None:
            kind = _CLASSES[minerals_db.mineral(self.mineral).optical_class]
            return Family(kind, self.mineral, False, False, tuple(sorted((self.concentrations or {}).items())))
        return Family(
            len(self.indices or ()), None, any(a > 0 for a in self.absorption_per_mm or ()), self.gyration is not None
        )

    @property
    def is_isotropic(self) -> bool:
        """Whether the medium has one index in all directions, by its kind: three equal indices count as biaxial."""
        return self.family.indices == 1

    def medium(self, wavelength_nm: ArrayLike) -> Medium:
        """Return the medium at each wavelength.

        Parameters
        ----------
        wavelength_nm : array_like, shape (N,)
            Vacuum wavelengths, nm. Indices that are given are the same for all; a mineral's entry has its own range,
            outside which the value at the nearer end is taken.

        Returns
        -------
        Medium
            Its indices have shape (N,).

        Raises
        ------
        InputError
            A wavelength that is not finite and positive, or another shape.
        """
        wavelengths = _wavelengths(wavelength_nm)
        if self.mineral is not None:
            return mineral_medium(minerals_db.mineral(self.mineral), wavelengths, self.rotation, self.concentrations)
        assert self.indices is not None
        coefficients = self._coefficients()
        return _inline(
            [np.full(wavelengths.shape, n) for n in self.indices],
            np.array(self.axes or _IDENTITY),
            None if coefficients is None else [np.full(wavelengths.shape, a) for a in coefficients],
            np.array(self.absorption_axes or self.axes or _IDENTITY),
            None if self.gyration is None else np.array(self.gyration),
        )

    def _coefficients(self) -> tuple[float, ...] | None:
        """Return one or three absorption coefficients, None if the medium is transparent."""
        if not self.family.absorbing or self.absorption_per_mm is None:
            return None
        return self.absorption_per_mm[:1] if self.is_isotropic else self.absorption_per_mm


def joint_medium(descriptions: Sequence[MediumDescription], wavelength_nm: ArrayLike) -> Medium:
    """Return one medium that holds many, one per ray.

    Parameters
    ----------
    descriptions : sequence of MediumDescription
        One per ray, all of one `MediumDescription.family`.
    wavelength_nm : array_like, shape (N,)
        Each ray's vacuum wavelength, nm.

    Raises
    ------
    InputError
        A wavelength that is not finite and positive.
    ValueError
        Descriptions of different families, or another number of them than of wavelengths.
    """
    wavelengths = _wavelengths(wavelength_nm)
    families = {description.family for description in descriptions}
    if len(families) != 1 or wavelengths.size != len(descriptions):
        raise ValueError("a joint medium takes one description per wavelength, all of one family")
    (family,) = families
    if family.mineral is not None:
        given = dict(family.concentrations)
        unturned = mineral_medium(minerals_db.mineral(family.mineral), wavelengths, concentrations=given)
        return _turned(unturned, _stack([d.rotation or _IDENTITY for d in descriptions]))
    coefficients = None
    if family.absorbing:
        coefficients = list(np.array([d._coefficients() for d in descriptions]).T)
    return _inline(
        list(np.array([d.indices for d in descriptions]).T),
        _stack([d.axes or _IDENTITY for d in descriptions]),
        coefficients,
        _stack([d.absorption_axes or d.axes or _IDENTITY for d in descriptions]),
        _stack([d.gyration or _IDENTITY for d in descriptions]) if family.active else None,
    )


def _inline(
    indices: Sequence[Real], axes: Real, absorption: Sequence[Real] | None, absorption_axes: Real, gyration: Real | None
) -> Medium:
    """Return the medium of indices (N,), frames (3, 3) or (3, 3, N), and a gyration on the rows of `axes`."""
    if len(indices) == 1:
        medium = Medium.isotropic(indices[0], None if absorption is None else absorption[0])
    else:
        medium = (
            Medium.uniaxial(indices[0], indices[1], axes[2]) if len(indices) == 2 else Medium.biaxial(indices, axes)
        )
        if absorption is not None:
            medium = medium.absorbing(absorption, absorption_axes)
    return medium if gyration is None else medium.active(_tensor(axes, gyration))


def _turned(medium: Medium, rotation: Real) -> Medium:
    """Return a medium with its directions turned, each ray's by its own rotation, shape (3, 3, N)."""

    def vector(v: Real) -> Real:
        return np.stack([dot(rotation[i], v) for i in range(3)])

    def frame(rows: Real) -> Real:
        return np.stack([vector(row) for row in rows])

    return replace(
        medium,
        axis=None if medium.axis is None else vector(medium.axis),
        axes=None if medium.axes is None else frame(medium.axes),
        absorption_axes=None if medium.absorption_axes is None else frame(medium.absorption_axes),
        gyration=None if medium.gyration is None else _tensor(rotation.swapaxes(0, 1), medium.gyration),
    )


def _tensor(axes: Real, on_axes: Real) -> Real:
    """Return axesᵀ G axes, exactly symmetric: a tensor on the rows of `axes`, in the world's frame."""
    half = [[dot(on_axes[a], axes[:, j]) for j in range(3)] for a in range(3)]
    g = np.array([[dot(axes[:, i], np.array([half[a][j] for a in range(3)])) for j in range(3)] for i in range(3)])
    return np.asarray(0.5 * (g + g.swapaxes(0, 1)), np.float64)


def _stack(frames: Sequence[Matrix]) -> Real:
    """Return matrices as one array, shape (3, 3, N), components contiguous over the rays."""
    return np.ascontiguousarray(np.moveaxis(np.array(frames), 0, 2))


def _wavelengths(value: ArrayLike) -> Real:
    wavelengths = np.asarray(value, np.float64)
    if wavelengths.ndim != 1 or not np.all(np.isfinite(wavelengths) & (wavelengths > 0)):
        raise InputError.at("/wavelength_nm", "wavelengths must be finite and positive, shape (N,)")
    return wavelengths


def _refuse_beside_mineral(value: object, info: ValidationInfo) -> None:
    if value is not None and info.data.get("mineral") is not None:
        raise wrong(f"does not go with a mineral: {info.data['mineral']!r} has its own")
