"""Stacks of parallel plates between isotropic half-spaces: Jones and Mueller matrices, reflected and transmitted.

Three ways to add the beams that the faces send to and fro (`plate_stack`):

**exact**
    All fields add, with all multiple beams, as between polished faces in light of one wavelength. Berreman's 4 × 4
    matrices with the full complex permittivity; plates are joined as scattering matrices, so that neither strong
    absorption nor evanescent waves overflow.

**single-pass**
    What a thick or rough sample does. Light that has been reflected inside has lost its phase relation to the rest;
    the two waves of a plate keep theirs. Let t, r be a face's Jones matrices between waves of unit flux and P the
    phases (and absorption) of a plate's two waves, exp(i k0 q_j d) with q_j the normal part of the wave vector. The
    Jones matrices are those of the direct path, J_t = t_n P_n … t_1 P_1 t_0, J_r = r_0 of the first face. The Mueller
    matrices are the sums over *all* sequences of transmissions and reflections, each sequence a Mueller matrix
    M(… t P r P t …) of its own: intensities, not fields, of different sequences add. The sum is taken in closed form.
    Faces see ε′ alone; a plate's way couples its two waves by ε″ (`optics.beams`).

**incoherent**
    As single-pass, but the phases of the two waves of a plate are averaged as well: on each passage of a plate the
    coherency matrix in the basis of its two waves keeps its diagonal only. Waves that agree in q, as in isotropic
    plates or along an optic axis, have no retardation at any thickness and stay together. Each wave is absorbed by
    its own coefficient (first order in ε″). A true average over thickness still lets two sequences interfere that pass
    each wave equally often in another order; this sum does not.

In the two latter an evanescent wave carries nothing from face to face: light that is totally reflected at one face does
not tunnel to the next, which is an effect of both faces' fields together and belongs to "exact". So each face by itself
keeps the energy, and R + T = 1 for stacks without absorption.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.errors import InputError
from crystal_core.optics.arrays import BoolArray, Complex, Field, Real, dot
from crystal_core.optics.beams import Beams, PlateBeams, plate_beams
from crystal_core.optics.berreman import plate_matrix
from crystal_core.optics.frames import interface_frame
from crystal_core.optics.layer_waves import Split, phase_matrix, split
from crystal_core.optics.medium import Medium
from crystal_core.optics.mueller import mueller
from crystal_core.optics.slices import sliced_plate
from crystal_core.optics.two_ports import TwoPort, coherency_map, mueller_of_map, product

__all__ = ["Coherence", "Plate", "StackOptics", "plate_stack"]

Coherence = Literal["exact", "single-pass", "incoherent"]
"""How the beams of a stack add."""

NEARLY_CRITICAL = 1e-3
"""Distance of a forward and a backward q below which a stack is put together from thin slices instead."""

NORMAL_PART = 1e-9
"""How long the normal part of a tangential wave vector may be."""


@dataclass(frozen=True, slots=True)
class Plate:
    """A plane-parallel plate.

    Parameters
    ----------
    medium : Medium
        At each wavelength, directions in the frame of the stack: z is the normal, light goes along +z.
    thickness_um : float
        Thickness, µm, above 0.

    Raises
    ------
    InputError
        A thickness that is not finite and positive.
    """

    medium: Medium
    thickness_um: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.thickness_um) and self.thickness_um > 0):
            raise InputError.at("/thickness_um", "a plate's thickness must be finite and above 0")


@dataclass(frozen=True, slots=True)
class StackOptics:
    """What a stack makes of light that comes in along +z.

    Frames are right-handed, (x, y, propagation): the components are (p, s) of ``docs/conventions.md``, at normal
    incidence those along the lab's x and y. Of reflected light p points the other way along x, so that at normal
    incidence its frame is (−x, y, −z).

    Parameters
    ----------
    jones_transmitted, jones_reflected : Complex or None
        Flux-normalised, [i, j] from component j to component i, shape (2, 2, N). None for the incoherent sum; of the
        direct path only for a single pass.
    mueller_transmitted, mueller_reflected : Real
        Of all light, in shares of the incident flux, shape (4, 4, N).
    """

    jones_transmitted: Complex | None
    jones_reflected: Complex | None
    mueller_transmitted: Real
    mueller_reflected: Real


@dataclass(frozen=True, slots=True)
class Incidence:
    """Wavelengths with their tangential wave vectors, and the waves of the mount.

    Parameters
    ----------
    wavelength_nm, kx, ky : Real
        Shape (N,).
    mount : pair of Field
        Tangential fields of p and s as columns, of unit flux, forward and backward, shape (N, 4, 2).
    """

    wavelength_nm: Real
    kx: Real
    ky: Real
    mount: tuple[Field, Field]

    def phase(self, plate: Plate) -> Real:
        """Return k0 d, shape (N,)."""
        return 2e3 * np.pi * plate.thickness_um / self.wavelength_nm

    def take(self, rays: NDArray[np.intp]) -> Incidence:
        """Return a selection."""
        forward, backward = self.mount
        return Incidence(self.wavelength_nm[rays], self.kx[rays], self.ky[rays], (forward[rays], backward[rays]))

    def matrix(self, plate: Plate) -> Field:
        """Return Berreman's matrix of a plate, shape (N, 4, 4)."""
        return plate_matrix(plate.medium, self.wavelength_nm, self.kx, self.ky)


