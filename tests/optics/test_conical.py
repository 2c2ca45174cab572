"""Conical refraction: the cone in closed form against waves traced around an optic axis."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
import pytest

from crystal_core.errors import InputError, NotSupportedError
from crystal_core.optics.arrays import Real
from crystal_core.optics.conical import Cone, external_cone, internal_cone, trace_internal_cone
from crystal_core.optics.directions import waves_along
from crystal_core.optics.indicatrix import BiaxialIndicatrix, permittivity
from crystal_core.optics.medium import Medium
from crystal_core.optics.wave_surface import dual, wave_surface

AXES = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
ARAGONITE = Medium.biaxial((1.5300, 1.6810, 1.6854), AXES)
MEDIA = {
    "aragonite": ARAGONITE,
    "left-handed": Medium.biaxial((1.5300, 1.6810, 1.6854), -AXES),
    "positive": Medium.biaxial((1.6854, 1.5300, 1.5500), AXES),
    "huge": Medium.biaxial((1.2, 2.0, 4.0), AXES),
    "weak": Medium.biaxial((1.6, 1.6001, 1.6003), AXES),
}
BOTH: tuple[Literal[0, 1], ...] = (0, 1)


def unit(v: Real) -> Real:
    return np.asarray(v / np.linalg.norm(v, axis=0))


@pytest.mark.parametrize("which", BOTH)
def test_aragonite_has_the_cone_of_the_textbook(which: Literal[0, 1]) -> None:
    cone = internal_cone(ARAGONITE, which)
    assert np.degrees(cone.aperture()) == pytest.approx(1.882, abs=5e-4)
    assert np.tan(cone.aperture()) == pytest.approx(2 * cone.radius, rel=1e-14)
    alpha, beta, gamma = (1.5300, 1.6810, 1.6854)
    outside = external_cone(ARAGONITE, which)
    speeds = np.sqrt((alpha**-2 - beta**-2) * (beta**-2 - gamma**-2))
    assert 2 * cone.radius == pytest.approx(beta**2 * speeds, rel=1e-13)
    assert 2 * outside.radius == pytest.approx(alpha * gamma * speeds, rel=1e-13)  # v_y² to v_x v_z: Born & Wolf


@pytest.mark.parametrize("which", BOTH)
@pytest.mark.parametrize("name", MEDIA)
def test_the_traced_cone_tends_to_the_closed_one(name: str, which: Literal[0, 1]) -> None:
    """Ray and D of either wave, extrapolated from two narrow cones of wave normals to none."""
    medium = MEDIA[name]
    cone = internal_cone(medium, which)
    azimuth = np.linspace(0.0, 2 * np.pi, 90, endpoint=False) + 0.01
    wide = trace_internal_cone(medium, 4e-6, azimuth, which)
    narrow = trace_internal_cone(medium, 2e-6, azimuth, which)
    for far, near in zip(wide, narrow, strict=True):
        ray = unit(2 * near.ray - far.ray)
        turn = np.sign(np.sum(near.d * far.d, axis=0))
        d = unit(2 * unit(near.d) - turn * unit(far.d))
        x, y = cone.vibrations(np.array([0.0, 0.5 * np.pi])).T
        psi = np.arctan2(y @ d, x @ d)
        np.testing.assert_allclose(
            cone.vibrations(psi) * np.sign(np.sum(d * cone.vibrations(psi), axis=0)), d, atol=1e-9
        )
        np.testing.assert_allclose(cone.directions(psi), ray, atol=1e-9)


def test_a_narrower_cone_of_wave_normals_comes_nearer() -> None:
    azimuth = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)
    cone = internal_cone(ARAGONITE)
    errors = []
    for half_angle in (1e-3, 1e-4, 1e-5, 1e-6):
        slow = trace_internal_cone(ARAGONITE, half_angle, azimuth)[0]
        errors.append(np.max(distance_from_circle(cone, slow.ray)))
    np.testing.assert_allclose(np.log10(errors) - np.log10(errors[0]), [0, -1, -2, -3], atol=0.05)


def distance_from_circle(cone: Cone, directions: Real) -> Real:
    points = directions / (cone.axis @ directions)
    return np.asarray(np.abs(np.linalg.norm(points - cone.centre()[:, None], axis=0) - cone.radius))


@pytest.mark.parametrize("which", BOTH)
@pytest.mark.parametrize("name", MEDIA)
def test_each_vibration_of_the_axial_wave_has_its_ray(name: str, which: Literal[0, 1]) -> None:
    """Maxwell's equations of k = n_β o with any D across o, and the flow of energy of that wave."""
    medium = MEDIA[name]
    cone = internal_cone(medium, which)
    psi = np.linspace(-3.0, 3.0, 50)
    d = cone.vibrations(psi)
    k = np.sort(np.stack(medium.indices))[1] * cone.axis[:, None]
    np.testing.assert_allclose(cone.axis @ d, 0.0, atol=1e-15)
    e = np.linalg.inv(permittivity(medium)) @ d
    h = np.cross(k, e, axis=0)
    np.testing.assert_allclose(np.cross(k, h, axis=0), -d, atol=1e-14)
    np.testing.assert_allclose(unit(np.cross(e, h, axis=0)), cone.directions(psi), atol=1e-14)


