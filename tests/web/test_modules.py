"""The page's modules that compute, in the browser that runs them."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from playwright.sync_api import Route

from tests.web.visitor import Visitor

pytestmark = pytest.mark.browser


@pytest.fixture
def module(visitor: Visitor) -> Any:
    """Give a function that evaluates an expression over a module ``m`` and an argument ``a``."""
    visitor.page.goto(visitor.address + "favicon.svg")  # an address of the service without a page that does things

    def evaluate(name: str, expression: str, argument: Any = None) -> Any:
        return visitor.run(f"async a => {{ const m = await import('/js/{name}.js'); return {expression}; }}", argument)

    return evaluate


def test_walk_off_is_that_of_the_index_surface(module: Any) -> None:
    # Calcite at the D line: 0.109 through a cleavage face, whose normal stands 44.6° from the optic axis.
    tilt = math.radians(44.64)
    found = module("optics", "m.walkOff(1.65835, 1.48640, a)", [math.sin(tilt), 0, math.cos(tilt)])
    assert found["tangent"] == pytest.approx(0.1092, abs=2e-4)
    assert found["degrees"] == pytest.approx(math.degrees(math.atan(found["tangent"])), rel=1e-12)
    assert found["tilt"] == pytest.approx(44.64, rel=1e-12)
    # Against the numerical normal of the index surface n(θ), in a positive crystal and away from 45°.
    no, ne, theta, h = 2.61, 2.91, math.radians(20), 1e-6

    def index(angle: float) -> float:
        return 1 / math.sqrt(math.cos(angle) ** 2 / no**2 + math.sin(angle) ** 2 / ne**2)

    slope = (index(theta + h) - index(theta - h)) / (2 * h) / index(theta)
    found = module("optics", "m.walkOff(2.61, 2.91, a)", [0, -math.sin(theta), -math.cos(theta)])
    assert found["tangent"] == pytest.approx(abs(slope), rel=1e-7)
    for axis in ([0, 0, 1], [1, 0, 0]):
        assert module("optics", "m.walkOff(1.65835, 1.48640, a)", axis)["tangent"] == pytest.approx(0, abs=1e-15)


def test_angles_are_one_turn(module: Any) -> None:
    given = [0, 360, -90, 725.5, -1e-12, 359.9999999999]
    assert module("angle", "a.map(m.normalise)", given) == [0, 0, 270, 5.5, 0, 0]
    assert module("angle", "m.apart(350, 10)") == pytest.approx(20)
    assert module("angle", "[7.5, 120, 360 / 7, 0.25].map(m.decimals)") == [1, 0, 4, 2]


def test_frames_stand_where_the_service_puts_them(module: Any) -> None:
    request = {"demonstration": "d", "parameters": {"first_angle_deg": 350}, "frames": 36, "size": [9, 9]}
    assert module("request", "[0, 1, 35].map((i) => m.frameAngle(a, i))", request) == [350, 0, 340]
    assert module("request", "[350, 0, 4.9, 5.1, 344].map((d) => m.nearestFrame(a, d))", request) == [0, 1, 1, 2, 35]
    other = {**request, "parameters": {"first_angle_deg": 1}}
    assert module("request", "m.sceneKey(a[0]) === m.sceneKey(a[1])", [request, other])


def test_schema_becomes_fields(module: Any) -> None:
    schema = {
        "$defs": {"Cut": {"enum": ["block", "cleavage"], "type": "string"}},
        "properties": {
            "mineral": {
                "type": "string",
                "default": "calcite",
                "title": "Mineral",
                "x-choices": "minerals",
                "x-optical-classes": ["uniaxial"],
            },
            "cut": {"$ref": "#/$defs/Cut", "default": "block", "x-label": {"en": "Cut", "ru": "Форма"}},
            "size_mm": {
                "type": "array",
                "prefixItems": [{"type": "number", "exclusiveMinimum": 0}, {"type": "number", "maximum": 9}],
                "default": [1, 2],
                "x-unit": "mm",
            },
            "analyser_deg": {
                "anyOf": [{"type": "number", "minimum": 0, "maximum": 180}, {"type": "null"}],
                "default": None,
            },
            "marks": {"type": "array", "items": {"type": "array"}, "default": [], "x-advanced": True},
            "texture": {"type": "string", "default": "digits"},
            "frozen": {"type": "boolean", "default": False, "x-advanced": False},
        },
    }
    fields = {field["name"]: field for field in module("schema", "m.fieldsOf(a)", schema)}
    assert {name: field["kind"] for name, field in fields.items()} == {
        "mineral": "mineral",
        "cut": "choice",
        "size_mm": "numbers",
        "analyser_deg": "analyser",
        "marks": "json",
        "texture": "text",
        "frozen": "boolean",
    }
    assert fields["mineral"]["classes"] == ["uniaxial"]
    assert fields["cut"]["choices"] == ["block", "cleavage"]
    assert fields["cut"]["label"]["ru"] == "Форма"
    assert fields["size_mm"]["limits"] == [{"least": 0, "most": None}, {"least": None, "most": 9}]
    assert fields["analyser_deg"]["nullable"]
    assert fields["analyser_deg"]["limits"] == [{"least": 0, "most": 180}]
    assert [name for name, field in fields.items() if field["advanced"]] == ["marks", "texture"]


def test_formula_has_its_subscripts(module: Any) -> None:
    found = module("elements/facts", "a.map(m.formulaText)", ["CaCO3", "Ca5(PO4)3F", "CaSO4·2H2O", "C"])
    assert found == ["CaCO₃", "Ca₅(PO₄)₃F", "CaSO₄·2H₂O", "C"]


def test_the_list_of_minerals_is_followed_from_page_to_page(visitor: Visitor, module: Any) -> None:
    whole = "(await (await fetch('/v1/minerals?limit=500')).json()).minerals.map((mineral) => mineral.id)"
    known = module("client", whole)
    asked: list[str] = []

    def shorten(route: Route) -> None:
        asked.append(route.request.url)
        route.continue_(url=re.sub(r"\blimit=\d+", "limit=7", route.request.url))

    visitor.page.route("**/v1/minerals?*", shorten)
    found = module("client", "(await new m.Client(a).minerals()).map((mineral) => mineral.id)", visitor.address)
    assert found == known
    assert len(asked) == math.ceil(len(found) / 7) > 1


def test_indices_have_the_names_that_mineralogists_give_them(module: Any) -> None:
    found = module("elements/facts", "a.map(m.namedIndices)", [{"n": 2.4}, {"o": 1.6, "e": 1.5}])
    assert found == [[["n", 2.4]], [["nₒ", 1.6], ["nₑ", 1.5]]]
    biaxial = module("elements/facts", "m.namedIndices(a)", {"a": 1.68, "b": 1.69, "c": 1.53})
    assert biaxial == [["nα", 1.53], ["nβ", 1.68], ["nγ", 1.69]]
