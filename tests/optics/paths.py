"""Light led through a crystal and back: air → a wave → total reflection, maybe with conversion → another → air."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from crystal_core.optics import Medium, Scattering, Wave, scatter, transverse_frame
from crystal_core.optics.arrays import BoolArray, Complex, Real
from tests.reference.media import KINDS, Kind, random_media, random_units

__all__ = [
    "AIR",
    "PATH_KINDS",
    "Beam",
    "PathKind",
    "Turn",
    "facing",
    "internal_path",
    "norm",
    "reversed_path",
    "tangential",
]

PathKind = Kind | Literal["active"]
PATH_KINDS: tuple[PathKind, ...] = (*KINDS, "active")

AIR = Medium.isotropic(1.0)


def norm(v: Real) -> Real:
    return np.asarray(np.sqrt(np.sum(v * v, axis=0)))


def facing(z: Real, v: Real) -> Real:
    """Return z or −z, whichever v goes along."""
    return np.asarray(z * np.where(np.sum(z * v, axis=0) < 0, -1.0, 1.0))


def tangential(k: Real, z: Real) -> Real:
    across = k - np.sum(k * z, axis=0) * z
    return np.asarray(across - np.sum(across * z, axis=0) * z)


@dataclass(frozen=True)
class Turn:
    """A face of a path: its normal along the way, the media on its sides, and whether the beam is reflected."""

    normal: Real
    source: Medium
    target: Medium
    reflected: bool

    def reversed(self) -> Turn:
        """Return the face as the beam that comes back meets it."""
        if self.reflected:
            return self
        return Turn(-self.normal, self.target, self.source, False)


@dataclass(frozen=True)
class Beam:
    """One wave in a crystal, or both of one k in an isotropic medium, with what two incident fields put into each.

    Parameters
    ----------
    k, ray : Real
        (3, N).
    fields : list of Complex
        Unit fields, (3, N) each.
    amplitude : Complex
        [i, j]: of field i from the incident field j, (n, 2, N), scaled so that |amplitude|² is power.
    """

    k: Real
    ray: Real
    fields: list[Complex]
    amplitude: Complex

    @classmethod
    def start(cls, direction: Real, x: Real, y: Real) -> Beam:
        """Return a beam in air whose two incident fields are along unit vectors x and y."""
        one, none = np.ones(direction.shape[1]), np.zeros(direction.shape[1])
        return cls(direction, direction, [x + 0j, y + 0j], np.array(((one, none), (none, one)), np.complex128))

    def jones(self, x: Real, y: Real) -> Complex:
        """Return the amplitudes along unit vectors x and y, (2, 2, N)."""
        return np.array(
            [sum(np.sum(v * field, axis=0) * self.amplitude[i] for i, field in enumerate(self.fields)) for v in (x, y)]
        )

    def met(self, turn: Turn) -> Scattering:
        """Return what the face does to the waves of this k."""
        return scatter(turn.normal, tangential(self.k, turn.normal), turn.source, turn.target)

    def through(self, turn: Turn, wanted: int | Real) -> Beam:
        """Return the beam behind a face.

        Parameters
        ----------
        turn : Turn
            The face.
        wanted : int or Real
            Of an anisotropic medium behind it the mode to follow, or the wave vector of it, (3, N).
        """
        s = self.met(turn)
        out, table = (
            (s.reflected, s.amplitude_reflected) if turn.reflected else (s.transmitted, s.amplitude_transmitted)
        )
        count = self.k.shape[1]
        mine = np.zeros((2, 2, count), np.complex128)  # of each incident wave of the face
        for i, wave in enumerate(s.incident):
            # In a crystal only the wave that this beam is; its field may come out with another sign.
            own = np.ones(count) if turn.source.is_isotropic else _nearest(s.incident, self.k) == i
            for n, field in enumerate(self.fields):
                mine[i] += own * np.sum(np.conj(wave.field) * field, axis=0) * self.amplitude[n]
        flux = np.where(_nearest(s.incident, self.k) == 0, s.incident[0].flux, s.incident[1].flux)
        with np.errstate(divide="ignore", invalid="ignore"):  # rays that have ended; `internal_path` tells which
            scale = [np.sqrt(np.abs(wave.flux) / flux) for wave in out]
            behind = np.array([sum(np.nan_to_num(table[i][j]) * scale[i] * mine[j] for j in (0, 1)) for i in (0, 1)])
        media_behind = turn.source if turn.reflected else turn.target
        if media_behind.is_isotropic:
            return Beam(out[0].k, out[0].ray, [wave.field for wave in out], behind)
        first = np.full(count, wanted == 0) if isinstance(wanted, int) else _nearest(out, wanted) == 0
        k, ray, field = (
            np.where(first, getattr(out[0], name), getattr(out[1], name)) for name in ("k", "ray", "field")
        )
        return Beam(k, ray, [field], np.where(first, behind[0], behind[1])[None])


def _nearest(waves: tuple[Wave, Wave], k: Real) -> np.ndarray:
    one, two = (norm(wave.k - k) for wave in waves)
    return np.asarray(np.where(two < one, 1, 0))


def internal_path(
    rng: np.random.Generator, kind: PathKind, count: int, modes: tuple[int, int]
) -> tuple[Beam, list[Turn], list[Beam], BoolArray]:
    """Return a beam in air, its three faces, the beams behind them, and for which rays the light comes out again.

    The second face reflects all the light: tangential k is above 1. Crystals are those of `random_media` of an index
    above 1.2, so that there is such a face; "active" ones are biaxial and turn the plane of polarization.
    """
    media = random_media(rng, "biaxial" if kind == "active" else kind, count)
    crystal = replace(media, indices=1.2 + 0.6 * (media.indices - 1.0)).medium()
    if kind == "active":
        gyration = rng.normal(0.0, 0.02, (3, 3, count))
        crystal = crystal.active(gyration + gyration.swapaxes(0, 1))
    d = random_units(rng, count)
    beam = Beam.start(d, *transverse_frame(d))
    entry = Turn(facing(random_units(rng, count), d), AIR, crystal, False)
    inside = beam.through(entry, modes[0])

    # A face at such an angle to k that k_t is from 1.02 to all of it, met by the ray from within.
    n = norm(inside.k)
    axis = inside.k / n
    across = np.cross(axis, random_units(rng, count), axis=0)
    across /= norm(across)
    sin = rng.uniform(1.02, 0.98 * n) / n
    z = axis * np.sqrt(1.0 - sin**2) + across * sin
    z = facing(z, inside.ray)
    mirror = Turn(z / norm(z), crystal, AIR, True)
    after = inside.through(mirror, modes[1])

    out = after.k + 0.2 * norm(after.k) * random_units(rng, count)
    leaving = Turn(facing(out / norm(out), after.ray), crystal, AIR, False)
    behind = after.through(leaving, 0)
    turns = [entry, mirror, leaving]
    good = np.isfinite(after.ray).all(axis=0) & np.isfinite(behind.ray).all(axis=0)
    # At grazing incidence amplitudes change with the root of the angle; a tenth of the beams go.
    for turn, outside in ((entry, beam), (leaving, behind)):
        good &= np.abs(np.sum(turn.normal * outside.k, axis=0)) > 0.05
    return beam, turns, [inside, after, behind], good


def reversed_path(beams: list[Beam], turns: list[Turn], x: Real, y: Real) -> list[Beam]:
    """Return the beams behind each face of the path run backward from light that comes in along x and y."""
    *inner, last = beams
    beam = Beam.start(-last.k, x, y)
    result = []
    for turn, before in zip(turns[::-1], [*inner[::-1], None], strict=True):
        beam = beam.through(turn.reversed(), 0 if before is None else -before.k)
        result.append(beam)
    return result
