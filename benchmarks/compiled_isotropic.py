"""Waves of an isotropic medium, as in `crystal_core.optics.isotropic`."""

from __future__ import annotations

import math

from benchmarks.compiled_frame import Array, Frame, Mode, compiled

__all__ = ["isotropic_ahead", "isotropic_all"]


@compiled
def _pair(n: float, kappa: float, q: float) -> tuple[Mode, Mode]:
    s = Mode(q, 0.0, 1.0, 0.0, -q, 0.0, kappa, 0.0, q)
    p = Mode(q, q / n, 0.0, -kappa / n, 0.0, n, kappa, 0.0, q)
    return s, p


@compiled
def isotropic_all(medium: Array, i: int, frame: Frame) -> tuple[Mode, Mode, Mode, Mode]:
    """Return both waves along the normal, then both against it; rows of `medium`: n."""
    n = medium[0, i]
    q = math.sqrt(n * n - frame.kappa * frame.kappa)
    return _pair(n, frame.kappa, q) + _pair(n, frame.kappa, -q)


@compiled
def isotropic_ahead(medium: Array, i: int, frame: Frame) -> tuple[Mode, Mode]:
    """Return both waves along the normal."""
    n = medium[0, i]
    return _pair(n, frame.kappa, math.sqrt(n * n - frame.kappa * frame.kappa))
