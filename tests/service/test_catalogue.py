"""Minerals, demonstrations, the API's description, the page."""

from __future__ import annotations

import pytest
from fastapi.testclient import TestClient

import minerals_db
from crystal_core.errors import InputError
from service import app as app_module
from service.app import page_folder


def test_minerals_are_listed_with_what_a_choice_needs(client: TestClient) -> None:
    minerals = client.get("/v1/minerals").json()["minerals"]
    assert [mineral["id"] for mineral in minerals] == list(minerals_db.minerals())
    calcite = next(mineral for mineral in minerals if mineral["id"] == "calcite")
    assert set(calcite["names"]) == {"en", "ru"}
    assert (calcite["system"], calcite["optical_class"], calcite["optic_sign"]) == ("trigonal", "uniaxial", "negative")
    assert calcite["formula"]
    assert calcite["point_group"]
    assert client.get(calcite["links"]["self"]).json()["id"] == "calcite"


def test_a_mineral_comes_whole_with_sources_and_indices(client: TestClient) -> None:
    calcite = client.get("/v1/minerals/calcite").json()
    assert set(calcite["dispersion"]) == {"o", "e"}
    assert calcite["dispersion"]["o"]["source"] in calcite["sources"]
    assert calcite["indices"]["wavelength_nm"] == 589.3
    # Every handbook: 1.658 and 1.486 at the D line.
    assert calcite["indices"]["o"] == pytest.approx(1.658, abs=5e-4)
    assert calcite["indices"]["e"] == pytest.approx(1.486, abs=5e-4)


def test_a_biaxial_mineral_is_told_by_its_axes(client: TestClient) -> None:
    topaz = client.get("/v1/minerals/topaz").json()
    assert (topaz["optical_class"], topaz["optic_sign"]) == ("biaxial", "positive")
    assert {axis: topaz["indices"][axis] for axis in "abc"} == {"a": 1.61161, "b": 1.61375, "c": 1.62109}
    assert topaz["orientation"]["gamma"] == "c"
    assert topaz["orientation"]["source"] in topaz["sources"]


def test_an_active_mineral_tells_its_rotation(client: TestClient) -> None:
    rotation = client.get("/v1/minerals/quartz").json()["optical_rotation"]
    assert rotation["hand"]["sense"] == "right"
    assert client.get("/v1/minerals/calcite").json()["optical_rotation"] is None


def test_mineral_data_are_validated_by_their_digest(client: TestClient) -> None:
    etag = client.get("/v1/minerals").headers["etag"]
    assert minerals_db.data_digest() in etag
    assert client.get("/v1/minerals", headers={"If-None-Match": etag}).status_code == 304


def test_demonstrations_come_with_the_schema_of_their_parameters(client: TestClient) -> None:
    (fake,) = client.get("/v1/demonstrations").json()["demonstrations"]
    assert fake["name"] == "fake"
    assert set(fake["title"]) == {"en", "ru"}
    assert fake["parameters"]["properties"]["delay_s"]["default"] == 0.0


def test_openapi_describes_the_interface(client: TestClient) -> None:
    document = client.get("/openapi.json").json()
    assert document["openapi"].startswith("3.1")
    assert set(document["paths"]) == {
        "/v1/minerals",
        "/v1/minerals/{mineral_id}",
        "/v1/demonstrations",
        "/v1/renders",
        "/v1/renders/{render_id}",
        "/v1/renders/{render_id}/events",
        "/v1/renders/{render_id}/frames/{index}.{kind}",
        "/v1/renders/{render_id}/sequence.webp",
        "/v1/renders/{render_id}/manifest.json",
        "/v1/optics/interface",
        "/v1/optics/plate",
        "/healthz",
        "/readyz",
    }
    post = document["paths"]["/v1/renders"]["post"]
    assert post["requestBody"]["content"]["application/json"]["schema"]["required"] == ["demonstration"]
    assert set(post["responses"]) == {"202", "400", "413", "415", "422"}
    assert list(post["responses"]["422"]["content"]) == ["application/problem+json"]
    assert set(document["components"]["schemas"]["Problem"]["required"]) == {"type", "title", "status", "detail"}
    schema = "#/components/schemas/Problem"
    for path, operations in document["paths"].items():
        for operation in operations.values():
            for status, answer in operation["responses"].items():
                if status >= "400":
                    assert answer["content"] == {"application/problem+json": {"schema": {"$ref": schema}}}, path
    frame = document["paths"]["/v1/renders/{render_id}/frames/{index}.{kind}"]["get"]["responses"]["200"]
    assert set(frame["content"]) == {"image/png", "image/webp"}


@pytest.mark.parametrize("path", ["/docs", "/redoc"])
def test_no_page_that_loads_from_elsewhere(client: TestClient, path: str) -> None:
    assert client.get(path).status_code == 404


def test_the_page_is_served_and_asked_for_again(client: TestClient) -> None:
    page = client.get("/")
    assert page.status_code == 200
    assert page.headers["content-type"].startswith("text/html")
    assert page.headers["cache-control"] == "no-cache"
    assert page.headers["etag"]
    folder = page_folder()
    scripts = [path.relative_to(folder).as_posix() for path in folder.rglob("*.js")]
    assert scripts
    for script in scripts:
        answer = client.get(f"/{script}")
        assert answer.status_code == 200
        assert answer.headers["content-type"].startswith("text/javascript")


def test_a_missing_page_is_said_at_the_start(monkeypatch: pytest.MonkeyPatch, tmp_path: object) -> None:
    monkeypatch.setattr(app_module.service, "__file__", f"{tmp_path}/service/__init__.py")
    with pytest.raises(InputError, match=r"no index\.html"):
        page_folder()
