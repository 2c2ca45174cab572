"""Where straight lines cross the unit sphere; ellipsoids are it in stretched coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import dot

__all__ = ["sphere_chord"]

Real = NDArray[np.float64]


def sphere_chord(point: Real, direction: Real) -> tuple[Real, Real]:
    """Return where straight lines enter and leave the unit sphere about the origin.

    Parameters
    ----------
    point, direction : Real
        Shape (3, N).

    Returns
    -------
    enters, leaves : Real
        Distances in lengths of the direction, shape (N,); inf and −inf where the line misses or touches.

    Notes
    -----
    E. Haines and others, Precision Improvements for Ray/Sphere Intersection, in: Ray Tracing Gems (2019), chapter 7:
    the discriminant from the line's distance to the centre, and the root that would cancel from the product of both.
    A line that starts on the sphere therefore leaves it at a distance that is right to rounding.
    """
    a, b = dot(direction, direction), dot(point, direction)
    foot = point - (b / a) * direction
    inside = 1.0 - dot(foot, foot)
    hit = inside > 0.0
    root = np.sqrt(a * np.where(hit, inside, 1.0))
    q = -(b + np.copysign(root, b))
    product = dot(point, point) - 1.0
    one, other = q / a, product / q
    ahead = b < 0.0
    enters, leaves = np.where(ahead, other, one), np.where(ahead, one, other)
    return np.where(hit, enters, np.inf), np.where(hit, leaves, -np.inf)
