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
    column, row : int
        Cell of the position in pixel (0, 0), of `side` × `side` cells.
    side : int
        Cells a side.
    wavelengths : WavelengthSet
        Wavelengths and weights.
    half : int
        0 or 1: the colour of that cell on a chessboard; the difference of the two halves estimates the error.
    """

    column: int
    row: int
    side: int
    wavelengths: WavelengthSet
    half: int

    def positions(self, across: Real, down: Real) -> tuple[Real, Real]:
        """Return the position in pixels of columns `across` and rows `down`, in pixels from the picture's top left.

        From pixel to pixel the pass moves on by a cell, and from side to side pixels by a cell the other way too, so
        that along a row as well as along a column it comes through all cells. One cell for all pixels would shift the
        colours of a picture against each other; one row of cells for a row of pixels would colour fine lines along it.
        """
        x = (self.column + across + down // self.side) % self.side
        y = (self.row + down + across // self.side) % self.side
        return across + (x + 0.5) / self.side, down + (y + 0.5) / self.side


def passes(side: int, wavelengths: int, seed: int) -> tuple[Pass, ...]:
    """Return the passes of a level: the centres of the side × side cells of a pixel.

    Textures are averaged over just such a cell, so the positions tile the pixel and see each bit of print once; no
    random offset, so a smooth picture stays smooth.

    Parameters
    ----------
    side : int
        Cells a side, ≥ 2 and even.
    wavelengths : int
        Per position; the sets of all positions interleave.
    seed : int
        Deals the sets of wavelengths out to the cells.
    """
    count = side * side
    sets = stratified_wavelengths(count, wavelengths)
    random = np.random.Generator(np.random.Philox(key=np.array((seed, 1), np.uint64), counter=(0, side, 0, 0)))
    dealt = random.permutation(count)
    return tuple(Pass(i % side, i // side, side, sets[dealt[i]], (i % side + i // side) & 1) for i in range(count))


def random_numbers(seed: int, frame: int, tile: int, level: int) -> np.random.Generator:
    """Return the generator of one level of one tile: Philox, keyed by the seed, counted from its place.

    Whoever renders the tile, and in whatever order, draws the same numbers.
    """
    return np.random.Generator(np.random.Philox(key=np.array((seed, 0), np.uint64), counter=(0, level, tile, frame)))
