"""Spectra of lights at wavelengths."""

from __future__ import annotations

import pytest

from crystal_core.scene.curves import Table
from crystal_core.scene.spectra import BlackBody, Line, SpectrumOf, relative_power
from crystal_core.spectra.illuminants import d65


def test_named_spectra() -> None:
    assert relative_power("D65", [450.0, 560.0]) == pytest.approx(d65([450.0, 560.0]))
    assert relative_power("A", 700.0) == pytest.approx(198.26, rel=1e-4)
    assert relative_power("E", [400.0, 700.0]).tolist() == [1.0, 1.0]


def test_black_bodies_and_tables() -> None:
    hot = SpectrumOf(black_body=BlackBody(temperature_k=9000))
    assert relative_power(hot, 400.0) > relative_power(hot, 700.0)
    table = SpectrumOf(table=Table(wavelengths_nm=(500, 600), values=(1, 3)))
    assert relative_power(table, [400.0, 500.0, 550.0, 601.0]).tolist() == [0.0, 1.0, 2.0, 0.0]


def test_lines_have_no_power_per_wavelength() -> None:
    with pytest.raises(ValueError, match="no power per wavelength"):
        relative_power(SpectrumOf(lines=(Line(wavelength_nm=589.3),)), 589.3)
