"""Faces of an anisotropic crystal in air: importance splits between two modes, each followed as a ray of its own.

The two rays part on their way, so beams add by intensity: their interference shows only in plates so
thin that the two stay within a pixel's footprint, which this tracer does not treat as such.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics import InterfaceFrame, Medium, absorption_along_ray, interface_frame
from crystal_core.optics.arrays import Field, columns, dot
from crystal_core.optics.directions import waves_along
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.framed import FramedMedium
from crystal_core.optics.interface import Face, solve_face
from crystal_core.optics.modes import Mode
from crystal_core.render.rays import InsideRays
from crystal_core.render.tracer import AIR, Arrivals, Leaving, Roulette, face_normals
from crystal_core.scene import StagedSpecimen

__all__ = ["AnisotropicEvents"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]


class AnisotropicEvents:
    """`tracer.Events` of an anisotropic specimen.

    Mode 0 is the ordinary one, mode 1 the extraordinary; of a biaxial crystal they are the slow and the fast one, but
    where both waves of a face lie on the outer sheet (inhibited reflection) both are slow: there a ray of mode 1 comes
    from a face as the second and may go to the next as the first of its pair.

    Parameters
    ----------
    specimen : StagedSpecimen
        The crystal.
    medium : Medium
        Its medium with one index per wavelength of the pass, shape (K,).
    """

    modes = 2

    def __init__(self, specimen: StagedSpecimen, medium: Medium) -> None:
        self._body = specimen.body
        self._normals = face_normals(specimen)
        self._medium = medium
        self.lossless = medium.absorption_per_mm is None
        self._colours = medium.indices[0].size
        self._is_biaxial = len(medium.indices) == 3

    def enter(self, arrivals: Arrivals, roulette: Roulette) -> tuple[Leaving, list[InsideRays]]:
        """Return the reflected rays and, per mode, the refracted ones."""
        d = arrivals.direction
        z = -columns(self._normals, arrivals.face)
        forward = dot(d, z)
        frame = interface_frame(z, d - forward * z)
        crystal = framed(self._medium.take(arrivals.colour), frame)
        # (p, s, propagation) is right-handed: p is x, s is y.
        p_axis = frame.world(forward, None, -frame.kappa)
        importance = arrivals.importance.in_frame(d, p_axis)
        reflected = importance.intensity()
        depth = np.zeros(forward.size, np.int16)
        pieces: tuple[list[InsideRays], list[InsideRays]] = ([], [])
        for part, face in _faces(framed(AIR, frame), crystal):
            from_s, from_p = face.transmission(0), face.transmission(1)
            arriving = importance.take(part)
            powers = []
            for mode in (0, 1):
                power = arriving.power_into(from_p[mode], from_s[mode])
                power = power * np.abs(face.transmitted[mode].flux()) / forward[part]
                reflected[part] -= power
                powers.append(power)
            at_face, lane = columns(arrivals.point, part), arrivals.lane[part]
            _spawn(pieces, face.frame, face.transmitted, powers, at_face, lane, depth[part], roulette)
        back = d - 2.0 * forward * z
        return Leaving(arrivals.point, back, reflected, arrivals.lane), [InsideRays.joined(piece) for piece in pieces]

    def leave(self, rays: InsideRays, mode: int, roulette: Roulette) -> tuple[Leaving, list[InsideRays]]:
        """Carry rays to the next face; return those that go out and, per mode, those reflected inside."""
        distance, exit_face = self._body.exit(rays.point, rays.ray)
        point = rays.point + distance * rays.ray
        medium = self._medium.take(rays.lane % self._colours)
        importance = rays.importance[0]
        if medium.absorption_per_mm is not None:
            length = distance * np.sqrt(dot(rays.ray, rays.ray))
            importance = importance * np.exp(
                -length * absorption_along_ray(medium, rays.k, self._field(medium, rays.k, mode))
            )
        z = columns(self._normals, exit_face)
        outward = dot(rays.k, z)
        tangential = rays.k - outward * z
        frame = interface_frame(z, tangential)
        depth = rays.depth + np.int16(1)
        pieces: tuple[list[InsideRays], list[InsideRays]] = ([], [])
        out: list[Leaving] = []
        for part, face in _faces(framed(medium, frame), framed(AIR, frame)):
            transmitted, reflected = self._shares(face, mode, outward[part])
            weight, lane = importance[part], rays.lane[part]
            gone = np.flatnonzero(transmitted > 0.0)
            if gone.size:
                at = gone if isinstance(part, slice) else part[gone]
                direction = columns(tangential, at) + face.transmitted[0].q.real[gone] * columns(z, at)
                out.append(Leaving(columns(point, at), direction, weight[gone] * transmitted[gone], lane[gone]))
            shares = [weight * share for share in reflected]
            _spawn(pieces, face.frame, face.reflected, shares, columns(point, part), lane, depth[part], roulette)
        return Leaving.joined(out), [InsideRays.joined(piece) for piece in pieces]

    def _field(self, medium: Medium, k: Real, mode: int) -> Field:
        """Return the electric fields of rays of a mode, shape (3, N)."""
        length = np.sqrt(dot(k, k))
        pair = waves_along(medium, k / length)
        if not self._is_biaxial:
            return pair[mode].e
        first = np.abs(pair[0].index - length) <= np.abs(pair[1].index - length)
        return np.where(first, pair[0].e, pair[1].e)

    def _shares(self, face: Face, mode: int, outward: Real) -> tuple[Real, tuple[Real, Real]]:
        """Return `_shares` of rays of a mode, told from the other wave of a biaxial pair by their own k."""
        if not self._is_biaxial:
            return _shares(face, mode)
        off = [np.abs(wave.q.real - outward) for wave in face.incident]
        other = off[1 - mode] < off[mode]
        transmitted, (first, second) = _shares(face, mode)
        if other.any():
            instead, (instead_first, instead_second) = _shares(face, 1 - mode)
            transmitted = np.where(other, instead, transmitted)
            first, second = np.where(other, instead_first, first), np.where(other, instead_second, second)
        return transmitted, (first, second)


def _faces(source: FramedMedium, target: FramedMedium) -> Iterator[tuple[slice | Index, Face]]:
    """Yield the rays in one or two parts, by what arithmetic their waves need, with their faces.

    Real on a side where every wave propagates, complex where one may be evanescent. Total reflection is too common,
    and complex numbers too cheap, to set those rays apart; waves evanescent on the near side are rare.
    """
    near, far = source.propagating(), target.propagating()
    near_free = near[0] & near[1]
    far_complex = not bool((far[0] & far[1]).all())
    if near_free.all():
        yield slice(None), solve_face(source, target, False, far_complex)
        return
    for part, near_complex in ((np.flatnonzero(near_free), False), (np.flatnonzero(~near_free), True)):
        if part.size:
            yield part, solve_face(source.take(part), target.take(part), near_complex, far_complex)


def _shares(face: Face, mode: int) -> tuple[Real, tuple[Real, Real]]:
    """Return the parts of a mode's flux that go out and into the two reflected modes; they sum to 1.

    The second reflected mode takes what is left: energy is kept to the last bit.
    """
    incident = face.incident[mode].flux()
    s, p = face.transmission(mode)
    air = face.transmitted[0].q.real  # flux of s and p of unit field; 0 where they are evanescent
    transmitted = (np.abs(s) ** 2 + np.abs(p) ** 2) * air / incident
    same = np.abs(face.reflection(mode, mode)) ** 2 * np.abs(face.reflected[mode].flux()) / incident
    same = np.minimum(same, 1.0)
    other = np.maximum(1.0 - transmitted - same, 0.0)
    return transmitted, (same, other) if mode == 0 else (other, same)


def _spawn(
    pieces: tuple[list[InsideRays], list[InsideRays]],
    frame: InterfaceFrame,
    waves: tuple[Mode, Mode],
    importances: list[Real],
    point: Real,
    lane: Index,
    depth: NDArray[np.int16],
    roulette: Roulette,
) -> None:
    """Add the rays of both modes' waves that survive, in the world, to the pieces of each mode."""
    survivors = roulette.survivors((importances[0], importances[1]), depth)
    for piece, wave, importance, (kept, factor) in zip(pieces, waves, importances, survivors, strict=True):
        part = frame.take(kept)
        state = np.empty((10, kept.size))
        state[0:3] = columns(point, kept)
        sideways = wave.ray[1]
        state[3:6] = part.world(
            wave.ray[0].real[kept], None if sideways is None else sideways.real[kept], wave.ray[2].real[kept]
        )
        state[6:9] = part.world(part.kappa, None, wave.q.real[kept])
        state[9] = importance[kept] * factor
        piece.append(InsideRays(state, lane[kept], depth[kept]))
