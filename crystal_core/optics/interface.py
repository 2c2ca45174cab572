"""Scattering of plane waves at the plane face between two media, by continuity of tangential E and H.

Let ψ = (E_t, H_t) be the tangential field of a wave and g(ψ, φ) = (E_ψ × H_φ + E_φ × H_ψ)_z. Two different waves of one
medium with the same tangential k have g = 0 (`modes.bilinear`). Projecting the continuity condition

    ψ_in + Σ r_i ψ₁⁻_i = Σ t_j ψ₂⁺_j

on the two waves ψ₁⁺_i that travel towards the face removes the reflected waves, and leaves one 2×2 system for the
transmitted amplitudes; projecting on ψ₁⁻_i then gives the reflected ones, one division each:

    Σ_j g(ψ₁⁺_i, ψ₂⁺_j) t_j = g(ψ₁⁺_i, ψ_in),        r_i = Σ_j t_j g(ψ₁⁻_i, ψ₂⁺_j) / g(ψ₁⁻_i, ψ₁⁻_i).

The same few products serve every pair of media, and no wave need propagate. Where a reflected wave is exactly
grazing g(ψ₁⁻_i, ψ₁⁻_i) vanishes; such rays are solved by the plain 4×4 continuity system of waves of unit E.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.errors import InputError
from crystal_core.optics.active import FramedActive
from crystal_core.optics.arrays import BoolArray, Field, Rays, Real, dot
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.framed import FramedMedium
from crystal_core.optics.frames import InterfaceFrame, interface_frame
from crystal_core.optics.medium import UNIT_TOLERANCE, Medium
from crystal_core.optics.modes import Mode, Wave, bilinear

__all__ = ["Face", "Scattering", "scatter", "solve_face"]

GRAZING = 1e-9
"""|g(ψ, ψ)|/|ψ|² below which a reflected wave counts as grazing: the division would cost half the digits."""

SINGULAR = 1e-13
"""Determinant of unit columns, and share of the largest singular value, below which they count as dependent."""

SLANTING = 1e-5
"""|g(ψ, ψ)|/|E|² of a wave of a crystal below which its closed form has lost digits that energy needs."""

ALL = slice(None)

NORMAL_PART = 1e-9
"""Largest normal component of a tangential wave vector that is taken for rounding."""

Amplitudes = list[list[Field]]
"""[i][j]: outgoing mode i from incident mode j."""


@dataclass(slots=True)
class Face:
    """The six waves at a face, in its frame, and the amplitudes between them, found on demand.

    Every array has one entry per ray; where `evanescent` is False all of them are real.
    """

    frame: InterfaceFrame
    incident: tuple[Mode, Mode]
    reflected: tuple[Mode, Mode]
    transmitted: tuple[Mode, Mode]
    _gram: Amplitudes = field(default_factory=list)
    _transmission: dict[int, tuple[Field, Field]] = field(default_factory=dict)

    def transmission(self, j: int) -> tuple[Field, Field]:
        """Return the amplitudes of the two transmitted modes for incident mode `j`, shape (N,) each."""
        if j not in self._transmission:
            if not self._gram:
                self._gram = [[bilinear(i, t) for t in self.transmitted] for i in self.incident]
            g = self._gram
            scale = self.incident[j].norm() / (g[0][0] * g[1][1] - g[0][1] * g[1][0])
            column = (g[1][1] * scale, -g[1][0] * scale) if j == 0 else (-g[0][1] * scale, g[0][0] * scale)
            self._transmission[j] = column
        return self._transmission[j]

    def reflection(self, i: int, j: int) -> Field:
        """Return the amplitude of reflected mode `i` for incident mode `j`, shape (N,)."""
        t = self.transmission(j)
        wave = self.reflected[i]
        projected = t[0] * bilinear(wave, self.transmitted[0]) + t[1] * bilinear(wave, self.transmitted[1])
        return projected / wave.norm()

    def grazing(self, lengths: list[Real]) -> NDArray[np.intp]:
        """Return the rays for which `reflection` loses digits, by the lengths of both reflected fields, shape (N,)."""
        smallest = np.minimum(*(np.abs(w.norm()) / n**2 for w, n in zip(self.reflected, lengths, strict=True)))
        return np.flatnonzero(smallest < GRAZING)


@dataclass(slots=True)
class ContinuityFace(Face):
    """The waves at a face whose source is optically active: there g does not part them, and ψ is solved for.

    All four amplitudes come from the 4×4 system [ψ₂⁺ −ψ₁⁻] a = ψ_in.
    """

    _solved: Field | None = None

    def transmission(self, j: int) -> tuple[Field, Field]:
        """Return the amplitudes of the two transmitted modes for incident mode `j`, shape (N,) each."""
        solved = self._amplitudes()
        return solved[:, 0, j], solved[:, 1, j]

    def reflection(self, i: int, j: int) -> Field:
        """Return the amplitude of reflected mode `i` for incident mode `j`, shape (N,)."""
        return self._amplitudes()[:, 2 + i, j]

    def grazing(self, lengths: list[Real]) -> NDArray[np.intp]:  # noqa: ARG002
        """Return no rays: the system holds at grazing incidence too."""
        return np.empty(0, np.intp)

    def _amplitudes(self) -> Field:
        """Return all amplitudes, shape (N, 4, 2)."""
        if self._solved is None:
            outgoing = _tangential((*self.transmitted, *self.reflected))
            size = np.sqrt(np.sum(np.abs(outgoing) ** 2, axis=1))
            matrix = outgoing / size[:, None, :]
            matrix[:, :, 2:] *= -1.0
            incoming = _tangential(self.incident)
            # Where a grazing wave on either side is the same one the system is singular, and consistent.
            singular = np.abs(np.linalg.det(matrix)) < SINGULAR
            safe = np.where(singular[:, None, None], np.eye(4), matrix)
            solved = np.linalg.solve(safe, incoming)
            rays = np.flatnonzero(singular)
            solved[rays] = np.einsum("nij,njk->nik", np.linalg.pinv(matrix[rays], rcond=SINGULAR), incoming[rays])
            self._solved = solved / size[:, :, None]
        return self._solved


def solve_face(source: FramedMedium, target: FramedMedium, source_evanescent: bool, target_evanescent: bool) -> Face:
    """Return the waves at each ray's face; amplitudes follow on demand.

    Parameters
    ----------
    source, target : FramedMedium
        The media on both sides, in the same frame, whose z points from `source` into `target`.
    source_evanescent, target_evanescent : bool
        Whether a wave of that medium may be evanescent in this batch; see `FramedMedium.pair`.
    """
    incident, reflected = source.both_pairs(source_evanescent)
    kind = ContinuityFace if isinstance(source, FramedActive) else Face
    return kind(source.frame, incident, reflected, target.pair(+1, target_evanescent))


@dataclass(frozen=True, slots=True)
class Scattering:
    """What a face does to the two waves that come in from one side.

    Parameters
    ----------
    incident, reflected, transmitted : pair of Wave
        Modes of isotropic media: s, p; of uniaxial ones: ordinary, extraordinary; of biaxial and of optically active
        ones: slow, then fast or a second slow one. Incident waves that are evanescent cannot come in: their columns of
        amplitudes and powers are NaN.
    amplitude_reflected, amplitude_transmitted : nested list of Field
        [i][j]: amplitude of outgoing mode i for incident mode j of unit field, shape (N,).
    power_reflected, power_transmitted : nested list of Real
        [i][j]: fraction of the incident normal flux, shape (N,); 0 for an evanescent outgoing wave.
    """

    incident: tuple[Wave, Wave]
    reflected: tuple[Wave, Wave]
    transmitted: tuple[Wave, Wave]
    amplitude_reflected: Amplitudes
    amplitude_transmitted: Amplitudes
    power_reflected: list[list[Real]]
    power_transmitted: list[list[Real]]

    def replace(self, rays: NDArray[np.intp], other: Scattering) -> None:
        """Put another answer in place of that of some rays; modes are matched by their wave vectors, names stay."""
        swaps = []
        for own, new in (
            (self.incident, other.incident),
            (self.reflected, other.reflected),
            (self.transmitted, other.transmitted),
        ):
            k = [wave.k[:, rays] + 1j * wave.k_imag[:, rays] for wave in own]
            apart = [[np.sum(np.abs(a - (w.k + 1j * w.k_imag)), axis=0) for w in new] for a in k]
            swap = apart[0][1] + apart[1][0] < apart[0][0] + apart[1][1]
            swaps.append(swap)
            for place, wave in enumerate(own):
                for name in ("k", "k_imag", "field", "ray", "index", "propagating", "flux"):
                    values = getattr(wave, name)
                    chosen = np.where(swap, getattr(new[1 - place], name), getattr(new[place], name))
                    values[..., rays] = chosen
        tables: Sequence[tuple[list[list[Any]], list[list[Any]], BoolArray]] = (
            (self.amplitude_reflected, other.amplitude_reflected, swaps[1]),
            (self.amplitude_transmitted, other.amplitude_transmitted, swaps[2]),
            (self.power_reflected, other.power_reflected, swaps[1]),
            (self.power_transmitted, other.power_transmitted, swaps[2]),
        )
        for mine, theirs, out in tables:
            for i, j in itertools.product((0, 1), (0, 1)):
                column = [np.where(swaps[0], theirs[row][1 - j], theirs[row][j]) for row in (0, 1)]
                mine[i][j] = _replaced(mine[i][j], rays, np.where(out, column[1 - i], column[i]))


def scatter(normal: ArrayLike, tangential_k: ArrayLike, source: Medium, target: Medium) -> Scattering:
    """Return the waves, amplitudes and powers at the plane face between two media.

    Parameters
    ----------
    normal : array_like
        Unit normal from `source` into `target`, shape (3,) or (3, N).
    tangential_k : array_like
        Part of the incident wave vector in the face, in units of 2π/λ, shape (3, N).
    source, target : Medium
        The media; their indices at each ray's wavelength.

    Raises
    ------
    InputError
        A normal that is not a unit vector, a tangential_k that is not finite or not tangential.

    Notes
    -----
    At exactly grazing incidence the incident wave carries no flux through the face; the powers given are the limit:
    it is reflected whole.
    """
    z, kt = _checked(normal, tangential_k)
    frame = interface_frame(z, kt)
    here, there = framed(source, frame), framed(target, frame)
    result, slant = _scattering(frame, here, there)
    rays = np.flatnonzero((slant < SLANTING) | here.crowded() | there.crowded())
    if rays.size:
        part = frame.take(rays)
        again, _ = _scattering(part, _steady(here.take(rays)), _steady(there.take(rays)))
        result.replace(rays, again)
    return result


def _steady(medium: FramedMedium) -> FramedMedium:
    """Return the same medium with waves that keep their energy to rounding however much they slant.

    The closed forms know a wave that all but grazes within rounding over its flux, and its reversal apart from it. As
    an active medium without activity the two are found together, from the space they share.
    """
    if medium.medium.is_isotropic or isinstance(medium, FramedActive):
        return medium
    return FramedActive(medium.medium.active(np.zeros((3, 3))), medium.frame)


def _scattering(frame: InterfaceFrame, here: FramedMedium, there: FramedMedium) -> tuple[Scattering, Real]:
    """Return the answer of `scatter`, and the least |g(ψ, ψ)|/|E|² of the waves of anisotropic media, shape (N,)."""
    incoming, outgoing = here.propagating(), there.propagating()
    face = solve_face(here, there, not (incoming[0] & incoming[1]).all(), not (outgoing[0] & outgoing[1]).all())

    slant = np.full(frame.kappa.shape, np.inf)
    sides = ((face.incident, incoming, here), (face.reflected, incoming, here), (face.transmitted, outgoing, there))
    scale: list[list[Real]] = []
    waves: list[tuple[Wave, Wave]] = []
    for modes, free, medium in sides:
        lengths = [_field_length(mode) for mode in modes]
        first, second = (_wave(mode, length, frame, ok) for mode, length, ok in zip(modes, lengths, free, strict=True))
        waves.append((first, second))
        scale.append(lengths)
        if not medium.medium.is_isotropic and not isinstance(medium, FramedActive):
            for mode, length in zip(modes, lengths, strict=True):
                slant = np.minimum(slant, np.abs(mode.norm()) / length**2)

    t, r = _amplitudes(face, scale)
    for j in (0, 1):
        if not incoming[j].all():
            for amplitude in (t, r):
                for i in (0, 1):
                    amplitude[i][j] = np.where(incoming[j], amplitude[i][j], np.nan)
    powers = _powers(r, waves[1], waves[0], True), _powers(t, waves[2], waves[0], False)
    return Scattering(waves[0], waves[1], waves[2], r, t, *powers), slant


def _amplitudes(face: Face, scale: list[list[Real]]) -> tuple[Amplitudes, Amplitudes]:
    """Return transmitted and reflected amplitudes between waves of unit field."""
    grazing = face.grazing(scale[1])
    with np.errstate(divide="ignore", invalid="ignore"):  # grazing rays are solved anew below
        t = [[face.transmission(j)[i] * scale[2][i] / scale[0][j] for j in (0, 1)] for i in (0, 1)]
        r = [[face.reflection(i, j) * scale[1][i] / scale[0][j] for j in (0, 1)] for i in (0, 1)]
    if grazing.size:
        solved = _solve_4x4(face, scale, grazing)
        for i in (0, 1):
            for j in (0, 1):
                t[i][j] = _replaced(t[i][j], grazing, solved[:, i, j])
                r[i][j] = _replaced(r[i][j], grazing, solved[:, 2 + i, j])
    return t, r


def _solve_4x4(face: Face, scale: list[list[Real]], rays: np.ndarray) -> Field:
    """Solve [ψ₂⁺ −ψ₁⁻] a = ψ_in for the few rays where a reflected wave grazes; shape (rays, 4, 2)."""
    ahead, back = (_tangential(m, n, rays) for m, n in ((face.transmitted, scale[2]), (face.reflected, scale[1])))
    incoming = _tangential(face.incident, scale[0], rays)
    matrix = np.concatenate((ahead, -back), axis=-1)
    # Where both of a pair's fields fall together (a grazing wave equals its own reflection) the system is singular
    # and consistent; the least-norm solution splits nothing and keeps continuity.
    return np.stack([np.linalg.lstsq(m, v, rcond=1e-13)[0] for m, v in zip(matrix, incoming, strict=True)])


def _tangential(modes: Sequence[Mode], lengths: Sequence[Real] | None = None, rays: Rays = ALL) -> Field:
    """Return ψ of some modes, divided by their lengths, as columns, shape (rays, 4, modes)."""
    columns = []
    for place, mode in enumerate(modes):
        parts = [np.zeros(mode.q.shape) if v is None else v for v in (mode.ex, mode.ey, mode.hx, mode.hy)]
        column = np.stack([np.broadcast_to(v, mode.q.shape)[rays] for v in parts], axis=-1)
        columns.append(column if lengths is None else column / lengths[place][rays][:, None])
    return np.stack(columns, axis=-1)


def _replaced(values: Field, rays: np.ndarray, new: Field) -> Field:
    result = values.astype(np.result_type(values, new))
    result[rays] = new
    return result


def _powers(amplitude: Amplitudes, out: tuple[Wave, Wave], inc: tuple[Wave, Wave], reflected: bool) -> list[list[Real]]:
    powers: list[list[Real]] = []
    for i in (0, 1):
        row = []
        for j in (0, 1):
            grazing = inc[j].propagating & (inc[j].flux <= GRAZING * inc[j].index)
            flux = np.where(grazing, 1.0, inc[j].flux)
            with np.errstate(divide="ignore", invalid="ignore"):  # evanescent incident waves: NaN is the answer
                power = np.abs(amplitude[i][j]) ** 2 * np.abs(out[i].flux) / flux
            row.append(np.where(grazing, float(reflected and i == j), power))
        powers.append(row)
    return powers


def _field_length(mode: Mode) -> Real:
    total = np.zeros(mode.q.shape)
    for component in (mode.ex, mode.ey, mode.ez):
        if component is not None:
            total = total + np.abs(component) ** 2
    return np.sqrt(total)


def _wave(mode: Mode, length: Real, frame: InterfaceFrame, free: BoolArray) -> Wave:
    zero = np.zeros(mode.q.shape)
    ex, ey, ez = ((zero if v is None else v) / length for v in (mode.ex, mode.ey, mode.ez))
    k = frame.world(frame.kappa, None, _real(mode.q))
    sideways = mode.ray[1]
    ray = frame.world(_real(mode.ray[0]), None if sideways is None else _real(sideways), _real(mode.ray[2]))
    with np.errstate(invalid="ignore", divide="ignore"):  # an evanescent wave has no ray
        ray = np.where(free, ray / np.sqrt(dot(ray, ray)), np.nan)
    return Wave(
        mode=mode.names(),
        k=k,
        k_imag=frame.z * np.where(free, 0.0, np.imag(mode.q)),
        field=frame.world(ex, ey, ez).astype(np.complex128),
        ray=ray,
        index=np.where(free, np.sqrt(dot(k, k)), np.nan),
        propagating=free.copy(),
        flux=np.where(free, mode.flux() / length**2, 0.0),
    )


def _real(values: Field) -> Real:
    return np.asarray(values.real, np.float64)


def _checked(normal: ArrayLike, tangential_k: ArrayLike) -> tuple[Real, Real]:
    kt = np.asarray(tangential_k, np.float64)
    if kt.ndim != 2 or kt.shape[0] != 3 or not np.all(np.isfinite(kt)):
        raise InputError.at("/tangential_k", "the tangential wave vector must be finite, shape (3, N)")
    z = np.asarray(normal, np.float64)
    if z.shape not in ((3,), kt.shape) or not np.all(np.abs(np.sum(z * z, axis=0) - 1.0) <= 2 * UNIT_TOLERANCE):
        raise InputError.at("/normal", "the normal must be a unit vector, shape (3,) or (3, N)")
    z = np.ascontiguousarray(np.broadcast_to(z[:, None] if z.ndim == 1 else z, kt.shape))
    off = dot(kt, z)
    if np.any(np.abs(off) > NORMAL_PART):
        raise InputError.at("/tangential_k", "the tangential wave vector has a component along the normal")
    return z, kt - off * z
