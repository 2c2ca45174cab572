"""Habits: every one of the database is a closed body with exact faces and the symmetry of its class."""

from __future__ import annotations

import time
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull, Delaunay

import minerals_db
from crystal_core.errors import InputError
from crystal_core.geometry import ConvexPolyhedron
from crystal_core.geometry.cleavage import cleavage_closes, cleavage_solid
from crystal_core.geometry.habit import Form, centroid, diameter, grown, habit_solid
from crystal_core.geometry.half_spaces import bounded_body
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.point_groups import point_group
from crystal_core.geometry.solid import Solid
from crystal_core.scene.specimen import lattice_of, point_group_of, specimen_solid
from tests.geometry.test_point_groups import CELLS, FORMS

SIZE_MM = 12.5
HABITS = [(mineral_id, habit.name) for mineral_id, entry in minerals_db.minerals().items() for habit in entry.habits]
CUBIC = Lattice((1.0, 1.0, 1.0), (90.0, 90.0, 90.0))
FULL = point_group("m-3m")


@cache
def crystal(mineral_id: str, name: str) -> Solid:
    return specimen_solid(minerals_db.mineral(mineral_id), name, SIZE_MM)


def check_closed(body: ConvexPolyhedron) -> None:
    """Euler's formula, each edge between two faces, corners on their planes and inside all others, outward faces."""
    ends = [pair for ring in body.faces for pair in zip(ring, ring[1:] + ring[:1], strict=True)]
    assert len(set(ends)) == len(ends)
    assert {(j, i) for i, j in ends} == set(ends)
    assert len(body.vertices) - len(ends) // 2 + len(body.faces) == 2
    assert set(body.edges) | {(j, i) for i, j in body.edges} == set(ends)
    for ends_of_edge, (face, other) in body.edges.items():
        for number, (i, j) in ((face, ends_of_edge), (other, ends_of_edge[::-1])):
            ring = body.faces[number]
            assert ring[(ring.index(i) + 1) % len(ring)] == j
    size = diameter(body.vertices)
    gaps = body.vertices @ body.normals.T - body.offsets
    assert gaps.max() < 1e-12 * size
    np.testing.assert_allclose(np.linalg.norm(body.normals, axis=1), 1.0, rtol=1e-14)
    for face, ring in enumerate(body.faces):
        assert len(set(ring)) == len(ring) >= 3
        assert np.abs(gaps[list(ring), face]).max() < 1e-12 * size
        corners = body.vertices[list(ring)]
        around = sum(np.cross(corners[i - 1], corners[i]) for i in range(len(ring)))
        assert around @ body.normals[face] == pytest.approx(2.0 * body.areas_mm2[face], rel=1e-9)
    assert (body.areas_mm2 > 1e-9 * size**2).all()
    # No face may be missing: the vector areas of a closed surface add up to nothing.
    np.testing.assert_allclose(body.areas_mm2 @ body.normals, 0.0, atol=1e-12 * size**2)


def check_volume(body: ConvexPolyhedron) -> None:
    hull = ConvexHull(body.vertices)
    assert body.volume_mm3 > 0.0
    assert body.volume_mm3 == pytest.approx(hull.volume, rel=1e-10)
    assert body.areas_mm2.sum() == pytest.approx(hull.area, rel=1e-10)
    assert body.areas_mm2 @ body.offsets / 3.0 == pytest.approx(body.volume_mm3, rel=1e-10)
    assert len(hull.vertices) == len(body.vertices)


def check_symmetry(body: ConvexPolyhedron, operations: np.ndarray) -> None:
    """Each operation maps corners onto corners and faces onto faces."""
    size = diameter(body.vertices)
    for operation in operations:
        for points, allowed in ((body.vertices, 1e-11 * size), (body.normals * body.offsets[:, None], 1e-11 * size)):
            gaps = np.abs((points @ operation.T)[:, None] - points[None]).max(axis=2)
            assert gaps.min(axis=1).max() < allowed
            assert len(set(gaps.argmin(axis=1))) == len(points)


