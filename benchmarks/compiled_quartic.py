"""A real quartic as two quadratics, as in `crystal_core.optics.quartic`."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.compiled_frame import compiled
from crystal_core.optics.quartic import LARGEST_STEP, SMALL_RESOLVENT, SMALL_ROOT

__all__ = ["real_quadratics"]


@compiled
def real_quadratics(b: float, c: float, d: float, e: float) -> tuple[float, float, float, float]:
    """Return upper, upper_square, lower, lower_square of x⁴ + b x³ + c x² + d x + e."""
    shift = 0.25 * b
    shift2 = shift * shift
    p = c - 6.0 * shift2
    r = d + shift * (8.0 * shift2 - 2.0 * c)
    s = e - shift * (d - shift * (c - 3.0 * shift2))
    m = _largest_resolvent_root(p, r, s)
    sum_ = math.sqrt(2.0 * m)
    middle = 0.5 * p + m
    if m <= SMALL_RESOLVENT * (abs(p) + math.sqrt(abs(s))):
        skew = math.copysign(math.sqrt(max(middle * middle - s, 0.0)), r)
    else:
        skew = r / (2.0 * sum_)
    half = 0.5 * sum_
    quarter = half * half - middle
    return half - shift, quarter - skew, -half - shift, quarter + skew


@compiled
def _largest_resolvent_root(p: float, r: float, s: float) -> float:
    p3 = p / 3.0
    linear = 0.25 * p * p - s
    constant = -0.125 * r * r
    u = (0.25 * p * p3 + s) / 3.0
    v = 0.5 * (2.0 * p3 * p3 * p3 - p3 * linear + constant)
    root_u = math.sqrt(max(u, 0.0))
    cube = root_u * root_u * root_u
    if abs(v) <= cube:
        cosine = min(max(-v / (cube if cube > 0.0 else 1.0), -1.0), 1.0)
        t = 2.0 * root_u * math.cos(math.acos(cosine) / 3.0)
    else:
        side = np.cbrt(abs(v) + math.sqrt(max(v * v - u * u * u, 0.0)))
        side = math.copysign(side if side > 0.0 else 1.0, -v)
        t = side + u / side
    m = max(t - p3, 0.0)
    if m < SMALL_ROOT * p:
        m = _small_root(p, linear, constant)
    for _ in range(2):
        value = constant + m * (linear + m * (p + m))
        slope = linear + m * (2.0 * p + 3.0 * m)
        if abs(value) < LARGEST_STEP * m * slope:
            m -= value / slope
    return m


@compiled
def _small_root(p: float, linear: float, constant: float) -> float:
    root = math.sqrt(linear * linear - 4.0 * p * constant)
    return -2.0 * constant / (linear + root) if linear > 0.0 else (root - linear) / (2.0 * p)
