"""The two sheets of a biaxial index surface along the normal of an interface, by the optic axes.

With the unit vectors o₁, o₂ of the optic axes, both in the half-space of γ, the indices along a wave normal s are

    1/n² = ½(α⁻² + γ⁻²) + ½(α⁻² − γ⁻²) cos(θ₁ ∓ θ₂),        θ_i = ∠(s, o_i),

the upper sign for the fast wave (Born & Wolf, Principles of Optics, 7th ed., §15.3.3, eq. 19). Multiplied by k² this is
F = P ± W = 0 with

    P = ½(α⁻² + γ⁻²) k² + ½(α⁻² − γ⁻²)(k·o₁)(k·o₂) − 1,      W = ½(α⁻² − γ⁻²) |k × o₁||k × o₂|,

and P² − W² = 0 is Fresnel's quartic. The quartic loses half the digits near an optic axis, where its roots fall
together; F does not: there an error of ε in k is one of ε in q, and of ε/θ in the direction of vibration.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from crystal_core.optics.arrays import BoolArray, Complex, Field, Rays, Real
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.optics.medium import take
from crystal_core.optics.quartic import Quadratics, real_quadratics

__all__ = ["Axis", "Point", "Sheets"]


class Axis(NamedTuple):
    """An optic axis o = (x, y, z) in the frame of the interface, with y² and the products κx, κy, κz; shape (N,)."""

    x: Real
    y: Real
    z: Real
    y2: Real
    kx: Real
    ky: Real
    kz: Real

    @classmethod
    def of(cls, direction: Real, frame: InterfaceFrame) -> Axis:
        """Return the axis of a world direction, shape (3,) or (3, N)."""
        x, y, z = frame.components(direction)
        return cls(x, y, z, y * y, frame.kappa * x, frame.kappa * y, frame.kappa * z)


@dataclass(frozen=True, slots=True)
class Sheets:
    """F(q) of both sheets for k = (κ, 0, q), shape (N,) or, where one medium serves all rays, ().

    Parameters
    ----------
    kappa, kappa2 : Real
        Tangential wave vector, and its square.
    half : Real
        ½(α⁻² − γ⁻²).
    middle : Real
        β⁻².
    smooth : three of Real
        The coefficients of P = p₂q² + p₁q + p₀.
    axes : pair of Axis
        The optic axes.
    """

    kappa: Real
    kappa2: Real
    half: Real
    middle: Real
    smooth: tuple[Real, Real, Real]
    axes: tuple[Axis, Axis]

    @classmethod
    def of(cls, indicatrix: BiaxialIndicatrix, frame: InterfaceFrame) -> Sheets:
        """Return the sheets of an indicatrix in the frame of an interface."""
        alpha, gamma = indicatrix.alpha, indicatrix.gamma
        product = (alpha * gamma) ** 2
        half = 0.5 * (gamma - alpha) * (gamma + alpha) / product
        mean = 0.5 * (alpha * alpha + gamma * gamma) / product
        one, two = (Axis.of(direction, frame) for direction in indicatrix.optic_axes())
        smooth = (
            mean + half * one.z * two.z,
            half * (one.kx * two.z + one.z * two.kx),
            frame.kappa * (mean * frame.kappa + half * one.x * two.kx) - 1.0,
        )
        kappa2 = frame.kappa * frame.kappa
        middle = 1.0 / indicatrix.beta**2
        return cls(frame.kappa, kappa2, np.asarray(half), np.asarray(middle), smooth, (one, two))

    def take(self, rays: Rays) -> Sheets:
        """Return those of a selection of rays."""
        p2, p1, p0 = self.smooth
        one, two = (Axis(*(part[rays] for part in axis)) for axis in self.axes)
        return Sheets(
            self.kappa[rays],
            self.kappa2[rays],
            take(self.half, rays),
            take(self.middle, rays),
            (p2[rays], p1[rays], p0[rays]),
            (one, two),
        )

    def at(self, q: Field) -> Point:
        """Return what the equations say of k = (κ, 0, q)."""
        return Point(self, q)

    def gap(self, q: Real) -> Real:
        """Return P alone: positive on the outer sheet, negative on the inner one."""
        p2, p1, p0 = self.smooth
        return np.asarray(q * (p2 * q + p1) + p0)

    def quadratics(self) -> Quadratics:
        """Return Fresnel's quartic in q as two quadratics."""
        one, two = self.axes
        p2, p1, p0 = self.smooth
        # W = q²·f − 2 q·g + h for each axis
        f1, g1, h1 = one.x * one.x + one.y2, one.kx * one.z, one.ky * one.ky + one.kz * one.kz
        f2, g2, h2 = two.x * two.x + two.y2, two.kx * two.z, two.ky * two.ky + two.kz * two.kz
        w = self.half * self.half
        lead = p2 * p2 - w * f1 * f2
        return real_quadratics(
            2.0 * (p2 * p1 + w * (f1 * g2 + g1 * f2)) / lead,
            (p1 * p1 + 2.0 * p2 * p0 - w * (f1 * h2 + h1 * f2 + 4.0 * g1 * g2)) / lead,
            2.0 * (p1 * p0 + w * (g1 * h2 + h1 * g2)) / lead,
            (p0 * p0 - w * h1 * h2) / lead,
        )

    def refined(self, q: Real, branch: Real | float, steps: int) -> Real:
        """Return real roots after some steps towards F = P + branch·W = 0; −1 is slow, +1 fast."""
        for _ in range(steps):
            q = self.step(self.at(q), branch)
        return np.asarray(q)

    def step(self, here: Point, branch: Real | float) -> Real:
        """Return a real q, one step from a point towards F = P + branch·W = 0."""
        p, dp = here.smooth()
        weight = branch * self.half
        w = np.sqrt(here.squares[0] * here.squares[1])
        slope = dp + weight * here.slope_of_product() / np.maximum(w, np.finfo(w.dtype).tiny)
        value, slope = np.asarray((p + weight * w).real), np.asarray(slope.real)
        return np.asarray(here.q.real - _real_step(value, slope, 2.0 * self.smooth[0]))

    def split(self, centre: Field) -> tuple[Field, Field, BoolArray]:
        """Return the slow and the fast root near a point where the sheets are close, and if both surely are real.

        With W constant they solve P ∓ W = 0. Where |P′| exceeds every possible |W′|, F rises or falls on either sheet,
        each has one real root, and no rounding of the quartic can make them complex.
        """
        here = self.at(centre)
        p, dp = here.smooth()
        first, second = here.squares
        w = self.half * np.sqrt(first) * np.sqrt(second)
        one, two = self.axes
        # |d|k × o|/dq| is at most the part of o across z.
        level1, level2 = one.x * one.x + one.y2, two.x * two.x + two.y2
        steepest = np.sqrt(level1 * np.abs(second)) + np.sqrt(level2 * np.abs(first))
        sure = np.abs(dp) > 1.1 * self.half * steepest + np.finfo(steepest.dtype).tiny
        bend = 2.0 * self.smooth[0]
        if np.iscomplexobj(centre):
            return centre - _complex_step(p - w, dp, bend), centre - _complex_step(p + w, dp, bend), sure
        slow, fast = (_real_step(np.asarray((p + sign * w).real), np.asarray(dp.real), bend) for sign in (-1.0, 1.0))
        return np.asarray(centre.real - slow), np.asarray(centre.real - fast), sure

    def branch(self, q: Complex) -> Real:
        """Return the branch of a complex root: −1 if P is W of the principal roots √Q₁·√Q₂, +1 if it is −W."""
        here = self.at(q)
        p, w = here.smooth()[0], self.half * np.sqrt(here.squares[0]) * np.sqrt(here.squares[1])
        return np.where(np.abs(p + w) < np.abs(p - w), 1.0, -1.0)

    def refined_complex(self, q: Complex, branch: Real, steps: int) -> Complex:
        """Return complex roots after some steps towards F = P + branch·√Q₁·√Q₂ = 0."""
        for _ in range(steps):
            here = self.at(q)
            p, dp = here.smooth()
            first, second = here.squares
            w = np.sqrt(first) * np.sqrt(second)
            flat = w == 0.0
            slope = dp + branch * self.half * here.slope_of_product() / np.where(flat, 1.0, w)
            q = q - _complex_step(p + branch * self.half * w, slope, 2.0 * self.smooth[0])
        return np.asarray(q, np.result_type(q, np.complex64))

    def near_axis(self, q: Real) -> tuple[Real, Real]:
        """Return the slow and the fast root near q where k all but points along an optic axis.

        Both may be slow: then the line passes the dimple at the axis, and the order means nothing.

        There |k × o| = √Q turns a corner as fast as q changes, while P is all but linear and the other axis far. With
        Q₂ for the square of that one, constant, (P + P′x)² = ½²(α⁻² − γ⁻²)² Q₂ Q(q + x) is one quadratic for x.
        """
        here = self.at(q)
        p, dp = here.smooth()
        second = here.squares[1] < here.squares[0]
        square, d_square = (np.where(second, b, a) for a, b in (here.squares, here.slopes()))
        x, y2, ky = (np.where(second, b, a) for a, b in zip(*((o.x, o.y2, o.ky) for o in self.axes), strict=True))
        lead = x * x + y2
        weight = self.half * self.half * np.where(second, here.squares[0], here.squares[1])
        a = dp * dp - weight * lead
        b = p * dp - weight * d_square
        # b² − a·c with what cancels taken out by hand.
        tilted = lead * p * p - 2.0 * p * dp * d_square + dp * dp * square
        root = np.sqrt(np.maximum(weight * (tilted - weight * ky * ky), 0.0))
        safe = np.where(a != 0.0, a, 1.0)
        one, two = (-b + root) / safe, (-b - root) / safe
        first_is_slow = p + dp * one >= p + dp * two
        return np.where(first_is_slow, q + one, q + two), np.where(first_is_slow, q + two, q + one)