def plate_stack(
    plates: Sequence[Plate],
    wavelength_nm: ArrayLike,
    mount_index: ArrayLike = 1.0,
    tangential_k: ArrayLike | None = None,
    coherent: Coherence = "exact",
) -> StackOptics:
    """Return the Jones and Mueller matrices of parallel plates between two half-spaces of one isotropic medium.

    Parameters
    ----------
    plates : sequence of Plate
        In the order in which the light meets them; none at all is the mount alone.
    wavelength_nm : array_like
        Vacuum wavelengths, nm, shape () or (N,).
    mount_index : array_like
        Index of the mount, shape () or (N,).
    tangential_k : array_like, optional
        Tangential wave vector in units of k0, shape (3,) or (3, N); normal incidence if left out.
    coherent : "exact", "single-pass" or "incoherent"
        How beams add; see the module.

    Raises
    ------
    InputError
        A wavelength or index that is not finite and positive; a tangential wave vector that is not finite, has a
        normal part, or is as long as the mount's index or longer; media whose shapes do not fit.

    Notes
    -----
    Precision of "exact": 1e-13 and 1e-15 k0 n d, whichever is more; energy is kept to 1e-13 beyond the nearly critical,
    where a wave of a plate has |q| below 5e-4 and the plates are put together from slices.
    """
    if coherent not in get_args(Coherence):
        raise InputError.at("/coherent", f"must be one of {', '.join(get_args(Coherence))}")
    incidence = _incidence(wavelength_nm, mount_index, tangential_k)
    for place, plate in enumerate(plates):
        shapes = {n.shape for n in plate.medium.indices} | {a.shape for a in plate.medium.absorption_per_mm or ()}
        if not shapes <= {(), incidence.kx.shape}:
            raise InputError.at(f"/plates/{place}", "a medium's indices must be one value or one per wavelength")
    if coherent == "exact":
        whole = _exact(plates, incidence)
        transmitted, reflected = _jones(whole.t), _jones(whole.r)
        return StackOptics(transmitted, reflected, mueller(transmitted), mueller(reflected))
    beams = [
        plate_beams(p.medium, incidence.wavelength_nm, incidence.kx, incidence.ky, incidence.phase(p)) for p in plates
    ]
    faces = _faces(beams, incidence)
    averaged = coherent == "incoherent"
    total = faces[0].intensities()
    for face, plate_ in zip(faces[1:], beams, strict=True):
        ways = (_way(plate_.forward, averaged), _way(plate_.backward, averaged))
        total = total.through(*ways).then(face.intensities())
    matrices = mueller_of_map(total.t), mueller_of_map(total.r)
    if averaged:
        return StackOptics(None, None, *matrices)
    direct = faces[0].t
    for face, plate_ in zip(faces[1:], beams, strict=True):
        direct = product(face.t, plate_.forward.amplitudes, direct)
    return StackOptics(_jones(direct), _jones(faces[0].r), *matrices)


def _exact(plates: Sequence[Plate], incidence: Incidence) -> TwoPort:
    layers = [split(incidence.matrix(plate)) for plate in plates]
    critical = np.zeros(incidence.kx.shape, np.bool_)
    for layer in layers:
        critical |= layer.separation < NEARLY_CRITICAL
    if not critical.any():
        return _joined(plates, layers, incidence)
    t, r, t_back, r_back = (np.empty((critical.size, 2, 2), np.complex128) for _ in range(4))
    for rays, sliced in ((np.flatnonzero(~critical), False), (np.flatnonzero(critical), True)):
        if not rays.size:
            continue
        here = incidence.take(rays)
        parts = [Plate(plate.medium.take(rays), plate.thickness_um) for plate in plates]
        if sliced:
            slabs = [sliced_plate(here.matrix(part), here.phase(part), here.mount) for part in parts]
            some = reduce(TwoPort.then, slabs)
        else:
            some = _joined(parts, [split(here.matrix(part)) for part in parts], here)
        t[rays], r[rays], t_back[rays], r_back[rays] = some.t, some.r, some.t_back, some.r_back
    return TwoPort(t, r, t_back, r_back)


