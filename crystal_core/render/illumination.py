"""Illuminance of the page by the point light and the sky.

The light that reaches the page through the specimen is approximated (illumination maps by light rays will replace it).
From each point of the page one ray goes towards the light: it is refracted where it meets the specimen, with the mean
of the principal indices. If it leaves by the face parallel to the one it came in by, its direction is the old one and
the light is dimmed by the transmittance of a plane-parallel plate, all internal reflections included; if it meets any
other face, the point gets no light through the specimen. A coloured crystal dims it along its way inside by the mean of
exp(−a d) over the three principal directions. What is missing: the doubling of the shadow's rim by double refraction,
and light that arrives by other ways (caustics). Light of a uniform sky through a lossless crystal is unchanged,
whatever its shape, so the sky's part is whole everywhere; a coloured crystal would dim it too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics.arrays import columns, dot
from crystal_core.scene import StagedScene
from crystal_core.spectra.quadrature import effective_wavelength_nm

__all__ = ["Illumination", "plate_transmittance"]

Real = NDArray[np.float64]

CELLS = 512
"""Cells a side of the grid on which the specimen's part is tabulated: finer than a pixel of most pictures of it."""


class Illumination:
    """Illuminance relative to the centre of the bare page, of a staged scene.

    What the specimen takes away is tabulated once per frame, on the rectangle of the page where it can.
    """

    def __init__(self, scene: StagedScene) -> None:
        self._specimen = scene.specimen
        self._body = scene.specimen.body
        self._light = scene.light_mm
        self._sky = scene.sky_fraction
        self._centre2 = float(np.sum(scene.light_mm**2))
        self._mean_index = float(np.mean(scene.specimen.indices(effective_wavelength_nm())))
        # Corners cast from the light onto the page, and the body's own outline, bound that rectangle.
        spokes = self._body.vertices - self._light
        cast = self._light + spokes * (self._light[2] / -spokes[:, 2])[:, None]
        outline = np.concatenate((cast[:, :2], self._body.vertices[:, :2]))
        self._low, self._high = outline.min(axis=0), outline.max(axis=0)
        self._step = (self._high - self._low) / CELLS
        across = self._low[0] + np.arange(CELLS + 1) * self._step[0]
        upward = self._low[1] + np.arange(CELLS + 1) * self._step[1]
        x, y = np.tile(across, CELLS + 1), np.repeat(upward, CELLS + 1)
        through, self._way = self._through(x, y)
        self._grid = self._bare(x, y) * (1.0 - self._sky) * through + self._sky

    @property
    def mean(self) -> float:
        """Mean illuminance near the specimen."""
        return float(self._grid.mean())

    def at(self, x: Real, y: Real) -> Real:
        """Return the illuminance at points of the page, in mm, shape (N,); 1 at the centre of the bare page.

        Behind a coloured crystal it is that of a clear one: `coloured` tells of the light that is left.
        """
        column, row, near = self._cell(x, y)
        if near.all():
            return _interpolated(self._grid, column, row)
        result = self._bare(x, y) * (1.0 - self._sky) + self._sky
        chosen = np.flatnonzero(near)
        result[chosen] = _interpolated(self._grid, column[chosen], row[chosen])
        return result

    def absorption_per_mm(self, wavelength_nm: Real) -> Real | None:
        """Return the crystal's three principal absorption coefficients, shape (3, K); None if it is clear."""
        found = self._specimen.medium(wavelength_nm).absorption_per_mm
        if found is None:
            return None
        first, last = found[0], found[-1]
        middle = found[1] if len(found) == 3 else first  # two waves of a uniaxial crystal in three vibrate across c
        return np.stack([np.broadcast_to(a, wavelength_nm.shape) for a in (first, middle, last)])

    def way_mm(self, x: Real, y: Real) -> Real:
        """Return how far the light goes through the crystal to points of the page, mm, shape (N,)."""
        column, row, near = self._cell(x, y)
        result = np.zeros(x.size)
        chosen = np.flatnonzero(near)
        result[chosen] = _interpolated(self._way, column[chosen], row[chosen])
        return result

    def coloured(self, light: Real, way_mm: Real, coefficients: Real) -> Real:
        """Return the illuminance that a coloured crystal leaves, shape (N,).

        Parameters
        ----------
        light : Real
            That behind a clear one, shape (N,).
        way_mm : Real
            Of the light through the crystal, shape (N,).
        coefficients : Real
            Principal absorption coefficients, mm⁻¹, shape (3, N) or (3, 1).
        """
        left = np.exp(-coefficients[0] * way_mm)
        for coefficient in coefficients[1:]:
            left = left + np.exp(-coefficient * way_mm)
        result: Real = self._sky + (light - self._sky) * (left / 3.0)
        return result

    def _cell(self, x: Real, y: Real) -> tuple[Real, Real, NDArray[np.bool_]]:
        """Return where points lie on the grid, in cells, and whether they lie on it."""
        column = (x - self._low[0]) * (1.0 / self._step[0])
        row = (y - self._low[1]) * (1.0 / self._step[1])
        return column, row, (column >= 0.0) & (column < CELLS) & (row >= 0.0) & (row < CELLS)

    def _bare(self, x: Real, y: Real) -> Real:
        """Return the light's part with no specimen: inverse square and cosine at height h give h/r³."""
        ratio = self._centre2 / ((self._light[0] - x) ** 2 + (self._light[1] - y) ** 2 + self._light[2] ** 2)
        result: Real = ratio * np.sqrt(ratio)
        return result

    def _through(self, x: Real, y: Real) -> tuple[Real, Real]:
        """Return the part of the light that a clear specimen lets through to each point, and its way inside, mm."""
        result, way = np.ones(x.size), np.zeros(x.size)
        point = np.stack((x, y, np.zeros(x.size)))
        towards = self._light[:, None] - point
        towards /= np.sqrt(dot(towards, towards))
        enters, leaves, entry, _ = self._body.span(point, towards)
        met = np.flatnonzero((enters < leaves) & (leaves > 0.0))
        point, towards, entry = columns(point, met), columns(towards, met), entry[met]
        inward = -columns(self._body.normals.T, entry)
        cosine = dot(towards, inward)
        refracted = towards + (np.sqrt(self._mean_index**2 - 1.0 + cosine**2) - cosine) * inward
        distance, exit_ = self._body.exit(point + enters[met] * towards, refracted)
        through = plate_transmittance(cosine, self._mean_index)
        result[met] = np.where(self._body.parallel_face[entry] == exit_, through, 0.0)
        way[met] = distance * np.sqrt(dot(refracted, refracted))
        return result, way