@pytest.mark.parametrize(("mineral_id", "name"), HABITS)
def test_closed_with_exact_faces(mineral_id: str, name: str) -> None:
    check_closed(crystal(mineral_id, name).body)


@pytest.mark.parametrize(("mineral_id", "name"), HABITS)
def test_volume_by_two_methods(mineral_id: str, name: str) -> None:
    check_volume(crystal(mineral_id, name).body)


@pytest.mark.parametrize(("mineral_id", "name"), HABITS)
def test_symmetry_of_the_class(mineral_id: str, name: str) -> None:
    entry = minerals_db.mineral(mineral_id)
    check_symmetry(crystal(mineral_id, name).body, point_group_of(entry).cartesian(lattice_of(entry)))


@pytest.mark.parametrize(("mineral_id", "name"), HABITS)
def test_faces_know_their_hkl_and_distances(mineral_id: str, name: str) -> None:
    entry, solid = minerals_db.mineral(mineral_id), crystal(mineral_id, name)
    lattice, group = lattice_of(entry), point_group_of(entry)
    forms = next(habit.forms for habit in entry.habits if habit.name == name)
    assert set(solid.hkl) == {face for form in forms for face in group.equivalents(form.hkl)}
    distances = []
    for hkl, normal, label in zip(solid.hkl, solid.body.normals, solid.labels, strict=True):
        assert hkl is not None
        np.testing.assert_allclose(lattice.face_normal(hkl), normal, atol=1e-13)
        form = next(form for form in forms if hkl in group.equivalents(form.hkl))
        assert label == f"{form.name or ''} {hkl[0]} {hkl[1]} {hkl[2]}".strip()
        distances.append(form.central_distance)
    # offset = scale · distance − n·(centroid from the common centre): four unknowns, all faces.
    unknowns = np.column_stack((distances, solid.body.normals))
    found, *_ = np.linalg.lstsq(unknowns, solid.body.offsets, rcond=None)
    np.testing.assert_allclose(unknowns @ found, solid.body.offsets, atol=1e-12 * SIZE_MM)


@pytest.mark.parametrize(("mineral_id", "name"), HABITS)
def test_size_and_centre(mineral_id: str, name: str) -> None:
    body = crystal(mineral_id, name).body
    apart = np.linalg.norm(body.vertices[:, None] - body.vertices[None], axis=2)
    assert apart.max() == pytest.approx(SIZE_MM, rel=1e-12)
    np.testing.assert_allclose(centroid(body), 0.0, atol=1e-12 * SIZE_MM)
    # Tetrahedra of a triangulation instead of pyramids over the faces.
    corners = body.vertices[Delaunay(body.vertices).simplices]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    np.testing.assert_allclose(volumes @ corners.mean(axis=1) / volumes.sum(), 0.0, atol=1e-11 * SIZE_MM)


@pytest.mark.parametrize("scale", [1e-200, 1e-3, 1e200])
def test_only_ratios_of_distances_count(scale: float) -> None:
    forms = [Form((1, 1, 1), 1.0), Form((1, 0, 0), 0.9)]
    scaled_forms = [Form(form.hkl, scale * form.central_distance) for form in forms]
    one, other = (habit_solid(CUBIC, FULL, drawn, 1.0).body for drawn in (forms, scaled_forms))
    np.testing.assert_allclose(one.vertices, other.vertices, atol=1e-12)


@pytest.mark.parametrize(("mineral_id", "name"), HABITS)
def test_no_sliver_of_an_edge(mineral_id: str, name: str) -> None:
    """Forms that should meet in a corner do: an edge of a few μm would be a slip of the central distances."""
    body = crystal(mineral_id, name).body
    lengths = [np.linalg.norm(body.vertices[i] - body.vertices[j]) for i, j in body.edges]
    assert min(lengths) > 1e-3 * SIZE_MM


