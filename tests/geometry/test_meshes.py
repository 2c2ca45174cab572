"""Meshes of one's own: what is taken and what is mended; and that whatever is taken is sound."""

from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from crystal_core.errors import InputError
from crystal_core.geometry.brilliant import MODERN, brilliant
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.mesh_file import LoadedMesh, load_mesh
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.prisms import prism
from crystal_core.geometry.solid import Solid
from tests.geometry.mesh_files import BOX, SUFFIXES, TORUS, file_of, mesh_of


def _as_trimesh(body: ConvexPolyhedron) -> trimesh.Trimesh:
    return mesh_of(body.vertices, body.triangles[0])


# What is taken.


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_box_of_twelve_triangles_has_six_faces(suffix: str) -> None:
    loaded = load_mesh(file_of(BOX, suffix), suffix)
    body = loaded.solid.body
    assert isinstance(body, ConvexPolyhedron)
    assert loaded.solid.labels == tuple(f"face {number}" for number in range(1, 7))
    assert len(body.vertices) == 8
    assert all(len(ring) == 4 for ring in body.faces)
    assert body.volume_mm3 == pytest.approx(24.0, rel=1e-7)
    # Exact planes, by falling area.
    np.testing.assert_array_equal(np.abs(body.normals), np.eye(3)[[0, 0, 1, 1, 2, 2]])
    np.testing.assert_allclose(body.offsets, (1.0, 1.0, 1.5, 1.5, 2.0, 2.0), rtol=1e-7)
    assert [note for note in loaded.notes if "merged" not in note] == []


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("solid", [brilliant(6.5, MODERN), prism(60.0, 30.0, 40.0)], ids=["brilliant", "prism"])
def test_cuts_come_back_from_files(suffix: str, solid: Solid) -> None:
    body = solid.body
    back = load_mesh(file_of(_as_trimesh(body), suffix), suffix).solid.body
    assert isinstance(back, ConvexPolyhedron)
    assert back.face_count == body.face_count
    assert len(back.vertices) == len(body.vertices)
    assert len(back.edges) == len(body.edges)
    size = np.ptp(body.vertices, axis=0).max()
    planes = np.column_stack((body.normals, body.offsets / size))
    found = np.column_stack((back.normals, back.offsets / size))
    gaps = np.abs(planes[:, None] - found[None]).max(axis=2)
    assert len(set(gaps.argmin(axis=1))) == body.face_count
    np.testing.assert_allclose(gaps.min(axis=1), 0.0, atol=2e-6)  # float32 over the smallest facets
    assert back.volume_mm3 == pytest.approx(body.volume_mm3, rel=1e-6)
    for face, ring in enumerate(back.faces):
        np.testing.assert_allclose(back.vertices[list(ring)] @ back.normals[face], back.offsets[face], atol=1e-6 * size)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_torus_is_a_mesh(suffix: str) -> None:
    loaded = load_mesh(file_of(TORUS, suffix), suffix, size_mm=20.0)
    body = loaded.solid.body
    assert isinstance(body, Mesh)
    # A torus of revolution: its quadrangles are planar.
    assert body.face_count == 24 * 12 == len(loaded.solid.labels)
    scale = 20.0 / np.linalg.norm(TORUS.vertices[:, None] - TORUS.vertices[None], axis=2).max()
    assert body.volume_mm3 == pytest.approx(TORUS.volume * scale**3, rel=1e-6)
    assert body.areas_mm2.sum() == pytest.approx(TORUS.area * scale**2, rel=1e-6)
    assert (np.diff(body.areas_mm2) < 1e-6).all()
    assert len(body.vertices) - len(body.edges) + body.face_count == 0  # Euler: one handle
    corners = body.vertices[body.corners]
    heights = np.einsum("tci,ti->tc", corners, body.normals[body.owners]) - body.offsets[body.owners][:, None]
    np.testing.assert_allclose(heights, 0.0, atol=1e-5 * 20)
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ti,ti->t", outward, body.normals[body.owners]) > 0.0).all()


