"""How a crystal stands: which of its directions point along x, y, z."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from crystal_core.materials.written_frames import Matrix, is_right_handed, orthonormal
from crystal_core.scene.parts import Angle, Choice, Direction, Location, Part

__all__ = ["CrystalDirection", "Indices", "OpticalDirection", "Orientation", "Rotation", "Turn"]

_Index = Annotated[int, Field(strict=True, ge=-99, le=99)]


def _not_zero(indices: tuple[int, int, int]) -> tuple[int, int, int]:
    if indices == (0, 0, 0):
        raise PydanticCustomError("scene", "must not be [0, 0, 0]")
    return indices


def _proper(matrix: Matrix) -> Matrix:
    turned = orthonormal(matrix, "the rotation")
    if not is_right_handed(turned):
        raise PydanticCustomError("scene", "must be a rotation: its determinant is -1, that of a mirror image")
    return turned


Indices = Annotated[tuple[_Index, _Index, _Index], AfterValidator(_not_zero)]
"""Three whole numbers, not all zero, on the axes of the entry's cell."""

Rotation = Annotated[Matrix, AfterValidator(_proper)]
"""Rows of a proper rotation matrix, right to 1e-6."""

OpticalDirection = Literal[
    "optic-axis",
    "other-optic-axis",
    "acute-bisectrix",
    "obtuse-bisectrix",
    "optic-normal",
    "alpha",
    "beta",
    "gamma",
]


class CrystalDirection(Choice):
    """A direction of the crystal."""

    choices = ("hkl", "uvw", "optical", "crystal")

    hkl: Indices | None = Field(default=None, description="Normal of a lattice plane, pointing out of the face (hkl)")
    uvw: Indices | None = Field(default=None, description="Direction of the lattice")
    optical: OpticalDirection | None = Field(default=None, description="Direction of the indicatrix at 589.3 nm")
    crystal: Direction | None = Field(default=None, description="Of the crystal frame (x ∥ a, z ∥ c*, y = z × x)")


class Orientation(Part):
    """Directions of the crystal along the axes of its body, or a matrix.

    z is met exactly and x, or y, as nearly as it can be; without z, x is met exactly and y as nearly as it can be.
    Where one direction is given, the crystal comes there by the smallest turn. With nothing given the crystal frame is
    x, y, z.
    """

    x: CrystalDirection | None = None
    y: CrystalDirection | None = None
    z: CrystalDirection | None = None
    matrix: Rotation | None = Field(default=None, description="R of v_body = R v_crystal, rows of a proper rotation")

    @classmethod
    def before(cls, raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
        """Refuse three directions, and directions beside a matrix."""
        axes = [axis for axis in ("x", "y", "z") if raw.get(axis) is not None]
        if len(axes) == 3:
            yield ("y",), "does not go with x and z: two directions fix a crystal"
        if axes and raw.get("matrix") is not None:
            yield ("matrix",), f"does not go with {axes[0]}"


class Turn(Part):
    """A turn of a body with its crystal, right-handed (counter-clockwise where `about` points at the viewer)."""

    about: Direction = (0.0, 0.0, 1.0)
    angle_deg: Angle
