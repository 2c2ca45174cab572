"""Chemical formulas as mineralogists write them: which elements stand in one."""

from __future__ import annotations

import re
import unicodedata

__all__ = ["ELEMENTS", "elements_of", "plain_formula"]

ELEMENTS: frozenset[str] = frozenset({
    "H", "He", "Li", "Be", "B", "C", "N", "O", "F", "Ne", "Na", "Mg", "Al", "Si", "P", "S", "Cl", "Ar", "K", "Ca",
    "Sc", "Ti", "V", "Cr", "Mn", "Fe", "Co", "Ni", "Cu", "Zn", "Ga", "Ge", "As", "Se", "Br", "Kr", "Rb", "Sr", "Y",
    "Zr", "Nb", "Mo", "Tc", "Ru", "Rh", "Pd", "Ag", "Cd", "In", "Sn", "Sb", "Te", "I", "Xe", "Cs", "Ba", "La", "Ce",
    "Pr", "Nd", "Pm", "Sm", "Eu", "Gd", "Tb", "Dy", "Ho", "Er", "Tm", "Yb", "Lu", "Hf", "Ta", "W", "Re", "Os", "Ir",
    "Pt", "Au", "Hg", "Tl", "Pb", "Bi", "Po", "At", "Rn", "Fr", "Ra", "Ac", "Th", "Pa", "U", "Np", "Pu", "Am", "Cm",
    "Bk", "Cf", "Es", "Fm", "Md", "No", "Lr", "Rf", "Db", "Sg", "Bh", "Hs", "Mt", "Ds", "Rg", "Cn", "Nh", "Fl", "Mc",
    "Lv", "Ts", "Og",
})  # fmt: skip
"""Symbols of the elements (IUPAC, 118)."""

_TOKEN = re.compile(
    r"""
    (?P<element>[A-Z][a-z]?)
    | \^?\d*[+-](?![\d.])         # a charge, as in Fe3+ or Fe^2+
    | \d+(?:\.\d+)?(?:-\d+(?:\.\d+)?)?  # how many, perhaps a range
    | \.\d+
    | [xyzn](?![a-z])             # how many, left open
    | (?P<bracket>[()\[\]{}])
    | [,·*.:;/±+-]                # between what may stand for each other, and before water
    | □                           # an empty place of the structure
    | [α-ω]-                      # which of several structures
    """,
    re.VERBOSE,
)
_CLOSES = {")": "(", "]": "[", "}": "{"}
_DOTS = str.maketrans(dict.fromkeys("∙•⋅・×", "·") | dict.fromkeys("‐‑‒–—−", "-"))


def plain_formula(text: str) -> str:
    """Return a formula in one way of writing: no blanks, no subscripts or superscripts, one kind of dot and dash."""
    # Dots first: compatibility forms would make letters and blanks of some.
    return "".join(unicodedata.normalize("NFKC", text.translate(_DOTS)).translate(_DOTS).split())


def elements_of(formula: str) -> frozenset[str]:
    """Return the elements that a formula holds.

    Parameters
    ----------
    formula : str
        Such as ``Ca5(PO4)3F``, ``(Mg,Fe)2SiO4``, ``CaSO4·2H2O``, ``Fe2+Fe3+2O4`` or ``□[Al2Si4O10](OH)2``;
        subscripts may be characters of their own.

    Returns
    -------
    frozenset of str
        Their symbols. Empty where the text is no formula, such as ``borosilicate crown glass``.
    """
    text = plain_formula(formula)
    found: set[str] = set()
    open_brackets: list[str] = []
    place = 0
    while place < len(text):
        token = _TOKEN.match(text, place)
        if token is None:
            return frozenset()
        place = token.end()
        if bracket := token["bracket"]:
            if bracket not in _CLOSES:
                open_brackets.append(bracket)
            elif not open_brackets or open_brackets.pop() != _CLOSES[bracket]:
                return frozenset()
        elif symbol := token["element"]:
            if symbol not in ELEMENTS:  # an element of one letter and a number left open, as in Cx
                if symbol[0] not in ELEMENTS or symbol[1:] not in ("x", "y", "z", "n"):
                    return frozenset()
                symbol = symbol[0]
            found.add(symbol)
    return frozenset() if open_brackets else frozenset(found)