class Point:
    """A point k = (κ, 0, q) on the normal's line, real or complex, with what the equations need of it, computed once.

    Parameters
    ----------
    sheets : Sheets
        The equations.
    q : Field
        The normal component, shape (N,).

    Attributes
    ----------
    k2 : Field
        k·k, without conjugation.
    levers : pair of Field
        y component of k × o for each axis; the others are −q·y and κ·y.
    squares : pair of Field
        |k × o|², without conjugation, as a sum of squares.
    """

    __slots__ = ("_sheets", "k2", "levers", "q", "squares")

    def __init__(self, sheets: Sheets, q: Field) -> None:
        one, two = sheets.axes
        self._sheets = sheets
        self.q = q
        self.k2: Field = sheets.kappa2 + q * q
        self.levers: tuple[Field, Field] = (q * one.x - one.kz, q * two.x - two.kz)
        first, second = self.levers
        self.squares: tuple[Field, Field] = (one.y2 * self.k2 + first * first, two.y2 * self.k2 + second * second)

    def nearest(self) -> Real:
        """Return the least |k × o|² of both axes, of real k."""
        return np.minimum(self.squares[0].real, self.squares[1].real)

    def smooth(self) -> tuple[Field, Field]:
        """Return P and dP/dq."""
        p2, p1, p0 = self._sheets.smooth
        term = p2 * self.q
        rest = term + p1
        return self.q * rest + p0, rest + term

    def slopes(self) -> tuple[Field, Field]:
        """Return half the derivative of each of the squares."""
        one, two = self._sheets.axes
        return one.y2 * self.q + one.x * self.levers[0], two.y2 * self.q + two.x * self.levers[1]

    def slope_of_product(self) -> Field:
        """Return half the derivative of the product of both squares."""
        first, second = self.slopes()
        return first * self.squares[1] + self.squares[0] * second


def _real_step(value: Real, slope: Real, bend: Real) -> Real:
    """Return x of value − slope·x + ½ bend·x² = 0, the smaller root; the nearest approach where there is none.

    Newton's step value/slope where the slope is large. At a grazing wave slope and value are both rounding: this step
    is then no longer than the square root of it, which is all that such a root is known to.
    """
    double = 2.0 * value
    square = slope * slope - double * bend
    both = slope + np.copysign(np.sqrt(np.maximum(square, 0.0)), slope)
    touching = square <= 0.0
    if not touching.any():
        return np.asarray(double / both)
    return np.where(touching, slope / bend, double / np.where(touching, 1.0, both))


def _complex_step(value: Field, slope: Field, bend: Real) -> Field:
    """Return the same for complex numbers, where there is always a root."""
    root = np.sqrt(slope * slope - 2.0 * value * bend + 0j)
    both = slope + np.where((np.conj(slope) * root).real >= 0.0, root, -root)
    return 2.0 * value / np.where(both != 0.0, both, np.inf)
