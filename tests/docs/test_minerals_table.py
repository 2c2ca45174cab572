"""docs/minerals-table.md is what its tool makes of the data."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import ImageColor

from crystal_core.materials import SODIUM_D_NM, swatches
from minerals_db.library import builtin_minerals
from tests.docs.blocks import ROOT
from tools.make_minerals_table import PAGE, PICTURES, write

DOCS = ROOT / "docs"
AGAIN = "make it anew: python tools/make_minerals_table.py"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("docs")
    write(folder)
    return folder


def test_the_page_is_what_the_tool_makes_of_the_data(made: Path) -> None:
    assert (DOCS / PAGE).read_text(encoding="utf-8") == (made / PAGE).read_text(encoding="utf-8"), AGAIN


def test_so_are_its_pictures(made: Path) -> None:
    shown, drawn = (
        {file.name: file.read_text(encoding="utf-8") for file in (folder / PICTURES).iterdir()}
        for folder in (DOCS, made)
    )
    assert shown == drawn, AGAIN


def test_a_picture_of_a_mineral_that_is_gone_goes_too(tmp_path: Path) -> None:
    write(tmp_path)
    gone = tmp_path / PICTURES / "kryptonite.svg"
    gone.write_text("<svg/>", encoding="utf-8")
    write(tmp_path)
    assert not gone.exists()


def rows() -> dict[str, str]:
    """Return the rows of the page by the English names of the minerals."""
    text = (DOCS / PAGE).read_text(encoding="utf-8")
    return {match[2]: match[1] for match in re.finditer(r"^(\| (?:↳ )?\*\*(.+?)\*\*<br>.*)$", text, re.MULTILINE)}


def test_every_mineral_has_its_row() -> None:
    minerals = builtin_minerals().values()
    assert sorted(rows()) == sorted(mineral.names.en for mineral in minerals)
    for mineral in minerals:
        row = rows()[mineral.names.en]
        assert mineral.names.ru in row
        numbers = [float(number) for number in re.findall(r"\d\.\d{3,}", row)]
        for curve in mineral.dispersion.values():
            assert np.min(np.abs(np.array(numbers) - float(curve.index(SODIUM_D_NM)))) <= 5.1e-4


def test_swatches_show_the_colours_of_the_library() -> None:
    coloured = [mineral for mineral in builtin_minerals().values() if mineral.absorption is not None]
    assert len(coloured) >= 20
    thin = 0
    for mineral in coloured:
        for name, thickness_mm in ((mineral.id, 1.0), (f"{mineral.id}-thin", 0.03)):
            file = DOCS / PICTURES / f"{name}.svg"
            if thickness_mm < 1.0 and not file.exists():
                continue
            thin += thickness_mm < 1.0
            shown = re.findall(r'rx="3" fill="(#\w{6})"', file.read_text(encoding="utf-8"))
            expected = list(swatches(mineral, thickness_mm).values())
            assert len(shown) == len(expected)
            for colour in expected:  # the page has them in the order of the indices
                assert min(np.abs(np.array(ImageColor.getrgb(one)) - 255.0 * colour).max() for one in shown) <= 0.51
    assert thin >= 1, "biotite is black in a millimetre"
