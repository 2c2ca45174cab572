"""Real quartic equations as two real quadratics, for a whole batch at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crystal_core.optics.arrays import Real

__all__ = ["Quadratics", "real_quadratics"]

SMALL_ROOT = 1e-3
"""Resolvent root, relative to p, below which the trigonometric formula has lost its digits."""

LARGEST_STEP = 1e-2
"""Largest relative step of Newton's method that is taken for a refinement."""

SMALL_RESOLVENT = 1e-2
"""Resolvent root, relative to the quartic's own scale, below which r/(2√2m) loses more digits than a square root."""


@dataclass(frozen=True, slots=True)
class Quadratics:
    """A quartic as [(x − upper)² − upper_square] · [(x − lower)² − lower_square] with upper ≥ lower, shape (N,) each.

    A negative square stands for a pair of complex roots. If all four roots are real, those of the upper factor are the
    two largest.
    """

    upper: Real
    upper_square: Real
    lower: Real
    lower_square: Real


def real_quadratics(b: Real, c: Real, d: Real, e: Real) -> Quadratics:
    """Return the factors of x⁴ + b x³ + c x² + d x + e, real, shape (N,) each.

    Ferrari's method with the largest root of the resolvent cubic, found by Viète's or Cardano's formula (Abramowitz &
    Stegun, §3.8.2–3) and two steps of Newton's method. Nearly double roots are good to half the digits only: whoever
    knows a better equation for them refines them by it.
    """
    shift = 0.25 * b
    shift2 = shift * shift
    p = c - 6.0 * shift2
    r = d + shift * (8.0 * shift2 - 2.0 * c)
    s = e - shift * (d - shift * (c - 3.0 * shift2))
    m = _largest_resolvent_root(p, r, s)
    sum_ = np.sqrt(2.0 * m)
    middle = 0.5 * p + m
    scale = np.abs(p) + np.sqrt(np.abs(s))
    small = m <= SMALL_RESOLVENT * scale
    skew = r / np.where(small, 1.0, 2.0 * sum_)
    if small.any():
        skew = np.where(small, np.copysign(np.sqrt(np.maximum(middle * middle - s, 0.0)), r), skew)
    half = 0.5 * sum_
    quarter = half * half - middle
    return Quadratics(half - shift, quarter - skew, -half - shift, quarter + skew)


def _largest_resolvent_root(p: Real, r: Real, s: Real) -> Real:
    """Return the largest root of m³ + p m² + (p²/4 − s) m − r²/8 = 0; it is never negative."""
    p3 = p / 3.0
    linear = 0.25 * p * p - s
    constant = -0.125 * r * r
    # m = t − p/3 solves t³ − 3 u t + 2 v = 0.
    u = (0.25 * p * p3 + s) / 3.0
    v = 0.5 * (2.0 * p3 * p3 * p3 - p3 * linear + constant)
    root_u = np.sqrt(np.maximum(u, 0.0))
    cube = root_u * root_u * root_u
    three = np.abs(v) <= cube
    cosine = np.clip(-v / np.where(cube > 0.0, cube, 1.0), -1.0, 1.0)
    t = 2.0 * root_u * np.cos(np.arccos(cosine) / 3.0)
    if not three.all():
        side = np.cbrt(np.abs(v) + np.sqrt(np.maximum(v * v - u * u * u, 0.0)))
        side = np.copysign(np.where(side > 0.0, side, 1.0), -v)
        t = np.where(three, t, side + u / side)
    m = np.maximum(t - p3, 0.0)
    few = np.flatnonzero(m < SMALL_ROOT * p)
    if few.size:
        m[few] = _small_root(p[few], linear[few], constant[few])
    for _ in range(2):
        value = constant + m * (linear + m * (p + m))
        slope = linear + m * (2.0 * p + 3.0 * m)
        # At a double root a step means nothing.
        good = np.abs(value) < LARGEST_STEP * m * slope
        m = m - np.where(good, value, 0.0) / np.where(good, slope, 1.0)
    return np.asarray(m)


def _small_root(p: Real, linear: Real, constant: Real) -> Real:
    """Return the root for p > 0 without m³, a little too large: it keeps its digits where m all but vanishes."""
    root = np.sqrt(linear * linear - 4.0 * p * constant)
    outside = np.where(linear > 0.0, linear + root, 1.0)
    return np.where(linear > 0.0, -2.0 * constant / outside, (root - linear) / (2.0 * p))
