"""What all dispersion models have in common: ranges, batches, tables, cost."""

from __future__ import annotations

import math
import pickle
import subprocess
import sys
import time
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

import minerals_db
from minerals_db.dispersion import AnyDispersion, Dispersion

ADAPTER: TypeAdapter[Dispersion] = TypeAdapter(AnyDispersion)
KNOWN = {"source": "somebody", "status": "published"}
SELLMEIER_1 = {
    "model": "sellmeier-1",
    "offset": 0.2,
    "terms": [{"strength": 1.1, "resonance_um": 0.1}, {"strength": 0.9, "resonance_um": 12.0}],
    "range_nm": [300, 2000],
    **KNOWN,
}
SELLMEIER_2 = {
    "model": "sellmeier-2",
    "offset": 0.2,
    "terms": [{"strength": 1.1, "resonance_um2": 0.01}, {"strength": 0.9, "resonance_um2": 144.0}],
    "range_nm": [300, 2000],
    **KNOWN,
}
POWERS = {
    "model": "resonances-and-powers",
    "constant": 2.3,
    "resonances": [
        {"strength": 0.02, "power": 0, "resonance_um2": 0.016},
        {"strength": 0.3, "power": 2, "resonance_um": 0.1},
    ],
    "powers": [{"coefficient": -0.01, "power": 2}, {"coefficient": 0.003, "power": -4}],
    "range_nm": [300, 2000],
    **KNOWN,
}
TABLE = {
    "model": "table",
    "wavelengths_nm": [400.0, 500.0, 600.0, 700.0],
    "indices": [1.60, 1.55, 1.54, 1.535],
    "range_nm": [400.0, 700.0],
    **KNOWN,
}
EVERY_MODEL = [SELLMEIER_1, SELLMEIER_2, POWERS, TABLE]


def curve(data: dict[str, Any], **changes: Any) -> Dispersion:
    return ADAPTER.validate_python(data | changes)


def test_sellmeier_1_is_formula_1() -> None:
    # n² - 1 = 0.2 + 1.1 λ²/(λ² - 0.1²) + 0.9 λ²/(λ² - 12²) at 0.5 µm, by hand
    squared = 1.0 + 0.2 + 1.1 * 0.25 / 0.24 + 0.9 * 0.25 / (0.25 - 144.0)
    assert float(curve(SELLMEIER_1).index(500.0)) == pytest.approx(math.sqrt(squared), rel=1e-15)


def test_sellmeier_2_takes_the_resonance_unsquared() -> None:
    wavelengths = np.linspace(300.0, 2000.0, 101)
    np.testing.assert_allclose(curve(SELLMEIER_2).index(wavelengths), curve(SELLMEIER_1).index(wavelengths), rtol=1e-14)


def test_resonances_and_powers_is_formula_4() -> None:
    # by hand at 0.5 µm: λ² = 0.25, λ⁻⁴ = 16
    squared = 2.3 + 0.02 / (0.25 - 0.016) + 0.3 * 0.25 / (0.25 - 0.01) - 0.01 * 0.25 + 0.003 * 16.0
    assert float(curve(POWERS).index(500.0)) == pytest.approx(math.sqrt(squared), rel=1e-15)


def test_table_goes_through_its_points_and_never_beyond_them() -> None:
    table = curve(TABLE)
    np.testing.assert_allclose(table.index(TABLE["wavelengths_nm"]), TABLE["indices"], rtol=1e-15)
    between = table.index(np.linspace(400.0, 700.0, 3001))
    assert np.all(np.diff(between) < 0.0)
    # A straight line would miss what the neighbours say about the bend.
    assert float(table.index(550.0)) < 0.5 * (1.55 + 1.54)


@pytest.mark.parametrize("data", EVERY_MODEL)
def test_outside_its_range_a_curve_keeps_its_end_values(data: dict[str, Any]) -> None:
    model = curve(data)
    shortest, longest = model.range_nm
    np.testing.assert_array_equal(model.index([1.0, shortest - 1e-9]), model.index(shortest))
    np.testing.assert_array_equal(model.index([longest + 1e-9, 1e9]), model.index(longest))


@pytest.mark.parametrize("data", EVERY_MODEL)
@pytest.mark.parametrize("shape", [(), (1,), (2, 3), (0,)])
def test_shapes(data: dict[str, Any], shape: tuple[int, ...]) -> None:
    index = curve(data).index(np.full(shape, 500.0))
    assert index.shape == shape
    assert index.dtype == np.float64


@pytest.mark.parametrize("data", EVERY_MODEL)
def test_bits_do_not_depend_on_the_batch(data: dict[str, Any]) -> None:
    model = curve(data)
    wavelengths = np.random.default_rng(5).uniform(350.0, 800.0, 1031)
    whole = model.index(wavelengths)
    for length in (1, 2, 3, 5, 17, 64):
        np.testing.assert_array_equal(model.index(wavelengths[:length]), whole[:length])
    assert float(model.index(float(wavelengths[7]))) == whole[7]


