"""Random scenes survive writing and reading; random mutations are valid or refused with a path; nothing is ignored."""

from __future__ import annotations

import json
import math
import string
from typing import Any

import pytest
import yaml
from hypothesis import HealthCheck, given, settings

from crystal_core.errors import InputError
from crystal_core.scene import SceneDocument, parse_scene
from tests.scene.strategies import Mapping, mutations, scenes

SLOW = settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
FULL = settings(max_examples=2000, deadline=None, suppress_health_check=list(HealthCheck))

AXES = {sign + axis for axis in "xyz" for sign in ("", "-")}


def says(given: Any, scene: Any) -> bool:
    """Tell whether a scene, as it writes itself, says everything that it was given."""
    if isinstance(given, dict):
        told = {key: value for key, value in given.items() if value is not None}
        return isinstance(scene, dict) and all(key in scene and says(value, scene[key]) for key, value in told.items())
    if isinstance(scene, list) and given in AXES if isinstance(given, str) else False:
        return True
    if isinstance(scene, list) and isinstance(given, int | float):
        return len(scene) == 1 and says(given, scene[0])  # one spacing for all
    if isinstance(given, list):
        same = isinstance(scene, list) and len(given) == len(scene)
        return same and all(says(a, b) for a, b in zip(given, scene, strict=True))
    if isinstance(given, float) and isinstance(scene, int | float):
        return math.isclose(given, scene, rel_tol=1e-6, abs_tol=1e-6)
    return type(given) is type(scene) and given == scene


def survives(mapping: Mapping) -> SceneDocument:
    scene = parse_scene(mapping, paths=True)
    assert says(mapping, scene.to_mapping(full=True))
    for text in (scene.to_yaml(), scene.to_yaml(full=True)):
        assert parse_scene(yaml.safe_load(text), paths=True) == scene
    for text in (scene.to_json(), scene.to_json(full=True)):
        assert parse_scene(json.loads(text), paths=True) == scene
    from_yaml = parse_scene(yaml.safe_load(scene.to_yaml()), paths=True)
    assert from_yaml.to_json() == scene.to_json()
    return scene


def leads_somewhere(pointer: str, mapping: Any) -> bool:
    """Tell whether a pointer stands for a place of a mapping, or for a key that is missing in one."""
    steps = [step.replace("~1", "/").replace("~0", "~") for step in pointer.split("/")[1:]]
    for number, step in enumerate(steps):
        if isinstance(mapping, list) and step.isdigit() and int(step) < len(mapping):
            mapping = mapping[int(step)]
        elif isinstance(mapping, dict) and step in mapping:
            mapping = mapping[step]
        else:
            return number == len(steps) - 1
    return True


def check_mutant(mutation: tuple[Mapping, Mapping, str]) -> bool:
    """Check one mutation; tell whether it was refused."""
    scene, mutant, how = mutation
    parse_scene(scene, paths=True)
    try:
        parse_scene(mutant, paths=True)
    except InputError as error:
        for fault in error.faults:
            assert leads_somewhere(fault.pointer, mutant), fault
            assert fault.message
            assert "\n" not in fault.message
            assert not set(fault.message) & set("\x1f")
            assert fault.message[0] not in string.ascii_uppercase
        return True
    assert how != "unknown key"
    survives(mutant)
    return False


@SLOW
@given(scenes())
def test_a_scene_survives_yaml_and_json(mapping: Mapping) -> None:
    survives(mapping)


@SLOW
@given(mutations())
def test_a_mutation_is_valid_or_refused_with_a_path(mutation: tuple[Mapping, Mapping, str]) -> None:
    check_mutant(mutation)


@pytest.mark.full
@FULL
@given(scenes())
def test_many_scenes_survive(mapping: Mapping) -> None:
    survives(mapping)


@pytest.mark.full
@FULL
@given(mutations())
def test_many_mutations(mutation: tuple[Mapping, Mapping, str]) -> None:
    check_mutant(mutation)


def test_the_mutations_are_of_both_kinds() -> None:
    seen: list[bool] = []

    @settings(max_examples=100, deadline=None, database=None, derandomize=True, suppress_health_check=list(HealthCheck))
    @given(mutations())
    def collect(mutation: tuple[Mapping, Mapping, str]) -> None:
        seen.append(check_mutant(mutation))

    collect()
    assert 0.3 < sum(seen) / len(seen) < 0.98


def test_says_notices_what_is_left_out() -> None:
    assert says({"a": [1, 2.0], "b": None}, {"a": [1, 2], "c": 1})
    assert not says({"a": 1}, {})
    assert not says({"a": 1}, {"a": 2})
    assert not says({"a": [1]}, {"a": [1, 2]})
    assert not says({"a": True}, {"a": 1})
