"""The elements that stand in a formula."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import minerals_db
from minerals_db.chemistry import ELEMENTS, elements_of


@pytest.mark.parametrize(
    ("formula", "elements"),
    [
        ("C", "C"),
        ("CaCO3", "C Ca O"),
        ("CoCO3", "C Co O"),
        ("Ca5(PO4)3F", "Ca F O P"),
        ("(Mg,Fe)2SiO4", "Fe Mg O Si"),
        ("CaSO4·2H2O", "Ca H O S"),
        ("CaSO4*2H2O", "Ca H O S"),
        ("Cu5(SiO3)4(OH)2·3-5H2O", "Cu H O Si"),
        ("SiO2·nH2O", "H O Si"),
        ("Fe2+Fe3+2O4", "Fe O"),
        ("(Ca,Na)(Mg,Fe^2+,Al)(Si,Al)2O6", "Al Ca Fe Mg Na O Si"),
        ("□[Al2Si4O10](OH)2", "Al H O Si"),
        ("Na(Li1.5Al1.5)Al6Si6O18(BO3)3(OH)4", "Al B H Li Na O Si"),
        ("Ca₅(PO₄)₃(F,Cl,OH)", "Ca Cl F H O P"),
        ("Fe1-xS", "Fe S"),
        ("Cx", "C"),
        ("β-BaB2O4", "B Ba O"),
        ("{Ca3}[Al2](Si3)O12", "Al Ca O Si"),
        # no formulas
        ("borosilicate crown glass", ""),
        ("YAG", ""),
        ("Ca(OH", ""),
        ("Ca(OH]2", ""),
        ("CaCO3 and some water", ""),
        ("", ""),
    ],
)
def test_elements_of_a_formula(formula: str, elements: str) -> None:
    assert elements_of(formula) == set(elements.split())


@given(st.lists(st.sampled_from(sorted(ELEMENTS)), min_size=1, max_size=6), st.data())
def test_every_element_is_found_however_it_is_put(symbols: list[str], data: st.DataObject) -> None:
    text = ""
    for symbol in symbols:
        count = data.draw(st.sampled_from(["", "2", "12", "1.5", "x"]))
        shape = data.draw(st.sampled_from(["{}{}", "({}){}", "[{}]{}·", "({},O){}"]))
        text += shape.format(symbol, count)
    found = elements_of(text)
    assert found >= set(symbols)
    assert found <= {*symbols, "O"}


@given(st.text(max_size=30))
def test_any_text_is_read_without_an_error(text: str) -> None:
    assert elements_of(text) <= ELEMENTS


def test_every_formula_of_the_data_is_read() -> None:
    unread = [
        mineral.id
        for mineral in minerals_db.minerals().values()
        if mineral.kind != "glass" and not elements_of(mineral.formula)
    ]
    assert unread == []
