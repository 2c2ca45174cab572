"""Faces of an isotropic crystal in air: one ray inside, with its coherency matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics import Coherency, InterfaceFrame, Medium, interface_frame
from crystal_core.optics.arrays import Complex, Field, columns, dot
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.interface import solve_face
from crystal_core.optics.modes import Mode
from crystal_core.render.rays import InsideRays
from crystal_core.render.tracer import AIR, Arrivals, Leaving, Roulette, face_normals
from crystal_core.scene import StagedSpecimen

__all__ = ["IsotropicEvents"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]


class IsotropicEvents:
    """`tracer.Events` of an isotropic specimen; one pool of rays that carry a coherency matrix.

    Parameters
    ----------
    specimen : StagedSpecimen
        The crystal.
    medium : Medium
        Its medium with one index per wavelength of the pass, shape (K,).
    """

    modes = 1

    def __init__(self, specimen: StagedSpecimen, medium: Medium) -> None:
        self._body = specimen.body
        self._normals = face_normals(specimen)
        self._medium = medium
        self.lossless = medium.absorption_per_mm is None
        self._colours = medium.indices[0].size

    def enter(self, arrivals: Arrivals, roulette: Roulette) -> tuple[Leaving, list[InsideRays]]:
        """Return the reflected rays and the refracted ones."""
        d = arrivals.direction
        z = -columns(self._normals, arrivals.face)
        forward = dot(d, z)
        frame = interface_frame(z, d - forward * z)
        crystal = self._medium.take(arrivals.colour)
        face = solve_face(framed(AIR, frame), framed(crystal, frame), False, True)
        t_s, t_p = face.transmission(0)[0], face.transmission(1)[1]
        inward = face.transmitted[0].q.real
        scale = np.sqrt(inward / forward)
        before = arrivals.importance.in_frame(d, _p_axis(frame, forward, np.ones(forward.size)))
        after = _diagonal(before, t_p * scale, t_s * scale)
        inside = _spawned(
            face.transmitted[0], frame, arrivals.point, after, arrivals.lane, np.zeros(forward.size, np.int16), roulette
        )
        reflected = before.intensity() - after.intensity()
        return Leaving(arrivals.point, d - 2.0 * forward * z, reflected, arrivals.lane), [inside]

    def leave(self, rays: InsideRays, mode: int, roulette: Roulette) -> tuple[Leaving, list[InsideRays]]:
        """Carry rays to the next face; return those that go out and those reflected inside."""
        assert mode == 0
        distance, exit_face = self._body.exit(rays.point, rays.ray)
        point = rays.point + distance * rays.ray
        crystal = self._medium.take(rays.lane % self._colours)
        n = crystal.indices[0]
        importance = Coherency(*rays.importance)
        if crystal.absorption_per_mm is not None:
            length = distance * np.sqrt(dot(rays.ray, rays.ray))
            dimmed = np.exp(-length * crystal.absorption_per_mm[0])
            importance = Coherency(*(dimmed * row for row in rays.importance))
        z = columns(self._normals, exit_face)
        outward = dot(rays.k, z)
        tangential = rays.k - outward * z
        frame = interface_frame(z, tangential)
        face = solve_face(framed(crystal, frame), framed(AIR, frame), False, True)
        air = face.transmitted[0].q.real
        scale = np.sqrt(air / outward)
        before = importance.in_frame(rays.k / n, _p_axis(frame, outward, n))
        gone = _diagonal(before, face.transmission(1)[1] * scale, face.transmission(0)[0] * scale)
        kept = _diagonal(before, face.reflection(1, 1), face.reflection(0, 0))
        inside = _spawned(face.reflected[0], frame, point, kept, rays.lane, rays.depth + np.int16(1), roulette)
        out = np.flatnonzero(air > 0.0)
        direction = columns(tangential, out) + air[out] * columns(z, out)
        return Leaving(columns(point, out), direction, gone.intensity()[out], rays.lane[out]), [inside]


def _p_axis(frame: InterfaceFrame, q: Real, n: Real) -> Real:
    """Return the unit vectors of p, (q, 0, −κ)/n; (p, s, propagation) is right-handed."""
    return frame.world(q / n, None, -frame.kappa / n)


def _diagonal(before: Coherency, x: Field, y: Field) -> Coherency:
    """Return J C J† for J = diag(x, y)."""
    cross: Complex = np.asarray(x * np.conj(y) * (before.xy_re + 1j * before.xy_im), np.complex128)
    return Coherency(np.abs(x) ** 2 * before.xx, np.abs(y) ** 2 * before.yy, cross.real, cross.imag)


def _spawned(
    mode: Mode,
    frame: InterfaceFrame,
    point: Real,
    importance: Coherency,
    lane: Index,
    depth: NDArray[np.int16],
    roulette: Roulette,
) -> InsideRays:
    """Return the rays of an isotropic wave that survive, in the world."""
    ((kept, factor),) = roulette.survivors((importance.intensity(),), depth)
    part = frame.take(kept)
    q = mode.q.real[kept]
    k = part.world(part.kappa, None, q)
    n = np.sqrt(dot(k, k))
    carried = importance.take(kept).to_transverse_frame(k / n, _p_axis(part, q, n))
    state = np.empty((13, kept.size))
    state[0:3] = columns(point, kept)
    state[3:6] = k
    state[6:9] = k
    state[9:] = (carried.xx * factor, carried.yy * factor, carried.xy_re * factor, carried.xy_im * factor)
    return InsideRays(state, lane[kept], depth[kept])
