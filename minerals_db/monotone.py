"""Monotone cubics through measured points: they rise and fall where the points do, and nowhere else.

F. N. Fritsch, J. Butland, A method for constructing local monotone piecewise cubic interpolants, SIAM J. Sci. Stat.
Comput. 5, 300-304 (1984), doi:10.1137/0905021: what SciPy calls PCHIP. Written out here because the import of SciPy's
takes ten times as long as reading all the data.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = ["MonotoneCubics"]

FloatArray = npt.NDArray[np.float64]


class MonotoneCubics:
    """The cubics between points.

    Parameters
    ----------
    knots, values : float64 array, shape (N,)
        Abscissas, rising, and ordinates; N at least 2.
    """

    def __init__(self, knots: FloatArray, values: FloatArray) -> None:
        self._knots, self._values = knots, values
        self._widths = np.diff(knots)
        self._chords = np.diff(values) / self._widths
        self._slopes = self._slopes_at_knots()

    def value(self, x: FloatArray) -> FloatArray:
        """Return the ordinates at abscissas inside the knots, of any shape; NaN of NaN, a knot's own at a knot."""
        i, t = self._place(x)
        y, rise, chord = self._values[i], self._widths[i] * t, self._chords[i]
        first, last = self._slopes[i], self._slopes[i + 1]
        inside = y + rise * (chord + (1.0 - t) * ((1.0 - t) * (first - chord) - t * (last - chord)))
        return np.where(t == 1.0, self._values[i + 1], inside)

    def slope(self, x: FloatArray) -> FloatArray:
        """Return the derivatives at abscissas inside the knots, of any shape; NaN of NaN."""
        i, t = self._place(x)
        chord = self._chords[i]
        first, last = self._slopes[i] - chord, self._slopes[i + 1] - chord
        return np.asarray(chord + (1.0 - t) * (1.0 - 3.0 * t) * first + t * (3.0 * t - 2.0) * last)

    def _place(self, x: FloatArray) -> tuple[npt.NDArray[np.intp], FloatArray]:
        """Return the piece of each abscissa and where it stands in it, 0 to 1."""
        i = (np.searchsorted(self._knots, x, side="right") - 1).clip(0, self._knots.size - 2)
        return i, np.asarray((x - self._knots[i]) / self._widths[i])

    def _slopes_at_knots(self) -> FloatArray:
        h, m = self._widths, self._chords
        if m.size == 1:
            return np.repeat(m, 2)
        slopes = np.zeros(m.size + 1)
        before, after = m[:-1], m[1:]
        same = before * after > 0.0  # else the point is an extreme, or the chord level
        w1, w2 = 2.0 * h[1:] + h[:-1], h[1:] + 2.0 * h[:-1]
        with np.errstate(over="ignore"):  # a chord that is all but level: the mean is its limit, 0
            slopes[1:-1][same] = (w1 + w2)[same] / ((w1[same] / before[same]) + (w2[same] / after[same]))
        slopes[0] = _end_slope(h[0], h[1], m[0], m[1])
        slopes[-1] = _end_slope(h[-1], h[-2], m[-1], m[-2])
        return slopes


def _end_slope(h0: float, h1: float, m0: float, m1: float) -> float:
    """Return the slope at an end by three points, kept from turning: chords m0 over h0, then m1 over h1."""
    slope = ((2.0 * h0 + h1) * m0 - h0 * m1) / (h0 + h1)
    if slope * m0 <= 0.0:
        return 0.0
    return 3.0 * m0 if m0 * m1 <= 0.0 and abs(slope) > 3.0 * abs(m0) else slope