@pytest.mark.parametrize(
    ("mineral_id", "name", "faces", "edges", "corners"),
    [
        ("calcite", "cleavage rhombohedron", 6, 12, 8),
        ("quartz", "prismatic", 18, 48, 32),
        ("quartz", "prismatic with s x", 30, 84, 56),
        ("halite", "cube", 6, 12, 8),
        ("fluorite", "octahedron", 8, 12, 6),
        ("fluorite", "cuboctahedron", 14, 24, 12),
        ("almandine", "dodecahedron", 12, 24, 14),
        ("almandine", "trapezohedron", 24, 48, 26),
        ("beryl", "prism", 8, 18, 12),
        ("zircon", "prism pyramid", 12, 20, 10),
        ("anatase", "dipyramid", 8, 12, 6),
    ],
)
def test_well_known_polyhedra(mineral_id: str, name: str, faces: int, edges: int, corners: int) -> None:
    body = crystal(mineral_id, name).body
    assert (len(body.faces), len(body.edges), len(body.vertices)) == (faces, edges, corners)


def test_volumes_of_the_cubic_forms() -> None:
    """Of an edge a: cube a³, octahedron √2/3 a³, rhombic dodecahedron 16/(3√3) a³; diameters a√3, a√2, 4a/√3."""
    cube, octahedron, dodecahedron = (
        habit_solid(CUBIC, FULL, [Form(hkl, 1.0)], 1.0).body for hkl in ((1, 0, 0), (1, 1, 1), (1, 1, 0))
    )
    assert cube.volume_mm3 == pytest.approx(3.0**-1.5, rel=1e-13)
    assert octahedron.volume_mm3 == pytest.approx(np.sqrt(2.0) / 3.0 * 2.0**-1.5, rel=1e-13)
    assert dodecahedron.volume_mm3 == pytest.approx(16.0 / (3.0 * np.sqrt(3.0)) * (np.sqrt(3.0) / 4.0) ** 3, rel=1e-13)


def test_tetrahedra_of_either_hand() -> None:
    positive, negative = (
        habit_solid(CUBIC, point_group("-43m"), [Form(hkl, 1.0)], 1.0) for hkl in ((1, 1, 1), (-1, -1, -1))
    )
    assert set(positive.hkl) == {(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)}
    np.testing.assert_allclose(sorted(map(tuple, -positive.body.normals)), sorted(map(tuple, negative.body.normals)))


@st.composite
def drawn_forms(draw: st.DrawFn) -> tuple[str, list[Form]]:
    symbol = draw(st.sampled_from(sorted(FORMS)))
    indices = st.tuples(*[st.integers(-3, 3)] * 3).filter(any)
    forms = draw(st.lists(st.tuples(indices, st.floats(0.5, 2.0)), min_size=1, max_size=5))
    return symbol, [Form(hkl, distance) for hkl, distance in forms]


@settings(deadline=None, max_examples=200, derandomize=True)
@given(drawn_forms())
def test_any_forms_make_a_body_or_are_refused(drawn: tuple[str, list[Form]]) -> None:
    symbol, forms = drawn
    group, lattice = point_group(symbol), CELLS[FORMS[symbol][0]]
    try:
        solid = habit_solid(lattice, group, forms, SIZE_MM, pointer="/shape/habit")
    except InputError as error:
        pointers = [fault.pointer for fault in error.faults]
    else:
        pointers = []
    assert all(pointer.startswith("/shape/habit/forms") for pointer in pointers)
    if pointers:
        return
    check_closed(solid.body)
    check_volume(solid.body)
    # A polar group leaves the centre free along its axis: corners and faces map onto themselves about the centroid too.
    check_symmetry(solid.body, group.cartesian(lattice))


# Errors


