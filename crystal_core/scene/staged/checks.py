"""What must not be: bodies in one place, inclusions that stick out, a camera or a light in a body or a wall."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import Fault, InputError
from crystal_core.scene.staged.body import NOBODY, StagedBody
from crystal_core.scene.staged.convex import Outlines, contains, depth_in, overlap
from crystal_core.scene.staged.flat import Plane, StagedSheet, StagedSurface
from crystal_core.scene.staged.lamp import StagedLight
from crystal_core.scene.staged.view import StagedView

__all__ = ["TOUCHING_MM", "check_scene"]

Real = NDArray[np.float64]

TOUCHING_MM = 1e-6
"""Bodies that are nearer than this touch: far above rounding in scenes of metres, far below any gap meant."""


def check_scene(
    bodies: Sequence[StagedBody],
    surfaces: Sequence[StagedSurface],
    sheets: Sequence[StagedSheet],
    lights: Sequence[StagedLight],
    camera: StagedView,
    when: str,
) -> None:
    """Check where everything is.

    Parameters
    ----------
    bodies, surfaces, sheets, lights, camera
        The parts of a scene, in the world.
    when : str
        " in frame 7", or "" for a scene without motion.

    Raises
    ------
    InputError
        With every fault that there is.
    """
    faults = [
        *_between_bodies(bodies),
        *_inclusions(bodies),
        *_through_planes(bodies, (*surfaces, *sheets)),
        *_covered(surfaces),
        *_camera(camera, bodies, surfaces),
        *_lights(lights, bodies, surfaces),
    ]
    if faults:
        raise InputError(Fault(fault.pointer, fault.message + when) for fault in dict.fromkeys(faults))


def _between_bodies(bodies: Sequence[StagedBody]) -> Iterator[Fault]:
    outlines = Outlines([body.solid.body for body in bodies])
    for i, j in outlines.near_pairs(TOUCHING_MM):
        one, other = bodies[i], bodies[j]
        if _within(bodies, i, j) or _within(bodies, j, i) or (one.name == other.name):
            continue
        deep = overlap(one.solid.body, other.solid.body)
        joined = bool(np.any(one.neighbour == j))
        place = other.pointer
        if deep > TOUCHING_MM:
            yield Fault(place, f"{other.name} and {one.name} overlap{_by(2 * deep)}")
        elif deep >= -TOUCHING_MM and not joined:
            yield Fault(place, f"{other.name} touches {one.name}: leave a gap, or say joined_to (or inside)")


def _within(bodies: Sequence[StagedBody], inner: int, outer: int) -> bool:
    host = bodies[inner].host
    while host != NOBODY:
        if bodies[host].name == bodies[outer].name:
            return True
        host = bodies[host].host
    return False


def _inclusions(bodies: Sequence[StagedBody]) -> Iterator[Fault]:
    for body in bodies:
        if body.host == NOBODY:
            continue
        host = bodies[body.host]
        depth = depth_in(host.solid.body, body.solid.body)
        if depth < TOUCHING_MM:
            how = f"sticks out of {host.name}{_by(-depth)}"
            if depth > -TOUCHING_MM:
                how = f"touches the face of {host.name}"
            yield Fault(f"{body.pointer}/inside", f"{body.name} {how}: it must lie wholly inside")


def _by(length_mm: float) -> str:
    """Return " by 2 mm", or nothing for a mesh, of which the length is not known."""
    return f" by {length_mm:.3g} mm" if np.isfinite(length_mm) else ""


def _through_planes(bodies: Sequence[StagedBody], things: Sequence[StagedSurface | StagedSheet]) -> Iterator[Fault]:
    for thing in things:
        for body in bodies:
            deep = overlap(body.solid.body, thing.plane)
            if deep > TOUCHING_MM:
                yield Fault(body.pointer, f"{body.name} is cut by {thing.name}")
            elif deep >= -TOUCHING_MM:
                yield Fault(body.pointer, f"{body.name} touches {thing.name}: leave a gap (rests_on leaves one)")


def _covered(surfaces: Sequence[StagedSurface]) -> Iterator[Fault]:
    """Refuse equal surfaces in one plane, neither of which covers the other."""
    for number, one in enumerate(surfaces):
        for other in surfaces[:number]:
            if one.name == other.name or not _same_plane(one.plane, other.plane):
                continue
            area, other_area = (s.plane.width_mm * s.plane.height_mm for s in (one, other))
            apart = float(np.linalg.norm(one.plane.centre - other.plane.centre))
            reach = 0.5 * sum(np.hypot(s.plane.width_mm, s.plane.height_mm) for s in (one, other))
            if area == other_area and apart < reach:
                reason = f"{one.name} and {other.name} lie in one plane and are of one size: neither covers the other"
                yield Fault(one.pointer, reason)


def _same_plane(one: Plane, other: Plane) -> bool:
    level = abs(float((one.centre - other.centre) @ one.normal)) < TOUCHING_MM
    return level and float(np.linalg.norm(np.cross(one.normal, other.normal))) < 1e-9


def _camera(camera: StagedView, bodies: Sequence[StagedBody], surfaces: Sequence[StagedSurface]) -> Iterator[Fault]:
    place = camera.pointer
    yield from (Fault(place, f"the camera {reason}") for reason in _where(camera.eye, bodies, surfaces))
    for surface in surfaces:
        if np.isfinite(surface.plane.width_mm) or not bodies:
            continue
        height = float((camera.eye - surface.plane.centre) @ surface.plane.normal)
        others = [float((body.centre - surface.plane.centre) @ surface.plane.normal) for body in bodies]
        if all(height * other < 0 for other in others):
            yield Fault(place, f"the camera stands behind {surface.name}, which is endless and hides everything")


def _lights(
    lights: Sequence[StagedLight], bodies: Sequence[StagedBody], surfaces: Sequence[StagedSurface]
) -> Iterator[Fault]:
    for light in lights:
        if light.kind == "sky":
            continue
        place = f"{light.pointer}/{light.kind}/position_mm"
        yield from (Fault(place, f"the light {reason}") for reason in _where(light.place, bodies, surfaces))
        if light.plane is None:
            continue
        for body in bodies:
            if not contains(body.solid.body, light.place) and overlap(body.solid.body, light.plane) >= -TOUCHING_MM:
                yield Fault(place, f"the light is cut by {body.name}")


def _where(point: Real, bodies: Sequence[StagedBody], surfaces: Sequence[StagedSurface]) -> Iterator[str]:
    """Yield where a point is that should be free."""
    inside = [body for body in bodies if contains(body.solid.body, point)]
    if inside:
        yield f"is inside {inside[-1].name}"
    walls: dict[str, list[float]] = {}
    for surface in surfaces:
        height = float((point - surface.plane.centre) @ surface.plane.normal)
        if surface.surface.shape.room is not None:
            walls.setdefault(surface.name, []).append(height)
        elif abs(height) < TOUCHING_MM and surface.plane.covers(point):
            yield f"is in {surface.name}"
    for name, heights in walls.items():
        if min(heights) < TOUCHING_MM:
            yield f"is in or behind a wall of {name}: its walls are seen and lit from within"
