"""Every link inside the docs leads somewhere, and pictures come from the commands that stand beside them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.docs.blocks import FENCE, ROOT
from tools.make_pictures import RENDERED

PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)|(?:src|href)=\"([^\"]+)\"")


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as GitHub makes them."""
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    lost = []
    for target in (first or second for first, second in LINK.findall(text)):
        if target.startswith(("https://", "mailto:")):
            continue
        name, _, anchor = target.partition("#")
        file = (page.parent / name).resolve() if name else page
        if not file.exists() or (anchor and anchor not in anchors(file)):
            lost.append(target)
    assert lost == []


def test_pictures_are_shown_and_shown_pictures_are_there() -> None:
    text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    kept = {path.name for path in (ROOT / "docs" / "pictures").iterdir()}
    assert {name for name in kept if f"pictures/{name}" in text} == kept
    assert set(RENDERED) <= kept


def test_the_command_of_the_picture_stands_in_the_readme() -> None:
    text = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    for name in ("rotating-calcite.webp", "tanzanite.webp", "ruby.png"):
        arguments, _ = RENDERED[name]
        assert f"isogyre render {arguments} --out " in text
    assert RENDERED["rotating-calcite.webp"][1] in text


NUMBER = re.compile(r"-?\d+\.\d+")


DRAWN = {
    "draw_conventions.py": ("frames.svg", "waves.svg"),
    "draw_backward_rays.py": ("backward-rays.svg",),
    "draw_indicatrix.py": ("indicatrix.svg",),
    "draw_minerals.py": ("chromium.svg", "orientation.svg"),
    "draw_plates.py": ("plates.svg",),
}
"""The scripts of tools/ and the drawings that they make."""


@pytest.mark.parametrize(("script", "names"), DRAWN.items(), ids=list(DRAWN))
def test_drawings_are_what_their_script_draws(script: str, names: tuple[str, ...], tmp_path: Path) -> None:
    subprocess.run([sys.executable, ROOT / "tools" / script, tmp_path], check=True, timeout=120)
    assert {path.name for path in tmp_path.iterdir()} == set(names)
    for name in names:
        shown = (ROOT / "docs" / "pictures" / name).read_text(encoding="utf-8")
        drawn = (tmp_path / name).read_text(encoding="utf-8")
        assert NUMBER.sub("#", shown) == NUMBER.sub("#", drawn), f"draw it anew: python tools/{script}"
        # Coordinates are rounded to tenths of a pixel; on another machine one may fall the other way.
        there, here = (np.array(NUMBER.findall(text), np.float64) for text in (shown, drawn))
        np.testing.assert_allclose(here, there, atol=0.11)


def test_every_drawing_has_its_script() -> None:
    drawings = {path.name for path in (ROOT / "docs" / "pictures").glob("*.svg")}
    assert drawings == {name for names in DRAWN.values() for name in names}
    assert {path.name for path in (ROOT / "tools").glob("draw_*.py")} == set(DRAWN)
