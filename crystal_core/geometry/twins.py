"""Contact twins: two individuals of one crystal that a twin law relates, cut where they meet.

The second individual is the image of the first by a reflection in a lattice plane or by half a turn about a lattice
direction. Both are cut at the plane of composition through the centre of the crystal, so that they share that face and
lie on either side of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from math import gcd

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError, NotSupportedError
from crystal_core.geometry.habit import Form, centroid, check_indices, check_size, diameter, grown, scaled
from crystal_core.geometry.half_spaces import bounded_body
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.point_groups import PointGroup
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.solid import Hkl, Solid, hkl_label

__all__ = ["ContactTwin", "Individual", "twin"]

Whole = NDArray[np.int64]
Real = NDArray[np.float64]

_SAME = 1e-9
"""Directions and, in units of the body, corners that differ by less are the same."""

_HIGHEST_INDEX = 3
"""Of the planes that are tried as planes of composition of a law that names an axis."""


@dataclass(frozen=True)
class Individual:
    """One crystal of a twin.

    Parameters
    ----------
    solid : Solid
        In the crystal frame of the first individual. The hkl are on this individual's own lattice.
    rotation : Real
        How its lattice stands: R of v_first = R v_own for the two crystal frames, a rotation, shape (3, 3). It is the
        same for crystal directions, indicatrix and absorption.
    hand : int
        1: the crystal as its entry describes it; −1: its mirror image, whose optical activity has the other sign.
    """

    solid: Solid
    rotation: Real
    hand: int


@dataclass(frozen=True)
class ContactTwin:
    """Two individuals that meet in one face and lie on either side of it.

    Parameters
    ----------
    individuals : tuple of Individual
        The first has the rotation 1 and the hand 1.
    contact : tuple of int
        The number of the common face in each; its corners are the same to the last bit.
    composition_hkl : tuple of int
        The common plane, on the lattice of the first individual.
    """

    individuals: tuple[Individual, Individual]
    contact: tuple[int, int]
    composition_hkl: Hkl


def twin(
    lattice: Lattice,
    group: PointGroup,
    forms: Sequence[Form],
    size_mm: float,
    *,
    plane_hkl: Hkl | None = None,
    axis_uvw: Hkl | None = None,
    composition_hkl: Hkl | None = None,
    pointer: str = "",
    shape_pointer: str = "",
) -> ContactTwin:
    """Return a contact twin, in the crystal frame of its first individual, the centroid of the pair at the origin.

    Parameters
    ----------
    lattice : Lattice
        Of the crystal.
    group : PointGroup
        Of the crystal, in the setting of the lattice.
    forms : sequence of Form
        The habit of both individuals.
    size_mm : float
        The greatest distance between two corners of the pair.
    plane_hkl, axis_uvw : tuple of int, or None
        The law, exactly one of them: a reflection in a plane, or half a turn about an axis.
    composition_hkl : tuple of int, or None
        The plane in which they meet. None: the twin plane; of an axis the plane at right angles to it, or, where the
        individuals do not fit together there, the one of the largest spacing that holds the axis and in which they do.
    pointer, shape_pointer : str
        Where the law, and forms and size stand in the input, for errors.

    Returns
    -------
    ContactTwin
        Of a law that names an axis, the second individual's rotation is that half turn. Of a law that names a plane, it
        is the smallest turn that, by symmetry, does the same to the lattice as the reflection; the hand changes where
        the crystal has a hand (Brazil twins of quartz: no turn at all, and the other hand).

    Raises
    ------
    InputError
        The law is no law: both or neither of plane and axis, or an operation that leaves the crystal as it is; forms
        and size as in `habit_solid`.
    NotSupportedError
        The individuals have different outlines in the plane of composition: they would not meet in one common face.
    """
    check_size(size_mm, f"{shape_pointer}/size_mm")
    if plane_hkl is not None and axis_uvw is not None:
        raise InputError.at(pointer, "a twin law names either a plane or an axis")
    operation, law = _operation(lattice, plane_hkl, axis_uvw, pointer)
    cartesian = group.cartesian(lattice)
    if (np.abs(cartesian - operation) < _SAME).all(axis=(1, 2)).any():
        raise InputError.at(pointer, f"{law} leaves a crystal of class {group.symbol} as it is: it makes no twin")
    whole = grown(lattice, group, forms, pointer=shape_pointer)
    own, rotation, hand = _own_lattice(group, cartesian, operation)
    for hkl in _compositions(lattice, plane_hkl, axis_uvw, composition_hkl, pointer):
        normal = lattice.face_normal(hkl)
        first, first_face = _half(whole, normal, hkl)
        second, second_face = _image(_half(whole, -operation.T @ normal, None), operation, own)
        joined = _joined(first, first_face, second, second_face)
        if joined is None:
            continue
        second = _with_contact(joined, second_face, -normal, _contact_hkl(lattice, rotation, hkl))
        both = np.concatenate((first.body.vertices, second.body.vertices))
        bodies = (first.body, second.body)
        volumes = np.array([body.volume_mm3 for body in bodies])
        middle = volumes @ np.array([centroid(body) for body in bodies]) / volumes.sum()
        factor = size_mm / diameter(both)
        return ContactTwin(
            (
                Individual(scaled(first, factor, middle), np.eye(3), 1),
                Individual(scaled(second, factor, middle), rotation, hand),
            ),
            (first_face, second_face),
            hkl,
        )
    where = "any plane of low indices" if composition_hkl is None else f"({hkl_label(composition_hkl)})"
    raise NotSupportedError(
        f"{pointer or 'twin'}: twinned by {law}, individuals of this habit have different outlines in {where}; "
        "only twins that meet in one common face can be built: give another composition plane or another habit"
    )


def _operation(lattice: Lattice, plane: Hkl | None, axis: Hkl | None, pointer: str) -> tuple[Real, str]:
    """Return the matrix of the law in the crystal frame, and what it is called."""
    if plane is not None:
        check_indices(plane, f"{pointer}/plane_hkl")
        across = lattice.face_normal(plane)
        return np.eye(3) - 2.0 * np.outer(across, across), f"reflection in ({hkl_label(plane)})"
    if axis is None:
        raise InputError.at(pointer, "a twin law names either a plane or an axis")
    check_indices(axis, f"{pointer}/axis_uvw")
    along = lattice.direction(axis)
    return 2.0 * np.outer(along, along) - np.eye(3), f"half a turn about [{hkl_label(axis)}]"


def _own_lattice(group: PointGroup, cartesian: Real, operation: Real) -> tuple[Whole, Real, int]:
    """Return what takes hkl before the law to hkl on the second individual's own lattice, its rotation, its hand.

    A reflection is no rotation. Followed by an operation q of the crystal that is none either, it does the same to the
    crystal; of a crystal that has no such q, a mirror image: −p, with p of the class, is then one of its lattice.
    """
    if np.linalg.det(operation) > 0.0:
        return np.eye(3, dtype=np.int64), operation, 1
    improper = group.determinants < 0
    hand = -1 if group.is_chiral else 1
    matrices = -group.matrices if group.is_chiral else group.matrices[improper]
    candidates = operation @ np.linalg.inv(-cartesian if group.is_chiral else cartesian[improper])
    traces = np.trace(candidates, axis1=1, axis2=2).round(9)
    best = int(traces.argmax())  # the trace is 1 + 2 cos of the turn
    faces = np.rint(np.linalg.inv(matrices[best])).astype(np.int64)
    return faces, np.asarray(candidates[best]), hand


def _compositions(
    lattice: Lattice, plane: Hkl | None, axis: Hkl | None, given: Hkl | None, pointer: str
) -> Iterator[Hkl]:
    if given is not None:
        check_indices(given, f"{pointer}/composition_hkl")
        yield given
    elif plane is not None:
        yield plane
    elif axis is not None:
        along = lattice.direction(axis)
        span = range(-_HIGHEST_INDEX, _HIGHEST_INDEX + 1)
        planes = [(h, k, m) for h, k, m in product(span, span, span) if gcd(h, k, m) == 1]
        across = [hkl for hkl in planes if np.linalg.norm(lattice.face_normal(hkl) - along) < _SAME]
        holding = [hkl for hkl in planes if np.dot(hkl, axis) == 0 and hkl > (0, 0, 0)]
        yield from across
        yield from sorted(holding, key=lambda hkl: (-round(lattice.d_spacing(hkl), 9), hkl))


def _half(whole: Solid, normal: Real, hkl: Hkl | None) -> tuple[Solid, int]:
    """Return the part of a solid about the origin with normal·x ≤ 0, and the number of the face that cuts it."""
    body = whole.body
    normals = np.concatenate((body.normals, normal[None]))
    offsets = np.append(body.offsets, 0.0)
    cut, kept = bounded_body(normals, offsets, -0.5 * float(body.offsets.min()) * normal)
    labels = (*whole.labels, "composition")
    indices = (*whole.hkl, hkl)
    solid = Solid(cut, tuple(labels[face] for face in kept), tuple(indices[face] for face in kept))
    return solid, len(kept) - 1


def _image(half: tuple[Solid, int], operation: Real, own: Whole) -> tuple[Solid, int]:
    """Return the image of half a crystal, its faces called after their own lattice; a reflection turns faces round."""
    solid, cut = half
    body = solid.body
    mirrored = np.linalg.det(operation) < 0.0
    image = ConvexPolyhedron(
        body.normals @ operation.T,
        body.offsets,
        body.vertices @ operation.T,
        tuple(ring[::-1] for ring in body.faces) if mirrored else body.faces,
    )
    labels: list[str] = []
    indices: list[Hkl | None] = []
    for label, hkl in zip(solid.labels, solid.hkl, strict=True):
        if hkl is None:
            labels.append(label)
            indices.append(None)
            continue
        h, k, m = (int(index) for index in np.array(hkl) @ own)
        name = label.removesuffix(hkl_label(hkl)).strip()
        labels.append(hkl_label((h, k, m), name))
        indices.append((h, k, m))
    return Solid(image, tuple(labels), tuple(indices)), cut


def _joined(first: Solid, first_face: int, second: Solid, second_face: int) -> Solid | None:
    """Return the second solid with the corners of the first in the common face; None where their outlines differ."""
    here = first.body.vertices[list(first.body.faces[first_face])]
    numbers = list(second.body.faces[second_face])
    there = second.body.vertices[numbers]
    gaps = np.linalg.norm(there[:, None] - here[None], axis=2)
    if len(here) != len(there) or gaps.min(axis=1).max() > 1e3 * _SAME * diameter(first.body.vertices):
        return None
    vertices = second.body.vertices.copy()
    vertices[numbers] = here[gaps.argmin(axis=1)]
    body = ConvexPolyhedron(second.body.normals, second.body.offsets, vertices, second.body.faces)
    return Solid(body, second.labels, second.hkl)


def _with_contact(solid: Solid, face: int, normal: Real, hkl: Hkl | None) -> Solid:
    """Return the solid with the plane of one face made exact, and its indices."""
    normals = solid.body.normals.copy()
    normals[face] = normal
    body = ConvexPolyhedron(normals, solid.body.offsets, solid.body.vertices, solid.body.faces)
    return Solid(body, solid.labels, tuple(hkl if number == face else old for number, old in enumerate(solid.hkl)))


def _contact_hkl(lattice: Lattice, rotation: Real, hkl: Hkl) -> Hkl | None:
    """Return the indices of the common face, seen from the second individual; None where they are not whole."""
    reciprocal = -(np.array(hkl) @ lattice.reciprocal) @ rotation
    indices = lattice.direct @ reciprocal
    whole = np.rint(indices)
    if np.abs(indices - whole).max() > 1e-6:
        return None
    h, k, m = (int(index) for index in whole)
    return h, k, m
