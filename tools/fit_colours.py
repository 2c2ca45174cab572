"""Find absorption coefficients that give the published colours of a crystal: the `absorption` blocks marked estimated.

    python tools/fit_colours.py [ID ...]

prints the block of each recipe of colour_recipes.yaml (all of them if no id is given) as it stands in the mineral's
file, and on standard error how well the colours are met.

**What is known** of such a mineral: where its bands lie, along which axis they are strong, and what colour a crystal of
some thickness has in light that vibrates along each axis. **What is sought** are the peaks p ≥ 0 of the bands (and the
plateaus of the edges), with centres and widths held, so that light of D65 behind d mm, exp(−α d), α = Σ p s(ν), looks
to the CIE 1931 2° observer as the named colour does. Minimised is Σ ΔE² over the colours (CIELAB, white D65; CIE
015:2018, section 8.2.1) plus 0.25 Σ (p d)², which keeps bands small that no colour asks for. The named colours are
centroids of the ISCC-NBS system: K. L. Kelly, D. B. Judd, Color: universal language and dictionary of names, NBS
Special Publication 440 (1976), in sRGB.
"""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray
from scipy.optimize import least_squares

from crystal_core.spectra.colour import D65_WHITE_XYZ, decode_srgb, linear_srgb_to_xyz
from crystal_core.spectra.illuminants import d65
from crystal_core.spectra.observer import colour_matching

RECIPES = Path(__file__).with_name("colour_recipes.yaml")

WAVELENGTHS_NM = np.arange(380.0, 781.0, 2.0)
RANGE_NM = (380, 780)

PENALTY = 0.5
"""ΔE that an optical depth of 1 in one band costs."""

DIGITS = 3
"""Significant digits of a peak: more than an estimate deserves, enough that rounding changes no colour."""

Real = NDArray[np.float64]


@dataclass(frozen=True)
class Goal:
    """A colour through a thickness: CIELAB, shape (3,)."""

    mm: float
    colour: str
    lab: Real


@dataclass(frozen=True)
class Match:
    """What a recipe led to: the peaks by (part, axis, term), and ΔE by axis and goal."""

    peaks: Mapping[tuple[str, str, str], float]
    differences: Mapping[str, Sequence[float]]


def lab_of_xyz(xyz: Real) -> Real:
    """Return CIELAB, shape (..., 3), of tristimulus values with Y = 1 for white D65 (CIE 015:2018, section 8.2.1)."""
    ratio = xyz / np.array(D65_WHITE_XYZ)
    f = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio * (29 / 6) ** 2 / 3 + 4 / 29)
    return np.stack((116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])), axis=-1)


def lab_of_hex(colour: str) -> Real:
    """Return CIELAB, shape (3,), of an sRGB colour "rrggbb"."""
    encoded = np.array([int(colour[place : place + 2], 16) for place in (0, 2, 4)]) / 255.0
    return lab_of_xyz(linear_srgb_to_xyz(decode_srgb(encoded)))


def lab_through(per_mm: Real, mm: float) -> Real:
    """Return CIELAB, shape (3,), of D65 behind a thickness of coefficients at `WAVELENGTHS_NM`."""
    weights = d65(WAVELENGTHS_NM) * colour_matching(WAVELENGTHS_NM)
    passed = (weights * np.exp(-per_mm * mm)).sum(axis=1) / weights.sum(axis=1)
    return lab_of_xyz(passed * np.array(D65_WHITE_XYZ))


def shape_of(term: Mapping[str, Any]) -> Real:
    """Return a band or edge of peak 1 at `WAVELENGTHS_NM`; the formulas of `minerals_db.absorption`."""
    wavenumber = 1e7 / WAVELENGTHS_NM
    if "edge_per_cm" in term:
        return np.asarray(np.exp(np.minimum(wavenumber - term["edge_per_cm"], 0.0) / term["width_per_cm"]))
    offset = 2.0 * (wavenumber - term["centre_per_cm"]) / term["fwhm_per_cm"]
    return np.asarray(np.exp2(-offset * offset))


def match(recipe: Mapping[str, Any], colours: Mapping[str, str]) -> Match:
    """Find the peaks of a recipe.

    Parameters
    ----------
    recipe : mapping
        An entry of colour_recipes.yaml.
    colours : mapping of str to str
        Names of colours and their sRGB, "rrggbb".

    Returns
    -------
    Match
        The peaks are rounded to three digits, and the differences are those of the rounded peaks.
    """
    goals = {
        axis: [Goal(goal["mm"], goal["colour"], lab_of_hex(colours[goal["colour"]])) for goal in wanted]
        for axis, wanted in recipe["goals"].items()
    }
    shapes = {name: shape_of(term) for name, term in recipe["terms"].items()}
    # A part that is alike along all axes has one unknown for each of its terms, any other one for each axis as well.
    unknowns: dict[tuple[str, str, str], list[tuple[str, str, str]]] = {}
    for part in recipe["parts"]:
        for axis, terms in part["axes"].items():
            for term in terms:
                one = (part["name"], "all" if part.get("alike") else axis, term)
                unknowns.setdefault(one, []).append((part["name"], axis, term))
    users = list(unknowns.values())
    depth = np.array([goals[places[0][1]][0].mm for places in users])

    def spectra(peaks: Real) -> dict[str, Real]:
        total = {axis: np.zeros_like(WAVELENGTHS_NM) for axis in goals}
        for peak, places in zip(peaks, users, strict=True):
            for _, axis, term in places:
                total[axis] += peak * shapes[term]
        return total

    def residuals(depths: Real) -> Real:
        total = spectra(depths / depth)
        missed = [lab_through(total[axis], goal.mm) - goal.lab for axis, wanted in goals.items() for goal in wanted]
        return np.concatenate((*missed, PENALTY * depths))

    found = least_squares(residuals, np.full(len(users), 0.5), bounds=(0.0, np.inf), xtol=1e-12, ftol=1e-12)
    peaks = np.array([float(f"{peak:.{DIGITS}g}") if peak > 1e-4 else 0.0 for peak in found.x / depth])
    total = spectra(peaks)
    return Match(
        {place: float(peak) for peak, places in zip(peaks, users, strict=True) for place in places},
        {
            axis: [float(np.linalg.norm(lab_through(total[axis], goal.mm) - goal.lab)) for goal in wanted]
            for axis, wanted in goals.items()
        },
    )


