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

from crystal_core.optics.arrays import BoolArray, Complex, Field, Real
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.medium import Medium

__all__ = ["Mode", "Wave", "mode_pair", "propagating"]

ON_AXIS = 1e-28
"""|k × c|²/ε_o below which a wave counts as travelling along the optic axis (an angle of 1e-14: rounding)."""


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


def propagating(medium: Medium, frame: InterfaceFrame) -> tuple[BoolArray, BoolArray]:
    """Return, for each of the medium's two modes, whether it propagates, shape (N,) each.

    A wave exactly at its limit (q real, no flux along the normal) counts as propagating.
    """
    kappa2 = frame.kappa**2
    if medium.is_isotropic:
        free = medium.indices[0] ** 2 - kappa2 >= 0
        return free, free
    assert medium.axis is not None
    cx, _, cz = frame.components(_columns(medium.axis))
    _, _, discriminant = _extraordinary_quadratic(medium, frame.kappa, cx, cz)
    return medium.indices[0] ** 2 - kappa2 >= 0, discriminant >= 0


def mode_pair(medium: Medium, frame: InterfaceFrame, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
    """Return the two waves whose energy goes along sign·normal (evanescent ones: that decay along it).

    Parameters
    ----------
    medium : Medium
        Isotropic (modes s, p) or uniaxial (ordinary, extraordinary).
    frame : InterfaceFrame
        Plane of incidence of each ray.
    sign : int
        +1 or −1.
    evanescent : bool
        Whether a wave of this batch may be evanescent: then all arithmetic is complex. With False, every q² must be
        ≥ 0 (see `propagating`).
    """
    if medium.is_isotropic:
        return _isotropic_pair(medium, frame, sign, evanescent)
    return _uniaxial_pair(medium, frame, sign, evanescent)


def _isotropic_pair(medium: Medium, frame: InterfaceFrame, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
    n = medium.indices[0]
    q = sign * _root(n * n - frame.kappa**2, evanescent)
    ones = np.ones(q.shape)
    ray = (frame.kappa, None, q)
    s = Mode(q, None, ones, None, -q, None, ray)
    p = Mode(q, q / n, None, -frame.kappa / n, None, n * ones, ray)
    return s, p


def _uniaxial_pair(medium: Medium, frame: InterfaceFrame, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
    assert medium.axis is not None
    kappa = frame.kappa
    cx, cy, cz = frame.components(_columns(medium.axis))
    eps_o = medium.indices[0] ** 2
    eps_e = medium.indices[1] ** 2
    difference = eps_e - eps_o

    q_o = sign * _root(eps_o - kappa * kappa, evanescent)
    mx: Field = -q_o * cy
    my: Field = q_o * cx - kappa * cz
    mz: Field = kappa * cy
    m2: Field = mx * mx + my * my + mz * mz

    a, b, discriminant = _extraordinary_quadratic(medium, kappa, cx, cz)
    root = sign * _root(discriminant, evanescent)
    # q_e = (root − b)/a, written as its difference from q_o (which solves k·ε·k − ε_o ε_e = −difference·|m|²): near
    # the axis the difference of two nearly equal roots would lose every digit.
    slope = a * q_o + b + root
    straight = np.flatnonzero((np.abs(slope) < np.abs(root)) | (slope == 0))
    if straight.size:
        slope[straight] = 1.0
    shift = difference * m2 / slope
    if straight.size:  # opposite signs: here the plain difference is the one that keeps its digits
        shift[straight] = ((root - b) / a - q_o)[straight]
    q_e = q_o + shift

    # A complex m can have m·m = 0 without vanishing, hence the conjugate.
    on_axis = (m2 if not evanescent else _squared_length(mx, my, mz)) <= ON_AXIS * eps_o
    nx: Field = mx - shift * cy
    ny: Field = my + shift * cx
    m2_e: Field = nx * nx + ny * ny + mz * mz
    nz = mz
    if on_axis.any():
        mx, my, mz = (np.where(on_axis, value, m) for value, m in ((0.0, mx), (1.0, my), (0.0, mz)))
        nx, ny, nz = (np.where(on_axis, value, m) for value, m in ((0.0, nx), (1.0, ny), (0.0, nz)))
        m2_e = np.where(on_axis, 0.0, m2_e)

    ordinary = Mode(q_o, mx, my, mz, -q_o * my, q_o * mx - kappa * mz, (kappa, None, q_o))
    along_c = m2_e * (1.0 / eps_e - 1.0 / eps_o)
    inverse = 1.0 / eps_o
    stretch = difference * (kappa * cx + q_e * cz)
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


def _extraordinary_quadratic(medium: Medium, kappa: Real, cx: Real, cz: Real) -> tuple[Real, Real, Real]:
    """Return a, b and b² − a·c of a q² + 2 b q + c = 0, which is k·ε·k = ε_o ε_e for k = (κ, 0, q).

    The ray's normal component is a q + b = ± √(b² − a c): the root's sign is the sign of the energy flow.
    """
    eps_o = medium.indices[0] ** 2
    eps_e = medium.indices[1] ** 2
    difference = eps_e - eps_o
    a = eps_o + difference * cz * cz
    b = difference * kappa * cx * cz
    # b² − a c with the terms of fourth order in c cancelled by hand: κ² ε_o (ε_o + d(cx² + cz²)) is what is left.
    discriminant = eps_o * (eps_e * a - kappa * kappa * (eps_o + difference * (cx * cx + cz * cz)))
    return a, b, discriminant


def _squared_length(x: Field, y: Field, z: Field) -> Real:
    total: Real = np.abs(x) ** 2 + np.abs(y) ** 2 + np.abs(z) ** 2
    return total


def _root(square: Real, evanescent: bool) -> Field:
    if not evanescent:
        return np.sqrt(square)
    # Im ≥ 0: a wave along +normal decays with it.
    return np.sqrt(square.astype(np.complex128))


def _columns(axis: Real) -> Real:
    return axis[:, None] if axis.ndim == 1 else axis
