"""The shape of a grown crystal: forms at distances from the centre enclose a polyhedron whose faces know their hkl."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import gcd, isfinite

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import pdist

from crystal_core.errors import Fault, InputError
from crystal_core.geometry.half_spaces import bounded_body, is_bounded
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.point_groups import PointGroup
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.solid import Hkl, Solid, hkl_label

__all__ = [
    "MAX_SIZE_MM",
    "MIN_SIZE_MM",
    "Form",
    "centroid",
    "check_indices",
    "check_size",
    "diameter",
    "grown",
    "habit_solid",
    "scaled",
]

Real = NDArray[np.float64]

MIN_SIZE_MM, MAX_SIZE_MM = 1e-6, 1e6
"""Bodies from a nanometre to a kilometre."""

_MOST_FORMS = 40
_HIGHEST_INDEX = 1000
_WIDEST_RATIO = 1e4
"""Of the greatest central distance to the least: beyond, a plate would be thinner than rounding lets planes meet."""


@dataclass(frozen=True)
class Form:
    """All faces that symmetry makes of one, at one distance from the centre.

    Parameters
    ----------
    hkl : tuple of int
        Miller indices of one of the faces.
    central_distance : float
        Distance of its faces from the centre, relative to the other forms.
    name : str or None
        Its letter or name.
    """

    hkl: Hkl
    central_distance: float
    name: str | None = None


def habit_solid(
    lattice: Lattice, group: PointGroup, forms: Sequence[Form], size_mm: float, *, pointer: str = ""
) -> Solid:
    """Return the polyhedron that forms enclose, in the crystal frame, its centroid at the origin.

    Parameters
    ----------
    lattice : Lattice
        Of the crystal.
    group : PointGroup
        Of the crystal, in the setting of the lattice.
    forms : sequence of Form
        What bounds it.
    size_mm : float
        The greatest distance between two corners.
    pointer : str
        Where forms and size stand in the input, for errors.

    Returns
    -------
    Solid
        A face for each face of each form, in their order.

    Raises
    ------
    InputError
        At ``/size_mm``: not a length. At ``/forms``: they close no body. At ``/forms/2``: not a form, one that repeats
        the faces of another, or one that lies outside what the others enclose.
    """
    check_size(size_mm, f"{pointer}/size_mm")
    grown_solid = grown(lattice, group, forms, pointer=pointer)
    body = grown_solid.body
    return scaled(grown_solid, size_mm / diameter(body.vertices), centroid(body))


def grown(lattice: Lattice, group: PointGroup, forms: Sequence[Form], *, pointer: str = "") -> Solid:
    """Return the polyhedron of forms about their common centre, the farthest faces at distance 1.

    Raises
    ------
    InputError
        As `habit_solid` says.
    """
    if not group.fits(lattice):
        raise InputError.at("/cell", f"the cell does not have the symmetry of class {group.symbol}")
    faces, owners = _faces(group, forms, pointer)
    normals = np.array(faces, np.float64) @ lattice.reciprocal
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    if not is_bounded(normals):
        told = ", ".join(f"{{{hkl_label(form.hkl)}}}" for form in forms)
        raise InputError.at(
            f"{pointer}/forms", f"{told} in class {group.symbol} do not close: the body would be without end"
        )
    distances = np.array([forms[owner].central_distance for owner in owners])
    distances /= distances.max()
    body, kept = bounded_body(normals, distances, np.zeros(3))
    # Faces of a form all bound the body or none does: it has their symmetry.
    idle = sorted(set(owners) - {owners[face] for face in kept})
    if idle:
        raise InputError(
            Fault(
                f"{pointer}/forms/{number}",
                f"the faces {{{hkl_label(forms[number].hkl)}}} at {forms[number].central_distance:g} bound nothing: "
                "they lie outside what the other forms enclose",
            )
            for number in idle
        )
    labels = tuple(hkl_label(hkl, forms[owner].name) for hkl, owner in zip(faces, owners, strict=True))
    return Solid(body, labels, tuple(faces))


def _faces(group: PointGroup, forms: Sequence[Form], pointer: str) -> tuple[list[Hkl], list[int]]:
    """Return all faces and the form of each; raise for what is no form, and for a face that comes twice."""
    if not 1 <= len(forms) <= _MOST_FORMS:
        raise InputError.at(f"{pointer}/forms", f"must be 1 to {_MOST_FORMS} forms, not {len(forms)}")
    faults: list[Fault] = []
    faces: list[Hkl] = []
    owners: list[int] = []
    seen: dict[Hkl, int] = {}
    for number, form in enumerate(forms):
        where = f"{pointer}/forms/{number}"
        try:
            check_indices(form.hkl, f"{where}/hkl")
        except InputError as error:
            faults += error.faults
            continue
        if not (isfinite(form.central_distance) and form.central_distance > 0.0):
            faults.append(Fault(f"{where}/central_distance", f"must be greater than 0, not {form.central_distance!r}"))
            continue
        for hkl in group.equivalents(form.hkl):
            factor = gcd(*hkl)
            plane = (hkl[0] // factor, hkl[1] // factor, hkl[2] // factor)
            earlier = seen.setdefault(plane, number)
            if earlier != number:
                told = f"{{{hkl_label(form.hkl)}}} and {{{hkl_label(forms[earlier].hkl)}}}"
                faults.append(Fault(where, f"{told} have the same faces in class {group.symbol}"))
                break
            faces.append(hkl)
            owners.append(number)
    if faults:
        raise InputError(faults)
    distances = [form.central_distance for form in forms]
    if max(distances) > _WIDEST_RATIO * min(distances):
        raise InputError.at(
            f"{pointer}/forms", f"central distances may differ by a factor of {_WIDEST_RATIO:g} and no more"
        )
    return faces, owners


def check_size(length_mm: float, pointer: str) -> None:
    """Raise an InputError at the pointer where a number is not the size of a body."""
    if not MIN_SIZE_MM <= length_mm <= MAX_SIZE_MM:
        raise InputError.at(pointer, f"must be a length from {MIN_SIZE_MM:g} to {MAX_SIZE_MM:g} mm, not {length_mm!r}")


def check_indices(indices: Hkl, pointer: str) -> None:
    """Raise an InputError at the pointer where three integers are no indices of a face or direction."""
    if not any(indices):
        raise InputError.at(pointer, "(0 0 0) is no face and no direction")
    if max(map(abs, indices)) > _HIGHEST_INDEX:
        raise InputError.at(pointer, f"indices are at most {_HIGHEST_INDEX}, not {max(map(abs, indices))}")


def diameter(vertices: Real) -> float:
    """Return the greatest distance between two points, shape (V, 3): of a body's corners, its size."""
    return float(pdist(vertices).max())


def centroid(body: ConvexPolyhedron) -> Real:
    """Return the centre of mass of a body of one density, shape (3,)."""
    middle = body.vertices.mean(axis=0)
    a, b, c = (body.vertices[body.triangles[0][:, corner]] - middle for corner in range(3))
    parts = np.sum(a * np.cross(b, c), axis=1)
    return np.asarray(middle + parts @ (a + b + c) / (4.0 * parts.sum()))


def scaled(solid: Solid, factor: float, origin: Real) -> Solid:
    """Return the solid with every point x moved to factor·(x − origin)."""
    body = solid.body
    moved = ConvexPolyhedron(
        body.normals, factor * (body.offsets - body.normals @ origin), factor * (body.vertices - origin), body.faces
    )
    return Solid(moved, solid.labels, solid.hkl)
