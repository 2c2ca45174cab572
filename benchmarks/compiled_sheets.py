"""The sheets of a biaxial index surface along the normal of a face, as in `crystal_core.optics.sheets`."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from benchmarks.compiled_frame import Array, Axis, Frame, compiled, components
from benchmarks.compiled_quartic import real_quadratics

__all__ = ["Sheets", "gap", "near_axis", "nearest", "quadratics", "refined", "sheets_of", "split", "square"]

TINY = float(np.finfo(np.float64).tiny)


class Sheets(NamedTuple):
    """Tangential wave vector; ½(α⁻² ± γ⁻²), β⁻²; the optic axes."""

    kappa: float
    mean: float
    half: float
    middle: float
    one: Axis
    two: Axis


@compiled
def sheets_of(medium: Array, i: int, frame: Frame) -> Sheets:
    """Return the sheets; rows of `medium`: indices in ascending order, then the components of their axes."""
    alpha, beta, gamma = medium[0, i], medium[1, i], medium[2, i]
    lower = (beta - alpha) * (beta + alpha) * (gamma * gamma)
    upper = (gamma - beta) * (gamma + beta) * (alpha * alpha)
    both = lower + upper
    inverse = 1.0 / (1.0 if both == 0.0 else both)
    sin_v, cos_v = math.sqrt(lower * inverse), math.sqrt(1.0 if both == 0.0 else upper * inverse)
    x0, x1, x2 = sin_v * medium[3, i], sin_v * medium[4, i], sin_v * medium[5, i]
    z0, z1, z2 = cos_v * medium[9, i], cos_v * medium[10, i], cos_v * medium[11, i]
    product = (alpha * gamma) * (alpha * gamma)
    return Sheets(
        frame.kappa,
        0.5 * (alpha * alpha + gamma * gamma) / product,
        0.5 * (gamma - alpha) * (gamma + alpha) / product,
        1.0 / (beta * beta),
        components(z0 + x0, z1 + x1, z2 + x2, frame),
        components(z0 - x0, z1 - x1, z2 - x2, frame),
    )


@compiled
def smooth(sheets: Sheets, q: float) -> tuple[float, float]:
    """Return P and dP/dq."""
    kappa, mean, half = sheets.kappa, sheets.mean, sheets.half
    (x1, _, z1), (x2, _, z2) = sheets.one, sheets.two
    along1, along2 = kappa * x1 + q * z1, kappa * x2 + q * z2
    p = mean * (kappa * kappa + q * q) + half * along1 * along2 - 1.0
    return p, 2.0 * mean * q + half * (z1 * along2 + z2 * along1)


@compiled
def square(kappa: float, axis: Axis, q: float) -> tuple[float, float]:
    """Return |k × o|² and its derivative."""
    x, y, z = axis
    y2 = y * y
    lever = q * x - kappa * z
    return y2 * (kappa * kappa + q * q) + lever * lever, 2.0 * (y2 * q + x * lever)


@compiled
def gap(sheets: Sheets, q: float) -> float:
    """Return P."""
    return smooth(sheets, q)[0]


@compiled
def nearest(sheets: Sheets, q: float) -> float:
    """Return the least |k × o|² of both axes."""
    return min(square(sheets.kappa, sheets.one, q)[0], square(sheets.kappa, sheets.two, q)[0])


@compiled
def quadratics(sheets: Sheets) -> tuple[float, float, float, float]:
    """Return Fresnel's quartic as two quadratics."""
    kappa, half = sheets.kappa, sheets.half
    (x1, y1, z1), (x2, y2, z2) = sheets.one, sheets.two
    kappa2 = kappa * kappa
    p2 = sheets.mean + half * z1 * z2
    p1 = half * kappa * (x1 * z2 + z1 * x2)
    p0 = kappa2 * (sheets.mean + half * x1 * x2) - 1.0
    f1, g1, h1 = x1 * x1 + y1 * y1, kappa * x1 * z1, kappa2 * (y1 * y1 + z1 * z1)
    f2, g2, h2 = x2 * x2 + y2 * y2, kappa * x2 * z2, kappa2 * (y2 * y2 + z2 * z2)
    w = half * half
    lead = p2 * p2 - w * f1 * f2
    return real_quadratics(
        2.0 * (p2 * p1 + w * (f1 * g2 + g1 * f2)) / lead,
        (p1 * p1 + 2.0 * p2 * p0 - w * (f1 * h2 + h1 * f2 + 4.0 * g1 * g2)) / lead,
        2.0 * (p1 * p0 + w * (g1 * h2 + h1 * g2)) / lead,
        (p0 * p0 - w * h1 * h2) / lead,
    )


@compiled
def curvature(sheets: Sheets) -> float:
    """Return d²P/dq²."""
    return 2.0 * (sheets.mean + sheets.half * sheets.one[2] * sheets.two[2])


@compiled
def _step(value: float, slope: float, bend: float) -> float:
    between = slope * slope - 2.0 * value * bend
    if between <= 0.0:
        return slope / bend
    return 2.0 * value / (slope + math.copysign(math.sqrt(between), slope))


@compiled
def refined(sheets: Sheets, q: float, branch: float, steps: int) -> float:
    """Return a root after some steps towards F = P + branch·W = 0."""
    weight = branch * sheets.half
    for _ in range(steps):
        p, dp = smooth(sheets, q)
        first, d_first = square(sheets.kappa, sheets.one, q)
        second, d_second = square(sheets.kappa, sheets.two, q)
        w = math.sqrt(first * second)
        slope = dp + weight * (d_first * second + first * d_second) / (2.0 * max(w, TINY))
        q -= _step(p + weight * w, slope, curvature(sheets))
    return q


@compiled
def split(sheets: Sheets, centre: float) -> tuple[float, float, bool]:
    """Return the slow and the fast root where the sheets are close, and whether both surely are real."""
    p, dp = smooth(sheets, centre)
    first, second = square(sheets.kappa, sheets.one, centre)[0], square(sheets.kappa, sheets.two, centre)[0]
    w = sheets.half * math.sqrt(first) * math.sqrt(second)
    (x1, y1, _), (x2, y2, _) = sheets.one, sheets.two
    steepest = math.sqrt((x1 * x1 + y1 * y1) * second) + math.sqrt((x2 * x2 + y2 * y2) * first)
    sure = abs(dp) > 1.1 * sheets.half * steepest + TINY
    bend = curvature(sheets)
    return centre - _step(p - w, dp, bend), centre - _step(p + w, dp, bend), sure


@compiled
def near_axis(sheets: Sheets, q: float) -> tuple[float, float]:
    """Return the slow and the fast root where k all but points along an optic axis."""
    p, dp = smooth(sheets, q)
    square1, d_square1 = square(sheets.kappa, sheets.one, q)
    square2, d_square2 = square(sheets.kappa, sheets.two, q)
    if square2 < square1:
        here, slope, other, axis = square2, d_square2, square1, sheets.two
    else:
        here, slope, other, axis = square1, d_square1, square2, sheets.one
    x, y, _ = axis
    lead = x * x + y * y
    weight = sheets.half * sheets.half * other
    a = dp * dp - weight * lead
    b = p * dp - 0.5 * weight * slope
    tilted = lead * p * p - p * dp * slope + dp * dp * here
    inner = sheets.kappa * y
    root = math.sqrt(max(weight * (tilted - weight * (inner * inner)), 0.0))
    safe = a if a != 0.0 else 1.0
    one, two = (-b + root) / safe, (-b - root) / safe
    if p + dp * one >= p + dp * two:
        return q + one, q + two
    return q + two, q + one