@pytest.mark.parametrize("data", EVERY_MODEL)
def test_nan_stays_nan(data: dict[str, Any]) -> None:
    assert np.isnan(curve(data).index(np.nan))


@pytest.mark.parametrize("data", EVERY_MODEL)
def test_curves_travel_between_processes(data: dict[str, Any]) -> None:
    model = curve(data)
    before = model.index(500.0)
    there = pickle.loads(pickle.dumps(model))
    assert there == model
    assert there.index(500.0) == before


@pytest.mark.parametrize("data", EVERY_MODEL)
def test_curves_are_frozen(data: dict[str, Any]) -> None:
    with pytest.raises(ValidationError, match="frozen"):
        curve(data).range_nm = (1.0, 2.0)


def test_covers() -> None:
    model = curve(TABLE)
    assert model.covers(400.0, 700.0)
    assert model.covers(450.0, 500.0)
    assert not model.covers(399.9, 700.0)
    assert not model.covers(400.0, 700.1)


def test_tables_need_no_scipy() -> None:
    # Every command that loads the minerals would pay the 0.3 s of its import.
    program = """
import sys
from pydantic import TypeAdapter
from minerals_db.dispersion import AnyDispersion
table = TypeAdapter(AnyDispersion).validate_python({
    "model": "table", "wavelengths_nm": [486.13, 589.3, 656.28], "indices": [1.7244, 1.7161, 1.7126],
    "range_nm": [486.13, 656.28], "source": "somebody", "status": "published",
})
assert float(table.index(589.3)) == 1.7161
assert abs(table.abbe_number() - 0.7161 / 0.0118) < 1e-9
print("scipy" in sys.modules)
table.group_index(589.3)
print("scipy" in sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]


@pytest.mark.parametrize("data", EVERY_MODEL)
def test_checking_a_curve_is_cheap(data: dict[str, Any]) -> None:
    curve(data)
    spent = []
    for _ in range(20):  # the least of many: others may run on this machine
        start = time.perf_counter()
        for _ in range(20):
            curve(data)
        spent.append((time.perf_counter() - start) / 20)
    assert min(spent) < 2e-4  # 200 curves load in 40 ms; 25 µs each where this was written


@given(st.floats(204.0, 2172.0))
def test_no_index_below_one(nm: float) -> None:
    for axis in ("o", "e"):
        assert float(minerals_db.mineral("calcite").dispersion[axis].index(nm)) > 1.0


FAULTS = [
    (SELLMEIER_1, {"range_nm": [700, 400]}, "must rise"),
    (SELLMEIER_1, {"range_nm": [400, 400]}, "must rise"),
    (SELLMEIER_1, {"range_nm": [-400, 700]}, "greater than 0"),
    (SELLMEIER_1, {"range_nm": [50, 700]}, "pole at 100 nm"),
    (SELLMEIER_1, {"terms": []}, "at least 1"),
    (SELLMEIER_1, {"offset": math.nan}, "finite"),
    (SELLMEIER_1, {"offset": "0.2"}, "valid number"),
    (SELLMEIER_1, {"offset": True}, "valid number"),
    (SELLMEIER_1, {"offset": -9.0}, "no real index"),
    (SELLMEIER_1, {"status": "guessed"}, "'published'"),
    (SELLMEIER_1, {"range_um": [0.3, 2.0]}, "Extra inputs"),
    (SELLMEIER_2, {"terms": [{"strength": 1.1, "resonance_um": 0.1}]}, "Field required"),
    (SELLMEIER_2, {"range_nm": [100, 700]}, "pole at 100 nm"),
    (POWERS, {"resonances": [{"strength": 1.0, "power": 0}]}, "either"),
    (
        POWERS,
        {"resonances": [{"strength": 1.0, "power": 0, "resonance_um": 0.1, "resonance_um2": 0.01}]},
        "either",
    ),
    (POWERS, {"powers": [{"coefficient": 1.0, "power": "3"}]}, "valid number"),
    (POWERS, {"powers": [{"coefficient": 1.0, "power": 400}]}, "less than or equal to 16"),
    (POWERS, {"range_nm": [100, 700]}, "pole at"),
    (TABLE, {"indices": [1.6, 1.55, 1.54]}, "4 wavelengths_nm but 3 indices"),
    (TABLE, {"wavelengths_nm": [400.0, 600.0, 500.0, 700.0]}, "must rise"),
    (TABLE, {"range_nm": [380.0, 700.0]}, "first and the last"),
    (TABLE, {"model": "magic"}, "sellmeier-1"),
]


@pytest.mark.parametrize(("data", "changes", "message"), FAULTS)
def test_faulty_curves_are_refused(data: dict[str, Any], changes: dict[str, Any], message: str) -> None:
    curve(data)  # without the change it is sound
    with pytest.raises(ValidationError, match=message):
        curve(data, **changes)
