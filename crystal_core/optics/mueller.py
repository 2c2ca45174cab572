"""Mueller matrices of Jones matrices and of maps of coherency matrices."""

from __future__ import annotations

import numpy as np

from crystal_core.optics.arrays import Complex, Real

__all__ = ["mueller_of_coherency_map", "mueller_of_jones"]

STOKES = np.array(((1, 0, 0, 1), (1, 0, 0, -1), (0, 1, 1, 0), (0, 1j, -1j, 0)))
"""(S0, S1, S2, S3) of (C_xx, C_xy, C_yx, C_yy): S0 = C_xx + C_yy, S1 = C_xx − C_yy, S2 = 2 Re C_xy, S3 = −2 Im C_xy."""


def mueller_of_coherency_map(mapping: Complex) -> Real:
    """Return the Mueller matrices, shape (4, 4, N), of maps of (C_xx, C_xy, C_yx, C_yy), shape (N, 4, 4)."""
    return np.asarray(np.einsum("ai,nij,bj->abn", STOKES, mapping, 0.5 * np.conj(STOKES)).real)


def mueller_of_jones(jones: Complex) -> Real:
    """Return the Mueller matrices, shape (4, 4, N), of Jones matrices, shape (2, 2, N).

    Stokes parameters as in ``docs/conventions.md``: S3 > 0 is counter-clockwise to an observer who faces the source.
    """
    kron = np.einsum("ijn,kln->nikjl", jones, np.conj(jones)).reshape(-1, 4, 4)
    return mueller_of_coherency_map(kron)
