"""What bodies are made of: minerals and glasses of the database, or indices written down."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

import minerals_db
from crystal_core.materials.written_frames import Matrix, orthonormal
from crystal_core.scene.curves import Absorbed, Index
from crystal_core.scene.parts import Choice, Location, Part

__all__ = ["Absorption", "Made", "Optics", "Surroundings"]

_Percent = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=100)]
_Frame = Annotated[Matrix, AfterValidator(lambda rows: orthonormal(rows, "the axes"))]
_SETS = (("n",), ("o", "e"), ("alpha", "beta", "gamma"))


def _known(mineral_id: str) -> str:
    known = minerals_db.minerals()
    if mineral_id not in known:
        reason = str(minerals_db.UnknownMineralError(mineral_id, known))
        raise PydanticCustomError("scene", "{reason}", {"reason": reason})
    return mineral_id


_MineralId = Annotated[str, Field(strict=True, min_length=1, max_length=64), AfterValidator(_known)]


def _one_set(raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
    """Refuse principal values that are neither n, nor o and e, nor alpha, beta and gamma."""
    given = {key for names in _SETS for key in names if raw.get(key) is not None}
    if not any(given == set(names) for names in _SETS):
        yield (), "give n, or o and e, or alpha, beta and gamma"


class Absorption(Part):
    """Natural absorption coefficients of the intensity, mm⁻¹, named as the indices are."""

    n: Absorbed | None = None
    o: Absorbed | None = None
    e: Absorbed | None = None
    alpha: Absorbed | None = None
    beta: Absorbed | None = None
    gamma: Absorbed | None = None

    @classmethod
    def before(cls, raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
        """Refuse a mixture of sets."""
        yield from _one_set(raw)


class Optics(Part):
    """A medium by its indices: isotropic (n), uniaxial (o, e) or biaxial (alpha, beta, gamma).

    The optic axis of a uniaxial medium is z of the crystal frame. The rows of `axes` are the directions in which waves
    of alpha, beta, gamma vibrate, in the crystal frame [default: x, y, z].
    """

    n: Index | None = None
    o: Index | None = None
    e: Index | None = None
    alpha: Index | None = None
    beta: Index | None = None
    gamma: Index | None = None
    axes: _Frame | None = None
    absorption_per_mm: Absorption | None = None
    absorption_axes: _Frame | None = Field(default=None, description="Directions of the coefficients [default: axes]")

    @classmethod
    def before(cls, raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
        """Refuse a mixture of sets, and axes of media that need none."""
        yield from _one_set(raw)
        if raw.get("alpha") is None and raw.get("axes") is not None:
            yield ("axes",), "goes with alpha, beta and gamma: without them the crystal frame says it all"
        if raw.get("alpha") is None and raw.get("absorption_axes") is not None:
            yield ("absorption_axes",), "goes with alpha, beta and gamma"

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse an absorption that is named otherwise than the indices."""
        if self.absorption_per_mm is not None:
            given = [key for key in self.names if getattr(self.absorption_per_mm, key) is None]
            if given:
                yield ("absorption_per_mm",), f"is named as the indices are: {', '.join(self.names)}"
        elif self.absorption_axes is not None:
            yield ("absorption_axes",), "goes with absorption_per_mm"

    @property
    def names(self) -> tuple[str, ...]:
        """Of the principal indices: (n,), (o, e) or (alpha, beta, gamma)."""
        return next(names for names in _SETS if getattr(self, names[0]) is not None)


class Made(Choice):
    """Base of what is made of something: a mineral or a glass of the database, or a medium by its indices."""

    choices = ("mineral", "optics")

    mineral: _MineralId | None = Field(default=None, description="Id of a mineral or a glass of the database")
    concentrations: dict[str, _Percent] | None = Field(
        default=None, description="Weight percent of chromophores of the mineral [default: those of its entry]"
    )
    optics: Optics | None = None

    @classmethod
    def before(cls, raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
        """Refuse concentrations of a medium that has no entry."""
        yield from super().before(raw)
        if raw.get("mineral") is None and raw.get("concentrations") is not None:
            yield ("concentrations",), "goes with a mineral"

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse chromophores that are not in the entry."""
        if self.entry is None:
            return
        absorption = self.entry.absorption
        chromophores = () if absorption is None else tuple(absorption.chromophores)
        for name in self.concentrations or {}:
            if name not in chromophores:
                has = f"has the chromophores {', '.join(chromophores)}" if chromophores else "has no chromophores"
                yield ("concentrations", name), f"unknown chromophore: {self.mineral} {has}"

    @property
    def entry(self) -> minerals_db.Mineral | None:
        """The entry of the mineral, None for a medium by its indices."""
        return None if self.mineral is None else minerals_db.mineral(self.mineral)


class Surroundings(Made):
    """The medium around all bodies: isotropic and transparent."""

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse anisotropic and absorbing surroundings: light would come from infinity through them."""
        faults = list(super().after())
        yield from faults
        if faults:
            return
        if self.optics is not None:
            if self.optics.n is None:
                yield ("optics",), "the surroundings are isotropic: give n"
            if self.optics.absorption_per_mm is not None:
                yield ("optics", "absorption_per_mm"), "the surroundings are transparent"
        elif self.entry is not None and self.entry.optical_class != "isotropic":
            yield ("mineral",), f"the surroundings are isotropic, and {self.mineral} is {self.entry.optical_class}"
        elif self.entry is not None and self.entry.absorption is not None:
            yield ("mineral",), f"the surroundings are transparent, and {self.mineral} absorbs"
