"""Plane waves in crystals and at their faces: functions over arrays, no scene, no image, no global state.

Conventions (``docs/conventions.md``): fields vary as exp(i(k·r − ωt)); wave vectors are in units of 2π/λ; H is scaled
by the vacuum impedance, so H = k × E and D = −k × H = ε E (in optically active media B stands for H and D gains a term
in H, see `berreman.activity`). Arrays of vectors are structures of arrays, shape (3, N).

Where to begin: a `Medium`; its `waves_along` a wave normal; `scatter` at the face between two; a `plate_stack`; the
`wave_surface` of a crystal and its `internal_cone`.
"""

from crystal_core.optics.absorption import absorption_along_ray
from crystal_core.optics.coherency import Coherency
from crystal_core.optics.conical import Cone, external_cone, internal_cone, trace_internal_cone
from crystal_core.optics.curvature import gaussian_curvature
from crystal_core.optics.directions import PlaneWave, waves_along
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.frames import InterfaceFrame, interface_frame, transverse_frame
from crystal_core.optics.indicatrix import (
    BiaxialIndicatrix,
    OpticalClass,
    dissipation,
    optic_axes,
    optical_class,
    permittivity,
    principal_frame,
)
from crystal_core.optics.interface import Face, Scattering, scatter, solve_face
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Wave
from crystal_core.optics.mueller import mueller
from crystal_core.optics.plates import Plate, StackOptics, plate_stack
from crystal_core.optics.retardation import degree_of_coherence, retardation_nm
from crystal_core.optics.wave_surface import SurfaceMesh, WaveSurface, wave_surface

__all__ = [
    "BiaxialIndicatrix",
    "Coherency",
    "Cone",
    "Face",
    "InterfaceFrame",
    "Medium",
    "OpticalClass",
    "PlaneWave",
    "Plate",
    "Scattering",
    "StackOptics",
    "SurfaceMesh",
    "Wave",
    "WaveSurface",
    "absorption_along_ray",
    "degree_of_coherence",
    "dissipation",
    "external_cone",
    "framed",
    "gaussian_curvature",
    "interface_frame",
    "internal_cone",
    "mueller",
    "optic_axes",
    "optical_class",
    "permittivity",
    "plate_stack",
    "principal_frame",
    "retardation_nm",
    "scatter",
    "solve_face",
    "trace_internal_cone",
    "transverse_frame",
    "wave_surface",
    "waves_along",
]
