"""One mineral for people: its optics in a table, and every record of its entry with status and source."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from pydantic import BaseModel

from minerals_db.fields import Known
from minerals_db.groups import GROUPS
from service.commands.complaint import one_line
from service.commands.output import print_text
from service.minerals.summaries import derived

if TYPE_CHECKING:
    from minerals_db import Mineral
    from service.minerals.optics import MineralOptics

__all__ = ["print_page"]

_WIDTH = 110
_IN_HEAD = {
    "id", "names", "kind", "variety_of", "group", "formula", "system", "point_group", "optical_class", "optic_sign",
    "ima_status", "strunz", "sources",
}  # fmt: skip
"""Fields that the head tells, or the end."""

_RANGES = {"range_nm", "g_per_cm3", "mohs", "two_v_deg"}
"""Fields that hold the ends of a range."""


def print_page(optics: MineralOptics) -> None:
    """Print a page about a mineral and its optics at some wavelengths."""
    mineral = optics.mineral
    lines = [*_head(mineral), "", *_optics(optics), ""]
    for field in type(mineral).model_fields:
        if field not in _IN_HEAD:
            lines += _told(field, getattr(mineral, field), "")
    lines += ["", "sources"]
    for key, source in mineral.sources.items():
        where = f" doi:{source.doi}" if source.doi else f" {source.url}" if source.url else ""
        lines += _wrapped(f"{key}: {source.citation}{where} ({source.licence})", "  ")
    print_text("\n".join(map(one_line, lines)))


def _head(mineral: Mineral) -> Iterator[str]:
    facts = derived(mineral)
    yield f"{mineral.names.en} · {mineral.names.ru} · {mineral.formula}"
    kind = [mineral.kind, f"variety of {mineral.variety_of}" if mineral.variety_of else "", _group(mineral)]
    kind += [f"IMA: {mineral.ima_status}" if mineral.ima_status else ""]
    kind += [f"Strunz {mineral.strunz}" if mineral.strunz else ""]
    yield ", ".join(filter(None, kind))
    symmetry = [
        mineral.system,
        mineral.point_group or "",
        f"{mineral.optical_class} {mineral.optic_sign or ''}".strip(),
    ]
    yield ", ".join(filter(None, symmetry))
    quality = facts["quality"]
    yield f"{mineral.origin} entry; dispersion {quality['dispersion']}, colour {quality['colour']}"
    n = {axis: value for axis, value in facts["indices"].items() if axis != "wavelength_nm"}
    told = [f"n_{axis} {value:.4f}" for axis, value in n.items()]
    if facts["birefringence"] is not None:
        told.append(f"birefringence {facts['birefringence']:.4f}")
    if facts["two_v_deg"] is not None:
        told.append(f"2V {facts['two_v_deg']:.1f}°")
    yield f"at {facts['indices']['wavelength_nm']} nm{'*' if facts['clamped'] else ''}: {', '.join(told)}"


def _group(mineral: Mineral) -> str:
    names = GROUPS.get(mineral.group or "")
    return f"{names.en} ({names.ru})" if names is not None else mineral.group or ""


def _optics(optics: MineralOptics) -> Iterator[str]:
    """Yield a table: a row for each wavelength, absorption in mm⁻¹, * where a value was taken from a curve's end."""
    if optics.weight_percent:
        told = ", ".join(f"{key} {percent:g} weight %" for key, percent in optics.weight_percent.items())
        yield f"absorption for {told}"
    absorption = optics.absorption_per_mm or {}
    heads = ["nm", *(f"n_{axis}" for axis in optics.indices), *(f"group n_{axis}" for axis in optics.group_indices)]
    heads += ["birefringence", "2V", "sign", *(f"absorption {axis} /mm" for axis in absorption)]
    rows = [heads]
    for row in optics.document()["optics"]:
        cells = [f"{row['wavelength_nm']:g}{'*' if row['clamped'] else ''}"]
        cells += [f"{n:.5f}" for n in (*row["indices"].values(), *row["group_indices"].values())]
        cells += [f"{row['birefringence']:.5f}", "" if row["two_v_deg"] is None else f"{row['two_v_deg']:.2f}°"]
        cells += [row["optic_sign"] or "", *(f"{a:.4g}" for a in (row["absorption_per_mm"] or {}).values())]
        rows.append(cells)
    used = [place for place in range(len(heads)) if any(row[place] for row in rows[1:])]
    widths = {place: max(len(row[place]) for row in rows) for place in used}
    for row in rows:
        yield "  ".join(row[place].rjust(widths[place]) for place in used).rstrip()
    if optics.clamped.any() or derived(optics.mineral)["clamped"]:
        yield "* outside the range of a curve: its value at the nearer end"


def _told(label: str, value: object, indent: str) -> Iterator[str]:
    """Yield the lines that tell a field's value: records with their status and source, whatever they hold."""
    if value is None or value == () or value == {}:
        return
    if isinstance(value, Known):
        numbers = {name: part for name, part in _fields(value) if name not in ("source", "status", "note")}
        flat = {name: part for name, part in numbers.items() if not _holds_records(part)}
        text = ", ".join(f"{name} {_range(part) if name in _RANGES else _plain(part)}" for name, part in flat.items())
        yield from _wrapped(f"{label}: {text} [{value.status}, {value.source}]", indent)
        if value.note is not None:
            yield from _wrapped(value.note, f"{indent}    ")
        for name, part in numbers.items():
            if name not in flat:
                yield from _told(name, part, f"{indent}  ")
    elif isinstance(value, BaseModel):
        yield f"{indent}{label}"
        for name, part in _fields(value):
            yield from _told(name, part, f"{indent}  ")
    elif isinstance(value, Mapping) and _holds_records(value):
        yield f"{indent}{label}"
        for name, part in value.items():
            yield from _told(str(name), part, f"{indent}  ")
    elif isinstance(value, Sequence) and _holds_records(value):
        for part in value:
            yield from _told(label, part, indent)
    else:
        yield from _wrapped(f"{label}: {_plain(value)}", indent)


def _fields(record: BaseModel) -> list[tuple[str, object]]:
    """Return what the file says of a record, the kind of a curve first; no defaults."""
    names = sorted(filter(record.model_fields_set.__contains__, type(record).model_fields), key="model".__ne__)
    return [(name, value) for name in names if (value := getattr(record, name)) is not None]


def _holds_records(value: object) -> bool:
    """Tell whether a value is or holds records that say where they come from, or are made of such."""
    if isinstance(value, Known):
        return True
    if isinstance(value, BaseModel):
        return any(_holds_records(part) for _, part in _fields(value))
    if isinstance(value, Mapping):
        return any(map(_holds_records, value.values()))
    return isinstance(value, Sequence) and not isinstance(value, str) and any(map(_holds_records, value))


def _plain(value: object) -> str:
    """Return a value in words: numbers as they stand in the file."""
    if isinstance(value, float):
        return f"{value:g}" if abs(value) >= 1e16 else repr(int(value)) if value.is_integer() else repr(value)
    if isinstance(value, BaseModel):
        return " ".join(f"{name} {_plain(part)}" for name, part in _fields(value))
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_plain(part)}" for name, part in value.items())
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"({', '.join(map(_plain, value))})"
    return str(value)


def _range(value: object) -> str:
    """Return a range in words: one number where its ends are equal."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        return _plain(value)
    return "–".join(dict.fromkeys(map(_plain, value)))


def _wrapped(text: str, indent: str) -> list[str]:
    return textwrap.wrap(text, _WIDTH, initial_indent=indent, subsequent_indent=f"{indent}    ", break_long_words=False)
