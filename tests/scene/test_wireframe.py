"""Line drawings: what is in front and what is behind, where things stand on the sheet, the SVG."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

import minerals_db
from crystal_core.errors import InputError, NotSupportedError
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.optics.indicatrix import BiaxialIndicatrix
from crystal_core.scene import SceneFiles, StagedDocument, parse_scene, stage_scene
from crystal_core.scene.wireframe import wireframe
from crystal_core.scene.wireframe.directions import indicatrix_section, optic_axes
from crystal_core.scene.wireframe.edges import body_lines
from crystal_core.scene.wireframe.hidden import Hider, pieces
from crystal_core.scene.wireframe.lens import Lens, camera_lens
from tests.scene.strategies import scenes

SVG = "{http://www.w3.org/2000/svg}"


def scene(bodies: dict[str, Any], **more: Any) -> StagedDocument:
    return stage_scene(parse_scene({"isogyre": 1, "bodies": bodies, **more}))


def box(x: float, y: float, z: float, **more: Any) -> dict[str, Any]:
    return {"optics": {"n": 1.5}, "shape": {"box": {"size_mm": [x, y, z]}}, **more}


def orthographic(height: float = 40.0, eye: tuple[float, float, float] = (30.0, -60.0, 40.0)) -> dict[str, Any]:
    return {"orthographic": {"eye_mm": list(eye), "height_mm": height}}


def perspective(eye: tuple[float, float, float]) -> dict[str, Any]:
    return {"perspective": {"eye_mm": list(eye), "vfov_deg": 40}}


def lens_of(staged: StagedDocument) -> Lens:
    return camera_lens(staged.camera, staged.document.render.size_px)


def strokes(svg: str, name: str) -> list[list[tuple[float, float]]]:
    """Return the lines of a kind, each as its points."""
    found = []
    for path in ElementTree.fromstring(svg).iter(f"{SVG}path"):
        if path.get("class") == name:
            for line in (path.get("d") or "").split("M")[1:]:
                found.append([tuple(map(float, point.split())) for point in line.split("L")])
    return found


def count(svg: str, name: str) -> int:
    return sum(len(line) - 1 for line in strokes(svg, name))


def texts(svg: str) -> list[str]:
    return ["".join(text.itertext()) for text in ElementTree.fromstring(svg).iter(f"{SVG}text")]


@pytest.mark.parametrize("camera", [orthographic(), perspective((30, -60, 40))])
def test_a_box_has_nine_edges_in_front_and_three_behind(camera: dict[str, Any]) -> None:
    svg = wireframe(scene({"block": box(20, 14, 10)}, camera=camera))
    assert (count(svg, "front"), count(svg, "back")) == (9, 3)


def test_the_sheet_is_the_picture() -> None:
    staged = scene({"block": box(20, 14, 10)}, camera=perspective((30, -60, 40)), render={"size_px": [400, 200]})
    lens = lens_of(staged)
    assert (lens.width, lens.height) == (720, 360)
    # By hand: a point on the picture's axes at tan 10° of the line of sight.
    eye, forward, up = staged.camera.eye, staged.camera.forward, staged.camera.up
    point = eye + 50.0 * (forward + np.tan(np.deg2rad(10.0)) * up)
    x, y = lens.project(point[None])[0]
    assert x == pytest.approx(360.0)
    assert y == pytest.approx(180.0 - 180.0 * np.tan(np.deg2rad(10.0)) / np.tan(np.deg2rad(20.0)))
    assert lens.units_per_mm(eye + 50.0 * forward) == pytest.approx(180.0 / (50.0 * np.tan(np.deg2rad(20.0))))


@pytest.mark.parametrize(("view", "width", "height"), [("plan", 20, 14), ("front", 20, 10), ("side", 14, 10)])
def test_straight_views_are_to_scale(view: Any, width: float, height: float) -> None:
    svg = wireframe(scene({"block": box(20, 14, 10)}, camera=perspective((300, -600, 400))), view)
    points = np.array([point for line in strokes(svg, "front") for point in line])
    extent = np.ptp(points, axis=0)
    assert extent[0] / extent[1] == pytest.approx(width / height, abs=2e-3)
    assert strokes(svg, "back") == [] or set(map(tuple, np.concatenate(strokes(svg, "back")))) <= set(
        map(tuple, points)
    )
    (bar,) = [path.get("d") for path in ElementTree.fromstring(svg).iter(f"{SVG}path") if path.get("class") == "scale"]
    left, right = (float(found) for found in re.findall(r"M([\d.]+) [\d.]+v8M[\d.]+ [\d.]+H([\d.]+)", bar)[0])
    (told,) = [float(text.split()[0]) for text in texts(svg) if re.fullmatch(r"[\d.]+ mm", text)]
    assert (right - left) / told == pytest.approx(extent[0] / width, rel=2e-3)


def test_a_body_hides_what_is_behind_it() -> None:
    bodies = {"near": box(10, 10, 10, position_mm=[0, -20, 0]), "far": box(6, 6, 6)}
    svg = wireframe(scene(bodies, camera=orthographic(eye=(0, -60, 0.01), height=40)))
    lens_unit = 720 / 40
    # The far one stands wholly behind the near one: none of its lines is solid.
    points = np.array([point for line in strokes(svg, "front") for point in line])
    assert np.ptp(points, axis=0) == pytest.approx([10 * lens_unit] * 2, abs=0.3)
    dashed = np.array([point for line in strokes(svg, "back") for point in line])
    assert np.any(np.abs(dashed - 360.0).max(axis=1) < 3.2 * lens_unit)


def test_an_edge_is_cut_where_it_goes_behind() -> None:
    bodies = {"near": box(10, 10, 10, position_mm=[0, -20, 0]), "far": box(30, 2, 2, position_mm=[0, 0, 1])}
    svg = wireframe(scene(bodies, camera=orthographic(eye=(0, -60, 0.001), height=40)))
    ends = sorted({x for line in strokes(svg, "front") for x, y in line if 300 < y < 355})
    assert ends == pytest.approx([360 + 18 * x for x in (-15, -5, 5, 15)], abs=0.2)


@pytest.mark.parametrize("pinhole", [True, False])
def test_hidden_stretches_agree_with_rays(pinhole: bool) -> None:
    """Each piece's middle is seen or hidden as a ray from it to the eye says."""
    random = np.random.default_rng(5)
    eye = (20.0, -70.0, 35.0)
    camera = perspective(eye) if pinhole else orthographic(eye=eye)
    staged = scene({"quartz": {"mineral": "quartz", "shape": {"habit": {"size_mm": 20}}}}, camera=camera)
    lens = lens_of(staged)
    body = staged.bodies[0].solid.body
    assert isinstance(body, ConvexPolyhedron)
    hider = Hider(body, lens)
    hidden = 0
    for start, end in random.uniform(-25.0, 25.0, (400, 2, 3)):
        for a, b, behind in pieces(start, end, [hider]):
            middle = 0.5 * (a + b)
            way = lens.towards_eye(middle[None])[0]
            enters, leaves, _, _ = body.span(middle[:, None], way[:, None])
            distance = np.linalg.norm(lens.eye - middle) if pinhole else np.inf
            chord = min(leaves[0], distance) - max(enters[0], 0.0)
            assert behind == (chord > 0.0) or abs(chord) < 1e-4
            hidden += behind
    assert hidden > 30  # else nothing has been shown


