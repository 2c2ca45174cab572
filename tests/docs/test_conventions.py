"""Signs and frames that docs/conventions.md states, one test each."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.typing import NDArray

from crystal_core.geometry.lattice import direct_basis, face_normal
from crystal_core.optics import Coherency, Medium, Scattering, Wave, scatter, transverse_frame
from crystal_core.render import QUALITIES
from crystal_core.sequence import RenderRequest, frame_angle_deg, manifest, parse_request, render_tile
from tests.docs.blocks import ROOT
from tests.reference.block_trace import MODES, ModeName, find_image

Real = NDArray[np.float64]

GLASS, DENSE, AIR = Medium.isotropic(1.5), Medium.isotropic(2.0), Medium.isotropic(1.0)
N_O, N_E = 1.658, 1.486
AXIS = np.array((0.48, 0.6, 0.64))
CALCITE = Medium.uniaxial(N_O, N_E, AXIS)
EPS = N_O**2 * np.eye(3) + (N_E**2 - N_O**2) * np.outer(AXIS, AXIS)


def at_face(source: Medium, target: Medium, kappa: float) -> Scattering:
    """Return the scattering at a face with normal +z and plane of incidence x, z."""
    return scatter((0.0, 0.0, 1.0), np.array(((kappa,), (0.0,), (0.0,))), source, target)


def vectors(wave: Wave) -> tuple[NDArray[np.complex128], NDArray[np.complex128], Real]:
    """Return k, E and the ray of the only wave of a batch."""
    return wave.k[:, 0] + 1j * wave.k_imag[:, 0], wave.field[:, 0], wave.ray[:, 0]


def test_a_wave_decays_along_its_way() -> None:
    beyond = at_face(GLASS, AIR, 1.2).transmitted[0]
    assert beyond.k_imag[2, 0] == pytest.approx(np.sqrt(1.2**2 - 1.0))  # exp(i k·r) with Im k_z > 0


def test_total_reflection_of_s_has_a_negative_phase() -> None:
    q1, q2 = np.sqrt(1.5**2 - 1.2**2), np.sqrt(1.2**2 - 1.0)
    r_s = at_face(GLASS, AIR, 1.2).amplitude_reflected[0][0][0]
    assert r_s == pytest.approx((q1 - 1j * q2) / (q1 + 1j * q2))
    assert np.angle(r_s) < 0.0


@pytest.mark.parametrize("side", ["incident", "reflected", "transmitted"])
def test_p_s_and_propagation_are_right_handed(side: str) -> None:
    s, p = (vectors(wave) for wave in getattr(at_face(AIR, GLASS, 0.6), side))
    np.testing.assert_allclose(s[1], (0.0, 1.0, 0.0))
    k = s[0].real
    np.testing.assert_allclose(np.cross(p[1].real, s[1].real), k / np.linalg.norm(k), atol=1e-15)


def test_at_normal_incidence_on_glass_r_s_and_r_p_differ_in_sign() -> None:
    r = at_face(AIR, GLASS, 0.0).amplitude_reflected
    assert (r[0][0][0], r[1][1][0]) == pytest.approx((-0.2, 0.2))


def test_waves_of_a_uniaxial_medium_are_those_derived() -> None:
    ordinary, extraordinary = at_face(AIR, CALCITE, 0.7).transmitted
    k, e, ray = vectors(ordinary)
    assert k @ k == pytest.approx(N_O**2)
    assert np.linalg.norm(np.cross(e, np.cross(k, AXIS))) < 1e-14  # E ∥ m
    np.testing.assert_allclose(ray, k.real / N_O, atol=1e-15)

    k, e, ray = vectors(extraordinary)
    assert k @ EPS @ k == pytest.approx((N_O * N_E) ** 2)
    field = np.linalg.solve(EPS, -np.cross(k, np.cross(k, AXIS)))
    assert np.linalg.norm(np.cross(e, field)) < 1e-14
    np.testing.assert_allclose(ray, (EPS @ k).real / np.linalg.norm(EPS @ k), atol=1e-15)


def test_each_wave_solves_maxwells_equations() -> None:
    face = at_face(CALCITE, CALCITE, 0.7)
    for wave in (*face.incident, *face.reflected, *face.transmitted):
        k, e, ray = vectors(wave)
        h = np.cross(k, e)
        np.testing.assert_allclose(np.cross(k, h), -EPS @ e, atol=1e-13)
        flow = np.cross(e, h.conj()).real
        np.testing.assert_allclose(ray, flow / np.linalg.norm(flow), atol=1e-14)


def test_the_sign_of_the_root_is_that_of_the_energy() -> None:
    # An axis so far over that one wave's k and ray stand on different sides of the face.
    rutile = Medium.uniaxial(2.61, 2.9, np.array((np.sqrt(0.5), 0.0, np.sqrt(0.5))))
    for kappa in (2.75, -2.75):
        forward = at_face(rutile, AIR, kappa).incident[1]
        backward = at_face(rutile, AIR, kappa).reflected[1]
        assert forward.ray[2, 0] > 0.0 > backward.ray[2, 0]
    k_z = [at_face(rutile, AIR, kappa).incident[1].k[2, 0] for kappa in (2.75, -2.75)]
    assert min(k_z) < 0.0 < max(k_z)


def test_the_difference_of_the_two_roots() -> None:
    kappa, delta = 0.7, N_E**2 - N_O**2
    ordinary, extraordinary = at_face(AIR, CALCITE, kappa).transmitted
    q_o, q_e = ordinary.k[2, 0], extraordinary.k[2, 0]
    a = N_O**2 + delta * AXIS[2] ** 2
    b = delta * kappa * AXIS[0] * AXIS[2]
    root = np.sqrt(b * b - a * (kappa**2 * (N_O**2 + delta * AXIS[0] ** 2) - (N_O * N_E) ** 2))
    m = np.cross(ordinary.k[:, 0], AXIS)
    assert q_e == pytest.approx((root - b) / a, abs=1e-14)
    assert q_e - q_o == pytest.approx(delta * (m @ m) / (a * q_o + b + root), abs=1e-14)


def test_positive_s3_turns_counter_clockwise_before_the_observer() -> None:
    ex, ey = np.array([1.0 + 0.0j]), np.array([1.0j])
    light = Coherency.pure(ex, ey, np.array([0.5]))
    np.testing.assert_allclose(light.stokes()[:, 0], (1.0, 0.0, 0.0, 1.0), atol=1e-15)
    # The frame (x, y, propagation) is right-handed and the light comes towards the observer: x right, y up.
    early, late = (np.real(np.array((1.0, 1.0j)) * np.exp(-1j * phase)) for phase in (0.0, 0.1))
    assert early[0] * late[1] - early[1] * late[0] > 0.0


def test_frames_turn_counter_clockwise() -> None:
    along_x = Coherency.pure(np.array([1.0]), np.array([0.0]), np.array([1.0]))
    turned = along_x.rotated(np.array([np.cos(0.3)]), np.array([np.sin(0.3)]))
    # Seen from the turned frame the light vibrates clockwise of x'.
    assert turned.stokes()[:, 0] == pytest.approx((1.0, np.cos(0.6), -np.sin(0.6), 0.0))


def test_transverse_frames_are_right_handed() -> None:
    d = np.array(((0.6, 0.0, -0.48), (0.0, 0.0, 0.64), (0.8, -1.0, 0.6)))
    x, y = transverse_frame(d)
    np.testing.assert_allclose(np.cross(x, y, axis=0), d, atol=1e-15)


def reflection(direction: Real, normal: Real) -> tuple[NDArray[np.complex128], Real]:
    """Return what a face between dense glass and calcite does to fields in the glass, (3, 3), and the new direction."""
    k = 2.0 * direction
    tangential = k - (k @ normal) * normal
    face = scatter(normal, tangential[:, None], DENSE, CALCITE)
    matrix = sum(
        face.amplitude_reflected[i][j][0] * np.outer(face.reflected[i].field[:, 0], face.incident[j].field[:, 0].conj())
        for i in (0, 1)
        for j in (0, 1)
    )
    return matrix, (tangential - (k @ normal) * normal) / 2.0


def test_backward_light_meets_the_transpose_and_importance_its_conjugate() -> None:
    first, second = np.array((0.0, 0.0, 1.0)), np.array((0.28, -0.96, 0.0))
    start = np.array((0.8, 0.36, 0.48))  # steep enough to be reflected totally, with its phases
    one, between = reflection(start, first)
    two, end = reflection(between, second if between @ second > 0 else -second)
    forward = two @ one
    back_two, back_between = reflection(-end, second if -end @ second > 0 else -second)
    back_one, back_end = reflection(back_between, first)
    backward = back_one @ back_two
    np.testing.assert_allclose(back_end, -start, atol=1e-15)
    np.testing.assert_allclose(backward, forward.T, atol=1e-14)  # reciprocity, same axes, same medium at both ends

    # A measurement of circular light, and a partly polarized beam; the fields of both lie across their directions.
    x, y = (axis[:, 0] for axis in transverse_frame(end[:, None]))
    circular = x + 1j * y
    importance = 0.5 * np.outer(circular, circular.conj())
    u, v = (axis[:, 0] for axis in transverse_frame(start[:, None]))
    beam = np.outer(u + 0.3j * v, (u + 0.3j * v).conj()) + 0.4 * np.outer(v, v)
    measured = np.trace(importance @ forward @ beam @ forward.conj().T)
    assert measured == pytest.approx(np.trace(forward.conj().T @ importance @ forward @ beam))
    carried = backward @ importance.conj() @ backward.conj().T  # the forward rule, upon C = conj(W)
    assert np.trace(carried.conj() @ beam) == pytest.approx(measured)
    unconjugated = backward @ importance @ backward.conj().T
    assert abs(np.trace(unconjugated @ beam) - measured) > 0.01 * abs(measured)


def test_crystal_frame() -> None:
    basis = direct_basis((4.0, 5.0, 6.0), (90.0, 110.0, 90.0))
    np.testing.assert_allclose(basis[0], (4.0, 0.0, 0.0))
    np.testing.assert_allclose(basis[1], (0.0, 5.0, 0.0), atol=1e-15)  # monoclinic: y ∥ b
    np.testing.assert_allclose(face_normal(basis, (0, 0, 1)), (0.0, 0.0, 1.0), atol=1e-15)  # z ∥ c*


def asked(**parameters: object) -> RenderRequest:
    """Return a small request with the camera straight above."""
    given = {"camera_tilt_deg": 0, "size_mm": [20, 20, 8], **parameters}
    return parse_request(
        {
            "demonstration": "rotating-calcite",
            "parameters": given,
            "frames": 8,
            "size": [48, 48],
            "quality": "draft",
        }
    )


def test_the_stage_turns_counter_clockwise_and_does_not_repeat_360() -> None:
    request = asked(axis_tilt_deg=90, axis_azimuth_deg=10, first_angle_deg=20)
    angles = [frame_angle_deg(request, frame) for frame in range(8)]
    np.testing.assert_allclose(angles, 20.0 + 45.0 * np.arange(8))
    axis = request.staged(1, None).specimen.axis
    np.testing.assert_allclose(axis, (np.cos(np.deg2rad(75.0)), np.sin(np.deg2rad(75.0)), 0.0), atol=1e-15)


def test_cleavage_rhombs_lean_towards_x() -> None:
    specimen = asked(cut="cleavage").staged(0, None).specimen
    assert np.rad2deg(np.arctan2(specimen.axis[0], specimen.axis[2])) == pytest.approx(44.6, abs=0.1)
    assert specimen.axis[1] == pytest.approx(0.0, abs=1e-15)
    assert specimen.body.vertices[:, 2].min() == pytest.approx(0.02)


def test_camera_and_analyser_frames() -> None:
    camera = asked(camera_tilt_deg=30, analyser_deg=30).staged(0, None).camera
    assert camera.eye[1] < 0.0 < camera.forward[1]
    np.testing.assert_allclose(camera.right, (1.0, 0.0, 0.0), atol=1e-15)
    np.testing.assert_allclose(camera.up, np.cross(camera.right, camera.forward), atol=1e-15)
    along = np.cos(np.pi / 6) * camera.right + 0.5 * camera.up
    assert camera.analyser == pytest.approx(along)


def test_pixel_zero_is_top_left() -> None:
    # The middle of a page with nothing above it but a flat crystal; a large mark towards -x and +y.
    request = asked(marks=[[-6.0, 6.0]], mark_diameter_mm=4.0, vfov_deg=6.5, axis_tilt_deg=0, page_width_mm=400)
    grey = render_tile(request, 0, 0).pixels.mean(axis=-1)
    assert grey.shape == (48, 48)
    dark = np.argwhere(grey < 0.25 * np.median(grey))
    assert len(dark) > 20
    row, column = dark.mean(axis=0)
    assert row < 20.0
    assert column < 20.0


@pytest.mark.parametrize(("analyser_deg", "mode"), [(0.0, "extraordinary"), (90.0, "ordinary")])
def test_the_analyser_passes_fields_along_its_direction(analyser_deg: float, mode: ModeName) -> None:
    # Axis in the plane of x and z, seen from above: the extraordinary field is along x, the ordinary along y.
    mark = (0.0, 2.6)  # above the line that crosses the middle of the page
    request = asked(
        marks=[mark],
        mark_diameter_mm=2.0,
        vfov_deg=3.5,
        axis_tilt_deg=45,
        analyser_deg=analyser_deg,
        page_width_mm=400,
    )
    grey = render_tile(request, 0, 0).pixels.mean(axis=-1)[:21]
    row, column = np.argwhere(grey < 0.3 * np.median(grey)).mean(axis=0) + 0.5
    facts = manifest(request, [], complete=False)
    seen = {
        name: find_image(facts, mark, name, 0.0, facts["scene"]["n_o"], facts["scene"]["n_e"]).pixel for name in MODES
    }
    assert (column, row) == pytest.approx(seen[mode], abs=0.3)
    # In a negative crystal rays lean away from the axis: the extraordinary image stands towards -x.
    assert seen["extraordinary"][0] < seen["ordinary"][0] - 3.0


def test_the_table_of_qualities_is_the_code_s() -> None:
    page = (ROOT / "docs" / "conventions.md").read_text(encoding="utf-8")
    told = dict(re.findall(r"^\| (draft|standard|fine) +\| ([0-9.]+) +\|$", page, re.MULTILINE))
    assert {name: float(bound) for name, bound in told.items()} == {
        name: quality.target_error for name, quality in QUALITIES.items()
    }
