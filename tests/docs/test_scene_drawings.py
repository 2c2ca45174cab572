"""The drawings beside the examples are what the command draws."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from service.cli import run
from tests.docs.blocks import ROOT

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
SCENES = ROOT / "docs" / "scenes"


@pytest.mark.parametrize("scene", sorted(SCENES.glob("*.yaml")), ids=lambda path: path.stem)
def test_the_drawing_is_what_the_command_draws(scene: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "drawing.svg"
    assert run(["scene", "show", str(scene), "--indicatrix", "--wireframe", str(out)]) == 0
    capsys.readouterr()
    shown, drawn = (path.read_text(encoding="utf-8") for path in (scene.with_suffix(".svg"), out))
    command = f"isogyre scene show {scene.name} --indicatrix --wireframe {scene.stem}.svg"
    assert NUMBER.sub("#", shown) == NUMBER.sub("#", drawn), f"draw it anew: {command}"
    # Coordinates are rounded to tenths of a unit; on another machine one may fall the other way.
    there, here = (np.array(NUMBER.findall(text), np.float64) for text in (shown, drawn))
    np.testing.assert_allclose(here, there, atol=0.11)


def test_every_example_is_shown_on_the_page() -> None:
    text = (ROOT / "docs" / "scenes.md").read_text(encoding="utf-8")
    for scene in SCENES.glob("*.yaml"):
        assert f"(scenes/{scene.stem}.svg)](scenes/{scene.name})" in text
    assert {path.stem for path in SCENES.glob("*.svg")} == {path.stem for path in SCENES.glob("*.yaml")}
