"""Group indices against derivatives in 40 digits and published slopes; Abbe numbers against the makers'."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from minerals_db.curve import OutsideRangeError
from tests.minerals_db.published_curves import BACD11, FUSED_SILICA, GLASSES, PUBLISHED, STANDARD_AIR, Published, curve

N_BK7 = GLASSES[0]
TABLE: dict[str, Any] = {
    "model": "table",
    "wavelengths_nm": [430.8, 486.13, 546.1, 589.3, 656.28, 700.0],
    "indices": [1.73149, 1.72440, 1.71903, 1.71610, 1.71260, 1.71100],
    "range_nm": [430.8, 700.0],
}
ONE_TERM: dict[str, Any] = {"model": "one-term", "n_d": 1.583, "n_f_minus_n_c": 0.009, "range_nm": [400, 700]}
EVERY_CURVE = [
    *(pytest.param(published.data, id=published.name) for published in PUBLISHED),
    pytest.param(TABLE, id="table"),
    pytest.param(ONE_TERM, id="one-term"),
]


@pytest.mark.parametrize("published", PUBLISHED, ids=lambda published: published.name)
def test_derivative(published: Published) -> None:
    model = curve(published.data)
    # The ends too: there the derivative is the formula's, which knows of no end.
    wavelengths = np.geomspace(*model.range_nm, 17)
    expected = [float(published.group_index(nm)) for nm in wavelengths.tolist()]
    np.testing.assert_allclose(model.group_index(wavelengths), expected, rtol=2e-14)


# dn/dλ, 1/µm, at 587.6 nm, as refractiveindex.info states it for the same coefficients
@pytest.mark.parametrize(
    ("published", "slope_per_um"), [(N_BK7, -0.0418), (FUSED_SILICA, -0.0352)], ids=["N-BK7", "fused silica"]
)
def test_published_slope(published: Published, slope_per_um: float) -> None:
    model = curve(published.data)
    slope = (model.index(587.6) - model.group_index(587.6)) / 0.5876
    assert float(slope) == pytest.approx(slope_per_um, abs=5e-5)


def test_group_index_of_fused_silica_is_least_where_pulses_spread_least() -> None:
    # I. H. Malitson, J. Opt. Soc. Am. 55, 1205 (1965): its dispersion λ d²n/dλ² is zero near 1.27 µm; from memory.
    wavelengths = np.arange(1200.0, 1350.0, 0.5)
    least = wavelengths[np.argmin(curve(FUSED_SILICA.data).group_index(wavelengths))]
    assert least == pytest.approx(1273.0, abs=3.0)


def test_one_term_has_the_derivative_of_its_formula() -> None:
    model = curve(ONE_TERM)
    step = 0.5
    nm = np.linspace(410.0, 690.0, 29)
    differences = (model.index(nm + step) - model.index(nm - step)) / (2.0 * step)
    np.testing.assert_allclose(model.group_index(nm), model.index(nm) - nm * differences, atol=1e-6)


def test_table_has_the_derivative_of_its_cubics() -> None:
    cubics = PchipInterpolator(TABLE["wavelengths_nm"], TABLE["indices"])
    nm = np.linspace(430.8, 700.0, 101)
    expected = cubics(nm) - nm * cubics.derivative()(nm)
    np.testing.assert_allclose(curve(TABLE).group_index(nm), expected, rtol=1e-14)


@pytest.mark.parametrize("data", EVERY_CURVE)
def test_bits_do_not_depend_on_the_batch(data: dict[str, Any]) -> None:
    model = curve(data)
    shortest, longest = model.range_nm
    wavelengths = np.random.default_rng(7).uniform(0.9 * shortest, 1.1 * longest, 1031)
    for ask in (model.index, model.group_index):
        whole = ask(wavelengths)
        for length in (1, 2, 3, 5, 17, 64):
            np.testing.assert_array_equal(ask(wavelengths[:length]), whole[:length])
            np.testing.assert_array_equal(ask(wavelengths[-length:]), whole[-length:])
        np.testing.assert_array_equal(ask(wavelengths[::3]), whole[::3])
        assert float(ask(float(wavelengths[7]))) == whole[7]


@pytest.mark.parametrize("data", EVERY_CURVE)
@pytest.mark.parametrize("shape", [(), (1,), (2, 3), (0,)])
def test_shapes(data: dict[str, Any], shape: tuple[int, ...]) -> None:
    group_index = curve(data).group_index(np.full(shape, 550.0))
    assert group_index.shape == shape
    assert group_index.dtype == np.float64


@pytest.mark.parametrize("data", EVERY_CURVE)
def test_nan_stays_nan(data: dict[str, Any]) -> None:
    for policy in ("clamp", "refuse"):
        model = curve(data, outside_range=policy)
        assert np.isnan(model.group_index(np.nan))
        assert np.isnan(model.index([np.nan, model.range_nm[0]])).tolist() == [True, False]


@pytest.mark.parametrize("data", EVERY_CURVE)
def test_outside_its_range_a_curve_keeps_its_end_values(data: dict[str, Any]) -> None:
    model = curve(data)
    shortest, longest = model.range_nm
    np.testing.assert_array_equal(model.group_index([1.0, shortest - 1e-9]), model.group_index(shortest))
    np.testing.assert_array_equal(model.group_index([longest + 1e-9, 1e9]), model.group_index(longest))


@pytest.mark.parametrize("data", EVERY_CURVE)
def test_a_curve_may_refuse_what_it_does_not_know(data: dict[str, Any]) -> None:
    model = curve(data, outside_range="refuse")
    clamping = curve(data)
    shortest, longest = model.range_nm
    inside = np.geomspace(shortest, longest, 5).clip(shortest, longest)
    for ask, clamped in ((model.index, clamping.index), (model.group_index, clamping.group_index)):
        np.testing.assert_array_equal(ask(inside), clamped(inside))
        for outside in (math.nextafter(shortest, 0.0), math.nextafter(longest, math.inf), math.inf):
            with pytest.raises(OutsideRangeError) as refusal:
                ask([shortest, outside, longest])
            assert refusal.value.wavelength_nm == outside
            assert refusal.value.range_nm == (shortest, longest)


def test_refusal_names_the_wavelength_and_the_range() -> None:
    with pytest.raises(ValueError, match=r"^the curve is known from 430\.8 to 700 nm, not at 430\.799999 nm$"):
        curve(TABLE, outside_range="refuse").index(430.799999)
    with pytest.raises(ValueError, match=r"^the curve is known from 430\.8 to 700 nm, not at 1e\+09 nm$"):
        curve(TABLE, outside_range="refuse").group_index([[500.0], [1e9]])


def test_refusals_travel_between_processes() -> None:
    refusal = OutsideRangeError(486.13, (500.0, 700.0), "Fraunhofer's line F")
    there = pickle.loads(pickle.dumps(refusal))
    assert (there.wavelength_nm, there.range_nm, there.name) == (486.13, (500.0, 700.0), "Fraunhofer's line F")
    assert str(there) == str(refusal)
    assert str(there) == "the curve is known from 500 to 700 nm, not at Fraunhofer's line F, 486.13 nm"


def test_policies_are_told_apart() -> None:
    with pytest.raises(ValueError, match="'clamp' or 'refuse'"):
        curve(TABLE, outside_range="extrapolate")


# V_d as the makers state it: the catalogues of `published_curves`, in refractiveindex.info (CC0)
MAKERS = [
    (GLASSES[0], 64.17),
    (GLASSES[1], 36.37),
    (GLASSES[2], 25.43),
    (GLASSES[3], 28.41),
    (GLASSES[4], 25.76),
    (GLASSES[5], 25.68),
    (GLASSES[6], 32.17),
    (BACD11, 60.83),
]


@pytest.mark.parametrize(("glass", "stated"), MAKERS, ids=lambda value: getattr(value, "name", ""))
def test_abbe_number_that_the_maker_states(glass: Published, stated: float) -> None:
    # Two digits are stated; our lines are rounded to 0.01 nm, which is 0.004 of the Abbe number.
    assert curve(glass.data).abbe_number("d") == pytest.approx(stated, abs=0.009)


def test_abbe_number_of_the_sodium_line() -> None:
    # by the definition, from the indices of N-BK7 (SCHOTT's data sheet: n_F 1.52238, n_D 1.51673, n_C 1.51432)
    model = curve(N_BK7.data)
    assert model.abbe_number() == pytest.approx(0.51673 / (1.52238 - 1.51432), abs=0.08)
    n_f, n_d, n_c = (float(n) for n in model.index([486.13, 589.3, 656.28]))
    assert model.abbe_number() == (n_d - 1.0) / (n_f - n_c)
    assert model.abbe_number() < model.abbe_number("d")


def test_abbe_number_of_a_table() -> None:
    assert curve(TABLE).abbe_number() == pytest.approx(0.71610 / (1.72440 - 1.71260), rel=1e-14)


def test_abbe_number_of_two_numbers() -> None:
    assert curve(ONE_TERM).abbe_number() == pytest.approx(0.583 / 0.009, rel=1e-12)


def test_abbe_number_without_dispersion() -> None:
    assert curve({"model": "cauchy", "constant": 1.5, "range_nm": [400, 700]}).abbe_number() == math.inf


@pytest.mark.parametrize("policy", ["clamp", "refuse"])
@pytest.mark.parametrize(("changes", "line"), [({"range_nm": [500, 700]}, "F"), ({"range_nm": [400, 650]}, "C")])
def test_abbe_number_needs_its_lines(policy: str, changes: dict[str, Any], line: str) -> None:
    model = curve(N_BK7.data, outside_range=policy, **changes)
    with pytest.raises(OutsideRangeError, match=rf"to \d+ nm, not at Fraunhofer's line {line}, \d+\.\d+ nm"):
        model.abbe_number()


def test_group_index_of_air_is_near_one() -> None:
    # Light travels near λ = 589 nm at c/1.00028: the pulse is the slower one.
    model = curve(STANDARD_AIR.data)
    assert 0.0 < float(model.group_index(589.3) - model.index(589.3)) < 1.2e-5
