"""Waves and faces of optically active media in long arithmetic, from the wave equation of E alone.

With D = ε E + i κ H, B = H − i κ E, elimination of H from k × E = B, k × H = −D leaves W E = 0 with

    W = (k× + i κ)² + ε,        H = (k× + i κ) E.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import mpmath
import numpy as np

from crystal_core.optics.arrays import Complex, Real

__all__ = ["ExactWave", "exact_face", "exact_indices", "wave_matrix"]

DIGITS = 50
REAL = 1e-30


@dataclass(frozen=True)
class ExactWave:
    """One wave at a face: q along the normal, E and H, and its flux along the normal if |E| = 1; 0 if evanescent."""

    q: mpmath.mpc
    e: mpmath.matrix
    h: mpmath.matrix
    flux: mpmath.mpf


def wave_matrix(k: Sequence[mpmath.mpf], epsilon: mpmath.matrix, kappa: mpmath.matrix) -> mpmath.matrix:
    """Return W."""
    curl = _curl(k) + 1j * kappa
    return curl * curl + epsilon


def exact_indices(s: Real, epsilon: Real, kappa: Real) -> list[mpmath.mpf]:
    """Return the indices of both waves along s, the larger first: the positive roots of det W = 0."""
    eps, kap = _matrix(epsilon), _matrix(kappa)
    along = _matrix(s)
    along /= mpmath.norm(along)  # of unit length to more digits than it has
    roots = _roots(lambda n: mpmath.det(wave_matrix([n * c for c in along], eps, kap)))
    return sorted((mpmath.re(n) for n in roots if mpmath.re(n) > 0), reverse=True)


def exact_face(
    normal: Real, tangential: Real, source: tuple[Real, Real], target: tuple[Real, Real]
) -> tuple[list[ExactWave], list[ExactWave], list[ExactWave], Complex]:
    """Return incident, reflected and transmitted waves, and the powers [outgoing, incident], reflected first, (4, 2).

    `source` and `target` are (ε, κ), shape (3, 3) each. Powers of evanescent waves are 0; columns of evanescent
    incident waves are NaN.
    """
    z, kt = _matrix(normal), _matrix(tangential)
    z /= mpmath.norm(z)
    kt -= z * mpmath.fdot(z, kt)
    forward, backward = _waves(z, kt, source)
    ahead, _ = _waves(z, kt, target)
    x = kt / mpmath.norm(kt)
    y = _cross(z, x)
    out = [*backward, *ahead]
    system = mpmath.matrix(4, 4)
    for column, wave in enumerate(out):
        sign = -1 if column < 2 else 1
        for row, value in enumerate(_tangential(wave, x, y)):
            system[row, column] = sign * value
    powers = np.full((4, 2), np.nan)
    for j, wave in enumerate(forward):
        if wave.flux == 0:
            continue
        amplitudes = mpmath.lu_solve(system, mpmath.matrix(_tangential(wave, x, y)))
        powers[:, j] = [float(abs(a) ** 2 * abs(o.flux) / wave.flux) for a, o in zip(amplitudes, out, strict=True)]
    return forward, backward, ahead, powers


def _waves(z: mpmath.matrix, kt: mpmath.matrix, medium: tuple[Real, Real]) -> tuple[list[ExactWave], list[ExactWave]]:
    eps, kap = _matrix(medium[0]), _matrix(medium[1])
    sides: tuple[list[ExactWave], list[ExactWave]] = [], []
    if mpmath.norm(kap) == 0 and mpmath.norm(eps - eps[0, 0] * mpmath.eye(3)) == 0:  # double roots: s and p
        x = kt / mpmath.norm(kt)
        root = mpmath.sqrt(eps[0, 0] - mpmath.norm(kt) ** 2)
        for side, q in zip(sides, (root, -root), strict=True):
            k = kt + q * z
            for e in (_cross(z, x), (q * x - mpmath.norm(kt) * z) / mpmath.sqrt(eps[0, 0])):
                unit = e / mpmath.norm(e)
                side.append(_wave(q, unit, _curl(list(k)) * unit, z))
        return sides
    for root in _roots(lambda q: mpmath.det(wave_matrix(list(kt + q * z), eps, kap))):
        free = abs(mpmath.im(root)) < REAL
        q = mpmath.re(root) if free else root
        k = list(kt + q * z)
        e = _null_vector(wave_matrix(k, eps, kap))
        h = (_curl(k) + 1j * kap) * e
        wave = _wave(q, e, h, z)
        ahead = wave.flux > 0 if free else mpmath.im(q) > 0
        sides[0 if ahead else 1].append(wave)
    assert len(sides[0]) == len(sides[1]) == 2
    return sides


def _wave(q: mpmath.mpc, e: mpmath.matrix, h: mpmath.matrix, z: mpmath.matrix) -> ExactWave:
    free = mpmath.im(q) == 0
    return ExactWave(q, e, h, mpmath.re(mpmath.fdot(z, _cross(e, h.apply(mpmath.conj)))) if free else mpmath.mpf(0))


def _roots(quartic: Callable[[mpmath.mpf], mpmath.mpc]) -> list[mpmath.mpc]:
    """Return the roots of a polynomial of degree 4, from five of its values, as eigenvalues of its companion matrix."""
    places = [mpmath.mpf(i) for i in range(-2, 3)]
    powers = mpmath.matrix([[place**p for p in range(5)] for place in places])
    coefficients = mpmath.lu_solve(powers, mpmath.matrix([quartic(place) for place in places]))
    companion = mpmath.zeros(4)
    for i in range(4):
        companion[i, 3] = -coefficients[i] / coefficients[4]
        if i:
            companion[i, i - 1] = 1
    return [_polished(coefficients, root) for root in mpmath.eig(companion, left=False, right=False)]


def _polished(coefficients: mpmath.matrix, root: mpmath.mpc) -> mpmath.mpc:
    """Return a simple root to all digits, by Newton's steps."""
    for _ in range(4):
        value = mpmath.fsum(c * root**p for p, c in enumerate(coefficients))
        slope = mpmath.fsum(p * c * root ** (p - 1) for p, c in enumerate(coefficients) if p)
        root -= value / slope
    return root


def _null_vector(matrix: mpmath.matrix) -> mpmath.matrix:
    """Return the unit vector across all rows: the longest product of two of them."""
    rows = [matrix[i, :].T for i in range(3)]
    best = max((_cross(rows[i], rows[(i + 1) % 3]) for i in range(3)), key=mpmath.norm)
    return best / mpmath.norm(best)


def _tangential(wave: ExactWave, x: mpmath.matrix, y: mpmath.matrix) -> list[mpmath.mpc]:
    return [mpmath.fdot(axis, field) for field in (wave.e, wave.h) for axis in (x, y)]


def _cross(a: mpmath.matrix, b: mpmath.matrix) -> mpmath.matrix:
    return mpmath.matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _curl(k: Sequence[mpmath.mpf]) -> mpmath.matrix:
    return mpmath.matrix([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])


def _matrix(values: Real) -> mpmath.matrix:
    return mpmath.matrix(values.tolist())
