"""The little linear algebra that the interface solver needs, in double precision or with mpmath."""

from __future__ import annotations

from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

__all__ = ["Arithmetic", "Array", "Double", "Many", "arithmetic", "exact"]

Array = NDArray[Any]


def exact(values: Any) -> Array:
    """Turn floats into mpmath numbers without rounding."""
    array = np.asarray(values)
    if array.dtype == object:
        return array
    kind = mpmath.mpc if np.iscomplexobj(array) else mpmath.mpf
    flat = np.empty(array.size, dtype=object)
    for i, value in enumerate(array.ravel().tolist()):
        flat[i] = kind(value)
    return flat.reshape(array.shape)


class Double:
    """Linear algebra in double precision."""

    tolerance_real = 1e-12
    tolerance_equal = 1e-9

    @staticmethod
    def array(values: Any) -> Array:
        return np.asarray(values)

    @staticmethod
    def sqrt(value: Any) -> Any:
        return np.sqrt(value)

    @staticmethod
    def eigenvalues(matrix: Array) -> list[Any]:
        return list(np.linalg.eigvals(matrix))

    @staticmethod
    def polish(root: Any, delta: Array) -> Any:
        """One generalised Rayleigh step: Delta is not normal, so the error of a bare eigenvalue is many ulps."""
        u, _, vh = np.linalg.svd(delta - root * np.eye(len(delta)))
        left, right = u[:, -1].conj(), vh[-1].conj()
        overlap = left @ right
        return root if abs(overlap) < 1e-6 else root + left @ (delta @ right - root * right) / overlap

    @staticmethod
    def kernel(matrix: Array, count: int) -> list[Array]:
        return [row.conj() for row in np.linalg.svd(matrix)[2][-count:]]

    @staticmethod
    def solve(matrix: Array, right: Array) -> Array:
        return np.asarray(np.linalg.solve(matrix, right))


class Many:
    """Linear algebra with mpmath at the current working precision."""

    @property
    def tolerance_real(self) -> Any:
        return mpmath.mpf(10) ** (-(3 * mpmath.mp.dps) // 4)

    @property
    def tolerance_equal(self) -> Any:
        return mpmath.mpf(10) ** (-mpmath.mp.dps // 2)

    @staticmethod
    def array(values: Any) -> Array:
        return exact(values)

    @staticmethod
    def sqrt(value: Any) -> Any:
        return mpmath.sqrt(value)

    @staticmethod
    def eigenvalues(matrix: Array) -> list[Any]:
        # the spectrum of an isotropic medium is q, q, -q, -q, on which mpmath's QR iteration stalls unless it is moved
        shift = mpmath.mpc("0.7310585786300049", "0.3678794411714423")
        moved = mpmath.matrix(matrix.tolist()) + shift * mpmath.eye(len(matrix))
        return [value - shift for value in mpmath.mp.eig(moved, left=False, right=False)]

    @staticmethod
    def polish(root: Any, delta: Array) -> Any:  # noqa: ARG004 - digits enough
        return root

    @staticmethod
    def kernel(matrix: Array, count: int) -> list[Array]:
        _, _, v = mpmath.mp.svd_c(mpmath.matrix(matrix.tolist()))
        size = len(matrix)
        return [np.array([mpmath.conj(v[i, j]) for j in range(size)]) for i in range(size - count, size)]

    @staticmethod
    def solve(matrix: Array, right: Array) -> Array:
        solution = mpmath.lu_solve(mpmath.matrix(matrix.tolist()), mpmath.matrix(right.tolist()))
        return np.array([solution[i] for i in range(len(right))])


Arithmetic = Double | Many


def arithmetic(digits: int | None) -> Arithmetic:
    """Return the algebra for so many digits, None for double precision."""
    return Many() if digits else Double()
