"""Hot bodies against published values."""

from __future__ import annotations

import numpy as np
import pytest

from crystal_core.spectra.thermal import black_body, illuminant_a


@pytest.mark.parametrize(
    ("wavelength", "power"),
    # CIE 015:2018, table 5.
    [(380, 9.7951), (400, 14.7080), (500, 59.8611), (560, 100.0), (600, 129.043), (700, 198.261), (780, 241.675)],
)
def test_illuminant_a(wavelength: float, power: float) -> None:
    assert illuminant_a(wavelength) == pytest.approx(power, rel=1e-4)


def test_a_is_a_black_body_of_2856_kelvin() -> None:
    wavelengths = np.linspace(380, 780, 81)
    assert illuminant_a(wavelengths) == pytest.approx(black_body(wavelengths, 2855.5), rel=1e-3)


def test_wien() -> None:
    wavelengths = np.linspace(300, 1500, 120001)
    peak = wavelengths[np.argmax(black_body(wavelengths, 5000.0))]
    assert peak == pytest.approx(2897771.955 / 5000.0, abs=0.02)
