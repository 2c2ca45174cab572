"""What the renderer works on: one specimen above a page, a light, a sky and a camera, as arrays, at one frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.geometry import ConvexPolyhedron, FaceFinder
from crystal_core.optics import Medium
from crystal_core.scene.staged.medium import StagedMedium
from crystal_core.scene.texture import Texture

__all__ = [
    "StagedCamera",
    "StagedPage",
    "StagedScene",
    "StagedSpecimen",
]

Real = NDArray[np.float64]


@dataclass(frozen=True)
class StagedSpecimen:
    """The crystal in the world.

    Parameters
    ----------
    body : ConvexPolyhedron
        In the world, mm.
    finder : FaceFinder
        First face on a ray from outside.
    filling : StagedMedium
        What it is made of.
    """

    body: ConvexPolyhedron
    finder: FaceFinder
    filling: StagedMedium

    @property
    def axis(self) -> Real:
        """The direction of c*, the optic axis of a uniaxial crystal, shape (3,)."""
        return self.filling.rotation[:, 2]

    def indices(self, wavelength_nm: ArrayLike) -> tuple[Real, ...]:
        """Return the principal indices, each in the shape of the wavelengths: see `optics.Medium`."""
        wavelengths = np.asarray(wavelength_nm, np.float64)
        found = self.filling.at(wavelengths.reshape(-1)).indices
        return tuple(np.broadcast_to(n, wavelengths.size).reshape(wavelengths.shape) for n in found)

    def medium(self, wavelength_nm: ArrayLike) -> Medium:
        """Return the crystal's medium at the wavelengths, absorption included; optical activity is left out."""
        return self.filling.at(wavelength_nm).inactive()


@dataclass(frozen=True)
class StagedPage:
    """The printed sheet: its texture and the table around it."""

    texture: Texture
    table_reflectance: float


@dataclass(frozen=True)
class StagedCamera:
    """Pinhole at `eye` with unit vectors forward, right, up and tan(vfov/2); `analyser` a unit vector or None."""

    eye: Real
    forward: Real
    right: Real
    up: Real
    tan_half: float
    analyser: Real | None


@dataclass(frozen=True)
class StagedScene:
    """Everything one frame needs."""

    specimen: StagedSpecimen
    page: StagedPage
    light_mm: Real
    sky_fraction: float
    camera: StagedCamera
    exposure: float
