"""The round brilliant: proportions as published, 57 facets, meet points, symmetry."""

from collections import Counter
from dataclasses import replace
from itertools import pairwise
from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from crystal_core.errors import InputError
from crystal_core.geometry.brilliant import MODERN, PROPORTIONS, TOLKOWSKY, Proportions, brilliant
from crystal_core.geometry.facets import compass
from crystal_core.geometry.solid import Solid

CUTS = [*PROPORTIONS.values(), replace(MODERN, culet_percent=2.0), replace(MODERN, girdle_facets=96)]


def _kinds(solid: Solid) -> Counter[str]:
    return Counter(label.rstrip("0123456789 ") for label in solid.labels)


def _of(solid: Solid, kind: str) -> np.ndarray:
    return np.array([number for number, label in enumerate(solid.labels) if label.rstrip("0123456789 ") == kind])


def _meet_points(cut: Proportions, diameter: float) -> np.ndarray:
    """Return the corners of a brilliant with a girdle of 16 facets and no culet, from the drawing of the cut alone."""
    table, star, lower = cut.table_percent / 100, cut.star_percent / 100, cut.lower_half_percent / 100
    half = cut.girdle_percent / 100
    crown, pavilion = tan(radians(cut.crown_deg)), tan(radians(cut.pavilion_deg))
    points = [(0.0, 0.0, -half - pavilion)]
    for eighth in range(8):
        main, between = pi / 4 * eighth, pi / 4 * (eighth + 0.5)
        points.append((table * cos(main), table * sin(main), half + (1 - table) * crown))
        edge = table * cos(pi / 8)
        tip = edge + star * (1 - edge)
        points.append((tip * cos(between), tip * sin(between), half + (1 - tip * cos(pi / 8)) * crown))
        tip = 1 - lower
        points.append((tip * cos(between), tip * sin(between), -half - (1 - tip * cos(pi / 8)) * pavilion))
        for azimuth in (main, between):
            points += [(cos(azimuth), sin(azimuth), half), (cos(azimuth), sin(azimuth), -half)]
    return 0.5 * diameter * np.array(points)


def test_published_heights() -> None:
    """Tolkowsky's own: crown height 16.2 % and pavilion depth 43.1 % of the diameter; to two places 16.15 and 43.08."""
    assert TOLKOWSKY.crown_height_percent == pytest.approx(16.15, abs=0.01)
    assert TOLKOWSKY.pavilion_depth_percent == pytest.approx(43.08, abs=0.01)
    stone = brilliant(6.5)
    girdle = stone.body.vertices[[corner for face in _of(stone, "girdle") for corner in stone.body.faces[face]]]
    height = stone.body.vertices[:, 2]
    assert (height.max() - girdle[:, 2].max()) / 6.5 * 100 == pytest.approx(16.15, abs=0.01)
    assert (girdle[:, 2].min() - height.min()) / 6.5 * 100 == pytest.approx(43.08, abs=0.01)
    assert np.ptp(height) / 6.5 * 100 == pytest.approx(TOLKOWSKY.depth_percent, abs=1e-9)


@pytest.mark.parametrize("cut", CUTS, ids=["tolkowsky", "modern", "culet", "round"])
def test_facets_by_kind(cut: Proportions) -> None:
    kinds = _kinds(brilliant(2.0, cut))
    girdle, culet = kinds.pop("girdle"), kinds.pop("culet", 0)
    assert kinds == {"table": 1, "star": 8, "kite": 8, "upper half": 16, "lower half": 16, "main": 8}
    assert sum(kinds.values()) == 57
    assert culet == (cut.culet_percent > 0)
    assert girdle == (cut.girdle_facets or (16 if cut is TOLKOWSKY else 32))


