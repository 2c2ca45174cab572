"""Eigenwaves of a biaxial medium: Fresnel's quartic, refined and told apart by the optic axes.

Which wave is which follows from how a line meets the index surface, two closed sheets, one within the other. Of four
real roots q₁ ≥ q₂ ≥ q₃ ≥ q₄ the outermost are on the outer (slow) sheet, and energy goes along +normal at q₁, along
−normal at q₄. The inner two are on the fast sheet, q₂ forward and q₃ backward, unless the line passes through the
dimple at an optic axis and meets the outer sheet four times: then all four waves are slow, the directions alternate, q₂
is backward and q₃ forward. Two real roots are on the outer sheet, the other two waves are evanescent. Of a complex pair
the root with Im q > 0 decays along +normal.

Fields follow from the optic axes o₁, o₂: D of the fast wave bisects the directions u_i ∥ k × o_i, D ∥ u₁ + u₂, that of
the slow wave is at right angles to it (Born & Wolf, Principles of Optics, 7th ed., §15.3.3), and

    E = ε⁻¹D = β⁻² D − ½(α⁻² − γ⁻²) [ o₁ (o₂·D) + o₂ (o₁·D) ],      H = k × E,      ray = E × H.
"""

from __future__ import annotations

import numpy as np

from crystal_core.optics.arrays import BoolArray, Complex, Field, Rays, Real
from crystal_core.optics.framed import FramedMedium
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Mode
from crystal_core.optics.orthogonality import balance, orthogonalize
from crystal_core.optics.sheets import Point, Sheets

__all__ = ["FramedBiaxial"]

STEPS = 1
"""Newton steps from the quartic's roots, good to 1e-8 at worst, to rounding."""

MORE_STEPS = 3
"""The same where the equation bends within the first error: near an optic axis, and for complex roots."""

CLOSE = 2.5
"""Relative distance of two roots, over ⁴√ of rounding, below which the quartic cannot tell real from complex."""

CROWDED = 1e-5
"""Relative distance of a forward and a backward root below which their waves are told apart by rounding."""

NEAR_AXIS = 8.0
"""Angle to an optic axis, over ⁴√ of rounding (1e-3), below which a start from the axis is worth more."""

ON_AXIS = 45.0
"""Angle, in units of rounding, below which a wave travels along an optic axis and any direction across it serves."""

ONE_FRAME = 80.0
"""Angle to an optic axis, over ⁴√ of rounding (1e-2), below which the two waves are made orthogonal to rounding."""

SLOW, FAST = -1.0, 1.0


