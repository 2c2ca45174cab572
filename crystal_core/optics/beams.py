"""The beams of a plate: waves of unit flux between faces, and what the way through the plate does to them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from crystal_core.optics.arrays import BoolArray, Complex, Field, Real
from crystal_core.optics.berreman import flux_product, plate_matrix
from crystal_core.optics.layer_waves import Pair, carried, phase_matrix, split
from crystal_core.optics.medium import Medium
from crystal_core.optics.two_ports import coherency_map, product

__all__ = ["Beams", "PlateBeams", "plate_beams"]

TOGETHER = 1e-12
"""Distance of two q up to which two waves have no retardation at any thickness: what is less is rounding."""

GRAZING = 1e-3
"""Distance of a forward and a backward q from which on they count as well apart."""


@dataclass(frozen=True, slots=True)
class Beams:
    """The two beams of a plate that go one way.

    Parameters
    ----------
    q : Complex
        Normal parts of the wave vectors without absorption, shape (N, 2).
    psi : Complex
        Tangential fields as columns, of unit flux and without exchange of energy, shape (N, 4, 2).
    carries : BoolArray
        Which carry energy, shape (N, 2); the others, evanescent, only help to make the fields at a face continuous.
    amplitudes : Complex
        What the way through the plate makes of the two amplitudes, shape (N, 2, 2); 0 where nothing is carried.
    kept : Real
        What each beam by itself keeps of its power on the way, shape (N, 2).
    """

    q: Complex
    psi: Complex
    carries: BoolArray
    amplitudes: Complex
    kept: Real

    def together(self) -> BoolArray:
        """Return where the two waves agree and keep their phase relation at any thickness, shape (N,)."""
        return self.carries.all(axis=1) & (np.abs(self.q[:, 0] - self.q[:, 1]) <= TOGETHER)

    def averaged(self) -> Complex:
        """Return the map of coherency matrices through the plate, all phases of the two beams averaged, (N, 4, 4).

        Each beam by itself is absorbed to first order. Two waves that agree are one beam, and stay as polarized as
        they were.
        """
        whole = coherency_map(self.amplitudes)
        apart = np.zeros_like(whole)
        apart[:, 0, 0], apart[:, 3, 3] = self.kept[:, 0], self.kept[:, 1]
        return np.where(self.together()[:, None, None], whole, apart)


@dataclass(frozen=True, slots=True)
class PlateBeams:
    """All four beams of a plate."""

    forward: Beams
    backward: Beams


def plate_beams(medium: Medium, wavelength_nm: Real, kx: Real, ky: Real, phase: Real) -> PlateBeams:
    """Return the beams of a plate.

    Faces see the medium without its absorption, so the beams there are the waves of ε′, whose fluxes simply add. On
    their way absorption changes them and couples them (see `_absorbed`).

    Parameters
    ----------
    medium : Medium
        At each wavelength.
    wavelength_nm, kx, ky : Real
        Wavelength, nm, and tangential wave vector in units of k0, shape (N,).
    phase : Real
        k0 d, shape (N,).
    """
    clear = plate_matrix(medium.transparent(), wavelength_nm, kx, ky)
    waves = split(clear)
    forward, backward = _clear(waves.forward, clear, phase, 1), _clear(waves.backward, clear, phase, -1)
    if medium.absorption_per_mm is None:
        return PlateBeams(forward, backward)
    change = plate_matrix(medium, wavelength_nm, kx, ky) - clear
    return PlateBeams(_absorbed(forward, backward, change, phase, 1), _absorbed(backward, forward, change, phase, -1))


def _clear(pair: Pair, clear: Field, phase: Real, sign: int) -> Beams:
    q, psi, carries = carried(pair, clear, sign)
    amplitudes = np.zeros((phase.size, 2, 2), np.complex128)
    for i in (0, 1):
        amplitudes[:, i, i] = np.where(carries[:, i], np.exp(1j * sign * phase * q[:, i].real), 0.0)
    return Beams(q, psi, carries, amplitudes, carries.astype(np.float64))


def _absorbed(beams: Beams, others: Beams, change: Field, phase: Real, sign: int) -> Beams:
    """Return the beams with the absorption of their way, exp(i k0 d Q).

    Q is the matrix of Δ between the two beams, with what the beams that go the other way add to it by perturbation of
    second order (P. O. Löwdin, J. Chem. Phys. 19, 1396 (1951); the mean of both beams' denominators). The coupling of
    the two beams near an optic axis is in Q in full; what is left out is of third order, (ε″/ε′)³. In exchange the way
    back is exactly the reverse of the way there, and as the second order is Hermitian no light is ever gained.

    Where one wave carries and the other is evanescent, the one is absorbed to first order.

    Parameters
    ----------
    beams, others : Beams
        Those that go along sign · z and those that go the other way.
    change : Field
        Berreman's matrix with absorption less that without, shape (N, 4, 4).
    phase : Real
        k0 d, shape (N,).
    sign : int
        +1 or −1.
    """
    own = flux_product(beams.psi, product(change, beams.psi))
    carries = beams.carries[:, :, None] & beams.carries[:, None, :]
    q_matrix = np.where(carries, sign * own, 0.0)
    for i in (0, 1):
        q_matrix[:, i, i] += np.where(beams.carries[:, i], beams.q[:, i].real, 0.0)
    four = np.asarray(beams.carries.all(axis=1) & others.carries.all(axis=1))
    there = flux_product(beams.psi, product(change, others.psi))
    back = flux_product(others.psi, product(change, beams.psi))
    coupling = (there - np.conj(back).swapaxes(1, 2)) / 2j
    gaps = beams.q.real[:, :, None] - others.q.real[:, None, :]
    # Grazing waves, whose q fall together, cannot be told by perturbation: first order for them.
    gaps = np.where(four[:, None, None] & (np.abs(gaps) > GRAZING), gaps, np.inf)
    weights = 0.5 * (1.0 / gaps[:, :, None, :] + 1.0 / gaps[:, None, :, :])
    q_matrix += (coupling[:, :, None, :] * np.conj(coupling[:, None, :, :]) * weights).sum(axis=3)
    amplitudes = np.where(carries, phase_matrix(q_matrix, sign * phase, lossless=False), 0.0)
    levels = np.stack((q_matrix[:, 0, 0], q_matrix[:, 1, 1]), axis=1)
    kept = np.where(beams.carries, np.exp(-2.0 * sign * phase[:, None] * levels.imag), 0.0)
    return replace(beams, amplitudes=amplitudes, kept=kept)
