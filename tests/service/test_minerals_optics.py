"""A mineral's entry over HTTP, and its optics at any wavelength."""

from __future__ import annotations

import csv
import io
import re
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

import minerals_db
from crystal_core.errors import InputError
from minerals_db import Mineral
from minerals_db.indicatrix import optic_sign, two_v_deg
from service.minerals.optics import mineral_optics
from service.minerals.wavelengths import MAX_WAVELENGTHS, read_wavelengths


def test_a_mineral_comes_whole_with_sources_and_indices(client: TestClient) -> None:
    calcite = client.get("/v1/minerals/calcite").json()
    assert set(calcite["dispersion"]) == {"o", "e"}
    assert calcite["dispersion"]["o"]["source"] in calcite["sources"]
    assert calcite["indices"]["wavelength_nm"] == 589.3
    # Every handbook: 1.658 and 1.486 at the D line.
    assert calcite["indices"]["o"] == pytest.approx(1.658, abs=5e-4)
    assert calcite["indices"]["e"] == pytest.approx(1.486, abs=5e-4)
    assert calcite["birefringence"] == pytest.approx(0.172, abs=5e-4)
    assert (calcite["two_v_deg"], calcite["origin"]) == (None, "built-in")
    assert calcite["quality"]["dispersion"] == "published"
    assert calcite["links"] == {
        "self": "/v1/minerals/calcite",
        "optics": "/v1/minerals/calcite/optics",
        "habits": "/v1/minerals/calcite/habits",
    }


def test_a_biaxial_mineral_is_told_by_its_axes(client: TestClient) -> None:
    topaz = client.get("/v1/minerals/topaz").json()
    assert (topaz["optical_class"], topaz["optic_sign"]) == ("biaxial", "positive")
    assert {axis: topaz["indices"][axis] for axis in "abc"} == {"a": 1.61161, "b": 1.61375, "c": 1.62109}
    assert topaz["two_v_deg"] == pytest.approx(57, abs=0.5)
    assert topaz["orientation"]["gamma"] == "c"
    assert topaz["orientation"]["source"] in topaz["sources"]


def test_an_active_mineral_tells_its_rotation(client: TestClient) -> None:
    rotation = client.get("/v1/minerals/quartz").json()["optical_rotation"]
    assert rotation["hand"]["sense"] == "right"
    assert client.get("/v1/minerals/calcite").json()["optical_rotation"] is None


def test_every_entry_is_told(client: TestClient) -> None:
    for mineral_id in minerals_db.minerals():
        assert client.get(f"/v1/minerals/{mineral_id}").json()["id"] == mineral_id
        assert len(client.get(f"/v1/minerals/{mineral_id}/optics").json()["optics"]) == 3


def test_optics_are_those_of_the_curves(client: TestClient) -> None:
    answer = client.get("/v1/minerals/topaz/optics?wavelengths_nm=430,500:700:100,589.3").json()
    topaz = minerals_db.mineral("topaz")
    rows = answer["optics"]
    assert [row["wavelength_nm"] for row in rows] == [430, 500, 600, 700, 589.3]
    for row in rows:
        wavelength = row["wavelength_nm"]
        n = {axis: float(curve.index(wavelength)) for axis, curve in topaz.dispersion.items()}
        assert row["indices"] == n
        assert row["group_indices"] == {
            a: float(curve.group_index(wavelength)) for a, curve in topaz.dispersion.items()
        }
        assert all(row["group_indices"][axis] > n[axis] for axis in n)  # normal dispersion
        assert row["birefringence"] == max(n.values()) - min(n.values())
        assert row["two_v_deg"] == float(two_v_deg(topaz, wavelength))
        assert row["optic_sign"] == optic_sign(topaz, wavelength) == "positive"
        assert row["absorption_per_mm"] is None
        assert row["clamped"] is (wavelength > 686.72)
    assert answer["links"]["mineral"] == "/v1/minerals/topaz"
    assert client.get(answer["links"]["self"]).json() == answer


def test_the_lines_of_f_d_c_are_told_unless_others_are_asked_for(client: TestClient) -> None:
    for mineral_id, signs in (("calcite", {"negative"}), ("quartz", {"positive"}), ("fluorite", {None})):
        rows = client.get(f"/v1/minerals/{mineral_id}/optics").json()["optics"]
        assert [row["wavelength_nm"] for row in rows] == [486.1, 589.3, 656.3]
        assert {row["optic_sign"] for row in rows} == signs
        assert {row["two_v_deg"] for row in rows} == {None}