class FramedBiaxial(FramedMedium):
    """A biaxial medium in the frame of an interface: mode 0 is slow, mode 1 fast or a second slow one."""

    def __init__(self, medium: Medium, frame: InterfaceFrame) -> None:
        super().__init__(medium, frame)
        sheets = self._sheets = Sheets.of(BiaxialIndicatrix.of(medium), frame)
        factors = sheets.quadratics()
        up, upper = _real_roots(sheets, factors.upper, factors.upper_square)
        down, lower = _real_roots(sheets, factors.lower, factors.lower_square)
        one, both = up | down, up & down
        self._free = one, both
        if both.all():
            self._sort(*upper, *lower)
            return
        # Of mixed factors mode 0 takes the real one; a complex factor stands for centre ± i·width.
        swap = down & ~up
        (q1, q2), (q3, q4) = (
            [np.where(swap, b, a) for a, b in zip(first, second, strict=True)]
            for first, second in ((upper, lower), (lower, upper))
        )
        self._sort(q1, q2, q3, q4, both)
        centres = np.where(swap, factors.lower, factors.upper), np.where(swap, factors.upper, factors.lower)
        squares = factors.upper_square, factors.lower_square
        squares = np.where(swap, squares[1], squares[0]), np.where(swap, squares[0], squares[1])
        for mode, free in enumerate(self._free):
            rays = np.flatnonzero(~free)
            self._forward[mode][rays] = self._backward[mode][rays] = centres[mode][rays]
            self._decay[mode] = np.where(free, 0.0, np.sqrt(np.maximum(-squares[mode], 0.0)))

    def _sort(self, q1: Real, q2: Real, q3: Real, q4: Real, four: BoolArray | None = None) -> None:
        """Sort the roots of two real factors, q1 ≥ q2 and q3 ≥ q4, into modes.

        `four` tells where all are real (None: everywhere); elsewhere only q1 and q2 mean something.
        """
        sheets = self._sheets
        highest, lowest = np.maximum(q1, q3), np.minimum(q2, q4)
        higher, lower = (
            np.maximum(np.maximum(q2, q4), np.minimum(q1, q3)),
            np.minimum(np.maximum(q2, q4), np.minimum(q1, q3)),
        )
        slow = sheets.gap(higher) + sheets.gap(lower) > 0.0
        if four is not None:
            slow &= four
            highest, lowest = np.where(four, highest, q1), np.where(four, lowest, q2)
        rays = np.flatnonzero(slow)
        if rays.size:  # only where the outer sheet turns back can it be met four times: elsewhere it was rounding
            some = sheets.take(rays)
            slow[rays] = ~(some.split(higher[rays])[2] | some.split(lower[rays])[2])
        self._second_slow: BoolArray = slow
        self._forward: list[Real] = [highest, np.where(slow, lower, higher)]
        self._backward: list[Real] = [lowest, np.where(slow, higher, lower)]
        self._decay: list[Real | None] = [None, None]

    def take(self, rays: Rays) -> FramedBiaxial:
        """Return the same for a selection of rays."""
        part = object.__new__(FramedBiaxial)
        part.medium, part.frame = self.medium.take(rays), self.frame.take(rays)
        part._sheets = self._sheets.take(rays)
        part._second_slow = self._second_slow[rays]
        part._free = self._free[0][rays], self._free[1][rays]
        part._forward = [q[rays] for q in self._forward]
        part._backward = [q[rays] for q in self._backward]
        part._decay = [None if decay is None else decay[rays] for decay in self._decay]
        return part

    def propagating(self) -> tuple[BoolArray, BoolArray]:
        """Return whether mode 0 and mode 1 propagate, shape (N,) each."""
        return self._free

    def crowded(self) -> BoolArray:
        """Return where a forward and a backward wave all but coincide, shape (N,)."""
        ahead, back = (
            [q if decay is None else q + 1j * sign * decay for q, decay in zip(roots, self._decay, strict=True)]
            for roots, sign in ((self._forward, 1.0), (self._backward, -1.0))
        )
        gaps = [np.abs(ahead[i] - back[j]) for i, j in ((0, 0), (0, 1), (1, 0), (1, 1))]
        least = np.minimum(np.minimum(gaps[0], gaps[1]), np.minimum(gaps[2], gaps[3]))
        return np.asarray(least < CROWDED * self.frame.kappa)

    def pair(self, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
        """Return the waves along sign·normal, as `FramedMedium.pair` says."""
        forward = sign > 0
        slow, fast = self._refined(forward)
        sheets = self._sheets
        second = self._second_branch()
        if not evanescent:
            first_slow = np.ones(slow.shape, np.bool_)
            points = sheets.at(slow), sheets.at(fast)
            modes = self._mode(points[0], SLOW, first_slow), self._mode(points[1], second, self._second_slow)
        else:
            (q0, branch0), (q1, branch1) = self._complex(slow, fast, second, forward)
            points = sheets.at(q0), sheets.at(q1)
            modes = (
                self._mode(points[0], branch0, branch0 == SLOW),
                self._mode(points[1], branch1, branch1 == SLOW),
            )
        limit = (ONE_FRAME * _fourth_root(slow)) ** 2 * points[0].k2.real
        orthogonalize(modes, np.flatnonzero((points[0].nearest() < limit) & self._free[1]))
        return modes

    def both_pairs(self, evanescent: bool) -> tuple[tuple[Mode, Mode], tuple[Mode, Mode]]:
        """Return the pairs of `pair` for +1 and for −1, orthogonal to each other to rounding."""
        ahead, back = self.pair(+1, evanescent), self.pair(-1, evanescent)
        balance((*ahead, *back))
        return ahead, back

    def _refined(self, forward: bool) -> tuple[Real, Real]:
        """Return the real roots of both modes to rounding; they mean nothing where a wave is evanescent."""
        sheets = self._sheets
        slow, fast = self._forward if forward else self._backward
        start = sheets.at(slow)
        reach = (NEAR_AXIS * _fourth_root(slow)) ** 2 * start.k2
        near = (start.nearest() < reach) & self._free[1] & ~self._second_slow
        slow = sheets.refined(sheets.step(start, SLOW), SLOW, STEPS - 1)
        fast = sheets.refined(fast, self._second_branch(), STEPS)
        rays = np.flatnonzero(near)
        if rays.size:
            slow[rays], fast[rays] = self._from_axis(rays, forward)
        rays = np.flatnonzero(self._second_slow)
        if rays.size:
            fast[rays] = self._in_dimple(rays, fast[rays], forward)
        return slow, fast

    def _second_branch(self) -> Real:
        one = self.frame.kappa.dtype.type(1.0)
        return np.where(self._second_slow, -one, one)

    def _from_axis(self, rays: Rays, forward: bool) -> tuple[Real, Real]:
        """Return the slow and the fast root of rays near an optic axis, from between the quartic's."""
        sheets = self._sheets.take(rays)
        slow, fast = self._forward if forward else self._backward
        slow, fast = sheets.near_axis(0.5 * (slow[rays] + fast[rays]))
        return sheets.refined(slow, SLOW, MORE_STEPS), sheets.refined(fast, FAST, MORE_STEPS)

    def _in_dimple(self, rays: Rays, known: Real, forward: bool) -> Real:
        """Return the inner slow roots of rays that cross the dimple at an optic axis, one on either side of its tip."""
        sheets = self._sheets.take(rays)
        ahead, back = self._forward[1][rays], self._backward[1][rays]
        pair = sheets.near_axis(0.5 * (ahead + back))
        reach = (NEAR_AXIS * _fourth_root(ahead)) ** 2 * sheets.at(ahead).k2
        near = (sheets.at(ahead).nearest() < reach) & (sheets.at(back).nearest() < reach)
        root = np.minimum(*pair) if forward else np.maximum(*pair)
        return np.where(near, sheets.refined(root, SLOW, MORE_STEPS), sheets.refined(known, SLOW, MORE_STEPS))

    def _complex(self, slow: Real, fast: Real, second: Real, forward: bool) -> tuple[tuple[Field, Real], ...]:
        """Return the roots of both modes as complex numbers, evanescent ones refined, and the branch of each."""
        branches = [np.full(slow.shape, SLOW, slow.dtype), second.copy()]
        kind = np.result_type(slow, np.complex64)
        roots: list[Complex] = [slow.astype(kind), fast.astype(kind)]
        starts = self._forward if forward else self._backward
        for mode, decay in enumerate(self._decay):
            rays = np.flatnonzero(~self._free[mode])
            if rays.size and decay is not None:
                roots[mode][rays] = starts[mode][rays] + (1j if forward else -1j) * decay[rays]
                branches[mode][rays] = self._sheets.take(rays).branch(roots[mode][rays])
        # Of two that are close the quartic knows the mean well, and each but to half the digits.
        none = ~self._free[0]
        close = np.flatnonzero(none & (np.abs(roots[0] - roots[1]) < CLOSE * _fourth_root(slow) * np.abs(roots[0])))
        if close.size:
            sheets = self._sheets.take(close)
            mean = 0.5 * (roots[0][close] + roots[1][close])
            roots[0][close], roots[1][close], _ = sheets.split(mean)
            branches[0][close], branches[1][close] = SLOW, FAST
        for mode in (0, 1):
            rays = np.flatnonzero(~self._free[mode])
            if rays.size:
                sheets = self._sheets.take(rays)
                roots[mode][rays] = sheets.refined_complex(roots[mode][rays], branches[mode][rays], MORE_STEPS)
        return (roots[0], branches[0]), (roots[1], branches[1])

    def _mode(self, k: Point, branch: Real | float, slow: BoolArray) -> Mode:
        """Return the fields of waves with given roots on given branches."""
        kappa, q = self.frame.kappa, k.q
        sheets = self._sheets
        (x1, y1, z1), (x2, y2, z2) = (axis[:3] for axis in sheets.axes)
        ux, uy, uz = self._direction(0, k)
        vx, vy, vz = self._direction(1, k)
        same = (ux * vx + uy * vy + uz * vz).real >= 0.0
        # The longer of u₁ ± u₂; the other vibration is across it and k.
        one = kappa.dtype.type(1.0)
        turn = np.where(same, one, -one)
        lx, ly, lz = ux + turn * vx, uy + turn * vy, uz + turn * vz
        direct = turn == branch
        dx = np.where(direct, lx, -q * ly)
        dy = np.where(direct, ly, q * lx - kappa * lz)
        dz = np.where(direct, lz, kappa * ly)
        along1 = sheets.half * (x1 * dx + y1 * dy + z1 * dz)
        along2 = sheets.half * (x2 * dx + y2 * dy + z2 * dz)
        ex = sheets.middle * dx - (x1 * along2 + x2 * along1)
        ey = sheets.middle * dy - (y1 * along2 + y2 * along1)
        ez = sheets.middle * dz - (z1 * along2 + z2 * along1)
        hx, hy, hz = -q * ey, q * ex - kappa * ez, kappa * ey
        return Mode(q, ex, ey, ez, hx, hy, None, slow, hz)

    def _direction(self, which: int, k: Point) -> tuple[Field, Field, Field]:
        """Return k × o/|k × o| (without conjugation) of an optic axis, and y where k lies along it."""
        kappa = self.frame.kappa
        axis, square = self._sheets.axes[which], k.squares[which]
        on_axis = np.abs(square) <= (ON_AXIS * np.finfo(kappa.dtype).eps) ** 2
        some = bool(on_axis.any())
        if some:
            square = np.where(on_axis, 1.0, square)
        inverse = 1.0 / np.sqrt(square)
        across = -k.q * (axis.y * inverse), k.levers[which] * inverse, axis.ky * inverse
        if not some:
            return across
        a, b, c = (np.where(on_axis, value, v) for value, v in zip((0.0, 1.0, 0.0), across, strict=True))
        return a, b, c


def _real_roots(sheets: Sheets, centre: Real, square: Real) -> tuple[BoolArray, tuple[Real, Real]]:
    """Return where a factor has real roots, and them, the larger first; elsewhere centre ± √|square|.

    Where the two nearly coincide (near an optic axis, or in all directions of a weakly birefringent crystal) the sign
    of the square is rounding, and the sheets themselves are asked.
    """
    width = np.sqrt(np.abs(square))
    real, roots = square >= 0.0, (centre + width, centre - width)
    rays = np.flatnonzero(np.abs(square) < (CLOSE * _fourth_root(centre)) ** 2 * (centre * centre))
    if rays.size:
        some = sheets.take(rays)
        slow, fast, sure = some.split(centre[rays])
        slow, fast = (some.refined(np.asarray(q.real), branch, STEPS) for q, branch in ((slow, SLOW), (fast, FAST)))
        real[rays] |= sure
        for root, better in zip(roots, (np.maximum(slow, fast), np.minimum(slow, fast)), strict=True):
            root[rays] = np.where(sure, better, root[rays])
    return real, roots


def _fourth_root(values: Real) -> float:
    """Return ⁴√ of the unit of rounding: 1.2e-4 in double, 1.9e-2 in single precision."""
    return float(np.sqrt(np.sqrt(np.finfo(values.dtype).eps)))
