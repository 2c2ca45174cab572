"""Reflection by a half space, computed by pyElli: a batch of cases in one call.

Only its reflection is used: what it calls transmission into an anisotropic half space are not shares per mode.

pyElli finds which waves go forward by the imaginary part of q first, then by the real part. Without absorption the
imaginary parts are rounding. So the back half space here has a trace of absorption, eps'' = 1e-12: then forward waves
are those that decay, which is the direction of the energy, and the answer moves by about as little.
"""

from __future__ import annotations

import elli  # type: ignore[import-untyped]
import numpy as np

from tests.reference.arithmetic import Array

__all__ = ["TRACE", "reflection", "separation"]

TRACE = 1e-12
"""Imaginary part of the back half space's permittivity."""


class _Tabulated(elli.materials.Material):  # type: ignore[misc]
    """One permittivity tensor per case, (N, 3, 3), in the place of one per wavelength."""

    def __init__(self, tensors: Array) -> None:
        self._tensors = tensors

    def get_tensor(self, lbda: Array) -> Array:
        assert len(lbda) == len(self._tensors)
        return self._tensors


def reflection(n: Array, kappa: Array, eps: Array) -> Array:
    """Return r [out, in, N] of s and p for light from an isotropic medium.

    Parameters
    ----------
    n : (N,) array
        Index in front.
    kappa : (N,) array
        Tangential wave vector, along x.
    eps : (N, 3, 3) array
        Permittivity behind, in the frame whose z points into it and whose y is s; p = (q, 0, -kappa)/n.
    """
    front = _Tabulated(n[:, None, None] ** 2 * np.eye(3) + 0j)
    back = _Tabulated(eps + 1j * TRACE * np.eye(3))
    angle = np.degrees(np.arcsin(kappa / n))
    result = elli.Structure(front, [], back).evaluate(np.full(len(n), 589.3), angle)
    r = result.jones_matrix_r
    assert r.shape == (len(n), 2, 2)
    # pyElli counts p first
    return np.moveaxis(r[:, ::-1, ::-1], 0, 2)


def separation(kappa: Array, eps: Array) -> Array:
    """Return the least distance between two of the four q of the half space, (N,).

    Its double precision knows a wave within rounding over that distance, and at a critical angle, where two waves come
    together, the trace of absorption is felt.
    """
    q = np.linalg.eigvals(elli.Solver4x4.build_delta_matrix(kappa, eps + 0j))
    gaps = [np.abs(q[:, i] - q[:, j]) for i in range(4) for j in range(i)]
    return np.asarray(np.min(gaps, axis=0))
