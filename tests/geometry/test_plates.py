"""Boxes, plates, wedges, prisms: their sizes and angles; and how a cut stands against the crystal's axes."""

from math import cos, pi, sin, tan

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from crystal_core.errors import InputError
from crystal_core.geometry.boxes import RIM_FACES, box, plate, wedge, wedge_thickness
from crystal_core.geometry.cut_orientation import Line, Plane, cut_orientation, inclined
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.prisms import column, prism
from crystal_core.geometry.solid import Solid

CALCITE = Lattice((4.99026, 4.99026, 17.0684), (90.0, 90.0, 120.0))
GYPSUM = Lattice((6.284, 15.2, 6.523), (90.0, 127.41, 90.0))


def _solids() -> list[tuple[Solid, float]]:
    rim = RIM_FACES / 2 * sin(2 * pi / RIM_FACES)
    return [
        (box((2.0, 3.0, 4.0)), 24.0),
        (plate((20.0, 10.0), 0.03), 6.0),
        (plate(20.0, 0.03), rim * 100 * 0.03),
        (wedge((30.0, 10.0), (0.0, 0.25)), 37.5),
        (wedge((30.0, 10.0), (0.05, 0.25)), 45.0),
        (prism(60.0, 30.0, 40.0), 30**2 / 2 * sin(pi / 3) * 40),
        (prism(120.0, 30.0, 40.0), 30**2 / 2 * sin(2 * pi / 3) * 40),
        (column(3, 2.0, 5.0), 3 / 2 * sin(2 * pi / 3) * 5),
        (column(6, 2.0, 5.0), 6 / 2 * sin(2 * pi / 6) * 5),
        (column(7, 2.0, 5.0), 7 / 2 * sin(2 * pi / 7) * 5),
    ]


@pytest.mark.parametrize(("solid", "volume"), _solids())
def test_closed_centred_and_of_the_right_volume(solid: Solid, volume: float) -> None:
    body = solid.body
    assert len(body.vertices) - len(body.edges) + body.face_count == 2
    assert body.volume_mm3 == pytest.approx(volume, rel=1e-11)
    hull = ConvexHull(body.vertices)
    assert hull.volume == pytest.approx(volume, rel=1e-11)
    corners = body.vertices[hull.simplices]
    parts = np.abs(np.linalg.det(corners))
    np.testing.assert_allclose(parts @ corners.sum(axis=1) / (4 * parts.sum()), 0.0, atol=1e-11)
    assert len(set(solid.labels)) == body.face_count
    assert solid.hkl == (None,) * body.face_count


def test_box() -> None:
    solid = box((2.0, 3.0, 4.0))
    sides = dict(
        zip(solid.labels, zip(solid.body.normals.tolist(), solid.body.offsets.tolist(), strict=True), strict=True)
    )
    assert sides["+x"] == ([1.0, 0.0, 0.0], 1.0)
    assert sides["-y"] == ([0.0, -1.0, 0.0], 1.5)
    assert sides["+z"] == ([0.0, 0.0, 1.0], 2.0)
    np.testing.assert_array_equal(np.abs(solid.body.vertices), np.broadcast_to((1.0, 1.5, 2.0), (8, 3)))


@pytest.mark.parametrize("size", [20.0, (20.0, 10.0)])
def test_plate_is_plane_parallel(size: float | tuple[float, float]) -> None:
    solid = plate(size, 0.03)
    upper, lower = solid.labels.index("upper"), solid.labels.index("lower")
    assert solid.body.parallel_face[upper] == lower
    assert solid.body.offsets[upper] + solid.body.offsets[lower] == 0.03
    np.testing.assert_array_equal(solid.body.normals[[upper, lower]], ((0, 0, 1), (0, 0, -1)))
    corners = solid.body.vertices[list(solid.body.faces[upper])]
    np.testing.assert_allclose(np.linalg.norm(corners[:, :2], axis=1), 10.0 if size == 20.0 else np.hypot(10, 5))


