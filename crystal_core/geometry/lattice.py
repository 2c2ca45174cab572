"""The lattice of a crystal: cell, reciprocal cell, faces and directions, in the crystal frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import gcd

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError

__all__ = ["Lattice", "direct_basis", "face_normal"]

Real = NDArray[np.float64]


@dataclass(frozen=True)
class Lattice:
    """A lattice, from the six numbers of its cell.

    The crystal frame is right-handed with x ∥ a, z ∥ c*, y = z × x. In it, with monoclinic axes, y ∥ b; with hexagonal
    axes, z ∥ c. Sources of all relations: International Tables for Crystallography B, chapter 1.1.

    Parameters
    ----------
    lengths : tuple of float
        a, b, c, in any one unit; spacings come in the same.
    angles_deg : tuple of float
        α between b and c, β between c and a, γ between a and b.

    Raises
    ------
    InputError
        These lengths and angles are those of no cell.
    """

    lengths: tuple[float, float, float]
    angles_deg: tuple[float, float, float]

    def __post_init__(self) -> None:
        numbers = np.array((*self.lengths, *self.angles_deg), np.float64)
        if not np.isfinite(numbers).all() or (numbers <= 0.0).any():
            raise InputError.at("/cell", f"lengths and angles of a cell are positive: {numbers.tolist()}")
        alpha, beta, gamma = self.angles_deg
        if alpha + beta + gamma >= 360.0 or 2.0 * max(self.angles_deg) >= alpha + beta + gamma:
            raise InputError.at("/cell", f"three edges cannot enclose the angles {alpha:g}, {beta:g}, {gamma:g}")

    @cached_property
    def direct(self) -> Real:
        """The vectors a, b, c as rows, shape (3, 3)."""
        return direct_basis(self.lengths, self.angles_deg)

    @cached_property
    def reciprocal(self) -> Real:
        """The vectors a*, b*, c* as rows, shape (3, 3), with a·a* = 1, in the reciprocal of the unit."""
        return np.asarray(np.linalg.inv(self.direct).T, np.float64)

    @cached_property
    def metric(self) -> Real:
        """The metric tensor of the dot products of a, b, c, shape (3, 3)."""
        return np.asarray(self.direct @ self.direct.T)

    @property
    def volume(self) -> float:
        """The volume of the cell, in the cube of the unit."""
        return float(np.linalg.det(self.direct))

    def face_normal(self, hkl: Sequence[int]) -> Real:
        """Return the outward unit normal of the face (hkl), along h a* + k b* + l c*, shape (3,)."""
        return _unit(_indices(hkl) @ self.reciprocal)

    def direction(self, uvw: Sequence[int]) -> Real:
        """Return the unit vector along [uvw], u a + v b + w c, shape (3,)."""
        return _unit(_indices(uvw) @ self.direct)

    def d_spacing(self, hkl: Sequence[int]) -> float:
        """Return 1/|h a* + k b* + l c*|: with (hkl) without a common factor the distance of neighbouring planes."""
        return float(1.0 / np.linalg.norm(_indices(hkl) @ self.reciprocal))

    def interfacial_angle_deg(self, hkl_1: Sequence[int], hkl_2: Sequence[int]) -> float:
        """Return the angle between the normals of two faces, as crystallographers tabulate it, degrees 0 to 180."""
        one, other = self.face_normal(hkl_1), self.face_normal(hkl_2)
        # From sine and cosine together: the cosine alone loses half the digits of small angles.
        return float(np.rad2deg(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other)))

    def zone_axis(self, hkl_1: Sequence[int], hkl_2: Sequence[int]) -> tuple[int, int, int]:
        """Return the direction [uvw] of the edge in which two faces meet, without a common factor.

        It points along the cross product of the normals.

        Raises
        ------
        InputError
            The faces are parallel.
        """
        _indices(hkl_1), _indices(hkl_2)
        (h1, k1, l1), (h2, k2, l2) = (tuple(int(index) for index in hkl) for hkl in (hkl_1, hkl_2))
        u, v, w = k1 * l2 - l1 * k2, l1 * h2 - h1 * l2, h1 * k2 - k1 * h2
        factor = gcd(u, v, w)
        if factor == 0:
            raise InputError.at("", f"the faces {tuple(hkl_1)} and {tuple(hkl_2)} are parallel: they meet in no zone")
        return u // factor, v // factor, w // factor


def direct_basis(lengths: tuple[float, float, float], angles_deg: tuple[float, float, float]) -> Real:
    """Return the cell vectors a, b, c as rows, shape (3, 3), in the crystal frame.

    The crystal frame is right-handed with x ∥ a, z ∥ c*, y = z × x. Lengths in any one unit. Source: International
    Tables for Crystallography, vol. B, §1.1.
    """
    alpha, beta, gamma = np.deg2rad(angles_deg)
    a, b, c = lengths
    # c·z fixes the cell's height; c* ∥ z means that a and b lie in the plane of x and y.
    cy = (np.cos(alpha) - np.cos(beta) * np.cos(gamma)) / np.sin(gamma)
    cz = np.sqrt(1.0 - np.cos(beta) ** 2 - cy**2)
    return np.array(
        (
            (a, 0.0, 0.0),
            (b * np.cos(gamma), b * np.sin(gamma), 0.0),
            (c * np.cos(beta), c * cy, c * cz),
        )
    )


def face_normal(basis: Real, hkl: tuple[int, int, int]) -> Real:
    """Return the unit normal of the plane (hkl), h a* + k b* + l c*, shape (3,), for `basis` of `direct_basis`."""
    normal = np.linalg.inv(basis) @ np.asarray(hkl, np.float64)
    return np.asarray(normal / np.linalg.norm(normal), np.float64)


def _indices(indices: Sequence[int]) -> Real:
    numbers = np.asarray(indices, np.float64)
    if numbers.shape != (3,) or not numbers.any():
        raise InputError.at("", f"a face or direction has three indices that are not all zero, not {tuple(indices)}")
    return numbers


def _unit(vector: Real) -> Real:
    return np.asarray(vector / np.linalg.norm(vector), np.float64)