@pytest.mark.parametrize("cut", CUTS, ids=["tolkowsky", "modern", "culet", "round"])
def test_closed_centred_and_of_its_hull(cut: Proportions) -> None:
    body = brilliant(6.5, cut).body
    edges = Counter(frozenset(ends) for ring in body.faces for ends in pairwise((*ring, ring[0])))
    assert set(edges.values()) == {2}
    assert len(body.vertices) - len(edges) + len(body.faces) == 2
    hull = ConvexHull(body.vertices)
    assert body.volume_mm3 == pytest.approx(hull.volume, rel=1e-12)
    assert len(hull.vertices) == len(body.vertices)
    for face, ring in enumerate(body.faces):
        np.testing.assert_allclose(body.vertices[list(ring)] @ body.normals[face], body.offsets[face], atol=1e-14)
    corners = body.vertices[hull.simplices]
    parts = np.abs(np.linalg.det(corners))
    np.testing.assert_allclose(parts @ corners.sum(axis=1) / (4 * parts.sum()), 0.0, atol=1e-12)


@pytest.mark.parametrize("cut", [TOLKOWSKY, replace(MODERN, girdle_facets=16)], ids=["tolkowsky", "modern"])
def test_corners_are_those_of_the_drawing(cut: Proportions) -> None:
    body = brilliant(6.5, cut).body
    drawn = _meet_points(cut, 6.5)
    assert len(body.vertices) == len(drawn) == 57
    drawn[:, 2] += body.vertices[:, 2].max() - drawn[:, 2].max()
    nearest = np.linalg.norm(body.vertices[:, None] - drawn[None], axis=2).min(axis=1)
    np.testing.assert_allclose(nearest, 0.0, atol=1e-13)
    assert body.volume_mm3 == pytest.approx(ConvexHull(drawn).volume, rel=1e-12)


@pytest.mark.parametrize(
    ("cut", "star", "upper", "lower"),
    [(TOLKOWSKY, 23.07, 40.578, 42.013), (MODERN, 22.52, 41.918, 41.887)],
    ids=["tolkowsky", "modern"],
)
def test_angles(cut: Proportions, star: float, upper: float, lower: float) -> None:
    """Crown and pavilion as asked for; the others follow from the meet points (a second calculation, to 0.001°)."""
    stone = brilliant(1.0, cut)
    expected = {"star": star, "kite": cut.crown_deg, "upper half": upper, "main": cut.pavilion_deg, "lower half": lower}
    for kind, angle in expected.items():
        tilts = np.rad2deg(np.arccos(np.abs(stone.body.normals[_of(stone, kind), 2])))
        np.testing.assert_allclose(tilts, angle, atol=1e-3)


@pytest.mark.parametrize("cut", CUTS, ids=["tolkowsky", "modern", "culet", "round"])
def test_eightfold_and_mirrored(cut: Proportions) -> None:
    body = brilliant(6.5, cut).body
    planes = np.column_stack((body.normals, body.offsets))
    turn = np.eye(4)
    turn[:2, :2] = np.array(((1.0, -1.0), (1.0, 1.0))) / sqrt(2)
    gaps = np.abs((planes @ turn.T)[:, None] - planes[None]).max(axis=2)
    np.testing.assert_allclose(gaps.min(axis=1), 0.0, atol=1e-14)
    # Across x, y and the diagonal to the last digit: no facet is favoured.
    given_planes = {tuple(plane + 0.0) for plane in planes}
    for mirrored in (planes * (-1, 1, 1, 1), planes * (1, -1, 1, 1), planes[:, [1, 0, 2, 3]]):
        assert {tuple(plane + 0.0) for plane in mirrored} == given_planes


