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
    """

    q: Complex
    psi: Complex
    carries: BoolArray
    amplitudes: Complex

    def together(self) -> BoolArray:
        """Return where the two waves agree and keep their phase relation at any thickness, shape (N,)."""
        return self.carries.all(axis=1) & (np.abs(self.q[:, 0] - self.q[:, 1]) <= TOGETHER)

    def averaged(self) -> Complex:
        """Return the map of coherency matrices through the plate, all phases of the two beams averaged, (N, 4, 4).

        Each beam by itself loses what its own diagonal element says, to first order in the absorption. Two waves that
        agree are one beam, and stay as polarized as they were.
        """
        whole = coherency_map(self.amplitudes)
        apart = np.zeros_like(whole)
        apart[:, 0, 0], apart[:, 3, 3] = whole[:, 0, 0], whole[:, 3, 3]
        return np.where(self.together()[:, None, None], whole, apart)


@dataclass(frozen=True, slots=True)
class PlateBeams:
    """All four beams of a plate."""

    forward: Beams
    backward: Beams


def plate_beams(medium: Medium, wavelength_nm: Real, kx: Real, ky: Real, phase: Real) -> PlateBeams:
    """Return the beams of a plate.

    Faces see the medium without its absorption, so the beams there are the waves of ε′, whose fluxes simply add. On
    their way they are the exact waves of ε′ + i ε″, in the basis that is nearest to them (see `_absorbed`).

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
    halves = [
        _clear_beams(pair, clear, sign * phase, sign) for pair, sign in ((waves.forward, 1), (waves.backward, -1))
    ]
    if medium.absorption_per_mm is not None:
        full = plate_matrix(medium, wavelength_nm, kx, ky)
        waves = split(full)
        halves = [
            _absorbed(beams, pair, clear, full, sign * phase, sign)
            for beams, pair, sign in zip(halves, (waves.forward, waves.backward), (1, -1), strict=True)
        ]
    return PlateBeams(*halves)


def _clear_beams(pair: Pair, clear: Field, phase: Real, sign: int) -> Beams:
    q, psi, carries = carried(pair, clear, sign)
    amplitudes = np.zeros((q.shape[0], 2, 2), np.complex128)
    for i in (0, 1):
        amplitudes[:, i, i] = np.where(carries[:, i], np.exp(1j * phase * q[:, i].real), 0.0)
    return Beams(q, psi, carries, amplitudes)


def _absorbed(beams: Beams, pair: Pair, clear: Field, full: Field, phase: Real, sign: int) -> Beams:
    """Return the beams with the absorption of their way.

    Where both carry, the space of the two waves of ε′ + i ε″ gets the basis of unit flux that is nearest to the waves
    of ε′ (by the polar decomposition). In it the way is exp(i k0 d Q) with the exact Q of the absorbing medium,
    coupled modes near an optic axis included, and since Q has no negative dissipation no light is ever gained. Where
    one wave carries and the other is evanescent, the one is absorbed to first order.
    """
    first_order = sign * flux_product(beams.psi, product(full - clear, beams.psi))
    amplitudes = np.zeros_like(beams.amplitudes)
    for i in (0, 1):
        q = beams.q[:, i].real + np.where(beams.carries[:, i], first_order[:, i, i], 0.0)
        amplitudes[:, i, i] = np.where(beams.carries[:, i], np.exp(1j * phase * q), 0.0)
    both = np.flatnonzero(beams.carries.all(axis=1))
    if both.size:
        basis = pair.basis[both]
        size, turn = np.linalg.eigh(sign * flux_product(basis, basis))
        fit = size[:, 0] > 0
        both, basis, size = both[fit], basis[fit], size[fit]
        basis = product(basis, turn[fit]) / np.sqrt(size)[:, None, :]
        left, _, right = np.linalg.svd(sign * flux_product(beams.psi[both], basis))
        basis = product(basis, np.conj(product(left, right)).swapaxes(1, 2))
        q_matrix = sign * flux_product(basis, product(full[both], basis))
        amplitudes[both] = phase_matrix(q_matrix, phase[both], lossless=False)
    return replace(beams, amplitudes=amplitudes)
