"""Rays against triangles: the NumPy tree, every triangle, Embree and the half-spaces agree; no ray slips through."""

import numpy as np
import pytest
import trimesh

from crystal_core.geometry import visibility
from crystal_core.geometry.body import dot
from crystal_core.geometry.brilliant import brilliant
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.mesh_file import load_mesh
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.triangle_tree import TriangleTree
from crystal_core.geometry.visibility import EmbreeFinder, NumpyFinder, TreeFinder, face_finder


def _mesh_of(body: ConvexPolyhedron) -> Mesh:
    corners, owners = body.triangles
    return Mesh(body.vertices, corners, owners, body.normals, body.offsets)


def _torus() -> Mesh:
    torus = trimesh.creation.torus(3.0, 1.0, major_sections=24, minor_sections=12)
    body = load_mesh(torus.export(file_type="ply"), ".ply").solid.body
    assert isinstance(body, Mesh)
    return body


BRILLIANT = brilliant(6.5).body
TORUS = _torus()


def _rays(count: int, seed: int, reach: float) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    origin = rng.normal(size=(3, count))
    origin *= 30.0 / np.linalg.norm(origin, axis=0)
    return origin, rng.uniform(-reach, reach, (3, count)) - origin


@pytest.mark.parametrize("body", [_mesh_of(BRILLIANT), TORUS], ids=["brilliant", "torus"])
def test_finders_agree(body: Mesh) -> None:
    origin, ahead = _rays(20_000, 0, 4.0)
    tree, every = TreeFinder(body).first_face(origin, ahead), NumpyFinder(body).first_face(origin, ahead)
    assert 0.2 < (tree >= 0).mean() < 0.95
    assert (tree != every).mean() < 2e-4  # Möller and Trumbore's test at an edge
    assert (EmbreeFinder(body).first_face(origin, ahead) != tree).mean() < 2e-4  # float32 at an edge


