"""Plane waves in crystals and at their faces: functions over arrays, no scene, no image, no global state.

Conventions (``docs/conventions.md``): fields vary as exp(i(k·r − ωt)); wave vectors are in units of 2π/λ; H is scaled
by the vacuum impedance, so H = k × E and D = −k × H = ε E. Arrays of vectors are structures of arrays, shape (3, N).
"""

from crystal_core.optics.absorption import absorption_along_ray
from crystal_core.optics.coherency import Coherency
from crystal_core.optics.frames import InterfaceFrame, interface_frame, transverse_frame
from crystal_core.optics.interface import Scattering, scatter
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Wave

__all__ = [
    "Coherency",
    "InterfaceFrame",
    "Medium",
    "Scattering",
    "Wave",
    "absorption_along_ray",
    "interface_frame",
    "scatter",
    "transverse_frame",
]
