"""The waves of a layer: which of the four go forward, and how they travel, however nearly two of them agree.

A pair of waves whose q nearly agree (along an optic axis, in an isotropic medium, at the singular axes of an absorbing
crystal) has no well-defined fields of its own, but the space that the two span is as well defined as ever. So the pair
is kept as that space, an orthonormal basis and a 2 × 2 matrix Q in it whose eigenvalues are the two q.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crystal_core.optics.arrays import BoolArray, Complex, Field, Real
from crystal_core.optics.berreman import flux_product
from crystal_core.optics.two_ports import product

__all__ = ["Pair", "Split", "carried", "phase_matrix", "split"]

REAL = 1e-9
"""|Im q| up to which a wave of a lossless medium propagates: what is less is rounding."""

NO_FLUX = 1e-13
"""Flux of a wave of unit ψ up to which it counts as grazing, and carries nothing."""

_ACROSS = np.sqrt((1.0, 2.0, 3.0, 5.0))
MIRROR = np.eye(4) - 2.0 * np.outer(_ACROSS, _ACROSS) / 11.0
"""A reflection in no special plane. LAPACK balances a matrix before it looks for eigenvalues; entries that are but
rounding, as there are where a crystal stands straight, mislead it to scales that cost half the digits."""

ONE_Q = 1e-7
"""Distance of two q below which their fields are told apart by rounding."""

SERIES = 1e-4
"""|x| below which (sin x)/x is summed as a series."""


@dataclass(frozen=True, slots=True)
class Pair:
    """The two waves whose energy goes one way (evanescent ones: that decay that way).

    Parameters
    ----------
    q : Complex
        Normal parts of the wave vectors, shape (N, 2).
    psi : Complex
        Their tangential fields as columns, each of unit length, shape (N, 4, 2); ill defined where q nearly agree.
    basis : Complex
        Orthonormal basis of the space of the two, shape (N, 4, 2).
    """

    q: Complex
    psi: Complex
    basis: Complex

    def propagating(self) -> BoolArray:
        """Return which of the two waves propagate, shape (N, 2); asked of lossless media."""
        return np.abs(self.q.imag) <= REAL

    def matrix(self, delta: Field) -> Complex:
        """Return Q with Δ basis = basis Q, shape (N, 2, 2)."""
        return product(np.conj(self.basis).swapaxes(1, 2), delta, self.basis)


@dataclass(frozen=True, slots=True)
class Split:
    """The four waves of a layer in two pairs.

    Parameters
    ----------
    forward, backward : Pair
        By the direction of energy or decay.
    separation : Real
        Least distance of a forward q from a backward one, shape (N,): 0 at exactly critical or grazing incidence,
        where two waves fall together and the pairs are no more a basis of all fields.
    """

    forward: Pair
    backward: Pair
    separation: Real


def split(delta: Field) -> Split:
    """Return the waves of Berreman's matrix, shape (N, 4, 4), by direction.

    In a passive medium the normal flux F of a wave and its decay have one sign, F · Im q ≥ 0 (Poynting's theorem), and
    F = 0 where a wave of a lossless medium is evanescent. So F + Im q says which way a wave goes, in all cases.
    """
    q, psi = np.linalg.eig(np.einsum("ij,njk,kl->nil", MIRROR, delta, MIRROR))
    q, psi = q.astype(np.complex128), np.einsum("ij,njk->nik", MIRROR, psi.astype(np.complex128))
    flux = 2.0 * (psi[:, 0] * np.conj(psi[:, 3]) - psi[:, 1] * np.conj(psi[:, 2])).real
    order = np.argsort(-(flux + q.imag), axis=1, kind="stable")
    q, way = np.take_along_axis(q, order, axis=1), np.take_along_axis(flux + q.imag, order, axis=1)
    # Of two waves with one q, one each way, any two fields of their space may come out, with fluxes of one sign.
    one_q = np.abs(q[:, ::2] - q[:, 1::2]) < ONE_Q
    mixed = (one_q[:, 0] & (way[:, 2] > 0.0)) | (one_q[:, 1] & (way[:, 1] < 0.0))
    q[mixed], order[mixed] = q[mixed][:, [0, 2, 1, 3]], order[mixed][:, [0, 2, 1, 3]]
    psi = np.take_along_axis(psi, order[:, None, :], axis=2)
    forward = Pair(q[:, :2], psi[:, :, :2], _space(delta, q[:, 2:]))
    backward = Pair(q[:, 2:], psi[:, :, 2:], _space(delta, q[:, :2]))
    gaps = np.abs(q[:, :2, None] - q[:, None, 2:])
    return Split(forward, backward, gaps.min(axis=(1, 2)))


def _space(delta: Field, other: Complex) -> Complex:
    """Return an orthonormal basis of the waves that (Δ − q₁)(Δ − q₂) leaves, q₁ and q₂ those of the other pair.

    Only q₁ + q₂ and q₁ q₂ enter, which are accurate to rounding even where q₁ and q₂ are not. The product is applied to
    fields without H: none of them lies in the other pair's space unless that pair has a standing wave at the face,
    which a pair that carries energy has not.
    """
    total = (other[:, 0] + other[:, 1])[:, None, None]
    both = (other[:, 0] * other[:, 1])[:, None, None]
    start = np.eye(4)[:, :2]
    once = delta[:, :, :2]
    columns = product(delta, once) - total * once + both * start
    return np.asarray(np.linalg.qr(columns)[0])


def phase_matrix(q_matrix: Complex, phase: Field, lossless: bool) -> Complex:
    """Return exp(i s Q), shape (N, 2, 2), in closed form, also where Q has one eigenvector only.

    With Q = m + R, tr R = 0 and R² = δ²: exp(i s Q) = exp(i s m) (cos s δ + i R (sin s δ)/δ).

    Parameters
    ----------
    q_matrix : Complex
        Q, shape (N, 2, 2).
    phase : Field
        s = k0 d, negative for waves that go along −z, shape (N,).
    lossless : bool
        Whether an imaginary part of less than 1e-9 of an eigenvalue of Q is rounding, to be dropped.
    """
    mean = 0.5 * (q_matrix[:, 0, 0] + q_matrix[:, 1, 1])
    half = 0.5 * (q_matrix[:, 0, 0] - q_matrix[:, 1, 1])
    delta = np.sqrt(half * half + q_matrix[:, 0, 1] * q_matrix[:, 1, 0])
    first, second = mean + delta, mean - delta
    if lossless:
        first, second = (np.where(np.abs(v.imag) <= REAL, v.real, v) for v in (first, second))
    # Each exponential by itself decays; cos and sin of a complex argument would grow.
    e1, e2 = np.exp(1j * phase * first), np.exp(1j * phase * second)
    gap = 0.5 * (first - second)
    x2 = (phase * gap) ** 2
    small = np.abs(x2) <= SERIES**2
    series = 1j * phase * np.exp(1j * phase * 0.5 * (first + second)) * (1.0 - x2 / 6.0)
    slope = np.where(small, series, (e1 - e2) / np.where(small, 1.0, 2.0 * gap))
    cosine = 0.5 * (e1 + e2)
    result = np.empty_like(q_matrix)
    result[:, 0, 0] = cosine + slope * half
    result[:, 1, 1] = cosine - slope * half
    result[:, 0, 1] = slope * q_matrix[:, 0, 1]
    result[:, 1, 0] = slope * q_matrix[:, 1, 0]
    return result


def carried(pair: Pair, delta: Field, sign: int) -> tuple[Complex, Complex, BoolArray]:
    """Return the waves of a lossless layer normalised to unit flux: what beams are counted in.

    Parameters
    ----------
    pair : Pair
        Of a lossless medium.
    delta : Field
        Its Berreman matrix, shape (N, 4, 4).
    sign : int
        +1 for the forward pair, −1 for the backward.

    Returns
    -------
    q : Complex
        Shape (N, 2).
    psi : Complex
        Columns of 2 |Re (E × H*)_z| = 1 that exchange no energy, shape (N, 4, 2); unit length where evanescent.
    carries : BoolArray
        Which of them carry energy, shape (N, 2).
    """
    q, psi, carries = pair.q.copy(), pair.psi.copy(), pair.propagating()
    flux = sign * np.einsum("nii->ni", flux_product(psi, psi)).real
    carries &= flux > NO_FLUX
    psi /= np.sqrt(np.where(carries, flux, 1.0))[:, None, :]
    both = np.flatnonzero(carries.all(axis=1))
    if both.size:
        # Two waves that propagate: an orthonormal basis by flux, in which Q is Hermitian, and its eigenvectors.
        basis = pair.basis[both]
        size, turn = np.linalg.eigh(sign * flux_product(basis, basis))
        fit = size[:, 0] > NO_FLUX
        basis = product(basis, turn) / np.sqrt(np.where(fit[:, None], size, 1.0))[:, None, :]
        levels, mix = np.linalg.eigh(sign * flux_product(basis, product(delta[both], basis)))
        chosen = both[fit]
        q[chosen] = levels[fit]
        psi[chosen] = product(basis, mix)[fit]
    # Evanescent pairs that nearly agree (total reflection in isotropic media) need a basis that is one.
    none = ~carries.any(axis=1)
    psi[none] = pair.basis[none]
    return np.where(carries, q.real, q), psi, carries
