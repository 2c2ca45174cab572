"""Coherency matrices C = ⟨E E†⟩ of light in isotropic media, in a right-handed frame (x, y, propagation)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crystal_core.optics.arrays import Field, Rays, Real, dot
from crystal_core.optics.frames import transverse_frame

__all__ = ["Coherency"]


@dataclass(frozen=True, slots=True)
class Coherency:
    """Hermitian 2×2 matrices, one per ray, as four real arrays of shape (N,).

    A backward ray carries its importance W the same way: with C = conj(W) the forward rules below move it, since an
    event's transposed Jones matrix is the event run backward (reciprocity), so that J† W J = conj(Jᵀ conj(W) conj(J)).

    Parameters
    ----------
    xx, yy : Real
        Intensities along x and y.
    xy_re, xy_im : Real
        Real and imaginary part of C_xy.
    """

    xx: Real
    yy: Real
    xy_re: Real
    xy_im: Real

    @classmethod
    def unpolarized(cls, intensity: Real) -> Coherency:
        """Return diag(I/2, I/2)."""
        zero = np.zeros(intensity.shape)
        return cls(0.5 * intensity, 0.5 * intensity, zero, zero)

    @classmethod
    def pure(cls, ex: Field, ey: Field, intensity: Real) -> Coherency:
        """Return intensity · e e† of the Jones vector e = (ex, ey), not normalised."""
        cross = intensity * (ex * np.conj(ey))
        return cls(intensity * np.abs(ex) ** 2, intensity * np.abs(ey) ** 2, cross.real, cross.imag * np.ones(ex.shape))

    def intensity(self) -> Real:
        """Return the trace."""
        return self.xx + self.yy

    def stokes(self) -> Real:
        """Return (S0, S1, S2, S3), shape (4, N); S3 > 0 is counter-clockwise to an observer who faces the source."""
        return np.stack((self.xx + self.yy, self.xx - self.yy, 2 * self.xy_re, -2 * self.xy_im))

    def rotated(self, cos: Real, sin: Real) -> Coherency:
        """Return the matrices in a frame turned counter-clockwise about the propagation, x' = cos x + sin y."""
        c2, s2, cs = cos * cos, sin * sin, cos * sin
        return Coherency(
            c2 * self.xx + s2 * self.yy + 2 * cs * self.xy_re,
            s2 * self.xx + c2 * self.yy - 2 * cs * self.xy_re,
            cs * (self.yy - self.xx) + (c2 - s2) * self.xy_re,
            self.xy_im,
        )

    def in_frame(self, direction: Real, x_axis: Real) -> Coherency:
        """Return matrices given in `transverse_frame(direction)` in the frame whose x is `x_axis`, each (3, N)."""
        x, y = transverse_frame(direction)
        return self.rotated(dot(x_axis, x), dot(x_axis, y))

    def to_transverse_frame(self, direction: Real, x_axis: Real) -> Coherency:
        """Return matrices given in the frame whose x is `x_axis` in `transverse_frame(direction)`, each (3, N)."""
        x, y = transverse_frame(direction)
        return self.rotated(dot(x_axis, x), -dot(x_axis, y))

    def power_into(self, jx: Field, jy: Field) -> Real:
        """Return j C j† for the row j = (jx, jy): the power that an amplitude jx E_x + jy E_y carries, shape (N,)."""
        cross = jx * np.conj(jy)
        return (
            np.abs(jx) ** 2 * self.xx
            + np.abs(jy) ** 2 * self.yy
            + 2.0 * (cross.real * self.xy_re - cross.imag * self.xy_im)
        )

    def take(self, rays: Rays) -> Coherency:
        """Return the matrices of a selection of rays."""
        return Coherency(self.xx[rays], self.yy[rays], self.xy_re[rays], self.xy_im[rays])