@pytest.mark.parametrize(
    ("symbol", "forms", "pointer", "told"),
    [
        ("m-3m", [], "/forms", "1 to 40 forms"),
        ("m-3m", [Form((0, 0, 0), 1.0)], "/forms/0/hkl", "no face"),
        ("m-3m", [Form((1, 0, 0), 1.0), Form((1, 1, 1), 0.0)], "/forms/1/central_distance", "greater than 0"),
        ("m-3m", [Form((1, 0, 0), float("nan"))], "/forms/0/central_distance", "greater than 0"),
        ("m-3m", [Form((1, 0, 0), 1.0), Form((0, 0, -1), 0.9)], "/forms/1", "same faces"),
        ("m-3m", [Form((1, 0, 0), 1.0), Form((2, 0, 0), 0.9)], "/forms/1", "same faces"),
        ("m-3m", [Form((1, 0, 0), 1.0), Form((1, 1, 1), 1.8)], "/forms/1", "bound nothing"),
        ("m-3m", [Form((1, 0, 0), 1.0), Form((1, 1, 1), np.sqrt(3.0))], "/forms/1", "bound nothing"),
        ("m-3m", [Form((1, 0, 0), 1.0), Form((1, 1, 1), 1e5)], "/forms", "factor"),
        ("m-3m", [Form((10**9, 0, 0), 1.0)], "/forms/0/hkl", "at most"),
        ("4/mmm", [Form((1, 0, 0), 1.0)], "/cell", "symmetry"),
        ("1", [Form((1, 0, 0), 1.0)], "/forms", "do not close"),
        ("mmm", [Form((1, 1, 0), 1.0)], "/forms", "do not close"),
        ("mmm", [Form((1, 0, 0), 1.0), Form((0, 1, 0), 1.0)], "/forms", "do not close"),
        ("mm2", [Form((1, 1, 1), 1.0)], "/forms", "do not close"),
        ("mm2", [Form((1, 1, 0), 1.0), Form((1, 1, 1), 1.0)], "/forms", "do not close"),
    ],
)
def test_errors_name_the_place(symbol: str, forms: list[Form], pointer: str, told: str) -> None:
    lattice = CUBIC if symbol != "4/mmm" else CELLS["orthorhombic"]
    prefix = "" if pointer == "/cell" else "/shape/habit"
    with pytest.raises(InputError, match=told) as caught:
        habit_solid(lattice, point_group(symbol), forms, 1.0, pointer="/shape/habit")
    assert [fault.pointer for fault in caught.value.faults] == [prefix + pointer]


@pytest.mark.parametrize("size_mm", [0.0, -1.0, float("inf"), float("nan"), 1e9, 1e-12])
def test_a_size_is_a_length(size_mm: float) -> None:
    with pytest.raises(InputError, match="/shape/size_mm"):
        habit_solid(CUBIC, FULL, [Form((1, 0, 0), 1.0)], size_mm, pointer="/shape")


def test_all_faults_at_once() -> None:
    with pytest.raises(InputError) as caught:
        habit_solid(CUBIC, FULL, [Form((1, 0, 0), 1.0), Form((0, 0, 0), 1.0), Form((1, 1, 1), -1.0)], 1.0)
    assert [fault.pointer for fault in caught.value.faults] == ["/forms/1/hkl", "/forms/2/central_distance"]


# Half-spaces from a point inside


def test_planes_that_bound_nothing_are_left_out() -> None:
    normals = np.concatenate((np.eye(3), -np.eye(3), [[0.6, 0.8, 0.0], [0.0, 0.6, 0.8]]))
    offsets = np.array([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 5.0, 1.2])
    body, kept = bounded_body(normals, offsets, np.array([0.3, -0.4, 0.2]))
    assert kept.tolist() == [0, 1, 2, 3, 4, 5, 7]
    check_closed(body)
    check_volume(body)
    again = ConvexPolyhedron.from_half_spaces(normals[kept], offsets[kept])
    assert again.volume_mm3 == pytest.approx(body.volume_mm3, rel=1e-12)
    np.testing.assert_allclose(sorted(map(tuple, again.vertices)), sorted(map(tuple, body.vertices)), atol=1e-9)


@pytest.mark.parametrize("inside", [(2.0, 0.0, 0.0), (1.0, 0.0, 0.0)])
def test_a_point_outside_is_refused(inside: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="inside"):
        bounded_body(np.concatenate((np.eye(3), -np.eye(3))), np.ones(6), np.array(inside))


