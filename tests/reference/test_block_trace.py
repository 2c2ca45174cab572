"""The exact trace against the Berreman solver, against cases known by hand, and against its own mutants."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.reference.berreman import modes, tensor_uniaxial
from tests.reference.block_trace import (
    MODES,
    Block,
    Camera,
    analyser_angles,
    analyser_share,
    find_image,
    light_field,
    mean_image,
    uniaxial_wave,
    visible_weights,
)

N_O, N_E = 1.6584, 1.4864


def manifest(
    tilt_deg: float = 0.0,
    distance: float = 200.0,
    vfov_deg: float = 3.0,
    gap: float = 0.02,
    axis_tilt_deg: float = 44.64,
) -> dict[str, Any]:
    """Return the parts of a manifest that the trace reads; the camera leans towards -y by tilt_deg."""
    tilt, axis = np.radians(tilt_deg), np.radians(axis_tilt_deg)
    return {
        "size": [128, 96],
        "camera": {
            "eye_mm": [0.0, -distance * np.sin(tilt), distance * np.cos(tilt)],
            "target_mm": [0.0, 0.0, 0.0],
            "up": [0.0, float(np.cos(tilt)), float(np.sin(tilt))],
            "vfov_deg": vfov_deg,
        },
        "scene": {
            "cut": "block",
            "half_size_mm": [11.0, 11.0],
            "z0_mm": gap,
            "z1_mm": gap + 14.0,
            "page_z_mm": 0.0,
            "optic_axis": [float(np.sin(axis)), 0.0, float(np.cos(axis))],
        },
    }


def test_closed_forms_agree_with_berreman() -> None:
    rng = np.random.default_rng(11)
    for _ in range(300):
        n_o, n_e = rng.uniform(1.2, 2.4, 2)
        axis, normal = (v / np.linalg.norm(v) for v in rng.standard_normal((2, 3)))
        across = np.cross(normal, rng.standard_normal(3))
        kt = across / np.linalg.norm(across) * rng.uniform(0, 0.95 * min(n_o, n_e))
        forward, backward = modes(tensor_uniaxial(n_o, n_e, axis), normal, kt)
        for side, pair in ((1.0, forward), (-1.0, backward)):
            for mode in MODES:
                k, ray, e = uniaxial_wave(mode, n_o, n_e, axis, side * normal, kt)
                twin = min(pair, key=lambda m, k=k: float(np.linalg.norm(m.k - k)))  # type: ignore[misc]
                np.testing.assert_allclose(k, twin.k, rtol=0, atol=1e-10)
                np.testing.assert_allclose(ray, twin.ray, rtol=0, atol=1e-9)
                np.testing.assert_allclose(abs(e @ twin.e), 1, rtol=0, atol=1e-10)


def test_camera_looks_where_the_manifest_says() -> None:
    camera = Camera.of(manifest(30.0))
    np.testing.assert_allclose(camera.pixel(np.zeros(3)), [64, 48], rtol=0, atol=1e-9)
    for pixel in ([0.5, 0.5], [127.5, 3.0], [20.25, 95.5]):
        point = camera.eye + 150.0 * camera.direction(np.array(pixel))
        np.testing.assert_allclose(camera.pixel(point), pixel, rtol=0, atol=1e-9)
    # x to the right, y down; the page's +y is up in the picture
    right, up = camera.pixel(np.array([1.0, 0, 0])), camera.pixel(np.array([0, 1.0, 0]))
    assert right[0] > 65
    assert up[1] < 47


@pytest.mark.parametrize("tilt", [0.0, 30.0])
def test_a_block_of_air_moves_nothing(tilt: float) -> None:
    scene = manifest(tilt)
    for mode in MODES:
        image = find_image(scene, (1.0, -0.5), mode, 40.0, 1.0, 1.0)
        expected = Camera.of(scene).pixel(np.array([1.0, -0.5, 0.0]))
        np.testing.assert_allclose(image.pixel, expected, rtol=0, atol=1e-6)


def test_apparent_depth_of_glass() -> None:
    """Through a glass plate of thickness t the ray lands t (tan - sin/sqrt(n^2 - sin^2)) nearer than through air."""
    scene, n, thickness = manifest(30.0), 1.55, 14.0
    image = find_image(scene, (0.7, 0.4), "ordinary", 15.0, n, n)
    d = image.trace.direction
    sine = np.hypot(d[0], d[1])
    straight = np.array(scene["camera"]["eye_mm"]) + d * (scene["camera"]["eye_mm"][2] / -d[2])
    nearer = thickness * (sine / -d[2] - sine / np.sqrt(n**2 - sine**2))
    np.testing.assert_allclose(straight[:2] - nearer * d[:2] / sine, [0.7, 0.4], rtol=0, atol=1e-8)


def test_orthographic_circle() -> None:
    """From afar the ordinary image rests; the extraordinary one circles at walk-off times thickness, with the block."""
    scene = manifest(distance=1e6, vfov_deg=np.degrees(12.0 / 1e6))
    per_mm = 96 / 12.0
    theta = np.radians(44.64)
    # the tangent of the angle between c-tilted ray and normal: tan(ray) = tan(theta) n_o^2 / n_e^2
    walk_off = (N_O**2 - N_E**2) * np.tan(theta) / (N_E**2 + N_O**2 * np.tan(theta) ** 2)
    assert walk_off == pytest.approx(0.109, abs=5e-4)
    for angle in range(0, 360, 30):
        ordinary, extraordinary = (find_image(scene, (1.0, 0.5), mode, angle, N_O, N_E).pixel for mode in MODES)
        np.testing.assert_allclose(ordinary, [64 + per_mm, 48 - 0.5 * per_mm], rtol=0, atol=1e-3)
        # at angle 0 the axis leans to +x and the energy on its way up to -x
        radians = np.radians(angle + 180.0)
        expected = walk_off * 14.0 * per_mm * np.array([np.cos(radians), -np.sin(radians)])
        np.testing.assert_allclose(extraordinary - ordinary, expected, rtol=0, atol=2e-3)


def test_paths_stay_inside_or_say_so() -> None:
    scene = manifest(vfov_deg=8.0)
    assert find_image(scene, (1.0, 0.5), "extraordinary", 70.0, N_O, N_E).trace.inside
    # 0.3 mm inside the edge: the ordinary ray is inside, the extraordinary one, 1.5 mm to -x, has left by the side
    assert find_image(scene, (-10.7, 0.0), "ordinary", 0.0, N_O, N_E).trace.inside
    assert not find_image(scene, (-10.7, 0.0), "extraordinary", 0.0, N_O, N_E).trace.inside
    assert find_image(scene, (-10.7, 0.0), "extraordinary", 180.0, N_O, N_E).trace.inside
    assert Block.of(scene, 45.0).covers(np.array([15.0, 0.0, 0.0]))
    assert not Block.of(scene, 0.0).covers(np.array([15.0, 0.0, 0.0]))


def test_analyser_angles() -> None:
    """The ordinary field stands across the plane of k and axis: an analyser along the axis extinguishes it."""
    far = manifest(distance=1e6, vfov_deg=np.degrees(12.0 / 1e6))
    for angle in (0.0, 25.0, 140.0, 300.0):
        found = analyser_angles(far, (1.0, 0.5), angle, N_O, N_E)
        for got, expected in zip(found, (angle, angle + 90), strict=True):
            assert abs((got - expected + 90) % 180 - 90) < 1e-3
        camera = Camera.of(far)
        for mode, put_out in zip(MODES, found, strict=True):
            direction, field = light_field(far, (1.0, 0.5), mode, angle, N_O, N_E)
            for turn in (0.0, 30.0, 90.0):
                share = analyser_share(camera, direction, field, put_out + turn)
                assert share == pytest.approx(np.sin(np.radians(turn)) ** 2, abs=1e-6)
    # seen obliquely the two fields are neither at the azimuth nor at right angles, yet near both
    near = manifest(30.0)
    gaps = []
    for angle in range(0, 180, 15):
        first, second = analyser_angles(near, (1.0, 0.5), angle, N_O, N_E)
        gaps.append(abs((second - first) % 180 - 90))
    assert 0.2 < max(gaps) < 15


def test_wrong_rules_are_far_away() -> None:
    """No walk-off, and refraction of the ray where there is a gap to show it."""
    scene = manifest(gap=2.0)
    for angle in range(0, 360, 30):
        right = find_image(scene, (1.0, 0.5), "extraordinary", angle, N_O, N_E).pixel
        for rule, least in (("along k", 8.0), ("refract ray", 1.5)):
            wrong = find_image(scene, (1.0, 0.5), "extraordinary", angle, N_O, N_E, rule).pixel  # type: ignore[arg-type]
            assert np.linalg.norm(wrong - right) > least


def test_mean_over_the_spectrum() -> None:
    nm = np.arange(380.0, 721.0)
    weights = visible_weights(nm)
    assert weights.sum() == pytest.approx(1)
    # D65 times the tabulated luminous efficiency has its mean at 556.76 nm
    assert weights @ nm == pytest.approx(556.76, abs=0.5)
    scene = manifest()
    constant = mean_image(scene, (1.0, 0.5), "extraordinary", 70.0, lambda x: (0 * x + N_O, 0 * x + N_E))
    single = find_image(scene, (1.0, 0.5), "extraordinary", 70.0, N_O, N_E).pixel
    np.testing.assert_allclose(constant, single, rtol=0, atol=1e-9)
