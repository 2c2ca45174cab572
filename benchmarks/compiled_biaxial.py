"""Waves of a biaxial medium, as in `crystal_core.optics.biaxial` and `crystal_core.optics.orthogonality`."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from benchmarks.compiled_frame import Array, Axis, Frame, Mode, bilinear, compiled, norm
from benchmarks.compiled_sheets import Sheets, gap, near_axis, nearest, quadratics, refined, sheets_of, split, square
from crystal_core.optics import biaxial
from crystal_core.optics.biaxial import FAST, MORE_STEPS, SLOW, STEPS
from crystal_core.optics.orthogonality import LARGEST_SHARE, SLANTING

__all__ = ["biaxial_ahead", "biaxial_all"]

EPSILON = float(np.finfo(np.float64).eps)
CLOSE_SQUARE = (biaxial.CLOSE * EPSILON**0.25) ** 2
NEAR_AXIS_SQUARE = (biaxial.NEAR_AXIS * EPSILON**0.25) ** 2
ONE_FRAME_SQUARE = (biaxial.ONE_FRAME * EPSILON**0.25) ** 2
ON_AXIS_SQUARE = (biaxial.ON_AXIS * EPSILON) ** 2
GRAZING = math.sqrt(EPSILON)


class Roots(NamedTuple):
    """Roots of mode 0 and 1 in both directions before they are refined, and whether mode 1 is a second slow one."""

    ahead: tuple[float, float]
    back: tuple[float, float]
    second_slow: bool


@compiled
def _real_roots(sheets: Sheets, centre: float, width_square: float) -> tuple[float, float]:
    if abs(width_square) < CLOSE_SQUARE * (centre * centre):
        slow, fast, sure = split(sheets, centre)
        if sure:
            slow, fast = refined(sheets, slow, SLOW, STEPS), refined(sheets, fast, FAST, STEPS)
            return max(slow, fast), min(slow, fast)
    width = math.sqrt(abs(width_square))
    return centre + width, centre - width


@compiled
def _roots(sheets: Sheets) -> Roots:
    upper, upper_square, lower, lower_square = quadratics(sheets)
    q1, q2 = _real_roots(sheets, upper, upper_square)
    q3, q4 = _real_roots(sheets, lower, lower_square)
    highest, lowest = max(q1, q3), min(q2, q4)
    one, two = max(q2, q4), min(q1, q3)
    inner_high, inner_low = max(one, two), min(one, two)
    slow = gap(sheets, inner_high) + gap(sheets, inner_low) > 0.0
    if slow:
        slow = not (split(sheets, inner_high)[2] or split(sheets, inner_low)[2])
    if slow:
        return Roots((highest, inner_low), (lowest, inner_high), True)
    return Roots((highest, inner_high), (lowest, inner_low), False)


@compiled
def _refined(sheets: Sheets, roots: Roots, forward: bool) -> tuple[float, float]:
    slow, fast = roots.ahead if forward else roots.back
    if not roots.second_slow:
        if nearest(sheets, slow) < NEAR_AXIS_SQUARE * (sheets.kappa * sheets.kappa + slow * slow):
            slow, fast = near_axis(sheets, 0.5 * (slow + fast))
            return refined(sheets, slow, SLOW, MORE_STEPS), refined(sheets, fast, FAST, MORE_STEPS)
        return refined(sheets, slow, SLOW, STEPS), refined(sheets, fast, FAST, STEPS)
    slow, fast = refined(sheets, slow, SLOW, STEPS), refined(sheets, fast, SLOW, STEPS)
    ahead, back = roots.ahead[1], roots.back[1]
    reach = NEAR_AXIS_SQUARE * (sheets.kappa * sheets.kappa + ahead * ahead)
    if nearest(sheets, ahead) < reach and nearest(sheets, back) < reach:
        one, two = near_axis(sheets, 0.5 * (ahead + back))
        fast = min(one, two) if forward else max(one, two)
    return slow, refined(sheets, fast, SLOW, MORE_STEPS)


@compiled
def _direction(kappa: float, axis: Axis, q: float) -> Axis:
    x, y, z = axis
    length2 = square(kappa, axis, q)[0]
    if abs(length2) <= ON_AXIS_SQUARE:
        return 0.0, 1.0, 0.0
    inverse = 1.0 / math.sqrt(length2)
    return -q * y * inverse, (q * x - kappa * z) * inverse, kappa * y * inverse


@compiled
def _with_ray(q: float, ex: float, ey: float, ez: float, hx: float, hy: float, hz: float) -> Mode:
    return Mode(q, ex, ey, ez, hx, hy, ey * hz - ez * hy, ez * hx - ex * hz, ex * hy - ey * hx)


@compiled
def _mode(sheets: Sheets, q: float, branch: float) -> Mode:
    kappa = sheets.kappa
    (x1, y1, z1), (x2, y2, z2) = sheets.one, sheets.two
    ux, uy, uz = _direction(kappa, sheets.one, q)
    vx, vy, vz = _direction(kappa, sheets.two, q)
    turn = 1.0 if ux * vx + uy * vy + uz * vz >= 0.0 else -1.0
    dx, dy, dz = ux + turn * vx, uy + turn * vy, uz + turn * vz
    if turn != branch:
        dx, dy, dz = -q * dy, q * dx - kappa * dz, kappa * dy
    along1 = sheets.half * (x1 * dx + y1 * dy + z1 * dz)
    along2 = sheets.half * (x2 * dx + y2 * dy + z2 * dz)
    ex = sheets.middle * dx - (x1 * along2 + x2 * along1)
    ey = sheets.middle * dy - (y1 * along2 + y2 * along1)
    ez = sheets.middle * dz - (z1 * along2 + z2 * along1)
    return _with_ray(q, ex, ey, ez, -q * ey, q * ex - kappa * ez, kappa * ey)


@compiled
def _less(mode: Mode, share: float, other: Mode, kappa: float) -> Mode:
    """Return a mode minus a share of another one."""
    return _with_ray(
        mode.q,
        mode.ex - share * other.ex,
        mode.ey - share * other.ey,
        mode.ez - share * other.ez,
        mode.hx - share * other.hx,
        mode.hy - share * other.hy,
        kappa * (mode.ey - share * other.ey),  # hz = κ e_y holds of the sum, as of both
    )


@compiled
def _square_of_field(mode: Mode) -> float:
    return mode.ex * mode.ex + mode.ey * mode.ey + mode.ez * mode.ez


@compiled
def _pair(sheets: Sheets, roots: Roots, forward: bool) -> tuple[Mode, Mode]:
    slow, fast = _refined(sheets, roots, forward)
    first = _mode(sheets, slow, SLOW)
    second = _mode(sheets, fast, SLOW if roots.second_slow else FAST)
    if nearest(sheets, slow) < ONE_FRAME_SQUARE * (sheets.kappa * sheets.kappa + slow * slow):
        own = norm(first)
        if abs(own) > GRAZING * _square_of_field(first):
            share = bilinear(first, second) / own
            second = _less(second, share, first, sheets.kappa)
    return first, second


@compiled
def _slants(mode: Mode) -> bool:
    return abs(norm(mode)) < SLANTING * _square_of_field(mode)


@compiled
def _balanced(mode: Mode, others: tuple[Mode, Mode, Mode], kappa: float) -> Mode:
    """Return a mode without half of what it shares with the three others."""
    result = mode
    own = norm(mode)
    for other in others:
        length = norm(other)
        overlap = 0.5 * bilinear(mode, other)
        if length != 0.0 and abs(overlap) <= LARGEST_SHARE * min(abs(own), abs(length)):
            result = _less(result, overlap / length, other, kappa)
    return result


@compiled
def biaxial_ahead(medium: Array, i: int, frame: Frame) -> tuple[Mode, Mode]:
    """Return both waves along the normal; rows of `medium` as in `sheets_of`."""
    sheets = sheets_of(medium, i, frame)
    return _pair(sheets, _roots(sheets), True)


@compiled
def biaxial_all(medium: Array, i: int, frame: Frame) -> tuple[Mode, Mode, Mode, Mode]:
    """Return both waves along the normal, then both against it."""
    sheets = sheets_of(medium, i, frame)
    roots = _roots(sheets)
    in0, in1 = _pair(sheets, roots, True)
    out0, out1 = _pair(sheets, roots, False)
    if _slants(in0) or _slants(in1) or _slants(out0) or _slants(out1):
        kappa = sheets.kappa
        return (
            _balanced(in0, (in1, out0, out1), kappa),
            _balanced(in1, (in0, out0, out1), kappa),
            _balanced(out0, (in0, in1, out1), kappa),
            _balanced(out1, (in0, in1, out0), kappa),
        )
    return in0, in1, out0, out1
