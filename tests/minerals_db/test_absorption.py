"""Absorption: the curves against their closed forms, the law of concentrations, published figures, bad data."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from minerals_db.absorption import Absorption, AbsorptionCurve, AnyAbsorptionCurve

ADAPTER: TypeAdapter[AbsorptionCurve] = TypeAdapter(AnyAbsorptionCurve)
KNOWN = {"source": "somebody", "status": "fitted"}
RANGE = {"range_nm": [400.0, 800.0], **KNOWN}


def band(shape: str, centre: float = 18000.0, fwhm: float = 2000.0, peak: float = 1.5) -> dict[str, Any]:
    return {"shape": shape, "centre_per_cm": centre, "fwhm_per_cm": fwhm, "peak_per_mm": peak}


def bands(*terms: dict[str, Any], **changes: Any) -> dict[str, Any]:
    return {"model": "bands", "bands": list(terms), **RANGE} | changes


GAUSSIAN = bands(band("gaussian"))
LORENTZIAN = bands(band("lorentzian"))
EDGE = bands(edges=[{"edge_per_cm": 22000.0, "width_per_cm": 900.0, "plateau_per_mm": 5.0}])
TABLE = {
    "model": "table",
    "wavelengths_nm": [400.0, 500.0, 550.0, 600.0, 800.0],
    "coefficients_per_mm": [3.0, 0.5, 0.0, 0.0, 1.0],
    **RANGE,
}


def curve(data: dict[str, Any], **changes: Any) -> AbsorptionCurve:
    return ADAPTER.validate_python(data | changes)


def absorption(*parts: dict[str, Any], **fields: Any) -> Absorption:
    return Absorption.model_validate({"sample": "a stone", "parts": list(parts)} | fields)


def part(name: str, *causes: str, **axes: dict[str, Any]) -> dict[str, Any]:
    return {"name": name, "proportional_to": list(causes), "axes": axes}


def chromophore(weight_percent: float, formula: str = "FeO") -> dict[str, Any]:
    return {"formula": formula, "weight_percent": weight_percent, **KNOWN}


def at_wavenumber(model: AbsorptionCurve, per_cm: float) -> float:
    return float(model.coefficient_per_mm(1e7 / per_cm))


def test_gaussian_against_its_closed_form() -> None:
    # one standard deviation from the centre exp(−1/2) is left, and σ = fwhm/(2 √(2 ln 2))
    sigma = 2000.0 / (2.0 * math.sqrt(2.0 * math.log(2.0)))
    model = curve(GAUSSIAN)
    for sign in (-1.0, 1.0):
        assert at_wavenumber(model, 18000.0 + sign * sigma) == pytest.approx(1.5 * math.exp(-0.5), rel=1e-12)
        assert at_wavenumber(model, 18000.0 + sign * 2.0 * sigma) == pytest.approx(1.5 * math.exp(-2.0), rel=1e-12)


def test_lorentzian_against_its_closed_form() -> None:
    # one full width from the centre 1/(1 + 2²) is left: the wings of a Lorentzian are long
    assert at_wavenumber(curve(LORENTZIAN), 20000.0) == pytest.approx(1.5 / 5.0, rel=1e-12)


@pytest.mark.parametrize("data", [GAUSSIAN, LORENTZIAN])
def test_peak_and_half_width(data: dict[str, Any]) -> None:
    model = curve(data)
    assert at_wavenumber(model, 18000.0) == pytest.approx(1.5, rel=1e-14)
    for half in (17000.0, 19000.0):
        assert at_wavenumber(model, half) == pytest.approx(0.75, rel=1e-12)


def test_an_edge_falls_exponentially_and_is_level_above() -> None:
    model = curve(EDGE)
    assert at_wavenumber(model, 22000.0 - 900.0) == pytest.approx(5.0 / math.e, rel=1e-12)
    assert at_wavenumber(model, 22000.0 - 1800.0) == pytest.approx(5.0 / math.e**2, rel=1e-12)
    assert at_wavenumber(model, 22500.0) == at_wavenumber(model, 24000.0) == 5.0


def test_bands_and_edges_add_up() -> None:
    terms = [band("gaussian"), band("lorentzian", 24000.0, 3000.0, 0.7)]
    together = curve(bands(*terms, edges=EDGE["edges"]))
    alone = [curve(bands(term)) for term in terms] + [curve(EDGE)]
    wavelengths = np.linspace(400.0, 800.0, 41)
    added = sum(model.coefficient_per_mm(wavelengths) for model in alone)
    np.testing.assert_allclose(together.coefficient_per_mm(wavelengths), added, rtol=1e-14)


def test_table_goes_through_its_points_and_never_below_nothing() -> None:
    table = curve(TABLE)
    np.testing.assert_array_equal(table.coefficient_per_mm(TABLE["wavelengths_nm"]), TABLE["coefficients_per_mm"])
    between = table.coefficient_per_mm(np.linspace(400.0, 800.0, 4001))
    assert between.min() == 0.0
    np.testing.assert_array_equal(table.coefficient_per_mm(np.linspace(550.0, 600.0, 101)), 0.0)


@pytest.mark.parametrize("data", [GAUSSIAN, LORENTZIAN, EDGE, TABLE])
def test_outside_its_range_a_curve_keeps_its_end_values(data: dict[str, Any]) -> None:
    model = curve(data)
    ends = model.coefficient_per_mm([400.0, 800.0])
    np.testing.assert_array_equal(model.coefficient_per_mm([1.0, 1e9]), ends)
    assert np.isnan(model.coefficient_per_mm([500.0, math.nan])).tolist() == [False, True]


MANY = bands(*(band(shape, 14000.0 + 900.0 * i) for i, shape in enumerate(["gaussian", "lorentzian"] * 4)))


@pytest.mark.parametrize("data", [MANY, EDGE, TABLE])
def test_bits_do_not_depend_on_the_batch(data: dict[str, Any]) -> None:
    stone = absorption(part("all", o=data, e=GAUSSIAN))
    wavelengths = np.random.default_rng(7).uniform(350.0, 850.0, 1031)
    wavelengths[::7] = 500.0  # a point of the table among others
    whole = stone.per_mm("o", wavelengths)
    for ray in (0, 1, 7, 500, 1030):
        assert float(stone.per_mm("o", wavelengths[ray])) == whole[ray]
    for stride in (2, 3, 5):
        np.testing.assert_array_equal(stone.per_mm("o", wavelengths[::stride]), whole[::stride])
    np.testing.assert_array_equal(
        stone.per_mm("o", wavelengths[:1030].reshape(2, 515).T), whole[:1030].reshape(2, 515).T
    )
    there = pickle.loads(pickle.dumps(stone))
    np.testing.assert_array_equal(there.per_mm("o", wavelengths), whole)


IRON = absorption(
    part("Fe2+", "ferrous", o=GAUSSIAN, e=GAUSSIAN),
    part("Fe2+ beside Fe3+", "ferrous", "ferric", o=LORENTZIAN, e=EDGE),
    part("lattice", o=EDGE, e=EDGE),
    chromophores={"ferrous": chromophore(2.0), "ferric": chromophore(0.5, "Fe2O3")},
)


def test_each_part_grows_with_the_product_of_its_concentrations() -> None:
    wavelengths = np.linspace(400.0, 800.0, 17)
    ferrous, pairs, lattice = (curve(data).coefficient_per_mm(wavelengths) for data in (GAUSSIAN, LORENTZIAN, EDGE))

    def seen(**concentrations: float) -> np.ndarray:
        return IRON.per_mm("o", wavelengths, concentrations)

    np.testing.assert_allclose(seen(), ferrous + pairs + lattice, rtol=1e-14)
    np.testing.assert_array_equal(seen(), IRON.per_mm("o", wavelengths))
    np.testing.assert_array_equal(seen(), seen(ferrous=2.0, ferric=0.5))
    np.testing.assert_allclose(seen(ferrous=4.0), 2.0 * ferrous + 2.0 * pairs + lattice, rtol=1e-14)
    np.testing.assert_allclose(seen(ferric=0.25), ferrous + 0.5 * pairs + lattice, rtol=1e-14)
    np.testing.assert_allclose(seen(ferrous=6.0, ferric=2.0), 3.0 * ferrous + 12.0 * pairs + lattice, rtol=1e-14)
    np.testing.assert_allclose(seen(ferrous=0.0), lattice, rtol=1e-14)


def test_a_chromophore_named_twice_counts_squared() -> None:
    stone = absorption(part("pairs", "iron", "iron", n=GAUSSIAN), chromophores={"iron": chromophore(1.0)})
    assert stone.per_mm("n", 560.0, {"iron": 3.0}) == pytest.approx(9.0 * stone.per_mm("n", 560.0), rel=1e-14)


def test_axes_and_shapes() -> None:
    assert IRON.axes == ("o", "e")
    assert IRON.per_mm("e", 500.0).shape == ()
    assert IRON.per_mm("e", np.full((2, 3), 500.0)).shape == (2, 3)
    assert IRON.per_mm("e", np.empty(0)).shape == (0,)
    assert IRON.covers(400.0, 800.0)
    assert not IRON.covers(399.0, 700.0)


@pytest.mark.parametrize(
    ("axis", "concentrations", "told"),
    [
        ("gamma", {}, "no axis 'gamma'; the axes are o, e"),
        ("o", {"chromium": 1.0}, "no chromophore 'chromium'; those with a concentration: ferrous, ferric"),
        ("o", {"ferric": -0.1}, "the concentration of ferric must be a number from 0 up, not -0.1"),
        ("o", {"ferric": math.nan}, "must be a number from 0 up, not nan"),
        ("o", {"ferric": math.inf}, "must be a number from 0 up, not inf"),
    ],
)
def test_questions_that_have_no_answer(axis: str, concentrations: dict[str, float], told: str) -> None:
    with pytest.raises(ValueError, match=told):
        IRON.per_mm(axis, 500.0, concentrations)


def test_a_stone_without_chromophores_says_so() -> None:
    with pytest.raises(ValueError, match="those with a concentration: none"):
        absorption(part("all", n=TABLE)).per_mm("n", 500.0, {"iron": 1.0})


FAULTS = [
    (GAUSSIAN, {"bands": []}, "at least one band or edge"),
    (GAUSSIAN, {"bands": [band("gaussian", peak=-0.1)]}, "greater than or equal to 0"),
    (GAUSSIAN, {"bands": [band("gaussian", fwhm=0.0)]}, "greater than 0"),
    (GAUSSIAN, {"bands": [band("gaussian", centre=math.nan)]}, "finite"),
    (GAUSSIAN, {"bands": [band("voigt")]}, "'gaussian' or 'lorentzian'"),
    (GAUSSIAN, {"bands": [band("gaussian") | {"centre_nm": 500.0}]}, "not permitted"),
    (GAUSSIAN, {"range_nm": [800.0, 400.0]}, "must rise"),
    (GAUSSIAN, {"baseline_removed_per_mm": -0.1}, "greater than or equal to 0"),
    (EDGE, {"edges": [{"edge_per_cm": 22000.0, "width_per_cm": -1.0, "plateau_per_mm": 5.0}]}, "greater than 0"),
    (TABLE, {"coefficients_per_mm": [3.0, 0.5, -1e-9, 0.0, 1.0]}, "greater than or equal to 0"),
    (TABLE, {"coefficients_per_mm": [3.0, 0.5]}, "5 wavelengths_nm but 2 coefficients_per_mm"),
    (TABLE, {"range_nm": [400.0, 700.0]}, "the first and the last of wavelengths_nm"),
    (TABLE, {"model": "none"}, "does not match any of the expected tags"),
]


@pytest.mark.parametrize(("data", "change", "told"), FAULTS)
def test_wrong_curves_are_refused(data: dict[str, Any], change: dict[str, Any], told: str) -> None:
    with pytest.raises(ValidationError, match=told):
        curve(data, **change)


WRONG_STONES: list[tuple[list[dict[str, Any]], dict[str, Any], str]] = [
    ([], {}, "at least 1 item"),
    ([part("all")], {}, "at least 1 item"),
    ([part("all", omega=GAUSSIAN)], {}, "'n', 'o', 'e'"),
    ([part("one", o=GAUSSIAN, e=GAUSSIAN), part("two", o=GAUSSIAN)], {}, "same axes: o in 'two', but o, e in 'one'"),
    ([part("one", n=GAUSSIAN), part("one", n=EDGE)], {}, "no two parts have the same name"),
    ([part("one", "iron", n=GAUSSIAN)], {}, "proportional_to names iron; the chromophores are none"),
    (
        [part("one", "iron", n=GAUSSIAN)],
        {"chromophores": {"iron": chromophore(1.0), "titanium": chromophore(1.0)}},
        "no part is proportional_to titanium",
    ),
    ([part("one", "iron", n=GAUSSIAN)], {"chromophores": {"iron": chromophore(0.0)}}, "greater than 0"),
    ([part("one", "iron", n=GAUSSIAN)], {"chromophores": {"iron": chromophore(101.0)}}, "less than or equal to 100"),
    ([part("one", n=GAUSSIAN)], {"sample": ""}, "at least 1 character"),
]


@pytest.mark.parametrize(("parts", "fields", "told"), WRONG_STONES)
def test_wrong_stones_are_refused(parts: list[dict[str, Any]], fields: dict[str, Any], told: str) -> None:
    with pytest.raises(ValidationError, match=told):
        absorption(*parts, **fields)


def test_its_axes_may_differ_from_those_of_the_indicatrix() -> None:
    turned = {"parallel_to_b": "beta", "direction": "gamma", "from_axis": "c", "angle_deg": 30.0, **KNOWN}
    stone = absorption(part("all", alpha=GAUSSIAN, beta=GAUSSIAN, gamma=EDGE), frame=turned)
    assert stone.frame is not None
    assert stone.frame.model_dump(exclude_none=True) == turned
    fixed = {"alpha": "a", "beta": "b", "gamma": "c", **KNOWN}  # symmetry leaves an orthorhombic crystal no choice
    with pytest.raises(ValidationError):
        absorption(part("all", a=GAUSSIAN, b=GAUSSIAN, c=EDGE), frame=fixed)


AMOUNT = st.floats(0.0, 100.0)
WAVENUMBER = st.floats(1000.0, 50000.0)
WIDTH = st.floats(10.0, 20000.0)
BANDS = st.lists(
    st.builds(band, st.sampled_from(["gaussian", "lorentzian"]), WAVENUMBER, WIDTH, AMOUNT), min_size=1, max_size=6
)
EDGES = st.lists(
    st.fixed_dictionaries({"edge_per_cm": WAVENUMBER, "width_per_cm": WIDTH, "plateau_per_mm": AMOUNT}), max_size=3
)
TABLES = st.lists(st.tuples(st.floats(200.0, 3000.0), AMOUNT), min_size=2, max_size=12, unique_by=lambda row: row[0])


def tabulated(rows: list[tuple[float, float]]) -> dict[str, Any]:
    wavelengths, coefficients = zip(*sorted(rows), strict=True)
    ends = [wavelengths[0], wavelengths[-1]]
    return TABLE | {"wavelengths_nm": wavelengths, "coefficients_per_mm": coefficients, "range_nm": ends}


CURVES = st.one_of(
    st.builds(lambda terms, edges: bands(*terms, edges=edges), BANDS, EDGES), st.builds(tabulated, TABLES)
)


@given(CURVES, CURVES, st.floats(0.0, 50.0), st.lists(st.floats(1.0, 1e5), max_size=20))
def test_no_absorption_is_negative_and_all_is_linear(
    first: dict[str, Any], second: dict[str, Any], weight_percent: float, wavelengths: list[float]
) -> None:
    stone = absorption(
        part("first", "iron", n=first), part("second", n=second), chromophores={"iron": chromophore(2.0)}
    )
    found = stone.per_mm("n", wavelengths, {"iron": weight_percent})
    assert np.all(found >= 0.0)
    assert np.all(np.isfinite(found))
    expected = 0.5 * weight_percent * curve(first).coefficient_per_mm(wavelengths)
    expected += curve(second).coefficient_per_mm(wavelengths)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
