"""Bodies that are sawn or cleaved: the rectangular block and the cleavage rhombohedron."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.polyhedron import ConvexPolyhedron

__all__ = ["block", "rhombohedron", "rotation_about_z"]

Real = NDArray[np.float64]


def block(size_mm: tuple[float, float, float]) -> ConvexPolyhedron:
    """Return a rectangular block centred on the origin, its edges along x, y, z."""
    normals = np.concatenate((np.eye(3), -np.eye(3)))
    half = 0.5 * np.asarray(size_mm, np.float64)
    return ConvexPolyhedron.from_half_spaces(normals, np.concatenate((half, half)))


def rhombohedron(
    pole_angle_deg: float, spacing_mm: tuple[float, float, float], axis_azimuth_deg: float
) -> tuple[ConvexPolyhedron, Real]:
    """Return a rhombohedron that lies on one of its faces, centred on the origin, and how its crystal is turned.

    Parameters
    ----------
    pole_angle_deg : float
        Angle between a face normal and the threefold axis c.
    spacing_mm : tuple of float
        Distances between the three pairs of parallel faces; the last pair is horizontal.
    axis_azimuth_deg : float
        Azimuth of the axis, counter-clockwise from x.

    Returns
    -------
    body : ConvexPolyhedron
        Two of its faces are z = ± spacing[2]/2.
    rotation : Real
        R of v_world = R v_crystal, shape (3, 3), with the threefold axis c along the crystal's z, c_z > 0.
    """
    pole = np.deg2rad(pole_angle_deg)
    turns = np.deg2rad((120.0, 240.0, 0.0))
    # Face normals about c = z, the third at azimuth 180° so that c leans towards +x once that face is horizontal.
    normals = np.stack(
        (-np.sin(pole) * np.cos(turns), -np.sin(pole) * np.sin(turns), np.full(3, np.cos(pole))), axis=-1
    )
    lean = np.array(((np.cos(pole), 0.0, np.sin(pole)), (0.0, 1.0, 0.0), (-np.sin(pole), 0.0, np.cos(pole))))
    turn = rotation_about_z(axis_azimuth_deg) @ lean
    upper = normals @ turn.T
    upper[2] = (0.0, 0.0, 1.0)
    half = 0.5 * np.asarray(spacing_mm, np.float64)
    body = ConvexPolyhedron.from_half_spaces(np.concatenate((upper, -upper)), np.concatenate((half, half)))
    return body, turn


def rotation_about_z(angle_deg: float) -> Real:
    """Return the matrix, shape (3, 3), that turns vectors counter-clockwise seen from +z."""
    angle = np.deg2rad(angle_deg)
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array(((cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)))
