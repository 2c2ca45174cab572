"""How a cut stands against the crystal that it is cut from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.solid import Hkl

__all__ = ["CrystalDirection", "Line", "Plane", "cut_orientation", "inclined"]

Real = NDArray[np.float64]

_PARALLEL = 1e-6
"""Directions nearer to each other than this, in radians, do not say how to turn about one of them."""


@dataclass(frozen=True)
class Plane:
    """The outward normal of a lattice plane."""

    hkl: Hkl


@dataclass(frozen=True)
class Line:
    """A direction of the lattice."""

    uvw: Hkl


CrystalDirection = Plane | Line | Sequence[float] | Real
"""A plane's normal, a direction of the lattice, or a vector of any length in the crystal frame, as an optic axis."""


def cut_orientation(
    lattice: Lattice, *, up: CrystalDirection, along: CrystalDirection | None = None, pointer: str = ""
) -> Real:
    """Return how the frame of a cut stands in the frame of its crystal.

    Parameters
    ----------
    lattice : Lattice
        Of the crystal.
    up : CrystalDirection
        What the cut's +z is, exactly.
    along : CrystalDirection, optional
        What the cut's +x is as nearly as it can be: its part across `up`. Without it the cut's frame is the crystal's
        by the smallest turn that brings z to `up`.
    pointer : str
        Where the orientation stands in the input, for errors.

    Returns
    -------
    Real
        R of v_crystal = R v_cut, a proper rotation, shape (3, 3): its columns are the cut's x, y, z in the crystal.

    Raises
    ------
    InputError
        At ``/up`` or ``/along``: no direction. At ``/along``: the same direction as `up`, or its opposite.
    """
    z = _vector(lattice, up, f"{pointer}/up")
    if along is None:
        return _smallest_turn(z)
    towards = _vector(lattice, along, f"{pointer}/along")
    x = towards - (towards @ z) * z
    if np.linalg.norm(x) < _PARALLEL:
        raise InputError.at(
            f"{pointer}/along", "points along the same line as up: it does not say how the cut is turned about it"
        )
    x /= np.linalg.norm(x)
    x -= (x @ z) * z  # what rounding left along z when both were nearly parallel
    x /= np.linalg.norm(x)
    return np.stack((x, np.cross(z, x), z), axis=-1)


def inclined(axis: Sequence[float] | Real, towards: Sequence[float] | Real, angle_deg: float) -> Real:
    """Return the unit vector at an angle from an axis, in its plane with another direction and on that one's side.

    A plate across it is cut at that angle to the axis.

    Raises
    ------
    InputError
        One of them is no direction, or both point along the same line.
    """
    z = _unit(np.asarray(axis, np.float64), "/axis")
    other = _unit(np.asarray(towards, np.float64), "/towards")
    across = other - (other @ z) * z
    if np.linalg.norm(across) < _PARALLEL:
        raise InputError.at("/towards", "points along the same line as the axis")
    across /= np.linalg.norm(across)
    return np.asarray(cos(radians(angle_deg)) * z + sin(radians(angle_deg)) * across)


def _vector(lattice: Lattice, direction: CrystalDirection, pointer: str) -> Real:
    if isinstance(direction, Plane | Line):
        indices = direction.hkl if isinstance(direction, Plane) else direction.uvw
        if not any(indices):
            raise InputError.at(pointer, "(0 0 0) is no direction")
        if isinstance(direction, Plane):
            return lattice.face_normal(indices)
        return lattice.direction(indices)
    return _unit(np.asarray(direction, np.float64), pointer)


def _unit(vector: Real, pointer: str) -> Real:
    if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
        raise InputError.at(pointer, "must be a direction: three numbers that are not all 0")
    scaled = vector / np.abs(vector).max()
    return np.asarray(scaled / np.linalg.norm(scaled))


def _smallest_turn(direction: Real) -> Real:
    """Return the rotation by the smallest angle that takes (0, 0, 1) to a unit vector, (0, 0, −1) by a turn about x."""
    x, y, z = direction
    across = x * x + y * y
    if across < np.finfo(np.float64).tiny:  # (0, 0, ±1) to 1e-154, where 1/across overflows
        return np.diag((1.0, np.sign(z), np.sign(z)))
    # Rodrigues: R = I + [v] + [v]²/(1 + z) with v = (0, 0, 1) × direction; 1/(1 + z) without cancellation near −1.
    share = 1.0 / (1.0 + z) if z > 0.0 else (1.0 - z) / across
    return np.array(((1.0 - share * x * x, -share * x * y, x), (-share * x * y, 1.0 - share * y * y, y), (-x, -y, z)))