def plate_transmittance(cosine: Real, n: float) -> Real:
    """Return the transmittance of a lossless plane-parallel plate for unpolarized light, beams added incoherently.

    (1 − R)/(1 + R) for each polarization, R its Fresnel reflectance (Born & Wolf, Principles of Optics, 7th ed.,
    §1.5.2); `cosine` of the angle of incidence in air, shape (N,).
    """
    inside = np.sqrt(1.0 - (1.0 - cosine**2) / (n * n))
    r_s = ((cosine - n * inside) / (cosine + n * inside)) ** 2
    r_p = ((n * cosine - inside) / (n * cosine + inside)) ** 2
    result: Real = 0.5 * ((1.0 - r_s) / (1.0 + r_s) + (1.0 - r_p) / (1.0 + r_p))
    return result


def _interpolated(grid: Real, column: Real, row: Real) -> Real:
    """Return the values of a table between its places, bilinearly."""
    j, i = column.astype(np.intp), row.astype(np.intp)
    fj, fi = column - j, row - i
    corner = i * (CELLS + 1) + j
    lower = grid[corner]
    lower = lower + fj * (grid[corner + 1] - lower)
    corner += CELLS + 1
    upper = grid[corner]
    upper = upper + fj * (grid[corner + 1] - upper)
    result: Real = lower + fi * (upper - lower)
    return result
