"""The published JSON Schema is a schema, and takes what the models take."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import HealthCheck, given, settings

from crystal_core.errors import InputError
from crystal_core.scene import parse_scene, read_scene, scene_schema
from tests.scene.json_schema import accepts, check_schema
from tests.scene.strategies import Mapping, mutations, scenes

EXAMPLES = sorted((Path(__file__).parents[2] / "docs" / "scenes").glob("*.yaml"))
SCHEMA = scene_schema()
SLOW = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))


def test_it_is_a_schema() -> None:
    assert SCHEMA["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    check_schema(SCHEMA, SCHEMA)


def test_every_property_is_described_by_its_own_or_its_type() -> None:
    assert set(SCHEMA["properties"]) == {
        *("isogyre", "title", "description", "surroundings", "bodies", "surfaces", "sheets", "lights"),
        *("camera", "motion", "render"),
    }
    for name, part in SCHEMA["$defs"].items():
        assert part.get("description"), name
        assert part.get("additionalProperties") is False, name


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_it_takes_the_examples_and_what_they_become(path: Path) -> None:
    scene = read_scene(path)
    for mapping in (yaml.safe_load(path.read_text()), scene.to_mapping(), scene.to_mapping(full=True)):
        assert accepts(SCHEMA, mapping, SCHEMA)


@SLOW
@given(scenes())
def test_it_takes_random_scenes(mapping: Mapping) -> None:
    assert accepts(SCHEMA, mapping, SCHEMA)


@SLOW
@given(mutations())
def test_what_it_refuses_the_models_refuse(mutation: tuple[Mapping, Mapping, str]) -> None:
    _, mutant, _ = mutation
    if accepts(SCHEMA, mutant, SCHEMA):
        return
    with pytest.raises(InputError):
        parse_scene(mutant, paths=True)


@pytest.mark.parametrize(
    "part",
    [
        {"isogyre": 2},
        {"colour": 1},
        {"bodies": {"1": {}}},
        {"bodies": {"a": {"optics": {"n": 1.5}, "shape": {"box": {}, "sphere": {}}}}},
        {"camera": {"analyser_deg": 0}},
        {"lights": {}},
        {"render": {"dispersion": 1}},
    ],
)
def test_it_refuses(part: dict[str, Any]) -> None:
    assert not accepts(SCHEMA, {"isogyre": 1, "surfaces": {"p": {"print": "digits"}}} | part, SCHEMA)
