"""Conical refraction: one wave normal with a whole cone of rays, one ray with a whole cone of wave normals.

Every D across an optic axis o of a biaxial crystal belongs to a wave of index n_β along it, and each has a ray of its
own (internal conical refraction). Let g be the part of ε⁻¹o across o, in the plane of the optic axes, and ψ the angle
of D from −g. The ray of E = ε⁻¹D goes along

    o + w,    w = −n_β² (g·D) D / D² = ½ n_β² |g| (1 + cos 2ψ, sin 2ψ):

a circle through o in the plane at unit distance, run through twice as fast as D turns. Its diameter is the tangent of
the full angle in the plane of the optic axes (Born & Wolf, Principles of Optics, 7th ed., §15.3.4),

    tan χ = n_β² √((n_α⁻² − n_β⁻²)(n_β⁻² − n_γ⁻²)).

The wave normals of one ray (external conical refraction) are the rays of one wave normal in the dual medium, of indices
1/n, with E in the place of D; the tangent is then √((n_β² − n_α²)(n_γ² − n_β²))/n_β².
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from crystal_core.errors import InputError, NotSupportedError
from crystal_core.optics.arrays import Real
from crystal_core.optics.directions import PlaneWave, waves_along
from crystal_core.optics.indicatrix import BiaxialIndicatrix, optical_class
from crystal_core.optics.medium import Medium
from crystal_core.optics.wave_surface import dual

__all__ = ["Cone", "external_cone", "internal_cone", "trace_internal_cone"]


@dataclass(frozen=True, slots=True)
class Cone:
    """A skew circular cone: the directions from the origin to a circle in the plane x·axis = 1 that passes the axis.

    Parameters
    ----------
    axis : Real
        Optic axis (internal conical refraction) or biradial (external), unit, shape (3,). It lies on the cone.
    towards : Real
        Unit vector across the axis, from it to the centre of the circle, shape (3,).
    radius : float
        Of the circle.
    """

    axis: Real
    towards: Real
    radius: float

    def centre(self) -> Real:
        """Return the centre of the circle, shape (3,)."""
        return np.asarray(self.axis + self.radius * self.towards)

    def aperture(self) -> float:
        """Return the full angle χ of the cone in the plane of the optic axes, radians: tan χ is the diameter."""
        return float(np.arctan(2.0 * self.radius))

    def directions(self, vibration: ArrayLike) -> Real:
        """Return the unit vectors of the cone that belong to vibrations at the given angles.

        Parameters
        ----------
        vibration : array_like
            Angle ψ of the vibration, as in `vibrations`, shape (N,). A half turn of it is once around the cone, and a
            quarter turn gives the axis.

        Returns
        -------
        Real
            Rays (internal) or wave normals (external), shape (3, N).
        """
        psi = np.asarray(vibration, np.float64)
        x, y = self._frame()
        point = self.centre()[:, None] + self.radius * (np.cos(2 * psi) * x + np.sin(2 * psi) * y)
        return np.asarray(point / np.sqrt(np.sum(point * point, axis=0)))

    def vibrations(self, vibration: ArrayLike) -> Real:
        """Return the unit vectors along D (internal) or E (external) at angles ψ, shape (3, N).

        ψ turns counter-clockwise about the axis, as seen against it, from the direction of the circle's centre.
        """
        psi = np.asarray(vibration, np.float64)
        x, y = self._frame()
        return np.asarray(np.cos(psi) * x + np.sin(psi) * y)

    def _frame(self) -> tuple[Real, Real]:
        """Return columns x, y across the axis, x towards the centre, (x, y, axis) right-handed."""
        return self.towards[:, None], np.cross(self.axis, self.towards)[:, None]


def internal_cone(medium: Medium, which: Literal[0, 1] = 0) -> Cone:
    """Return the cone of rays of the wave normal along an optic axis.

    Parameters
    ----------
    medium : Medium
        Biaxial, at one wavelength: indices of shape (), axes of shape (3, 3).
    which : int
        Which optic axis, in the order of `BiaxialIndicatrix.optic_axes`. The cone about the reversed axis is the
        reversed cone.

    Raises
    ------
    InputError
        The medium is not biaxial or has more than one wavelength; another number than 0 or 1.
    NotSupportedError
        The medium is optically active: its sheets do not touch.
    """
    indicatrix = _indicatrix(medium, which)
    alpha, beta, gamma = (float(n) for n in (indicatrix.alpha, indicatrix.beta, indicatrix.gamma))
    lower = (beta - alpha) * (beta + alpha) / (alpha * beta) ** 2
    upper = (gamma - beta) * (gamma + beta) / (beta * gamma) ** 2
    radius = 0.5 * beta**2 * float(np.sqrt(lower * upper))
    # From the optic axis towards γ: along sin V γ − cos V α, or its mirror image for the other axis.
    sin, cos = indicatrix.sin_v, indicatrix.cos_v * (1 if which == 0 else -1)
    towards = sin * indicatrix.axes[2] - cos * indicatrix.axes[0]
    return Cone(indicatrix.optic_axes()[which], towards, radius)


def external_cone(medium: Medium, which: Literal[0, 1] = 0) -> Cone:
    """Return the cone of wave normals, inside the crystal, of the ray along a biradial.

    Parameters and errors are those of `internal_cone`. The axis of the cone is the biradial next to that optic axis.
    """
    indicatrix = _indicatrix(medium, which)
    cone = internal_cone(dual(medium), which)
    # Of the dual medium α and γ have changed places, and so has the half-space in which its axes are given.
    side = np.sign(np.sum(cone.axis * indicatrix.optic_axes()[which]))
    return Cone(side * cone.axis, side * cone.towards, cone.radius)


def trace_internal_cone(
    medium: Medium, half_angle: float, azimuth: ArrayLike, which: Literal[0, 1] = 0
) -> tuple[PlaneWave, PlaneWave]:
    """Return the slow and the fast waves of a narrow circular cone of wave normals about an optic axis.

    This is how a beam along the axis is sampled. Once around the wave normals, the rays of either wave go once around
    the cone of `internal_cone`, opposite each other, and meet it in the limit half_angle → 0.

    Parameters
    ----------
    medium : Medium
        As for `internal_cone`.
    half_angle : float
        Of the cone of wave normals, radians, above 0 and below π/2. Below 1e-7 the directions lose digits: their
        rounding is 1e-16/half_angle.
    azimuth : array_like
        Angle of each wave normal about the optic axis, counter-clockwise as seen against it, from the side where the
        circle of the rays is, radians, shape (N,).
    which : int
        Which optic axis, as for `internal_cone`.

    Raises
    ------
    InputError
        As `internal_cone`; a half angle out of its range.
    NotSupportedError
        The medium is optically active.
    """
    cone = internal_cone(medium, which)
    if not 0.0 < half_angle < 0.5 * np.pi:
        raise InputError.at("/half_angle", "must lie above 0 and below π/2")
    s = np.cos(half_angle) * cone.axis[:, None] + np.sin(half_angle) * cone.vibrations(azimuth)
    return waves_along(medium, s)


def _indicatrix(medium: Medium, which: int) -> BiaxialIndicatrix:
    if which not in (0, 1):
        raise InputError.at("/which", f"a biaxial medium has the optic axes 0 and 1, not {which}")
    if medium.gyration is not None and np.any(medium.gyration):
        raise NotSupportedError("in an optically active medium (one with a gyration tensor) the cones open up")
    if any(n.ndim for n in medium.indices) or (medium.axes is not None and medium.axes.ndim > 2):
        raise InputError.at("", "conical refraction belongs to one medium at one wavelength")
    if optical_class(medium) != "biaxial":
        raise InputError.at("/indices", "only a biaxial medium refracts conically")
    return BiaxialIndicatrix.of(medium)
