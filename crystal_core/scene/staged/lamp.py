"""Lights in the world."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from crystal_core.scene.lights import Light
from crystal_core.scene.spectra import Spectrum
from crystal_core.scene.staged.flat import Plane, outline
from crystal_core.scene.staged.stance import facing_frame

__all__ = ["StagedLight", "staged_light"]

Real = NDArray[np.float64]


@dataclass(frozen=True)
class StagedLight:
    """A light.

    Parameters
    ----------
    name, pointer : str
        In the scene.
    light : Light
        As written: its strength and polarization.
    spectrum : Spectrum
        Of this frame.
    position : Real or None
        Of a point, shape (3,).
    plane : Plane or None
        Of a beam, its cross-section, and of an area; it shines the way it faces.
    """

    name: str
    pointer: str
    light: Light
    spectrum: Spectrum
    position: Real | None
    plane: Plane | None

    @property
    def kind(self) -> str:
        """Of "point", "beam", "area", "sky"."""
        return self.light.kind

    @property
    def place(self) -> Real:
        """Where it stands, shape (3,); the origin for the sky."""
        if self.position is not None:
            return self.position
        return np.zeros(3) if self.plane is None else self.plane.centre

    def moved(self, rotation: Real, shift: Real) -> StagedLight:
        """Return the light with every point x moved to rotation·x + shift."""
        position = None if self.position is None else rotation @ self.position + shift
        return replace(self, position=position, plane=None if self.plane is None else self.plane.moved(rotation, shift))


def staged_light(name: str, light: Light) -> StagedLight:
    """Return a light in the world."""
    pointer = f"/lights/{name}"
    if light.point is not None:
        return StagedLight(name, pointer, light, light.spectrum, np.asarray(light.point.position_mm, np.float64), None)
    if light.beam is not None:
        frame = facing_frame(light.beam.direction, light.beam.up)
        width, height, is_disc = outline(light.beam.shape)
        plane = Plane(np.asarray(light.beam.position_mm, np.float64), frame, width, height, is_disc)
        return StagedLight(name, pointer, light, light.spectrum, None, plane)
    if light.area is not None:
        frame = facing_frame(light.area.facing, light.area.up)
        width, height, is_disc = outline(light.area.shape)
        plane = Plane(np.asarray(light.area.position_mm, np.float64), frame, width, height, is_disc)
        return StagedLight(name, pointer, light, light.spectrum, None, plane)
    return StagedLight(name, pointer, light, light.spectrum, None, None)
