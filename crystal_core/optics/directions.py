"""The two plane waves of a medium along a given wave normal: index, k, D, E, H and ray of each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.errors import InputError
from crystal_core.optics.active_directions import EllipticalWave, elliptical_waves
from crystal_core.optics.arrays import Field, Real, dot
from crystal_core.optics.berreman import activity, is_active, stacked
from crystal_core.optics.frames import transverse_frame
from crystal_core.optics.indicatrix import BiaxialIndicatrix, permittivity
from crystal_core.optics.medium import UNIT_TOLERANCE, Medium

__all__ = ["PlaneWave", "waves_along"]

ON_AXIS = 1e-15
"""Sine of the angle to an optic axis below which a wave counts as travelling along it: there it is only rounding."""


@dataclass(frozen=True, slots=True)
class PlaneWave:
    """One plane wave of a medium in each of N directions.

    The fields obey k × E = B and k × H = −D; D ⟂ k. Without optical activity B = H, and the ray is across E. With it
    (`berreman.activity`) D = ε E + i κ H and B = H − i κ E, and the fields are complex, of elliptical vibrations.

    Parameters
    ----------
    mode : NDArray[np.str_]
        "s", "p" (isotropic), "ordinary", "extraordinary" (uniaxial), "slow" or "fast" (three indices, or optically
        active), shape (N,).
    index : Real
        Refractive index n = |k|, shape (N,).
    k : Real
        Wave vector n·s in units of 2π/λ, shape (3, N).
    d, e, h : Field
        Fields D, E of unit length and H, shape (3, N); complex in an optically active medium, real in others.
    ray : Real
        Unit vector of the energy flow Re(E × H*), shape (3, N).
    """

    mode: NDArray[np.str_]
    index: Real
    k: Real
    d: Field
    e: Field
    h: Field
    ray: Real

    def walk_off(self) -> Real:
        """Return the angle between wave normal and ray, radians, shape (N,)."""
        # By the sine, well conditioned for every walk-off there is, unlike the arc cosine.
        across = _cross(self.k, self.ray)
        return np.asarray(np.arcsin(np.minimum(np.sqrt(dot(across, across)) / self.index, 1.0)))

    def ray_vector(self) -> Real:
        """Return the point r of the ray surface, r ∥ ray and k·r = 1, shape (3, N): |r| is the ray velocity over c."""
        return np.asarray(self.ray / dot(self.k, self.ray))


def waves_along(medium: Medium, wave_normal: ArrayLike) -> tuple[PlaneWave, PlaneWave]:
    """Return the two waves that propagate along each wave normal.

    In an isotropic medium they are any orthogonal pair, (s, p), with (p, s, wave normal) right-handed; in a uniaxial
    one (ordinary, extraordinary), with D along s × c and across it; in one of three indices (slow, fast). These follow
    from the angles θ₁, θ₂ of the wave normal s to the optic axes (Born & Wolf, Principles of Optics, 7th ed., §15.3.3),

        1/n² = ½(n_α⁻² + n_γ⁻²) + ½(n_α⁻² − n_γ⁻²) cos(θ₁ ± θ₂),

    the sum for the slow wave, and D by Fresnel's construction: it halves the angles between the two planes through s
    and an optic axis each. With unit vectors u_i ∥ s × o_i, o_i in one half-space about γ, D_fast ∥ u₁ + u₂ and
    D_slow ∥ u₁ − u₂. So the directions are good to 10⁻¹⁶/θ at an angle θ to an optic axis, where the roots of
    Fresnel's equation would leave 10⁻¹⁶/θ². Exactly on the optic axis any pair serves, and one is returned.

    In an optically active medium, of any class, they are (slow, fast), elliptical, and circular along an optic axis:
    solved for without expansion in the gyration, see `active_directions`. Their fields are good to
    10⁻¹⁶/(n_slow − n_fast), a difference that does not vanish at an optic axis.

    Absorption is not looked at: the waves are those of the real ε.

    Parameters
    ----------
    medium : Medium
        Its indices and directions are of shape () and (3,), or per direction, (N,) and (3, N).
    wave_normal : array_like
        Unit vectors s, shape (3, N).

    Raises
    ------
    InputError
        Wave normals that are not unit vectors or not of the shape (3, N), or not as many as the medium has indices.
    """
    s = _unit(medium, wave_normal)
    if is_active(medium):
        return _active(medium, s)
    if medium.axes is not None:
        return _biaxial(medium, s)
    if medium.axis is not None:
        return _uniaxial(medium, s)
    return _isotropic(medium, s)


def _isotropic(medium: Medium, s: Real) -> tuple[PlaneWave, PlaneWave]:
    n = np.broadcast_to(medium.indices[0], s.shape[1:])
    p, across = transverse_frame(s)

    def field(d: Real) -> Real:
        return d / (n * n)

    return _wave("s", s, n, across, field), _wave("p", s, n, p, field)


def _uniaxial(medium: Medium, s: Real) -> tuple[PlaneWave, PlaneWave]:
    assert medium.axis is not None
    c = _wide(medium.axis)
    n_o, n_e = (np.broadcast_to(n, s.shape[1:]) for n in medium.indices)
    ordinary, sin = _across(s, c)
    cos = dot(s, c)
    n = n_o * n_e / np.sqrt((n_o * sin) ** 2 + (n_e * cos) ** 2)
    # 1/n_e² − 1/n_o² without cancellation.
    difference = (n_o - n_e) * (n_o + n_e) / (n_o * n_e) ** 2

    def field(d: Real) -> Real:
        return d / (n_o * n_o) + difference * dot(c, d) * c

    return (
        _wave("ordinary", s, n_o, ordinary, field),
        _wave("extraordinary", s, n, _cross(ordinary, s), field),
    )


def _biaxial(medium: Medium, s: Real) -> tuple[PlaneWave, PlaneWave]:
    indicatrix = BiaxialIndicatrix.of(medium)
    alpha, beta, gamma = indicatrix.alpha, indicatrix.beta, indicatrix.gamma
    first, second = (_wide(axis) for axis in indicatrix.optic_axes())
    u_1, sin_1 = _across(s, first)
    u_2, sin_2 = _across(s, second)
    mean = 0.5 * (1.0 / (alpha * alpha) + 1.0 / (gamma * gamma))
    half = 0.5 * (gamma - alpha) * (gamma + alpha) / (alpha * gamma) ** 2
    cosines, sines = dot(s, first) * dot(s, second), sin_1 * sin_2
    n_slow = 1.0 / np.sqrt(mean + half * (cosines - sines))
    n_fast = 1.0 / np.sqrt(mean + half * (cosines + sines))

    # One of sum and difference of two unit vectors may vanish, the longer is at least √2.
    plus, minus = u_1 + u_2, u_1 - u_2
    by_fast = dot(u_1, u_2) >= 0
    longer = np.where(by_fast, plus, minus)
    longer = longer / np.sqrt(dot(longer, longer))
    other = _cross(s, longer)
    principal = [(_wide(indicatrix.axes[i]), n * n) for i, n in enumerate((alpha, beta, gamma))]

    def field(d: Real) -> Real:
        total = np.zeros_like(d)
        for axis, square in principal:
            total += dot(axis, d) / square * axis
        return total

    return (
        _wave("slow", s, n_slow, np.where(by_fast, other, longer), field),
        _wave("fast", s, n_fast, np.where(by_fast, longer, other), field),
    )


def _active(medium: Medium, s: Real) -> tuple[PlaneWave, PlaneWave]:
    kappa = activity(medium)
    assert kappa is not None
    slow, fast = elliptical_waves(stacked(permittivity(medium), s.shape[1]), stacked(kappa, s.shape[1]), s)
    return _elliptical("slow", s, slow), _elliptical("fast", s, fast)


def _elliptical(mode: str, s: Real, wave: EllipticalWave) -> PlaneWave:
    ray = _cross(wave.e, np.conj(wave.h)).real
    ray /= np.sqrt(dot(ray, ray))
    n = wave.index
    return PlaneWave(np.full(n.shape, mode), n, n * s, wave.d, wave.e, wave.h, ray)


def _wave(mode: str, s: Real, n: Real, d: Real, field: Callable[[Real], Real]) -> PlaneWave:
    """Return the wave of index `n` (N,) along `s` whose D is along the unit vectors `d`; `field` gives ε⁻¹D."""
    e = field(d)
    length = np.sqrt(dot(e, e))
    e, d = e / length, d / length
    k = n * s
    # E × (k × E) = k (E·E) − E (E·k)
    ray = s - e * dot(e, s)
    ray /= np.sqrt(dot(ray, ray))
    return PlaneWave(np.full(n.shape, mode), n.copy(), k, d, e, _cross(k, e), ray)


def _across(s: Real, axis: Real) -> tuple[Real, Real]:
    """Return the unit vectors along s × axis, any across `s` where they are parallel, and the sine between the two."""
    u = _cross(s, axis)
    sin = np.sqrt(dot(u, u))
    parallel = np.flatnonzero(sin <= ON_AXIS)
    u /= np.maximum(sin, ON_AXIS)
    if parallel.size:
        u[:, parallel] = transverse_frame(s[:, parallel])[0]
    # Near the axis the product is mostly cancellation; what its rounding holds along s must go, so that D ⟂ k.
    u -= s * dot(s, u)
    u /= np.sqrt(dot(u, u))
    return u, sin


@overload
def _cross(a: Real, b: Real) -> Real: ...


@overload
def _cross(a: Field, b: Field) -> Field: ...


def _cross(a: Field, b: Field) -> Field:
    """Return a × b, both (3, N) or one of them (3, 1)."""
    return np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def _wide(direction: Real) -> Real:
    return direction[:, None] if direction.ndim == 1 else direction


def _unit(medium: Medium, wave_normal: ArrayLike) -> Real:
    """Return the wave normals, checked and of unit length to rounding."""
    s = np.asarray(wave_normal, np.float64)
    if s.ndim != 2 or s.shape[0] != 3:
        raise InputError.at("/wave_normal", "the wave normals must be of shape (3, N)")
    length = np.sqrt(dot(s, s))
    if not np.all(np.abs(length - 1.0) <= UNIT_TOLERANCE):
        raise InputError.at("/wave_normal", "the wave normals must be unit vectors")
    given = ((medium.axis, 1), (medium.axes, 2), (medium.gyration, 2))
    directions = [t for t, one in given if t is not None and t.ndim > one]
    if any(values.shape[-1] != s.shape[1] for values in (*medium.indices, *directions) if values.ndim):
        raise InputError.at("/wave_normal", f"the medium is not one for {s.shape[1]} wave normals")
    return np.asarray(s / length)
