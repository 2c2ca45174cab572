"""From Miller indices of a unit cell to face normals in the crystal frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["direct_basis", "face_normal"]

Real = NDArray[np.float64]


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
