"""Finding minerals."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from typing import Any, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

import minerals_db
from minerals_db import Mineral
from minerals_db.facts import facts
from minerals_db.groups import GROUPS
from minerals_db.indicatrix import SODIUM_D_NM, birefringence, two_v_deg
from minerals_db.query import SORT_KEYS, Query, find

SOURCE = {"source": "here", "status": "published"}


def index(n: float) -> dict[str, Any]:
    """Return a curve that is n everywhere it is known."""
    return {
        "model": "table",
        "wavelengths_nm": [400, 589.3, 700],
        "indices": [n, n, n],
        "range_nm": [400, 700],
        **SOURCE,
    }


def spectrum(status: str) -> dict[str, Any]:
    table = {"model": "table", "wavelengths_nm": [400, 700], "coefficients_per_mm": [1, 2], "range_nm": [400, 700]}
    return {**table, "source": "here", "status": status}


def entry(mineral_id: str, en: str, ru: str, formula: str, indices: Mapping[str, float], **more: Any) -> Mineral:
    """Return an entry of a crystal whose system follows from the names of its indices, or of a glass."""
    system, point_group, optical_class, cell = {
        "n": ("cubic", "m-3m", "isotropic", (5, 5, 5, 90)),
        "eo": ("trigonal", "-3m", "uniaxial", (5, 5, 9, 120)),
        "abc": ("orthorhombic", "mmm", "biaxial", (5, 6, 7, 90)),
    }["".join(sorted(indices))]
    a, b, c, gamma = cell
    fields: dict[str, Any] = {
        "id": mineral_id,
        "names": {"en": en, "ru": ru},
        "formula": formula,
        "system": system,
        "point_group": point_group,
        "optical_class": optical_class,
        "cell": {
            "a_angstrom": a,
            "b_angstrom": b,
            "c_angstrom": c,
            "alpha_deg": 90,
            "beta_deg": 90,
            "gamma_deg": gamma,
            "space_group": "some",
            **SOURCE,
        },
        "dispersion": {axis: index(n) for axis, n in indices.items()},
        "sources": {"here": {"citation": "An imagined source", "licence": "None"}},
    }
    if optical_class == "uniaxial":
        fields["optic_sign"] = "positive" if indices["e"] > indices["o"] else "negative"
    if optical_class == "biaxial":
        alpha, beta, gamma_axis = sorted(indices, key=lambda axis: indices[axis])
        fields["orientation"] = {"alpha": alpha, "beta": beta, "gamma": gamma_axis, **SOURCE}
        fields["optic_sign"] = "positive"
    return Mineral.model_validate({**fields, **more})


GLASS = {"kind": "glass", "system": "amorphous", "point_group": None, "cell": None, "group": "optical-glass"}
ENTRIES = (
    entry(
        "calcite", "Calcite", "Кальцит", "CaCO3", {"o": 1.658, "e": 1.486},
        group="calcite", appearance={"colours": ["colourless", "white", "yellow"], **SOURCE},
        density={"g_per_cm3": 2.71, **SOURCE}, hardness={"mohs": 3, **SOURCE},
    ),
    entry(
        "corundum", "Corundum", "Корунд", "Al2O3", {"o": 1.768, "e": 1.76},
        density={"g_per_cm3": [3.97, 4.05], **SOURCE}, hardness={"mohs": 9, **SOURCE},
    ),
    entry(
        "ruby", "Ruby", "Рубин", "Al2O3", {"o": 1.768, "e": 1.76},
        variety_of="corundum", appearance={"colours": ["red"], **SOURCE},
        pleochroism={"colours": {"o": "deep red", "e": "orange red"}, "strength": "strong", **SOURCE},
        absorption={
            "sample": "some", "parts": [{"name": "all", "axes": {"o": spectrum("fitted"), "e": spectrum("fitted")}}]
        },
    ),
    entry(
        "schorl", "Schorl", "Шерл", "NaFe3Al6(BO3)3Si6O18(OH)4", {"o": 1.668, "e": 1.639},
        group="tourmaline", appearance={"colours": ["black", "brown"], **SOURCE},
        pleochroism={"colours": {"o": "black"}, "strength": "moderate", **SOURCE},
        absorption={
            "sample": "some", "parts": [{"name": "all", "axes": {"o": spectrum("estimated"), "e": spectrum("fitted")}}]
        },
    ),
    entry(
        "aragonite", "Aragonite", "Арагонит", "CaCO3", {"a": 1.5, "b": 1.503, "c": 1.53},
        pleochroism={"colours": {"alpha": "colourless"}, "strength": "none", **SOURCE},
    ),
    entry("forsterite", "Forsterite", "Форстерит", "Mg2SiO4", {"a": 1.635, "b": 1.651, "c": 1.67}, group="olivine"),
    entry("star-stone", "Star stone", "Звёздный камень", "Mg3(Co,Fe)2", {"n": 1.43}, kind="synthetic"),
    entry("crown", "Crown", "Крон", "borosilicate crown glass", {"n": 1.517}, **GLASS),
)  # fmt: skip
MINERALS = {mineral.id: mineral for mineral in ENTRIES}


def ids(**conditions: Any) -> list[str]:
    return [mineral.id for mineral in find(MINERALS, Query(**conditions))]


@pytest.mark.parametrize(
    ("conditions", "expected"),
    [
        ({}, sorted(MINERALS)),
        # names
        ({"name": "calcite"}, ["calcite"]),
        ({"name": "ALCI"}, ["calcite"]),
        ({"name": "КАЛЬ"}, ["calcite"]),
        ({"name": "tourmaline"}, ["schorl"]),
        ({"name": "Турмалин"}, ["schorl"]),
        ({"name": "corundum"}, ["corundum", "ruby"]),
        ({"name": "корунд"}, ["corundum", "ruby"]),
        ({"name": "звездный"}, ["star-stone"]),
        ({"name": "ЗВЁЗДНЫЙ  камень"}, ["star-stone"]),
        ({"name": "зве\u0308здный"}, ["star-stone"]),  # е and a combining diaeresis, as some systems write it
        ({"name": "star stone"}, ["star-stone"]),
        ({"name": "star-stone"}, ["star-stone"]),
        ({"name": "kryptonite"}, []),
        # formulas
        ({"formula": "CO3"}, ["aragonite", "calcite"]),
        ({"formula": "caco3"}, ["aragonite", "calcite"]),
        ({"formula": "CaCO₃"}, ["aragonite", "calcite"]),
        ({"formula": "Co"}, ["star-stone"]),  # cobalt, not a carbonate
        ({"formula": "Si6 O18"}, ["schorl"]),
        ({"elements": "Ca,C"}, ["aragonite", "calcite"]),
        ({"elements": ("Al", "O")}, ["corundum", "ruby", "schorl"]),
        ({"elements": "c"}, ["aragonite", "calcite"]),
        ({"elements": " b , na"}, ["schorl"]),
        ({"elements": "Co"}, ["star-stone"]),
        # families and kinds
        ({"group": "tourmaline"}, ["schorl"]),
        ({"group": "Турмалины"}, ["schorl"]),
        ({"group": "optical glass"}, ["crown"]),
        ({"group": "tour"}, []),
        ({"kind": "variety"}, ["ruby"]),
        ({"kind": "mineral"}, ["aragonite", "calcite", "corundum", "forsterite", "schorl"]),
        ({"kind": "synthetic"}, ["star-stone"]),
        ({"kind": "glass"}, ["crown"]),
        ({"origin": "own"}, []),
        ({"origin": "built-in"}, sorted(MINERALS)),
        # optics
        ({"system": "orthorhombic"}, ["aragonite", "forsterite"]),
        ({"system": " Amorphous "}, ["crown"]),
        ({"optical_class": "isotropic"}, ["crown", "star-stone"]),
        ({"optic_sign": "positive"}, ["aragonite", "forsterite"]),
        ({"optic_sign": "negative"}, ["calcite", "corundum", "ruby", "schorl"]),
        ({"n_min": 1.65, "n_max": 1.66}, ["calcite", "forsterite"]),  # one index of each lies there
        ({"n_min": 1.6, "n_max": 1.63}, []),  # between the indices of calcite and of no other
        ({"n_min": 1.76}, ["corundum", "ruby"]),
        ({"n_max": 1.486}, ["calcite", "star-stone"]),
        ({"birefringence_min": 0.028, "birefringence_max": 0.031}, ["aragonite", "schorl"]),
        ({"birefringence_max": 0}, ["crown", "star-stone"]),
        # colours and how good the data are
        ({"colour": "white"}, ["calcite"]),
        ({"colour": "RED"}, ["ruby"]),
        ({"pleochroism": "weak"}, ["ruby", "schorl"]),
        ({"pleochroism": "moderate"}, ["ruby", "schorl"]),
        ({"pleochroism": "strong"}, ["ruby"]),
        ({"pleochroism": "none"}, ["aragonite", "crown", "star-stone"]),
        ({"quality": "measured"}, ["ruby"]),
        ({"quality": "estimated,published"}, ["schorl"]),
        ({"quality": "fallback"}, []),
        # all of them at once
        ({"name": "al", "elements": "O", "n_min": 1.7, "optical_class": "uniaxial"}, []),
        ({"name": "cor", "elements": "O", "n_min": 1.7, "colour": "red"}, ["ruby"]),
    ],
)  # fmt: skip
def test_conditions_narrow_the_answer(conditions: dict[str, Any], expected: list[str]) -> None:
    assert ids(**conditions) == expected


@pytest.mark.parametrize(
    ("sort", "expected"),
    [
        ("id", "aragonite calcite corundum crown forsterite ruby schorl star-stone"),
        ("-id", "star-stone schorl ruby forsterite crown corundum calcite aragonite"),
        ("name", "aragonite calcite corundum crown forsterite ruby schorl star-stone"),
        ("name-ru", "aragonite star-stone calcite corundum crown ruby forsterite schorl"),
        ("-name-ru", "schorl forsterite ruby crown corundum calcite star-stone aragonite"),
        ("index", "star-stone aragonite crown calcite forsterite schorl corundum ruby"),
        ("-index", "corundum ruby schorl forsterite calcite crown aragonite star-stone"),
        ("birefringence", "crown star-stone corundum ruby schorl aragonite forsterite calcite"),
        # what is not known stands at the end either way
        ("density", "calcite corundum aragonite crown forsterite ruby schorl star-stone"),
        ("-density", "corundum calcite aragonite crown forsterite ruby schorl star-stone"),
        ("hardness", "calcite corundum aragonite crown forsterite ruby schorl star-stone"),
        ("-2v", "forsterite aragonite calcite corundum crown ruby schorl star-stone"),
        ("2v", "aragonite forsterite calcite corundum crown ruby schorl star-stone"),
        ("-birefringence,-id", "calcite forsterite aragonite schorl ruby corundum star-stone crown"),
    ],
)
def test_answers_have_their_order(sort: str, expected: str) -> None:
    assert ids(sort=sort) == expected.split()
    backwards = dict(reversed(MINERALS.items()))
    assert [mineral.id for mineral in find(backwards, Query(sort=tuple(sort.split(","))))] == expected.split()


def test_every_fault_is_named_at_once() -> None:
    with pytest.raises(ValidationError) as caught:
        Query.model_validate(
            {
                "name": "  ",
                "elements": "CO",
                "system": "cubist",
                "optic_sign": "negative",
                "n_min": "low",
                "birefringence_min": 0.2,
                "birefringence_max": 0.1,
                "colour": "ultraviolet",
                "quality": "published,fallback",
                "sort": "colour",
                "weight": 3,
            }
        )
    faulty = {str(fault["loc"][0]) for fault in caught.value.errors()}
    assert faulty == {
        "name", "elements", "system", "n_min", "birefringence_max", "colour", "quality", "sort", "weight",
    }  # fmt: skip


@pytest.mark.parametrize(
    "conditions",
    [
        {"n_min": float("nan")},
        {"n_max": float("inf")},
        {"n_min": 0},
        {"n_min": 1.7, "n_max": 1.6},
        {"birefringence_min": -0.1},
        {"quality": "measured,none"},
        {"elements": "Xx"},
        {"elements": ""},
        {"sort": ""},
        {"sort": "--id"},
        {"name": ""},
        {"name": "x" * 201},
    ],
)
def test_a_bad_condition_is_refused(conditions: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        Query(**conditions)


def test_an_index_that_is_refused_at_the_d_line_hides_no_mineral() -> None:
    infrared = {**index(2.4), "wavelengths_nm": [1000, 1500, 2000], "range_nm": [1000, 2000], "outside_range": "refuse"}
    stone = entry("dark", "Dark", "Тёмный", "PbS", {"n": 2.4}, dispersion={"n": infrared})
    minerals = {**MINERALS, "dark": stone}
    assert dict(facts(stone).indices) == {}
    assert [mineral.id for mineral in find(minerals, Query(sort=("index",)))][-1] == "dark"
    assert "dark" not in [mineral.id for mineral in find(minerals, Query(n_min=1))]
    assert "dark" in [mineral.id for mineral in find(minerals, Query(birefringence_max=0))]


def test_facts_say_whether_the_d_line_lies_outside_a_curve() -> None:
    red = {**index(2.4), "wavelengths_nm": [600, 650, 700], "range_nm": [600, 700]}
    told = facts(entry("red", "Red", "Красный", "HgS", {"n": 2.4}, dispersion={"n": red}))
    assert (told.clamped, told.indices) == (True, {"n": 2.4})
    assert not any(facts(mineral).clamped for mineral in ENTRIES)


def test_facts_are_those_of_the_indices() -> None:
    calcite, aragonite = facts(MINERALS["calcite"]), facts(MINERALS["aragonite"])
    assert calcite.indices == {"o": 1.658, "e": 1.486}
    assert calcite.birefringence == pytest.approx(0.172, abs=1e-12)
    assert calcite.mean_index == pytest.approx((2 * 1.658 + 1.486) / 3, abs=1e-12)
    assert (calcite.two_v_deg, calcite.density_g_per_cm3, calcite.hardness_mohs) == (None, (2.71, 2.71), (3, 3))
    assert aragonite.mean_index == pytest.approx(1.511, abs=1e-12)
    # tan² V_γ = (β − α)/(γ − β) where the indices differ little.
    assert aragonite.two_v_deg == pytest.approx(2 * math.degrees(math.atan(math.sqrt(0.003 / 0.027))), abs=1)
    assert facts(MINERALS["crown"]).birefringence == 0


def test_every_group_of_the_data_has_its_names() -> None:
    used = {mineral.group for mineral in minerals_db.minerals().values() if mineral.group is not None}
    assert used <= set(GROUPS)
    for names in GROUPS.values():
        assert names.en.isascii()
        assert any("а" <= letter <= "я" for letter in names.ru.lower())


def test_facts_of_the_data_are_those_of_the_indicatrix() -> None:
    for mineral in minerals_db.minerals().values():
        told = facts(mineral)
        assert told.birefringence == birefringence(mineral, SODIUM_D_NM)
        assert (told.two_v_deg is None) == (mineral.optical_class != "biaxial")
        assert math.isnan(two_v_deg(mineral, SODIUM_D_NM)) or told.two_v_deg == two_v_deg(mineral, SODIUM_D_NM)


def test_the_data_are_found_by_what_they_are() -> None:
    """Every mineral answers to each of its own properties, and the parts of every division are the whole."""
    minerals = minerals_db.minerals()
    for mineral in minerals.values():
        for conditions in (
            {"name": mineral.names.en},
            {"name": mineral.names.ru.upper()},
            {"formula": mineral.formula},
            {"group": mineral.group} if mineral.group else {},
            {"kind": "variety" if mineral.variety_of else mineral.kind},
            {"n_min": min(facts(mineral).indices.values()), "n_max": max(facts(mineral).indices.values())},
        ):
            assert mineral in find(minerals, Query.model_validate(conditions)), (mineral.id, conditions)
    for field in ("system", "optical_class", "kind"):
        annotation = Query.model_fields[field].annotation
        choices = [value for value in _literals(annotation) if isinstance(value, str)]
        parts = [find(minerals, Query.model_validate({field: choice})) for choice in choices]
        assert sorted(mineral.id for mineral in itertools.chain(*parts)) == list(minerals)


def _literals(annotation: Any) -> list[object]:
    found: list[object] = []
    for part in get_args(annotation):
        found += _literals(part) if get_args(part) else [part]
    return found


@given(st.permutations(SORT_KEYS), st.lists(st.booleans(), min_size=len(SORT_KEYS), max_size=len(SORT_KEYS)))
def test_an_order_loses_nothing(keys: list[str], turned: list[bool]) -> None:
    sort = [f"-{key}" if back else key for key, back in zip(keys, turned, strict=True)]
    assert sorted(ids(sort=sort)) == sorted(MINERALS)
