"""Code blocks of the Markdown pages."""

from __future__ import annotations

import contextlib
import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Program:
    """A block of Python, and the block of text after it: what it prints."""

    source: str
    prints: str


def programs(page: str) -> list[Program]:
    """Return the programs of a page, such as ``docs/tour.md``."""
    blocks = FENCE.findall((ROOT / page).read_text(encoding="utf-8"))
    found = []
    for number, (language, body) in enumerate(blocks):
        if language == "python":
            follows, text = blocks[number + 1] if number + 1 < len(blocks) else ("", "")
            found.append(Program(body, text if follows == "text" else ""))
    return found


def run(program: Program, folder: Path) -> tuple[dict[str, Any], str]:
    """Run a program in a folder; return its variables and what it printed."""
    variables: dict[str, Any] = {"__name__": "__main__"}
    printed = io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(printed):
        exec(compile(program.source, "program", "exec"), variables)
    return variables, printed.getvalue()


def section(page: str, heading: str) -> str:
    """Return what a page, such as ``docs/errata.md``, says under a heading of any level, on one line.

    Raises
    ------
    KeyError
        There is no such heading.
    """
    text = (ROOT / page).read_text(encoding="utf-8")
    found = re.search(rf"^(#+) {re.escape(heading)}\n(.*?)(?=^#{{1,2}} |\Z)", text, re.MULTILINE | re.DOTALL)
    if found is None:
        raise KeyError(heading)
    return " ".join(found.group(2).split())
