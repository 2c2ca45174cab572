"""The indicatrix of a medium: its tensors, its optical class, optic axes, 2V and optic sign."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from crystal_core.errors import InputError
from crystal_core.optics.arrays import BoolArray, Real
from crystal_core.optics.medium import Medium

__all__ = [
    "BiaxialIndicatrix",
    "OpticalClass",
    "dissipation",
    "optic_axes",
    "optical_class",
    "permittivity",
    "principal_frame",
]

OpticalClass = Literal["isotropic", "uniaxial", "biaxial"]


@dataclass(frozen=True, slots=True)
class BiaxialIndicatrix:
    """Three principal indices in ascending order, with what follows from them.

    Parameters
    ----------
    alpha, beta, gamma : Real
        The indices n_α ≤ n_β ≤ n_γ, shape () or (N,).
    axes : Real
        Directions of α, β, γ, shape (3, 3) or (3, 3, N).
    sin_v, cos_v : Real
        Sine and cosine of `v_z`.
    """

    alpha: Real
    beta: Real
    gamma: Real
    axes: Real
    sin_v: Real
    cos_v: Real

    @classmethod
    def of(cls, medium: Medium) -> BiaxialIndicatrix:
        """Return that of a medium with three indices.

        Raises
        ------
        InputError
            The medium has fewer.
        """
        if medium.axes is None:
            raise InputError.at("", "only a medium with three principal indices has a biaxial indicatrix")
        first, second, third = np.broadcast_arrays(*medium.indices)
        axes = medium.axes
        if not ((first <= second) & (second <= third)).all():
            n = np.stack((first, second, third))
            order = np.argsort(n, axis=0, kind="stable")
            if n.ndim == 1:
                axes = axes[order]
            elif (order == order[:, :1]).all():  # the same names for all rays: the usual case
                axes = axes[order[:, 0]]
            else:
                wide = np.broadcast_to(axes[:, :, None] if axes.ndim == 2 else axes, (3, 3, n.shape[1]))
                axes = np.take_along_axis(wide, order[:, None, :], axis=0)
            first, second, third = np.take_along_axis(n, order, axis=0)
        return cls(first, second, third, axes, *_sin_and_cos_v(first, second, third))

    @property
    def v_z(self) -> Real:
        """Angle between γ and each optic axis, radians, in [0, π/2], shape () or (N,).

        0 where n_α = n_β, π/2 where n_β = n_γ. Where all three are equal every direction is an optic axis, and γ is
        given.
        """
        return np.asarray(np.arctan2(self.sin_v, self.cos_v))

    def optic_axes(self) -> tuple[Real, Real]:
        """Return two unit vectors, (3,) or (3, N), at ±V_z from γ towards α: the same half-space, whatever the sign."""
        along, across = self.cos_v * self._column(2), self.sin_v * self._column(0)
        return along + across, along - across

    def two_v(self) -> Real:
        """Return the acute angle 2V between the optic axes, radians."""
        return np.asarray(2.0 * np.minimum(self.v_z, 0.5 * np.pi - self.v_z))

    def is_positive(self) -> BoolArray:
        """Return whether γ is the acute bisectrix (2V_z < 90°), shape () or (N,)."""
        return np.asarray(self.v_z < 0.25 * np.pi)

    def _column(self, which: int) -> Real:
        direction = self.axes[which]
        return np.asarray(direction[:, None] if direction.ndim == 1 and self.sin_v.ndim == 1 else direction)


def _sin_and_cos_v(alpha: Real, beta: Real, gamma: Real) -> tuple[Real, Real]:
    """Return those of V_z, tan² V_z = (n_α⁻² − n_β⁻²)/(n_β⁻² − n_γ⁻²) (Born & Wolf, §15.3.3, eq. 11).

    Differences of the indices themselves: those of their squares would lose the digits of a small birefringence.
    """
    lower = (beta - alpha) * (beta + alpha) * (gamma * gamma)
    upper = (gamma - beta) * (gamma + beta) * (alpha * alpha)
    both = lower + upper
    equal = both == 0.0
    inverse = 1.0 / np.where(equal, 1.0, both)
    return np.sqrt(lower * inverse), np.sqrt(np.where(equal, 1.0, upper * inverse))


def optical_class(medium: Medium) -> OpticalClass:
    """Return the class by the values of the indices, the same for every ray: two equal ones make a medium uniaxial.

    Raises
    ------
    InputError
        Rays of one batch would belong to different classes.
    """
    n = np.sort(np.stack(np.broadcast_arrays(*medium.indices)), axis=0)
    gaps = np.count_nonzero(np.diff(n, axis=0), axis=0)
    if np.any(gaps != gaps.flat[0]):
        raise InputError.at("/indices", "the batch mixes optical classes")
    names: tuple[OpticalClass, ...] = ("isotropic", "uniaxial", "biaxial")
    return names[int(gaps.flat[0])]


def optic_axes(medium: Medium) -> tuple[Real, ...]:
    """Return the optic axes as unit vectors, (3,) or (3, N): none, one or two of them, by `optical_class`."""
    kind = optical_class(medium)
    if kind == "isotropic":
        return ()
    if medium.axis is not None:
        return (medium.axis,)
    pair = BiaxialIndicatrix.of(medium).optic_axes()
    return pair if kind == "biaxial" else pair[:1]


def principal_frame(medium: Medium) -> tuple[Real, Real]:
    """Return three principal indices, (3,) or (3, N), and their directions, (3, 3) or (3, 3, N), of any medium.

    Directions that a medium does not single out (across a uniaxial axis, all of an isotropic medium) are arbitrary.
    """
    if medium.axes is not None:
        return np.stack(np.broadcast_arrays(*medium.indices)), medium.axes
    if medium.axis is None:
        n = medium.indices[0]
        return np.stack((n, n, n)), np.eye(3)
    n_o, n_e = np.broadcast_arrays(*medium.indices)
    axis = medium.axis
    # Across the axis: the coordinate direction that stands furthest from it, made perpendicular.
    least = np.argmin(np.abs(axis), axis=0)
    helper = np.eye(3)[least].T if axis.ndim == 2 else np.eye(3)[least]
    first = np.cross(axis, helper, axis=0)
    first = first / np.sqrt(np.sum(first * first, axis=0))
    return np.stack((n_o, n_o, n_e)), np.stack((first, np.cross(axis, first, axis=0), axis))


def permittivity(medium: Medium) -> Real:
    """Return ε′ = Σ n_i² e_i e_iᵀ on the medium's directions e_i, shape (3, 3) or (3, 3, N)."""
    n, axes = principal_frame(medium)
    return _tensor(n * n, axes)


