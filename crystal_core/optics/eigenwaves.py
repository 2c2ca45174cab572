"""The eigenwaves of any medium at an interface."""

from __future__ import annotations

from crystal_core.optics.active import FramedActive
from crystal_core.optics.berreman import is_active
from crystal_core.optics.biaxial import FramedBiaxial
from crystal_core.optics.framed import FramedMedium
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.isotropic import FramedIsotropic
from crystal_core.optics.medium import Medium
from crystal_core.optics.uniaxial import FramedUniaxial

__all__ = ["framed"]


def framed(medium: Medium, frame: InterfaceFrame) -> FramedMedium:
    """Return a medium in the frame of an interface, by its activity and its number of principal indices."""
    if is_active(medium):
        return FramedActive(medium, frame)
    kinds: tuple[type[FramedMedium], ...] = (FramedIsotropic, FramedUniaxial, FramedBiaxial)
    return kinds[len(medium.indices) - 1](medium, frame)
