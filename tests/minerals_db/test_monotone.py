"""Monotone cubics against SciPy's PCHIP."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from minerals_db.monotone import MonotoneCubics

Points = st.lists(st.tuples(st.floats(0.5, 50.0), st.floats(-3.0, 3.0, allow_subnormal=False)), min_size=2, max_size=12)


def _points(steps: list[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    return 300.0 + np.cumsum([step for step, _ in steps]), np.array([y if abs(y) > 1e-6 else 0.0 for _, y in steps])


@given(Points)
def test_as_scipy(steps: list[tuple[float, float]]) -> None:
    x, y = _points(steps)
    ours, theirs = MonotoneCubics(x, y), PchipInterpolator(x, y)
    at = np.concatenate((x, np.linspace(x[0], x[-1], 101)))
    np.testing.assert_allclose(ours.value(at), theirs(at), rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(ours.slope(at[x.size :]), theirs(at[x.size :], 1), rtol=1e-8, atol=1e-8)


@given(Points)
def test_points_are_kept_exactly_and_nothing_swings_beyond_them(steps: list[tuple[float, float]]) -> None:
    x, y = _points(steps)
    cubics = MonotoneCubics(x, y)
    np.testing.assert_array_equal(cubics.value(x), y)
    for left, right, low, high in zip(x, x[1:], y, y[1:], strict=False):
        between = cubics.value(np.linspace(left, right, 33))
        assert between.min() >= min(low, high) - 1e-12
        assert between.max() <= max(low, high) + 1e-12


def test_nan_of_nan_and_any_shape() -> None:
    cubics = MonotoneCubics(np.array([1.0, 2.0, 4.0]), np.array([1.0, 3.0, 2.0]))
    found = cubics.value(np.array([[1.5, np.nan], [4.0, 1.0]]))
    assert np.isnan(found[0, 1])
    assert np.isnan(cubics.slope(np.array(np.nan)))
    np.testing.assert_array_equal(found[1], (2.0, 1.0))
    assert cubics.value(np.array(2.0)) == pytest.approx(3.0)