def coloured(status: str = "fitted") -> Mineral:
    """Return a mineral that absorbs 1 and 2 mm⁻¹ by chromium, and 0.5 mm⁻¹ along o besides."""

    def flat(value: float) -> dict[str, Any]:
        return {
            "model": "table", "wavelengths_nm": [400, 700], "coefficients_per_mm": [value, value],
            "range_nm": [400, 700], "source": "here", "status": status,
        }  # fmt: skip

    chromium = {"formula": "Cr2O3", "weight_percent": 0.05, "source": "here", "status": "published"}
    fields = minerals_db.mineral("corundum").model_dump(mode="json", exclude_unset=True)
    fields["absorption"] = {
        "sample": "imagined",
        "chromophores": {"chromium": chromium},
        "parts": [
            {"name": "bands", "proportional_to": ["chromium"], "axes": {"o": flat(1), "e": flat(2)}},
            {"name": "the rest", "axes": {"o": flat(0.5), "e": flat(0)}},
        ],
    }
    fields["sources"]["here"] = {"citation": "An imagined source", "licence": "None"}
    return Mineral.model_validate(fields)


@pytest.fixture
def ruby(monkeypatch: pytest.MonkeyPatch) -> Mineral:
    mineral = coloured()
    monkeypatch.setattr(minerals_db, "mineral", lambda _: mineral)
    return mineral


@pytest.mark.usefixtures("ruby")
def test_absorption_grows_with_its_chromophore(client: TestClient) -> None:
    address = "/v1/minerals/ruby/optics?wavelengths_nm=500,800"
    own, more, none = (client.get(f"{address}{given}").json() for given in (
        "", "&concentration.chromium=0.2", "&concentration.chromium=0",
    ))  # fmt: skip
    assert own["concentrations_weight_percent"] == {"chromium": 0.05}
    assert more["concentrations_weight_percent"] == {"chromium": 0.2}
    assert own["optics"][0]["absorption_per_mm"] == {"o": 1.5, "e": 2}
    assert more["optics"][0]["absorption_per_mm"] == pytest.approx({"o": 4.5, "e": 8}, rel=1e-12)
    assert none["optics"][0]["absorption_per_mm"] == {"o": 0.5, "e": 0}
    # 800 nm lies inside the range of the indices and outside that of the absorption.
    assert [row["clamped"] for row in own["optics"]] == [False, True]
    assert own["optics"][1]["absorption_per_mm"] == {"o": 1.5, "e": 2}
    tags = {client.get(f"{address}&concentration.chromium={c}").headers["etag"] for c in (0.05, 0.1)}
    assert len(tags) == 2


@pytest.mark.usefixtures("ruby")
def test_every_wrong_parameter_of_the_optics_is_named(client: TestClient) -> None:
    query = "wavelengths_nm=0.5893&colour=1&concentration.iron=1&concentration.chromium=101&format=png"
    answer = client.get(f"/v1/minerals/ruby/optics?{query}")
    assert answer.status_code == 422
    told = {fault["pointer"]: fault["detail"] for fault in answer.json()["errors"]}
    assert set(told) == {
        "query/wavelengths_nm", "query/colour", "query/concentration.iron", "query/concentration.chromium",
        "query/format",
    }  # fmt: skip
    assert told["query/wavelengths_nm"] == "0.5893: must be from 10 to 100000 nm"
    assert told["query/concentration.iron"].endswith("those of corundum are chromium")
    assert told["query/concentration.chromium"] == "must be a number of weight %, 0 to 100, not '101'"


@pytest.mark.parametrize("value", ["-1", "nan", "inf", "much", ""])
@pytest.mark.usefixtures("ruby")
def test_a_bad_concentration_is_refused(client: TestClient, value: str) -> None:
    answer = client.get("/v1/minerals/ruby/optics", params={"concentration.chromium": value})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["pointer"] == "query/concentration.chromium"


def test_a_colourless_mineral_has_no_concentrations(client: TestClient) -> None:
    answer = client.get("/v1/minerals/calcite/optics?concentration.chromium=1")
    assert answer.status_code == 422
    assert "calcite has none" in answer.json()["detail"]