def test_wedge_grows_along_x() -> None:
    solid = wedge((30.0, 10.0), wedge_thickness(30.0, 0.5, 0.02))
    upper, lower = (solid.labels.index(name) for name in ("upper", "lower"))
    angle = np.rad2deg(np.arccos(-solid.body.normals[upper] @ solid.body.normals[lower]))
    assert angle == pytest.approx(0.5, abs=1e-9)
    thin_end = solid.body.vertices[:, 0].min()
    assert thin_end < -15.0  # the centre of mass lies towards the thick end
    x = thin_end + np.array((0.001, 15.0, 29.999))
    below = np.stack((x, np.zeros(3), np.full(3, -10.0)))
    enters, leaves, entry, exit_ = solid.body.span(below, np.array([[0.0] * 3, [0.0] * 3, [1.0] * 3]))
    np.testing.assert_array_equal(entry, lower)
    np.testing.assert_array_equal(exit_, upper)
    np.testing.assert_allclose(leaves - enters, 0.02 + (x - thin_end) * tan(np.deg2rad(0.5)), rtol=1e-9)
    edge = wedge((30.0, 10.0), (0.0, 0.25))
    assert "thin end" not in edge.labels
    assert edge.body.face_count == 5


@pytest.mark.parametrize("apex", [1.0, 45.0, 60.0, 90.0, 170.0])
def test_prism(apex: float) -> None:
    solid = prism(apex, 30.0, 40.0)
    left, right, base = (solid.body.normals[solid.labels.index(name)] for name in ("left", "right", "base"))
    assert 180.0 - np.rad2deg(np.arccos(left @ right)) == pytest.approx(apex, abs=1e-9)
    np.testing.assert_array_equal(base, (0, 0, -1))
    np.testing.assert_array_equal(left * (-1, 1, 1), right)
    top = solid.body.vertices[:, 2].max()
    edge = solid.body.vertices[solid.body.vertices[:, 2] > top - 1e-9]
    np.testing.assert_allclose(np.abs(edge), np.broadcast_to((0.0, 20.0, top), (2, 3)), atol=1e-12)
    foot = solid.body.vertices[solid.body.vertices[:, 2] < top - 1e-3]
    np.testing.assert_allclose(np.linalg.norm((foot - edge[0])[:, [0, 2]], axis=1), 30.0, rtol=1e-12)


def test_column_faces_x() -> None:
    solid = column(6, 2.0, 5.0)
    np.testing.assert_array_equal(solid.body.normals[solid.labels.index("side 1")], (1, 0, 0))
    np.testing.assert_allclose(np.linalg.norm(solid.body.vertices[:, :2], axis=1), 1.0, rtol=1e-14)


@pytest.mark.parametrize(
    ("make", "place"),
    [
        (lambda: box((1.0, 0.0, 1.0), pointer="/s"), "/s/size_mm/1"),
        (lambda: plate((1.0, float("inf")), 0.1, pointer="/s"), "/s/size_mm/1"),
        (lambda: plate(-1.0, 0.1, pointer="/s"), "/s/size_mm"),
        (lambda: plate(1.0, 0.0, pointer="/s"), "/s/thickness_mm"),
        (lambda: wedge((1.0, 1.0), (0.2, 0.2), pointer="/s"), "/s/thickness_mm"),
        (lambda: wedge((1.0, 1.0), (-0.1, 0.2), pointer="/s"), "/s/thickness_mm"),
        (lambda: wedge_thickness(1.0, 90.0, pointer="/s"), "/s/angle_deg"),
        (lambda: prism(180.0, 1.0, 1.0, pointer="/s"), "/s/apex_deg"),
        (lambda: prism(60.0, float("nan"), 1.0, pointer="/s"), "/s/side_mm"),
        (lambda: prism(60.0, 1.0, -1.0, pointer="/s"), "/s/length_mm"),
        (lambda: column(2, 1.0, 1.0, pointer="/s"), "/s/sides"),
        (lambda: column(6, 1.0, 0.0, pointer="/s"), "/s/length_mm"),
    ],
)
def test_wrong_sizes(make: object, place: str) -> None:
    assert callable(make)
    with pytest.raises(InputError) as caught:
        make()
    assert [fault.pointer for fault in caught.value.faults] == [place]


# How a cut stands against the crystal.