@pytest.mark.parametrize("make", [internal_cone, external_cone])
@pytest.mark.parametrize("which", BOTH)
@pytest.mark.parametrize("name", MEDIA)
def test_the_cone_is_a_skew_circular_one_through_its_axis(
    name: str, which: Literal[0, 1], make: Callable[[Medium, int], Cone]
) -> None:
    cone = make(MEDIA[name], which)
    psi = np.linspace(0.0, np.pi, 37)
    directions = cone.directions(psi)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=0), 1.0, rtol=1e-15)
    np.testing.assert_allclose(distance_from_circle(cone, directions), 0.0, atol=1e-15)
    np.testing.assert_allclose(directions[:, 18], cone.axis, atol=1e-15)  # vibrations across the plane of the axes
    np.testing.assert_allclose(directions[:, 0], directions[:, -1], atol=1e-15)
    # Around the circle the vibration turns by half the angle.
    points = directions / (cone.axis @ directions) - cone.centre()[:, None]
    x, y = cone.vibrations(np.array([0.0, 0.5 * np.pi])).T
    np.testing.assert_allclose(np.unwrap(np.arctan2(y @ points, x @ points)), 2 * psi, atol=1e-11)
    np.testing.assert_allclose(np.cross(x, y), cone.axis, atol=1e-15)
    # The whole angle is that between the axis and the far side of the circle, both in the plane of the optic axes.
    far = np.arctan2(np.linalg.norm(np.cross(cone.axis, directions[:, 0])), cone.axis @ directions[:, 0])
    assert far == pytest.approx(cone.aperture(), rel=1e-10)
    beta = BiaxialIndicatrix.of(MEDIA[name]).axes[1]
    assert beta @ cone.axis == pytest.approx(0.0, abs=1e-15)
    assert beta @ directions[:, 0] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("which", BOTH)
def test_slow_and_fast_rays_are_opposite_and_go_once_around(which: Literal[0, 1]) -> None:
    cone = internal_cone(ARAGONITE, which)
    azimuth = np.linspace(0.0, 2 * np.pi, 61)
    angles = []
    for wave in trace_internal_cone(ARAGONITE, 1e-6, azimuth, which):
        points = wave.ray / (cone.axis @ wave.ray) - cone.centre()[:, None]
        x, y = cone.vibrations(np.array([0.0, 0.5 * np.pi])).T
        angles.append(np.unwrap(np.arctan2(y @ points, x @ points)))
    slow, fast = angles
    np.testing.assert_allclose(np.abs(slow[-1] - slow[0]), 2 * np.pi, atol=1e-4)
    np.testing.assert_allclose(np.cos(slow - fast), -1.0, atol=1e-4)


