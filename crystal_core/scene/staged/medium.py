"""What fills a body, in the world: its optics at any wavelength."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.materials import medium as mineral_medium
from crystal_core.optics import Medium
from crystal_core.scene.curves import absorbed, index
from crystal_core.scene.media import Made, Optics
from minerals_db import Mineral

__all__ = ["StagedMedium"]

Real = NDArray[np.float64]

SODIUM_D_NM = 589.3


@dataclass(frozen=True)
class StagedMedium:
    """A medium turned into the world.

    Parameters
    ----------
    made : Made
        As the scene says it.
    rotation : Real
        R of v_world = R v_crystal, a proper rotation, shape (3, 3).
    hand : int
        1 as the entry has it, −1 the mirror image: optical activity has the other sign.
    dispersion : bool
        False: every index is that at 589.3 nm; absorption still depends on the wavelength.
    """

    made: Made
    rotation: Real
    hand: int = 1
    dispersion: bool = True

    @property
    def mineral(self) -> Mineral | None:
        """The entry, None of a medium by its indices."""
        return self.made.entry

    @property
    def unturned(self) -> StagedMedium:
        """The same in the crystal frame."""
        return replace(self, rotation=np.eye(3))

    @property
    def is_isotropic(self) -> bool:
        """Whether it has one index in all directions, by its kind."""
        if self.made.optics is not None:
            return self.made.optics.n is not None
        return self.mineral is not None and self.mineral.optical_class == "isotropic"

    def at(self, wavelength_nm: ArrayLike) -> Medium:
        """Return the medium at vacuum wavelengths in nm, shape (N,), its directions in the world."""
        wavelengths = np.asarray(wavelength_nm, np.float64)
        medium = self._at(wavelengths)
        if self.hand < 0 and medium.gyration is not None:
            medium = medium.active(-medium.gyration)
        if self.dispersion:
            return medium
        still = self._at(np.full(wavelengths.shape, SODIUM_D_NM))
        return replace(medium, indices=still.indices, axis=still.axis, axes=still.axes)

    def _at(self, wavelengths: Real) -> Medium:
        if self.mineral is not None:
            return mineral_medium(self.mineral, wavelengths, self.rotation, self.made.concentrations)
        assert self.made.optics is not None
        return _inline(self.made.optics, wavelengths, self.rotation)


def _inline(optics: Optics, wavelengths: Real, rotation: Real) -> Medium:
    indices = [index(getattr(optics, name), wavelengths) for name in optics.names]
    coefficients = None
    if optics.absorption_per_mm is not None:
        coefficients = [absorbed(getattr(optics.absorption_per_mm, name), wavelengths) for name in optics.names]
    if len(indices) == 1:
        return Medium.isotropic(indices[0], None if coefficients is None else coefficients[0])
    if len(indices) == 2:
        pair = None if coefficients is None else (coefficients[0], coefficients[1])
        return Medium.uniaxial(indices[0], indices[1], rotation[:, 2], pair)
    axes = np.eye(3) if optics.axes is None else np.asarray(optics.axes)
    medium = Medium.biaxial(indices, axes @ rotation.T)
    if coefficients is None:
        return medium
    frame = axes if optics.absorption_axes is None else np.asarray(optics.absorption_axes)
    return medium.absorbing(coefficients, frame @ rotation.T)
