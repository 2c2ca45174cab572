"""Retardation and degree of coherence."""

from __future__ import annotations

import numpy as np
import pytest

from crystal_core.errors import InputError
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.optics.medium import Medium
from crystal_core.optics.plates import Plate, plate_stack
from crystal_core.optics.retardation import degree_of_coherence, path_lengths_nm, retardation_nm
from tests.optics.plate_cases import random_medium

X, Y, Z = np.eye(3)
QUARTZ = (1.5442, 1.5533)


def of(*plates: Plate, wavelength: float = 589.3, kt: tuple[float, float, float] | None = None) -> float:
    found = retardation_nm(plates, [wavelength], kt)
    assert found is not None
    return float(found[0])


def test_thin_section_of_quartz() -> None:
    """30 µm with the axis in the plane: 273 nm; less with a tilted axis; none across the axis."""
    assert of(Plate(Medium.uniaxial(*QUARTZ, X), 30.0)) == pytest.approx(273.0, abs=1e-9)
    tilted = np.array((np.sin(0.4), 0.0, np.cos(0.4)))
    n = (np.cos(0.4) ** 2 / QUARTZ[0] ** 2 + np.sin(0.4) ** 2 / QUARTZ[1] ** 2) ** -0.5
    assert of(Plate(Medium.uniaxial(*QUARTZ, tilted), 30.0)) == pytest.approx((n - QUARTZ[0]) * 3e4, abs=1e-9)
    assert of(Plate(Medium.uniaxial(*QUARTZ, Z), 30.0)) == pytest.approx(0.0, abs=1e-9)
    assert of(Plate(Medium.isotropic(1.5), 30.0)) == pytest.approx(0.0, abs=1e-9)
    assert of(Plate(Medium.biaxial((1.6, 1.5, 1.7), np.eye(3)), 10.0)) == pytest.approx(1000.0, abs=1e-9)


def test_biaxial_plate_across_an_optic_axis_has_none() -> None:
    medium = Medium.biaxial((1.53, 1.681, 1.6854), np.eye(3))
    axis = BiaxialIndicatrix.of(medium).optic_axes()[0]
    across = np.array((axis[2], 0.0, -axis[0]))
    turn = np.array((across, Y, axis))  # takes the optic axis to z
    turned = Medium.biaxial((1.53, 1.681, 1.6854), turn.T)
    assert of(Plate(turned, 30.0)) == pytest.approx(0.0, abs=1e-9)


def test_phase_is_of_the_normal_part_of_k_not_of_the_length_of_a_ray() -> None:
    """Oblique light on a plate with its axis along z: closed forms of both waves."""
    n_o, n_e, kappa = 1.6584, 1.4864, 0.6
    slow = np.sqrt(n_o**2 - kappa**2)
    fast = n_o * np.sqrt(1 - (kappa / n_e) ** 2)
    got = of(Plate(Medium.uniaxial(n_o, n_e, Z), 100.0), kt=(kappa, 0.0, 0.0))
    assert got == pytest.approx(abs(slow - fast) * 1e5, rel=1e-12)
    # The mutant: indices times the lengths of the rays
    n_wave = np.hypot(kappa, fast)
    ray = np.array((n_o**2 * kappa, n_e**2 * fast))  # ε k
    mutant = abs(n_o**2 / slow - n_wave * np.hypot(*ray) / ray[1]) * 1e5
    assert abs(mutant - got) > 0.1 * got


