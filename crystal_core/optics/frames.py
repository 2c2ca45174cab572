"""Right-handed frames: of an interface and its plane of incidence, and across a direction of propagation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import overload

import numpy as np

from crystal_core.optics.arrays import Field, Rays, Real, columns, dot

__all__ = ["InterfaceFrame", "interface_frame", "transverse_frame"]

NORMAL_INCIDENCE = 1e-15
"""Tangential |k| below which incidence counts as normal: there the plane of incidence is only rounding."""


@dataclass(frozen=True, slots=True)
class InterfaceFrame:
    """Frame of a plane of incidence: x along the tangential wave vector, z along the normal, y = z × x.

    A wave vector reads (kappa, 0, q) in it, the same kappa for every wave at the interface; y is the direction of s.

    Parameters
    ----------
    x, y, z : Real
        Unit vectors, shape (3, N).
    kappa : Real
        Length of the tangential wave vector, in units of 2π/λ, shape (N,).
    """

    x: Real
    y: Real
    z: Real
    kappa: Real

    def components(self, v: Real) -> tuple[Real, Real, Real]:
        """Return the components of world vectors `v`, shape (3,) or (3, N), along x, y, z."""
        return dot(v, self.x), dot(v, self.y), dot(v, self.z)

    @overload
    def world(self, vx: Real, vy: Real | None, vz: Real) -> Real: ...

    @overload
    def world(self, vx: Field, vy: Field | None, vz: Field) -> Field: ...

    def world(self, vx: Field, vy: Field | None, vz: Field) -> Field:
        """Return the world vectors, shape (3, N), of components along x, y, z; None stands for zero."""
        in_plane = self.x * vx + self.z * vz
        return in_plane if vy is None else in_plane + self.y * vy

    def take(self, rays: Rays) -> InterfaceFrame:
        """Return the frames of a selection of rays."""
        return InterfaceFrame(columns(self.x, rays), columns(self.y, rays), columns(self.z, rays), self.kappa[rays])


def interface_frame(normal: Real, tangential_k: Real) -> InterfaceFrame:
    """Return the frame of each ray's plane of incidence.

    Parameters
    ----------
    normal : Real
        Unit normal of the interface, shape (3, N).
    tangential_k : Real
        Wave vector's part in the interface, in units of 2π/λ, shape (3, N). Where it vanishes (normal incidence)
        any direction in the interface serves as x.
    """
    kappa = np.sqrt(dot(tangential_k, tangential_k))
    x = tangential_k / np.maximum(kappa, NORMAL_INCIDENCE)
    at_normal = np.flatnonzero(kappa <= NORMAL_INCIDENCE)
    if at_normal.size:
        x[:, at_normal] = transverse_frame(normal[:, at_normal])[0]
        kappa[at_normal] = 0.0
    y = np.empty_like(x)
    y[0] = normal[1] * x[2] - normal[2] * x[1]
    y[1] = normal[2] * x[0] - normal[0] * x[2]
    y[2] = normal[0] * x[1] - normal[1] * x[0]
    return InterfaceFrame(x, y, normal, kappa)


def transverse_frame(direction: Real) -> tuple[Real, Real]:
    """Return unit vectors x, y, each (3, N), such that (x, y, direction) is right-handed.

    A function of the direction alone, so that a coherency matrix needs no frame of its own beside it. Formula of
    Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017; exact for every unit direction (3, N).
    """
    sign = np.copysign(1.0, direction[2])
    a = -1.0 / (sign + direction[2])
    b = direction[0] * direction[1] * a
    x = np.stack((1.0 + sign * direction[0] ** 2 * a, sign * b, -sign * direction[0]))
    y = np.stack((b, sign + direction[1] ** 2 * a, -direction[1]))
    return x, y
