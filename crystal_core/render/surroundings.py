"""What a backward ray in air sees that meets no crystal: the page, the table around it, the sky."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics.arrays import columns
from crystal_core.render.illumination import Illumination
from crystal_core.scene import StagedScene
from crystal_core.spectra.reflectance import basis

__all__ = ["Surroundings"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]


class Surroundings:
    """Radiance, relative to D65 and times the exposure, along rays in air.

    `sky` is that of the sky, `usual` that of the page near the specimen, on the average.

    Parameters
    ----------
    scene : StagedScene
        The scene.
    wavelength_nm : Real
        The wavelengths of a level's passes, shape (K,).
    weights : Real
        Linear sRGB of each wavelength, shape (K, 3), for the mean over the passes; they sum to white.
    footprint_mm : float
        Side of the square of the page that a sample stands for.
    """

    def __init__(
        self, scene: StagedScene, illumination: Illumination, wavelength_nm: Real, weights: Real, footprint_mm: float
    ) -> None:
        self._scene = scene
        self._illumination = illumination
        self._basis = basis(wavelength_nm)
        # Linear sRGB of light reflected by each of the three basis spectra, (3 of the basis, 3 channels).
        self._reflected = np.sum(self._basis[:, :, None] * weights, axis=1)
        self._weights = weights
        self._absorption = illumination.absorption_per_mm(wavelength_nm)
        self._footprint_mm = footprint_mm
        self._half_width = 0.5 * scene.page.texture.width_mm
        self._half_height = 0.5 * scene.page.texture.height_mm
        self.sky = scene.sky_fraction * scene.exposure
        self.usual = float(scene.page.texture.mean * illumination.mean) * scene.exposure

    def radiance(self, point: Real, direction: Real, colour: Index) -> Real:
        """Return the radiance each ray sees, shape (N,).

        Parameters
        ----------
        point, direction : Real
            Rays in air above the page, shape (3, N).
        colour : Index
            Wavelength of each ray: its place among them, shape (N,).
        """
        result = np.full(colour.size, self.sky)
        down = np.flatnonzero(direction[2] < 0.0)
        if down.size:
            reflectance, light, sheet, way = self._page(columns(point, down), columns(direction, down))
            at = colour[down]
            if way is not None and self._absorption is not None:
                light = self._illumination.coloured(light, way, self._absorption[:, at])
            if reflectance.shape[0] == 1:
                value = reflectance[0]
            else:
                value = reflectance[0] * self._basis[0][at]
                value += reflectance[1] * self._basis[1][at]
                value += reflectance[2] * self._basis[2][at]
            result[down] = np.where(sheet, value, self._scene.page.table_reflectance) * light * self._scene.exposure
        return result

    def linear_srgb(self, point: Real, direction: Real) -> Real:
        """Return the colour each ray sees when it carries all wavelengths, shape (3, N).

        Parameters
        ----------
        point, direction : Real
            Rays in air above the page, shape (3, N).
        """
        result = np.full((3, point.shape[1]), self.sky)
        down = np.flatnonzero(direction[2] < 0.0)
        if down.size:
            reflectance, light, sheet, way = self._page(columns(point, down), columns(direction, down))
            for channel in range(3):
                value = reflectance[0]
                if reflectance.shape[0] == 3:
                    red, green, blue = self._reflected[:, channel]
                    value = reflectance[0] * red + reflectance[1] * green + reflectance[2] * blue
                value = np.where(sheet, value, self._scene.page.table_reflectance)
                result[channel, down] = value * light * self._scene.exposure
            behind = np.flatnonzero(way) if way is not None else np.empty(0, np.intp)
            if behind.size and way is not None and self._absorption is not None:
                result[:, down[behind]] = self._exposed(
                    reflectance[:, behind], light[behind], sheet[behind], way[behind], self._absorption
                )
        return result

    def _exposed(self, reflectance: Real, light: Real, sheet: NDArray[np.bool_], way: Real, absorption: Real) -> Real:
        """Return the colour of places of the page in light that has come through a coloured crystal, shape (3, N)."""
        result = np.zeros((3, way.size))
        for place, weights in enumerate(self._weights):
            value = reflectance[0]
            if reflectance.shape[0] == 3:
                value = np.sum(reflectance * self._basis[:, place, None], axis=0)
            value = np.where(sheet, value, self._scene.page.table_reflectance)
            value = value * self._illumination.coloured(light, way, absorption[:, place, None])
            for channel in range(3):
                result[channel] += weights[channel] * value
        return result * self._scene.exposure

    def _page(self, point: Real, direction: Real) -> tuple[Real, Real, NDArray[np.bool_], Real | None]:
        """Return texture reflectance (channels, N), light, whether the sheet was met, the light's way in the crystal.

        The way, mm, is told of coloured crystals only.
        """
        distance = point[2] / -direction[2]
        x = point[0] + distance * direction[0]
        y = point[1] + distance * direction[1]
        reflectance = self._scene.page.texture.average(x, y, self._footprint_mm)
        sheet = (np.abs(x) <= self._half_width) & (np.abs(y) <= self._half_height)
        way = None if self._absorption is None else self._illumination.way_mm(x, y)
        return reflectance, self._illumination.at(x, y), sheet, way
