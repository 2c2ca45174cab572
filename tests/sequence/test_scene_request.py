"""Requests of scenes: canonical, equal whatever was left out, told apart from demonstrations."""

from __future__ import annotations

import hashlib
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import minerals_db
from crystal_core.errors import NotSupportedError
from crystal_core.sequence import (
    DemonstrationRequest,
    SceneRequest,
    manifest,
    parse_request,
    read_request,
    render_tile,
)
from crystal_core.sequence.request import code_digest

SCENES = Path(__file__).parents[2] / "docs" / "scenes"


def example(name: str = "calcite-over-page") -> dict[str, Any]:
    document: dict[str, Any] = yaml.safe_load((SCENES / f"{name}.yaml").read_text(encoding="utf-8"))
    return document


def test_the_canonical_request_is_the_same_request() -> None:
    request = parse_request({"scene": example()})
    assert isinstance(request, SceneRequest)
    assert (request.name, request.frames, request.size, request.quality) == ("scene", 1, (512, 512), "standard")
    for same in (
        read_request(request.canonical()),
        read_request(json.loads(json.dumps(request.canonical()))),
        pickle.loads(pickle.dumps(request)),
    ):
        assert same == request
        assert hash(same) == hash(request)
        assert same.digest() == request.digest()
    other = parse_request({"scene": example(), "seed": 1})
    assert other != request
    assert other.digest() != request.digest()
    assert request != parse_request({"demonstration": "rotating-calcite"})


def test_settings_beside_the_scene_replace_its_own() -> None:
    scene = {**example("quartz-crystal"), "render": {"size_px": [100, 50], "seed": 3}}
    request = parse_request({"scene": scene, "size": [64, 32], "frames": 5, "quality": "draft"})
    assert isinstance(request, SceneRequest)
    assert (request.size, request.frames, request.quality, request.seed) == ((64, 32), 5, "draft", 3)
    assert request.scene.motion is not None
    assert (request.scene.render.size_px, request.scene.motion.frames) == ((64, 32), 5)
    scene["render"] = {"size_px": [64, 32], "seed": 3, "quality": "draft"}
    scene["motion"] = {**scene["motion"], "frames": 5}
    assert parse_request({"scene": scene}) == request


def test_a_demonstrations_digest_is_of_the_same_text_as_ever() -> None:
    request = parse_request({"demonstration": "rotating-calcite", "frames": 2})
    assert isinstance(request, DemonstrationRequest)
    assert sorted(request.canonical()) == ["demonstration", "frames", "parameters", "quality", "seed", "size"]
    text = json.dumps(
        {"request": request.canonical(), "data": minerals_db.data_digest(), "code": code_digest()},
        sort_keys=True,
        separators=(",", ":"),
    )
    assert request.digest() == hashlib.sha256(text.encode()).hexdigest()


@pytest.mark.parametrize(
    ("moves", "angles"),
    [
        ([{"turn": {"what": "crystal", "angles_deg": [0, 360]}}], [0, 90, 180, 270]),
        (
            [{"turn": {"what": "crystal", "angles_deg": [0, 40]}}, {"stage": {"angles_deg": [10, 50]}}],
            [10, 20, 30, 40],
        ),
        ([{"analyser": {"angles_deg": [0, 180]}}], [0, 0, 0, 0]),
    ],
)
def test_a_frames_angle_is_that_of_the_stage_or_of_what_turns(moves: list[Any], angles: list[float]) -> None:
    scene = {
        **example(),
        "camera": {"fitted": {}, "analyser_deg": 0},
        "motion": {"frames": 4, "moves": moves},
    }
    request = read_request({"scene": scene})
    assert [request.angle_deg(index) for index in range(4)] == pytest.approx(angles)


def test_a_scene_and_the_demonstration_of_the_same_make_the_same_picture() -> None:
    """The demonstration is a scene with parameters: written down, it makes the same pixels."""
    common = {"size": [48, 48], "quality": "draft", "seed": 5}
    asked = parse_request({"demonstration": "rotating-calcite", "frames": 3, **common})
    assert isinstance(asked, DemonstrationRequest)
    written = read_request({"scene": asked.parameters.document(3).to_mapping(), **common})
    assert [written.angle_deg(index) for index in range(3)] == [asked.angle_deg(index) for index in range(3)]
    np.testing.assert_array_equal(render_tile(asked, 2, 0).pixels, render_tile(written, 2, 0).pixels)


def test_what_cannot_be_drawn_names_its_place_in_the_request() -> None:
    with pytest.raises(NotSupportedError, match=r"^/scene/bodies/upright: "):
        parse_request({"scene": example("tourmaline-pair")})
    assert read_request({"scene": example("tourmaline-pair")}).frames == 18


def test_the_manifest_holds_the_whole_scene() -> None:
    request = parse_request({"scene": example()})
    told = json.loads(json.dumps(manifest(request, [], False)))
    assert told["title"] == "Calcite over a page"
    assert read_request({"scene": told["document"]}) == request
    assert (told["request_digest"], told["size"], told["frame_count"]) == (request.digest(), [512, 512], 1)
