"""The two elliptical waves of an optically active medium along a given wave normal.

With D = ε E + i κ H and B = H − i κ E (`berreman.activity`) the fields of a plane wave of wave vector n s obey
n s × E = B and n s × H = −D, so that D and B lie across s. Let

    (E, H) = M⁻¹ (D, B),        M = ( ε    iκ )
                                    (−iκ   1 )

and let A be the part of M⁻¹ across s, 4 × 4. Then n enters as the eigenvalue of a Hermitian pencil with positive A,

    Σ (D, B) = n A (D, B),      Σ = ( 0  −J )
                                    ( J   0 ),      J = s × on vectors across s:

two positive eigenvalues, the waves along s, and their like with the opposite sign along −s. Nothing is expanded in κ,
and waves whose indices agree come out orthogonal all the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crystal_core.optics.arrays import Complex, Field, Real
from crystal_core.optics.frames import transverse_frame

__all__ = ["EllipticalWave", "elliptical_waves", "indices_along"]

ACROSS = np.array(((0, 0, 0, 1), (0, 0, -1, 0), (0, -1, 0, 0), (1, 0, 0, 0)), np.float64)
"""Σ on (D_x, D_y, B_x, B_y), x × y = s."""


@dataclass(frozen=True, slots=True)
class EllipticalWave:
    """One wave along each of N directions: index (N,), and fields d, e (of unit length), h, shape (3, N)."""

    index: Real
    d: Complex
    e: Complex
    h: Complex


def elliptical_waves(epsilon: Real, kappa: Real, wave_normal: Real) -> tuple[EllipticalWave, EllipticalWave]:
    """Return the slow and the fast wave along each wave normal.

    The indices are good to rounding, each wave's fields to rounding over n_slow − n_fast. Where the two agree (a
    direction without birefringence and gyration) any pair serves, and one is returned. The phase is such that the
    largest component of E is real and positive.

    Parameters
    ----------
    epsilon, kappa : Real
        Symmetric tensors, shape (N, 3, 3).
    wave_normal : Real
        Unit vectors s, shape (3, N).

    Raises
    ------
    numpy.linalg.LinAlgError
        ε is not positive, or κ so large (near √ε) that the medium's energy is not.
    """
    pencil, basis, inverse = _pencil(epsilon, kappa, wave_normal)
    whitening, hermitian = _whitened(pencil)
    index, vectors = np.linalg.eigh(hermitian)
    fields = _product(basis, whitening, vectors)
    electric = _product(inverse, fields)
    return _wave(index, fields, electric, 3), _wave(index, fields, electric, 2)


def indices_along(epsilon: Real, kappa: Real, wave_normal: Real) -> tuple[Real, Real]:
    """Return the two indices along each wave normal, the larger first, shape (N,) each; see `elliptical_waves`."""
    hermitian = _whitened(_pencil(epsilon, kappa, wave_normal)[0])[1]
    index = np.asarray(np.linalg.eigvalsh(hermitian), np.float64)
    return index[:, 3], index[:, 2]


def _pencil(epsilon: Real, kappa: Real, wave_normal: Real) -> tuple[Complex, Real, Complex]:
    """Return A (N, 4, 4), the basis (N, 6, 4) of (D, B) across s, and M⁻¹ (N, 6, 6)."""
    count = wave_normal.shape[1]
    material = np.zeros((count, 6, 6), np.complex128)
    material[:, :3, :3], material[:, 3:, 3:] = epsilon, np.eye(3)
    material[:, :3, 3:], material[:, 3:, :3] = 1j * kappa, -1j * kappa
    inverse: Complex = np.asarray(np.linalg.inv(material), np.complex128)
    inverse = 0.5 * (inverse + _adjoint(inverse))
    basis = np.zeros((count, 6, 4))
    for place, direction in enumerate(transverse_frame(wave_normal)):
        basis[:, :3, place] = direction.T
        basis[:, 3:, 2 + place] = direction.T
    return _product(basis.swapaxes(1, 2), inverse, basis), basis, inverse


def _whitened(pencil: Complex) -> tuple[Complex, Field]:
    """Return L⁻† and L⁻¹ Σ L⁻†, both (N, 4, 4), for A = L L†."""
    lower: Complex = np.asarray(np.linalg.inv(np.linalg.cholesky(pencil)), np.complex128)
    return _adjoint(lower), _product(lower, ACROSS, _adjoint(lower))


def _wave(index: Real, fields: Complex, electric: Complex, which: int) -> EllipticalWave:
    d, e, h = fields[:, :3, which].T, electric[:, :3, which].T, electric[:, 3:, which].T
    size = np.abs(e)
    largest = np.take_along_axis(e, np.argmax(size, axis=0)[None, :], axis=0)[0]
    scale = np.conj(largest) / (np.abs(largest) * np.sqrt(np.sum(size * size, axis=0)))
    return EllipticalWave(index[:, which].copy(), d * scale, e * scale, h * scale)


def _adjoint(matrices: Complex) -> Complex:
    return np.conj(matrices).swapaxes(1, 2)


def _product(first: Field, *others: Field) -> Complex:
    """Return the product of a stack (N, i, j) with stacks or single matrices, as a plain sum."""
    result: Field = first
    for other in others:
        result = np.einsum("nij,njk->nik" if other.ndim == 3 else "nij,jk->nik", result, other)
    return np.asarray(result, np.complex128)