@pytest.mark.usefixtures("ruby")
def test_optics_as_csv(client: TestClient) -> None:
    answer = client.get("/v1/minerals/ruby/optics?wavelengths_nm=500,800&format=csv")
    assert answer.headers["content-disposition"] == 'inline; filename="corundum-optics.csv"'
    rows = list(csv.DictReader(io.StringIO(answer.text, newline="")))
    assert list(rows[0]) == [
        "wavelength_nm", "n_o", "n_e", "group_index_o", "group_index_e", "birefringence", "two_v_deg", "optic_sign",
        "absorption_o_per_mm", "absorption_e_per_mm", "clamped",
    ]  # fmt: skip
    told = client.get("/v1/minerals/ruby/optics?wavelengths_nm=500,800").json()["optics"]
    assert [float(row["n_e"]) for row in rows] == [row["indices"]["e"] for row in told]
    assert [row["clamped"] for row in rows] == ["false", "true"]
    assert [row["absorption_o_per_mm"] for row in rows] == ["1.5", "1.5"]
    assert {row["two_v_deg"] for row in rows} == {""}


def test_unknown_minerals_and_parameters_of_an_entry_are_problems(client: TestClient) -> None:
    for address in ("/v1/minerals/kryptonite", "/v1/minerals/kryptonite/optics"):
        assert client.get(address).status_code == 404
        assert client.get(address).json()["type"] == "urn:isogyre:problem:unknown-mineral"
    answer = client.get("/v1/minerals/calcite?wavelength=500")
    assert (answer.status_code, answer.json()["errors"][0]["pointer"]) == (422, "query/wavelength")


def test_a_wavelength_that_a_curve_refuses_is_said_with_its_curve() -> None:
    calcite = minerals_db.mineral("calcite")
    curves = {axis: curve.model_copy(update={"outside_range": "refuse"}) for axis, curve in calcite.dispersion.items()}
    strict = calcite.model_copy(update={"dispersion": curves})
    assert mineral_optics(strict, [500], {}, "w").clamped.tolist() == [False]
    with pytest.raises(InputError) as caught:
        mineral_optics(strict, [500, 3000], {}, "w")
    assert [fault.pointer for fault in caught.value.faults] == ["w", "w"]
    assert str(caught.value.faults[0]).startswith("w: index o of calcite: the curve is known from 204 to 2172 nm, not")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("589.3", [589.3]),
        (" 400 , 500,600 ", [400, 500, 600]),
        ("400:700:100", [400, 500, 600, 700]),
        ("400:750:100", [400, 500, 600, 700]),
        ("400:400:1", [400]),
        ("400:700:1e999999", [400]),
        ("380:380.3:0.1", [380, 380.1, 380.2, 380.3]),  # in decimals, so that the end is met
        ("700,400:500:50,380", [700, 400, 450, 500, 380]),
        ("5e2", [500]),
        ("10,100000", [10, 100_000]),
    ],
)
def test_wavelengths_are_read_as_they_are_written(text: str, expected: list[float]) -> None:
    assert list(read_wavelengths(text)) == expected


def test_as_many_wavelengths_as_are_allowed(client: TestClient) -> None:
    whole = read_wavelengths(f"400:{399 + MAX_WAVELENGTHS}:1")
    assert whole == tuple(np.arange(400.0, 400 + MAX_WAVELENGTHS))
    answer = client.get(f"/v1/minerals/calcite/optics?wavelengths_nm=400:{399 + MAX_WAVELENGTHS}:1")
    assert len(answer.json()["optics"]) == MAX_WAVELENGTHS
    assert client.get(f"/v1/minerals/calcite/optics?wavelengths_nm=400:{400 + MAX_WAVELENGTHS}:1").status_code == 422


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "'' is no number"),
        ("400,", "'' is no number"),
        ("red", "'red' is no number"),
        ("nan", "'nan' is no finite number"),
        ("-inf", "'-inf' is no finite number"),
        ("0.5893", "0.5893: must be from 10 to 100000 nm"),
        ("400:300:1", "400:300:1: must not fall"),
        ("400:700", "400:700: must be a wavelength in nm or start:stop:step"),
        ("400:700:10:1", "must be a wavelength in nm or start:stop:step"),
        ("400:700:0", "the step must be above zero"),
        ("400:700:-1", "the step must be above zero"),
        ("400:700:1e-999999", f"at most {MAX_WAVELENGTHS} wavelengths"),
        ("400:700:1e-300", f"at most {MAX_WAVELENGTHS} wavelengths"),
        ("400:1399:1,400:1400:1", f"at most {MAX_WAVELENGTHS} wavelengths"),
        ("1e99999999999999999999", "is no number"),
        ("snan", "'snan' is no finite number"),
        ("1e999999999", "must be from 10 to 100000 nm"),
    ],
)
def test_what_is_no_wavelength_is_refused(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(said)):
        read_wavelengths(text)