def test_a_sphere_shows_its_outline() -> None:
    staged = scene(
        {"ball": {"optics": {"n": 1.5}, "shape": {"sphere": {"diameter_mm": 20}}}}, camera=perspective((0, -60, 0))
    )
    lens = lens_of(staged)
    lines = body_lines(staged.bodies[0].solid.body, lens)
    points = lens.project(np.array([line.start for line in lines]))
    # The cone that touches the sphere: sin = r/d.
    radius = 360.0 * np.tan(np.arcsin(10.0 / 60.0)) / np.tan(np.deg2rad(20.0))
    assert np.hypot(*(points - 360.0).T) == pytest.approx(radius, rel=3e-3)
    assert all(line.is_front for line in lines)
    assert count(wireframe(staged), "back") == 0


def _u_shape() -> str:
    """Return a U, 30 × 20 mm in x and y, its arms and its base 10 mm thick, 10 mm along z, as OBJ."""
    ring = [(0, 0), (30, 0), (30, 20), (20, 20), (20, 10), (10, 10), (10, 20), (0, 20)]
    inside = [(0, 5, 6), (0, 6, 7), (0, 4, 5), (0, 1, 4), (1, 3, 4), (1, 2, 3)]
    lines = [f"v {x} {y} {z}" for z in (0, 10) for x, y in ring]
    lines += [f"f {c + 1} {b + 1} {a + 1}" for a, b, c in inside] + [f"f {a + 9} {b + 9} {c + 9}" for a, b, c in inside]
    for i in range(8):
        j = (i + 1) % 8
        lines += [f"f {i + 1} {j + 1} {j + 9}", f"f {i + 1} {j + 9} {i + 9}"]
    return "\n".join(lines) + "\n"


