"""Rotations: about axes, of things that face some way, of crystals whose directions are told."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.errors import InputError
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.scene.media import Made
from crystal_core.scene.orientation import CrystalDirection, Orientation, Turn
from crystal_core.scene.specimen import lattice_of
from crystal_core.scene.staged.medium import StagedMedium

__all__ = ["about", "crystal_direction", "crystal_rotation", "facing_frame", "turned"]

Real = NDArray[np.float64]

SODIUM_D_NM = 589.3

PARALLEL = 1e-9
"""Sine of the angle under which two directions are one."""


def about(axis: ArrayLike, angle_deg: float) -> Real:
    """Return the rotation about an axis of any length, shape (3, 3), right-handed (Rodrigues)."""
    u = _unit(np.asarray(axis, np.float64))
    angle = np.deg2rad(angle_deg)
    cross = np.array(((0.0, -u[2], u[1]), (u[2], 0.0, -u[0]), (-u[1], u[0], 0.0)))
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross, np.float64)


def turned(turns: tuple[Turn, ...]) -> Real:
    """Return the rotation of turns one after the other, shape (3, 3)."""
    rotation = np.eye(3)
    for turn in turns:
        rotation = about(turn.about, turn.angle_deg) @ rotation
    return rotation


def facing_frame(facing: ArrayLike, up: ArrayLike | None) -> Real:
    """Return unit vectors right, up, facing as columns, shape (3, 3).

    Without `up` it is z, or y of what faces z or −z, made perpendicular.
    """
    out = _unit(np.asarray(facing, np.float64))
    upright = (0.0, 1.0, 0.0) if np.hypot(out[0], out[1]) < PARALLEL else (0.0, 0.0, 1.0)
    right = _unit(np.cross(np.asarray(upright if up is None else up, np.float64), out))
    return np.stack((right, np.cross(out, right), out), axis=1)


def crystal_rotation(orientation: Orientation | None, made: Made, medium: StagedMedium, pointer: str) -> Real:
    """Return R of v_body = R v_crystal, shape (3, 3).

    Raises
    ------
    InputError
        At or below `pointer`: a direction that the crystal does not have, or two that are parallel.
    """
    if orientation is None:
        return np.eye(3)
    if orientation.matrix is not None:
        return np.asarray(orientation.matrix, np.float64)
    told = [(axis, getattr(orientation, axis)) for axis in ("z", "x", "y")]
    given = [(axis, crystal_direction(d, made, medium, f"{pointer}/{axis}")) for axis, d in told if d is not None]
    if not given:
        return np.eye(3)
    world = np.eye(3)
    axis, first = given[0]
    target = world["xyz".index(axis)]
    if len(given) == 1:
        return _smallest(first, target)
    other, second = given[1]
    across = second - (second @ first) * first
    if np.linalg.norm(across) < PARALLEL:
        raise InputError.at(f"{pointer}/{other}", f"is parallel to the direction along {axis}")
    across = _unit(across)
    aside = world["xyz".index(other)]
    crystal = np.stack((first, across, np.cross(first, across)), axis=1)
    body = np.stack((target, aside, np.cross(target, aside)), axis=1)
    return np.asarray(body @ crystal.T, np.float64)


def crystal_direction(direction: CrystalDirection, made: Made, medium: StagedMedium, pointer: str) -> Real:
    """Return a direction as a unit vector of the crystal frame, shape (3,).

    Raises
    ------
    InputError
        Below `pointer`: an optical direction that the crystal does not single out.
    """
    if direction.crystal is not None:
        return _unit(np.asarray(direction.crystal, np.float64))
    if direction.optical is not None:
        return _optical(direction.optical, medium, f"{pointer}/optical")
    assert made.entry is not None
    lattice = lattice_of(made.entry)
    if direction.hkl is not None:
        return np.asarray(lattice.face_normal(direction.hkl), np.float64)
    assert direction.uvw is not None
    return np.asarray(lattice.direction(direction.uvw), np.float64)


def _optical(name: str, medium: StagedMedium, pointer: str) -> Real:
    at_d = medium.unturned.at(np.array([SODIUM_D_NM]))
    if len(at_d.indices) == 1:
        raise InputError.at(pointer, "the crystal is isotropic: it has no optical directions")
    if at_d.axis is not None:
        if name != "optic-axis":
            raise InputError.at(pointer, "the crystal is uniaxial: it has its optic-axis alone")
        return _unit(at_d.axis.reshape(3, -1)[:, 0])
    indicatrix = BiaxialIndicatrix.of(at_d)
    axes = indicatrix.axes if indicatrix.axes.ndim == 2 else indicatrix.axes[:, :, 0]
    alpha, beta, gamma = axes
    one, two = (v.reshape(3, -1)[:, 0] for v in indicatrix.optic_axes())
    acute, obtuse = (gamma, alpha) if bool(np.all(indicatrix.is_positive())) else (alpha, gamma)
    directions = {
        "optic-axis": one,
        "other-optic-axis": two,
        "acute-bisectrix": acute,
        "obtuse-bisectrix": obtuse,
        "optic-normal": beta,
        "alpha": alpha,
        "beta": beta,
        "gamma": gamma,
    }
    return _unit(directions[name])


def _smallest(start: Real, end: Real) -> Real:
    """Return the rotation by the smallest angle that takes one unit vector to another."""
    axis = np.cross(start, end)
    if np.linalg.norm(axis) < PARALLEL:
        if start @ end > 0:
            return np.eye(3)
        axis = np.cross(end, np.roll(end, 1))  # half a turn about a coordinate axis across
        return about(axis, 180.0)
    return about(axis, float(np.rad2deg(np.arctan2(np.linalg.norm(axis), start @ end))))


def _unit(vector: Real) -> Real:
    return np.asarray(vector / np.linalg.norm(vector), np.float64)
