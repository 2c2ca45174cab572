"""Gaussian curvature of the index surface: it stands in for 1/n² where tangential k becomes solid angle.

Faces conserve tangential wave vectors. Rays along the normals of a surface element dA of the index surface fill the
solid angle dΩ = |K| dA, and the element covers d²k_t = |ray·z| dA of a face with the normal z, hence

    d²k_t = |ray·z| dΩ / |K|.

In an isotropic medium K = 1/n², and that is the n² of radiance. For a surface F(k) = 0 with the gradient g and the
Hessian H,

    K = gᵀ adj(H) g / |g|⁴

(R. Goldman, Curvature formulas for implicit curves and surfaces, Comput. Aided Geom. Des. 22, 632 (2005)).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from crystal_core.errors import InputError
from crystal_core.optics.arrays import BoolArray, Real, dot
from crystal_core.optics.frames import transverse_frame
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.optics.medium import Medium

__all__ = ["gaussian_curvature"]

ON_AXIS = 1e-15
"""Sine of the angle to an optic axis below which k counts as lying along it."""


def gaussian_curvature(medium: Medium, k: Real, mode: ArrayLike) -> Real:
    """Return the Gaussian curvature K of a sheet of the index surface, in units of 1/k², shape (N,).

    - isotropic media and ordinary waves: the sphere, K = 1/n²;
    - extraordinary waves: the spheroid k·ε·k = ε_o ε_e, K = ε_o³ ε_e²/|ε k|⁴;
    - three indices: F = P ± W of the angles to the optic axes (Born & Wolf, Principles of Optics, 7th ed., §15.3.3),

          P = ½(α⁻² + γ⁻²) k² + ½(α⁻² − γ⁻²)(k·o₁)(k·o₂) − 1,      W = ½(α⁻² − γ⁻²)|k × o₁||k × o₂|,

      + for the fast and − for the slow sheet, with its gradient and Hessian. At an angle θ to an optic axis of a
      biaxial medium K grows as 1/θ: negative on the slow sheet, about the dimple, positive on the fast one. On the
      axis itself −∞ and +∞ are returned.

    Parameters
    ----------
    medium : Medium
        Its indices and axes of shape () and (3,), or one per wave.
    k : Real
        Real wave vectors on the index surface, in units of 2π/λ, shape (3, N).
    mode : array_like of str
        Which sheet: "slow" or "fast" of a medium with three indices, "ordinary" or "extraordinary" of a uniaxial one
        (`Wave.mode`, `PlaneWave.mode`), shape () or (N,); of an isotropic medium "s" or "p".

    Raises
    ------
    InputError
        A mode that the medium does not have.
    """
    count = k.shape[1:]
    names = np.broadcast_to(np.asarray(mode, np.str_), count)
    if medium.axes is not None:
        return _biaxial(medium, k, _is_second(names, "slow", "fast"))
    if medium.axis is not None:
        e_o, e_e = (np.broadcast_to(n * n, count) for n in medium.indices)
        axis = _wide(medium.axis)
        outward = e_o * k + (e_e - e_o) * dot(k, axis) * axis
        spheroid = e_o * (e_o * e_e / dot(outward, outward)) ** 2
        return np.asarray(np.where(_is_second(names, "ordinary", "extraordinary"), spheroid, 1.0 / e_o))
    _is_second(names, "s", "p")
    return np.broadcast_to(1.0 / medium.indices[0] ** 2, count).copy()


def _is_second(names: np.ndarray, first: str, second: str) -> BoolArray:
    is_second = names == second
    if not np.all(is_second | (names == first)):
        raise InputError.at("/mode", f'the modes of this medium are "{first}" and "{second}"')
    return np.asarray(is_second)


def _biaxial(medium: Medium, k: Real, fast: BoolArray) -> Real:
    indicatrix = BiaxialIndicatrix.of(medium)
    alpha, gamma = indicatrix.alpha, indicatrix.gamma
    half = 0.5 * (gamma - alpha) * (gamma + alpha) / (alpha * gamma) ** 2
    mean = 0.5 * (alpha * alpha + gamma * gamma) / (alpha * gamma) ** 2
    o_1, o_2 = (np.broadcast_to(_wide(axis), k.shape) for axis in indicatrix.optic_axes())
    p_1, length_1 = _from_axis(k, o_1)
    p_2, length_2 = _from_axis(k, o_2)
    t_1, t_2 = np.cross(o_1, p_1, axis=0), np.cross(o_2, p_2, axis=0)

    # |k × o| = l has the gradient p, the unit vector from the axis to k, and the Hessian t tᵀ/l with t = o × p. So of
    # W only the ratio of both lengths is ever wanted, and that is 1 where the axes coincide.
    together = np.abs(indicatrix.alpha - indicatrix.beta) * np.abs(indicatrix.gamma - indicatrix.beta) == 0.0
    at_1, at_2 = length_1 == 0.0, length_2 == 0.0
    on_axis = (at_1 | at_2) & ~together
    ratio = np.where(at_1 | at_2, 1.0, length_2) / np.where(at_1 | at_2, 1.0, length_1)
    sign = np.where(fast, 1.0, -1.0)
    gradient = 2.0 * mean * k + half * (dot(k, o_1) * o_2 + dot(k, o_2) * o_1)
    gradient = gradient + sign * half * (length_2 * p_1 + length_1 * p_2)

    def entry(i: int, j: int) -> Real:
        bend = ratio * t_1[i] * t_1[j] + t_2[i] * t_2[j] / ratio + p_1[i] * p_2[j] + p_1[j] * p_2[i]
        flat = o_1[i] * o_2[j] + o_1[j] * o_2[i]
        return np.asarray((2.0 * mean if i == j else 0.0) + half * (flat + sign * bend))

    hessian = np.array([[entry(i, j) for j in range(3)] for i in range(3)])
    cofactors = [np.cross(hessian[(i + 1) % 3], hessian[(i + 2) % 3], axis=0) for i in range(3)]
    bent = sum((gradient[i] * dot(cofactors[i], gradient) for i in range(3)), np.zeros(k.shape[1]))
    curvature = bent / dot(gradient, gradient) ** 2
    return np.asarray(np.where(on_axis, sign * np.inf, curvature))


def _from_axis(k: Real, axis: Real) -> tuple[Real, Real]:
    """Return the unit vector from an axis to k, any across the axis where k lies on it, and |k × axis|, there 0."""
    across = k - dot(k, axis) * axis
    across = across - dot(across, axis) * axis  # near the axis the first difference is mostly rounding
    length = np.sqrt(dot(across, across))
    on_axis = length <= ON_AXIS * np.sqrt(dot(k, k))
    rest = np.where(on_axis, transverse_frame(axis)[0], across)
    return rest / np.sqrt(dot(rest, rest)), np.where(on_axis, 0.0, length)


def _wide(direction: Real) -> Real:
    return direction[:, None] if direction.ndim == 1 else direction
