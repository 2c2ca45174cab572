"""Our models against what other sources have published: published_values.yaml, row by row."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from minerals_db import Mineral
from minerals_db.library import builtin_minerals

FILE = Path(__file__).with_name("published_values.yaml")
DATA = yaml.safe_load(FILE.read_text(encoding="utf-8"))
MINERALS = builtin_minerals()
LINES_NM = {"B": 686.72, "C": 656.28, "D": 589.3, "F": 486.13, "G": 430.79}


def sorted_indices(mineral: Mineral, wavelength_nm: float) -> list[float]:
    return sorted(float(curve.index(wavelength_nm)) for curve in mineral.dispersion.values())


def acute_two_v_deg(alpha: float, beta: float, gamma: float) -> float:
    """Return the acute angle between the optic axes, degrees, by the ratio of sines of E. E. Wahlstrom (1979)."""
    cosine2 = alpha**2 * (gamma**2 - beta**2) / (beta**2 * (gamma**2 - alpha**2))
    two_v = 2.0 * float(np.rad2deg(np.arccos(np.sqrt(cosine2))))
    return min(two_v, 180.0 - two_v)


def ours(row: dict[str, Any]) -> float:
    """Return what our models give for the quantity of a row."""
    mineral, quantity = MINERALS[row["mineral"]], str(row["quantity"])
    at = float(row.get("wavelength_nm", LINES_NM["D"]))
    if quantity in ("n_alpha", "n_beta", "n_gamma"):
        return sorted_indices(mineral, at)[("n_alpha", "n_beta", "n_gamma").index(quantity)]
    if quantity == "birefringence":
        indices = sorted_indices(mineral, at)
        return indices[-1] - indices[0]
    if quantity == "two_v_deg":
        return acute_two_v_deg(*sorted_indices(mineral, at))
    if quantity in ("n", "n_o", "n_e"):
        return float(mineral.dispersion[quantity[-1]].index(at))
    ray = "o" if quantity.endswith("_o") else "n"
    curve = mineral.dispersion[ray]
    n = {line: float(curve.index(nm)) for line, nm in LINES_NM.items()}
    if quantity == "abbe_D":
        return (n["D"] - 1.0) / (n["F"] - n["C"])
    first, second = {"n_f_minus_n_c": ("F", "C"), "n_g_minus_n_b": ("G", "B")}[quantity.removesuffix("_o")]
    return n[first] - n[second]


def outside(row: dict[str, Any]) -> float:
    """Return how far our value lies outside the value or the range of a row."""
    lowest, highest = row["value"] if isinstance(row["value"], list) else (row["value"], row["value"])
    return max(float(lowest) - ours(row), ours(row) - float(highest), 0.0)


def name(row: dict[str, Any]) -> str:
    return f"{row['mineral']}-{row['quantity']}-{row.get('wavelength_nm', 'D')}-{row['source']}"


@pytest.mark.parametrize("row", DATA["values"], ids=name)
def test_value(row: dict[str, Any]) -> None:
    # An ulp, where a difference of printed decimals falls on the tolerance itself.
    assert outside(row) <= row["tolerance"] * (1.0 + 1e-9), f"ours is {ours(row):.5f}"


@pytest.mark.parametrize("row", DATA["disagreements"], ids=name)
def test_known_disagreements_are_still_there(row: dict[str, Any]) -> None:
    assert len(row["why"]) > 20
    assert outside(row) > row["tolerance"], f"ours is {ours(row):.5f}: it agrees, move the row to the values"


def test_twenty_five_minerals_are_compared() -> None:
    compared = {row["mineral"] for row in DATA["values"]}
    assert len(compared) >= 25
    measured = {
        key for key in compared if all(curve.model != "one-term" for curve in MINERALS[key].dispersion.values())
    }
    assert len(measured) >= 25, "those whose curves are published, not made from one index"
    numbers = {row["mineral"] for row in DATA["values"] if not isinstance(row["value"], list)}
    assert len(numbers & measured) >= 25, "those of which a number is published, not a range"


@pytest.mark.parametrize("row", DATA["values"] + DATA["disagreements"], ids=name)
def test_the_source_is_another_than_ours(row: dict[str, Any]) -> None:
    mineral = MINERALS[row["mineral"]]
    forbidden = set(DATA["sources"][row["source"]].get("same_as", ()))
    for curve in mineral.dispersion.values():
        carried = mineral.sources[curve.source].via
        assert curve.source not in forbidden
        assert carried is None or carried not in forbidden
        if row["quantity"] == "two_v_deg":
            assert "2V is" not in (curve.note or ""), "an index was chosen for the angle"


def test_every_tolerance_has_its_reason() -> None:
    for row in DATA["values"]:
        assert 0.0 < row["tolerance"] <= 5.0
        assert len(DATA["reasons"][row["reason"]]) > 20
        assert row["quantity"] == "two_v_deg" or row["tolerance"] <= 0.05
        if isinstance(row["value"], list):
            lowest, highest = row["value"]
            assert 0.0 < highest - lowest <= (20.0 if row["quantity"] == "two_v_deg" else 0.07), "too wide to say much"
    assert {row["reason"] for row in DATA["values"]} == set(DATA["reasons"]), "none is idle"
    assert {row["source"] for row in DATA["values"] + DATA["disagreements"]} == set(DATA["sources"])


def test_no_row_stands_twice() -> None:
    names = [name(row) for row in DATA["values"] + DATA["disagreements"]]
    assert len(set(names)) == len(names)
