"""Where in a pixel, and at which wavelengths, the samples lie; and the random numbers of the rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.spectra.quadrature import WavelengthSet, stratified_wavelengths

__all__ = ["Pass", "passes", "random_numbers"]

Real = NDArray[np.float64]


@dataclass(frozen=True)
class Pass:
    """One position in every pixel, with its wavelengths.

    Parameters
    ----------
    x, y : float
        Position in the pixel, in [0, 1), from its left and top edge.
    footprint : float
        Side of the square, in pixels, that the position stands for.
    wavelengths : WavelengthSet
        Wavelengths and weights.
    half : int
        0 or 1: which of the two interleaved halves of the level it belongs to; their difference estimates the error.
    """

    x: float
    y: float
    footprint: float
    wavelengths: WavelengthSet
    half: int


def passes(positions: int, wavelengths: int, seed: int) -> tuple[Pass, ...]:
    """Return the passes of a level.

    The positions are the first points of the (0, 2)-sequence of van der Corput and Sobol' (T. Kollig, A. Keller,
    Computer Graphics Forum 21(3), 2002), moved by a digital shift that keeps them stratified, each in the centre of
    its stratum: 4 of them tile a pixel 2 × 2. The same in every pixel, so that a smooth picture stays smooth.

    Parameters
    ----------
    positions : int
        A power of two.
    wavelengths : int
        Per position; the sets of all positions interleave.
    seed : int
        Chooses the digital shift.
    """
    bits = positions.bit_length() - 1
    shift_x, shift_y = _digital_shift(seed, positions)
    sets = stratified_wavelengths(positions, wavelengths)
    result = []
    for i in range(positions):
        x = _van_der_corput(i, bits) ^ shift_x
        y = _sobol(i, bits) ^ shift_y
        result.append(
            Pass(
                (x + 0.5) / positions,
                (y + 0.5) / positions,
                positions**-0.5,
                sets[_van_der_corput(i, bits)],  # reversed bits again: each half is spread over the wavelengths too
                (i >> 1) & 1 if positions > 2 else i & 1,
            )
        )
    return tuple(result)


def random_numbers(seed: int, frame: int, tile: int, level: int) -> np.random.Generator:
    """Return the generator of one level of one tile: Philox, keyed by the seed, counted from its place.

    Whoever renders the tile, and in whatever order, draws the same numbers.
    """
    return np.random.Generator(np.random.Philox(key=np.array((seed, 0), np.uint64), counter=(0, level, tile, frame)))


def _digital_shift(seed: int, positions: int) -> tuple[int, int]:
    rng = np.random.Generator(np.random.Philox(key=np.array((seed, 1), np.uint64), counter=(0, positions, 0, 0)))
    return int(rng.integers(positions)), int(rng.integers(positions))


def _van_der_corput(i: int, bits: int) -> int:
    return int(f"{i:0{bits}b}"[::-1], 2) if bits else 0


def _sobol(i: int, bits: int) -> int:
    """Return the second Sobol' coordinate of index i, as an integer of `bits` bits."""
    result = 0
    direction = 1 << 31
    for bit in range(bits):
        if i >> bit & 1:
            result ^= direction
        direction ^= direction >> 1
    return result >> (32 - bits) if bits else 0
