"""Signs and frames that docs/conventions.md states of optical activity and of plates, one test each."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import minerals_db
from crystal_core.materials import medium as mineral_medium
from crystal_core.materials.plate_colour import transmittance
from crystal_core.optics import Coherency, Medium, scatter
from crystal_core.optics.berreman import activity, berreman_matrix
from crystal_core.optics.directions import waves_along
from crystal_core.optics.indicatrix import permittivity
from crystal_core.optics.plates import Coherence, Plate, plate_stack
from crystal_core.optics.retardation import degree_of_coherence, retardation_nm
from tests.docs.blocks import section

Real = NDArray[np.float64]

PAGE = "docs/conventions.md"
NORMAL = np.array((0.0, 0.0, 1.0))
SODIUM = np.array((589.3,))
BIAXIAL = Medium.biaxial((2.2, 1.2, 1.42), ((0.6, 0.48, 0.64), (-0.8, 0.36, 0.48), (0.0, -0.8, 0.6)))


# Optical activity


def quartz(sign: float = 1.0) -> Medium:
    """Return quartz of either hand, its axis along z."""
    right = mineral_medium(minerals_db.mineral("quartz"), SODIUM)
    assert right.gyration is not None
    return right if sign > 0 else Medium.uniaxial(right.indices[0], right.indices[1], NORMAL).active(-right.gyration)


def plane_behind(medium: Medium, thickness_mm: float) -> float:
    """Return the direction of vibration behind a plate of light that vibrates along x, degrees from x towards y."""
    optics = plate_stack([Plate(medium, 1e3 * thickness_mm)], SODIUM, 1.544, coherent="single-pass")
    assert optics.jones_transmitted is not None
    ex, ey = optics.jones_transmitted[:, 0, 0]
    return float(0.5 * np.rad2deg(np.arctan2(2 * (ex * np.conj(ey)).real, abs(ex) ** 2 - abs(ey) ** 2)))


def test_right_quartz_turns_clockwise_before_one_who_faces_the_source() -> None:
    turned = plane_behind(quartz(), 1.0)
    assert turned < 0.0  # x to the right, y up, light comes towards the observer: clockwise is negative
    gyration = quartz().gyration
    assert gyration is not None
    assert gyration[2, 2, 0] > 0.0
    rho = np.pi * gyration[2, 2, 0] / (SODIUM[0] * 1e-6 * quartz().indices[0][0])
    assert np.rad2deg(rho) == pytest.approx(-turned, rel=1e-6)
    assert f"{-turned:.1f}° per mm at 589 nm" in section(PAGE, "Optical activity")
    assert plane_behind(quartz(-1.0), 1.0) == pytest.approx(-turned, rel=1e-6)


def test_light_that_is_sent_back_turns_back() -> None:
    optics = plate_stack([Plate(quartz(), 1000.0)], SODIUM, 1.544, coherent="single-pass")
    assert optics.jones_transmitted is not None
    there = optics.jones_transmitted[:, :, 0]
    # Backward, with the axes of the field as they were, the matrix is the transposed one.
    both = there.T @ there
    assert abs(both[1, 0]) < 1e-9 * abs(both[0, 0])
    assert abs(there[1, 0]) > 0.3 * abs(there[0, 0])


def test_elliptical_modes_have_the_indices_stated() -> None:
    axis = np.array((np.sin(0.9), 0.0, np.cos(0.9)))
    n_o, n_e = 1.5442, 1.5533
    g = 1e-3 * (0.4 * np.eye(3) + 0.6 * np.outer(axis, axis))
    crystal = Medium.uniaxial(n_o, n_e, axis).active(g)
    kappa = activity(crystal)
    assert kappa is not None
    zero = np.zeros(1)
    roots = np.linalg.eigvals(berreman_matrix(permittivity(crystal)[None], zero, zero, kappa[None]))[0]
    ordinary, extraordinary = waves_along(Medium.uniaxial(n_o, n_e, axis), NORMAL[:, None])
    for root in roots:
        product = (root.real**2 - ordinary.index[0] ** 2) * (root.real**2 - extraordinary.index[0] ** 2)
        assert product == pytest.approx(float(NORMAL @ g @ NORMAL) ** 2, rel=0.02)
    # The gyration is the same for the wave that goes the other way.
    assert sorted(np.abs(roots.real))[::2] == pytest.approx(sorted(np.abs(roots.real))[1::2], rel=1e-12)


def test_the_slow_wave_of_right_quartz_turns_counter_clockwise() -> None:
    slow, fast = waves_along(quartz(), NORMAL[:, None])
    for wave, sign in ((slow, 1.0), (fast, -1.0)):
        light = Coherency.pure(wave.e[0], wave.e[1], np.ones(1))  # x, y and the propagation z are right-handed
        assert light.stokes()[:, 0] == pytest.approx((1.0, 0.0, 0.0, sign), abs=1e-9)
    gyration = quartz().gyration
    assert gyration is not None
    assert slow.index[0] - fast.index[0] == pytest.approx(gyration[2, 2, 0] / quartz().indices[0][0], rel=1e-4)
    assert [str(wave.mode[0]) for wave in (slow, fast)] == ["slow", "fast"]


def test_waves_of_an_active_medium_obey_the_stated_relations() -> None:
    crystal = quartz()
    kappa, eps, g = activity(crystal), permittivity(crystal)[:, :, 0], crystal.gyration
    assert kappa is not None
    assert g is not None
    kappa = kappa[:, :, 0]
    n_o = crystal.indices[0][0]
    np.testing.assert_allclose(kappa, (0.5 * np.trace(g[:, :, 0]) * np.eye(3) - g[:, :, 0]) / n_o, atol=1e-18)
    for wave in waves_along(crystal, np.array(((0.6,), (0.0,), (0.8,)))):
        k, d, e, h = (v[:, 0] for v in (wave.k, wave.d, wave.e, wave.h))
        np.testing.assert_allclose(d, eps @ e + 1j * kappa @ h, atol=1e-14)
        np.testing.assert_allclose(np.cross(k, e), h - 1j * kappa @ e, atol=1e-14)
        np.testing.assert_allclose(np.cross(k, h), -d, atol=1e-14)
        # Its partner is (−k, E*), with H = −H*.
        np.testing.assert_allclose(np.cross(-k, e.conj()), -h.conj() - 1j * kappa @ e.conj(), atol=1e-14)


def test_active_media_at_a_face_keep_the_energy_and_their_names() -> None:
    kt = np.array(((0.5,), (0.2,), (0.0,)))
    event = scatter(NORMAL, kt, quartz(), Medium.isotropic(1.0))
    assert [str(wave.mode[0]) for wave in (*event.incident, *event.reflected)] == ["slow", "fast"] * 2
    for j in (0, 1):
        total = sum(power[i][j][0] for power in (event.power_reflected, event.power_transmitted) for i in (0, 1))
        assert total == pytest.approx(1.0, abs=1e-12)
    # Reciprocity: the powers between each two modes are those of the path run backward.
    back = scatter(-NORMAL, -kt, Medium.isotropic(1.0), quartz())
    for i in (0, 1):
        through = sum(event.power_transmitted[p][i][0] for p in (0, 1))
        assert sum(back.power_transmitted[i][p][0] for p in (0, 1)) == pytest.approx(through, rel=1e-10)


# Plates


def test_light_meets_the_plates_in_their_order_and_z_goes_along_it() -> None:
    half = Plate(Medium.uniaxial(1.5442, 1.5533, (1.0, 0.0, 0.0)), 589.3 / 2 / 9.1)
    rotator = Plate(quartz(), 1000.0)
    one, two = (
        plate_stack(plates, SODIUM, 1.544, coherent="single-pass").jones_transmitted
        for plates in ([half, rotator], [rotator, half])
    )
    assert one is not None
    assert two is not None
    # Light along x passes the half-wave plate unchanged, then turns clockwise; or it turns first and is mirrored.
    for jones, sign in ((one, -1.0), (two, 1.0)):
        ex, ey = jones[:, 0, 0]
        assert np.sign((ex * np.conj(ey)).real) == sign


def test_angles_go_from_x_towards_y() -> None:
    at_30 = np.array((np.cos(np.pi / 6), 0.5, 0.0))
    dichroic = Medium.uniaxial(1.6, 1.6, at_30, (500.0, 0.0))  # lets through what vibrates along 30°
    optics = plate_stack([Plate(dichroic, 30.0)], SODIUM, 1.6)
    seen = [float(transmittance(optics.mueller_transmitted, angle, None)[0]) for angle in (30.0, -30.0, 120.0)]
    assert seen == pytest.approx([1.0, 0.25, 0.0], abs=1e-5)


def test_the_open_field_between_parallel_polars_is_one() -> None:
    open_field = plate_stack([], SODIUM).mueller_transmitted
    told = [
        transmittance(open_field, *polars)[0] for polars in ((20.0, 20.0), (20.0, 110.0), (20.0, None), (None, None))
    ]
    assert told == pytest.approx([1.0, 0.0, 1.0, 1.0], abs=1e-15)


def test_reflected_light_has_its_p_the_other_way() -> None:
    glass = plate_stack([Plate(Medium.isotropic(1.5), 0.001)], SODIUM)
    assert glass.jones_reflected is not None
    reflected = glass.jones_reflected[:, :, 0]
    assert reflected[0, 0] == pytest.approx(-reflected[1, 1])


def test_retardation_is_that_of_wave_vectors() -> None:
    crystal = Medium.uniaxial(1.5442, 1.5533, (1.0, 0.0, 0.0))
    crossed = Medium.uniaxial(1.5442, 1.5533, (0.0, 1.0, 0.0))
    askew = Medium.uniaxial(1.5442, 1.5533, (0.8, 0.6, 0.0))
    plate = Plate(crystal, 30.0)
    single = retardation_nm([plate], SODIUM)
    assert single is not None
    assert single[0] == pytest.approx(9.1e-3 * 30e3)
    for other, expected in ((crystal, 2.0), (crossed, 0.0)):
        both = retardation_nm([plate, Plate(other, 30.0)], SODIUM)
        assert both is not None
        assert both[0] == pytest.approx(expected * single[0], abs=1e-9)
    assert retardation_nm([plate, Plate(askew, 30.0)], SODIUM) is None
    # Inclined, it is the difference of normal parts, not index × length.
    kt = np.array((0.9, 0.0, 0.0))
    inclined = retardation_nm([plate], SODIUM, kt)
    q_o = np.sqrt(1.5442**2 - 0.81)
    q_e = np.sqrt(1.5442**2 * 1.5533**2 - 1.5533**2 * 0.81) / 1.5442
    assert inclined is not None
    assert inclined[0] == pytest.approx(abs(q_e - q_o) * 30e3, rel=1e-9)


@pytest.mark.parametrize("coherent", ["exact", "single-pass", "incoherent"])
def test_all_ways_of_adding_keep_the_energy(coherent: Coherence) -> None:
    plates = [Plate(BIAXIAL, 0.5), Plate(Medium.uniaxial(1.6584, 1.4864, (0.6, 0.0, 0.8)), 0.3)]
    optics = plate_stack(plates, SODIUM, 1.2, coherent=coherent)
    total = optics.mueller_transmitted[0, :, 0] + optics.mueller_reflected[0, :, 0]
    np.testing.assert_allclose(total, (1.0, 0.0, 0.0, 0.0), atol=1e-12)


def test_the_cross_term_fades_as_a_sinc() -> None:
    assert degree_of_coherence(1000.0, 5.0, 500.0) == pytest.approx(np.sin(0.02 * np.pi) / (0.02 * np.pi))
