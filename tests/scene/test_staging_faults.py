"""What cannot be is told before any rendering, with a pointer and a reason of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from crystal_core.scene import SceneFiles, parse_scene
from tests.scene.staging import BALL, BOX, CALCITE, TABLE, bodies, body, refused, scene, staged

CABOCHON: dict[str, Any] = {"optics": {"n": 1.5}, "shape": {"cabochon": {"size_mm": [10, 10], "height_mm": 5}}}
MESH: dict[str, Any] = {"optics": {"n": 1.5}, "shape": {"mesh": {"file": "a.ply"}}}


def saved(folder: Path, mesh: trimesh.Trimesh) -> SceneFiles:
    mesh.export(folder / "a.ply")
    return SceneFiles(folder=folder)


def ell() -> trimesh.Trimesh:
    """Return an L-shaped body of 10 mm: two blocks, not convex."""
    outline = [(0, 0), (10, 0), (10, 4), (4, 4), (4, 10), (0, 10)]
    bottom = np.array([(x, y, 0.0) for x, y in outline])
    vertices = np.concatenate((bottom, bottom + np.array((0.0, 0.0, 4.0))))
    lid = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    faces = [(a, c, b) for a, b, c in lid] + [(a + 6, b + 6, c + 6) for a, b, c in lid]
    for i in range(6):
        j = (i + 1) % 6
        faces += [(i, j, j + 6), (i, j + 6, i + 6)]
    return trimesh.Trimesh(vertices, faces, process=False)


def test_an_empty_scene() -> None:
    assert refused(scene()) == {"": "the scene is empty: give it bodies, surfaces or sheets"}


@pytest.mark.parametrize(
    ("one", "other", "distance", "deep"),
    [(BOX, BOX, 9.0, 1.0), (BALL, BALL, 9.0, 1.0), (BOX, BALL, 9.0, 1.0), (CABOCHON, BOX, 9.0, 1.0)],
)
def test_bodies_that_overlap(one: Any, other: Any, distance: float, deep: float) -> None:
    told = refused(bodies(a=one, b=body(other, position_mm=[distance, 0, 0])))
    assert list(told) == ["/bodies/b"]
    assert told["/bodies/b"].startswith("b and a overlap by ")
    assert float(told["/bodies/b"].split()[-2]) == pytest.approx(deep, rel=0.03)
    assert refused(bodies(a=one, b=body(other, position_mm=[distance + 1.001, 0, 0]))) == {}


def test_two_balls_are_told_apart_to_a_micrometre() -> None:
    towards = np.array((0.36, 0.48, 0.8))
    for distance, apart in ((10.00002, True), (9.9999, False)):
        told = refused(bodies(a=BALL, b=body(BALL, position_mm=(distance * towards).tolist())))
        assert (told == {}) is apart, told


def test_bodies_that_touch_are_joined_or_apart() -> None:
    told = refused(bodies(a=BOX, b=body(BOX, position_mm=[10, 0, 0])))
    assert told == {"/bodies/b": "b touches a: leave a gap, or say joined_to (or inside)"}
    assert refused(bodies(a=BOX, b=body(BOX, position_mm=[10, 0, 0], joined_to="a"))) == {}


def test_joined_faces_must_cover_each_other() -> None:
    told = refused(bodies(a=BOX, b=body(BOX, position_mm=[10, 1, 0], joined_to="a")))
    assert list(told) == ["/bodies/b/joined_to"]
    assert "no face of b lies on one of a" in told["/bodies/b/joined_to"]


def test_joined_bodies_may_not_overlap_elsewhere() -> None:
    parts = {
        "a": BOX,
        "b": body(BOX, position_mm=[10, 0, 0], joined_to="a"),
        "c": body(BALL, position_mm=[10, 0, 0]),
    }
    assert list(refused(bodies(**parts))) == ["/bodies/c"]


@pytest.mark.parametrize("host", [BOX, BALL])
def test_an_inclusion_that_sticks_out(host: Any) -> None:
    small = body(BALL, shape={"sphere": {"diameter_mm": 2}}, inside="a")
    assert refused(bodies(a=host, b=body(small, position_mm=[3.9, 0, 0]))) == {}
    told = refused(bodies(a=host, b=body(small, position_mm=[4.5, 0, 0])))
    assert told == {"/bodies/b/inside": "b sticks out of a by 0.5 mm: it must lie wholly inside"}
    told = refused(bodies(a=host, b=body(small, position_mm=[4, 0, 0])))
    assert told == {"/bodies/b/inside": "b touches the face of a: it must lie wholly inside"}


@pytest.mark.parametrize("turn_deg", [0, 20, 45])
def test_a_box_in_a_ball_sticks_out_with_its_corners(turn_deg: float) -> None:
    half = 5 / np.sqrt(3)
    for size, fits in ((2 * half - 1e-4, True), (2 * half + 1e-4, False)):
        cube = body(BOX, shape={"box": {"size_mm": [size] * 3}}, turns=[{"angle_deg": turn_deg}], inside="a")
        assert (refused(bodies(a=BALL, b=cube)) == {}) is fits


def test_an_inclusion_in_a_cabochon() -> None:
    ball = body(BALL, shape={"sphere": {"diameter_mm": 2}}, inside="a")
    # The dome is half of a ball of 5 mm, its centre of mass 3/8 of 5 mm over the base.
    up = 5 - 5 * 3 / 8 - 1
    for height, fits in ((up - 1e-3, True), (up + 1e-3, False), (1 - 1.875 + 1e-3, True), (1 - 1.875 - 1e-3, False)):
        told = refused(bodies(a=CABOCHON, b=body(ball, position_mm=[0, 0, height])))
        assert (told == {}) is fits, (height, told)


def test_two_inclusions_that_overlap() -> None:
    small = body(BALL, shape={"sphere": {"diameter_mm": 2}}, inside="a")
    told = refused(bodies(a=BOX, b=small, c=body(small, position_mm=[1, 0, 0])))
    assert list(told) == ["/bodies/c"]


def test_a_body_that_a_surface_cuts() -> None:
    told = refused(scene(bodies={"a": BOX}, surfaces={"t": TABLE}))
    assert told == {"/bodies/a": "a is cut by t"}
    told = refused(scene(bodies={"a": body(BOX, position_mm=[0, 0, 5])}, surfaces={"t": TABLE}))
    assert told == {"/bodies/a": "a touches t: leave a gap (rests_on leaves one)"}
    small = {"reflectance": 0.5, "shape": {"disc": {"diameter_mm": 4}}}
    assert "cut by" in refused(scene(bodies={"a": BOX}, surfaces={"t": small}))["/bodies/a"]
    assert refused(scene(bodies={"a": BOX}, surfaces={"t": small | {"position_mm": [8, 0, 0]}})) == {}
    assert "cut by" in refused(scene(bodies={"a": BALL}, sheets={"p": {"polarizer": {}}}))["/bodies/a"]


@pytest.mark.parametrize("base", [BOX, BALL, CABOCHON])
def test_a_camera_or_a_light_in_a_body(base: Any) -> None:
    told = refused(scene(bodies={"a": base}, camera={"perspective": {"eye_mm": [0, 0, 0.1]}}))
    assert told == {"/camera/perspective/eye_mm": "the camera is inside a"}
    told = refused(scene(bodies={"a": base}, lights={"l": {"point": {"position_mm": [1.5, 0, 0]}}}))
    assert told == {"/lights/l/point/position_mm": "the light is inside a"}
    area = {"area": {"position_mm": [0, 0, 30], "facing": "-z"}}
    assert refused(scene(bodies={"a": base}, lights={"l": area})) == {}
    cut = {"area": {"position_mm": [30, 0, 0], "facing": "-z"}}
    assert refused(scene(bodies={"a": base}, lights={"l": cut})) == {
        "/lights/l/area/position_mm": "the light is cut by a"
    }


def test_a_camera_or_a_light_in_a_wall() -> None:
    eye = {"perspective": {"eye_mm": [20, 0, 0]}}
    page = {"print": "digits"}
    assert refused(scene(surfaces={"p": page}, camera=eye)) == {"/camera/perspective/eye_mm": "the camera is in p"}
    assert refused(scene(surfaces={"p": page}, camera={"perspective": {"eye_mm": [40, 0, 0]}})) == {}
    room = {"r": {"reflectance": 0.8, "shape": {"room": {}}}}
    inside = {"perspective": {"eye_mm": [0, -80, 0]}}
    lamp = {"l": {"point": {"position_mm": [0, 0, 100]}}}
    told = refused(scene(bodies={"a": BOX}, surfaces=room, camera=inside, lights=lamp))
    assert list(told) == ["/lights/l/point/position_mm"]
    assert "wall of r" in told["/lights/l/point/position_mm"]
    small = {"r": {"reflectance": 0.8, "shape": {"room": {"size_mm": [100, 100, 100]}}}}
    told = refused(scene(bodies={"a": BOX}, surfaces=small, lights={"l": {"sky": {}}}))
    assert list(told) == ["/camera/fitted"]
    sky = {"l": {"sky": {}}}
    assert refused(scene(bodies={"a": BOX}, surfaces=room, lights=sky, camera=inside)) == {}


def test_a_camera_behind_an_endless_table() -> None:
    parts: dict[str, Any] = {"bodies": {"a": body(BOX, rests_on="t")}, "surfaces": {"t": TABLE}}
    told = refused(scene(**parts, camera={"perspective": {"eye_mm": [0, 0, -50]}}))
    assert "behind t" in told["/camera/perspective/eye_mm"]


def test_equal_surfaces_in_one_plane() -> None:
    card = {"reflectance": 0.5}
    told = refused(scene(surfaces={"a": card, "b": card | {"position_mm": [10, 0, 0]}}))
    assert "neither covers the other" in told["/surfaces/b"]
    assert refused(scene(surfaces={"a": card, "b": card | {"position_mm": [100, 0, 0]}})) == {}
    assert refused(scene(surfaces={"a": card, "b": TABLE})) == {}


def test_forms_that_do_not_close() -> None:
    prism = body(CALCITE, shape={"habit": {"forms": [{"hkl": [1, 0, 0]}]}})
    told = refused(bodies(a=prism, b=body(CALCITE, shape={"habit": {"forms": [{"hkl": [0, 0, 1]}]}})))
    assert list(told) == ["/bodies/a/shape/habit/forms", "/bodies/b/shape/habit/forms"]
    assert "do not close" in told["/bodies/a/shape/habit/forms"]


def test_a_form_that_bounds_nothing() -> None:
    forms = [{"hkl": [1, 0, 4]}, {"hkl": [0, 0, 1], "central_distance": 5}]
    assert list(refused(bodies(a=body(CALCITE, shape={"habit": {"forms": forms}})))) == [
        "/bodies/a/shape/habit/forms/1"
    ]


def test_a_cleavage_that_encloses_nothing() -> None:
    assert "/bodies/a/shape/cleavage" in refused(bodies(a={"mineral": "muscovite", "shape": {"cleavage": {}}}))


def test_proportions_that_do_not_meet() -> None:
    stone = {"mineral": "diamond", "shape": {"brilliant": {"star_percent": 0.5}}}
    assert list(refused(bodies(a=stone))) == ["/bodies/a/shape/brilliant/star_percent"]


def test_directions_that_a_crystal_does_not_have() -> None:
    def told(mineral: str, **orientation: Any) -> list[str]:
        return list(refused(bodies(a={"mineral": mineral, "shape": {"box": {}}, "orientation": orientation})))

    assert told("calcite", z={"optical": "acute-bisectrix"}) == ["/bodies/a/orientation/z/optical"]
    assert told("spinel", x={"optical": "optic-axis"}) == ["/bodies/a/orientation/x/optical"]
    assert told("calcite", z={"uvw": [0, 0, 1]}, x={"hkl": [0, 0, -1]}) == ["/bodies/a/orientation/x"]
    assert told("calcite", z={"uvw": [0, 0, 1]}, x={"hkl": [1, 0, 4]}) == []


def test_a_twin_that_is_none() -> None:
    told = refused(bodies(a=body(CALCITE, twin={"plane_hkl": [1, 1, 0]})))
    assert next(iter(told)).startswith("/bodies/a/twin")


def test_a_mesh_with_a_hole(tmp_path: Path) -> None:
    open_box = trimesh.creation.icosphere(subdivisions=3, radius=5.0)
    patch = open_box.triangles_center[:, 2] < 3.0
    open_box.update_faces(patch)
    told = refused(bodies(a=MESH), saved(tmp_path, open_box))
    (pointer,) = told
    assert pointer.startswith("/bodies/a/shape/mesh")
    assert "hole" in told[pointer] or "closed" in told[pointer]


def test_a_mesh_that_is_not_there(tmp_path: Path) -> None:
    assert list(refused(bodies(a=MESH), SceneFiles(folder=tmp_path))) == ["/bodies/a/shape/mesh/file"]


def test_a_million_faces(tmp_path: Path) -> None:
    header = "ply\nformat binary_little_endian 1.0\nelement vertex 500002\n"
    header += "property float x\nproperty float y\nproperty float z\n"
    header += "element face 1000000\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "a.ply").write_bytes(header.encode())
    told = refused(bodies(a=MESH), SceneFiles(folder=tmp_path))
    (message,) = told.values()
    assert "1000000 faces" in message


def test_a_mesh_is_a_body_like_others(tmp_path: Path) -> None:
    files = saved(tmp_path, ell())
    document = staged(bodies(a=MESH), files)
    (item,) = document.bodies
    assert len(item.outside) == 8
    assert item.solid.body.volume_mm3 == pytest.approx(4 * (40 + 24))
    # The centre of mass stands at the origin; the free corner of the L is at +x +y.
    corner = np.array((4.0, 4.0)) - ell().center_mass[:2]
    ball = body(BALL, shape={"sphere": {"diameter_mm": 2}})
    free = [corner[0] + 2.0, corner[1] + 2.0, 0.0]
    assert refused(bodies(a=MESH, b=body(ball, position_mm=free)), files) == {}
    for at in ([corner[0] + 0.5, corner[1] + 2.0, 0.0], [corner[0] - 2.0, corner[1] - 2.0, 0.0]):
        assert refused(bodies(a=MESH, b=body(ball, position_mm=at)), files) == {"/bodies/b": "b and a overlap"}
    inside = body(ball, inside="a", position_mm=[corner[0] - 2.0, corner[1] - 2.0, 0.0])
    assert refused(bodies(a=MESH, b=inside), files) == {}
    out = body(inside, position_mm=[corner[0] - 0.5, corner[1] + 2.0, 0.0])
    assert "sticks out" in refused(bodies(a=MESH, b=out), files)["/bodies/b/inside"]
    other = body(MESH, turns=[{"angle_deg": 180}], position_mm=[2 * corner[0] + 6.2, 2 * corner[1] + 6.2, 0])
    assert refused(bodies(a=MESH, b=other), files) == {}
    assert refused(bodies(a=MESH, b=body(other, position_mm=[3, 3, 0])), files) == {"/bodies/b": "b and a overlap"}


def test_a_mesh_and_planes_and_points(tmp_path: Path) -> None:
    files = saved(tmp_path, ell())
    corner = (np.array((4.0, 4.0)) - ell().center_mass[:2] + 2.5).tolist()
    card = {"reflectance": 0.5, "shape": {"disc": {"diameter_mm": 4}}, "position_mm": [*corner, 0]}
    assert refused(scene(bodies={"a": MESH}, surfaces={"t": card}), files) == {}
    assert "cut by" in refused(scene(bodies={"a": MESH}, surfaces={"t": TABLE}), files)["/bodies/a"]
    speck = card | {"shape": {"disc": {"diameter_mm": 0.1}}, "position_mm": [-2, -2, 0]}
    assert "cut by" in refused(scene(bodies={"a": MESH}, surfaces={"t": speck}), files)["/bodies/a"]
    eye = {"perspective": {"eye_mm": [*corner, 0.1]}}
    assert refused(scene(bodies={"a": MESH}, camera=eye), files) == {}
    eye = {"perspective": {"eye_mm": [-2, -2, 0.1]}}
    assert list(refused(scene(bodies={"a": MESH}, camera=eye), files)) == ["/camera/perspective/eye_mm"]


def test_an_asset_is_told_by_its_bytes(tmp_path: Path) -> None:
    ell().export(tmp_path / "a.ply")
    digest = "0" * 64
    (tmp_path / digest).write_bytes((tmp_path / "a.ply").read_bytes())
    mesh = body(MESH, shape={"mesh": {"file": f"asset:{digest}", "size_mm": 5}})
    document = staged(bodies(a=mesh), SceneFiles(assets=tmp_path))
    corners = document.bodies[0].solid.body.vertices
    assert np.linalg.norm(corners[:, None] - corners, axis=2).max() == pytest.approx(5)


def test_an_asset_that_is_no_mesh(tmp_path: Path) -> None:
    digest = "1" * 64
    (tmp_path / digest).write_bytes(b"\x89PNG\r\n\x1a\n")
    mesh = body(MESH, shape={"mesh": {"file": f"asset:{digest}"}})
    told = refused(bodies(a=mesh), SceneFiles(assets=tmp_path))
    assert list(told) == ["/bodies/a/shape/mesh/file"]
    assert "no mesh" in told["/bodies/a/shape/mesh/file"]


def test_a_picture_that_is_none(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"x")
    told = refused(scene(surfaces={"p": {"print": "a.png"}}), SceneFiles(folder=tmp_path))
    assert told == {"/surfaces/p/print": "not a PNG or JPEG picture"}


def test_a_mark_beside_the_page() -> None:
    told = refused(scene(surfaces={"p": {"print": "digits", "marks_mm": [[0, 0], [40, 0]]}}))
    assert told == {"/surfaces/p/marks_mm/1": "the mark does not lie on the page"}


def test_a_collision_in_a_later_frame() -> None:
    parts = {"a": body(BOX, shape={"box": {"size_mm": [30, 2, 2]}}), "b": body(BALL, position_mm=[0, 12, 0])}
    motion = {"frames": 8, "moves": [{"turn": {"what": "a", "angles_deg": [0, 360]}}]}
    told = refused(scene(bodies=parts, motion=motion))
    assert list(told) == ["/bodies/b"]
    assert told["/bodies/b"].endswith("in frame 2")


def test_faults_of_several_bodies_are_told_together() -> None:
    mapping = bodies(
        a=body(CALCITE, shape={"habit": {"forms": [{"hkl": [0, 0, 1]}]}}),
        b={"mineral": "calcite", "shape": {"box": {}}, "orientation": {"z": {"optical": "gamma"}}},
    )
    parse_scene(mapping)
    assert list(refused(mapping)) == ["/bodies/a/shape/habit/forms", "/bodies/b/orientation/z/optical"]
