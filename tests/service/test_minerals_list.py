"""The list of minerals over HTTP: conditions, orders, pages, entity tags, CSV."""

from __future__ import annotations

import base64
import csv
import io
import json
from typing import Any

import pytest
from fastapi.testclient import TestClient

import minerals_db
from minerals_db.query import Query, find
from service.minerals import pages
from service.minerals.summaries import COLUMNS


def ids(client: TestClient, query: str = "") -> list[str]:
    """Return the ids of a list, all its pages."""
    found: list[str] = []
    address: str | None = f"/v1/minerals{query}"
    while address is not None:
        answer = client.get(address)
        assert answer.status_code == 200, answer.text
        found += [mineral["id"] for mineral in answer.json()["minerals"]]
        address = answer.json()["links"].get("next")
    return found


def test_minerals_are_listed_with_what_a_choice_needs(client: TestClient) -> None:
    answer = client.get("/v1/minerals?limit=500").json()
    minerals = answer["minerals"]
    assert [mineral["id"] for mineral in minerals] == list(minerals_db.minerals())
    assert answer["total"] == len(minerals)
    assert answer["links"] == {"self": "/v1/minerals?limit=500"}
    calcite = next(mineral for mineral in minerals if mineral["id"] == "calcite")
    assert set(calcite["names"]) == {"en", "ru"}
    assert (calcite["system"], calcite["optical_class"], calcite["optic_sign"]) == ("trigonal", "uniaxial", "negative")
    assert (calcite["kind"], calcite["origin"], calcite["formula"]) == ("mineral", "built-in", "CaCO3")
    assert calcite["point_group"]
    assert calcite["quality"]["dispersion"] == "published"
    # Every handbook: 1.658 and 1.486 at the D line.
    assert calcite["indices"] == pytest.approx({"wavelength_nm": 589.3, "o": 1.6583, "e": 1.4863}, abs=3e-4)
    assert calcite["birefringence"] == pytest.approx(0.172, abs=5e-4)
    assert (calcite["two_v_deg"], calcite["clamped"]) == (None, False)
    assert client.get(calcite["links"]["self"]).json()["id"] == "calcite"
    assert client.get(calcite["links"]["optics"]).json()["mineral"] == "calcite"
    topaz = next(mineral for mineral in minerals if mineral["id"] == "topaz")
    assert topaz["two_v_deg"] == pytest.approx(57, abs=0.5)


@pytest.mark.parametrize(
    "conditions",
    [
        {"name": "кальцит"},
        {"name": "corundum"},
        {"formula": "CO3"},
        {"elements": "Ca,C"},
        {"group": "garnet"},
        {"system": "trigonal", "optical_class": "uniaxial", "optic_sign": "negative"},
        {"n_min": "1.65", "n_max": "1.66"},
        {"birefringence_min": "0.1", "birefringence_max": "0.2"},
        {"colour": "red"},
        {"pleochroism": "strong"},
        {"quality": "published,none"},
        {"kind": "variety"},
        {"origin": "built-in", "sort": "-birefringence"},
        {"sort": "-2v,name-ru"},
        {"origin": "own"},
    ],
)
def test_conditions_are_those_of_a_query(client: TestClient, conditions: dict[str, str]) -> None:
    answer = client.get("/v1/minerals", params={**conditions, "limit": 500}).json()
    expected = [mineral.id for mineral in find(minerals_db.minerals(), Query.model_validate(conditions))]
    assert [mineral["id"] for mineral in answer["minerals"]] == expected
    assert answer["total"] == len(expected)


def test_every_wrong_parameter_is_named(client: TestClient) -> None:
    answer = client.get("/v1/minerals?n_min=low&system=cubist&elements=Ca,CO&weight=3&limit=0&format=xml&sort=beauty")
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    assert {fault["pointer"] for fault in answer.json()["errors"]} == {
        "query/n_min", "query/system", "query/elements/1", "query/weight", "query/limit", "query/format",
        "query/sort/0",
    }  # fmt: skip
    details = {fault["pointer"]: fault["detail"] for fault in answer.json()["errors"]}
    assert details["query/weight"].startswith("unknown; there are name, formula, ")
    assert details["query/elements/1"] == "'CO' is no element; give symbols such as Ca, C"
    assert 'not "low"' in details["query/n_min"]


