"""Eigenwaves: the four waves of a medium that share a tangential wave vector.

In the frame of the interface a wave vector is (κ, 0, q). With a uniaxial ε = ε_o 1 + (ε_e − ε_o) c cᵀ, Maxwell's
equations k × E = H, k × H = −ε E have two pairs of solutions, written here with m = k × c (Born & Wolf, Principles of
Optics, 7th ed., §15.3; derivation in ``docs/conventions.md``):

* ordinary: k² = ε_o, E = m, H = k × m, ray along k;
* extraordinary: k·ε·k = ε_o ε_e, H = m, D = −k × m, E = ε⁻¹D, ray along ε k.

Both pairs are computed from one m: then they stay orthogonal to rounding however near k comes to the optic axis, and
at the axis, where m vanishes and any pair serves, m is replaced by the frame's y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crystal_core.optics.arrays import BoolArray, Complex, Field, Rays, Real
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.medium import Medium, take

__all__ = ["FramedMedium", "Mode", "Wave", "bilinear"]

ON_AXIS = 1e-28
"""|k × c|²/ε_o below which a wave counts as travelling along the optic axis (an angle of 1e-14: rounding)."""

BOTH_SIGNS = np.array(((1.0,), (-1.0,)))
"""For waves along and against the normal in one go: half the calls for the same arithmetic."""


@dataclass(slots=True)
class Mode:
    """One eigenwave in the interface frame; None stands for a component that is zero for the whole batch.

    Parameters
    ----------
    q : Field
        Component of the wave vector along the normal, shape (N,).
    ex, ey, ez : Field or None
        Electric field, not normalised.
    hx, hy : Field or None
        Tangential magnetic field, H = k × E.
    ray : tuple of Field
        A vector along the energy flow, not normalised; meaningless where the wave is evanescent.
    """

    q: Field
    ex: Field | None
    ey: Field | None
    ez: Field | None
    hx: Field | None
    hy: Field | None
    ray: tuple[Field, Field | None, Field]

    def half(self, which: int) -> Mode:
        """Return one row of a mode whose arrays have shape (2, N)."""

        def row(values: Field | None) -> Field | None:
            return None if values is None else _row(values, which)

        return Mode(
            self.q[which],
            row(self.ex),
            row(self.ey),
            row(self.ez),
            row(self.hx),
            row(self.hy),
            (_row(self.ray[0], which), row(self.ray[1]), _row(self.ray[2], which)),
        )

    def norm(self) -> Field:
        """Return g(ψ, ψ) = 2 (E × H)_z, without conjugation: twice the normal flux where the wave propagates."""
        return bilinear(self, self)

    def flux(self) -> Real:
        """Return Re(E × H*)_z, shape (N,)."""
        total: Real = np.zeros(self.q.shape)
        if self.ex is not None and self.hy is not None:
            total = total + (self.ex * np.conj(self.hy)).real
        if self.ey is not None and self.hx is not None:
            total = total - (self.ey * np.conj(self.hx)).real
        return total


@dataclass(frozen=True, slots=True)
class Wave:
    """One eigenwave in the world's frame, as `scatter` returns it.

    Parameters
    ----------
    name : str
        "s", "p", "ordinary" or "extraordinary".
    k, k_imag : Real
        Wave vector in units of 2π/λ, real and imaginary part, shape (3, N).
    field : Complex
        Electric field of unit length, shape (3, N).
    ray : Real
        Unit vector of the energy flow Re E × H*, shape (3, N); NaN where the wave is evanescent.
    index : Real
        Length of k, shape (N,); NaN where the wave is evanescent.
    propagating : BoolArray
        Whether the wave carries energy along the normal, shape (N,).
    flux : Real
        Re(E × H*)·normal of the normalised field, shape (N,); 0 where evanescent.
    """

    name: str
    k: Real
    k_imag: Real
    field: Complex
    ray: Real
    index: Real
    propagating: BoolArray
    flux: Real


def bilinear(a: Mode, b: Mode) -> Field:
    """Return g(a, b) = (E_a × H_b + E_b × H_a)_z, shape (N,).

    By Lorentz's reciprocity with the centrosymmetry of a symmetric ε (the wave −k has E, −H), g vanishes between any
    two different waves of one medium with the same tangential k, evanescent ones included: modes are g-orthogonal.
    """
    terms: list[tuple[int, Field | None, Field | None]] = [
        (1, a.ex, b.hy),
        (-1, a.ey, b.hx),
        (1, b.ex, a.hy),
        (-1, b.ey, a.hx),
    ]
    if a is b:
        terms = terms[:2]
    total: Field | None = None
    for sign, e, h in terms:
        if e is None or h is None:
            continue
        product = e * h
        if total is None:
            total = product if sign > 0 else -product
        else:
            total = total + product if sign > 0 else total - product
    if total is None:
        return np.zeros(a.q.shape)
    return 2.0 * total if a is b else total


class FramedMedium:
    """A medium in the frame of an interface: what its four waves have in common.

    Parameters
    ----------
    medium : Medium
        Isotropic (modes s, p) or uniaxial (ordinary, extraordinary).
    frame : InterfaceFrame
        Plane of incidence of each ray.
    """

    def __init__(self, medium: Medium, frame: InterfaceFrame) -> None:
        self.medium = medium
        self.frame = frame
        kappa = frame.kappa
        self._eps_o = medium.indices[0] ** 2
        self._q2_o = self._eps_o - kappa * kappa
        if medium.axis is None:
            return
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

    def take(self, rays: Rays) -> FramedMedium:
        """Return the same for a selection of rays."""
        part = object.__new__(FramedMedium)
        part.medium = self.medium.take(rays)
        part.frame = self.frame.take(rays)
        part._eps_o = take(self._eps_o, rays)
        part._q2_o = self._q2_o[rays]
        if not self.medium.is_isotropic:
            part._c = (self._c[0][rays], self._c[1][rays], self._c[2][rays])
            part._eps_e = take(self._eps_e, rays)
            part._difference = take(self._difference, rays)
            part._a, part._b = self._a[rays], self._b[rays]
            part._discriminant = self._discriminant[rays]
        return part

    def propagating(self) -> tuple[BoolArray, BoolArray]:
        """Return, for each of the two modes, whether it propagates, shape (N,) each.

        A wave exactly at its limit (no flux along the normal) counts as propagating.
        """
        first = self._q2_o >= 0
        return first, first if self.medium.is_isotropic else self._discriminant >= 0

    def pair(self, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
        """Return the two waves whose energy goes along sign·normal (evanescent ones: that decay along it).

        Parameters
        ----------
        sign : int
            +1 or −1.
        evanescent : bool
            Whether a wave of this batch may be evanescent: then the arithmetic is complex. With False every wave must
            propagate (see `propagating`).
        """
        return self._pair(float(sign), evanescent)

    def both_pairs(self, evanescent: bool) -> tuple[tuple[Mode, Mode], tuple[Mode, Mode]]:
        """Return the pairs of `pair` for +1 and for −1, computed together."""
        first, second = self._pair(BOTH_SIGNS, evanescent)
        return (first.half(0), second.half(0)), (first.half(1), second.half(1))

    def _pair(self, sign: float | Real, evanescent: bool) -> tuple[Mode, Mode]:
        """Return a pair of modes; a sign of shape (2, 1) gives arrays of shape (2, N)."""
        if self.medium.is_isotropic:
            return self._isotropic_pair(sign, evanescent)
        return self._uniaxial_pair(sign, evanescent)

    def _isotropic_pair(self, sign: float | Real, evanescent: bool) -> tuple[Mode, Mode]:
        n = self.medium.indices[0]
        kappa = self.frame.kappa
        q = sign * _root(self._q2_o, evanescent)
        ray = (kappa, None, q)
        s = Mode(q, None, np.ones(kappa.shape), None, -q, None, ray)
        p = Mode(q, q / n, None, -kappa / n, None, np.broadcast_to(n, kappa.shape), ray)
        return s, p

    def _uniaxial_pair(self, sign: float | Real, evanescent: bool) -> tuple[Mode, Mode]:
        kappa = self.frame.kappa
        cx, cy, cz = self._c
        eps_o = self._eps_o

        q_o = sign * _root(self._q2_o, evanescent)
        mx: Field = -q_o * cy
        my: Field = q_o * cx - kappa * cz
        mz: Field = np.broadcast_to(kappa * cy, q_o.shape)
        m2: Field = mx * mx + my * my + mz * mz

        # q_e = (root − b)/a, written as its difference from q_o, which solves k·ε·k − ε_o ε_e = −difference·|m|²: near
        # the optic axis the plain difference of two nearly equal roots would lose every digit.
        root = sign * _root(self._discriminant, evanescent)
        slope = self._a * q_o + self._b + root
        straight = (np.abs(slope) < np.abs(root)) | (slope == 0)
        crossed = bool(straight.any())
        if crossed:
            slope[straight] = 1.0
        shift = self._difference * m2 / slope
        if crossed:  # opposite signs: here the plain difference is the one that keeps its digits
            shift = np.where(straight, (root - self._b) / self._a - q_o, shift)
        q_e = q_o + shift

        nx: Field = mx - shift * cy
        ny: Field = my + shift * cx
        nz = mz
        m2_e: Field = nx * nx + ny * ny + nz * nz
        # A complex m can have m·m = 0 without vanishing, hence the conjugate.
        on_axis = (m2 if not evanescent else _squared_length(mx, my, mz)) <= ON_AXIS * eps_o
        if on_axis.any():
            mx, my, mz = (np.where(on_axis, value, m) for value, m in ((0.0, mx), (1.0, my), (0.0, mz)))
            nx, ny, nz = (np.where(on_axis, value, m) for value, m in ((0.0, nx), (1.0, ny), (0.0, nz)))
            m2_e = np.where(on_axis, 0.0, m2_e)

        ordinary = Mode(q_o, mx, my, mz, -q_o * my, q_o * mx - kappa * mz, (kappa, None, q_o))
        inverse = 1.0 / eps_o
        along_c = m2_e * (1.0 / self._eps_e - inverse)
        stretch = self._difference * (kappa * cx + q_e * cz)
        extraordinary = Mode(
            q_e,
            q_e * ny * inverse + along_c * cx,
            (kappa * nz - q_e * nx) * inverse + along_c * cy,
            -kappa * ny * inverse + along_c * cz,
            nx,
            ny,
            (eps_o * kappa + stretch * cx, stretch * cy, eps_o * q_e + stretch * cz),
        )
        return ordinary, extraordinary


def _squared_length(x: Field, y: Field, z: Field) -> Real:
    total: Real = np.abs(x) ** 2 + np.abs(y) ** 2 + np.abs(z) ** 2
    return total


def _root(square: Real, evanescent: bool) -> Field:
    """Return √square, with Im ≥ 0 where it is negative: a wave along +normal decays with it."""
    if not evanescent:
        return np.sqrt(square)
    root = np.empty(square.shape, np.complex128)
    root.real = np.sqrt(np.maximum(square, 0.0))
    root.imag = np.sqrt(np.maximum(-square, 0.0))
    return root


def _row(values: Field, which: int) -> Field:
    return values if values.ndim == 1 else values[which]


def _columns(axis: Real) -> Real:
    return axis[:, None] if axis.ndim == 1 else axis
