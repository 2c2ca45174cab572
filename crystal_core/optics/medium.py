"""A homogeneous, non-magnetic medium as the optics sees it: principal indices at each ray's wavelength, on axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from crystal_core.errors import InputError
from crystal_core.optics.arrays import Rays, Real, columns

__all__ = ["Medium", "take"]

UNIT_TOLERANCE = 1e-9
"""How far |axis| may stand from 1: far above rounding, far below any direction known by measurement."""

SYMMETRY_TOLERANCE = 1e-12
"""How far a gyration tensor may stand from symmetric, in absolute terms; gyrations are about 1e-4."""


@dataclass(frozen=True, slots=True)
class Medium:
    """Principal refractive indices, real, on their axes; absorption and gyration where there are any.

    Use the constructors `isotropic`, `uniaxial` and `biaxial`; they check their input. All directions are in one
    frame, the world or any other, shared with the wave vectors.

    Parameters
    ----------
    indices : tuple of Real
        One array (isotropic), two (n_o, n_e) or three (biaxial, in the order of `axes`), each of shape () or (N,): one
        value per ray.
    axis : Real or None
        Optic axis of a uniaxial medium, unit, shape (3,) or (3, N).
    axes : Real or None
        Principal directions of a biaxial medium, shape (3, 3) or (3, 3, N): axes[i] is the direction of indices[i].
    absorption_per_mm : tuple of Real or None
        Principal absorption coefficients (natural, of intensity, mm⁻¹), each of shape () or (N,): one (isotropic) or
        two (a_o, a_e) on the frame of the indicatrix, or three on `absorption_axes`; None if transparent.
    absorption_axes : Real or None
        Principal directions of three absorption coefficients, shape (3, 3) or (3, 3, N).
    gyration : Real or None
        Gyration tensor g of an optically active medium, symmetric, shape (3, 3) or (3, 3, N): the gyration along a wave
        normal s is G = s·g·s (Landau & Lifshitz, Electrodynamics of Continuous Media, 2nd ed., §104). None if inactive.
    """

    indices: tuple[Real, ...]
    axis: Real | None = None
    axes: Real | None = None
    absorption_per_mm: tuple[Real, ...] | None = None
    absorption_axes: Real | None = None
    gyration: Real | None = None

    @classmethod
    def isotropic(cls, n: ArrayLike, absorption_per_mm: ArrayLike | None = None) -> Medium:
        """Return an isotropic medium of index `n`, shape () or (N,).

        Raises
        ------
        InputError
            An index that is not finite and positive, an absorption that is negative or not finite.
        """
        absorption = None if absorption_per_mm is None else (_absorption(absorption_per_mm, 0),)
        return cls((_index(n, 0),), absorption_per_mm=absorption)

    @classmethod
    def uniaxial(
        cls,
        n_o: ArrayLike,
        n_e: ArrayLike,
        axis: ArrayLike,
        absorption_per_mm: tuple[ArrayLike, ArrayLike] | None = None,
    ) -> Medium:
        """Return a uniaxial medium.

        Parameters
        ----------
        n_o, n_e : array_like
            Ordinary and principal extraordinary index, shape () or (N,).
        axis : array_like
            Unit vector of the optic axis, shape (3,) or (3, N).
        absorption_per_mm : pair of array_like, optional
            (a_o, a_e) for waves that vibrate across and along the axis.

        Raises
        ------
        InputError
            An index that is not finite and positive, an axis that is not a unit vector, a negative absorption.
        """
        unit = np.asarray(axis, np.float64)
        length = np.sqrt(np.sum(unit * unit, axis=0)) if unit.shape[:1] == (3,) else np.array(np.nan)
        if not np.all(np.abs(length - 1.0) <= UNIT_TOLERANCE):
            raise InputError.at("/axis", "the optic axis must be a unit vector of shape (3,) or (3, N)")
        absorption = None
        if absorption_per_mm is not None:
            absorption = (_absorption(absorption_per_mm[0], 0), _absorption(absorption_per_mm[1], 1))
        return cls((_index(n_o, 0), _index(n_e, 1)), axis=unit, absorption_per_mm=absorption)

    @classmethod
    def biaxial(
        cls,
        indices: Sequence[ArrayLike],
        axes: ArrayLike,
        absorption_per_mm: Sequence[ArrayLike] | None = None,
    ) -> Medium:
        """Return a medium of three principal indices, in any order; two or all of them may be equal.

        Parameters
        ----------
        indices : three of array_like
            Principal indices, shape () or (N,) each.
        axes : array_like
            Orthonormal directions of the three, of either handedness, shape (3, 3) or (3, 3, N): axes[i] is that of
            indices[i].
        absorption_per_mm : three of array_like, optional
            Coefficients on the same axes; `absorbing` gives them a frame of their own.

        Raises
        ------
        InputError
            An index that is not finite and positive, axes that are not orthonormal, a negative absorption.
        """
        if len(indices) != 3:
            raise InputError.at("/indices", "a biaxial medium has three principal indices")
        frame = _orthonormal(axes, "/axes")
        medium = cls((_index(indices[0], 0), _index(indices[1], 1), _index(indices[2], 2)), axes=frame)
        return medium if absorption_per_mm is None else medium.absorbing(absorption_per_mm, frame)

    def absorbing(self, absorption_per_mm: Sequence[ArrayLike], absorption_axes: ArrayLike) -> Medium:
        """Return this medium with an absorption surface on a frame of its own.

        Parameters
        ----------
        absorption_per_mm : three of array_like
            Principal coefficients (natural, of intensity, mm⁻¹), shape () or (N,) each.
        absorption_axes : array_like
            Their orthonormal directions, shape (3, 3) or (3, 3, N).

        Raises
        ------
        InputError
            A coefficient that is negative or not finite, axes that are not orthonormal.
        """
        if len(absorption_per_mm) != 3:
            raise InputError.at("/absorption_per_mm", "an absorption surface has three principal coefficients")
        coefficients = tuple(_absorption(a, place) for place, a in enumerate(absorption_per_mm))
        frame = _orthonormal(absorption_axes, "/absorption_axes")
        return replace(self, absorption_per_mm=coefficients, absorption_axes=frame)

    def active(self, gyration: ArrayLike) -> Medium:
        """Return this medium with a gyration tensor, symmetric, shape (3, 3) or (3, 3, N).

        Raises
        ------
        InputError
            A tensor that is not finite or not symmetric.
        """
        g = np.asarray(gyration, np.float64)
        if g.shape[:2] != (3, 3) or g.ndim > 3 or not np.all(np.isfinite(g)):
            raise InputError.at("/gyration", "the gyration tensor must be finite, shape (3, 3) or (3, 3, N)")
        if np.any(np.abs(g - g.swapaxes(0, 1)) > SYMMETRY_TOLERANCE):
            raise InputError.at("/gyration", "the gyration tensor must be symmetric")
        return replace(self, gyration=g)

    @property
    def is_isotropic(self) -> bool:
        """Whether the medium has one index in all directions."""
        return len(self.indices) == 1

    def transparent(self) -> Medium:
        """Return the medium without its absorption: what faces see of it."""
        return replace(self, absorption_per_mm=None, absorption_axes=None)

    def inactive(self) -> Medium:
        """Return the medium without its gyration: linear modes, those of its indices."""
        return replace(self, gyration=None)

    def astype(self, precision: type[np.floating]) -> Medium:
        """Return the medium in single or double precision, np.float32 or np.float64.

        The batch functions (`interface_frame`, `framed`, `solve_face`) keep it. In single precision roots are within
        5e-6 and energy within 2e-6 where all waves propagate and none slants more than 0.1; `scatter` is always double.
        """

        def cast(values: Real | None) -> Real | None:
            return None if values is None else np.asarray(values.astype(precision))

        absorption = self.absorption_per_mm
        return Medium(
            tuple(np.asarray(n.astype(precision)) for n in self.indices),
            cast(self.axis),
            cast(self.axes),
            None if absorption is None else tuple(np.asarray(a.astype(precision)) for a in absorption),
            cast(self.absorption_axes),
            cast(self.gyration),
        )

    def take(self, rays: Rays) -> Medium:
        """Return the medium of a selection of rays (an index array or a slice)."""
        return Medium(
            tuple(take(n, rays) for n in self.indices),
            self.axis if self.axis is None or self.axis.ndim == 1 else columns(self.axis, rays),
            _frames(self.axes, rays),
            None if self.absorption_per_mm is None else tuple(take(a, rays) for a in self.absorption_per_mm),
            _frames(self.absorption_axes, rays),
            _frames(self.gyration, rays),
        )


def take(values: Real, rays: Rays) -> Real:
    """Return the values of a selection of rays; one value for all, shape (), stays one."""
    return values if values.ndim == 0 else values[rays]


def _frames(tensors: Real | None, rays: Rays) -> Real | None:
    if tensors is None or tensors.ndim == 2:
        return tensors
    return tensors[:, :, rays] if isinstance(rays, slice) else tensors.take(rays, axis=2)


def _index(value: ArrayLike, place: int) -> Real:
    n = np.asarray(value, np.float64)
    if n.ndim > 1 or not np.all(np.isfinite(n) & (n > 0)):
        raise InputError.at(f"/indices/{place}", "a refractive index must be finite and positive, shape () or (N,)")
    return n


def _absorption(value: ArrayLike, place: int) -> Real:
    a = np.asarray(value, np.float64)
    if a.ndim > 1 or not np.all(np.isfinite(a) & (a >= 0)):
        raise InputError.at(f"/absorption_per_mm/{place}", "an absorption must be finite and ≥ 0, shape () or (N,)")
    return a


def _orthonormal(value: ArrayLike, pointer: str) -> Real:
    frame = np.asarray(value, np.float64)
    if frame.shape[:2] != (3, 3) or frame.ndim > 3 or not np.all(np.isfinite(frame)):
        raise InputError.at(pointer, "the axes must be three finite vectors, shape (3, 3) or (3, 3, N)")
    gram = np.einsum("ij...,kj...->ik...", frame, frame)
    identity = np.eye(3) if frame.ndim == 2 else np.eye(3)[:, :, None]
    if not np.all(np.abs(gram - identity) <= 2 * UNIT_TOLERANCE):
        raise InputError.at(pointer, "the axes must be orthonormal: unit vectors at right angles")
    return frame
