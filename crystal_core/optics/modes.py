"""Eigenwaves: plane waves of a medium that share a tangential wave vector."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics.arrays import BoolArray, Complex, Field, Real

__all__ = ["Mode", "Wave", "bilinear"]


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
    direction : tuple of Field or None
        A vector along the energy flow where a closed form gives it, not normalised; None: E × H, by `ray`.
    name : str or BoolArray
        "s", "p", "ordinary" or "extraordinary"; of a biaxial medium True where it is slow and False where it is fast.
    hz : Field or None
        Normal magnetic field; needed only where `direction` is None.
    """

    q: Field
    ex: Field | None
    ey: Field | None
    ez: Field | None
    hx: Field | None
    hy: Field | None
    direction: tuple[Field, Field | None, Field] | None
    name: str | BoolArray
    hz: Field | None = None

    @property
    def ray(self) -> tuple[Field, Field | None, Field]:
        """A vector along the energy flow, not normalised; meaningless where the wave is evanescent."""
        if self.direction is not None:
            return self.direction
        ex, ey, ez, hx, hy, hz = (self._whole(v) for v in (self.ex, self.ey, self.ez, self.hx, self.hy, self.hz))
        return ey * hz - ez * hy, ez * hx - ex * hz, ex * hy - ey * hx

    def _whole(self, component: Field | None) -> Field:
        return np.zeros_like(self.q) if component is None else component

    def half(self, which: int) -> Mode:
        """Return one row of a mode whose arrays have shape (2, N)."""

        def row(values: Field | None) -> Field | None:
            return None if values is None else _row(values, which)

        flow = self.direction
        return Mode(
            self.q[which],
            row(self.ex),
            row(self.ey),
            row(self.ez),
            row(self.hx),
            row(self.hy),
            None if flow is None else (_row(flow[0], which), row(flow[1]), _row(flow[2], which)),
            self.name if isinstance(self.name, str) else self.name[which],
            row(self.hz),
        )

    def names(self) -> NDArray[np.str_]:
        """Return the name of each wave, shape (N,)."""
        if isinstance(self.name, str):
            return np.broadcast_to(np.str_(self.name), self.q.shape)
        return np.where(self.name, np.str_("slow"), np.str_("fast"))

    def norm(self) -> Field:
        """Return g(ψ, ψ) = 2 (E × H)_z, without conjugation: twice the normal flux where the wave propagates."""
        return bilinear(self, self)

    def flux(self) -> Real:
        """Return Re(E × H*)_z, shape (N,)."""
        total: Real = np.zeros_like(self.q.real)
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
    mode : NDArray of str
        "s", "p" (isotropic), "ordinary", "extraordinary" (uniaxial), "slow", "fast" (biaxial), shape (N,).
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

    mode: NDArray[np.str_]
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


def _row(values: Field, which: int) -> Field:
    return values if values.ndim == 1 else values[which]