def test_the_retardation_is_the_phase_of_the_jones_matrix() -> None:
    """Random crystals, index-matched as well as can be: eigenvalues of the single-pass Jones matrix."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        medium = Medium.biaxial(tuple(1.6 + 1e-4 * rng.uniform(-1, 1, 3)), axes)
        plate = Plate(medium, 200.0)
        kt = (0.3, -0.7, 0.0)
        jones = plate_stack([plate], [589.3], 1.6, kt, "single-pass").jones_transmitted
        assert jones is not None
        first, second = np.linalg.eigvals(jones[:, :, 0])
        assert abs(np.angle(first / second)) == pytest.approx(2 * np.pi * of(plate, kt=kt) / 589.3, abs=1e-3)


def test_plates_that_share_axes_add_and_crossed_ones_subtract() -> None:
    quartz, calcite = Medium.uniaxial(*QUARTZ, X), Medium.uniaxial(1.6584, 1.4864, X)
    crossed = Medium.uniaxial(*QUARTZ, Y)
    assert of(Plate(quartz, 30.0), Plate(quartz, 20.0)) == pytest.approx(455.0, abs=1e-9)
    assert of(Plate(quartz, 30.0), Plate(crossed, 20.0)) == pytest.approx(91.0, abs=1e-9)
    assert of(Plate(quartz, 20.0), Plate(crossed, 30.0)) == pytest.approx(91.0, abs=1e-9)
    assert of(Plate(quartz, 30.0), Plate(crossed, 30.0)) == pytest.approx(0.0, abs=1e-9)
    # Calcite is negative: with its axis along x the slow direction is y.
    assert of(Plate(quartz, 30.0), Plate(calcite, 1.0)) == pytest.approx(273.0 - 172.0, abs=1e-9)
    # Plates without directions of their own agree with everything, first or not.
    glass, section = Plate(Medium.isotropic(1.5), 1000.0), Plate(Medium.uniaxial(*QUARTZ, Z), 50.0)
    assert of(glass, section, Plate(quartz, 30.0), glass, Plate(crossed, 20.0)) == pytest.approx(91.0, abs=1e-8)


def test_plates_that_do_not_share_axes_have_no_retardation() -> None:
    at_30 = Medium.uniaxial(*QUARTZ, (np.cos(np.pi / 6), 0.5, 0.0))
    assert retardation_nm([Plate(at_30, 30.0), Plate(Medium.uniaxial(*QUARTZ, X), 30.0)], [589.3]) is None
    barely = Medium.uniaxial(*QUARTZ, (np.cos(1e-4), np.sin(1e-4), 0.0))
    assert retardation_nm([Plate(barely, 30.0), Plate(Medium.uniaxial(*QUARTZ, X), 30.0)], [589.3]) is None
    rounded = Medium.uniaxial(*QUARTZ, (np.cos(1e-8), np.sin(1e-8), 0.0))
    assert retardation_nm([Plate(rounded, 30.0), Plate(Medium.uniaxial(*QUARTZ, X), 30.0)], [589.3]) is not None
    # Circular and linear waves do not agree either.
    active = Medium.uniaxial(*QUARTZ, Z).active(np.diag((0.0, 0.0, 1e-4)))
    assert retardation_nm([Plate(active, 30.0), Plate(Medium.uniaxial(*QUARTZ, X), 30.0)], [589.3]) is None
    # One wavelength at which they part is enough.
    turning = np.stack([np.array((np.cos(t), np.sin(t), 0.0)) for t in (0.0, 0.1)], axis=1)
    dispersed = Medium.uniaxial(*QUARTZ, turning)
    assert retardation_nm([Plate(dispersed, 30.0), Plate(Medium.uniaxial(*QUARTZ, X), 30.0)], [589.3, 600.0]) is None


def test_dispersion_and_an_evanescent_wave() -> None:
    medium = Medium.uniaxial(np.array((1.52, 1.53)), np.array((1.54, 1.56)), X)
    found = retardation_nm([Plate(medium, 10.0)], [700.0, 500.0])
    assert found is not None
    np.testing.assert_allclose(found, (200.0, 300.0), atol=1e-9)
    # Across the axis, s along x sees n_e and goes on; p along y sees n_o and does not.
    evanescent = retardation_nm([Plate(Medium.uniaxial(1.2, 1.6, X), 10.0)], [550.0], (0.0, 1.4, 0.0))
    assert evanescent is not None
    assert np.isnan(evanescent[0])


def test_path_lengths_bound_the_retardation_and_hold_the_round_trip() -> None:
    rng = np.random.default_rng(8)
    plates = [Plate(random_medium(rng, "biaxial"), 10.0), Plate(random_medium(rng, "uniaxial"), 20.0)]
    difference, round_trip = path_lengths_nm(plates, [550.0])
    each = [of(plate, wavelength=550.0) for plate in plates]
    assert difference[0] == pytest.approx(sum(each))
    highest = [max(p.medium.indices) for p in plates]
    assert round_trip[0] <= 2e3 * (10.0 * highest[0] + 20.0 * highest[1]) + 1e-9


def test_degree_of_coherence_is_the_average_of_the_phase_factor_over_the_band() -> None:
    """A box of 4 nm about 550: to first order in Δλ/λ, with the phase of the middle taken out."""
    wavelengths = 550.0 + 4.0 * ((np.arange(4000) + 0.5) / 4000 - 0.5)
    for retardation in (500.0, 2e4, 75625.0, 1e5):
        average = np.mean(np.exp(2j * np.pi * retardation * (1 / wavelengths - 1 / 550.0)))
        assert degree_of_coherence(retardation, 4.0, 550.0) == pytest.approx(average.real, abs=1e-2)
    assert degree_of_coherence(550.0**2 / 4.0, 4.0, 550.0) == pytest.approx(0.0, abs=1e-15)
    np.testing.assert_allclose(degree_of_coherence([0.0, 550.0**2 / 8.0], 4.0, 550.0), (1.0, 2 / np.pi))


@pytest.mark.parametrize(
    ("arguments", "pointer"), [((1.0, -1.0, 550.0), "/band_nm"), ((1.0, 1.0, 0.0), "/wavelength_nm")]
)
def test_bad_bands_are_named(arguments: tuple[float, float, float], pointer: str) -> None:
    with pytest.raises(InputError, match=pointer):
        degree_of_coherence(*arguments)


def test_bad_wavelengths_and_directions_are_named() -> None:
    plate = Plate(Medium.isotropic(1.5), 1.0)
    with pytest.raises(InputError, match="/wavelength_nm"):
        retardation_nm([plate], [-1.0])
    with pytest.raises(InputError, match="/tangential_k"):
        retardation_nm([plate], [550.0], (np.nan, 0.0, 0.0))
