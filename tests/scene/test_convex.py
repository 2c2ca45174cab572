"""Overlaps and rooms against dense samples of the bodies."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crystal_core.geometry.boxes import box
from crystal_core.geometry.brilliant import brilliant
from crystal_core.geometry.cabochon import cabochon
from crystal_core.geometry.sphere import sphere
from crystal_core.scene.staged.convex import contains, corners, depth_in, highest, overlap, support
from crystal_core.scene.staged.stance import about

SHAPES = {
    "box": box((3.0, 2.0, 1.0)),
    "brilliant": brilliant(3.0),
    "ball": sphere(2.0),
    "cabochon": cabochon((3.0, 2.0), 1.2),
    "cap": cabochon((3.0, 2.0), 0.6, profile="cap"),
}
NAMES = sorted(SHAPES)
DIRECTIONS = st.tuples(*[st.integers(-20, 20).map(lambda n: n / 20)] * 3).filter(any)
ANGLES = st.integers(0, 3600).map(lambda n: n / 10)


def placed(name: str, axis: Any, angle: float, at: Any) -> Any:
    return SHAPES[name].transformed(about(axis, angle), np.asarray(at, np.float64)).body


def sample(body: Any, count: int = 4000) -> Any:
    """Return random points of a body."""
    rng = np.random.default_rng(5)
    spanned = corners(body)
    low, high = spanned.min(axis=0), spanned.max(axis=0)
    points = rng.uniform(low, high, (count, 3))
    return points[inside(body, points)]


def inside(body: Any, points: Any) -> Any:
    """Tell which points lie in a body: a line through them enters before and leaves after."""
    start = np.ascontiguousarray(points.T)
    enters, leaves, *_ = body.span(start, np.broadcast_to(np.array([[0.31], [0.23], [0.92]]), start.shape).copy())
    return (enters < 0) & (leaves > 0)


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(NAMES), st.sampled_from(NAMES), DIRECTIONS, DIRECTIONS, ANGLES, st.floats(0.2, 3.0))
def test_overlap_is_what_samples_say(
    one: str, other: str, axis: Any, towards: Any, angle: float, distance: float
) -> None:
    a = placed(one, axis, angle, (0, 0, 0))
    b = placed(other, towards, 2 * angle, distance * np.asarray(towards) / np.linalg.norm(towards))
    deep = overlap(a, b)
    assert deep == pytest.approx(overlap(b, a), rel=0.02, abs=1e-5)
    both = inside(b, sample(a)).any()
    if both:
        assert deep > 0
    if deep > 0.15:  # a ball of 0.15 mm inside both catches some of the points
        assert both
    # A plane between the bodies, where there is one among many, says that they do not overlap.
    normals = np.random.default_rng(1).normal(size=(300, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    if any(highest(a, n) < -highest(b, -n) for n in normals):
        assert deep < 0


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(NAMES), DIRECTIONS, ANGLES, DIRECTIONS)
def test_the_furthest_point_is_of_the_body_and_none_is_further(
    name: str, axis: Any, angle: float, direction: Any
) -> None:
    body = placed(name, axis, angle, (1, 2, 3))
    n = np.asarray(direction) / np.linalg.norm(direction)
    point = support(body, n)
    assert (sample(body) @ n).max() <= highest(body, n) + 1e-12
    assert (body.vertices @ n).max() <= highest(body, n) + 1e-9
    centre = body.vertices.mean(axis=0)
    assert contains(body, point + 1e-9 * (centre - point))
    assert not contains(body, point + 1e-6 * n)


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(NAMES), st.sampled_from(NAMES), DIRECTIONS, ANGLES, st.floats(0.0, 4.0))
def test_room_is_what_samples_say(host: str, inner: str, axis: Any, angle: float, distance: float) -> None:
    outer = SHAPES[host].transformed(np.eye(3), np.zeros(3)).body
    outer = _scaled(host, 3.0) if host != "box" else outer
    body = placed(inner, axis, angle, distance * 0.3 * np.asarray(axis) / np.linalg.norm(axis))
    room = depth_in(outer, body)
    points = np.concatenate((sample(body), body.vertices))
    held = inside(outer, points).all()
    if room > 1e-6:
        assert held
    if room < -0.05:
        assert not held


def _scaled(name: str, factor: float) -> Any:
    made: dict[str, Any] = {
        "ball": lambda: sphere(2.0 * factor),
        "brilliant": lambda: brilliant(3.0 * factor),
        "cabochon": lambda: cabochon((3.0 * factor, 2.0 * factor), 1.2 * factor),
        "cap": lambda: cabochon((3.0 * factor, 2.0 * factor), 0.6 * factor, profile="cap"),
    }
    return made[name]().body
