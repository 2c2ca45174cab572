"""The programs of docs/crystal-shapes.md print what the page says, and what it claims is so."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

import minerals_db
from crystal_core.scene.specimen import cleavage_body, point_group_of
from service.cli import run as isogyre
from tests.docs.blocks import FENCE, ROOT, programs, run

PAGE = "docs/crystal-shapes.md"


def test_the_command_prints_what_the_page_shows(capsys: pytest.CaptureFixture[str]) -> None:
    blocks = FENCE.findall((ROOT / PAGE).read_text(encoding="utf-8"))
    (language, command), (_, prints) = blocks[0], blocks[1]
    assert language == "sh"
    assert isogyre(shlex.split(command)[1:]) == 0
    assert capsys.readouterr().out == prints


def test_the_program_prints_what_the_page_shows(tmp_path: Path) -> None:
    (program,) = programs(PAGE)
    _, printed = run(program, tmp_path)
    assert printed == program.prints


def test_benitoite_has_a_trigonal_prism() -> None:
    assert len(point_group_of(minerals_db.mineral("benitoite")).equivalents((1, 0, 0))) == 3


def test_barite_cleaves_into_a_tablet() -> None:
    assert set(cleavage_body(minerals_db.mineral("barite"), 2.0).hkl) >= {(0, 0, 1), (2, 1, 0)}
