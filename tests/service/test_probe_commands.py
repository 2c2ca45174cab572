"""The probes at the command line: all answers or none, one line on stderr, and the number of the input's line in it."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from service.cli import run
from service.commands import answers
from tests.service.interface_questions import CALCITE

ISOGYRE = Path(sys.executable).with_name("isogyre")

GOOD = json.dumps(CALCITE)
INSIDE = {**{key: CALCITE[key] for key in ("wavelength_nm", "normal", "to")}, "from": CALCITE["to"]}
PLATE = {"plates": [{"indices": [1.5], "thickness_um": 30}], "wavelengths_nm": [500]}


@pytest.fixture(autouse=True)
def _work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def refused(text: str | bytes, capsys: pytest.CaptureFixture[str], command: str = "interface") -> str:
    """Run a command on a file; return what stderr says of it, without the program's name and the end of the line."""
    Path("questions").write_bytes(text.encode() if isinstance(text, str) else text)
    assert run([command, "questions"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith("isogyre: ")
    return err.removeprefix("isogyre: ").removesuffix("\n")


def test_one_answer_for_each_line_in_order(capsys: pytest.CaptureFixture[str]) -> None:
    indices = [1.5, 1.2, 1.9, 1.1]
    questions = [{**CALCITE, "to": {"indices": [n]}} for n in indices]
    questions.insert(2, CALCITE)
    Path("questions").write_text("".join(f"{json.dumps(question)}\n\n" for question in questions))
    assert run(["interface", "questions"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    found = [json.loads(line)["scattered"][0]["index"] for line in out.splitlines()]
    assert found == pytest.approx([1.5, 1.2, 1.6584, 1.9, 1.1], abs=1e-12)


def test_a_document_may_be_spread_over_lines_and_come_by_stdin(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    printed = []
    for text in (GOOD, json.dumps(CALCITE, indent=2)):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
        assert run(["interface", "-"]) == 0
        printed.append(capsys.readouterr().out)
    assert printed[0] == printed[1]
    assert printed[0].count("\n") == 1


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"colour": 1}, "/colour: unknown key"),
        ({"wavelength_nm": 0.5893}, "/wavelength_nm: input should be greater than or equal to 100, not 0.5893"),
        ({"wavelength_nm": None}, "/wavelength_nm: must be a number, not null"),
        ({"wavelength_nm": float("nan")}, "/wavelength_nm: must be a finite number, not NaN"),
        ({"normal": [0, 0, 0]}, "/normal: must be a unit vector, to 1e-06; its length is 0"),
        ({"normal": [0, 0, 1.00001]}, "/normal: must be a unit vector, to 1e-06; its length is 1.00001"),
        ({"normal": [0, 0, -1]}, "/wave_normal: must have a positive component along normal"),
        ({"normal": [0, float("nan"), 1]}, "/normal/1: must be a finite number, not NaN"),
        ({"normal": [0, 1]}, "/normal/2: required"),
        ({"normal": [0, 0, 0, 1]}, "/normal: must have at most 3 items, not 4"),
        ({"normal": "up"}, '/normal: must be a list, not "up"'),
        ({"wave_normal": [0.5, 0, 0.5]}, "/wave_normal: must be a unit vector"),
        ({"wave_normal": [1e200, 1e200, 0]}, "/wave_normal: must be a unit vector"),
        ({"wave_normal": [1, 0, 0]}, "/wave_normal: must have a positive component along normal"),
        ({"wave_normal": None}, "/wave_normal: required: `from` is isotropic"),
        (
            {"tangential_k": [0.5, 0, 0]},
            "/tangential_k: is for an anisotropic `from`; of an isotropic one give wave_no",
        ),
        ({"from": CALCITE["to"]}, "/wave_normal: is for an isotropic `from`; of an anisotropic one give tangential_k"),
        ({"from": {"indices": [0]}}, "/from/indices/0: input should be greater than or equal to 0.01, not 0"),
        ({"from": {"indices": [-1.5]}}, "/from/indices/0: input should be greater than or equal to 0.01, not -1.5"),
        ({"from": 1.0}, "/from: must be an object, not 1.0"),
        ({"to": {"indices": [1.5, 1.6]}}, "/to/axes: required: the medium is anisotropic"),
        (
            {"to": {"indices": [1.5, 1.6], "axes": [[1, 0, 0], [0, 1, 0], [0, 0.1, 1]]}},
            "/to/axes: the axes must be ort",
        ),
        ({"to": {"mineral": "unobtainium"}}, "/to/mineral: no mineral 'unobtainium'; "),
        ({"to": {"mineral": "calcite", "rotation": [[0] * 3] * 3}}, "/to/rotation: the rotation must be orthonormal"),
        ({"to": {"colour~/": 1}}, "/to/indices: required, unless a mineral is named; /to/colour~0~1: unknown key"),
    ],
)
def test_what_is_wrong_is_told_by_line_and_pointer(
    capsys: pytest.CaptureFixture[str], change: dict[str, Any], said: str
) -> None:
    line = json.dumps({**CALCITE, **change})
    assert refused(f"{GOOD}\n\n{line}\n{GOOD}\n", capsys).startswith(f"line 3: {said}")


@pytest.mark.parametrize(
    ("k", "said"),
    [
        ([1.7, 0, 0], "/tangential_k: no wave of `from` propagates with this tangential wave vector"),
        ([0.5, 0, 2e-9], "/tangential_k: must lie in the face: its component along normal is 2e-09"),
        ([0.5, 0, -1], "/tangential_k: must lie in the face: its component along normal is -1"),
        ([1e200, 0, 0], "/tangential_k: must have components of at most 100"),
        ([float("inf"), 0, 0], "/tangential_k/0: must be a finite number"),
        (None, "/tangential_k: required: `from` is anisotropic"),
    ],
)
def test_a_wrong_tangential_wave_vector(capsys: pytest.CaptureFixture[str], k: Any, said: str) -> None:
    assert refused(f"{GOOD}\n{json.dumps({**INSIDE, 'tangential_k': k})}", capsys).startswith(f"line 2: {said}")


def test_a_normal_component_of_rounding_is_taken(capsys: pytest.CaptureFixture[str]) -> None:
    Path("questions").write_text(json.dumps({**INSIDE, "tangential_k": [0.5, 0, 5e-10]}))
    assert run(["interface", "questions"]) == 0
    assert len(json.loads(capsys.readouterr().out)["incident"]) == 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "FILE: there is nothing in it"),
        ("\n \n", "FILE: there is nothing in it"),
        (f"{GOOD}\n{{\n{GOOD}\n", "line 2: not JSON: "),
        (f"[\n{GOOD}\n]", "line 1: must be a JSON object, not a list"),
        (f"{GOOD}\n5\n", "line 2: must be a JSON object, not a number"),
        (f"{GOOD}\nnull\n{{\n", "line 2: must be a JSON object, not null"),
        (GOOD.encode() + b"\n\xff\n", "line 2: not JSON: not UTF-8 at byte 0"),
        (GOOD + "\n" + GOOD.replace("589.3", "1e999"), "line 2: /wavelength_nm: must be a finite number"),
        (GOOD + "\n" + GOOD.replace("589.3", "9" * 400), "line 2: /wavelength_nm: must be a number"),
        (json.dumps({**CALCITE, "normal": [0, 0, 0]}, indent=2), "line 1: /normal: must be a unit vector"),
        ("\n\n" + json.dumps({**CALCITE, "normal": [0, 0, 0]}, indent=2), "line 3: /normal: must be a unit vector"),
        (json.dumps(CALCITE, indent=2).replace("589.3", "five"), "line 2: not JSON: "),
    ],
)
def test_what_cannot_be_read(capsys: pytest.CaptureFixture[str], text: str | bytes, said: str) -> None:
    assert refused(text, capsys).startswith(said)