def dissipation(medium: Medium) -> Real:
    """Return k₀ ε″ = Σ n(u_i) a_i u_i u_iᵀ in mm⁻¹, shape (3, 3) or (3, 3, N).

    n(u) = (uᵀ ε′⁻¹ u)^(−1/2), so that a wave that vibrates along u_i is absorbed by a_i where the frames of ε′ and ε″
    agree. Zero if the medium is transparent.
    """
    n, axes = principal_frame(medium)
    absorption = medium.absorption_per_mm
    if absorption is None:
        return _tensor(np.zeros_like(n), axes)
    if medium.absorption_axes is None:
        three = {1: (0, 0, 0), 2: (0, 0, 1), 3: (0, 1, 2)}[len(absorption)]
        a = np.stack(np.broadcast_arrays(*(absorption[i] for i in three)))
        n, a = (v[:, None] if v.ndim == 1 and n.ndim + a.ndim == 3 else v for v in (n, a))
        return _tensor(n * a, axes)
    own = medium.absorption_axes
    inverse = _tensor(1.0 / (n * n), axes)
    along = np.einsum("ki...,ij...,kj...->k...", *_aligned(own, inverse, own))
    a = np.stack(np.broadcast_arrays(*absorption))
    along, a = (v[:, None] if v.ndim == 1 and along.ndim + a.ndim == 3 else v for v in (along, a))
    return _tensor(a / np.sqrt(along), own)


def _tensor(values: Real, axes: Real) -> Real:
    """Return Σ values_i axes_i axes_iᵀ."""
    if values.ndim == 1 and axes.ndim == 2:
        return np.asarray(np.einsum("k,ki,kj->ij", values, axes, axes))
    values = values[:, None] if values.ndim == 1 else values
    axes = axes[:, :, None] if axes.ndim == 2 else axes
    weighted = values[:, None, :] * axes
    return np.asarray(np.sum(weighted[:, :, None, :] * axes[:, None, :, :], axis=0))


def _aligned(*tensors: Real) -> tuple[Real, ...]:
    """Give tensors of one medium, (3, 3) and (3, 3, N) mixed, one number of dimensions."""
    if all(t.ndim == 2 for t in tensors):
        return tensors
    return tuple(t[:, :, None] if t.ndim == 2 else t for t in tensors)
