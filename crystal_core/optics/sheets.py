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

import numpy as np

from crystal_core.optics.arrays import BoolArray, Complex, Field, Rays, Real
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.optics.medium import take
from crystal_core.optics.quartic import Quadratics, real_quadratics

__all__ = ["Sheets"]

Axis = tuple[Real, Real, Real]
"""Components along x, y, z of the interface frame."""


@dataclass(frozen=True, slots=True)
class Sheets:
    """F(q) of both sheets for k = (κ, 0, q), shape (N,) or, where one medium serves all rays, ().

    Parameters
    ----------
    kappa : Real
        Tangential wave vector.
    mean, half : Real
        ½(α⁻² + γ⁻²) and ½(α⁻² − γ⁻²).
    middle : Real
        β⁻².
    axes : pair of Axis
        The optic axes.
    """

    kappa: Real
    mean: Real
    half: Real
    middle: Real
    axes: tuple[Axis, Axis]

    @classmethod
    def of(cls, indicatrix: BiaxialIndicatrix, frame: InterfaceFrame) -> Sheets:
        """Return the sheets of an indicatrix in the frame of an interface."""
        alpha, gamma = indicatrix.alpha, indicatrix.gamma
        product = (alpha * gamma) ** 2
        half = 0.5 * (gamma - alpha) * (gamma + alpha) / product
        mean = 0.5 * (alpha * alpha + gamma * gamma) / product
        first, second = indicatrix.optic_axes()
        return cls(
            frame.kappa,
            np.asarray(mean),
            np.asarray(half),
            np.asarray(1.0 / indicatrix.beta**2),
            (frame.components(first), frame.components(second)),
        )

    def take(self, rays: Rays) -> Sheets:
        """Return those of a selection of rays."""
        one, two = ((x[rays], y[rays], z[rays]) for x, y, z in self.axes)
        return Sheets(
            self.kappa[rays], take(self.mean, rays), take(self.half, rays), take(self.middle, rays), (one, two)
        )

    def gap(self, q: Real) -> Real:
        """Return P alone: positive on the outer sheet, negative on the inner one."""
        (x1, _, z1), (x2, _, z2) = self.axes
        across = self.half * (self.kappa * x1 + q * z1) * (self.kappa * x2 + q * z2)
        return np.asarray(self.mean * (self.kappa * self.kappa + q * q) + across - 1.0)

    def nearest(self, q: Real) -> Real:
        """Return the least |k × o|² of both optic axes."""
        return np.minimum(self.square(0, q)[0], self.square(1, q)[0])

    def smooth(self, q: Field) -> tuple[Field, Field]:
        """Return P and dP/dq."""
        (x1, _, z1), (x2, _, z2) = self.axes
        along1, along2 = self.kappa * x1 + q * z1, self.kappa * x2 + q * z2
        p = self.mean * (self.kappa * self.kappa + q * q) + self.half * along1 * along2 - 1.0
        return p, 2.0 * self.mean * q + self.half * (z1 * along2 + z2 * along1)

    def square(self, which: int, q: Field) -> tuple[Field, Field]:
        """Return |k × o|² of an optic axis, without conjugation, as a sum of squares, and its derivative."""
        x, y, z = self.axes[which]
        y2 = y * y
        lever = q * x - self.kappa * z
        return y2 * (self.kappa * self.kappa + q * q) + lever * lever, 2.0 * (y2 * q + x * lever)

    def quadratics(self) -> Quadratics:
        """Return Fresnel's quartic in q as two quadratics."""
        (x1, y1, z1), (x2, y2, z2) = self.axes
        kappa, half = self.kappa, self.half
        kappa2 = kappa * kappa
        p2 = self.mean + half * z1 * z2
        p1 = half * kappa * (x1 * z2 + z1 * x2)
        p0 = kappa2 * (self.mean + half * x1 * x2) - 1.0
        # W = q²·f − 2 q·g + h for each axis
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

    def curvature(self) -> Real:
        """Return d²P/dq²; that of F is the same to the order of the birefringence."""
        (_, _, z1), (_, _, z2) = self.axes
        return np.asarray(2.0 * (self.mean + self.half * z1 * z2))

    def refined(self, q: Real, branch: Real | float, steps: int) -> Real:
        """Return real roots after some steps towards F = P + branch·W = 0; −1 is slow, +1 fast."""
        weight = branch * self.half
        for _ in range(steps):
            p, dp = self.smooth(q)
            first, d_first = self.square(0, q)
            second, d_second = self.square(1, q)
            w = np.sqrt(first * second)
            slope = dp + weight * (d_first * second + first * d_second) / (2.0 * np.maximum(w, np.finfo(w.dtype).tiny))
            q = q - _real_step(np.asarray((p + weight * w).real), np.asarray(slope.real), self.curvature())
        return np.asarray(q)

    def split(self, centre: Field) -> tuple[Field, Field, BoolArray]:
        """Return the slow and the fast root near a point where the sheets are close, and if both surely are real.

        With W constant they solve P ∓ W = 0. Where |P′| exceeds every possible |W′|, F rises or falls on either sheet,
        each has one real root, and no rounding of the quartic can make them complex.
        """
        p, dp = self.smooth(centre)
        first, second = self.square(0, centre)[0], self.square(1, centre)[0]
        w = self.half * np.sqrt(first) * np.sqrt(second)
        (x1, y1, _), (x2, y2, _) = self.axes
        # |d|k × o|/dq| is at most the part of o across z.
        steepest = np.sqrt((x1 * x1 + y1 * y1) * np.abs(second)) + np.sqrt((x2 * x2 + y2 * y2) * np.abs(first))
        sure = np.abs(dp) > 1.1 * self.half * steepest + np.finfo(steepest.dtype).tiny
        bend = self.curvature()
        if np.iscomplexobj(centre):
            return centre - _complex_step(p - w, dp, bend), centre - _complex_step(p + w, dp, bend), sure
        slow, fast = (_real_step(np.asarray((p + sign * w).real), np.asarray(dp.real), bend) for sign in (-1.0, 1.0))
        return np.asarray(centre.real - slow), np.asarray(centre.real - fast), sure

    def branch(self, q: Complex) -> Real:
        """Return the branch of a complex root: −1 if P is W of the principal roots √Q₁·√Q₂, +1 if it is −W."""
        p, _ = self.smooth(q)
        w = self.half * np.sqrt(self.square(0, q)[0]) * np.sqrt(self.square(1, q)[0])
        return np.where(np.abs(p + w) < np.abs(p - w), 1.0, -1.0)

    def refined_complex(self, q: Complex, branch: Real, steps: int) -> Complex:
        """Return complex roots after some steps towards F = P + branch·√Q₁·√Q₂ = 0."""
        for _ in range(steps):
            p, dp = self.smooth(q)
            first, d_first = self.square(0, q)
            second, d_second = self.square(1, q)
            w = np.sqrt(first) * np.sqrt(second)
            flat = w == 0.0
            slope = dp + branch * self.half * (d_first * second + first * d_second) / np.where(flat, 1.0, 2.0 * w)
            q = q - _complex_step(p + branch * self.half * w, slope, self.curvature())
        return np.asarray(q, np.result_type(q, np.complex64))

    def near_axis(self, q: Real) -> tuple[Real, Real]:
        """Return the slow and the fast root near q where k all but points along an optic axis.

        Both may be slow: then the line passes the dimple at the axis, and the order means nothing.

        There |k × o| = √Q turns a corner as fast as q changes, while P is all but linear and the other axis far: P
        linear, the other factor constant and Q whole leave one quadratic, (P + P′x)² = ½²(α⁻² − γ⁻²)² Q′(Q + …).
        """
        p, dp = self.smooth(q)
        squares = self.square(0, q), self.square(1, q)
        second = squares[1][0] < squares[0][0]
        square, d_square = (np.where(second, b, a) for a, b in zip(*squares, strict=True))
        x, y, _ = (np.where(second, b, a) for a, b in zip(*self.axes, strict=True))
        lead = x * x + y * y
        weight = self.half * self.half * np.where(second, squares[0][0], squares[1][0])
        a = dp * dp - weight * lead
        b = p * dp - 0.5 * weight * d_square
        # b² − a·c with what cancels taken out by hand.
        tilted = lead * p * p - p * dp * d_square + dp * dp * square
        root = np.sqrt(np.maximum(weight * (tilted - weight * (self.kappa * y) ** 2), 0.0))
        safe = np.where(a != 0.0, a, 1.0)
        one, two = (-b + root) / safe, (-b - root) / safe
        first_is_slow = p + dp * one >= p + dp * two
        return np.where(first_is_slow, q + one, q + two), np.where(first_is_slow, q + two, q + one)


def _real_step(value: Real, slope: Real, bend: Real) -> Real:
    """Return x of value − slope·x + ½ bend·x² = 0, the smaller root; the nearest approach where there is none.

    Newton's step value/slope where the slope is large. At a grazing wave slope and value are both rounding: this step
    is then no longer than the square root of it, which is all that such a root is known to.
    """
    square = slope * slope - 2.0 * value * bend
    both = slope + np.copysign(np.sqrt(np.maximum(square, 0.0)), slope)
    touching = square <= 0.0
    return np.where(touching, slope / bend, 2.0 * value / np.where(touching, 1.0, both))


def _complex_step(value: Field, slope: Field, bend: Real) -> Field:
    """Return the same for complex numbers, where there is always a root."""
    root = np.sqrt(slope * slope - 2.0 * value * bend + 0j)
    both = slope + np.where((np.conj(slope) * root).real >= 0.0, root, -root)
    return 2.0 * value / np.where(both != 0.0, both, np.inf)
