"""Absorption of a mode along its ray, to first order in ε''."""

from __future__ import annotations

import numpy as np

from crystal_core.optics.arrays import Real, dot
from crystal_core.optics.medium import Medium

__all__ = ["absorption_along_ray"]


def absorption_along_ray(medium: Medium, k: Real, extraordinary: bool) -> Real:
    """Return a(E) = k0 E†ε''E / |Re(E × H*)| of a mode, in mm⁻¹ along its ray, shape (N,).

    ε'' = Σ (n_i a_i / k0) u_i u_iᵀ on the frame of the indicatrix, so a wave that vibrates along u_i is absorbed by
    a_i. First order in ε''; it fails within about 1° of an optic axis only where ε'' couples the two modes, which a
    uniaxial ε'' on the same axis does not (Born & Wolf, Principles of Optics, 7th ed., §15.6).

    Parameters
    ----------
    medium : Medium
        With `absorption_per_mm`.
    k : Real
        Wave vector of the mode inside the medium, in units of 2π/λ, shape (3, N).
    extraordinary : bool
        Which mode; ignored in an isotropic medium.

    Raises
    ------
    ValueError
        The medium is transparent.
    """
    if medium.absorption_per_mm is None:
        raise ValueError("the medium has no absorption")
    if not extraordinary or medium.is_isotropic:
        # E ⟂ c: k0 (n a/k0)|E|² over the flux n|E|².
        return np.broadcast_to(medium.absorption_per_mm[0], k.shape[1:]).copy()
    assert medium.axis is not None
    axis = medium.axis[:, None] if medium.axis.ndim == 1 else medium.axis
    n_o, n_e = medium.indices
    a_o, a_e = medium.absorption_per_mm
    # H = m = k × c, D = −k × m; split E = ε⁻¹D along c and across it. |E × H| = |E||m| (E ⟂ m).
    kc = dot(k, axis)
    m2 = np.maximum(dot(k, k) - kc * kc, 0.0)
    along2 = (m2 / n_e**2) ** 2
    across2 = m2 * kc * kc / n_o**4
    on_axis = m2 <= 1e-28 * n_o**2
    flux = np.sqrt((along2 + across2) * m2)
    dissipated = n_e * a_e * along2 + n_o * a_o * across2
    return np.where(on_axis, a_o, dissipated / np.where(on_axis, 1.0, flux))
