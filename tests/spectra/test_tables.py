"""The committed tables against colour-science, and the way they are read."""

from __future__ import annotations

import sys
from subprocess import run
from types import ModuleType

import numpy as np
import pytest

from crystal_core.spectra import illuminants, observer, reflectance
from crystal_core.spectra.tables import read_table

WAVELENGTHS = np.random.default_rng(20_190_702).uniform(380.0, 780.0, 400)


def linear(colour_science: ModuleType, table: object, shape: tuple[float, float, float]) -> np.ndarray:
    """Return what colour-science itself makes of its table, rows by 1 nm and straight lines between them."""
    fine = table.copy().interpolate(colour_science.SpectralShape(*shape))  # type: ignore[attr-defined]
    values = np.atleast_2d(fine.values.T)
    return np.stack([colour_science.LinearInterpolator(fine.wavelengths, column)(WAVELENGTHS) for column in values])


def test_observer_is_that_of_colour_science(colour_science: ModuleType) -> None:
    table = colour_science.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    expected = linear(colour_science, table, (360, 830, 1))
    np.testing.assert_allclose(observer.colour_matching(WAVELENGTHS), expected, rtol=0, atol=1e-12)


def test_d65_is_that_of_colour_science(colour_science: ModuleType) -> None:
    table = colour_science.SDS_ILLUMINANTS["D65"]
    expected = linear(colour_science, table, (300, 780, 1))[0]
    np.testing.assert_allclose(illuminants.d65(WAVELENGTHS), expected, rtol=0, atol=1e-10)


def test_reflectance_basis_is_that_of_colour_science(colour_science: ModuleType) -> None:
    table = colour_science.recovery.MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019
    expected = linear(colour_science, table, (380, 780, 1))
    # The published digits add to 1 within 1e-5 only; ours are divided by their sum.
    np.testing.assert_allclose(reflectance.basis(WAVELENGTHS), expected, rtol=0, atol=1.1e-5)


def test_luminous_efficiency_peaks_at_555_nm_with_1() -> None:
    # The photometric unit rests on it: V(555 nm) = 1 (BIPM, The SI Brochure, 9th ed.).
    wavelengths = np.arange(360.0, 831.0)
    luminous = observer.colour_matching(wavelengths)[1]
    assert wavelengths[np.argmax(luminous)] == 555.0
    assert luminous.max() == pytest.approx(1.0, abs=1e-6)


def test_d65_beyond_780_nm_is_the_published_table() -> None:
    # ISO 11664-2:2007, table 1: 63.8434 at 785, 59.4519 at 800, 60.3125 at 830 nm.
    np.testing.assert_allclose(illuminants.d65([785.0, 800.0, 830.0]), [63.8434, 59.4519, 60.3125], atol=1e-6)


def test_d65_is_100_at_560_nm() -> None:
    assert illuminants.d65(560.0) == 100.0


@pytest.mark.parametrize("outside", [299.0, 359.9, 830.1, 2000.0, -1.0])
def test_the_eye_sees_nothing_outside_its_table(outside: float) -> None:
    np.testing.assert_array_equal(observer.colour_matching(outside), 0.0)
    assert (illuminants.d65(outside) == 0.0) == (outside < 300.0 or outside > 830.0)


def test_reflectance_keeps_its_end_values_outside() -> None:
    np.testing.assert_array_equal(reflectance.basis([300.0, 900.0]), reflectance.basis([380.0, 780.0]))


def test_reflectances_are_a_partition_of_unity() -> None:
    parts = reflectance.basis(np.linspace(350.0, 850.0, 4001))
    assert parts.min() >= 0.0
    assert parts.max() <= 1.0
    np.testing.assert_allclose(parts.sum(axis=0), 1.0, rtol=0, atol=4e-16)


@pytest.mark.parametrize("shape", [(), (1,), (3, 5), (2, 0)])
def test_shapes(shape: tuple[int, ...]) -> None:
    wavelengths = np.full(shape, 500.0)
    assert observer.colour_matching(wavelengths).shape == (3, *shape)
    assert reflectance.basis(wavelengths).shape == (3, *shape)
    assert illuminants.d65(wavelengths).shape == shape


@pytest.mark.parametrize("function", [observer.colour_matching, illuminants.d65, reflectance.basis])
def test_bits_do_not_depend_on_the_batch(function: object) -> None:
    # np.interp takes another way through the table once a batch is longer than it.
    batch = np.resize(WAVELENGTHS, 5000)
    whole = function(batch)  # type: ignore[operator]
    for length in (1, 2, 3, 7, 401):
        np.testing.assert_array_equal(function(batch[:length]), whole[..., :length])  # type: ignore[operator]


def test_nan_stays_nan() -> None:
    assert np.isnan(observer.colour_matching(np.nan)).all()
    assert np.isnan(illuminants.d65(np.nan))
    assert np.isnan(reflectance.basis(np.nan)).all()


def test_tables_are_read_only() -> None:
    with pytest.raises(ValueError, match="read-only"):
        read_table("cie_d65.csv").columns[0, 0] = 1.0


def test_every_table_names_its_source() -> None:
    from importlib import resources

    files = [file for file in (resources.files("crystal_core.spectra") / "data").iterdir() if file.is_file()]
    assert len(files) == 3
    for file in files:
        text = file.read_text(encoding="utf-8")
        assert "# Source:" in text, file.name
        assert "doi:" in text, file.name


def test_colour_science_is_not_needed_at_run_time() -> None:
    program = (
        "import sys; from crystal_core.spectra import colour, illuminants, observer, reflectance; "
        "illuminants.d65(500.0); observer.colour_matching(500.0); reflectance.basis(500.0); "
        "sys.exit('colour' in sys.modules or 'scipy' in sys.modules)"
    )
    assert run([sys.executable, "-c", program], check=False).returncode == 0