def test_a_mesh_hides_itself(tmp_path: Path) -> None:
    """Seen along the base of a U, its notch and its far arm stand behind the near arm."""
    (tmp_path / "u.obj").write_text(_u_shape(), encoding="utf-8")

    def drawn(eye: tuple[float, float, float]) -> str:
        body = {"optics": {"n": 1.5}, "shape": {"mesh": {"file": "u.obj"}}}
        document = parse_scene({"isogyre": 1, "bodies": {"u": body}, "camera": orthographic(60, eye)}, paths=True)
        return wireframe(stage_scene(document, SceneFiles(folder=tmp_path)))

    along = drawn((-60, 0, 0))
    solid = np.array([point for line in strokes(along, "front") for point in line])
    assert np.ptp(solid, axis=0) == pytest.approx([240, 120], abs=0.5)
    low, high = solid.min(axis=0) + 3.0, solid.max(axis=0) - 3.0
    pairs = np.array([pair for line in strokes(along, "front") for pair in pairwise(line)])
    middles = pairs.mean(axis=1)
    assert not np.any(np.all((middles > low) & (middles < high), axis=1))  # the edges of the notch cross the rectangle
    # From above along y they are: four edges across the drawing, those of the notch and the sides.
    across = drawn((0, 60, 0))
    solid = np.array([point for line in strokes(across, "front") for point in line])
    assert sorted(set(solid[:, 0].round(0))) == [180, 300, 420, 540]


def test_axes_and_optic_axes_are_named() -> None:
    calcite = texts(wireframe(scene({"c": {"mineral": "calcite", "shape": {"habit": {}}}}, camera=orthographic())))
    assert {"a₁", "a₂", "c = optic axis", "c (calcite)"} <= set(calcite)
    topaz = texts(wireframe(scene({"t": {"mineral": "topaz", "shape": {"habit": {}}}}, camera=orthographic())))
    assert {"a", "b", "c", "optic axis 1", "optic axis 2"} <= set(topaz)
    glass = texts(wireframe(scene({"g": box(5, 5, 5)}, camera=orthographic())))
    assert not {"a", "b", "c"} & set(glass)


def test_miller_indices_have_bars() -> None:
    svg = wireframe(
        scene(
            {"c": {"mineral": "fluorite", "shape": {"habit": {"forms": [{"hkl": [1, 1, 1]}]}}}}, camera=orthographic()
        )
    )
    assert "1 1\u0305 1" in texts(svg)


def test_sections_of_the_indicatrix_are_those_of_the_two_waves() -> None:
    staged = scene({"t": {"mineral": "topaz", "shape": {"habit": {}}}}, camera=orthographic())
    medium = staged.media[1]
    at_d = BiaxialIndicatrix.of(medium.at(np.array([589.3])))
    alpha, beta, gamma = (float(np.ravel(n)[0]) for n in (at_d.alpha, at_d.beta, at_d.gamma))
    axes = at_d.axes.reshape(3, 3, -1)[:, :, 0]
    section = indicatrix_section(medium, axes[1])
    assert section is not None
    assert section.indices == pytest.approx((gamma, alpha))
    assert np.abs(np.einsum("ki,ki->k", section.directions, axes[[2, 0]])) == pytest.approx(1.0)
    section = indicatrix_section(medium, axes[0])
    assert section is not None
    assert section.indices == pytest.approx((gamma, beta))
    for axis in optic_axes(medium):  # along an optic axis it is a circle
        assert indicatrix_section(medium, axis) is None
    shown = texts(wireframe(staged, indicatrix=True))
    assert any(text.startswith("n₁ 1.6") for text in shown)
    assert any("times larger" in text for text in shown)


def everything() -> StagedDocument:
    return scene(
        {
            "gypsum": {"mineral": "gypsum", "shape": {"plate": {"size_mm": [12, 12], "thickness_um": 800}}},
            "twin": {
                "mineral": "spinel",
                "shape": {"habit": {"size_mm": 6}},
                "twin": {"law": "spinel law"},
                "position_mm": [14, 0, 0],
            },
            "stone": {
                "mineral": "corundum",
                "shape": {"cabochon": {"size_mm": [8, 6], "height_mm": 3}},
                "position_mm": [-14, 0, 0],
            },
        },
        title='<script>alert("1")</script> & \u0007 кристалл',
        sheets={
            "lower": {"polarizer": {"angle_deg": 0}, "position_mm": [0, 0, -12]},
            "gips": {"retarder": {"retardation_nm": 550, "slow_deg": 45}, "position_mm": [0, 0, 12]},
        },
        surfaces={"page": {"reflectance": 0.5, "position_mm": [0, 0, -20]}, "table": _table()},
        lights={
            "panel": {
                "area": {"position_mm": [0, 0, -16], "facing": [0, 0, 1], "shape": {"disc": {"diameter_mm": 30}}}
            },
            "laser": {"beam": {"position_mm": [-40, 0, 30], "direction": [1, 0, -0.5]}},
            "lamp": {"point": {}, "polarization": {"vibration": [1, 0, 0]}},
            "sky": {"sky": {}},
        },
        camera={**orthographic(height=90), "analyser_deg": 90},
    )