@pytest.mark.parametrize(
    ("bad", "first"),
    [
        (["{", json.dumps({**INSIDE, "tangential_k": [1.7, 0, 0]}), "{}"], "line 2: not JSON"),
        ([json.dumps({**INSIDE, "tangential_k": [1.7, 0, 0]}), "{}", "{"], "line 2: /tangential_k: no wave"),
        (["{}", "{", json.dumps({**INSIDE, "tangential_k": [1.7, 0, 0]})], "line 2: /wavelength_nm: required; "),
    ],
)
def test_the_first_of_several_wrong_lines_is_told(
    capsys: pytest.CaptureFixture[str], bad: list[str], first: str
) -> None:
    assert refused("\n".join([GOOD, *bad, GOOD]), capsys).startswith(first)


def test_a_wrong_line_is_found_behind_many_good_ones(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answers, "_CHUNK", 2)
    assert refused("\n".join([GOOD] * 5 + ["{}"] + [GOOD] * 3), capsys).startswith("line 6: ")
    Path("questions").write_text("\n".join([GOOD] * 5))
    assert run(["interface", "questions"]) == 0
    assert capsys.readouterr().out.count("\n") == 5


def test_too_many_lines_are_refused(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(answers, "MAX_DOCUMENTS", 2)
    assert refused(f"{GOOD}\n" * 3, capsys) == "FILE: has 3 documents; at most 2 are answered in one run"


@pytest.mark.parametrize(
    ("file", "said"),
    [
        ("missing", "FILE: 'missing' cannot be read: No such file or directory"),
        ("/missing", "FILE: '/missing' cannot be read: No such file or directory"),
        (".", "FILE: '.' cannot be read: Is a directory"),
        ("a\0b", "FILE: 'a\\x00b' cannot be read: embedded null byte"),
    ],
)
def test_a_file_that_is_none(capsys: pytest.CaptureFixture[str], file: str, said: str) -> None:
    assert run(["plate", file]) == 2
    assert capsys.readouterr() == ("", f"isogyre: {said}\n")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"plates": []}, "/plates: must have at least 1 items, not 0"),
        ({"plates": [{"indices": [1.5]}]}, "/plates/0/thickness_um: required"),
        ({"plates": [*PLATE["plates"], {"indices": [1.5], "thickness_um": 0}]}, "/plates/1/thickness_um: input should"),
        ({"plates": [{"indices": [1.5, 1.6], "thickness_um": 30}]}, "/plates/0/axes: required"),
        ({"plates": [{"indices": [float("nan")], "thickness_um": 30}]}, "/plates/0/indices/0: must be a finite number"),
        ({"plates": PLATE["plates"][0]}, "/plates: must be a list"),
        ({"mount_index": 0}, "/mount_index: input should be greater than or equal to 0.01, not 0"),
        ({"coherent": "maybe"}, "/coherent: input should be 'exact', 'single-pass' or 'incoherent', not \"maybe\""),
        ({"polarizer_deg": "x"}, '/polarizer_deg: must be a number, not "x"'),
        ({"wavelengths_nm": []}, "/wavelengths_nm: must have at least 1 items, not 0"),
        ({"wavelengths_nm": [0.5]}, "/wavelengths_nm/0: input should be greater than or equal to 100, not 0.5"),
        ({"analyzer_deg": 0}, "/analyzer_deg: unknown key"),
        # The optics themselves refuse it.
        (
            {"plates": [{"indices": [1.5, 3.0], "axes": [[0, 0, 1], [0, 1, 0], [1, 0, 0]], "thickness_um": 1e5}]},
            "/plates: the fringes of so thick a stack need ",
        ),
    ],
)
def test_a_wrong_stack(capsys: pytest.CaptureFixture[str], change: dict[str, Any], said: str) -> None:
    assert refused(f"{json.dumps(PLATE)}\n{json.dumps({**PLATE, **change})}", capsys, "plate").startswith(
        f"line 2: {said}"
    )


def test_a_reader_that_has_seen_enough_is_no_error(tmp_path: Path) -> None:
    (tmp_path / "questions").write_text(f"{GOOD}\n" * 200)
    done = subprocess.run(
        ["bash", "-o", "pipefail", "-c", f"{ISOGYRE} interface questions | head -c 20"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.stderr == ""
    assert done.returncode == 0
    assert done.stdout == '{"incident":[{"mode"'


def test_help_tells_the_keys(capsys: pytest.CaptureFixture[str]) -> None:
    for command, keys in (("interface", ("tangential_k", "wave_normal")), ("plate", ("mount_index", "coherent"))):
        assert run([command, "--help"]) == 0
        text = capsys.readouterr().out
        assert all(key in text for key in keys)