@pytest.mark.parametrize("which", BOTH)
@pytest.mark.parametrize("name", MEDIA)
def test_the_rays_of_one_wave_normal_end_on_one_plane_of_the_ray_surface(name: str, which: Literal[0, 1]) -> None:
    """The plane across the optic axis at 1/n_β touches the ray surface along the circle."""
    medium = MEDIA[name]
    cone = internal_cone(medium, which)
    n_beta = np.sort(np.stack(medium.indices))[1]
    rays = cone.directions(np.linspace(0.05, 3.0, 25))
    # Of the two ray velocities along each ray, one must reach the plane: k·r = 1.
    reached = [n_beta * (cone.axis @ rays) * wave.index for wave in waves_along(dual(medium), rays)]
    np.testing.assert_allclose(np.min(np.abs(np.array(reached) - 1), axis=0), 0.0, atol=1e-13)
    # No ray vector reaches beyond it.
    for sheet in (wave_surface(medium, "ray", 12).outer, wave_surface(medium, "ray", 12).inner):
        assert np.max(n_beta * (cone.axis @ sheet.vertices)) <= 1 + 1e-14


@pytest.mark.parametrize("which", BOTH)
@pytest.mark.parametrize("name", MEDIA)
def test_every_wave_normal_of_the_external_cone_has_the_ray_of_the_biradial(name: str, which: Literal[0, 1]) -> None:
    medium = MEDIA[name]
    cone = external_cone(medium, which)
    optic = internal_cone(medium, which)
    assert cone.axis @ optic.axis > np.cos(optic.aperture() + external_cone(medium, which).aperture())
    psi = np.linspace(-1.3, 1.3, 20)
    s, e = cone.directions(psi), cone.vibrations(psi)
    errors, fields = [], []
    for wave in waves_along(medium, s):
        errors.append(np.linalg.norm(wave.ray - cone.axis[:, None], axis=0))
        fields.append(np.linalg.norm(np.cross(wave.e, e, axis=0), axis=0))
    # Near the optic axis the direction keeps 1e-16/θ; the birefringence of "weak" makes its cones that narrow.
    bound = 1e-12 if name != "weak" else 1e-11
    np.testing.assert_allclose(np.min(errors, axis=0), 0.0, atol=bound)
    np.testing.assert_allclose(np.min(fields, axis=0), 0.0, atol=bound / cone.radius)


@pytest.mark.parametrize(
    ("medium", "pointer"),
    [
        (Medium.isotropic(1.5), "/indices"),
        (Medium.uniaxial(1.5, 1.6, (0, 0, 1)), "/indices"),
        (Medium.biaxial((1.5, 1.6, 1.5), AXES), "/indices"),
        (Medium.biaxial((1.5, 1.6, [1.7, 1.8]), AXES), ""),
        (Medium.biaxial((1.5, 1.6, 1.7), AXES[:, :, None]), ""),
    ],
)
def test_other_media_have_no_cone(medium: Medium, pointer: str) -> None:
    for make in (internal_cone, external_cone):
        with pytest.raises(InputError) as caught:
            make(medium)
        assert [fault.pointer for fault in caught.value.faults] == [pointer]


def test_wrong_input_is_named() -> None:
    with pytest.raises(InputError, match="/which"):
        internal_cone(ARAGONITE, 2)  # type: ignore[arg-type]
    for half_angle in (0.0, -0.1, 2.0, np.nan):
        with pytest.raises(InputError, match="/half_angle"):
            trace_internal_cone(ARAGONITE, half_angle, np.zeros(1))
    with pytest.raises(NotSupportedError, match="gyration"):
        internal_cone(ARAGONITE.active(np.eye(3) * 1e-4))
