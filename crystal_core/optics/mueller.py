"""Jones and Mueller views of an event: what it does to coherency matrices, Stokes parameters and importances.

An event with the Jones matrix J maps C → J C J† (`transported`). With the Stokes parameters S_i = tr(σ_i C) of
``docs/conventions.md``, where σ = (1, diag(1, −1), [[0, 1], [1, 0]], [[0, −i], [i, 0]]) and C = ½ Σ S_i σ_i, the same
is S → M S with the real matrix

    M_ij = ½ tr(σ_i J σ_j J†)

(R. Simon, Opt. Commun. 42, 293 (1982); Born & Wolf, Principles of Optics, 7th ed., §10.9.3). Beams that do not
interfere add, and so do their Mueller matrices: a sum of them, unlike one of Jones matrices, may depolarize.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from crystal_core.optics.arrays import Complex, Field, Real
from crystal_core.optics.coherency import Coherency

__all__ = [
    "coherency_of",
    "degree_of_polarization",
    "frame_rotation",
    "importance_before",
    "measured",
    "mueller",
    "partially_coherent",
    "reversed_jones",
    "reversed_mueller",
    "rotated_jones",
    "rotated_mueller",
    "transported",
]

BASIS: Complex = np.array(
    (((1, 0), (0, 1)), ((1, 0), (0, -1)), ((0, 1), (1, 0)), ((0, -1j), (1j, 0))),
    np.complex128,
)
"""The matrices σ_i of S_i = tr(σ_i C), shape (4, 2, 2)."""

REVERSAL: Real = np.array((1.0, 1.0, -1.0, 1.0))
"""Diagonal of O in M_b = O Mᵀ O."""


def mueller(jones: Field) -> Real:
    """Return the Mueller matrices of Jones matrices, shape (2, 2, N) → (4, 4, N).

    Parameters
    ----------
    jones : Field
        jones[i, j]: amplitude of component i behind the event from component j before it, shape (2, 2, N); flux-
        normalised, if M is to speak of power. Both frames are right-handed, (x, y, propagation).

    Raises
    ------
    ValueError
        `jones` is not of that shape.
    """
    j = _matrices(jones, 2)
    # J σ_j J†, then its trace with σ_i. Plain einsum: no BLAS over rays.
    passed = np.einsum("abn,jbc,dcn->jadn", j, BASIS, np.conj(j))
    return np.asarray(0.5 * np.einsum("ida,jadn->ijn", BASIS, passed).real)


def frame_rotation(angle: ArrayLike) -> Real:
    """Return the Jones matrices of going over to a frame turned counter-clockwise, shape (2, 2, N).

    Light is not changed by it: x' = cos φ x + sin φ y, so that E' = [[cos, sin], [−sin, cos]] E, as
    `Coherency.rotated` does. Its Mueller matrix, `mueller(frame_rotation(φ))`, turns (S1, S2) by −2φ.

    Parameters
    ----------
    angle : array_like
        φ in radians about the propagation, counter-clockwise to an observer who faces the source, shape () or (N,).
    """
    phi = np.atleast_1d(np.asarray(angle, np.float64))
    cos, sin = np.cos(phi), np.sin(phi)
    return np.array(((cos, sin), (-sin, cos)))


def rotated_jones(jones: Field, angle: ArrayLike) -> Field:
    """Return the Jones matrices of an element turned counter-clockwise in a fixed frame, R(−φ) J R(φ), (2, 2, N)."""
    turn = frame_rotation(angle)
    return np.asarray(np.einsum("ban,bcn,cdn->adn", *np.broadcast_arrays(turn, _matrices(jones, 2), turn)))


def rotated_mueller(matrix: Real, angle: ArrayLike) -> Real:
    """Return the Mueller matrices of an element turned counter-clockwise in a fixed frame, shape (4, 4, N).

    Parameters
    ----------
    matrix : Real
        Mueller matrices of the element at φ = 0, shape (4, 4, N).
    angle : array_like
        φ in radians, shape () or (N,).
    """
    m, turn = np.broadcast_arrays(_matrices(matrix, 4), mueller(frame_rotation(angle)))
    return np.asarray(np.einsum("ban,bcn,cdn->adn", turn, m, turn))


def partially_coherent(first: Field, second: Field, degree: ArrayLike) -> Real:
    """Return the Mueller matrices of two fields of one parent that overlap, shape (4, 4, N).

    The cross term of |J₁ + J₂|² is multiplied by the degree of coherence γ of the wavelength band, so that
    M = M(J₁) + M(J₂) + γ [M(J₁ + J₂) − M(J₁) − M(J₂)]: γ = 1 is interference, γ = 0 the incoherent sum.

    Parameters
    ----------
    first, second : Field
        Jones matrices, shape (2, 2, N), each with the phase it arrives with at the centre of the band.
    degree : array_like
        γ, real (a band that is symmetric about its centre), from −1 to 1, shape () or (N,).
    """
    apart = mueller(first) + mueller(second)
    together = mueller(_matrices(first, 2) + _matrices(second, 2))
    return np.asarray(apart + np.asarray(degree, np.float64) * (together - apart))


def transported(coherency: Coherency, jones: Field) -> Coherency:
    """Return J C J† of `jones`, shape (2, 2, N)."""
    (a, b), (c, d) = _matrices(jones, 2)
    xx = coherency.power_into(a, b)
    yy = coherency.power_into(c, d)
    xy = coherency.xy_re + 1j * coherency.xy_im
    cross = (
        a * np.conj(c) * coherency.xx
        + b * np.conj(d) * coherency.yy
        + a * np.conj(d) * xy
        + b * np.conj(c) * np.conj(xy)
    )
    return Coherency(xx, yy, np.asarray(cross.real), np.asarray(cross.imag))


def importance_before(importance: Coherency, jones: Field) -> Coherency:
    """Return J† W J: what a measurement W behind an event measures of the light before it.

    The adjoint of `transported`: `measured(W, transported(C, J)) == measured(importance_before(W, J), C)`. J is that of
    the event as light goes through it, `jones[i, j]` from j before to i behind, shape (2, 2, N).
    """
    return transported(importance, np.conj(np.swapaxes(_matrices(jones, 2), 0, 1)))


def measured(importance: Coherency, light: Coherency) -> Real:
    """Return tr(W C), shape (N,): what a measurement W takes of light C in the same frame."""
    w, c = importance, light
    return np.asarray(w.xx * c.xx + w.yy * c.yy + 2.0 * (w.xy_re * c.xy_re + w.xy_im * c.xy_im))


def reversed_jones(jones: Field) -> Field:
    """Return the Jones matrices of an event run backward, each end in the beam's own right-handed frame, (2, 2, N).

    By reciprocity J_b = Jᵀ with the axes of the forward frames. Of a right-handed frame one axis turns round with the
    beam; here it is x, at both ends. It holds in all media but magneto-optic ones, optically active ones included.
    """
    (a, b), (c, d) = _matrices(jones, 2)
    return np.array(((a, -c), (-b, d)))


def reversed_mueller(matrix: Real) -> Real:
    """Return M_b = O Mᵀ O with O = diag(1, 1, −1, 1), shape (4, 4, N): the Mueller view of `reversed_jones`.

    Being linear it holds for sums, that is for events that depolarize, too (Z. Sekera, J. Opt. Soc. Am. 56, 1732
    (1966)).
    """
    m = _matrices(matrix, 4)
    return np.asarray(REVERSAL[:, None, None] * np.swapaxes(m, 0, 1) * REVERSAL[None, :, None])


def degree_of_polarization(coherency: Coherency) -> Real:
    """Return √(1 − 4 det C/(tr C)²), from 0 (unpolarized) to 1, shape (N,); 0 where there is no light.

    Computed as √(S1² + S2² + S3²)/S0, the same without cancellation.
    """
    c = coherency
    total = c.intensity()
    dark = total <= 0.0
    polarized = np.sqrt((c.xx - c.yy) ** 2 + 4.0 * (c.xy_re**2 + c.xy_im**2))
    return np.asarray(np.where(dark, 0.0, polarized / np.where(dark, 1.0, total)))


def coherency_of(stokes: Real) -> Coherency:
    """Return the coherency matrices C = ½ Σ S_i σ_i of Stokes parameters, shape (4, N); undoes `Coherency.stokes`."""
    s0, s1, s2, s3 = np.asarray(stokes, np.float64)
    return Coherency(0.5 * (s0 + s1), 0.5 * (s0 - s1), 0.5 * s2, -0.5 * s3)


def _matrices(values: Field, size: int) -> Field:
    if values.ndim != 3 or values.shape[:2] != (size, size):
        raise ValueError(f"matrices of shape ({size}, {size}, N) are wanted, not {values.shape}")
    return values