def test_an_open_body_is_refused() -> None:
    with pytest.raises(ValueError, match="bounded"):
        bounded_body(np.concatenate((np.eye(3), -np.eye(3)))[:5], np.ones(5), np.zeros(3))


# Cleavage


@pytest.mark.parametrize(
    ("mineral_id", "hkl", "faces", "spacing_to_volume"),
    [
        ("calcite", (1, 0, 4), 6, None),
        ("fluorite", (1, 1, 1), 8, np.sqrt(3.0) / 2.0),
        ("halite", (0, 0, 1), 6, 1.0),
        ("sphalerite", (1, 1, 0), 12, 1.0 / np.sqrt(2.0)),
    ],
)
def test_cleavage_bodies(
    mineral_id: str, hkl: tuple[int, int, int], faces: int, spacing_to_volume: float | None
) -> None:
    entry = minerals_db.mineral(mineral_id)
    lattice, group = lattice_of(entry), point_group_of(entry)
    solid = cleavage_solid(lattice, group, [hkl], 3.0)
    check_closed(solid.body)
    check_symmetry(solid.body, group.laue.cartesian(lattice))
    assert len(solid.body.faces) == faces
    np.testing.assert_allclose(solid.body.offsets, 1.5, rtol=1e-12)
    if spacing_to_volume is None:  # a parallelepiped between three pairs of planes: s³ / det of the normals
        upper = np.array([lattice.face_normal(face) for face in ((1, 0, 4), (-1, 1, 4), (0, -1, 4))])
        spacing_to_volume = 1.0 / abs(np.linalg.det(upper))
    assert solid.body.volume_mm3 == pytest.approx(27.0 * spacing_to_volume, rel=1e-12)


def test_cleavage_with_three_spacings() -> None:
    entry = minerals_db.mineral("calcite")
    solid = cleavage_solid(lattice_of(entry), point_group_of(entry), [(1, 0, 4)], (20.0, 18.0, 12.0))
    check_closed(solid.body)
    opposite = solid.body.parallel_face
    widths = [solid.body.offsets[i] + solid.body.offsets[j] for i, j in enumerate(opposite) if i < j]
    np.testing.assert_allclose(widths, (20.0, 18.0, 12.0))
    np.testing.assert_allclose(centroid(solid.body), 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("mineral_id", "spacing", "told"),
    [
        ("muscovite", 3.0, "enclose no body"),
        ("topaz", 3.0, "enclose no body"),
        ("hornblende", 3.0, "enclose no body"),
        ("calcite", (3.0, 3.0), "3 pairs of parallel faces, not 2"),
        ("calcite", (3.0, -3.0, 3.0), "must be a length"),
        ("calcite", 0.0, "must be a length"),
        ("fluorite", (3.0, 3.0, 3.0, 30.0), "lie outside"),
    ],
)
def test_cleavage_that_makes_no_body(mineral_id: str, spacing: float | tuple[float, ...], told: str) -> None:
    entry = minerals_db.mineral(mineral_id)
    lattice, group = lattice_of(entry), point_group_of(entry)
    planes = [cleavage.hkl for cleavage in entry.cleavage]
    assert cleavage_closes(lattice, group, planes) == (mineral_id in ("calcite", "fluorite"))
    with pytest.raises(InputError, match=told) as caught:
        cleavage_solid(lattice, group, planes, spacing, pointer="/shape")
    assert all(fault.pointer.startswith("/shape") for fault in caught.value.faults)


def test_all_habits_in_well_under_a_second() -> None:
    entries = [
        (lattice_of(entry), point_group_of(entry), [Form(form.hkl, form.central_distance) for form in habit.forms])
        for entry in minerals_db.minerals().values()
        for habit in entry.habits
    ]
    begun = time.process_time()
    for lattice, group, forms in entries:
        grown(lattice, group, forms)
    assert time.process_time() - begun < 0.9
