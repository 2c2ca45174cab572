"""Plane things in the world: diffuse surfaces and thin sheets."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from crystal_core.scene.prints import decoded_print, with_marks
from crystal_core.scene.scene_files import SceneFiles
from crystal_core.scene.sheets import Sheet
from crystal_core.scene.staged.medium import StagedMedium
from crystal_core.scene.staged.stance import crystal_rotation, facing_frame
from crystal_core.scene.surfaces import Surface
from crystal_core.scene.texture import Texture

__all__ = ["Plane", "StagedSheet", "StagedSurface", "staged_sheet", "staged_surfaces"]

Real = NDArray[np.float64]

MARK_MM = 0.4
"""Diameter of a mark that has none of its own."""


@dataclass(frozen=True)
class Plane:
    """A plane outline: `frame` columns are right, up, facing.

    Parameters
    ----------
    centre : Real
        Shape (3,), mm.
    frame : Real
        Shape (3, 3).
    width_mm, height_mm : float
        Of a rectangle; the diameter twice of a disc; inf of an endless plane.
    is_disc : bool
        Whether it is a disc.
    """

    centre: Real
    frame: Real
    width_mm: float
    height_mm: float
    is_disc: bool = False

    @property
    def normal(self) -> Real:
        """The way it faces, unit, shape (3,)."""
        return self.frame[:, 2]

    @property
    def corners(self) -> Real:
        """Corners of the rectangle, or of the square about the disc, shape (4, 3); an endless plane's centre alone."""
        if not np.isfinite(self.width_mm):
            return self.centre[None]
        x, y = 0.5 * self.width_mm * self.frame[:, 0], 0.5 * self.height_mm * self.frame[:, 1]
        return np.stack((-x - y, x - y, x + y, -x + y)) + self.centre

    @property
    def sides(self) -> tuple[Real, Real]:
        """Half-spaces that bound the outline within its plane, (k, 3) and (k,); a disc as its 64-gon from outside."""
        if not np.isfinite(self.width_mm):
            return np.empty((0, 3)), np.empty(0)
        count = 64 if self.is_disc else 4
        angles = 2.0 * np.pi * np.arange(count) / count
        normals = np.outer(np.cos(angles), self.frame[:, 0]) + np.outer(np.sin(angles), self.frame[:, 1])
        reach = np.full(count, 0.5 * self.width_mm) if self.is_disc else self._reach
        return normals, normals @ self.centre + reach

    @property
    def _reach(self) -> Real:
        return 0.5 * np.array((self.width_mm, self.height_mm, self.width_mm, self.height_mm))

    def covers(self, point: Real) -> bool:
        """Tell whether the point's foot on the plane lies within the outline."""
        normals, offsets = self.sides
        return bool(np.all(normals @ point <= offsets))

    def moved(self, rotation: Real, shift: Real) -> Plane:
        """Return the plane with every point x moved to rotation·x + shift."""
        return replace(self, centre=rotation @ self.centre + shift, frame=rotation @ self.frame)


@dataclass(frozen=True)
class StagedSurface:
    """A diffuse plane; a room is six of them.

    Parameters
    ----------
    name, pointer : str
        In the scene.
    surface : Surface
        As written: its reflectance.
    plane : Plane
        Where it is.
    texture : Texture or None
        What is printed on it.
    """

    name: str
    pointer: str
    surface: Surface
    plane: Plane
    texture: Texture | None


@dataclass(frozen=True)
class StagedSheet:
    """A thin element.

    Parameters
    ----------
    name, pointer : str
        In the scene.
    sheet : Sheet
        As written: a polarizer, a retarder or a plate.
    plane : Plane
        Where it is; angles count from `plane.frame[:, 0]` towards `plane.frame[:, 1]`.
    medium : StagedMedium or None
        Of a plate, in the world.
    """

    name: str
    pointer: str
    sheet: Sheet
    plane: Plane
    medium: StagedMedium | None


def staged_surfaces(name: str, surface: Surface, files: SceneFiles) -> tuple[StagedSurface, ...]:
    """Return the planes of a surface.

    Raises
    ------
    InputError
        Its picture cannot be had.
    """
    pointer = f"/surfaces/{name}"
    room = surface.shape.room
    if room is not None:
        walls = (
            _wall(np.asarray(surface.position_mm), room.size_mm, axis, side) for axis in range(3) for side in (1, -1)
        )
        return tuple(StagedSurface(name, pointer, surface, wall, None) for wall in walls)
    texture = None
    if surface.print is not None:
        assert surface.shape.rectangle is not None
        data = None if surface.print == "digits" else files.read(surface.print, f"{pointer}/print")
        texture = Texture(decoded_print(data, f"{pointer}/print"), surface.shape.rectangle.width_mm)
        if surface.marks_mm:
            texture = with_marks(texture, surface.marks_mm, surface.mark_diameter_mm or MARK_MM, pointer)
    return (StagedSurface(name, pointer, surface, _outline(surface, texture), texture),)


def staged_sheet(name: str, sheet: Sheet, dispersion: bool) -> StagedSheet:
    """Return a sheet in the world.

    Raises
    ------
    InputError
        The crystal of a plate cannot stand as it is told.
    """
    pointer = f"/sheets/{name}"
    plane = _outline(sheet, None)
    medium = None
    if sheet.plate is not None:
        unturned = StagedMedium(sheet.plate, np.eye(3), dispersion=dispersion)
        lying = crystal_rotation(sheet.plate.orientation, sheet.plate, unturned, f"{pointer}/plate/orientation")
        medium = replace(unturned, rotation=plane.frame @ lying)
    return StagedSheet(name, pointer, sheet, plane, medium)


def outline(shape: object) -> tuple[float, float, bool]:
    """Return width, height and whether it is a disc, of a rectangle, a disc or an endless plane."""
    rectangle, disc = getattr(shape, "rectangle", None), getattr(shape, "disc", None)
    if rectangle is not None:
        width, height = rectangle.size
        return width, height, False
    if disc is not None:
        return disc.diameter_mm, disc.diameter_mm, True
    return np.inf, np.inf, False


def _outline(placed: Surface | Sheet, texture: Texture | None) -> Plane:
    width, height, is_disc = outline(placed.shape)
    if texture is not None:
        height = texture.height_mm
    frame = facing_frame(placed.facing, placed.up)
    return Plane(np.asarray(placed.position_mm, np.float64), frame, width, height, is_disc)


def _wall(middle: Real, size: tuple[float, float, float], axis: int, side: int) -> Plane:
    inward = np.zeros(3)
    inward[axis] = -side
    frame = facing_frame(inward, None)
    extent = np.abs(frame.T @ np.asarray(size))
    return Plane(middle - 0.5 * size[axis] * inward, frame, float(extent[0]), float(extent[1]))
