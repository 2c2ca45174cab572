"""Absorption of a mode along its ray, to first order in ε''."""

from __future__ import annotations

import numpy as np

from crystal_core.optics.arrays import Field, Real, dot
from crystal_core.optics.indicatrix import dissipation
from crystal_core.optics.medium import Medium

__all__ = ["absorption_along_ray"]


def absorption_along_ray(medium: Medium, k: Real, field: Field) -> Real:
    """Return a(E) = k₀ E†ε″E / |Re(E × H*)| of a wave, in mm⁻¹ along its ray, shape (N,).

    k₀ε″ = Σ n(u_i) a_i u_i u_iᵀ (`indicatrix.dissipation`), so a wave that vibrates along u_i is absorbed by a_i where
    the frames of the indicatrix and of the absorption surface agree. First order in ε″: off by the square of ε″ over
    the split of the two sheets, which counts within about 1° of an optic axis of a pleochroic biaxial crystal (Born &
    Wolf, Principles of Optics, 7th ed., §15.6).

    Parameters
    ----------
    medium : Medium
        The medium; 0 is returned for a transparent one.
    k : Real
        Wave vector inside the medium, in units of 2π/λ, shape (3, N).
    field : Field
        Electric field of the wave, of any length, shape (3, N).
    """
    if medium.absorption_per_mm is None:
        return np.zeros(k.shape[1:])
    if medium.is_isotropic and medium.absorption_axes is None:
        return np.broadcast_to(medium.absorption_per_mm[0], k.shape[1:]).copy()
    tensor = dissipation(medium)
    ex, ey, ez = field
    conjugate = np.conj(field)
    lost = sum(
        (tensor[i, j] * (conjugate[i] * field[j]).real for i in range(3) for j in range(3)), np.zeros(k.shape[1:])
    )
    magnetic = np.conj((k[1] * ez - k[2] * ey, k[2] * ex - k[0] * ez, k[0] * ey - k[1] * ex))
    flow = np.stack(
        (
            (ey * magnetic[2] - ez * magnetic[1]).real,
            (ez * magnetic[0] - ex * magnetic[2]).real,
            (ex * magnetic[1] - ey * magnetic[0]).real,
        )
    )
    return np.asarray(lost / np.sqrt(dot(flow, flow)))
