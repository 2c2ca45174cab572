"""A body whose faces have names: what habits, cleavages, cuts and meshes hand to a scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, cast

import numpy as np
from numpy.typing import NDArray
from typing_extensions import TypeVar

from crystal_core.geometry.body import Body
from crystal_core.geometry.polyhedron import ConvexPolyhedron

__all__ = ["Hkl", "Solid", "hkl_label"]

Real = NDArray[np.float64]

Hkl = tuple[int, int, int]
"""Miller indices of a face, or the three indices of a lattice direction."""

BodyT = TypeVar("BodyT", bound=Body, default=ConvexPolyhedron, covariant=True)


@dataclass(frozen=True)
class Solid(Generic[BodyT]):
    """A body and what its faces are; ``Solid`` without more is one with a `ConvexPolyhedron`.

    Parameters
    ----------
    body : Body
        The body, mm.
    labels : tuple of str
        A name for each face: ``"r 1 0 4"``, ``"table"``.
    hkl : tuple of (int, int, int) or None
        For each face that is a lattice plane its Miller indices, on the lattice of the crystal that fills the body.
    """

    body: BodyT
    labels: tuple[str, ...]
    hkl: tuple[Hkl | None, ...]

    def __post_init__(self) -> None:
        count = self.body.face_count
        if len(self.labels) != count or len(self.hkl) != count:
            raise ValueError(f"{count} faces, but {len(self.labels)} labels and {len(self.hkl)} Miller indices")

    def transformed(self, rotation: Real, shift_mm: Real) -> Solid[BodyT]:
        """Return the solid with every point x moved to rotation·x + shift, shapes (3, 3) and (3,), its crystal too."""
        return Solid(cast(BodyT, self.body.transformed(rotation, shift_mm)), self.labels, self.hkl)


def hkl_label(hkl: Hkl, name: str | None = None) -> str:
    """Return the name of a face: its indices, and the letter of its form before them if it has one."""
    indices = " ".join(str(index) for index in hkl)
    return f"{name} {indices}" if name else indices
