"""Convex bodies: closed, of the right volume, and left by the right face."""

import numpy as np
import pytest

from crystal_core.errors import InputError
from crystal_core.geometry import ConvexPolyhedron
from crystal_core.geometry.boxes import box
from crystal_core.geometry.visibility import EmbreeFinder, NumpyFinder
from crystal_core.scene.specimen import cleavage_body
from minerals_db import mineral

QUARTER_TURN = np.array(((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))


def _bodies() -> list[ConvexPolyhedron]:
    rng = np.random.default_rng(0)
    sphere = rng.normal(size=(20, 3))
    sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
    return [
        box((22.0, 20.0, 14.0)).body,
        cleavage_body(mineral("calcite"), (12.0, 20.0, 20.0)).body,
        ConvexPolyhedron.from_half_spaces(sphere, np.full(20, 6.0)),  # tangents of a sphere: no two parallel
    ]


@pytest.mark.parametrize("body", _bodies(), ids=["block", "rhombohedron", "random"])
def test_closed_and_oriented(body: ConvexPolyhedron) -> None:
    edges = [frozenset(pair) for ring in body.faces for pair in zip(ring, ring[1:] + ring[:1], strict=True)]
    assert len(body.vertices) - len(set(edges)) + len(body.faces) == 2
    assert all(edges.count(edge) == 2 for edge in set(edges))
    for (a, b, c), face in zip(body.vertices[body.triangles[0]], body.triangles[1], strict=True):
        assert np.cross(b - a, c - a) @ body.normals[face] > 0
    hits = np.random.default_rng(1).uniform(-20, 20, (200_000, 3))
    inside = (hits @ body.normals.T <= body.offsets).all(axis=1).mean() * 40.0**3
    assert body.volume_mm3 == pytest.approx(inside, rel=0.03)


def test_volumes() -> None:
    assert box((2.0, 3.0, 4.0)).body.volume_mm3 == pytest.approx(24.0, rel=1e-12)
    body = cleavage_body(mineral("calcite"), (12.0, 20.0, 20.0)).body
    n = np.array([one for k, one in enumerate(body.normals) if all(one @ other > -0.999 for other in body.normals[:k])])
    assert n.shape == (3, 3)
    assert body.volume_mm3 == pytest.approx(20 * 20 * 12 / abs(np.linalg.det(n)), rel=1e-9)


@pytest.mark.parametrize("body", _bodies(), ids=["block", "rhombohedron", "random"])
def test_exit_is_the_nearest_plane_ahead(body: ConvexPolyhedron) -> None:
    rng = np.random.default_rng(2)
    start = body.vertices.mean(axis=0)[:, None] + rng.uniform(-0.5, 0.5, (3, 2000))
    ahead = rng.normal(size=(3, 2000))
    ahead[:, :3] = np.eye(3)  # along planes of the block
    distance, face = body.exit(start, ahead)
    speed = body.normals @ ahead
    with np.errstate(divide="ignore"):
        all_distances = np.where(speed > 0, (body.offsets[:, None] - body.normals @ start) / speed, np.inf)
    np.testing.assert_array_equal(face, all_distances.argmin(axis=0))
    np.testing.assert_allclose(distance, all_distances.min(axis=0), rtol=1e-12)
    # From the exit on, back inside: the face it stands on is never its own exit, with no epsilon anywhere.
    point = start + distance * ahead
    inward = ahead - 2 * np.sum(ahead * body.normals.T[:, face], axis=0) * body.normals.T[:, face]
    again, other = body.exit(point, inward)
    assert (other != face).all()
    assert (again >= 0).all()


@pytest.mark.parametrize("body", _bodies(), ids=["block", "rhombohedron", "random"])
def test_finders_agree(body: ConvexPolyhedron) -> None:
    """Embree, every triangle by NumPy, and the half-spaces: the same first face, save on the very edges."""
    rng = np.random.default_rng(3)
    origin = rng.normal(size=(3, 20_000))
    origin *= 60.0 / np.linalg.norm(origin, axis=0)
    aim = rng.normal(size=(3, 20_000)) * 6.0
    ahead = (aim - origin) / np.linalg.norm(aim - origin, axis=0)
    enters, leaves, entry, _ = body.span(origin, ahead)
    expected = np.where(enters < leaves, entry, -1)
    slow, fast = NumpyFinder(body).first_face(origin, ahead), EmbreeFinder(body).first_face(origin, ahead)
    np.testing.assert_array_equal(slow, expected)
    assert (fast != expected).mean() < 2e-4  # float32 at an edge
    assert 0.3 < (expected >= 0).mean() < 1.0


def test_transformed() -> None:
    body = box((2.0, 4.0, 6.0)).body.transformed(QUARTER_TURN, np.array((0.0, 0.0, 3.0)))
    np.testing.assert_allclose(body.vertices.min(axis=0), (-2.0, -1.0, 0.0), atol=1e-12)
    assert ((body.vertices @ body.normals.T) <= body.offsets + 1e-12).all()


@pytest.mark.parametrize(
    ("normals", "offsets"),
    [
        (np.concatenate((np.eye(3), -np.eye(3))), (1, 1, 1, -2, 1, 1)),  # nothing inside
        (np.eye(3), (1, 1, 1)),  # open
        (np.concatenate((np.eye(3), -np.eye(3), [[0.6, 0.8, 0.0]])), (1, 1, 1, 1, 1, 1, 5)),  # one bounds nothing
    ],
)
def test_faces_that_do_not_close_are_refused(normals: np.ndarray, offsets: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match="/shape"):
        ConvexPolyhedron.from_half_spaces(normals, np.array(offsets, float))


def test_lines_all_but_along_a_face() -> None:
    """The smallest speeds there are: the crossing is infinitely far away, and nobody is warned."""
    body = box((2.0, 2.0, 2.0)).body
    ahead = np.array(((1.0, 1.0, 1.0), (5e-324, 1e-310, 0.0), (0.0, 0.0, 0.0)))
    enters, leaves, entry, exit_ = body.span(np.zeros((3, 3)), ahead)
    np.testing.assert_array_equal(enters, -1.0)
    np.testing.assert_array_equal(leaves, 1.0)
    assert (body.normals[entry, 0] == -1.0).all()
    assert (body.normals[exit_, 0] == 1.0).all()