@pytest.mark.parametrize("angle", [0.0, 10.0, 45.0, 90.0, 135.0])
def test_plate_at_an_angle_to_the_optic_axis(angle: float) -> None:
    """The optic axis of calcite is c: a plate cut at an angle to it holds it at that angle to its normal."""
    axis = CALCITE.direction((0, 0, 1))
    rotation = cut_orientation(CALCITE, up=inclined(axis, CALCITE.direction((1, 0, 0)), angle))
    solid = plate((20.0, 20.0), 0.03)
    normal = rotation @ solid.body.normals[solid.labels.index("upper")]
    assert np.rad2deg(np.arccos(np.clip(normal @ axis, -1, 1))) == pytest.approx(angle, abs=1e-6)
    # It leans towards a: none of it along y of the crystal.
    assert normal[1] == pytest.approx(0.0, abs=1e-15)
    assert normal[0] == pytest.approx(sin(np.deg2rad(angle)), abs=1e-15)


def test_plate_along_named_directions() -> None:
    """A cleavage plate of calcite: 44.6° between its normal and the optic axis, which lies over the plate's x."""
    rotation = cut_orientation(CALCITE, up=Plane((1, 0, 4)), along=Line((0, 0, 1)))
    axis = rotation.T @ CALCITE.direction((0, 0, 1))
    pole = np.deg2rad(CALCITE.interfacial_angle_deg((1, 0, 4), (0, 0, 1)))
    assert np.rad2deg(pole) == pytest.approx(44.6, abs=0.05)
    np.testing.assert_allclose(axis, (sin(pole), 0.0, cos(pole)), atol=1e-15)
    # In a monoclinic crystal a plane's normal is not the direction of the same indices.
    face = cut_orientation(GYPSUM, up=Plane((1, 0, 0)), along=Line((0, 1, 0)))
    edge = cut_orientation(GYPSUM, up=Line((1, 0, 0)), along=Line((0, 1, 0)))
    between = np.rad2deg(np.arccos(face[:, 2] @ edge[:, 2]))
    assert between == pytest.approx(127.41 - 90.0, abs=1e-9)
    np.testing.assert_allclose(face[:, 0], (0, 1, 0), atol=1e-15)


_components = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: max(map(abs, v)) > 1e-3)


@given(up=_components, along=_components)
@settings(max_examples=200, deadline=None)
def test_orientation_is_a_proper_rotation(up: tuple[float, ...], along: tuple[float, ...]) -> None:
    z, towards = np.array(up) / np.linalg.norm(up), np.array(along) / np.linalg.norm(along)
    assume(np.linalg.norm(np.cross(z, towards)) > 1e-5)
    for rotation in (cut_orientation(CALCITE, up=up, along=along), cut_orientation(CALCITE, up=up)):
        np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)
        assert np.linalg.det(rotation) == pytest.approx(1.0)
        np.testing.assert_allclose(rotation[:, 2], z, atol=1e-15)
    turned = cut_orientation(CALCITE, up=up, along=along).T @ towards
    assert turned[0] > 0.0
    assert turned[1] == pytest.approx(0.0, abs=1e-14)
    # The smallest turn: its angle is that between c* and the plate's normal.
    free = cut_orientation(CALCITE, up=up)
    assert np.trace(free) == pytest.approx(1 + 2 * z[2], abs=1e-12)


@pytest.mark.parametrize("tilt", [1e-3, 1e-7, 1e-12, 1e-200, 0.0])
def test_smallest_turn_near_upside_down(tilt: float) -> None:
    up = (tilt, 0.0, -1.0)
    rotation = cut_orientation(CALCITE, up=up)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(rotation[:, 2], np.array(up) / np.hypot(tilt, 1.0), atol=1e-15)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("up", "along", "place", "told"),
    [
        (Plane((0, 0, 0)), None, "/o/up", "no direction"),
        ((0.0, 0.0, 0.0), None, "/o/up", "not all 0"),
        ((0.0, float("nan"), 1.0), None, "/o/up", "three numbers"),
        ((0.0, 1.0), None, "/o/up", "three numbers"),
        (Plane((0, 0, 1)), Line((0, 0, 0)), "/o/along", "no direction"),
        (Plane((0, 0, 1)), Line((0, 0, 1)), "/o/along", "same line"),
        (Plane((0, 0, 1)), (0.0, 0.0, -3.0), "/o/along", "same line"),
    ],
)
def test_directions_that_say_nothing(up: object, along: object, place: str, told: str) -> None:
    with pytest.raises(InputError, match=told) as caught:
        cut_orientation(CALCITE, up=up, along=along, pointer="/o")  # type: ignore[arg-type]
    assert [fault.pointer for fault in caught.value.faults] == [place]
    with pytest.raises(InputError, match="same line"):
        inclined((0, 0, 1), (0, 0, -2), 30.0)