def test_entry_and_exit_of_a_convex_mesh_are_those_of_its_half_spaces() -> None:
    mesh = _mesh_of(BRILLIANT)
    origin, ahead = _rays(20_000, 1, 3.0)
    enters, leaves, entry, exit_ = BRILLIANT.span(origin, ahead)
    met = enters < leaves
    distance, face = mesh.entry(origin, ahead)
    np.testing.assert_array_equal(np.isfinite(distance), met)
    np.testing.assert_array_equal(face[met], entry[met])
    np.testing.assert_allclose(distance[met], enters[met], rtol=1e-12)
    point, ahead = (origin + np.where(met, distance, 0.0) * ahead)[:, met], ahead[:, met]
    distance, face = mesh.exit(point, ahead)
    np.testing.assert_array_equal(face, exit_[met])
    np.testing.assert_allclose(distance, (leaves - enters)[met], rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(mesh.normal(face, point), BRILLIANT.normal(face, point))


def test_light_shut_in_never_gets_out() -> None:
    """A hundred reflections inside a torus: no epsilon, no ray lost at an edge, none stuck."""
    origin, ahead = _rays(2000, 2, 3.5)
    distance, face = TORUS.entry(origin, ahead)
    met = face >= 0
    point, ahead = (origin + np.where(met, distance, 0.0) * ahead)[:, met], ahead[:, met]
    ahead = ahead / np.sqrt(dot(ahead, ahead))
    length = np.zeros(point.shape[1])
    for _ in range(100):
        distance, face = TORUS.exit(point, ahead)
        assert (face >= 0).all()
        normal = TORUS.normal(face, point)
        assert (dot(normal, ahead) > -1e-4).all()
        point, length = point + distance * ahead, length + distance
        ahead = ahead - 2.0 * dot(normal, ahead) * normal
    assert (length > 10.0).all()


def test_crossings_alternate() -> None:
    """Along a line through a closed surface, in and out take turns, and their number is even."""
    origin, ahead = _rays(3000, 3, 4.0)
    found = TORUS.tree.crossings(origin, ahead)
    order = np.lexsort((found.distance, found.ray))
    ray, leaves, distance = found.ray[order], found.leaves[order], found.distance[order]
    assert (np.bincount(ray) % 2 == 0).all()
    assert np.bincount(ray).max() >= 4
    np.testing.assert_array_equal(leaves[::2], False)
    np.testing.assert_array_equal(leaves[1::2], True)
    inside = np.bincount(ray[::2], distance[1::2] - distance[::2])
    assert (inside >= 0.0).all()


def test_no_ray_slips_between_triangles() -> None:
    """Aimed at edges and corners exactly: every ray is stopped, by float64 arithmetic alone."""
    mesh = _mesh_of(BRILLIANT)
    ends = np.array(list(BRILLIANT.edges))
    rng = np.random.default_rng(4)
    share = rng.random((50, len(ends), 1))
    on_edges = (BRILLIANT.vertices[ends[:, 0]] * share + BRILLIANT.vertices[ends[:, 1]] * (1 - share)).reshape(-1, 3)
    targets = np.concatenate((on_edges, np.repeat(BRILLIANT.vertices, 50, axis=0)))
    start = rng.uniform(-0.3, 0.3, targets.shape)  # well inside
    distance, face = mesh.exit(start.T, (targets - start).T)
    assert (face >= 0).all()
    np.testing.assert_allclose(distance, 1.0, rtol=1e-12)
    # From outside as well, along the axes and diagonals of a cube's grid of triangles.
    cube = trimesh.creation.box((2.0, 2.0, 2.0)).subdivide().subdivide()
    body = load_mesh(cube.export(file_type="stl"), ".stl").solid.body
    grid = _mesh_of(body) if isinstance(body, ConvexPolyhedron) else body
    x, y = (axis.reshape(-1) for axis in np.meshgrid(np.linspace(-0.75, 0.75, 13), np.linspace(-0.75, 0.75, 13)))
    for axis in range(3):
        origin = np.roll(np.stack((x, y, np.full(len(x), -5.0))), axis, axis=0)
        ahead = np.roll(np.array([[0.0], [0.0], [1.0]]), axis, axis=0) * np.ones(len(x))
        np.testing.assert_allclose(grid.entry(origin, ahead)[0], 4.0, rtol=1e-7)


def test_one_ray_gives_the_same_bits_in_any_company() -> None:
    origin, ahead = _rays(9000, 5, 4.0)  # more than walk the tree together
    distance, face = TORUS.entry(origin, ahead)
    for number in (0, 4095, 4096, 8999):
        alone = TORUS.entry(origin[:, number : number + 1], ahead[:, number : number + 1])
        assert (alone[0][0], alone[1][0]) == (distance[number], face[number])


def test_many_pairs_are_taken_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    origin, ahead = _rays(500, 6, 4.0)
    whole = TORUS.tree.crossings(origin, ahead)
    monkeypatch.setattr("crystal_core.geometry.triangle_tree._PAIRS", 50)
    parted = TORUS.tree.crossings(origin, ahead)
    for field in ("ray", "triangle", "distance", "leaves"):
        np.testing.assert_array_equal(getattr(parted, field), getattr(whole, field))
    with pytest.raises(OverflowError):
        list(TORUS.tree.in_parts(origin, ahead, most=100))


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 17])
def test_few_triangles(count: int) -> None:
    corners = np.array([[[0, 0, z], [1, 0, z], [0, 1, z]] for z in range(count)], float)
    tree = TriangleTree(corners)
    origin, ahead = np.array([[0.2, 5.0], [0.2, 5.0], [-1.0, -1.0]]), np.array([[0.0, 0.0], [0.0, 0.0], [2.0, 2.0]])
    found = tree.crossings(origin, ahead)
    assert sorted(found.triangle.tolist()) == list(range(count))
    assert set(found.ray.tolist()) == {0}
    np.testing.assert_allclose(np.sort(found.distance), (np.arange(count) + 1) / 2)
    assert found.leaves.all()  # along the normals
    distance, triangle = tree.nearest(origin, ahead, leaving=True)
    assert distance.tolist() == [0.5, np.inf]
    assert triangle.tolist() == [0, -1]
    assert tree.nearest(origin, ahead, leaving=False)[1].tolist() == [-1, -1]


def test_rays_without_direction_meet_nothing() -> None:
    zero = np.zeros((3, 2))
    distance, face = TORUS.entry(zero, zero)
    assert np.isinf(distance).all()
    assert (face == -1).all()
    distance, _ = TORUS.exit(np.zeros((3, 0)), np.zeros((3, 0)))
    assert distance.shape == (0,)


def test_stand_in_for_embree(monkeypatch: pytest.MonkeyPatch) -> None:
    assert isinstance(face_finder(TORUS), EmbreeFinder)
    monkeypatch.setattr(visibility.importlib.util, "find_spec", lambda _: None)
    assert isinstance(face_finder(TORUS), TreeFinder)
    assert isinstance(face_finder(BRILLIANT), NumpyFinder)


def test_transformed() -> None:
    turn = np.array(((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    shift = np.array((1.0, 2.0, 3.0))
    moved = TORUS.transformed(turn, shift)
    origin, ahead = _rays(1000, 7, 4.0)
    distance, face = TORUS.entry(origin, ahead)
    there, other = moved.entry(turn @ origin + shift[:, None], turn @ ahead)
    np.testing.assert_array_equal(other, face)
    np.testing.assert_allclose(there[face >= 0], distance[face >= 0], rtol=1e-12)
    corners = moved.vertices[moved.corners[:, 0]]
    np.testing.assert_allclose(
        np.einsum("ti,ti->t", corners, moved.normals[moved.owners]), moved.offsets[moved.owners], atol=1e-4
    )
