"""The tool that finds absorption from colours: its parts against references, and the entries against its answers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import colour
import numpy as np
import pytest
import yaml

import minerals_db
from minerals_db.absorption import Absorption, SpectralBands
from tests.minerals_db.colour_tool import RECIPES, TOOL

CONTENT: dict[str, Any] = yaml.safe_load(RECIPES.read_text(encoding="utf-8"))
DATA = Path(minerals_db.__file__).parent / "data"


def test_cielab_agrees_with_colour_science() -> None:
    xyz = np.random.default_rng(3).uniform(0.0, 1.0, (50, 3)) ** 3
    white = np.array(TOOL.D65_WHITE_XYZ)
    expected = colour.XYZ_to_Lab(xyz, colour.XYZ_to_xy(white))
    np.testing.assert_allclose(TOOL.lab_of_xyz(xyz), expected, atol=1e-9)


def test_named_colours() -> None:
    np.testing.assert_allclose(TOOL.lab_of_hex("ffffff"), (100.0, 0.0, 0.0), atol=1e-6)
    # sRGB red, as tables print it
    np.testing.assert_allclose(TOOL.lab_of_hex("ff0000"), (53.24, 80.09, 67.20), atol=0.05)


def test_a_clear_plate_is_white_and_a_grey_one_grey() -> None:
    clear = np.zeros_like(TOOL.WAVELENGTHS_NM)
    np.testing.assert_allclose(TOOL.lab_through(clear, 5.0), (100.0, 0.0, 0.0), atol=1e-9)
    # luminance 0.18420 is lightness 50
    grey = np.full_like(clear, -np.log(0.18418652) / 5.0)
    np.testing.assert_allclose(TOOL.lab_through(grey, 5.0), (50.0, 0.0, 0.0), atol=1e-5)


@pytest.mark.parametrize(
    "term", [{"centre_per_cm": 18000, "fwhm_per_cm": 3000}, {"edge_per_cm": 24000, "width_per_cm": 2500}]
)
def test_shapes_are_those_of_the_entries(term: dict[str, Any]) -> None:
    known = {"model": "bands", "range_nm": (380, 780), "source": "authors", "status": "estimated"}
    if "edge_per_cm" in term:
        curve = SpectralBands.model_validate({**known, "edges": [{**term, "plateau_per_mm": 1}]})
    else:
        curve = SpectralBands.model_validate({**known, "bands": [{"shape": "gaussian", **term, "peak_per_mm": 1}]})
    np.testing.assert_allclose(TOOL.shape_of(term), curve.coefficient_per_mm(TOOL.WAVELENGTHS_NM), rtol=1e-12)


def test_finds_the_peaks_that_made_a_colour(monkeypatch: pytest.MonkeyPatch) -> None:
    terms = {
        "green": {"centre_per_cm": 18500, "fwhm_per_cm": 4000},
        "edge": {"edge_per_cm": 26000, "width_per_cm": 3000},
    }
    made = 0.31 * TOOL.shape_of(terms["green"]) + 1.7 * TOOL.shape_of(terms["edge"])
    monkeypatch.setattr(TOOL, "lab_of_hex", lambda _: TOOL.lab_through(made, 4.0))
    monkeypatch.setattr(TOOL, "PENALTY", 0.0)
    recipe = {
        "goals": {"n": [{"mm": 4, "colour": "it", "published": "it"}]},
        "terms": terms,
        "parts": [{"name": "all", "axes": {"n": ["green", "edge"]}}],
    }
    found = TOOL.match(recipe, {"it": "000000"})
    assert found.peaks["all", "n", "green"] == pytest.approx(0.31, rel=2e-3)
    assert found.peaks["all", "n", "edge"] == pytest.approx(1.7, rel=2e-3)
    assert found.differences["n"][0] < 0.2


def _without_peaks(block: dict[str, Any]) -> tuple[dict[str, Any], list[float]]:
    """Return a block without its peaks and notes, and the peaks."""
    peaks: list[float] = []

    def bare(node: Any) -> Any:
        if isinstance(node, dict):
            peaks.extend(value for key, value in node.items() if key in ("peak_per_mm", "plateau_per_mm"))
            return {
                key: bare(value) for key, value in node.items() if key not in ("peak_per_mm", "plateau_per_mm", "note")
            }
        return [bare(child) for child in node] if isinstance(node, list) else node

    return bare(block), peaks


@pytest.mark.parametrize("mineral", CONTENT["recipes"])
def test_the_entry_holds_what_the_tool_finds(mineral: str) -> None:
    recipe = CONTENT["recipes"][mineral]
    matched = TOOL.match(recipe, CONTENT["colours"])
    printed = yaml.safe_load(TOOL.block(recipe, matched))["absorption"]
    assert Absorption.model_validate(printed).axes == tuple(recipe["goals"])
    entry = yaml.safe_load((DATA / f"{mineral}.yaml").read_text(encoding="utf-8"))["absorption"]
    (told, peaks), (held, held_peaks) = _without_peaks(printed), _without_peaks(entry)
    assert held == told
    # another LAPACK may round the third digit otherwise, and a band that no colour asks for is loosely held
    assert held_peaks == pytest.approx(peaks, rel=0.02, abs=0.01 * max(peaks))


@pytest.mark.parametrize("mineral", CONTENT["recipes"])
def test_colours_are_met(mineral: str) -> None:
    matched = TOOL.match(CONTENT["recipes"][mineral], CONTENT["colours"])
    differences = [difference for axis in matched.differences.values() for difference in axis]
    # neighbouring names of the ISCC-NBS system are some 15 to 20 apart
    assert max(differences) < 21.0


def test_named_minerals_only() -> None:
    for mineral in CONTENT["recipes"]:
        assert mineral in minerals_db.minerals()
