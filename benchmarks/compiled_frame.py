"""Frame of a face and the waves in it, one ray at a time, compiled: the yardstick for `crystal_core.optics`.

The modules ``compiled_*`` repeat the formulas of the package, line by line, for a single ray; see there for what they
mean. All waves propagate: real arithmetic only.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, TypeVar, cast

import numba
import numpy as np
from numpy.typing import NDArray

__all__ = ["Array", "Axis", "Frame", "Mode", "bilinear", "compiled", "components", "frame_of", "norm"]

Array = NDArray[np.float64]
Axis = tuple[float, float, float]

F = TypeVar("F", bound=Callable[..., object])

NORMAL_INCIDENCE = 1e-15
"""As in `crystal_core.optics.frames`."""


class Frame(NamedTuple):
    """Unit vectors along the tangential wave vector, z × that, and the normal; length of the tangential part."""

    x: Axis
    y: Axis
    z: Axis
    kappa: float


class Mode(NamedTuple):
    """One wave as `crystal_core.optics.modes.Mode` has it; (rx, ry, rz) is its ray, not normalised."""

    q: float
    ex: float
    ey: float
    ez: float
    hx: float
    hy: float
    rx: float
    ry: float
    rz: float


def compiled(function: F) -> F:
    """Compile with the arithmetic of NumPy: IEEE 754 to the letter, no exception for 1/0; inline it where it is called.

    Left to itself LLVM makes calls of the larger functions, and the loops are half as fast.
    """
    return cast(F, numba.njit(error_model="numpy", fastmath=False, forceinline=True)(function))


@compiled
def components(vx: float, vy: float, vz: float, frame: Frame) -> Axis:
    """Return the components of a world vector along x, y, z."""
    x, y, z = frame.x, frame.y, frame.z
    return (
        vx * x[0] + vy * x[1] + vz * x[2],
        vx * y[0] + vy * y[1] + vz * y[2],
        vx * z[0] + vy * z[1] + vz * z[2],
    )


@compiled
def frame_of(z0: float, z1: float, z2: float, k0: float, k1: float, k2: float) -> Frame:
    """Return the frame of a unit normal and a tangential wave vector, as `interface_frame` does."""
    kappa = math.sqrt(k0 * k0 + k1 * k1 + k2 * k2)
    if kappa <= NORMAL_INCIDENCE:
        kappa = 0.0
        sign = math.copysign(1.0, z2)
        a = -1.0 / (sign + z2)
        x0, x1, x2 = 1.0 + sign * z0 * z0 * a, sign * (z0 * z1 * a), -sign * z0
    else:
        x0, x1, x2 = k0 / kappa, k1 / kappa, k2 / kappa
    return Frame((x0, x1, x2), (z1 * x2 - z2 * x1, z2 * x0 - z0 * x2, z0 * x1 - z1 * x0), (z0, z1, z2), kappa)


@compiled
def bilinear(a: Mode, b: Mode) -> float:
    """Return g(a, b) = (E_a × H_b + E_b × H_a)_z."""
    return a.ex * b.hy - a.ey * b.hx + b.ex * a.hy - b.ey * a.hx


@compiled
def norm(a: Mode) -> float:
    """Return g(a, a)."""
    return 2.0 * (a.ex * a.hy - a.ey * a.hx)
