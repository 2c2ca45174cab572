"""Where bodies are: at their positions, on what they rest on, inside their hosts, face to face with their partners."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import Fault, InputError
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.scene.document import SceneDocument
from crystal_core.scene.staged.body import NOBODY, MadeBody, StagedBody
from crystal_core.scene.staged.convex import contains
from crystal_core.scene.staged.flat import StagedSurface

__all__ = ["placed_bodies"]

Real = NDArray[np.float64]

SAME_MM = 1e-6
"""Corners of faces in contact that differ by less are the same: scenes are written with a few digits."""


def placed_bodies(
    document: SceneDocument, made: Mapping[str, MadeBody], surfaces: Sequence[StagedSurface]
) -> tuple[StagedBody, ...]:
    """Return all bodies in the world, in the order of the scene; each knows what is on either side of its faces.

    Parameters
    ----------
    document : SceneDocument
        The scene.
    made : mapping
        Its bodies at their own centres, by name.
    surfaces : sequence of StagedSurface
        What bodies may rest on.

    Raises
    ------
    InputError
        Bodies that are joined and have no face in common.
    """
    centres: dict[str, Real] = {}
    for name in made:
        _place(name, document, made, surfaces, centres)
    bodies: list[StagedBody] = []
    for name, body in made.items():
        for individual, solid in enumerate(body.solids):
            where = solid.transformed(np.eye(3), centres[name])
            count = len(solid.labels)
            sides = np.zeros(count, np.intp), np.full(count, NOBODY, np.intp)
            number = len(bodies) + 1
            bodies.append(StagedBody(name, f"/bodies/{name}", individual, where, centres[name], number, *sides, NOBODY))
    _know_hosts(document, bodies)
    _know_neighbours(document, made, bodies)
    return tuple(bodies)


def _place(
    name: str,
    document: SceneDocument,
    made: Mapping[str, MadeBody],
    surfaces: Sequence[StagedSurface],
    centres: dict[str, Real],
) -> None:
    """Find the centre of a body, and first of what it depends on."""
    if name in centres:
        return
    body = document.bodies[name]
    under = body.depends_on
    if under in made:
        assert under is not None
        _place(under, document, made, surfaces, centres)
    given = np.asarray(body.position_mm or (0.0, 0.0, 0.0), np.float64)
    if body.rests_on is None:
        centres[name] = given + (centres[under] if under is not None else 0.0)
        return
    up = np.array((0.0, 0.0, 1.0))
    if body.rests_on in made:
        floor = centres[body.rests_on][2] + made[body.rests_on].highest(up)
    else:
        floor = min(s.plane.centre[2] for s in surfaces if s.name == body.rests_on)
    centres[name] = np.array((given[0], given[1], floor + body.gap + made[name].highest(-up)))


def _know_hosts(document: SceneDocument, bodies: list[StagedBody]) -> None:
    """Put bodies inside of others, in whose medium they then lie."""
    for number, body in enumerate(bodies):
        host = document.bodies[body.name].inside
        if host is None:
            continue
        candidates = [i for i, other in enumerate(bodies) if other.name == host]
        holding = next((i for i in candidates if contains(bodies[i].solid.body, body.centre)), candidates[0])
        outside = np.full_like(body.outside, bodies[holding].medium)
        bodies[number] = replace(body, host=holding, outside=outside)


def _know_neighbours(document: SceneDocument, made: Mapping[str, MadeBody], bodies: list[StagedBody]) -> None:
    """Join the individuals of twins, and bodies that the scene joins."""
    faults: list[Fault] = []
    numbers = {name: [i for i, body in enumerate(bodies) if body.name == name] for name in made}
    for name, body in made.items():
        if body.contact is not None:
            first, second = numbers[name]
            _join(bodies, (first, body.contact[0]), (second, body.contact[1]))
        partner = document.bodies[name].joined_to
        if partner is None:
            continue
        common = [
            ((i, a), (j, b)) for i in numbers[name] for j in numbers[partner] for a, b in _common(bodies[i], bodies[j])
        ]
        for one, other in common:
            _join(bodies, one, other)
        if not common:
            reason = f"no face of {name} lies on one of {partner} with the same corners: join faces of the same outline"
            faults.append(Fault(f"/bodies/{name}/joined_to", reason))
    if faults:
        raise InputError(faults)


def _join(bodies: list[StagedBody], one: tuple[int, int], other: tuple[int, int]) -> None:
    for (body, face), (across, _) in ((one, other), (other, one)):
        outside, neighbour = bodies[body].outside.copy(), bodies[body].neighbour.copy()
        outside[face], neighbour[face] = bodies[across].medium, across
        bodies[body] = replace(bodies[body], outside=outside, neighbour=neighbour)


def _common(one: StagedBody, other: StagedBody) -> list[tuple[int, int]]:
    """Return the pairs of faces that lie on each other, corner on corner."""
    a, b = one.solid.body, other.solid.body
    if not isinstance(a, ConvexPolyhedron) or not isinstance(b, ConvexPolyhedron):
        return []
    opposite = np.argwhere(a.normals @ b.normals.T < -1.0 + 1e-9)
    return [
        (int(i), int(j))
        for i, j in opposite
        if _same_corners(a.vertices[list(a.faces[i])], b.vertices[list(b.faces[j])])
    ]


def _same_corners(one: Real, other: Real) -> bool:
    if one.shape != other.shape:
        return False
    distance = np.abs(one[:, None] - other[None]).max(axis=2)
    return bool((distance.min(axis=1) < SAME_MM).all() and (distance.min(axis=0) < SAME_MM).all())
