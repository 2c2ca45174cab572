"""Waves of a uniaxial medium, as in `crystal_core.optics.uniaxial`."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from benchmarks.compiled_frame import Array, Axis, Frame, Mode, compiled, components
from crystal_core.optics import uniaxial

__all__ = ["uniaxial_ahead", "uniaxial_all"]

ON_AXIS_SQUARE = (uniaxial.ON_AXIS * float(np.finfo(np.float64).eps)) ** 2


class Crystal(NamedTuple):
    """What the waves of both directions share."""

    kappa: float
    eps_o: float
    eps_e: float
    c: Axis
    root_o: float
    root_e: float
    a: float
    b: float


@compiled
def _crystal(medium: Array, i: int, frame: Frame) -> Crystal:
    kappa = frame.kappa
    eps_o, eps_e = medium[0, i] * medium[0, i], medium[1, i] * medium[1, i]
    c = components(medium[2, i], medium[3, i], medium[4, i], frame)
    cx, _, cz = c
    difference = eps_e - eps_o
    a = eps_o + difference * cz * cz
    discriminant = eps_o * (eps_e * a - kappa * kappa * (eps_o + difference * (cx * cx + cz * cz)))
    root_o, root_e = math.sqrt(eps_o - kappa * kappa), math.sqrt(discriminant)
    return Crystal(kappa, eps_o, eps_e, c, root_o, root_e, a, difference * kappa * cx * cz)


@compiled
def _pair(crystal: Crystal, sign: float) -> tuple[Mode, Mode]:
    kappa, eps_o, eps_e = crystal.kappa, crystal.eps_o, crystal.eps_e
    cx, cy, cz = crystal.c
    difference = eps_e - eps_o

    q_o = sign * crystal.root_o
    mx, my, mz = -q_o * cy, q_o * cx - kappa * cz, kappa * cy
    m2 = mx * mx + my * my + mz * mz

    root = sign * crystal.root_e
    slope = crystal.a * q_o + crystal.b + root
    straight = abs(slope) < abs(root) or slope == 0.0
    shift = (root - crystal.b) / crystal.a - q_o if straight else difference * m2 / slope
    q_e = q_o + shift

    nx, ny, nz = mx - shift * cy, my + shift * cx, mz
    m2_e = nx * nx + ny * ny + nz * nz
    if m2 <= ON_AXIS_SQUARE * eps_o:
        mx, my, mz = 0.0, 1.0, 0.0
        nx, ny, nz = 0.0, 1.0, 0.0
        m2_e = 0.0

    ordinary = Mode(q_o, mx, my, mz, -q_o * my, q_o * mx - kappa * mz, kappa, 0.0, q_o)
    inverse = 1.0 / eps_o
    along_c = m2_e * (1.0 / eps_e - inverse)
    stretch = difference * (kappa * cx + q_e * cz)
    extraordinary = Mode(
        q_e,
        q_e * ny * inverse + along_c * cx,
        (kappa * nz - q_e * nx) * inverse + along_c * cy,
        -kappa * ny * inverse + along_c * cz,
        nx,
        ny,
        eps_o * kappa + stretch * cx,
        stretch * cy,
        eps_o * q_e + stretch * cz,
    )
    return ordinary, extraordinary


@compiled
def uniaxial_all(medium: Array, i: int, frame: Frame) -> tuple[Mode, Mode, Mode, Mode]:
    """Return both waves along the normal, then both against it; rows of `medium`: n_o, n_e, the axis."""
    crystal = _crystal(medium, i, frame)
    return _pair(crystal, 1.0) + _pair(crystal, -1.0)


@compiled
def uniaxial_ahead(medium: Array, i: int, frame: Frame) -> tuple[Mode, Mode]:
    """Return both waves along the normal."""
    return _pair(_crystal(medium, i, frame), 1.0)
