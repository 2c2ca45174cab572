"""Every dispersion formula against the equation that refractiveindex.info documents, in 40 digits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from minerals_db.one_term import OneTerm
from minerals_db.refractive_index import FRAUNHOFER_NM
from tests.minerals_db.published_curves import BACD11, GLASSES, PUBLISHED, STANDARD_AIR, Published, curve, mp

F, D, C = (FRAUNHOFER_NM[line] for line in "FDC")


@pytest.mark.parametrize("published", PUBLISHED, ids=lambda published: published.name)
def test_formula(published: Published) -> None:
    model = curve(published.data)
    wavelengths = np.geomspace(*model.range_nm, 23)
    expected = [float(published.index(mp.mpf(nm))) for nm in wavelengths.tolist()]
    np.testing.assert_allclose(model.index(wavelengths), expected, rtol=3e-15)


def test_every_numbered_formula_is_there() -> None:
    assert {published.formula for published in PUBLISHED} == set(range(1, 10))


# n_d as the maker states it, to the last digit
@pytest.mark.parametrize(
    ("glass", "n_d"),
    [
        (GLASSES[0], 1.51680),
        (GLASSES[1], 1.62004),
        (GLASSES[2], 1.80518),
        (GLASSES[3], 1.72825),
        (GLASSES[4], 1.78472),
        (GLASSES[5], 1.78472),
        (GLASSES[6], 1.85025),
        (BACD11, 1.56384),
    ],
    ids=lambda value: value.name if isinstance(value, Published) else "",
)
def test_index_that_the_maker_states(glass: Published, n_d: float) -> None:
    assert float(curve(glass.data).index(FRAUNHOFER_NM["d"])) == pytest.approx(n_d, abs=5.5e-6)


def test_standard_air() -> None:
    # B. Edlén, Metrologia 2, 71 (1966), his formula, from memory; Ciddor has 450 ppm of CO2, Edlén 300.
    wave_number_squared = 1.0 / 0.5893**2
    edlen = 1e-8 * (8342.13 + 2406030.0 / (130.0 - wave_number_squared) + 15997.0 / (38.9 - wave_number_squared))
    assert float(curve(STANDARD_AIR.data).index(D)) - 1.0 == pytest.approx(edlen, abs=5e-8)


def one_term(n_d: float, n_f_minus_n_c: float, **changes: Any) -> OneTerm:
    data = {"model": "one-term", "n_d": n_d, "n_f_minus_n_c": n_f_minus_n_c, "range_nm": [400, 700]}
    model = curve(data, **changes)
    assert isinstance(model, OneTerm)
    return model


# n_D, n_F - n_C; B and C as another program has them, which took F at 486.1 and C at 656.3 nm
ONE_TERM = [
    (1.583, 0.009, 1.464387, 0.009571),  # beryl o
    (1.638, 0.58 * 0.017, 1.636017, 0.009703),  # elbaite o
    (1.925, 0.022, 2.584907, 0.015495),  # zircon o
    (2.093, 0.035, 3.176124, 0.02101),  # cassiterite e
    (1.485, 0.009, 1.166524, 0.011151),  # sodalite
]


@pytest.mark.parametrize(("n_d", "n_f_minus_n_c", "strength", "resonance_um2"), ONE_TERM)
def test_one_term(n_d: float, n_f_minus_n_c: float, strength: float, resonance_um2: float) -> None:
    resonance = one_term(n_d, n_f_minus_n_c).resonance
    assert resonance.strength == pytest.approx(strength, abs=1e-5)
    assert resonance.resonance_um2 == pytest.approx(resonance_um2, abs=2e-6)


@given(n_d=st.floats(1.05, 4.0), share=st.floats(1e-4, 0.08))
def test_one_term_goes_through_its_numbers(n_d: float, share: float) -> None:
    n_f_minus_n_c = share * (n_d - 1.0)  # share: one over the Abbe number
    model = one_term(n_d, n_f_minus_n_c, range_nm=[480, 700])
    n_f, n, n_c = model.index([F, D, C])
    # A few bits of the indices: nothing better can be had of their difference.
    assert n == pytest.approx(n_d, rel=5e-16)
    assert n_f - n_c == pytest.approx(n_f_minus_n_c, abs=1e-15 * n_d)


def test_one_term_lies_near_a_true_formula() -> None:
    n_f, n_d, n_c = curve(GLASSES[0].data).index([F, D, C])
    fallback = one_term(float(n_d), float(n_f - n_c))
    wavelengths = np.linspace(400.0, 700.0, 31)
    off = np.abs(fallback.index(wavelengths) - curve(GLASSES[0].data).index(wavelengths))
    assert 1e-5 < off.max() < 7e-4


FAULTS: list[tuple[dict[str, Any], dict[str, Any], str]] = [
    # a slip of units: nm for µm in the coefficients, µm for nm in the range
    (PUBLISHED[0].data, {"terms": [{"strength": 1.1, "resonance_um": 92.0}]}, "are the coefficients for µm"),
    (PUBLISHED[0].data, {"range_nm": [0.21, 6.7]}, "range_nm in nm"),
    ({"model": "cauchy", "constant": 1.5, "powers": [{"coefficient": 4500.0, "power": -2}]}, {}, "1 to 5"),
    ({"model": "cauchy", "constant": -1.5}, {}, "from -1.5 to -1.5"),
    ({"model": "cauchy", "constant": 1.5, "powers": [{"coefficient": 1e308, "power": -9}]}, {}, "to inf"),
    ({"model": "cauchy", "constant": 1.5, "powers": [{"coefficient": 1.0, "power": 17}]}, {}, "less than or equal"),
    ({"model": "polynomial", "constant": 2.3, "powers": []}, {}, "at least 1"),
    ({"model": "polynomial", "constant": -2.3, "powers": [{"coefficient": 0.1, "power": 1}]}, {}, "no real index"),
    (STANDARD_AIR.data, {"range_nm": [60, 1690]}, "pole at 64.8179 nm"),
    (STANDARD_AIR.data, {"terms": []}, "at least 1"),
    (PUBLISHED[-4].data, {"range_nm": [160, 700]}, "pole at 167.332 nm"),  # Herzberger's, at every material
    (PUBLISHED[-3].data, {"range_nm": [200, 670]}, "pole at 265.588 nm"),
    (PUBLISHED[-3].data, {"constant": 1.2}, "no real index"),  # (n² - 1)/(n² + 2) reaches one only at n = ∞
    (PUBLISHED[-2].data, {"range_nm": [170, 700]}, "pole at 173.205 nm"),
    (
        PUBLISHED[-2].data,
        {"line": {"strength_um": 0.02, "centre_um": 1.52, "width_um2": -0.81}},
        "pole at 620 nm",
    ),
    ({"model": "one-term", "n_d": 1.0, "n_f_minus_n_c": 0.009}, {}, "greater than 1"),
    ({"model": "one-term", "n_d": 1583, "n_f_minus_n_c": 0.009}, {}, "less than or equal to 5"),
    ({"model": "one-term", "n_d": 1.583, "n_f_minus_n_c": 0.0}, {}, "greater than 0"),
    ({"model": "one-term", "n_d": 1.583, "n_f_minus_n_c": -0.009}, {}, "greater than 0"),
    ({"model": "one-term", "n_d": 1.583, "n_f_minus_n_c": 9.0}, {}, "less than 1"),
    ({"model": "one-term", "n_d": 1.583, "n_f_minus_n_c": 0.6}, {}, "pole at"),  # between 400 nm and F
    ({"model": "one-term", "n_d": 1.583, "n_f_minus_n_c": math.nan}, {}, "finite"),
    (
        {"model": "table", "wavelengths_nm": [400.0, 700.0], "indices": [16.0, 15.0], "range_nm": [400.0, 700.0]},
        {},
        "from 15 to 16 over range_nm",
    ),
]


@pytest.mark.parametrize(("data", "changes", "message"), FAULTS)
def test_faulty_formulas_are_refused(data: dict[str, Any], changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        curve({"range_nm": [400, 700]} | data, **changes)


@pytest.mark.parametrize("published", PUBLISHED, ids=lambda published: published.name)
def test_published_ranges_are_accepted_as_they_are(published: Published) -> None:
    model = curve(published.data)
    assert model.range_nm == tuple(published.data["range_nm"])
    assert curve(model.model_dump()) == model