@pytest.mark.parametrize(
    "query",
    [
        "limit=501", "limit=-1", "limit=two", "n_min=nan", "n_max=inf", "n_min=1.7&n_max=1.6", "name=", "name=%20",
        "name=a&name=b", "birefringence_min=-1", "quality=good", "colour=ultraviolet", "a~1b=1", "%22=1",
    ],
)  # fmt: skip
def test_a_bad_parameter_is_a_problem_that_names_it(client: TestClient, query: str) -> None:
    answer = client.get(f"/v1/minerals?{query}")
    assert answer.status_code == 422
    (fault,) = answer.json()["errors"]
    name = query.rpartition("&")[2].partition("=")[0].replace("%22", '"')
    assert fault["pointer"] in (f"query/{name}", f"query/{name}/0")
    assert fault["detail"]


@pytest.mark.parametrize("query", ["", "?sort=-birefringence", "?sort=2v&optical_class=biaxial", "?name=a"])
@pytest.mark.parametrize("limit", [1, 3, 100])
def test_pages_are_the_list(client: TestClient, query: str, limit: int) -> None:
    whole = ids(client, f"{query}{'&' if query else '?'}limit=500")
    assert len(whole) > 3
    assert ids(client, f"{query}{'&' if query else '?'}limit={limit}") == whole


def test_a_page_links_to_the_next_in_its_body_and_its_head(client: TestClient) -> None:
    answer = client.get("/v1/minerals?name=а&limit=2")
    links = answer.json()["links"]
    assert answer.headers["link"] == f'<{links["next"]}>; rel="next"'
    assert client.get(links["self"]).json()["minerals"] == answer.json()["minerals"]
    again = client.get(links["next"]).json()
    assert again["total"] == answer.json()["total"]
    assert again["links"]["self"] == links["next"]


def next_cursor(client: TestClient, query: str) -> str:
    link = client.get(f"/v1/minerals?{query}").json()["links"]["next"]
    return str(link.rpartition("cursor=")[2])


def told(place: list[Any]) -> str:
    return base64.urlsafe_b64encode(json.dumps(place).encode()).decode()


@pytest.mark.parametrize(
    "cursor",
    ["x", "", "....", "äö", "bm90IGpzb24", told([1, 2, 3]), told(["a", "b"]), "A" * 999, told([[[]]] * 3)],
)
def test_what_is_no_cursor_is_said_to_be_none(client: TestClient, cursor: str) -> None:
    answer = client.get("/v1/minerals", params={"cursor": cursor})
    assert answer.status_code == 422
    assert answer.json()["errors"] == [{"pointer": "query/cursor", "detail": "is no cursor of this service"}]


def test_a_cursor_of_another_query_is_refused(client: TestClient) -> None:
    cursor = next_cursor(client, "limit=2&sort=name")
    assert client.get(f"/v1/minerals?limit=5&sort=name&cursor={cursor}").status_code == 200  # as many as one likes
    for query in ("sort=-name", "name=a&sort=name", ""):
        answer = client.get(f"/v1/minerals?{query}&cursor={cursor}")
        assert answer.status_code == 422
        assert answer.json()["errors"][0]["pointer"] == "query/cursor"
        assert "belongs to another query" in answer.json()["detail"]


def test_a_cursor_of_a_mineral_that_is_not_in_the_list_is_refused(client: TestClient) -> None:
    of_query, of_data, _ = pages._read(next_cursor(client, "limit=2"), "")
    answer = client.get("/v1/minerals", params={"cursor": told([of_query, of_data, "kryptonite"])})
    assert answer.status_code == 422


