"""Rays and amplitudes at a face by prtLab, in its sequential mode, for isotropic and uniaxial media.

Its scene and solid modes are not used: they move along k in place of the ray. Waves inside a crystal are made by light
that enters it from a dense glass through a parallel face. Its normal is always +z, so cases are turned.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import prtlab  # type: ignore[import-untyped]

from tests.reference.arithmetic import Array
from tests.reference.media import Media

__all__ = ["PRISM", "Event", "Outgoing", "events"]

PRISM = 2.7
"""Index of the glass from which a crystal is entered: above all indices of the cases."""


@dataclass(frozen=True)
class Outgoing:
    """A wave that leaves the face: k (3,) in units of k0, unit ray, its electric field, flux along +z, unsigned."""

    mode: str
    reflected: bool
    k: Array
    ray: Array
    field: Array
    flux: float


@dataclass(frozen=True)
class Event:
    """An incident wave, its electric field (3,) and flux along +z, and what the face makes of it."""

    mode: str
    k: Array
    field: Array
    flux: float
    outgoing: list[Outgoing]


def _material(media: Media, case: int, frame: Array) -> tuple[str, dict[str, float], dict[str, Array]]:
    indices = media.indices[:, case].tolist()
    if media.kind == "isotropic":
        return "isotropic", {"n": indices[0]}, {}
    return "uniaxial", {"nO": indices[0], "nE": indices[2]}, {"opticAxis": frame @ media.axes[2, :, case]}


def _add(system: prtlab.OpticalSystem, material: tuple[str, dict[str, float], dict[str, Array]]) -> None:
    kind, indices, axes = material
    prtlab.add_surface(system, np.inf, 1.0, "plane", {}, kind, indices, axes)


def _index_times(ray: prtlab.RayBranch) -> Array:
    return np.asarray(ray.metadata.get("phaseIndex", ray.metadata["n"]) * ray.k)


def events(source: Media, target: Media, case: int, frame: Array, kappa: float) -> list[Event]:
    """Return what happens to each incident wave: s and p of an isotropic source, or the two waves of a uniaxial one.

    Parameters
    ----------
    source, target : Media
        Isotropic or uniaxial.
    case : int
        Which of the media.
    frame : (3, 3) array
        Rows x, y, z of the face in the frame of the media: z the normal, x along the tangential k. All vectors come
        back in this frame.
    kappa : float
        Length of the tangential wave vector.
    """
    system = prtlab.create_optical_system(0.5893)
    inside = source.kind != "isotropic"
    if inside:
        _add(system, ("isotropic", {"n": PRISM}, {}))
    _add(system, _material(source, case, frame))
    _add(system, _material(target, case, frame))
    n = PRISM if inside else float(source.indices[0, case])
    q = np.sqrt(n**2 - kappa**2)
    direction = np.array([kappa, 0.0, q]) / n
    s, p = np.array([0.0, 1.0, 0.0]), np.array([q, 0.0, -kappa]) / n
    # from inside one oblique polarization serves: it excites both waves
    polarizations = [("both", 0.6 * s + 0.8 * p)] if inside else [("s", s), ("p", p)]
    found = []
    for name, field in polarizations:
        result = prtlab.polarization_ray_trace(system, direction, np.zeros(3), field)
        for event in result.interactions[1 if inside else 0 :]:
            incident = event.incident
            # an entering wave's flux is counted along its k, all others along the normal
            flux = incident.flux if inside else incident.flux * direction[2]
            outgoing = [
                Outgoing(
                    child.mode,
                    child.branch_type == "reflected",
                    _index_times(child),
                    child.S.real,
                    child.field_e,
                    abs(child.flux),
                )
                for child in event.children
            ]
            found.append(
                Event(incident.mode if inside else name, _index_times(incident), incident.field_e, flux, outgoing)
            )
    return found
