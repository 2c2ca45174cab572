"""The wave surface of a mineral as a document: JSON for programs, PLY for programs that show meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import minerals_db
from crystal_core import __version__
from crystal_core.errors import InputError
from crystal_core.materials.constants import medium as medium_of
from crystal_core.optics.indicatrix import BiaxialIndicatrix, optic_axes, optical_class, principal_frame
from crystal_core.optics.medium import Medium
from crystal_core.optics.wave_surface import SurfaceKind, SurfaceMesh, WaveSurface, wave_surface

__all__ = ["MineralSurface", "mineral_surface"]

OUTER_RGB, INNER_RGB = (230, 159, 0), (0, 114, 178)
"""Orange and blue that the colour-blind can tell apart (Okabe & Ito 2008)."""


@dataclass(frozen=True, slots=True)
class MineralSurface:
    """The index or the ray surface of a mineral at a wavelength, in its crystal frame (x ∥ a, z ∥ c*, y = z × x).

    Parameters
    ----------
    mineral : str
        Id of the entry.
    wavelength_nm : float
        Vacuum wavelength.
    medium : Medium
        What the surface belongs to.
    surface : WaveSurface
        Its two sheets.
    """

    mineral: str
    wavelength_nm: float
    medium: Medium
    surface: WaveSurface

    def document(self) -> dict[str, Any]:
        """Return the surface as a JSON object; vectors are lists of three numbers, triangles of three vertices."""
        indices, axes = principal_frame(self.medium)
        indicatrix = BiaxialIndicatrix.of(Medium.biaxial(list(indices), axes))
        kind = optical_class(self.medium)
        sign = "positive" if bool(indicatrix.is_positive()) else "negative"
        return {
            "mineral": self.mineral,
            "wavelength_nm": self.wavelength_nm,
            "kind": self.surface.kind,
            "indices": [float(n) for n in self.medium.indices],
            "axes": None if kind == "isotropic" else axes.tolist(),
            "optical_class": kind,
            "optic_axes": [axis.tolist() for axis in optic_axes(self.medium)],
            "two_v_deg": float(np.degrees(indicatrix.two_v())) if kind == "biaxial" else None,
            "optic_sign": None if kind == "isotropic" else sign,
            "contact_points": self.surface.contact_points.T.tolist(),
            "outer": _sheet(self.surface.outer),
            "inner": _sheet(self.surface.inner),
        }

    def ply(self) -> bytes:
        """Return both sheets as one binary PLY file.

        They are two parts without a common vertex, each vertex with its sheet's colour and number (`sheet`, 0 for the
        outer one), so that any program shows them apart and can separate them by loose parts.
        """
        sheets = (self.surface.outer, self.surface.inner)
        places = [("x", "<f8"), ("y", "<f8"), ("z", "<f8")]
        looks = [("red", "u1"), ("green", "u1"), ("blue", "u1"), ("sheet", "u1")]
        count = sheets[0].vertices.shape[1]
        vertices = np.empty((2, count), np.dtype([*places, *looks]))
        faces = np.empty((2, len(sheets[0].triangles)), np.dtype([("corners", "u1"), ("vertex_indices", "<i4", (3,))]))
        for number, (sheet, rgb) in enumerate(zip(sheets, (OUTER_RGB, INNER_RGB), strict=True)):
            for (name, _), values in zip((*places, *looks), (*sheet.vertices, *rgb, number), strict=True):
                vertices[name][number] = values
            faces["vertex_indices"][number] = sheet.triangles + number * count
        faces["corners"] = 3
        what = {"index": "wave vectors in units of 2 pi/wavelength", "ray": "ray velocities in units of c"}
        header = [
            "ply",
            "format binary_little_endian 1.0",
            f"comment {self.surface.kind} surface of {self.mineral} at {self.wavelength_nm} nm, isogyre {__version__}",
            f"comment {what[self.surface.kind]}; crystal frame: x along a, z along c*, y = z cross x",
            f"comment sheet 0: outer, {sheets[0].mode}; sheet 1: inner, {sheets[1].mode}",
            f"element vertex {vertices.size}",
            *(f"property double {name}" for name, _ in places),
            *(f"property uchar {name}" for name, _ in looks),
            f"element face {faces.size}",
            "property list uchar int vertex_indices",
            "end_header",
        ]
        return "\n".join(header).encode("ascii") + b"\n" + vertices.tobytes() + faces.tobytes()


def mineral_surface(mineral_id: str, wavelength_nm: float, kind: SurfaceKind, resolution: int) -> MineralSurface:
    """Return the wave surface of a mineral of the database.

    The optical activity of a mineral that has one is left out: in quartz it parts the two sheets of the index surface
    at their contacts by 7·10⁻⁵, a hundredth of what they are apart across the axis.

    Parameters
    ----------
    mineral_id : str
        Such as ``calcite``.
    wavelength_nm : float
        Vacuum wavelength, within the range for which the indices are known.
    kind, resolution
        As for `crystal_core.optics.wave_surface.wave_surface`.

    Raises
    ------
    InputError
        An unknown mineral, a wavelength out of its range, an unknown kind, a resolution that is too low.
    """
    try:
        mineral = minerals_db.mineral(mineral_id)
    except minerals_db.UnknownMineralError as error:
        raise InputError.at("mineral", str(error)) from None
    ranges = [curve.range_nm for curve in mineral.dispersion.values()]
    shortest, longest = max(low for low, _ in ranges), min(high for _, high in ranges)
    if not shortest <= wavelength_nm <= longest:
        reason = f"the indices of {mineral.id} are known from {shortest:g} to {longest:g} nm, not at {wavelength_nm:g}"
        raise InputError.at("--wavelength-nm", reason)
    medium = medium_of(mineral, wavelength_nm).inactive()
    return MineralSurface(mineral.id, wavelength_nm, medium, wave_surface(medium, kind, resolution))


def _sheet(mesh: SurfaceMesh) -> dict[str, Any]:
    return {"mode": mesh.mode, "vertices": mesh.vertices.T.tolist(), "triangles": mesh.triangles.tolist()}
