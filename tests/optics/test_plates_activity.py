"""Optical activity in plates: rotation along the axis, its sense, and what it is not."""

from __future__ import annotations

import numpy as np
import pytest

from crystal_core.optics.arrays import Real
from crystal_core.optics.berreman import activity, berreman_matrix
from crystal_core.optics.medium import Medium
from crystal_core.optics.plates import Coherence, Plate, plate_stack
from crystal_core.optics.retardation import retardation_nm

Z = np.array((0.0, 0.0, 1.0))
QUARTZ = (1.5442, 1.5533)
RHO = np.radians(21.724)
"""Rotation of quartz along c at 589.3 nm, rad/mm."""
G = RHO * 589.3e-6 * QUARTZ[0] / np.pi
"""ρ = π G/(λ n)."""


def dextro(gyration: Real, axis: Real = Z) -> Medium:
    return Medium.uniaxial(*QUARTZ, axis).active(gyration)


def azimuth_deg(mueller: Real, polarizer_deg: float) -> float:
    """Direction of the light behind a plate, from x towards y, mod 180°."""
    double = 2 * np.radians(polarizer_deg)
    light = mueller @ np.array((1.0, np.cos(double), np.sin(double), 0.0))
    return float(0.5 * np.degrees(np.arctan2(light[2], light[1])))


@pytest.mark.parametrize("gyration", [np.diag((0.0, 0.0, G)), np.diag((-0.6 * G, -0.6 * G, G)), G * np.eye(3)])
@pytest.mark.parametrize("coherent", ["exact", "single-pass"])
def test_light_along_the_axis_is_turned(gyration: Real, coherent: Coherence) -> None:
    """Only G along the axis counts. Index-matched, as the faces would mix in multiple beams."""
    plate = Plate(dextro(gyration), 1000.0)
    m = plate_stack([plate], [589.3], QUARTZ[0], coherent=coherent).mueller_transmitted[:, :, 0]
    # Light goes along +z to an observer who faces the source and sees x to y counter-clockwise: dextro is clockwise.
    assert azimuth_deg(m, 0.0) == pytest.approx(-21.724, abs=1e-5)
    assert azimuth_deg(m, 30.0) == pytest.approx(30 - 21.724, abs=1e-5)
    assert m[0, 0] == pytest.approx(1.0, abs=1e-8)
    assert abs(m[3, 1]) < 1e-7  # it stays linear


def test_circular_waves_have_indices_n_plus_and_minus_half_g_over_n() -> None:
    """n_R − n_L = −λ ρ/π … and their difference is the retardation of the section."""
    plate = Plate(dextro(np.diag((0.0, 0.0, G))), 1000.0)
    retardation = retardation_nm([plate], [589.3])
    assert retardation is not None
    assert retardation[0] == pytest.approx(589.3 * RHO / np.pi, rel=1e-6)
    t = plate_stack([plate], [589.3], QUARTZ[0]).jones_transmitted
    assert t is not None
    counter_clockwise, clockwise = np.array((1, 1j)), np.array((1, -1j))
    for field in (counter_clockwise, clockwise):
        out = t[:, :, 0] @ field
        assert abs(np.vdot(field, out)) / 2 == pytest.approx(1.0, abs=1e-8)
    lag = np.vdot(counter_clockwise, t[:, :, 0] @ counter_clockwise) / np.vdot(clockwise, t[:, :, 0] @ clockwise)
    # the counter-clockwise wave is the slower one in a dextro crystal: E = (1, i) turns back by 2ρd in phase
    assert np.angle(lag) == pytest.approx(2 * RHO, abs=1e-6)


