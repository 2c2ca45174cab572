"""`isogyre minerals list`, `show` and `check` on the built-in minerals."""

from __future__ import annotations

import csv
import fcntl
import io
import json
import os
import pty
import struct
import subprocess
import sys
import termios
from pathlib import Path
from typing import Any

import pytest

import minerals_db
from minerals_db.query import Query, find
from service.cli import run
from service.minerals.summaries import COLUMNS, entry_document, summary

ISOGYRE = Path(sys.executable).with_name("isogyre")


def printed(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert run(["minerals", *arguments]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[str]:
    assert run(["minerals", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    lines: list[str] = err.splitlines()
    assert lines
    assert all(line.startswith("isogyre: ") for line in lines)
    return [line.removeprefix("isogyre: ") for line in lines]


@pytest.mark.parametrize(
    ("options", "conditions"),
    [
        ([], {}),
        (["--name", "Кальцит"], {"name": "кальцит"}),
        (["--formula", "CO3", "--elements", "Ca,C"], {"formula": "CO3", "elements": "Ca,C"}),
        (["--group", "garnet", "--system", "cubic"], {"group": "garnet", "system": "cubic"}),
        (["--optical-class", "uniaxial"], {"optical_class": "uniaxial"}),
        (["--optic-sign", "negative"], {"optic_sign": "negative"}),
        (["--n-min", "1.5", "--n-max", "1.6"], {"n_min": 1.5, "n_max": 1.6}),
        (["--birefringence-min", "0.05"], {"birefringence_min": 0.05}),
        (["--birefringence-max", "0.01"], {"birefringence_max": 0.01}),
        (["--colour", "red", "--pleochroism", "weak"], {"colour": "red", "pleochroism": "weak"}),
        (["--quality", "published,none", "--kind", "mineral"], {"quality": "published,none", "kind": "mineral"}),
        (["--origin", "built-in", "--sort", "-birefringence"], {"origin": "built-in", "sort": "-birefringence"}),
        (["--sort=-2v,name"], {"sort": "-2v,name"}),
    ],
)  # fmt: skip
def test_a_list_is_what_a_query_finds(
    capsys: pytest.CaptureFixture[str], options: list[str], conditions: dict[str, Any]
) -> None:
    expected = find(minerals_db.minerals(), Query.model_validate(conditions))
    assert expected
    told = json.loads(printed(capsys, "list", *options, "--json"))
    assert told == json.loads(json.dumps([summary(mineral) for mineral in expected]))
    rows = list(csv.DictReader(io.StringIO(printed(capsys, "list", *options, "--csv"), newline="")))
    assert [row["id"] for row in rows] == [mineral.id for mineral in expected]
    lines = printed(capsys, "list", *options).splitlines()[1:]
    assert [line.split()[0] for line in lines] == [mineral.id for mineral in expected]


def test_an_object_of_the_list_says_what_a_choice_needs(capsys: pytest.CaptureFixture[str]) -> None:
    (calcite,) = json.loads(
        printed(capsys, "list", "--json", "--name", "calcite", "--kind", "mineral", "--formula", "CaCO3")
    )
    assert calcite["id"] == "calcite"
    assert calcite["names"] == {"en": "Calcite", "ru": "Кальцит"}
    assert (calcite["optical_class"], calcite["system"], calcite["point_group"]) == ("uniaxial", "trigonal", "-3m")
    assert calcite["birefringence"] == pytest.approx(0.172, abs=5e-4)
    assert set(calcite) >= {"optic_sign", "group", "kind", "formula", "indices", "two_v_deg", "quality", "origin"}


def test_a_piped_list_is_aligned_text(capsys: pytest.CaptureFixture[str]) -> None:
    head, *lines = printed(capsys, "list", "--elements", "Ca,C", "--optical-class", "uniaxial").splitlines()
    assert head.split() == ["id", "name", "название", "system", "optics", "n", "δ", "2V", "dispersion", "colour"]
    place = head.index("system")
    assert {line[place:].split()[0] for line in lines} == {"trigonal"}
    calcite = next(line for line in lines if line.startswith("calcite "))
    assert "uniaxial −  1.4861–1.6583  0.1722" in calcite


def test_nothing_found_is_no_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert json.loads(printed(capsys, "list", "--name", "kryptonite", "--json")) == []
    assert printed(capsys, "list", "--name", "kryptonite", "--csv").rstrip("\r\n").split(",") == list(COLUMNS)
    assert len(printed(capsys, "list", "--name", "kryptonite").splitlines()) == 1


def test_every_wrong_option_of_a_list_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    lines = refused(
        capsys, "list", "--n-min", "low", "--system", "cubist", "--elements", "CO,Xx", "--sort", "beauty",
        "--birefringence-min", "0.2", "--birefringence-max", "0.1",
    )  # fmt: skip
    assert [line.split(": ")[0] for line in lines] == [
        "--elements",
        "--system",
        "--n-min",
        "--birefringence-max",
        "--sort",
    ]
    assert (
        lines[0]
        == "--elements: 'CO' is no element; give symbols such as Ca, C; 'Xx' is no element; give symbols such as Ca, C"
    )
    assert "must not be less than birefringence_min, 0.2" in lines[3]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "Missing command"),
        (["find"], "No such command 'find'"),
        (["list", "calcite"], "Got unexpected extra argument"),
        (["list", "--json", "--csv"], "--csv: not together with --json"),
        (["list", "--hardness", "7"], "No such option: --hardness"),
        (["show"], "Missing argument 'ID'"),
        (["show", "unobtainium"], "ID: no mineral 'unobtainium'; "),
        (["show", "Calcit"], "ID: no mineral 'Calcit'; do you mean calcite"),
        (["show", "calcite", "--wavelengths", "0.5893"], "--wavelengths: 0.5893: must be from 10 to 100000 nm"),
        (["show", "calcite", "--wavelengths", "red"], "--wavelengths: 'red' is no number"),
        (["show", "calcite", "--concentration", "iron=1"], "--concentration iron: no chromophore"),
        (["show", "calcite", "--concentration", "iron"], "--concentration: must be CHROMOPHORE=PERCENT, not 'iron'"),
        (["check", "nowhere"], "'nowhere': there is no such folder or file"),
        (["check", "a\0b"], "'a\\x00b': "),
        (["check", "notes.txt"], "'notes.txt': must end in .yaml"),
        (["check", "sources.yaml"], "'sources.yaml': holds sources; give its folder"),
    ],
)
def test_bad_usage_is_one_line_and_code_2(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("notes.txt").touch()
    Path("sources.yaml").touch()
    (line,) = refused(capsys, *arguments)
    assert line.startswith(said)


def test_one_wrong_concentration_hides_no_wrong_wavelength(capsys: pytest.CaptureFixture[str]) -> None:
    lines = refused(capsys, "show", "calcite", "--concentration", "iron=1", "--wavelengths", "red")
    assert [line.split(": ")[0] for line in lines] == ["--concentration iron", "--wavelengths"]


def test_a_page_tells_the_entry_with_its_sources(capsys: pytest.CaptureFixture[str]) -> None:
    page = printed(capsys, "show", "calcite", "--wavelengths", "500,3000")
    assert page.startswith("Calcite · Кальцит · CaCO3\n")
    assert "\ntrigonal, -3m, uniaxial negative\n" in page
    assert "published, ghosh-1999]" in page
    assert "\nsources\n" in page
    assert "Ghosh" in page.partition("\nsources\n")[2]
    table = next(part for part in page.split("\n\n") if part.lstrip().startswith("nm"))
    rows = [line.split() for line in table.splitlines()]
    assert rows[0][:3] == ["nm", "n_o", "n_e"]
    calcite = minerals_db.mineral("calcite")
    assert rows[1][:3] == ["500", *(f"{float(calcite.dispersion[axis].index(500)):.5f}" for axis in "oe")]
    assert rows[2][0] == "3000*"
    assert rows[3][0] == "*"


def test_every_entry_has_a_page(capsys: pytest.CaptureFixture[str]) -> None:
    for mineral in minerals_db.minerals().values():
        page = printed(capsys, "show", mineral.id)
        assert mineral.names.ru in page
        for key in mineral.sources:
            assert f"\n  {key}: " in page


def test_a_mineral_as_json_is_its_entry_and_its_optics(capsys: pytest.CaptureFixture[str]) -> None:
    told = json.loads(printed(capsys, "show", "topaz", "--wavelengths", "400:600:100", "--json"))
    entry = json.loads(json.dumps(entry_document(minerals_db.mineral("topaz"))))
    assert {key: told[key] for key in entry} == entry
    assert [row["wavelength_nm"] for row in told["optics"]] == [400, 500, 600]
    assert told["optics"][1]["indices"]["a"] == float(minerals_db.mineral("topaz").dispersion["a"].index(500))
    assert told["concentrations_weight_percent"] == {}


def test_the_built_in_minerals_have_no_fault(capsys: pytest.CaptureFixture[str]) -> None:
    count = len(minerals_db.minerals())
    assert json.loads(printed(capsys, "check", "--json")) == {"minerals": count, "faults": []}
    line = printed(capsys, "check")
    assert line.startswith(f"{count} entries, ")
    assert line.endswith(": nothing wrong\n")


def on_a_terminal(columns: int, *arguments: str) -> list[str]:
    """Return what a command prints on a terminal of a width."""
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    environment = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")}
    environment |= {"TERM": "xterm", "NO_COLOR": "1"}
    with subprocess.Popen([ISOGYRE, "minerals", *arguments], stdout=follower, env=environment) as process:
        os.close(follower)
        text = b""
        while True:
            try:
                part = os.read(leader, 65536)
            except OSError:  # the other end is closed
                break
            if not part:
                break
            text += part
    os.close(leader)
    assert process.returncode == 0
    return [line.rstrip() for line in text.decode().replace("\x1b[1m", "").replace("\x1b[0m", "").splitlines()]


def test_a_terminal_gets_a_table_that_fits(capsys: pytest.CaptureFixture[str]) -> None:
    ids = [mineral["id"] for mineral in json.loads(printed(capsys, "list", "--elements", "Ca,C", "--json"))]
    for columns, head in (
        (160, "id name название system optics n δ 2V dispersion colour"),
        (82, "id optics n δ 2V dispersion colour"),
    ):
        first, *rows, last = on_a_terminal(columns, "list", "--elements", "Ca,C")
        assert first.split() == head.split()
        assert [row.split()[0] for row in rows] == ids
        assert all(len(row) <= columns for row in rows)
        assert last == f"{len(ids)} minerals"


def test_a_reader_may_go_away_and_a_terminal_may_lack_letters() -> None:
    shell = f"set -o pipefail; '{ISOGYRE}' minerals show quartz | head -n 1"
    result = subprocess.run(["bash", "-c", shell], capture_output=True, text=True, check=True, timeout=60)
    assert (result.stdout, result.stderr) == ("Quartz · Кварц · SiO2\n", "")
    latin = subprocess.run(
        [ISOGYRE, "minerals", "list", "--name", "quartz", "--kind", "mineral"],
        capture_output=True, check=True, timeout=60, env={**os.environ, "PYTHONIOENCODING": "latin-1"},
    )  # fmt: skip
    assert latin.stderr == b""
    assert b"\\u041a\\u0432\\u0430\\u0440\\u0446" in latin.stdout


def test_help_of_minerals_loads_nothing_slow() -> None:
    script = """
import sys
from service.cli import run
for command in ([], ["list"], ["show"], ["check"]):
    assert run(["minerals", *command, "--help"]) == 0
slow = {"numpy", "scipy", "yaml", "fastapi", "distributed"} & set(sys.modules)
assert not slow, slow
"""
    subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, timeout=60)