def test_size_and_place() -> None:
    far = BOX.copy().apply_transform(trimesh.transformations.translation_matrix((300.0, -50.0, 7.0)))
    loaded = load_mesh(file_of(far, ".ply"), ".ply", size_mm=10.0)
    vertices = loaded.solid.body.vertices
    assert np.linalg.norm(vertices[:, None] - vertices[None], axis=2).max() == pytest.approx(10.0, rel=1e-5)
    np.testing.assert_allclose(vertices.mean(axis=0), 0.0, atol=1e-5)
    assert np.argsort(np.ptp(vertices, axis=0)).tolist() == [0, 1, 2]
    # A wedge-like body: not the middle of the corners but the centre of mass.
    tetrahedron = load_mesh(
        file_of(
            mesh_of([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]), ".stl"
        ),
        ".stl",
    )
    np.testing.assert_allclose(tetrahedron.solid.body.vertices.min(axis=0), -1.0, atol=1e-6)


def test_polygons_and_straight_corners() -> None:
    """An OBJ of quadrangles, one edge of the box divided: still a box."""
    text = (
        b"# box\nmtllib ../../etc/stone.mtl\no box\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\n"
        b"v 1 1 1\nv 0 1 1\nv 0.5 0 0\nvt 0 0\nvn 0 0 1\nusemtl red\ns 1\nf 4 3 2 9 1\nf 5/1/1 6/1/1 7/1/1 8/1/1\n"
        b"f 1 9 2 6 5\nf 2 3 \\\n7 6\nf 3//1 4//1 8//1 7//1\nf 4 1 5 8\n"
    )
    loaded = load_mesh(text, ".obj")
    assert isinstance(loaded.solid.body, ConvexPolyhedron)
    assert loaded.solid.body.face_count == 6
    assert len(loaded.solid.body.vertices) == 8
    assert loaded.solid.body.volume_mm3 == pytest.approx(1.0)
    assert loaded.notes == ("left out the materials of another file",)


def test_faces_of_a_concave_body() -> None:
    """A box with a smaller box cut out of a corner: nine faces, three of them L-shaped."""
    corner = trimesh.creation.extrude_triangulation(
        np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], float),
        np.array([[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]]),
        1.0,
    )
    body = load_mesh(file_of(corner, ".ply"), ".ply").solid.body
    assert isinstance(body, Mesh)
    assert body.face_count == 8
    assert body.volume_mm3 == pytest.approx(3.0, rel=1e-6)
    np.testing.assert_allclose(body.areas_mm2, (3, 3, 2, 2, 1, 1, 1, 1), rtol=1e-6)
    assert len(body.edges) == 18