def _joined(plates: Sequence[Plate], layers: Sequence[Split], incidence: Incidence) -> TwoPort:
    """Return the stack as faces and ways between them, fields and all."""
    before = incidence.mount
    whole: TwoPort | None = None
    for plate, layer in zip(plates, layers, strict=True):
        after = (layer.forward.basis, layer.backward.basis)
        face = TwoPort.face(before, after)
        whole = face if whole is None else whole.then(face)
        delta, phase = incidence.matrix(plate), incidence.phase(plate)
        lossless = plate.medium.absorption_per_mm is None
        whole = whole.through(
            phase_matrix(layer.forward.matrix(delta), phase, lossless),
            phase_matrix(layer.backward.matrix(delta), -phase, lossless),
        )
        before = after
    face = TwoPort.face(before, incidence.mount)
    return face if whole is None else whole.then(face)


def _faces(plates: Sequence[PlateBeams], incidence: Incidence) -> list[TwoPort]:
    """Return the faces between waves of unit flux; waves that carry nothing are neither received nor sent on."""
    everything = np.ones((incidence.kx.size, 2), np.bool_)
    before, before_carries = incidence.mount, (everything, everything)
    faces = []
    for plate in (*plates, None):
        after, after_carries = incidence.mount, (everything, everything)
        if plate is not None:
            after = (plate.forward.psi, plate.backward.psi)
            after_carries = (plate.forward.carries, plate.backward.carries)
        face = TwoPort.face(before, after)
        faces.append(
            TwoPort(
                _between(face.t, after_carries[0], before_carries[0]),
                _between(face.r, before_carries[1], before_carries[0]),
                _between(face.t_back, before_carries[1], after_carries[1]),
                _between(face.r_back, after_carries[0], after_carries[1]),
            )
        )
        before, before_carries = after, after_carries
    return faces


def _between(amplitudes: Complex, outgoing: BoolArray, incoming: BoolArray) -> Complex:
    return np.where(outgoing[:, :, None] & incoming[:, None, :], amplitudes, 0.0)


def _way(beams: Beams, averaged: bool) -> Complex:
    return beams.averaged() if averaged else coherency_map(beams.amplitudes)


def _jones(blocks: Complex) -> Complex:
    """Return matrices (N, 2, 2) as (2, 2, N)."""
    return np.ascontiguousarray(np.moveaxis(blocks, 0, 2))


def _incidence(wavelength_nm: ArrayLike, mount_index: ArrayLike, tangential_k: ArrayLike | None) -> Incidence:
    wavelength = np.atleast_1d(np.asarray(wavelength_nm, np.float64))
    n = np.asarray(mount_index, np.float64)
    kt = np.zeros(3) if tangential_k is None else np.asarray(tangential_k, np.float64)
    if wavelength.ndim != 1 or not np.all(np.isfinite(wavelength) & (wavelength > 0)):
        raise InputError.at("/wavelength_nm", "wavelengths must be finite and positive, shape () or (N,)")
    if n.shape not in ((), wavelength.shape) or not np.all(np.isfinite(n) & (n > 0)):
        raise InputError.at("/mount_index", "the mount's index must be finite and positive, one or one per wavelength")
    if kt.shape not in ((3,), (3, wavelength.size)) or not np.all(np.isfinite(kt)):
        raise InputError.at("/tangential_k", "the tangential wave vector must be finite, shape (3,) or (3, N)")
    if np.any(np.abs(kt[2]) > NORMAL_PART):
        raise InputError.at("/tangential_k", "the tangential wave vector has a component along the normal z")
    wide = np.zeros((3, wavelength.size))
    wide[:2] = kt[:2] if kt.ndim == 2 else kt[:2, None]
    q2 = n * n - dot(wide, wide)
    if np.any(q2 <= 0):
        raise InputError.at("/tangential_k", "the tangential wave vector must be shorter than the mount's index")
    normal = np.zeros_like(wide)
    normal[2] = 1.0
    frame = interface_frame(normal, wide)
    return Incidence(wavelength, wide[0], wide[1], (_mount(frame.x, n, np.sqrt(q2)), _mount(frame.x, n, -np.sqrt(q2))))


def _mount(x: Real, n: Real, q: Real) -> Field:
    """Return ψ = (E_x, E_y, H_x, H_y) of p and s as columns, 2 |(E × H)_z| = 1, shape (N, 4, 2).

    p = (q, 0, −κ)/n with H = n y, s = y with H = (−q, 0, κ), in the frame of incidence.
    """
    cos, sin = x[0], x[1]
    p = np.stack((q / n * cos, q / n * sin, -n * sin, n * cos), axis=1)
    s = np.stack((-sin, cos, -q * cos, -q * sin), axis=1)
    return np.stack((p, s), axis=2) / np.sqrt(2.0 * np.abs(q))[:, None, None]