def test_a_cursor_from_before_the_data_changed_is_refused(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    cursor = next_cursor(client, "limit=2")
    monkeypatch.setattr(minerals_db, "data_digest", lambda: "another")
    answer = client.get(f"/v1/minerals?limit=2&cursor={cursor}")
    assert answer.status_code == 422
    assert "the minerals have changed since" in answer.json()["detail"]


def test_the_tag_is_of_the_question_the_data_and_the_code(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = ("", "?name=a", "?format=csv", "?limit=1", "/calcite", "/quartz", "/calcite/optics",
             "/calcite/optics?wavelengths_nm=500", "/calcite/optics?format=csv")  # fmt: skip
    addresses = [f"/v1/minerals{path}" for path in paths]
    tags = [client.get(address).headers["etag"] for address in addresses]
    assert len(set(tags)) == len(addresses)
    for address, tag in zip(addresses, tags, strict=True):
        known = client.get(address, headers={"If-None-Match": tag})
        assert (known.status_code, known.content, known.headers["etag"]) == (304, b"", tag)
        assert client.get(address, headers={"If-None-Match": f'"other", W/{tag}'}).status_code == 304
        assert client.get(address, headers={"If-None-Match": tags[0] if tag != tags[0] else tags[1]}).status_code == 200
    with monkeypatch.context() as change:
        change.setattr(pages, "_code_digest", lambda: "other code")
        assert not {client.get(address).headers["etag"] for address in addresses} & set(tags)
    with monkeypatch.context() as change:
        change.setattr(minerals_db, "data_digest", lambda: "other data")
        assert not {client.get(address).headers["etag"] for address in addresses} & set(tags)


@pytest.mark.parametrize(
    ("accept", "is_csv"),
    [
        ("text/csv", True),
        ("text/csv, application/json;q=0.5", True),
        ("text/csv;q=0.5, application/json", False),
        ("text/*", True),
        ("text/html, */*;q=0.1", False),
        ("application/json", False),
        ("*/*", False),
        ("image/png", False),
        ("text/csv;q=x, */*", False),
    ],
)
def test_the_form_is_as_asked_for(client: TestClient, accept: str, is_csv: bool) -> None:
    for address in ("/v1/minerals", "/v1/minerals/calcite/optics"):
        answer = client.get(address, headers={"Accept": accept})
        kind = "text/csv; charset=utf-8; header=present" if is_csv else "application/json"
        assert answer.headers["content-type"] == kind
        assert answer.headers["vary"] == "Accept"
        assert client.get(f"{address}?format=json", headers={"Accept": accept}).headers["content-type"] == (
            "application/json"
        )


def test_csv_holds_the_whole_list_unless_a_limit_is_given(client: TestClient) -> None:
    answer = client.get("/v1/minerals?format=csv&sort=-index")
    assert answer.headers["content-disposition"] == 'inline; filename="minerals.csv"'
    assert answer.text.startswith("id,name_en,name_ru,")
    assert answer.text.count("\r\n") == answer.text.count("\n")
    rows = list(csv.DictReader(io.StringIO(answer.text, newline="")))
    assert tuple(rows[0]) == COLUMNS
    assert [row["id"] for row in rows] == ids(client, "?sort=-index&limit=500")
    by_id = {row["id"]: row for row in rows}
    calcite, topaz, fluorite = by_id["calcite"], by_id["topaz"], by_id["fluorite"]
    told = next(m for m in client.get("/v1/minerals?limit=500").json()["minerals"] if m["id"] == "calcite")
    assert (float(calcite["n_o"]), float(calcite["n_e"])) == (told["indices"]["o"], told["indices"]["e"])
    assert (calcite["n"], calcite["n_alpha"], calcite["two_v_deg"]) == ("", "", "")
    assert calcite["name_ru"] == "Кальцит"
    assert [topaz[f"n_{axis}"] for axis in ("alpha", "beta", "gamma")] == ["1.61161", "1.61375", "1.62109"]
    assert topaz["formula"] == "Al2SiO4(F,OH)2"
    assert float(fluorite["n"]) == pytest.approx(1.4338, abs=2e-4)
    assert fluorite["birefringence"] == "0.0"
    part = client.get("/v1/minerals?format=csv&sort=-index&limit=2")
    assert part.text.splitlines() == answer.text.splitlines()[:3]
    rest = client.get(part.headers["link"].partition("<")[2].partition(">")[0])
    assert rest.text.splitlines()[1:] == answer.text.splitlines()[3:5]


def test_openapi_tells_every_parameter(client: TestClient) -> None:
    paths = client.get("/openapi.json").json()["paths"]
    listed = {item["name"]: item for item in paths["/v1/minerals"]["get"]["parameters"]}
    assert set(listed) == {*Query.model_fields, "limit", "cursor", "format"}
    for item in listed.values():
        assert item["in"] == "query"
        assert item["description"]
        assert "null" not in json.dumps(item)
    assert listed["system"]["schema"]["enum"][0] == "cubic"
    assert (listed["elements"]["schema"]["type"], listed["elements"]["explode"]) == ("array", False)
    answers = paths["/v1/minerals"]["get"]["responses"]
    assert set(answers) == {"200", "304", "422"}
    assert set(answers["200"]["content"]) == {"application/json", "text/csv"}
    asked = {item["name"]: item for item in paths["/v1/minerals/{mineral_id}/optics"]["get"]["parameters"]}
    assert set(asked) == {"mineral_id", "wavelengths_nm", "format", "concentration.KEY"}
    assert asked["wavelengths_nm"]["schema"]["type"] == "string"
