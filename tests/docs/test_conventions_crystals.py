"""Signs and frames that docs/conventions.md states of crystals of all classes and of plates, one test each."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials import medium as mineral_medium
from crystal_core.optics import Coherency, Medium, Wave, absorption_along_ray, scatter
from crystal_core.optics.conical import internal_cone
from crystal_core.optics.directions import waves_along
from crystal_core.optics.indicatrix import BiaxialIndicatrix, dissipation, optic_axes, optical_class, permittivity
from crystal_core.optics.mueller import degree_of_polarization, frame_rotation, mueller, rotated_jones, transported
from tests.docs.blocks import section
from tests.docs.reversed_paths import units

Real = NDArray[np.float64]

PAGE = "docs/conventions.md"
AIR = Medium.isotropic(1.0)
NORMAL = np.array((0.0, 0.0, 1.0))
SODIUM = np.array((589.3,))

ALPHA, BETA, GAMMA = 1.2, 1.42, 2.2
AXES = np.array(((0.6, 0.48, 0.64), (-0.8, 0.36, 0.48), (0.0, -0.8, 0.6)))
"""Of γ, α, β: the medium below gives its indices in that order."""
BIAXIAL = Medium.biaxial((GAMMA, ALPHA, BETA), AXES)
ARAGONITE = Medium.biaxial((1.53, 1.681, 1.6854), np.eye(3))


# Media


def test_materials_turn_the_crystal_into_the_world() -> None:
    turn = np.array(((0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)))
    calcite = mineral_medium(minerals_db.mineral("calcite"), SODIUM, turn)
    assert calcite.axis is not None
    np.testing.assert_allclose(calcite.axis, turn @ NORMAL)  # z of the crystal is the optic axis
    aragonite = minerals_db.mineral("aragonite")
    upright, turned = (permittivity(mineral_medium(aragonite, SODIUM, r))[:, :, 0] for r in (np.eye(3), turn))
    np.testing.assert_allclose(np.diag(np.diag(upright)), upright)  # x, y, z along a, b, c
    np.testing.assert_allclose(turned, turn @ upright @ turn.T, atol=1e-15)
    with pytest.raises(InputError):
        mineral_medium(aragonite, SODIUM, np.diag((1.0, 1.0, -1.0)))


def test_a_tensor_does_not_look_at_signs_of_its_directions() -> None:
    expected = sum(n * n * np.outer(x, x) for n, x in zip((GAMMA, ALPHA, BETA), AXES, strict=True))
    np.testing.assert_allclose(permittivity(BIAXIAL), expected, atol=1e-15)
    mirrored = Medium.biaxial((GAMMA, ALPHA, BETA), AXES * np.array((-1.0, 1.0, 1.0))[:, None])
    np.testing.assert_array_equal(permittivity(mirrored), permittivity(BIAXIAL))


def test_two_equal_indices_make_a_medium_uniaxial_but_keep_its_names() -> None:
    twice = Medium.biaxial((1.5, 1.6, 1.5), np.eye(3))
    assert optical_class(twice) == "uniaxial"
    np.testing.assert_allclose(optic_axes(twice)[0], (0.0, 1.0, 0.0))
    waves = scatter(NORMAL, np.array(((0.3,), (0.2,), (0.0,))), AIR, twice).transmitted
    assert [str(wave.mode[0]) for wave in waves] == ["slow", "fast"]
    same = scatter(NORMAL, np.array(((0.3,), (0.2,), (0.0,))), AIR, Medium.uniaxial(1.5, 1.6, (0.0, 1.0, 0.0)))
    for wave, other in zip(waves, same.transmitted[::-1], strict=True):
        np.testing.assert_allclose(wave.ray, other.ray, atol=1e-14)


def test_names_are_given_after_sorting_at_each_wavelength() -> None:
    crossing = BiaxialIndicatrix.of(Medium.biaxial((np.array((1.50, 1.52)), np.array((1.51, 1.51)), 1.6), np.eye(3)))
    np.testing.assert_allclose(crossing.alpha, (1.50, 1.51))
    np.testing.assert_allclose(crossing.axes[0], np.array(((1.0, 0.0), (0.0, 1.0), (0.0, 0.0))))


def test_optic_axes_lie_at_v_z_from_gamma_towards_alpha() -> None:
    indicatrix = BiaxialIndicatrix.of(BIAXIAL)
    lower, upper = ALPHA**-2 - BETA**-2, BETA**-2 - GAMMA**-2
    assert np.tan(indicatrix.v_z) ** 2 == pytest.approx(lower / upper)
    gamma, alpha = AXES[0], AXES[1]
    cos, sin = np.cos(indicatrix.v_z), np.sin(indicatrix.v_z)
    for axis, sign in zip(indicatrix.optic_axes(), (1.0, -1.0), strict=True):
        np.testing.assert_allclose(axis, cos * gamma + sign * sin * alpha, atol=1e-15)
        slow, fast = waves_along(BIAXIAL, axis[:, None])
        assert (slow.index[0], fast.index[0]) == pytest.approx((BETA, BETA))


def test_2v_is_acute_and_the_sign_is_that_of_the_acute_bisectrix() -> None:
    positive, negative = BiaxialIndicatrix.of(BIAXIAL), BiaxialIndicatrix.of(ARAGONITE)
    assert positive.is_positive()
    assert float(positive.two_v()) == pytest.approx(2.0 * float(positive.v_z))
    assert not negative.is_positive()
    assert float(negative.two_v()) == pytest.approx(np.pi - 2.0 * float(negative.v_z))
    for n, v_z, is_positive in (((1.5, 1.5, 1.6), 0.0, True), ((1.5, 1.6, 1.6), 90.0, False)):
        limit = BiaxialIndicatrix.of(Medium.biaxial(n, np.eye(3)))
        assert np.rad2deg(limit.v_z) == pytest.approx(v_z)
        assert bool(limit.is_positive()) is is_positive


def test_the_angles_of_aragonite() -> None:
    indicatrix = BiaxialIndicatrix.of(ARAGONITE)
    outside = 2.0 * np.rad2deg(np.arcsin(1.681 * np.sin(0.5 * indicatrix.two_v())))
    v_z, two_v = np.rad2deg(indicatrix.v_z), np.rad2deg(indicatrix.two_v())
    assert f"V_z = {v_z:.2f}°, 2V = {two_v:.2f}°, negative, 2E = {outside:.2f}°" in section(PAGE, "Media")


# Biaxial waves


def angles_to_axes(s: Real) -> tuple[Real, Real]:
    """Return the angles θ₁, θ₂ of wave normals, (3, N), to the optic axes."""
    first, second = (np.arccos(np.clip(axis @ s, -1.0, 1.0)) for axis in BiaxialIndicatrix.of(BIAXIAL).optic_axes())
    return first, second


def test_indices_follow_from_the_angles_to_the_optic_axes() -> None:
    s = units(np.random.default_rng(1), 200)
    one, two = angles_to_axes(s)
    slow, fast = waves_along(BIAXIAL, s)
    for wave, angle in ((slow, one + two), (fast, one - two)):
        inverse_square = 0.5 * (ALPHA**-2 + GAMMA**-2) + 0.5 * (ALPHA**-2 - GAMMA**-2) * np.cos(angle)
        np.testing.assert_allclose(wave.index**-2.0, inverse_square, rtol=1e-12)
    assert np.all(slow.index >= fast.index)


def test_vibrations_halve_the_angles_between_the_planes_of_the_axes() -> None:
    s = units(np.random.default_rng(2), 200)
    u = [np.cross(s, axis[:, None], axis=0) for axis in BiaxialIndicatrix.of(BIAXIAL).optic_axes()]
    first, second = (v / np.linalg.norm(v, axis=0) for v in u)
    slow, fast = waves_along(BIAXIAL, s)
    for wave, direction in ((fast, first + second), (slow, first - second)):
        across = np.cross(wave.d, direction, axis=0)
        assert np.max(np.linalg.norm(across, axis=0) / np.linalg.norm(wave.d, axis=0)) < 1e-12
        assert np.max(wave.walk_off()) > np.deg2rad(10.0)  # neither is ordinary


def test_the_other_end_of_one_axis_would_not_do() -> None:
    s = units(np.random.default_rng(3), 50)
    one, two = angles_to_axes(s)
    slow, fast = waves_along(BIAXIAL, s)
    for sign in (1.0, -1.0):
        wrong = 0.5 * (ALPHA**-2 + GAMMA**-2) + 0.5 * (ALPHA**-2 - GAMMA**-2) * np.cos(one + sign * (np.pi - two))
        right = slow.index**-2.0 if sign > 0 else fast.index**-2.0
        assert np.median(np.abs(wrong / right - 1.0)) > 0.1
    # With u₂ turned round the sum of u₁ and u₂ is the vibration of the slow wave.
    u = [np.cross(s, axis[:, None], axis=0) for axis in BiaxialIndicatrix.of(BIAXIAL).optic_axes()]
    first, second = (v / np.linalg.norm(v, axis=0) for v in u)
    np.testing.assert_allclose(np.cross(slow.d, first + -second, axis=0), 0.0, atol=1e-11)


def test_every_vibration_across_an_optic_axis_has_a_ray_of_its_own() -> None:
    cone = internal_cone(ARAGONITE)
    assert np.rad2deg(cone.aperture()) == pytest.approx(1.88, abs=0.005)
    half = np.array((0.0, 0.5 * np.pi))
    np.testing.assert_allclose(
        cone.directions(half + np.pi), cone.directions(half), atol=1e-15
    )  # half a turn: once around
    np.testing.assert_allclose(cone.directions(half)[:, 1], cone.axis, atol=1e-15)


def dimple_line(offset: float) -> tuple[Real, tuple[Wave, Wave], tuple[Wave, Wave]]:
    """Return the normal of a face that passes near the dimple, and the incident and reflected waves in the crystal.

    It runs across the biradial m, to which the common tangent of both sheets of the plane of α and γ is normal; so the
    offset from it is negative where it passes through the dimple.
    """
    across, along = np.sqrt(BETA**2 - ALPHA**2), np.sqrt(GAMMA**2 - BETA**2)
    m = (across * AXES[1] + along * AXES[0]) / np.hypot(across, along)
    normal = (along * AXES[1] - across * AXES[0]) / np.hypot(across, along)
    event = scatter(normal, (BETA + offset) * m[:, None], BIAXIAL, AIR)
    return normal, event.incident, event.reflected


def test_through_a_dimple_both_waves_of_a_side_are_slow() -> None:
    normal, incident, reflected = dimple_line(-0.016)
    normal_parts = []
    for waves, sign in ((incident, 1.0), (reflected, -1.0)):
        for wave in waves:
            assert wave.propagating[0]
            assert str(wave.mode[0]) == "slow"
            assert np.sign(wave.flux[0]) == sign
            normal_parts.append((float(wave.k[:, 0] @ normal), sign))
    # q₁ forward, q₂ backward, q₃ forward, q₄ backward.
    assert [sign for _, sign in sorted(normal_parts, reverse=True)] == [1.0, -1.0, 1.0, -1.0]
    assert normal_parts[0][0] == max(q for q, _ in normal_parts)  # mode 0 has q₁


def test_four_roots_away_from_a_dimple_are_slow_and_fast() -> None:
    event = scatter(NORMAL, np.array(((0.5,), (0.3,), (0.0,))), BIAXIAL, AIR)
    for waves, sign in ((event.incident, 1.0), (event.reflected, -1.0)):
        slow, fast = waves
        assert [str(wave.mode[0]) for wave in waves] == ["slow", "fast"]
        assert sign * slow.k[2, 0] > sign * fast.k[2, 0] > 0.0
        assert sign * slow.flux[0] > 0.0
        assert sign * fast.flux[0] > 0.0


def test_inhibited_reflection() -> None:
    event = scatter(NORMAL, np.array(((1.48,), (0.0,), (0.0,))), Medium.biaxial((1.4, 1.45, 1.6), np.eye(3)), AIR)
    slow, other = event.reflected
    assert str(slow.mode[0]) == "slow"
    assert slow.propagating[0]
    assert not other.propagating[0]
    assert other.k_imag[2, 0] < 0.0  # decays along −z
    assert event.power_reflected[0][0][0] == pytest.approx(1.0)
    assert event.power_reflected[1][0][0] == 0.0
    assert abs(event.amplitude_reflected[1][0][0]) >= 0.0  # an amplitude there is
    assert np.isnan(event.power_reflected[0][1][0])  # the second wave cannot come in


# Absorption


def test_the_absorption_surface_has_a_frame_of_its_own() -> None:
    turned = np.array(((np.cos(0.5), 0.0, np.sin(0.5)), (0.0, 1.0, 0.0), (-np.sin(0.5), 0.0, np.cos(0.5))))
    medium = ARAGONITE.absorbing((0.3, 1.0, 2.0), turned)
    inverse = np.linalg.inv(permittivity(ARAGONITE))
    expected = sum(a / np.sqrt(u @ inverse @ u) * np.outer(u, u) for a, u in zip((0.3, 1.0, 2.0), turned, strict=True))
    np.testing.assert_allclose(dissipation(medium), expected, rtol=1e-12, atol=1e-15)

    s = units(np.random.default_rng(4), 50)
    for wave in waves_along(ARAGONITE, s):
        flow = np.linalg.norm(np.cross(wave.e, wave.h, axis=0), axis=0)
        by_hand = np.einsum("in,ij,jn->n", wave.e, expected, wave.e) / flow
        np.testing.assert_allclose(absorption_along_ray(medium, wave.k, wave.e.astype(complex)), by_hand, rtol=1e-12)


def test_waves_along_the_absorption_axes_are_absorbed_by_its_coefficients() -> None:
    medium = ARAGONITE.absorbing((0.3, 1.0, 2.0), np.eye(3))
    slow, fast = waves_along(medium, np.array(((0.0,), (1.0,), (0.0,))))  # along β: they vibrate along γ and α
    found = [absorption_along_ray(medium, wave.k, wave.e)[0] for wave in (slow, fast)]
    assert found == pytest.approx([2.0, 0.3])


# Jones and Mueller matrices


def test_elements_turn_counter_clockwise() -> None:
    along_x = np.zeros((2, 2, 1), np.complex128)
    along_x[0, 0] = 1.0
    turned = rotated_jones(along_x, np.deg2rad(30.0))[:, :, 0]
    at_30 = np.array((np.cos(np.pi / 6), 0.5))
    np.testing.assert_allclose(turned, np.outer(at_30, at_30), atol=1e-15)
    r = frame_rotation(0.3)[:, :, 0]
    np.testing.assert_allclose(r, ((np.cos(0.3), np.sin(0.3)), (-np.sin(0.3), np.cos(0.3))))


def test_mueller_matrices_are_those_of_the_stokes_parameters() -> None:
    rng = np.random.default_rng(6)
    jones = rng.normal(size=(2, 2, 5)) + 1j * rng.normal(size=(2, 2, 5))
    light = rng.normal(size=(2, 5)) + 1j * rng.normal(size=(2, 5))
    before = Coherency.pure(light[0], light[1], np.ones(5))
    behind = transported(before, jones)
    np.testing.assert_allclose(np.einsum("ijn,jn->in", mueller(jones), before.stokes()), behind.stokes(), atol=1e-12)
    np.testing.assert_allclose(degree_of_polarization(behind), 1.0, rtol=1e-12)
