"""The step cut: level steps, a keel, cut corners that run out into its ends."""

from collections import Counter
from math import radians, tan

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from crystal_core.errors import InputError
from crystal_core.geometry.solid import Solid
from crystal_core.geometry.step_cut import StepProportions, step_cut

CASES = [
    ((9.0, 7.0), StepProportions()),
    ((7.0, 9.0), StepProportions(corner_percent=25.0)),
    ((8.0, 8.0), StepProportions(crown_deg=(40.0,), pavilion_deg=(55.0, 45.0))),
    ((12.0, 3.0), StepProportions(table_percent=40.0, crown_deg=(50.0, 40.0, 30.0, 20.0), girdle_percent=8.0)),
]


def _volume(size: tuple[float, float], cut: StepProportions) -> float:
    """Return the volume by Simpson's rule, exact for steps whose sections are quadratic in their height."""
    length, width = max(size), min(size)
    leg = cut.corner_percent / 100 * width

    def area(share: float) -> float:
        return (length - share * width) * width * (1 - share) - 2 * (leg * (1 - share)) ** 2

    total = area(0.0) * cut.girdle_percent / 100 * width
    for angles, inward in ((cut.crown_deg, 1 - cut.table_percent / 100), (cut.pavilion_deg, 1.0)):
        for step, angle in enumerate(angles):
            outer, inner = inward * step / len(angles), inward * (step + 1) / len(angles)
            height = (inner - outer) * width / 2 * tan(radians(angle))
            total += height / 6 * (area(outer) + 4 * area((outer + inner) / 2) + area(inner))
    return total


def _tilts(stone: Solid, part: str, side: str) -> list[float]:
    numbers = [n for n, label in enumerate(stone.labels) if label.startswith(part) and label.endswith(f" {side}")]
    return list(np.rad2deg(np.arccos(np.abs(stone.body.normals[numbers, 2]))))


@pytest.mark.parametrize(("size", "cut"), CASES)
def test_facets_closedness_and_volume(size: tuple[float, float], cut: StepProportions) -> None:
    stone = step_cut(size, cut)
    kinds = Counter(label.split()[0] for label in stone.labels)
    crown, pavilion = 8 * len(cut.crown_deg), 8 * len(cut.pavilion_deg)
    assert kinds == {"table": 1, "crown": crown, "girdle": 8, "pavilion": pavilion}
    body = stone.body
    assert len(body.vertices) - len(body.edges) + body.face_count == 2
    assert body.volume_mm3 == pytest.approx(_volume(size, cut), rel=1e-11)
    assert body.volume_mm3 == pytest.approx(ConvexHull(body.vertices).volume, rel=1e-11)
    np.testing.assert_allclose(np.ptp(body.vertices, axis=0)[:2], size, rtol=1e-13)
    assert np.ptp(body.vertices[:, 2]) == pytest.approx(cut.depth_percent / 100 * min(size), rel=1e-12)


@pytest.mark.parametrize(("size", "cut"), CASES)
def test_angles_keel_and_levels(size: tuple[float, float], cut: StepProportions) -> None:
    stone = step_cut(size, cut)
    for part, angles in (("crown", cut.crown_deg), ("pavilion", cut.pavilion_deg)):
        for side in ("+x", "-x", "+y", "-y"):
            np.testing.assert_allclose(_tilts(stone, part, side), angles, atol=1e-10)
        corners = np.array([_tilts(stone, part, side) for side in ("+x+y", "-x+y", "-x-y", "+x-y")])
        np.testing.assert_allclose(corners - corners[:1], 0.0, atol=1e-10)
        assert (corners < angles).all()
    body = stone.body
    keel = body.vertices[body.vertices[:, 2] < body.vertices[:, 2].min() + 1e-9]
    extent = np.ptp(keel, axis=0)
    along = int(size[1] > size[0])
    np.testing.assert_allclose(extent[along], abs(size[0] - size[1]), atol=1e-12)
    np.testing.assert_allclose(extent[1 - along], 0.0, atol=1e-12)
    # Steps have level edges: corners lie on as many levels as there are steps, girdle edges, table and keel.
    levels = np.unique(np.round(body.vertices[:, 2], 9))
    assert len(levels) == len(cut.crown_deg) + len(cut.pavilion_deg) + 2
    table = body.vertices[list(body.faces[stone.labels.index("table")])]
    assert np.ptp(table, axis=0)[:2].min() == pytest.approx(cut.table_percent / 100 * min(size), rel=1e-12)


def test_symmetric_to_the_last_digit() -> None:
    body = step_cut((9.0, 7.0)).body
    planes = np.column_stack((body.normals, body.offsets))
    kept = {tuple(plane + 0.0) for plane in planes}
    for mirrored in (planes * (-1, 1, 1, 1), planes * (1, -1, 1, 1)):
        assert {tuple(plane + 0.0) for plane in mirrored} == kept


def test_keel_along_the_longer_side() -> None:
    one, other = step_cut((9.0, 7.0)).body, step_cut((7.0, 9.0)).body
    planes = [np.column_stack((body.normals, body.offsets)) for body in (one, other)]
    gaps = np.abs(planes[0][:, None] - planes[1][None][:, :, [1, 0, 2, 3]]).max(axis=2)
    np.testing.assert_allclose(gaps.min(axis=1), 0.0, atol=1e-13)


@pytest.mark.parametrize(
    ("size", "cut", "place", "told"),
    [
        ((0.0, 7.0), StepProportions(), "/size_mm/0", "must be a length"),
        ((9.0, float("nan")), StepProportions(), "/size_mm/1", "must be a length"),
        ((9.0, 7.0), StepProportions(table_percent=0.0), "/table_percent", "between 0 and 100"),
        ((9.0, 7.0), StepProportions(girdle_percent=0.0), "/girdle_percent", "between 0 and 100"),
        ((9.0, 7.0), StepProportions(corner_percent=50.0), "/corner_percent", "between 0 and 50"),
        ((9.0, 7.0), StepProportions(crown_deg=()), "/crown_deg", "1 to 8 steps"),
        ((9.0, 7.0), StepProportions(crown_deg=(95.0, 30.0)), "/crown_deg/0", "between 0 and 90"),
        ((9.0, 7.0), StepProportions(pavilion_deg=(45.0, 40.0, 42.0)), "/pavilion_deg/2", "less than 40°"),
    ],
)
def test_wrong_cuts(size: tuple[float, float], cut: StepProportions, place: str, told: str) -> None:
    with pytest.raises(InputError, match=told) as caught:
        step_cut(size, cut, pointer="/shape")
    assert [fault.pointer for fault in caught.value.faults] == [f"/shape{place}"]
