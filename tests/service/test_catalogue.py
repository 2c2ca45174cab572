"""Demonstrations, the API's description, the page."""

from __future__ import annotations

import pytest
from fastapi.testclient import TestClient

from crystal_core.errors import InputError
from service import app as app_module
from service.app import page_folder


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
        "/v1/minerals/{mineral_id}/optics",
        "/v1/schemas/mineral",
        "/v1/minerals/{mineral_id}/habits",
        "/v1/minerals/{mineral_id}/habits/{name}",
        "/v1/demonstrations",
        "/v1/scenes/validate",
        "/v1/scenes/schema",
        "/v1/assets",
        "/v1/assets/{asset}",
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
    kinds = post["requestBody"]["content"]["application/json"]["schema"]["oneOf"]
    assert [kind["required"] for kind in kinds] == [["demonstration"], ["scene"]]
    assert set(post["responses"]) == {"202", "400", "413", "415", "422", "503"}
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
