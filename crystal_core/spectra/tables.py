"""The tables of the package's ``data`` folder: read once, joined by straight lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import resources

import numpy as np
import numpy.typing as npt

__all__ = ["SpectralTable", "read_table"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SpectralTable:
    """Columns of numbers against wavelength.

    Parameters
    ----------
    wavelength_nm : float64 array, shape (R,)
        Rising, nm; read-only.
    columns : float64 array, shape (C, R)
        One row per column of the file; read-only.
    """

    wavelength_nm: FloatArray
    columns: FloatArray

    def interpolate(self, wavelength_nm: npt.ArrayLike, *, zero_outside: bool) -> FloatArray:
        """Return every column at any wavelengths, by straight lines between the rows.

        Parameters
        ----------
        wavelength_nm : array_like, shape (...)
            nm; NaN gives NaN.
        zero_outside : bool
            Whether the table is 0 outside its wavelengths; else its end values go on.

        Returns
        -------
        float64 array, shape (C, ...)
            Each value is computed by itself: its bits do not depend on the length of the batch.
        """
        at = np.asarray(wavelength_nm, dtype=np.float64)
        outside = 0.0 if zero_outside else None
        found = [np.interp(at, self.wavelength_nm, column, left=outside, right=outside) for column in self.columns]
        return np.stack(found)


@cache
def read_table(name: str) -> SpectralTable:
    """Read a table of the package: ``#`` comments, a line of column names, comma-separated rows.

    Parameters
    ----------
    name : str
        File name in ``crystal_core/spectra/data``.

    Raises
    ------
    FileNotFoundError
        Where there is no such table.
    """
    text = (resources.files("crystal_core.spectra") / "data" / name).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    rows = np.array([[float(field) for field in line.split(",")] for line in lines[1:]])
    columns = np.ascontiguousarray(rows.T)
    columns.setflags(write=False)
    return SpectralTable(columns[0], columns[1:])
