"""Requests: every fault at once, at its place; a digest that tells requests apart."""

import pickle

import pytest

from crystal_core.errors import InputError
from crystal_core.sequence import demonstrations, parse_request

NAME = "rotating-calcite"


def test_defaults() -> None:
    request = parse_request({"demonstration": NAME})
    assert (request.frames, request.size, request.quality, request.seed) == (36, (512, 512), "standard", 0)
    assert request.parameters.document().bodies["crystal"].mineral == "calcite"
    assert pickle.loads(pickle.dumps(request)) == request
    assert parse_request(request.canonical()) == request


def _faults(obj: dict[str, object]) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        parse_request(obj)
    return {fault.pointer: fault.message for fault in caught.value.faults}


@pytest.mark.parametrize(
    ("obj", "pointer", "words"),
    [
        ({}, "/demonstration", "required"),
        ({"demonstration": "dancing-quartz"}, "/demonstration", "known: rotating-calcite"),
        ({"demonstration": NAME, "colour": 1}, "/colour", "unknown key"),
        ({"demonstration": NAME, "size": [0, 512]}, "/size/0", "16"),
        ({"demonstration": NAME, "size": [512, 100000]}, "/size/1", "2048"),
        ({"demonstration": NAME, "size": [512.5, 512]}, "/size/0", "integer"),
        ({"demonstration": NAME, "frames": 0}, "/frames", "1"),
        ({"demonstration": NAME, "frames": 361}, "/frames", "360"),
        ({"demonstration": NAME, "seed": -1}, "/seed", "0"),
        ({"demonstration": NAME, "seed": 2**63}, "/seed", "9223372036854775807"),
        ({"demonstration": NAME, "quality": "superb"}, "/quality", "draft"),
        ({"demonstration": NAME, "parameters": []}, "/parameters", "dictionary"),
        ({"demonstration": NAME, "parameters": {"minerals": "calcite"}}, "/parameters/minerals", "unknown key"),
        ({"demonstration": NAME, "parameters": {"mineral": "calzite"}}, "/parameters/mineral", "calcite"),
        ({"demonstration": NAME, "parameters": {"size_mm": [1, 2, "x"]}}, "/parameters/size_mm/2", "number"),
        ({"demonstration": NAME, "parameters": {"gap_mm": float("nan")}}, "/parameters/gap_mm", ""),
        ({"demonstration": NAME, "parameters": {"marks": [[0, 0], [90, 0]]}}, "/parameters/marks/1", "page"),
        ({"demonstration": NAME, "parameters": {"texture": "asset:" + "0" * 64}}, "/parameters/texture", "unknown"),
        ({"demonstration": NAME, "parameters": {"texture": "/etc/passwd"}}, "/parameters/texture", ""),
        ({"demonstration": NAME, "parameters": {"mineral": "quartz", "cut": "cleavage"}}, "/parameters/cut", "block"),
        (
            {"demonstration": NAME, "parameters": {"camera_distance_mm": 20, "size_mm": [50, 50, 90]}},
            "/parameters/camera_distance_mm",
            "inside",
        ),
        ({"demonstration": NAME, "parameters": {"light_position_mm": [0, 0, 7]}}, "/parameters/light_position_mm", ""),
        (
            {"demonstration": NAME, "parameters": {"light_position_mm": [60, 0, 9]}},
            "/parameters/light_position_mm",
            "higher",
        ),
    ],
)
def test_one_fault(obj: dict[str, object], pointer: str, words: str) -> None:
    faults = _faults(obj)
    assert list(faults) == [pointer]
    assert words in faults[pointer]
    assert "\n" not in faults[pointer]


def test_every_fault_at_once() -> None:
    faults = _faults(
        {"demonstration": NAME, "size": [0, 5], "parameters": {"mineral": "unobtainium", "gap_mm": -1, "hue": 3}}
    )
    assert set(faults) == {"/size/0", "/size/1", "/parameters/mineral", "/parameters/gap_mm", "/parameters/hue"}


def test_the_digest_tells_requests_apart() -> None:
    base = parse_request({"demonstration": NAME}).digest()
    assert parse_request({"demonstration": NAME, "parameters": {"mineral": "calcite"}, "frames": 36}).digest() == base
    for change in ({"seed": 1}, {"quality": "draft"}, {"parameters": {"gap_mm": 0.03}}, {"size": [512, 511]}):
        assert parse_request({"demonstration": NAME, **change}).digest() != base


@pytest.mark.parametrize("mineral", ["calcite", "diamond", "aragonite", "gypsum", "kyanite", "glass-n-bk7"])
def test_crystals_of_every_class_are_taken(mineral: str) -> None:
    assert parse_request({"demonstration": NAME, "parameters": {"mineral": mineral}}).parameters


def test_unknown_mineral_names_one_like_it() -> None:
    unknown = _faults({"demonstration": NAME, "parameters": {"mineral": "Calcit"}})["/parameters/mineral"]
    assert unknown.startswith("no mineral 'Calcit'; do you mean calcite")


def test_the_schema_tells_a_page_all_it_needs() -> None:
    schema = demonstrations()[NAME].Parameters.model_json_schema()
    for name, prop in schema["properties"].items():
        assert {"default", "title", "description", "x-label", "x-group"} <= prop.keys(), name
        assert set(prop["x-label"]) == {"en", "ru"}, name
    assert schema["additionalProperties"] is False