def test_any_isotropic_gyration_turns_in_any_direction_of_a_cubic_crystal() -> None:
    g = 1e-4
    medium = Medium.isotropic(1.5).active(g * np.eye(3))
    kappa = 0.9
    m = plate_stack([Plate(medium, 500.0)], [589.3], 1.5, (kappa, 0.0, 0.0)).mueller_transmitted[:, :, 0]
    path_mm = 0.5 / np.sqrt(1 - (kappa / 1.5) ** 2)
    expected = -np.degrees(np.pi * g / (589.3e-6 * 1.5) * path_mm)
    assert azimuth_deg(m, 0.0) == pytest.approx(expected, abs=2e-3)  # faces: second order in g


def test_left_and_right_turn_alike_and_there_and_back_do_not_cancel() -> None:
    right = plate_stack([Plate(dextro(np.diag((0, 0, G))), 700.0)], [589.3], QUARTZ[0]).mueller_transmitted[:, :, 0]
    left = plate_stack([Plate(dextro(np.diag((0, 0, -G))), 700.0)], [589.3], QUARTZ[0]).mueller_transmitted[:, :, 0]
    assert azimuth_deg(left, 0.0) == pytest.approx(-azimuth_deg(right, 0.0), abs=1e-9)
    # The crystal turned over is the same crystal: natural activity, not Faraday's.
    over = dextro(np.diag((0.0, 0.0, G)), -Z)
    again = plate_stack([Plate(over, 700.0)], [589.3], QUARTZ[0]).mueller_transmitted[:, :, 0]
    np.testing.assert_allclose(again, right, atol=1e-12)


def test_activity_hides_behind_birefringence_away_from_the_axis() -> None:
    """60° from the axis the modes' ellipticity is G/(2 n Δn) ≪ 1; k is that of the crystal without activity, nearly."""
    tilted = np.array((np.sin(np.pi / 3), 0.0, 0.5))
    plain = Plate(Medium.uniaxial(*QUARTZ, tilted), 100.0)
    active = Plate(dextro(np.diag((G, G, G)), tilted), 100.0)
    first, second = retardation_nm([plain], [589.3]), retardation_nm([active], [589.3])
    assert first is not None
    assert second is not None
    # Γ² = Γ_linear² + Γ_circular² (the modes' splitting, Born & Wolf §15 / Szivessy)
    circular = 0.1 * 589.3 * RHO / np.pi
    assert second[0] == pytest.approx(np.hypot(first[0], circular), rel=1e-4)


def test_matrix_keeps_energy_and_is_berremans_without_activity() -> None:
    rng = np.random.default_rng(2)
    a = rng.normal(size=(5, 3, 3))
    epsilon = np.einsum("nij,nkj->nik", a, a) + 2 * np.eye(3)
    kx, ky = rng.uniform(-1, 1, (2, 5))
    b = rng.normal(size=(5, 3, 3)) * 1e-2
    kappa = b + b.swapaxes(1, 2)
    active = berreman_matrix(epsilon, kx, ky, kappa)
    metric = np.fliplr(np.diag((1.0, -1.0, -1.0, 1.0)))
    hermitian = np.einsum("ij,njk->nik", metric, active)
    np.testing.assert_allclose(hermitian, np.conj(hermitian).swapaxes(1, 2), atol=1e-12)
    plain = berreman_matrix(epsilon, kx, ky)
    assert not np.iscomplexobj(plain)
    np.testing.assert_allclose(berreman_matrix(epsilon, kx, ky, 0 * kappa), plain, atol=1e-14)


def test_condons_tensor() -> None:
    """κ along the axis is G/(2 n), whatever g is across."""
    kappa = activity(dextro(np.diag((0.3, 0.3, 0.1))))
    assert kappa is not None
    np.testing.assert_allclose(np.diag(kappa), np.array((0.05, 0.05, 0.25)) / QUARTZ[0], atol=1e-15)
    assert activity(Medium.isotropic(1.5)) is None
    many = activity(Medium.isotropic(np.array((1.5, 1.6))).active(np.eye(3)))
    assert many is not None
    np.testing.assert_allclose(many[0, 0], (1 / 3.0, 1 / 3.2))
