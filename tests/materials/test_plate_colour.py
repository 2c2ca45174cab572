"""Colours of plates between polars, in daylight."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from crystal_core.errors import InputError
from crystal_core.materials import plate_colour
from crystal_core.materials.plate_colour import plate_colours, transmittance, wavelength_grid
from crystal_core.optics.arrays import Real
from crystal_core.optics.medium import Medium
from crystal_core.optics.plates import Coherence, Plate, plate_stack
from crystal_core.optics.retardation import retardation_nm
from crystal_core.spectra.colour import D65_WHITE_XYZ

DIAGONAL = np.array((1.0, 1.0, 0.0)) / np.sqrt(2)
QUARTZ = Medium.uniaxial(1.5442, 1.5533, DIAGONAL)


def always(*plates: Plate) -> Callable[[Real], Sequence[Plate]]:
    """Plates without dispersion."""
    return lambda _wavelength: plates


def retarder(retardation: float) -> Callable[[Real], Sequence[Plate]]:
    """A plate at 45° of almost no birefringence in a mount of its own index: sin²(πΓ/λ) and nothing else."""
    return always(Plate(Medium.uniaxial(1.5, 1.5 + 1e-6, DIAGONAL), retardation * 1e3))


def ideal(retardation: float) -> plate_colour.PlateColour:
    return plate_colours(retarder(retardation), 1.5, 0.0, 90.0, "single-pass")


def test_the_retarder_is_ideal() -> None:
    wavelengths = np.linspace(380.0, 780.0, 401)
    optics = plate_stack(retarder(551.0)(wavelengths), wavelengths, 1.5, coherent="single-pass")
    passed = transmittance(optics.mueller_transmitted, 0.0, 90.0)
    np.testing.assert_allclose(passed, np.sin(np.pi * 551.0 / wavelengths) ** 2, atol=1e-6)


@pytest.mark.parametrize(
    ("retardation", "expected"),
    [
        (100.0, (128, 148, 174)),
        (332.0, (255, 242, 189)),
        (551.0, (104, 0, 179)),
        (664.0, (0, 175, 255)),
        (1334.0, (97, 249, 89)),
    ],
)
def test_interference_colours(retardation: float, expected: tuple[int, int, int]) -> None:
    """Computed outside this project from sin²(πΓ/λ), D65 and the CIE 1931 2° observer, clipped."""
    colour = ideal(retardation)
    assert tuple(np.floor(colour.srgb * 255 + 0.5)) == expected
    assert np.all((colour.srgb >= 0) & (colour.srgb <= 1))


def test_order_of_the_luminance() -> None:
    """Sensitive tint at 551 nm, the next minimum at 1106, the first maximum at 275."""
    luminance = {gamma: ideal(gamma).xyz[1] for gamma in (274, 275, 276, 550, 551, 552, 1105, 1106, 1107)}
    assert luminance[551] == pytest.approx(0.0524, abs=5e-5)
    assert luminance[551] < min(luminance[550], luminance[552])
    assert luminance[1106] < min(luminance[1105], luminance[1107])
    assert luminance[275] > max(luminance[274], luminance[276])


def test_very_thick_plates_are_half_white() -> None:
    colour = ideal(1e6)
    np.testing.assert_allclose(colour.xyz, 0.5 * np.array(D65_WHITE_XYZ), rtol=1e-3)
    averaged = plate_colours(retarder(1e6), 1.5, 0.0, 90.0, "incoherent")
    np.testing.assert_allclose(averaged.xyz, 0.5 * np.array(D65_WHITE_XYZ), rtol=1e-6)


@pytest.mark.parametrize("polars", [(0.0, 0.0), (33.0, 33.0), (None, None), (20.0, None), (None, 70.0)])
def test_the_open_field_is_white(polars: tuple[float | None, float | None]) -> None:
    colour = plate_colours(always(), 1.0, *polars)
    np.testing.assert_allclose(colour.xyz, D65_WHITE_XYZ, rtol=1e-12)
    np.testing.assert_allclose(colour.srgb, 1.0, atol=1e-9)


def test_transmittance_of_polars() -> None:
    open_field = np.eye(4)[:, :, None]
    assert transmittance(open_field, 0.0, 90.0)[0] == pytest.approx(0.0, abs=1e-15)
    assert transmittance(open_field, 10.0, 40.0)[0] == pytest.approx(0.75)
    # A plate that passes vibrations at +45° (from x towards y) only
    polaroid = 0.5 * np.array(((1, 0, 1, 0), (0, 0, 0, 0), (1, 0, 1, 0), (0, 0, 0, 0)))[:, :, None]
    assert transmittance(polaroid, 45.0, 45.0)[0] == pytest.approx(1.0)
    assert transmittance(polaroid, 45.0, None)[0] == pytest.approx(1.0)
    assert transmittance(polaroid, None, 135.0)[0] == pytest.approx(0.0, abs=1e-15)
    assert transmittance(polaroid, None, None)[0] == pytest.approx(0.5)


@pytest.mark.parametrize(("mount", "expected", "tolerance"), [(1.0, 0.9106, 5e-5), (1.54, 0.99998, 5e-6)])
def test_quartz_in_air_and_in_balsam(mount: float, expected: float, tolerance: float) -> None:
    """Mean ratio to sin²(πΓ/λ), 400 to 700 nm by 1 nm: faces and multiple beams take 9 % in air."""
    wavelengths = np.linspace(400.0, 700.0, 301)
    plates = [Plate(QUARTZ, 30.0)]
    passed = transmittance(plate_stack(plates, wavelengths, mount).mueller_transmitted, 0.0, 90.0)
    retardation = retardation_nm(plates, wavelengths)
    assert retardation is not None
    ratio = passed / np.sin(np.pi * retardation / wavelengths) ** 2
    assert ratio.mean() == pytest.approx(expected, abs=tolerance)


def test_polars_and_the_stage_turn_together() -> None:
    """Extinction along the axes; the same colour when everything turns."""
    axes = {angle: np.array((np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0)) for angle in (0, 30, 45, 75)}
    dark = plate_colours(always(Plate(Medium.uniaxial(1.5442, 1.5533, axes[30]), 30.0)), 1.54, 30.0, 120.0)
    assert dark.xyz.max() < 1e-9
    first = plate_colours(always(Plate(Medium.uniaxial(1.5442, 1.5533, axes[45]), 30.0)), 1.54, 0.0, 90.0)
    second = plate_colours(always(Plate(Medium.uniaxial(1.5442, 1.5533, axes[75]), 30.0)), 1.54, 30.0, 120.0)
    np.testing.assert_allclose(first.xyz, second.xyz, atol=1e-12)


def test_dispersion_reaches_the_colour() -> None:
    """A plate whose retardation is λ/2 at every wavelength is white, not grey or yellow."""
    halfwave = plate_colours(
        lambda w: [Plate(Medium.uniaxial(1.5, 1.5 + 0.5 * w * 1e-6, DIAGONAL), 1000.0)], 1.5, 0.0, 90.0, "single-pass"
    )
    np.testing.assert_allclose(halfwave.xyz, D65_WHITE_XYZ, rtol=1e-6)


@pytest.mark.parametrize("coherent", ["exact", "single-pass"])
def test_the_grid_resolves_every_fringe(coherent: Coherence, monkeypatch: pytest.MonkeyPatch) -> None:
    """A grid four times as fine changes nothing."""
    thick = Plate(QUARTZ, 200.0)
    wavelengths = wavelength_grid(always(thick), coherent)
    step = wavelengths[1] - wavelengths[0]
    gamma = 200e3 * (1.5533 - 1.5442)
    path = 2 * 200e3 * 1.5533 if coherent == "exact" else gamma
    finest = min(1.0, 380.0**2 / (8 * path))
    assert 0.99 * finest < step <= finest * (1 + 1e-12)
    colour = plate_colours(always(thick), 1.0, 0.0, 90.0, coherent)
    monkeypatch.setattr(plate_colour, "SAMPLES_PER_FRINGE", 31.0)
    finer = plate_colours(always(thick), 1.0, 0.0, 90.0, coherent)
    np.testing.assert_allclose(finer.xyz, colour.xyz, atol=1e-5)


def test_grids_at_most_1_nm_and_with_dispersion_finer() -> None:
    assert np.diff(wavelength_grid(retarder(10.0), "single-pass")).max() == pytest.approx(1.0)
    assert np.diff(wavelength_grid(always(Plate(QUARTZ, 1e5)), "incoherent")).max() == pytest.approx(1.0)
    plain = wavelength_grid(retarder(1e5), "single-pass")
    # The birefringence of an active section goes as λ⁻¹ or more: its phase runs twice as fast as Γ/λ
    steep = wavelength_grid(
        lambda w: [Plate(Medium.uniaxial(1.5, 1.5 + 1e-6 * 380.0 / w, DIAGONAL), 1e8)], "single-pass"
    )
    assert steep.size == pytest.approx(2 * plain.size, rel=0.01)


def test_a_stack_too_thick_is_refused_before_any_work() -> None:
    with pytest.raises(InputError, match=r"need \d+ wavelengths"):
        plate_colours(always(Plate(QUARTZ, 1e5)), 1.0, 0.0, 90.0)
    # Many plates are as much work as many wavelengths.
    plate = Plate(QUARTZ, 2000.0)
    assert wavelength_grid(always(plate), "exact").size < 300_000
    with pytest.raises(InputError, match="each of 8 plates"):
        wavelength_grid(always(*[plate] * 8), "exact")


def test_single_pass_and_exact_are_nearly_the_same_colour() -> None:
    """Multiple beams average out over the spectrum of a thin section in air."""
    exact = plate_colours(always(Plate(QUARTZ, 30.0)), 1.0, 0.0, 90.0)
    single = plate_colours(always(Plate(QUARTZ, 30.0)), 1.0, 0.0, 90.0, "single-pass")
    np.testing.assert_allclose(single.xyz, exact.xyz, rtol=2e-3)


@pytest.mark.parametrize(("polars", "pointer"), [((np.nan, 0.0), "/polarizer_deg"), ((0.0, np.inf), "/analyser_deg")])
def test_bad_angles_are_named(polars: tuple[float, float], pointer: str) -> None:
    with pytest.raises(InputError, match=pointer):
        transmittance(np.eye(4)[:, :, None], *polars)
