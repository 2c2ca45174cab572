"""A homogeneous, non-magnetic medium as the optics sees it: indices at each ray's wavelength, and an optic axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from crystal_core.errors import InputError, NotSupportedError
from crystal_core.optics.arrays import Rays, Real, columns

__all__ = ["Medium", "take"]

UNIT_TOLERANCE = 1e-9
"""How far |axis| may stand from 1: far above rounding, far below any direction known by measurement."""


@dataclass(frozen=True, slots=True)
class Medium:
    """Principal refractive indices, real, and the optic axis.

    Use the constructors `isotropic` and `uniaxial`; they check their input.

    Parameters
    ----------
    indices : tuple of Real
        One array (isotropic) or two (n_o, n_e), each of shape () or (N,): one value per ray.
    axis : Real or None
        Optic axis, unit, shape (3,) or (3, N), world or any frame shared with the wave vectors; None if isotropic.
    absorption_per_mm : tuple of Real or None
        Principal absorption coefficients (natural, of intensity, mm⁻¹), in the order of `indices`, on the frame of
        the indicatrix; None if transparent.
    """

    indices: tuple[Real, ...]
    axis: Real | None = None
    absorption_per_mm: tuple[Real, ...] | None = None

    @classmethod
    def isotropic(cls, n: ArrayLike, absorption_per_mm: ArrayLike | None = None) -> Medium:
        """Return an isotropic medium of index `n`, shape () or (N,).

        Raises
        ------
        InputError
            An index that is not finite and positive, an absorption that is negative or not finite.
        """
        absorption = None if absorption_per_mm is None else (_absorption(absorption_per_mm, 0),)
        return cls((_index(n, 0),), None, absorption)

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
        return cls((_index(n_o, 0), _index(n_e, 1)), unit, absorption)

    @classmethod
    def biaxial(cls, *_: ArrayLike) -> Medium:
        """Refuse: waves of biaxial crystals need the quartic of Fresnel's equation, which is not here yet."""
        raise NotSupportedError("biaxial media are not supported yet: only isotropic and uniaxial ones")

    @property
    def is_isotropic(self) -> bool:
        """Whether the medium has one index in all directions."""
        return len(self.indices) == 1

    def take(self, rays: Rays) -> Medium:
        """Return the medium of a selection of rays (an index array or a slice)."""
        return Medium(
            tuple(take(n, rays) for n in self.indices),
            self.axis if self.axis is None or self.axis.ndim == 1 else columns(self.axis, rays),
            None if self.absorption_per_mm is None else tuple(take(a, rays) for a in self.absorption_per_mm),
        )


def take(values: Real, rays: Rays) -> Real:
    """Return the values of a selection of rays; one value for all, shape (), stays one."""
    return values if values.ndim == 0 else values[rays]


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
