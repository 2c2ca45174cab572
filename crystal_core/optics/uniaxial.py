"""Eigenwaves of a uniaxial medium, in closed form.

In the frame of the interface a wave vector is (κ, 0, q). With a uniaxial ε = ε_o 1 + (ε_e − ε_o) c cᵀ, Maxwell's
equations k × E = H, k × H = −ε E have two pairs of solutions, written here with m = k × c (Born & Wolf, Principles of
Optics, 7th ed., §15.3; derivation in ``docs/conventions.md``):

* ordinary: k² = ε_o, E = m, H = k × m, ray along k;
* extraordinary: k·ε·k = ε_o ε_e, H = m, D = −k × m, E = ε⁻¹D, ray along ε k.

Both pairs are computed from one m: then they stay orthogonal to rounding however near k comes to the optic axis, and
at the axis, where m vanishes and any pair serves, m is replaced by the frame's y.
"""

from __future__ import annotations

import numpy as np

from crystal_core.optics.arrays import BoolArray, Field, Rays, Real
from crystal_core.optics.framed import ClosedForm, signed_root
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.medium import Medium, take
from crystal_core.optics.modes import Mode

__all__ = ["FramedUniaxial"]

ON_AXIS = 45.0
"""Angle to the optic axis, in units of rounding, below which a wave counts as travelling along it (1e-14)."""


class FramedUniaxial(ClosedForm):
    """A uniaxial medium in the frame of an interface: modes ordinary and extraordinary."""

    def __init__(self, medium: Medium, frame: InterfaceFrame) -> None:
        super().__init__(medium, frame)
        assert medium.axis is not None
        kappa = frame.kappa
        self._eps_o = medium.indices[0] ** 2
        self._q2 = self._eps_o - kappa * kappa
        self._c = frame.components(_columns(medium.axis))
        cx, _, cz = self._c
        self._eps_e = medium.indices[1] ** 2
        self._difference = self._eps_e - self._eps_o
        # a q² + 2 b q + c = 0 is k·ε·k = ε_o ε_e for k = (κ, 0, q). The ray's normal component is a q + b =
        # ± √(b² − a c): the root's sign is the sign of the energy flow.
        self._a = self._eps_o + self._difference * cz * cz
        self._b = self._difference * kappa * cx * cz
        # b² − a c with the terms of fourth order in the axis cancelled by hand.
        self._discriminant = self._eps_o * (
            self._eps_e * self._a - kappa * kappa * (self._eps_o + self._difference * (cx * cx + cz * cz))
        )

    def take(self, rays: Rays) -> FramedUniaxial:
        """Return the same for a selection of rays."""
        part = object.__new__(FramedUniaxial)
        part.medium = self.medium.take(rays)
        part.frame = self.frame.take(rays)
        part._eps_o, part._eps_e = take(self._eps_o, rays), take(self._eps_e, rays)
        part._difference = take(self._difference, rays)
        part._c = (self._c[0][rays], self._c[1][rays], self._c[2][rays])
        part._q2, part._discriminant = self._q2[rays], self._discriminant[rays]
        part._a, part._b = self._a[rays], self._b[rays]
        return part

    def propagating(self) -> tuple[BoolArray, BoolArray]:
        """Return whether the ordinary and the extraordinary wave propagate, shape (N,) each."""
        return self._q2 >= 0, self._discriminant >= 0

    def _pair(self, sign: float | Real, evanescent: bool) -> tuple[Mode, Mode]:
        kappa = self.frame.kappa
        cx, cy, cz = self._c
        eps_o = self._eps_o

        q_o = sign * signed_root(self._q2, evanescent)
        cy2 = cy * cy
        mx: Field = -cy * q_o
        my: Field = q_o * cx - kappa * cz
        mz: Field = np.broadcast_to(kappa * cy, q_o.shape)
        m2: Field = cy2 * eps_o + my * my  # the squares of mx and mz add up to cy² k²

        # q_e = (root − b)/a, written as its difference from q_o, which solves k·ε·k − ε_o ε_e = −difference·|m|²: near
        # the optic axis the plain difference of two nearly equal roots would lose every digit.
        root = sign * signed_root(self._discriminant, evanescent)
        slope = self._a * q_o + self._b + root
        straight = np.abs(slope) <= np.abs(root)
        crossed = bool(straight.any())
        if crossed:
            slope[straight] = 1.0
        shift = self._difference * m2 / slope
        if crossed:  # opposite signs: here the plain difference is the one that keeps its digits
            shift = np.where(straight, (root - self._b) / self._a - q_o, shift)
        q_e = q_o + shift

        nx: Field = -cy * q_e
        ny: Field = my + shift * cx
        k2: Field = kappa * kappa + q_e * q_e
        m2_e: Field = cy2 * k2 + ny * ny
        # A complex m can have m·m = 0 without vanishing, hence the conjugate.
        on_axis_square = (ON_AXIS * np.finfo(kappa.dtype).eps) ** 2
        on_axis = (m2 if not evanescent else _squared_length(mx, my, mz)) <= on_axis_square * eps_o
        if on_axis.any():
            mx, my, mz = (np.where(on_axis, value, m) for value, m in ((0.0, mx), (1.0, my), (0.0, mz)))
            nx, ny = np.where(on_axis, 0.0, nx), np.where(on_axis, 1.0, ny)
            m2_e, cy = np.where(on_axis, 0.0, m2_e), np.where(on_axis, 0.0, cy)

        # The y component of k × m is −cy k².
        hy: Field = np.broadcast_to(-cy * eps_o, q_o.shape)
        ordinary = Mode(q_o, mx, my, mz, -q_o * my, hy, (kappa, None, q_o), "ordinary")
        inverse = 1.0 / eps_o
        along_c = m2_e * (1.0 / self._eps_e - inverse)
        stretch = self._difference * (kappa * cx + q_e * cz)
        extraordinary = Mode(
            q_e,
            q_e * ny * inverse + along_c * cx,
            cy * (k2 * inverse + along_c),
            along_c * cz - kappa * inverse * ny,
            nx,
            ny,
            (eps_o * kappa + stretch * cx, stretch * cy, eps_o * q_e + stretch * cz),
            "extraordinary",
        )
        return ordinary, extraordinary


def _squared_length(x: Field, y: Field, z: Field) -> Real:
    total: Real = np.abs(x) ** 2 + np.abs(y) ** 2 + np.abs(z) ** 2
    return total


def _columns(axis: Real) -> Real:
    return axis[:, None] if axis.ndim == 1 else axis
