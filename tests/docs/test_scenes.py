"""The page of the scene language: its pieces are valid, its program prints what it says, no key is left out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from crystal_core.scene import parse_scene, scene_schema
from tests.docs.blocks import FENCE, ROOT, programs, run

PAGE = ROOT / "docs" / "scenes.md"
BLOCKS = FENCE.findall(PAGE.read_text(encoding="utf-8"))
PIECES = [yaml.safe_load(body) for language, body in BLOCKS if language == "yaml"]


def whole(piece: dict[str, Any]) -> dict[str, Any]:
    """Return a piece of the page as a scene."""
    body = {"mineral": "calcite", "shape": {"habit": {}}}
    if "optics" in piece:
        body = {"shape": {"box": {}}} | piece
    elif set(piece) <= {"mineral", "shape", "twin", "orientation"}:
        body |= piece
    scene = {"isogyre": 1, "bodies": {"crystal": body}}
    return piece if "isogyre" in piece else scene | (piece if {"lights", "motion"} & set(piece) else {})


@pytest.mark.parametrize("piece", PIECES, ids=lambda piece: "+".join(piece))
def test_the_pieces_are_valid(piece: dict[str, Any]) -> None:
    scene = parse_scene(whole(piece))
    assert len(PIECES) >= 8
    assert scene.bodies


def test_the_program_prints_what_it_says(tmp_path: Path) -> None:
    (program,) = programs("docs/scenes.md")
    _, printed = run(program, tmp_path)
    assert printed.strip() == program.prints.strip()


def test_every_key_is_told() -> None:
    text = PAGE.read_text(encoding="utf-8")
    keys = {key for part in [scene_schema(), *scene_schema()["$defs"].values()] for key in part.get("properties", {})}
    assert {key for key in keys if key not in text} == set()
    assert {key for key in keys if f"`{key}`" not in text and f"{key}:" not in text and f"{{{key}" not in text} == set()
