"""Spheres and cabochons: exact where rays meet them, against closed forms and against fine triangles."""

from math import pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from crystal_core.errors import InputError
from crystal_core.geometry.body import dot
from crystal_core.geometry.cabochon import Cabochon, cabochon
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.solid import Solid
from crystal_core.geometry.sphere import Sphere, sphere
from crystal_core.geometry.visibility import ExactFinder, face_finder

Curved = Sphere | Cabochon

TURN = Rotation.from_rotvec((0.3, -0.7, 0.4)).as_matrix()
SHIFT = np.array((3.0, -5.0, 2.0))


def _bodies() -> list[Curved]:
    upright: list[Curved] = [
        sphere(20.0).body,
        cabochon((12.0, 10.0), 5.0).body,
        cabochon((12.0, 10.0), 3.0, profile="cap").body,
        cabochon((10.0, 10.0), 5.0, profile="cap").body,
    ]
    return [*upright, *(body.transformed(TURN, SHIFT) for body in upright)]


IDS = ["sphere", "dome", "cap", "hemisphere", "sphere'", "dome'", "cap'", "hemisphere'"]
bodies = pytest.mark.parametrize("body", _bodies(), ids=IDS)


def _rays(body: Curved, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    origin = rng.normal(size=(3, count))
    origin *= 40.0 / np.linalg.norm(origin, axis=0)
    reach = 0.7 * float(np.ptp(body.vertices, axis=0).max())
    aim = rng.uniform(-reach, reach, (3, count))
    return _middle(body) + origin, aim - origin


def _middle(body: Curved) -> np.ndarray:
    """Return the centre of mass, where `sphere` and `cabochon` leave it, shape (3, 1)."""
    upright = isinstance(body, Sphere) or body.rotation[2, 2] == 1.0
    return np.zeros((3, 1)) if upright and abs(body.centre[0]) < 1e-9 else SHIFT[:, None]


def _miss(body: Curved, face: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Return how far points lie from the surface of a face, in mm or nearly so."""
    if isinstance(body, Sphere):
        return np.linalg.norm(point - body.centre[:, None], axis=0) - body.radius_mm
    own = body.rotation.T @ (point - body.centre[:, None])
    dome = (np.linalg.norm(own / body.semi_axes_mm[:, None], axis=0) - 1.0) * body.semi_axes_mm.min()
    return np.where(face == 0, dome, own[2] - body.floor * body.semi_axes_mm[2])


@bodies
def test_points_of_entry_and_exit_lie_on_their_faces(body: Curved) -> None:
    origin, ahead = _rays(body, 20_000, 0)
    enters, leaves, entry, exit_ = body.span(origin, ahead)
    met = enters < leaves
    assert 0.2 < met.mean() < 0.9
    faces = range(body.face_count)
    for distance, face, sense in ((enters, entry, -1.0), (leaves, exit_, 1.0)):
        assert set(face[met]) == set(faces)
        point = origin[:, met] + distance[met] * ahead[:, met]
        np.testing.assert_allclose(_miss(body, face[met], point), 0.0, atol=1e-13)
        normal = body.normal(face[met], point)
        np.testing.assert_allclose(dot(normal, normal), 1.0, rtol=1e-14)
        assert (sense * dot(normal, ahead[:, met]) > 0.0).all()
    # The line that misses has no point inside: try the one nearest to the middle.
    middle = _middle(body)
    nearest = dot(middle - origin, ahead) / dot(ahead, ahead)
    foot = (origin + nearest * ahead)[:, ~met]
    inside = np.ones(foot.shape[1], bool)
    for face in faces:
        inside &= _miss(body, np.full(foot.shape[1], face), foot) * (1 if face == 0 else -1) < 0.0
    assert not inside.any()


@bodies
def test_exit_needs_no_epsilon(body: Curved) -> None:
    """Light shut in for fifty reflections stays on the surface; no chord is lost and none has a negative length."""
    origin, ahead = _rays(body, 2000, 1)
    enters, leaves, _, _ = body.span(origin, ahead)
    met = enters < leaves
    point, ahead = (origin + np.where(met, enters, 0.0) * ahead)[:, met], ahead[:, met]
    ahead = ahead / np.sqrt(dot(ahead, ahead))
    for _ in range(50):
        distance, face = body.exit(point, ahead)
        assert np.isfinite(distance).all()
        assert (distance >= 0.0).all()
        point = point + distance * ahead
        np.testing.assert_allclose(_miss(body, face, point), 0.0, atol=1e-12)
        normal = body.normal(face, point)
        assert (dot(normal, ahead) > -1e-7).all()
        ahead = ahead - 2.0 * dot(normal, ahead) * normal
    # In a sphere every chord of a path has the same length.
    if isinstance(body, Sphere):
        next_, _ = body.exit(point, ahead)
        np.testing.assert_allclose(next_, distance, atol=1e-9)


@bodies
def test_exit_is_where_the_line_leaves(body: Curved) -> None:
    origin, ahead = _rays(body, 5000, 2)
    enters, leaves, _, exit_ = body.span(origin, ahead)
    met = enters < leaves
    half = 0.5 * (enters[met] + leaves[met])
    distance, face = body.exit(origin[:, met] + half * ahead[:, met], ahead[:, met])
    np.testing.assert_allclose(distance, leaves[met] - half, rtol=1e-10, atol=1e-12)
    np.testing.assert_array_equal(face, exit_[met])


def test_closed_forms_of_the_sphere() -> None:
    ball = sphere(10.0).body
    offset = np.array((0.0, 3.0, 4.999999, 5.0, 5.1))
    origin = np.stack((offset, np.zeros(5), np.full(5, -1000.0)))
    ahead = np.stack((np.zeros(5), np.zeros(5), np.full(5, 2.0)))
    enters, leaves, _, _ = ball.span(origin, ahead)
    half = np.sqrt(25.0 - offset[:3] ** 2)
    np.testing.assert_allclose(enters[:3], (1000.0 - half) / 2, rtol=1e-12)
    np.testing.assert_allclose((leaves - enters)[:3], half, rtol=1e-9)
    assert (enters[3:] >= leaves[3:]).all()  # a tangent and a miss
    assert ball.volume_mm3 == pytest.approx(pi / 6 * 1000)


def test_closed_forms_of_the_dome() -> None:
    """Vertical rays through an ellipsoid with semi-axes 6, 5 and 4 over its middle plane."""
    solid = cabochon((12.0, 10.0), 4.0)
    body = solid.body
    assert solid.labels == ("dome", "base")
    x, y = np.array((0.0, 2.0, -3.0, 5.9)), np.array((0.0, -1.0, 4.0, 0.0))
    below = np.stack((x, y, np.full(4, -50.0)))
    up = np.stack((np.zeros(4), np.zeros(4), np.ones(4)))
    enters, leaves, entry, exit_ = body.span(below, up)
    np.testing.assert_array_equal(entry, 1)
    np.testing.assert_array_equal(exit_, 0)
    heights = 4.0 * np.sqrt(1 - (x / 6) ** 2 - (y / 5) ** 2)
    np.testing.assert_allclose(leaves - enters, heights, rtol=1e-12)
    # The centre of mass of half an ellipsoid is 3/8 of its height over the base (Archimedes).
    np.testing.assert_allclose(enters - 50.0, -3 / 8 * 4.0, rtol=1e-12)
    normal = body.normal(exit_, below + leaves * up)
    gradient = np.stack((x / 36, y / 25, heights / 16))
    np.testing.assert_allclose(normal, gradient / np.linalg.norm(gradient, axis=0), atol=1e-13)
    np.testing.assert_array_equal(body.normal(entry, below + enters * up), -up)
    assert body.volume_mm3 == pytest.approx(2 / 3 * pi * 6 * 5 * 4)
    # The middle of the base, where the dome has no normal, has one as a base.
    np.testing.assert_array_equal(body.normal(np.array([1]), body.centre[:, None]), [[0.0], [0.0], [-1.0]])


def test_a_cap_is_a_piece_of_a_sphere() -> None:
    """Of radius (a² + h²)/2h, a the radius of the outline; its volume is πh²(3R − h)/3."""
    height, half = 3.0, 5.0
    radius = (half**2 + height**2) / (2 * height)
    body = cabochon((10.0, 10.0), height, profile="cap").body
    np.testing.assert_allclose(body.semi_axes_mm, radius, rtol=1e-14)
    volume = pi * height**2 * (3 * radius - height) / 3
    assert body.volume_mm3 == pytest.approx(volume, rel=1e-14)
    oval = cabochon((16.0, 10.0), height, profile="cap").body
    assert oval.volume_mm3 == pytest.approx(1.6 * volume, rel=1e-14)
    np.testing.assert_allclose(np.ptp(oval.vertices, axis=0), (16.0, 10.0, 3.0), rtol=1e-12)
    # At the rim the dome of a half ellipsoid stands upright, that of a cap leans.
    rim = np.array([[5.0], [0.0], [body.vertices[:, 2].min()]])
    lean = body.normal(np.array([0]), rim)[2, 0]
    assert lean == pytest.approx((radius - height) / radius, rel=1e-12)
    upright = cabochon((10.0, 10.0), height).body
    rim[2] = upright.vertices[:, 2].min()
    assert upright.normal(np.array([0]), rim)[2, 0] == pytest.approx(0.0, abs=1e-15)


@bodies
def test_against_triangles(body: Curved) -> None:
    """The drawn triangles are inscribed and closed; rays meet the same faces in nearly the same places."""
    corners, owners = body.triangles
    face_normals = np.zeros((body.face_count, 3))
    mesh = Mesh(body.vertices, corners, owners, face_normals, np.zeros(body.face_count))
    for face in range(body.face_count):
        used = np.unique(corners[owners == face])
        np.testing.assert_allclose(_miss(body, np.full(len(used), face), body.vertices[used].T), 0.0, atol=1e-13)
    assert 0.99 * body.volume_mm3 < mesh.volume_mm3 < body.volume_mm3
    edges = np.sort(np.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    rng = np.random.default_rng(3)
    origin = rng.normal(size=(3, 3000))
    origin *= 40.0 / np.linalg.norm(origin, axis=0)
    middle = _middle(body)
    aim = rng.uniform(-0.6, 0.6, (3, 3000))
    enters, leaves, entry, _ = body.span(middle + origin, aim - origin)
    distance, face = mesh.entry(middle + origin, aim - origin)
    lengths = np.linalg.norm(aim - origin, axis=0)
    assert (enters < leaves).all()
    assert (face == entry).mean() > 0.99  # the rim's chords
    same = face == entry
    gap = ((distance - enters) * lengths)[same]
    assert gap.max() < 0.2
    assert gap.min() > -1e-9
    np.testing.assert_array_equal(face_finder(body).first_face(middle + origin, aim - origin), entry)


@given(
    start=st.tuples(*[st.floats(-30, 30)] * 3),
    ahead=st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: max(map(abs, v)) > 1e-3),
    which=st.sampled_from(range(8)),
)
@settings(max_examples=200, deadline=None)
def test_one_ray_gives_the_same_bits_in_any_company(
    start: tuple[float, ...], ahead: tuple[float, ...], which: int
) -> None:
    body = _bodies()[which]
    origin, others = _rays(body, 37, 4)
    origin[:, 17], others[:, 17] = start, ahead
    together, alone = body.span(origin, others), body.span(origin[:, 17:18], others[:, 17:18])
    for many, one in zip(together, alone, strict=True):
        assert many[17] == one[0]
    assert not np.isnan(together[0]).any()


def test_finder_from_within_and_past() -> None:
    finder = face_finder(cabochon((12.0, 10.0), 5.0).body)
    assert isinstance(finder, ExactFinder)
    origin = np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 50.0, 50.0]])
    ahead = np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [1.0, -1.0, 1.0, -1.0]])
    assert finder.first_face(origin, ahead).tolist() == [0, 1, -1, 0]


def test_transformed_moves_points_and_rays_alike() -> None:
    body = cabochon((12.0, 10.0), 3.0, profile="cap").body
    origin, ahead = _rays(body, 500, 5)
    enters, leaves, entry, exit_ = body.span(origin, ahead)
    there = Solid(body, ("dome", "base"), (None, None)).transformed(TURN, SHIFT)
    moved = there.body.span(TURN @ origin + SHIFT[:, None], TURN @ ahead)
    met = enters < leaves
    np.testing.assert_array_equal(moved[0] < moved[1], met)
    np.testing.assert_allclose(moved[0][met], enters[met], atol=1e-12)
    np.testing.assert_allclose(moved[1][met], leaves[met], atol=1e-12)
    np.testing.assert_array_equal(moved[2][met], entry[met])
    np.testing.assert_array_equal(moved[3][met], exit_[met])
    np.testing.assert_allclose(there.body.vertices, body.vertices @ TURN.T + SHIFT, atol=1e-13)
    assert there.labels == ("dome", "base")
    assert sqrt(float(there.body.centre @ there.body.centre)) > 1.0


@pytest.mark.parametrize(
    ("make", "place", "told"),
    [
        (lambda: sphere(0.0, pointer="/s"), "/s/diameter_mm", "must be a length"),
        (lambda: cabochon((12.0, -1.0), 5.0, pointer="/s"), "/s/size_mm/1", "must be a length"),
        (lambda: cabochon((12.0, 10.0), float("nan"), pointer="/s"), "/s/height_mm", "must be a length"),
        (
            lambda: cabochon((12.0, 10.0), 5.1, profile="cap", pointer="/s"),
            "/s/height_mm",
            "half its smaller size, 5 mm",
        ),
    ],
)
def test_wrong_sizes(make: object, place: str, told: str) -> None:
    assert callable(make)
    with pytest.raises(InputError, match=told) as caught:
        make()
    assert [fault.pointer for fault in caught.value.faults] == [place]
