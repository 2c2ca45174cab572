"""Two-ports: what a part of a stack reflects and transmits from either side, and how two parts become one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics.arrays import Complex, Field, Real

__all__ = ["TwoPort", "coherency_map", "mueller_of_map", "product"]

TRAPPED = 1e-14
"""Share of a beam that is lost at each round trip between two parts. Light that no mode can bring in or out, as in a
light guide, would have no finite sum; it is multiplied by zero afterwards, and nothing else feels a loss so small."""

AnyComplex = NDArray[np.float64] | NDArray[np.complexfloating[Any, Any]]

STOKES = np.array(((1, 0, 0, 1), (1, 0, 0, -1), (0, 1, 1, 0), (0, 1j, -1j, 0)))
"""(S0, S1, S2, S3) of (C_xx, C_xy, C_yx, C_yy)."""


def product(first: AnyComplex, *others: AnyComplex) -> Complex:
    """Return the matrix product of stacks (N, i, j), (N, j, k), …; a plain sum, whose bits do not depend on N."""
    result = first
    for other in others:
        result = np.einsum("nij,njk->nik", result, other)
    return np.asarray(result, np.complex128)


@dataclass(frozen=True, slots=True)
class TwoPort:
    """Scattering matrix of a part of a stack, in blocks: of amplitudes (m = 2) or of coherency matrices (m = 4).

    Forward is along +z. Products of growing exponentials never occur, so that no thickness overflows.

    Parameters
    ----------
    t, r : Complex
        Transmission and reflection of light that comes in at the front, shape (N, m, m).
    t_back, r_back : Complex
        The same for light that comes in at the back.
    """

    t: Complex
    r: Complex
    t_back: Complex
    r_back: Complex

    def through(self, forward: Complex, backward: Complex) -> TwoPort:
        """Return this part with a way behind it, on which nothing is reflected: (N, m, m) forward and backward."""
        return TwoPort(
            product(forward, self.t),
            self.r,
            product(self.t_back, backward),
            product(forward, self.r_back, backward),
        )

    def then(self, other: TwoPort) -> TwoPort:
        """Return this part followed by another: Redheffer's star product (J. Math. Phys. 41, 1, 1962)."""
        one, kept = np.eye(self.t.shape[-1]), 1.0 - TRAPPED
        ahead = np.linalg.solve(one - kept * product(self.r_back, other.r), self.t)
        back = np.linalg.solve(one - kept * product(other.r, self.r_back), other.t_back)
        return TwoPort(
            product(other.t, ahead),
            self.r + product(self.t_back, other.r, ahead),
            product(self.t_back, back),
            other.r_back + product(other.t, self.r_back, back),
        )

    @classmethod
    def face(cls, before: tuple[Field, Field], after: tuple[Field, Field]) -> TwoPort:
        """Return the face between two media from their waves.

        Parameters
        ----------
        before, after : pair of Field
            Tangential fields ψ of the forward and of the backward waves as columns, shape (N, 4, 2): ψ is continuous.
        """
        unknown = np.concatenate((after[0], -before[1]), axis=2)
        given = np.concatenate((before[0], -after[1]), axis=2)
        out = np.linalg.solve(unknown, given)
        blocks = out.astype(np.complex128)
        return cls(blocks[:, :2, :2], blocks[:, 2:, :2], blocks[:, 2:, 2:], blocks[:, :2, 2:])

    def intensities(self) -> TwoPort:
        """Return the maps J ⊗ J* of coherency matrices, shape (N, 4, 4), to these amplitudes' (N, 2, 2)."""
        return TwoPort(*(coherency_map(j) for j in (self.t, self.r, self.t_back, self.r_back)))


def coherency_map(jones: Complex) -> Complex:
    """Return J ⊗ J*, which maps (C_xx, C_xy, C_yx, C_yy) as C → J C J†, shape (N, 2, 2) → (N, 4, 4)."""
    kron = jones[:, :, None, :, None] * np.conj(jones)[:, None, :, None, :]
    return np.asarray(kron.reshape(-1, 4, 4))


def mueller_of_map(mapping: Complex) -> Real:
    """Return the Mueller matrices, shape (4, 4, N), of maps of (C_xx, C_xy, C_yx, C_yy), shape (N, 4, 4)."""
    return np.asarray(np.einsum("ai,nij,bj->abn", STOKES, mapping, 0.5 * np.conj(STOKES)).real)