def test_triangles_without_height_belong_to_a_neighbour() -> None:
    """A corner of one face on the edge of another, the gap closed by a triangle in a line."""
    vertices = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 2], [1, 0, 0]]
    faces = [[0, 3, 2], [0, 2, 1], [0, 1, 5], [0, 5, 4], [5, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    loaded = load_mesh(file_of(mesh_of(vertices, faces), ".ply"), ".ply")
    assert isinstance(loaded.solid.body, ConvexPolyhedron)
    assert loaded.solid.body.face_count == 5
    assert len(loaded.solid.body.vertices) == 5
    assert loaded.solid.body.volume_mm3 == pytest.approx(8 / 3, rel=1e-6)


def test_round_bodies_of_many_facets_stay_meshes() -> None:
    body = load_mesh(file_of(trimesh.creation.icosphere(subdivisions=3), ".stl"), ".stl").solid.body
    assert isinstance(body, Mesh)
    assert body.face_count == 1280
    few = load_mesh(file_of(trimesh.creation.icosphere(subdivisions=1), ".stl"), ".stl").solid.body
    assert isinstance(few, ConvexPolyhedron)
    assert few.face_count == 80


# What is mended.


def test_doubled_corners_are_merged() -> None:
    loose = mesh_of(
        BOX.vertices[BOX.faces.reshape(-1)] + np.random.default_rng(0).uniform(-4e-7, 4e-7, (36, 3)),
        np.arange(36).reshape(-1, 3),
    )
    loaded = load_mesh(file_of(loose, ".ply"), ".ply")
    assert loaded.notes == ("merged 36 corners that fall together into 8",)
    assert isinstance(loaded.solid.body, ConvexPolyhedron)
    assert loaded.solid.body.face_count == 6


def test_winding_is_mended() -> None:
    faces = BOX.faces.copy()
    faces[3] = faces[3, ::-1]
    one = load_mesh(file_of(mesh_of(BOX.vertices, faces), ".ply"), ".ply")
    assert one.notes == ("turned 1 triangle round, against the others' sense",)
    inside_out = load_mesh(file_of(mesh_of(BOX.vertices, BOX.faces[:, ::-1]), ".ply"), ".ply")
    assert inside_out.notes == ("turned the surface inside out: its triangles were wound clockwise",)
    rng = np.random.default_rng(1)
    faces = np.where(rng.random((len(TORUS.faces), 1)) < 0.5, TORUS.faces[:, ::-1], TORUS.faces)
    mixed = load_mesh(file_of(mesh_of(TORUS.vertices, faces), ".ply"), ".ply")
    assert mixed.notes[0].startswith("turned ")
    straight = load_mesh(file_of(TORUS, ".ply"), ".ply")
    assert straight.notes == ()
    for loaded in (one, inside_out):
        assert loaded.solid.body.volume_mm3 == pytest.approx(24.0, rel=1e-6)
    assert mixed.solid.body.volume_mm3 == pytest.approx(straight.solid.body.volume_mm3, rel=1e-12)


def test_idle_triangles_are_left_out() -> None:
    faces = np.concatenate((BOX.faces, [[0, 0, 1], BOX.faces[2], BOX.faces[5][::-1]]))
    loaded = load_mesh(file_of(mesh_of(BOX.vertices, faces), ".ply"), ".ply")
    assert loaded.notes == ("left out 1 triangle without area", "left out 2 triangles that came twice")
    assert loaded.solid.body.volume_mm3 == pytest.approx(24.0, rel=1e-6)


# Whatever comes.


FILES = [(file_of(mesh, suffix), suffix) for mesh in (BOX, TORUS) for suffix in SUFFIXES]


@given(
    which=st.sampled_from(range(len(FILES))),
    changes=st.lists(st.tuples(st.floats(0, 1), st.binary(max_size=4)), max_size=4),
)
@settings(max_examples=300, deadline=None)
def test_damaged_files_are_taken_or_refused(which: int, changes: list[tuple[float, bytes]]) -> None:
    """Nothing but a sound body or an InputError comes of bytes, whatever they are."""
    data, suffix = FILES[which]
    for place, replaced in changes:
        at = int(place * len(data))
        data = data[:at] + replaced + data[at + len(replaced) :]
    _sound_or_refused(lambda: load_mesh(data, suffix, 10.0, pointer="/m"))


@given(seed=st.integers(0, 2**32 - 1), amount=st.floats(0, 1.5))
@settings(max_examples=60, deadline=None)
def test_shaken_corners_are_taken_or_refused(seed: int, amount: float) -> None:
    rng = np.random.default_rng(seed)
    mesh = trimesh.creation.icosphere(subdivisions=1)
    shaken = mesh.vertices + amount * rng.normal(size=mesh.vertices.shape) * (rng.random((len(mesh.vertices), 1)) < 0.2)
    _sound_or_refused(lambda: load_mesh(file_of(mesh_of(shaken, mesh.faces), ".stl"), ".stl", 10.0))


def _sound_or_refused(load: Callable[[], LoadedMesh]) -> None:
    try:
        loaded = load()
    except InputError:
        return
    body = loaded.solid.body
    assert body.volume_mm3 > 0.0
    assert len(loaded.solid.labels) == body.face_count
    np.testing.assert_allclose(np.linalg.norm(body.normals, axis=1), 1.0, rtol=1e-12)
    corners, owners = body.triangles
    edges = np.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)])
    assert len(np.unique(edges, axis=0)) == len(edges)  # every edge once each way
    assert (np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)[1] == 2).all()
    heights = np.einsum("tci,ti->tc", body.vertices[corners], body.normals[owners]) - body.offsets[owners][:, None]
    assert np.abs(heights).max() < 3e-4  # some times FLAT of 10 mm
    if isinstance(body, ConvexPolyhedron):
        assert (body.vertices @ body.normals.T - body.offsets).max() < 3e-4
