"""Few wavelengths against many: white stays white, colours are those of the whole spectrum."""

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest

from crystal_core.spectra.colour import linear_srgb_to_xyz
from crystal_core.spectra.quadrature import effective_wavelength_nm, stratified_wavelengths

SPECTRA: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "ramp": lambda nm: 0.3 + 0.5 * (nm - 400) / 300,
    "edge": lambda nm: 0.1 + 0.8 / (1 + np.exp(-(nm - 600) / 8)),
    "band": lambda nm: 0.1 + 0.7 * np.exp(-(((nm - 530) / 30) ** 2)),
    "ruby": lambda nm: np.exp(-2 * np.exp(-(((nm - 550) / 35) ** 2)) - 2 * np.exp(-(((nm - 405) / 30) ** 2))),
}


def _colour(spectrum: Callable[[np.ndarray], np.ndarray], sets: int, count: int) -> np.ndarray:
    chosen = stratified_wavelengths(sets, count)
    return np.mean([(spectrum(s.wavelength_nm)[:, None] * s.weights).sum(axis=0) for s in chosen], axis=0)


def _lab(linear: np.ndarray) -> np.ndarray:
    white = linear_srgb_to_xyz(np.ones(3))
    t = np.clip(linear_srgb_to_xyz(linear) / white, 0, None)
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array((116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])))


@pytest.mark.parametrize(("sets", "count"), [(1, 1), (4, 2), (4, 4), (16, 8)])
def test_white_is_white(sets: int, count: int) -> None:
    np.testing.assert_allclose(_colour(np.ones_like, sets, count), 1.0, atol=1e-12)


@pytest.mark.parametrize("name", SPECTRA)
def test_sixteen_wavelengths_give_the_colour(name: str) -> None:
    """The 4 × 4 of a standard pixel within ΔE 2 of a fine integral; the 16 × 8 of a fine one within 0.2."""
    exact = _lab(_colour(SPECTRA[name], 1, 4000))
    assert np.linalg.norm(_lab(_colour(SPECTRA[name], 4, 4)) - exact) < 2.0
    assert np.linalg.norm(_lab(_colour(SPECTRA[name], 16, 8)) - exact) < 0.2


def test_sets_interleave() -> None:
    sets = stratified_wavelengths(4, 4)
    together = np.sort(np.concatenate([s.wavelength_nm for s in sets]))
    np.testing.assert_allclose(together, stratified_wavelengths(1, 16)[0].wavelength_nm)


def test_effective_wavelength(colour_science: ModuleType) -> None:
    """The luminance centroid of daylight, from the tables of another library."""
    nm = np.arange(360, 831)
    observer = colour_science.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    daylight = colour_science.SDS_ILLUMINANTS["D65"].copy().align(colour_science.SpectralShape(360, 780, 1))
    luminance = np.interp(nm, daylight.wavelengths, daylight.values, right=0.0) * observer[nm][:, 1]
    assert effective_wavelength_nm() == pytest.approx(np.sum(nm * luminance) / np.sum(luminance), abs=0.05)