def _folded(key: str, text: str, indent: int) -> list[str]:
    """Return a field of text, folded where it does not fit into a line."""
    margin = " " * indent
    plain = ": " not in text and " #" not in text and text[0] not in "[]{}&*!|>'\"%@`-?,"
    if plain and indent + len(key) + 2 + len(text) <= 120:
        return [f"{margin}{key}: {text}"]
    width = 120 - indent - 2
    folded = textwrap.wrap(text, width, break_on_hyphens=False, break_long_words=False)
    return [f"{margin}{key}: >-", *(f"{margin}  {line}" for line in folded)]


def _flow(fields: Mapping[str, Any]) -> str:
    """Return a mapping in one line of YAML."""
    line: str = yaml.safe_dump(dict(fields), default_flow_style=True, sort_keys=False, allow_unicode=True, width=1000)
    return line.strip()


def _curve(recipe: Mapping[str, Any], part: Mapping[str, Any], axis: str, matched: Match) -> list[str]:
    """Return the lines of one curve."""
    bands, edges = [], []
    names = part["axes"][axis]
    # A band that no colour asks for is left out, unless nothing at all absorbs.
    for name in [name for name in names if matched.peaks[part["name"], axis, name] > 0.0] or names[:1]:
        term = {key: value for key, value in recipe["terms"][name].items() if key != "assignment"}
        peak = matched.peaks[part["name"], axis, name]
        assignment = recipe["terms"][name].get("assignment")
        told = {"assignment": assignment} if assignment else {}
        if "edge_per_cm" in term:
            edges.append({**term, "plateau_per_mm": peak, **told})
        else:
            bands.append({"shape": "gaussian", **term, "peak_per_mm": peak, **told})
    lines = [f"        {axis}:", "          model: bands"]
    for field, terms in (("bands", bands), ("edges", edges)):
        if terms:
            lines += [f"          {field}:", *(f"            - {_flow(term)}" for term in terms)]
    lines += [f"          range_nm: {list(RANGE_NM)}", f"          source: {recipe['source']}"]
    return [*lines, "          status: estimated"]


def _note(recipe: Mapping[str, Any], axis: str, matched: Match) -> str:
    """Return what was matched along an axis, in words."""
    reached = ", ".join(
        f"{goal['colour']} through {goal['mm']:g} mm (ΔE {difference:.0f})"
        for goal, difference in zip(recipe["goals"][axis], matched.differences[axis], strict=True)
    )
    published = "; ".join(goal["published"] for goal in recipe["goals"][axis])
    return f"Matched: {published}; taken as {reached}."


def block(recipe: Mapping[str, Any], matched: Match) -> str:
    """Return the `absorption` block of a recipe, YAML in the style of the data files."""
    lines = ["absorption:", *_folded("sample", recipe["sample"], 2)]
    if recipe.get("chromophores"):
        lines.append("  chromophores:")
        for key, fields in recipe["chromophores"].items():
            lines.append(f"    {key}:")
            for field, value in fields.items():
                lines += _folded(field, value, 6) if isinstance(value, str) else [f"      {field}: {value}"]
    lines.append("  parts:")
    told: set[str] = set()
    for part in recipe["parts"]:
        lines.append(f"    - name: {part['name']}")
        if part.get("proportional_to"):
            lines.append(f"      proportional_to: [{', '.join(part['proportional_to'])}]")
        lines.append("      axes:")
        for axis in part["axes"]:
            lines += _curve(recipe, part, axis, matched)
            if axis not in told:  # once for each axis, and what holds for all of them with the first
                words = [_note(recipe, axis, matched), *(() if told else (recipe["note"].strip(),))]
                lines += _folded("note", " ".join(words), 10)
                told.add(axis)
    return "\n".join(lines) + "\n"


def main(ids: Sequence[str]) -> None:
    """Print the blocks of the recipes named."""
    content = yaml.safe_load(RECIPES.read_text(encoding="utf-8"))
    for name in ids or content["recipes"]:
        matched = match(content["recipes"][name], content["colours"])
        for axis, differences in matched.differences.items():
            print(f"{name} {axis}: ΔE {', '.join(f'{value:.1f}' for value in differences)}", file=sys.stderr)
        print(f"# {name}.yaml\n{block(content['recipes'][name], matched)}")


if __name__ == "__main__":
    main(sys.argv[1:])