def _table() -> dict[str, Any]:
    return {"reflectance": 0.2, "shape": {"endless": {}}, "position_mm": [0, 0, -20.5]}


@pytest.mark.parametrize("view", ["camera", "plan", "front", "side"])
def test_the_svg_is_sound_and_always_the_same(view: Any) -> None:
    svg = wireframe(everything(), view, indicatrix=True)
    assert svg == wireframe(everything(), view, indicatrix=True)
    assert len(svg.encode()) < 200_000
    root = ElementTree.fromstring(svg)
    assert {element.tag.removeprefix(SVG) for element in root.iter()} <= {
        "svg",
        "title",
        "rect",
        "path",
        "circle",
        "text",
    }
    assert not [name for element in root.iter() for name in element.attrib if name.startswith("on") or "href" in name]
    x, y, width, height = map(float, root.get("viewBox", "").split())
    assert (x, y, width) == (0, 0, 720)
    for name in ("front", "back", "sheet", "axis", "optic-axis", "surface", "beam", "vibration"):
        for line in strokes(svg, name):
            for a, b in line:
                assert 0 <= a <= width
                assert 0 <= b <= height
    words = " ".join(texts(svg))
    for word in (
        "laser",
        "lamp (polarized)",
        "lower (polarizer 0°)",
        "gips (550 nm, slow 45°)",
        "panel",
        " mm",
        "кристалл",
    ):
        assert word in words
    assert ("analyser 90°" in words) == (view == "camera")
    assert ("camera" in words.replace("as the camera sees it", "")) == (view != "camera")


def test_names_do_not_cover_each_other() -> None:
    for view in ("camera", "plan"):
        boxes = list(_boxes(wireframe(everything(), view)))  # type: ignore[arg-type]
        overlaps = [
            (a[0], b[0])
            for i, a in enumerate(boxes)
            for b in boxes[i + 1 :]
            if a[1] < b[3] and b[1] < a[3] and a[2] < b[4] and b[2] < a[4]
        ]
        assert overlaps == []


def _boxes(svg: str) -> Iterator[tuple[str, float, float, float, float]]:
    for text in ElementTree.fromstring(svg).iter(f"{SVG}text"):
        content = "".join(text.itertext()).replace("\u0305", "")
        size, x, y = (float(text.get(key, "0")) for key in ("font-size", "x", "y"))
        wide = 0.5 * size * len(content)
        left = x - {"start": 0.0, "middle": 0.5, "end": 1.0}[text.get("text-anchor", "start")] * wide
        yield content, left, y - 0.7 * size, left + wide, y


def test_a_camera_among_the_bodies_sees_what_is_before_it() -> None:
    bodies = {"before": box(4, 4, 4, position_mm=[0, 30, 0]), "behind": box(4, 4, 4, position_mm=[0, -30, 0])}
    room = {"walls": {"reflectance": 0.8, "shape": {"room": {"size_mm": [90, 90, 90]}}}}
    camera = {"perspective": {"eye_mm": [0, 0, 0], "target_mm": [0, 1, 0], "vfov_deg": 100}}
    svg = wireframe(scene(bodies, surfaces=room, camera=camera, lights={"sky": {"sky": {}}}))
    points = np.array([point for line in strokes(svg, "front") for point in line])
    assert np.abs(points - 360.0).max() < 360.0 * (2.0 / 28.0) / np.tan(np.deg2rad(50.0)) + 0.1
    assert "behind" not in texts(svg)
    assert count(svg, "surface") > 0


def test_every_habit_of_the_database_in_one_drawing() -> None:
    habits = [(mineral.id, habit.name) for mineral in minerals_db.minerals().values() for habit in mineral.habits]
    bodies = {
        f"b{i}": {
            "mineral": mineral,
            "shape": {"habit": {"name": name, "size_mm": 8}},
            "position_mm": [10 * (i % 16), 10 * (i // 16), 0],
        }
        for i, (mineral, name) in enumerate(habits)
    }
    assert len(bodies) > 150
    svg = wireframe(scene(bodies, camera={"fitted": {"tilt_deg": 40}}))
    assert len(svg.encode()) < 200_000
    assert count(svg, "front") > 5 * len(bodies)


@settings(max_examples=40, deadline=None)
@given(mapping=scenes(), view=st.sampled_from(["camera", "plan", "front", "side"]))
def test_whatever_can_be_put_together_can_be_drawn(mapping: dict[str, Any], view: Any) -> None:
    mapping.pop("motion", None)
    try:
        staged = stage_scene(parse_scene(mapping))
    except (InputError, NotSupportedError):
        reject()
    svg = wireframe(staged, view, indicatrix=True)
    for line in [line for style in ("front", "back", "axis", "indicatrix") for line in strokes(svg, style)]:
        assert np.isfinite(line).all()
    assert len(svg.encode()) < 200_000
