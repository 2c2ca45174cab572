"""A list of minerals for people: a table on a terminal, aligned text in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from minerals_db.facts import facts
from minerals_db.quality import colour_quality, dispersion_quality
from service.commands.complaint import one_line
from service.commands.output import print_text

if TYPE_CHECKING:
    from minerals_db import Mineral

__all__ = ["print_list"]

_HEADS = ("id", "name", "название", "system", "optics", "n", "δ", "2V", "dispersion", "colour")
_SIGNS = {"positive": "+", "negative": "−"}
_SPARED = ("название", "name", "system")
"""Columns that a narrow terminal does without, in this order: the id says nearly as much."""


def print_list(minerals: Sequence[Mineral]) -> None:
    """Print a line for each mineral, with its optics at 589.3 nm."""
    rows = [[one_line(cell) for cell in _cells(mineral)] for mineral in minerals]
    if not sys.stdout.isatty():
        _print_plain(rows)
        return
    from rich.console import Console
    from rich.table import Table

    console = Console(markup=False, highlight=False)
    shown = _that_fit(rows, console.width)
    table = Table(box=None, header_style="bold", pad_edge=False)
    for head in shown:
        table.add_column(head, justify="right" if head in ("δ", "2V") else "left", overflow="fold")
    for row in rows:
        table.add_row(*(cell for head, cell in zip(_HEADS, row, strict=True) if head in shown))
    console.print(table)
    print_text(f"{len(rows)} {'mineral' if len(rows) == 1 else 'minerals'}")


def _that_fit(rows: Sequence[Sequence[str]], width: int) -> list[str]:
    """Return the heads of the columns for which a terminal of some width has room."""
    widths = {head: max(map(len, column)) for head, column in zip(_HEADS, zip(_HEADS, *rows, strict=True), strict=True)}
    shown = list(_HEADS)
    for head in _SPARED:
        if sum(widths[kept] + 2 for kept in shown) - 2 > width:
            shown.remove(head)
    return shown


def _cells(mineral: Mineral) -> tuple[str, ...]:
    numbers = facts(mineral)
    n = sorted(numbers.indices.values())
    return (
        mineral.id,
        mineral.names.en,
        mineral.names.ru,
        mineral.system,
        f"{mineral.optical_class} {_SIGNS.get(mineral.optic_sign or '', '')}".rstrip(),
        ""
        if not n
        else "–".join(f"{end:.4f}" for end in dict.fromkeys((n[0], n[-1]))) + ("*" if numbers.clamped else ""),
        "" if numbers.birefringence is None else f"{numbers.birefringence:.4f}",
        "" if numbers.two_v_deg is None else f"{numbers.two_v_deg:.0f}°",
        dispersion_quality(mineral),
        colour_quality(mineral),
    )


def _print_plain(rows: Sequence[Sequence[str]]) -> None:
    lines = [_HEADS, *rows]
    widths = [max(len(line[place]) for line in lines) for place in range(len(_HEADS))]
    text = "".join("  ".join(map(str.ljust, line, widths)).rstrip() + "\n" for line in lines)
    print_text(text, end="")