def test_girdle() -> None:
    """Its corners lie on the circle; more facets than 16 make it rounder and, between kites, thinner."""
    for sides in (16, 32, 96):
        stone = brilliant(2.0, replace(MODERN, girdle_facets=sides))
        girdle = _of(stone, "girdle")
        corners = stone.body.vertices[sorted({corner for face in girdle for corner in stone.body.faces[face]})]
        np.testing.assert_allclose(np.hypot(corners[:, 0], corners[:, 1]), 1.0, atol=1e-14)
        heights = [np.ptp(stone.body.vertices[list(stone.body.faces[face]), 2]) for face in girdle]
        np.testing.assert_allclose(max(heights), 0.07, rtol=1e-12)
        azimuths = np.round(np.rad2deg(np.arctan2(corners[:, 1], corners[:, 0])) % 360, 6) % 360
        assert len(set(azimuths)) == sides
        thinnest = min(np.ptp(corners[azimuths == azimuth, 2]) for azimuth in set(azimuths))
        assert thinnest == pytest.approx(0.07) if sides == 16 else 0.03 < thinnest < 0.04
    knife = brilliant(2.0, replace(TOLKOWSKY, girdle_percent=0.0))
    assert "girdle" not in _kinds(knife)
    assert knife.body.face_count == 57


@given(
    table=st.floats(30, 80),
    crown=st.floats(10, 50),
    pavilion=st.floats(25, 55),
    girdle=st.floats(0.1, 10),
    star=st.floats(40, 80),
    lower=st.floats(40, 90),
)
@settings(max_examples=60, deadline=None)
def test_any_proportions_are_refused_by_name_or_close(
    table: float, crown: float, pavilion: float, girdle: float, star: float, lower: float
) -> None:
    cut = Proportions(table, crown, pavilion, girdle, star, lower)
    try:
        stone = brilliant(3.0, cut, pointer="/shape")
    except InputError as error:
        fault = error.faults[0]
    else:
        fault = None
    if fault is not None:
        assert fault.pointer == "/shape/star_percent"
        shortest = float(fault.message.split(" than ")[1].split()[0])
        assert star <= shortest * 1.01
        stone = brilliant(3.0, replace(cut, star_percent=shortest * 1.02))
    kinds = _kinds(stone)
    assert sum(kinds.values()) - kinds["girdle"] == 57
    edges = stone.body.edges
    assert len(stone.body.vertices) - len(edges) + stone.body.face_count == 2
    assert np.ptp(stone.body.vertices[:, 2]) == pytest.approx(0.03 * cut.depth_percent, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "place", "told"),
    [
        ({"table_percent": 100.0}, "/table_percent", "between 0 and 100"),
        ({"crown_deg": 0.0}, "/crown_deg", "between 0 and 90 degrees"),
        ({"pavilion_deg": float("nan")}, "/pavilion_deg", "between 0 and 90 degrees"),
        ({"girdle_percent": -1.0}, "/girdle_percent", "at least 0"),
        ({"culet_percent": float("inf")}, "/culet_percent", "at least 0"),
        ({"star_percent": 10.0}, "/star_percent", "more than 16.5 %"),
        ({"culet_percent": 30.0}, "/lower_half_percent", "less than 67.5 %"),
        ({"girdle_facets": 20}, "/girdle_facets", "a multiple of 16"),
        ({"girdle_facets": 32}, "/girdle_percent", "runs out between the kites"),
    ],
)
def test_wrong_proportions(change: dict[str, float], place: str, told: str) -> None:
    with pytest.raises(InputError, match=told) as caught:
        brilliant(6.5, replace(TOLKOWSKY, **change), pointer="/bodies/gem/shape/brilliant")
    assert [fault.pointer for fault in caught.value.faults] == [f"/bodies/gem/shape/brilliant{place}"]


@pytest.mark.parametrize("diameter", [0.0, -1.0, float("nan"), float("inf")])
def test_wrong_diameter(diameter: float) -> None:
    with pytest.raises(InputError, match="must be a length") as caught:
        brilliant(diameter, pointer="/shape")
    assert caught.value.faults[0].pointer == "/shape/diameter_mm"


@pytest.mark.parametrize("steps", [5, 8, 16, 32, 64])
def test_compass(steps: int) -> None:
    for step in range(-steps, 2 * steps):
        x, y = compass(step, steps)
        assert (x, y) == pytest.approx((cos(2 * pi * step / steps), sin(2 * pi * step / steps)), abs=1e-14)
        if steps % 4 == 0:
            assert compass(step + steps // 4, steps) == (-y, x)
            assert compass(-step, steps) == (x, -y)
