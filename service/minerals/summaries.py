"""A mineral in a few words and numbers, as JSON and as a row of a table."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from minerals_db import Mineral
from minerals_db.facts import Facts, facts
from minerals_db.indicatrix import SODIUM_D_NM
from minerals_db.quality import colour_quality, dispersion_quality

__all__ = ["COLUMNS", "derived", "entry_document", "summary", "summary_rows"]

_INDEX_DIGITS, _ANGLE_DIGITS = 6, 2

COLUMNS = (
    "id", "name_en", "name_ru", "kind", "variety_of", "group", "formula", "system", "point_group", "optical_class",
    "optic_sign", "n", "n_o", "n_e", "n_alpha", "n_beta", "n_gamma", "clamped", "birefringence", "two_v_deg",
    "density_min_g_per_cm3", "density_max_g_per_cm3", "hardness_min_mohs", "hardness_max_mohs", "colours",
    "pleochroism", "dispersion_quality", "colour_quality", "origin",
)  # fmt: skip
"""Of the table of minerals; indices (n, n_o …), birefringence and two_v_deg are those at 589.3 nm."""


def derived(mineral: Mineral, numbers: Facts | None = None) -> dict[str, Any]:
    """Return what follows from an entry: indices at the D line, birefringence, 2V; quality and origin of its data.

    Indices stand under the names of their curves beside ``wavelength_nm``; there are none where a curve refuses the D
    line, and ``clamped`` where it lies outside a curve's range, whose nearer end then stands for it. ``two_v_deg`` is
    the acute angle, null unless the mineral is biaxial.
    """
    numbers = numbers or facts(mineral)
    return {
        "indices": {
            "wavelength_nm": SODIUM_D_NM,
            **{axis: round(n, _INDEX_DIGITS) for axis, n in numbers.indices.items()},
        },
        "clamped": numbers.clamped,
        "birefringence": _rounded(numbers.birefringence, _INDEX_DIGITS),
        "two_v_deg": _rounded(numbers.two_v_deg, _ANGLE_DIGITS),
        "quality": {"dispersion": dispersion_quality(mineral), "colour": colour_quality(mineral)},
        "origin": mineral.origin,
    }


def summary(mineral: Mineral) -> dict[str, Any]:
    """Return a mineral shortly, as a JSON object."""
    numbers = facts(mineral)
    return {
        "id": mineral.id,
        "names": mineral.names.model_dump(),
        "kind": mineral.kind,
        "variety_of": mineral.variety_of,
        "group": mineral.group,
        "formula": mineral.formula,
        "system": mineral.system,
        "point_group": mineral.point_group,
        "optical_class": mineral.optical_class,
        "optic_sign": mineral.optic_sign,
        "density_g_per_cm3": numbers.density_g_per_cm3,
        "hardness_mohs": numbers.hardness_mohs,
        "colours": [] if mineral.appearance is None else list(mineral.appearance.colours),
        "pleochroism": None if mineral.pleochroism is None else mineral.pleochroism.strength,
        **derived(mineral, numbers),
    }


def entry_document(mineral: Mineral) -> dict[str, Any]:
    """Return a mineral's whole entry with what follows from it, as a JSON object."""
    return {**mineral.model_dump(mode="json"), **derived(mineral)}


def summary_rows(minerals: Iterable[Mineral]) -> list[dict[str, object]]:
    """Return a row for each mineral, by the names in `COLUMNS`; what is not known is None."""
    return [_row(summary(mineral), facts(mineral)) for mineral in minerals]


def _row(told: Mapping[str, Any], numbers: Facts) -> dict[str, object]:
    n = {axis: value for axis, value in told["indices"].items() if axis != "wavelength_nm"}
    rising = sorted(n.values())
    if len(rising) == 3:  # whatever the curves are called, a table has them by size
        n = dict(zip(("alpha", "beta", "gamma"), rising, strict=True))
    density, hardness = numbers.density_g_per_cm3, numbers.hardness_mohs
    return {
        "name_en": told["names"]["en"],
        "name_ru": told["names"]["ru"],
        **{key: told[key] for key in COLUMNS if key in told},
        "n": n.get("n"),
        **{f"n_{axis}": n.get(axis) for axis in ("o", "e", "alpha", "beta", "gamma")},
        "density_min_g_per_cm3": None if density is None else density[0],
        "density_max_g_per_cm3": None if density is None else density[1],
        "hardness_min_mohs": None if hardness is None else hardness[0],
        "hardness_max_mohs": None if hardness is None else hardness[1],
        "colours": " ".join(told["colours"]),
        "dispersion_quality": told["quality"]["dispersion"],
        "colour_quality": told["quality"]["colour"],
    }


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None else round(value, digits)
