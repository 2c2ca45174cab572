"""Write the spectral tables of ``crystal_core.spectra`` anew from colour-science.

    python tools/tabulate_spectra.py

writes ``crystal_core/spectra/data/*.csv`` and prints the constants that ``crystal_core/spectra/colour.py`` holds. It
needs the test requirements (colour-science); the product itself does not, because importing colour-science takes over a
second.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # it warns that it cannot plot without Matplotlib
    import colour

DATA = Path(__file__).resolve().parent.parent / "crystal_core" / "spectra" / "data"
COLOUR = f"colour-science {colour.__version__} (BSD-3-Clause)"


def write(name: str, header: Sequence[str], columns: str, rows: Iterable[Iterable[float]]) -> None:
    """Write one table: comment lines, a line of column names, rows of the shortest digits that give the number back."""
    lines = [f"# {line}" for line in header] + [columns]
    for wavelength, *values in rows:
        lines.append(",".join([f"{wavelength:g}", *(repr(float(value)) for value in values)]))
    (DATA / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def observer() -> None:
    """Write the colour matching functions."""
    table = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    write(
        "cie_1931_2_degree.csv",
        [
            "CIE 1931 colour matching functions, 2 degree observer.",
            "Source: CIE 015:2018 Colorimetry, 4th ed., doi:10.25039/TR.015.2018, the table by 1 nm.",
            f"Taken from {COLOUR} by tools/tabulate_spectra.py. Between the rows: linear.",
        ],
        "wavelength_nm,x_bar,y_bar,z_bar",
        zip(table.wavelengths, *table.values.T, strict=True),
    )


def daylight() -> None:
    """Write D65; colour-science ends its table at 780 nm, the CIE's own D series carries it to 830 nm."""
    table = colour.SDS_ILLUMINANTS["D65"]
    # 6500 K on the scale of 1931 (c2 = 0.014380 m K), as the CIE defines D65; on today's scale 6503.6 K.
    temperature = 6500.0 * 1.4388 / 1.4380
    series = colour.colorimetry.sd_CIE_illuminant_D_series(colour.temperature.CCT_to_xy_CIE_D(temperature))
    overlap = np.isin(series.wavelengths, table.wavelengths)
    worst = np.max(np.abs(series.values[overlap] - table.values))
    if worst > 0.001:
        raise SystemExit(f"the D series leaves the table of D65 by {worst:g}: it may not continue it")
    beyond = series.wavelengths > table.wavelengths[-1]
    write(
        "cie_d65.csv",
        [
            "CIE standard illuminant D65, relative spectral power, 100 at 560 nm.",
            "Source: CIE 015:2018 Colorimetry, 4th ed., doi:10.25039/TR.015.2018; from 785 nm its equation of the",
            "D series, which gives the rows up to 780 nm within 0.001.",
            f"Taken from {COLOUR} by tools/tabulate_spectra.py. Between the rows: linear, as the CIE prescribes.",
        ],
        "wavelength_nm,relative_power",
        [
            *zip(table.wavelengths, table.values, strict=True),
            *zip(series.wavelengths[beyond], np.round(series.values[beyond], 6), strict=True),
        ],
    )


def reflectance() -> None:
    """Write the Mallett-Yuksel basis by 1 nm.

    Straight lines between the 5 nm rows of the paper would miss the colours by up to 3/255: the steps between the
    primaries are steep. Sprague's interpolation, the CIE's own, keeps them within 0.6/255.
    """
    table = colour.recovery.MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019
    fine = table.copy().interpolate(colour.SpectralShape(380, 780, 1), interpolator=colour.SpragueInterpolator)
    write(
        "mallett_yuksel_2019.csv",
        [
            "Reflectance basis of linear sRGB: red, green and blue parts of unity.",
            "Source: I. Mallett, C. Yuksel. Spectral primary decomposition for rendering with sRGB reflectance.",
            "Eurographics Symposium on Rendering (2019), doi:10.2312/SR.20191216.",
            "Its 5 nm rows, interpolated by Sprague's quintics.",
            f"Taken from {COLOUR} by tools/tabulate_spectra.py. Between the rows: linear.",
        ],
        "wavelength_nm,red,green,blue",
        zip(fine.wavelengths, *np.round(fine.values, 9).T, strict=True),
    )


def constants() -> None:
    """Print white and matrices for ``colour.py``."""
    from crystal_core.spectra import illuminants, observer

    wavelengths = np.arange(360.0, 831.0)
    white = np.array([np.sum(illuminants.d65(wavelengths) * bar) for bar in observer.colour_matching(wavelengths)])
    white /= white[1]
    chromaticities = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]])
    to_xyz = colour.normalised_primary_matrix(chromaticities, colour.XYZ_to_xy(white))
    for name, value in (("white", white), ("linear sRGB to XYZ", to_xyz), ("its inverse", np.linalg.inv(to_xyz))):
        print(name, value.tolist())


if __name__ == "__main__":
    observer()
    daylight()
    reflectance()
    constants()
