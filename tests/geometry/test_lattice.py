"""Lattices: bases, directions, and interfacial angles against published ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import minerals_db
from crystal_core.errors import InputError
from crystal_core.geometry.lattice import Lattice, direct_basis, face_normal
from crystal_core.scene.specimen import lattice_of
from tests.geometry.published_angles import PUBLISHED, RECALLED

TOLERANCE_DEG = 0.15

ANGLES = st.floats(50.0, 130.0)
LENGTHS = st.floats(1.0, 30.0)
INDICES = st.tuples(*[st.integers(-9, 9)] * 3).filter(any)


@st.composite
def lattices(draw: st.DrawFn) -> Lattice:
    angles = draw(st.tuples(ANGLES, ANGLES, ANGLES).filter(lambda a: sum(a) < 355 and 2 * max(a) < sum(a) - 5))
    return Lattice(draw(st.tuples(LENGTHS, LENGTHS, LENGTHS)), angles)


@pytest.mark.parametrize(
    ("mineral", "one", "other", "published", "source"), [*PUBLISHED, *RECALLED], ids=lambda value: str(value)[:24]
)
def test_interfacial_angles(
    mineral: str, one: tuple[int, int, int], other: tuple[int, int, int], published: float, source: str
) -> None:
    computed = lattice_of(minerals_db.mineral(mineral)).interfacial_angle_deg(one, other)
    assert computed == pytest.approx(published, abs=TOLERANCE_DEG), source


def test_enough_minerals_are_published() -> None:
    assert len({mineral for mineral, *_ in PUBLISHED}) >= 15


@settings(deadline=None, max_examples=60)
@given(lattices())
def test_bases(lattice: Lattice) -> None:
    a, b, c = lattice.direct
    np.testing.assert_allclose(np.linalg.norm(lattice.direct, axis=1), lattice.lengths, rtol=1e-12)
    cosines = [b @ c / np.linalg.norm(b) / np.linalg.norm(c), c @ a / np.linalg.norm(c) / np.linalg.norm(a)]
    cosines.append(a @ b / np.linalg.norm(a) / np.linalg.norm(b))
    np.testing.assert_allclose(cosines, np.cos(np.deg2rad(lattice.angles_deg)), atol=1e-12)
    np.testing.assert_allclose(lattice.direct @ lattice.reciprocal.T, np.eye(3), atol=1e-10)
    # x along a, z along c*, b in the half-plane of +y: y = z × x.
    np.testing.assert_allclose(lattice.direction((1, 0, 0)), (1, 0, 0), atol=1e-12)
    np.testing.assert_allclose(lattice.face_normal((0, 0, 1)), (0, 0, 1), atol=1e-12)
    assert b[1] > 0
    assert lattice.volume > 0
    np.testing.assert_allclose(lattice.metric, lattice.direct @ lattice.direct.T)
    np.testing.assert_allclose(lattice.direct, direct_basis(lattice.lengths, lattice.angles_deg))


@settings(deadline=None, max_examples=60)
@given(lattices(), INDICES, INDICES)
def test_faces_and_zones(lattice: Lattice, one: tuple[int, int, int], other: tuple[int, int, int]) -> None:
    np.testing.assert_allclose(lattice.face_normal(one), face_normal(lattice.direct, one), atol=1e-10)
    # A face (hkl) meets the axes at a/h, b/k, c/l: all three points lie in the plane at d from the origin.
    spacing = lattice.d_spacing(one)
    for index, axis in zip(one, lattice.direct, strict=True):
        if index:
            assert axis / index @ lattice.face_normal(one) == pytest.approx(spacing, rel=1e-9)
    if not np.cross(one, other).any():
        with pytest.raises(InputError, match="parallel"):
            lattice.zone_axis(one, other)
        return
    zone = lattice.zone_axis(one, other)
    assert np.gcd.reduce(zone) == 1
    assert np.dot(zone, one) == np.dot(zone, other) == 0
    edge = np.cross(lattice.face_normal(one), lattice.face_normal(other))
    np.testing.assert_allclose(lattice.direction(zone), edge / np.linalg.norm(edge), atol=1e-8)
    angle = lattice.interfacial_angle_deg(one, other)
    assert angle == pytest.approx(lattice.interfacial_angle_deg(other, one))
    assert np.cos(np.deg2rad(angle)) == pytest.approx(lattice.face_normal(one) @ lattice.face_normal(other), abs=1e-9)


def test_frames_of_the_systems() -> None:
    gypsum = lattice_of(minerals_db.mineral("gypsum"))
    np.testing.assert_allclose(gypsum.direction((0, 1, 0)), (0, 1, 0), atol=1e-15)  # y along b
    assert gypsum.direct[2, 0] < 0  # β is obtuse: c leans away from a
    quartz = lattice_of(minerals_db.mineral("quartz"))
    np.testing.assert_allclose(quartz.direction((0, 0, 1)), (0, 0, 1), atol=1e-15)
    azimuth = np.rad2deg(np.arctan2(*quartz.face_normal((1, 0, 0))[[1, 0]]))
    assert azimuth == pytest.approx(30.0)  # a* between a1 and −(the third axis)
    assert quartz.d_spacing((1, 0, 1)) == pytest.approx(3.344, abs=1e-3)  # the strongest line of quartz, 3.343 Å


@pytest.mark.parametrize(
    ("lengths", "angles"),
    [
        ((0.0, 1.0, 1.0), (90.0, 90.0, 90.0)),
        ((1.0, 1.0, float("nan")), (90.0, 90.0, 90.0)),
        ((1.0, 1.0, 1.0), (120.0, 120.0, 120.0)),
        ((1.0, 1.0, 1.0), (30.0, 30.0, 100.0)),
    ],
)
def test_impossible_cells(lengths: tuple[float, float, float], angles: tuple[float, float, float]) -> None:
    with pytest.raises(InputError, match="/cell"):
        Lattice(lengths, angles)


@pytest.mark.parametrize("indices", [(0, 0, 0), (1, 0), (1, 0, -1, 1)])
def test_no_indices(indices: tuple[int, ...]) -> None:
    with pytest.raises(InputError, match="three indices"):
        Lattice((1.0, 1.0, 1.0), (90.0, 90.0, 90.0)).face_normal(indices)
