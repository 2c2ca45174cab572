"""A user's own minerals: in lists, over HTTP, in every command; faulty ones are told fault by fault."""

from __future__ import annotations

import json
from collections.abc import Iterator
from importlib import resources
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

import minerals_db
from crystal_core.errors import InputError
from minerals_db import MineralDataError, library
from service.app import create_app
from service.cli import run
from service.engine import InlineEngine
from service.minerals.check import check_paths
from service.settings import Settings, load_settings
from service.workshop import Workshop
from tests.service.interface_questions import CALCITE

VARIETY = """
id: blue-calcite
variety_of: calcite
names: {en: Blue calcite, ru: Голубой кальцит}
appearance: {colours: [blue], source: me, status: measured}
sources:
  me: {citation: My own notebook., licence: CC0 1.0}
"""
FAULTY = VARIETY.replace("status: measured", "status: guessed") + "strunz: fourth\n"
FAULTS = ("strunz", "appearance.status")


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Give a folder of the user's own minerals; what was read before is forgotten, before and after."""
    folder = tmp_path / "own"
    folder.mkdir()
    (folder / "blue-calcite.yaml").write_text(VARIETY, encoding="utf-8")
    monkeypatch.setenv(library.OWN_FOLDER_VARIABLE, str(folder))
    monkeypatch.chdir(tmp_path)
    forget()
    yield folder
    forget()


@pytest.fixture
def faulty(own: Path) -> Path:
    (own / "blue-calcite.yaml").write_text(FAULTY, encoding="utf-8")
    return own


def forget() -> None:
    for remembered in (library.own_minerals, library.all_minerals, library.data_digest, library._own_files):
        remembered.cache_clear()


@pytest.mark.usefixtures("own")
def test_own_minerals_are_found_and_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["minerals", "list", "--origin", "own", "--json"]) == 0
    (told,) = json.loads(capsys.readouterr().out)
    assert (told["id"], told["origin"], told["variety_of"]) == ("blue-calcite", "own", "calcite")
    assert run(["minerals", "list", "--name", "кальцит", "--json"]) == 0
    assert {"blue-calcite", "calcite"} <= {mineral["id"] for mineral in json.loads(capsys.readouterr().out)}
    assert run(["minerals", "show", "blue-calcite"]) == 0
    assert "\nown entry; " in capsys.readouterr().out
    assert run(["minerals", "check"]) == 0
    assert ", 1 of your own: nothing wrong" in capsys.readouterr().out


@pytest.mark.usefixtures("own")
def test_own_minerals_are_listed_over_http(fake: None, tmp_path: Path) -> None:  # noqa: ARG001
    settings = Settings(data_dir=tmp_path / "data", workers=1, log_level="error")
    with TestClient(create_app(settings, workshop=Workshop(settings, InlineEngine))) as client:
        listed = client.get("/v1/minerals?origin=own")
        assert [mineral["id"] for mineral in listed.json()["minerals"]] == ["blue-calcite"]
        assert client.get("/v1/minerals/blue-calcite").json()["origin"] == "own"
        built_in = client.get("/v1/minerals?origin=built-in&limit=500").json()
        assert built_in["total"] == len(minerals_db.minerals()) - 1
        assert {mineral["origin"] for mineral in built_in["minerals"]} == {"built-in"}


def test_the_tag_and_the_cursors_are_of_the_own_minerals_too(fake: None, own: Path, tmp_path: Path) -> None:  # noqa: ARG001
    settings = Settings(data_dir=tmp_path / "data", workers=1, log_level="error")
    with TestClient(create_app(settings, workshop=Workshop(settings, InlineEngine))) as client:
        before = client.get("/v1/minerals?limit=1")
        (own / "blue-calcite.yaml").write_text(VARIETY.replace("Blue", "Sky blue"), encoding="utf-8")
        forget()
        after = client.get("/v1/minerals?limit=1", headers={"If-None-Match": before.headers["etag"]})
        assert after.status_code == 200
        assert client.get(before.json()["links"]["next"]).status_code == 422
        assert client.get(after.json()["links"]["next"]).status_code == 200


@pytest.mark.parametrize(
    "arguments",
    [
        ["minerals", "list"],
        ["minerals", "show", "calcite"],
        ["render", "rotating-calcite", "--out", "out"],
        ["interface", "questions"],
        ["plate", "plates"],
        ["wave-surface", "calcite"],
        ["serve", "--port", "0"],
    ],
    ids=" ".join,
)
def test_every_command_tells_each_fault_of_an_own_mineral(
    faulty: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
) -> None:
    monkeypatch.setenv("ISOGYRE_DATA_DIR", str(tmp_path / "data"))
    Path("questions").write_text(json.dumps({**CALCITE, "to": {"mineral": "calcite"}}))
    Path("plates").write_text(json.dumps({"plates": [{"mineral": "calcite", "thickness_um": 30}]}))
    assert run(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    lines = err.splitlines()
    assert len(lines) == len(FAULTS)
    for line, field in zip(lines, FAULTS, strict=True):
        assert line.startswith(f"isogyre: {faulty / 'blue-calcite.yaml'}: {field}: ")
    assert not Path("out").exists()
    assert not (tmp_path / "data").exists()


def test_check_tells_each_fault_and_exits_1(faulty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for paths in ([], [str(faulty)], [str(faulty / "blue-calcite.yaml")]):
        assert run(["minerals", "check", *paths]) == 1
        out, err = capsys.readouterr()
        assert err == ""
        lines = out.splitlines()
        assert [line.split(": ")[:2] for line in lines] == [[str(faulty / "blue-calcite.yaml"), f] for f in FAULTS]
        assert run(["minerals", "check", *paths, "--json"]) == 1
        told = json.loads(capsys.readouterr().out)
        assert told["minerals"] == 1 + (0 if paths else len(library.builtin_minerals()))
        assert [f"{fault['file']}: {fault['field']}: {fault['reason']}" for fault in told["faults"]] == lines


def test_check_reads_what_a_file_builds_upon(tmp_path: Path) -> None:
    folder = tmp_path / "drafts"
    folder.mkdir()
    (folder / "blue-calcite.yaml").write_text(VARIETY.partition("sources:")[0], encoding="utf-8")
    (folder / "sources.yaml").write_text("me: {citation: My own notebook., licence: CC0 1.0}\n", encoding="utf-8")
    (folder / "other.yaml").write_text("id: [", encoding="utf-8")
    alone = check_paths([str(folder / "blue-calcite.yaml")])
    assert (alone.checked, alone.faults) == (1, [])
    assert [mineral.id for mineral in alone.minerals] == ["blue-calcite"]
    whole = check_paths([str(folder)])
    assert whole.checked == 2
    assert [fault.file for fault in whole.faults] == [str(folder / "other.yaml")]


def test_check_takes_the_built_in_files_as_what_they_are() -> None:
    folder = Path(str(resources.files("minerals_db") / "data"))
    assert check_paths([str(folder)]).faults == []
    assert check_paths([str(folder)]).checked == len(library.builtin_minerals())
    one = check_paths([str(folder / "calcite.yaml")])
    assert (one.checked, one.faults) == (1, [])


def test_check_refuses_the_id_of_a_built_in_mineral(tmp_path: Path) -> None:
    data = (resources.files("minerals_db") / "data" / "calcite.yaml").read_text(encoding="utf-8")
    (tmp_path / "calcite.yaml").write_text(data, encoding="utf-8")
    (fault,) = check_paths([str(tmp_path)]).faults
    assert fault.field == "id"
    assert "built-in" in fault.reason


def test_control_characters_of_a_file_do_nothing_to_a_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a\x1b[2J.yaml").write_text('id: "\\e[31m"\n', encoding="utf-8")
    assert run(["minerals", "check", str(tmp_path)]) == 1
    out = capsys.readouterr().out
    assert "\x1b" not in out
    assert "a\\x1b[2J.yaml: " in out


def test_the_setting_is_that_of_the_environment(own: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert load_settings().minerals_dir == own
    monkeypatch.setenv("ISOGYRE_MINERALS_DIR", "own")
    assert load_settings().minerals_dir == own
    assert library.own_folder() == own
    monkeypatch.setenv("ISOGYRE_MINERALS_DIR", "")
    assert load_settings().minerals_dir is None
    monkeypatch.delenv("ISOGYRE_MINERALS_DIR")
    assert load_settings().minerals_dir is None
    with pytest.raises(ValueError, match="is set by the environment variable ISOGYRE_MINERALS_DIR alone"):
        Settings(minerals_dir=tmp_path)


def test_a_folder_that_is_none_is_named(own: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for path, said in ((tmp_path / "none", "there is no folder"), (own / "blue-calcite.yaml", "is not a folder")):
        monkeypatch.setenv("ISOGYRE_MINERALS_DIR", str(path))
        forget()
        with pytest.raises(InputError, match=said) as caught:
            load_settings()
        assert [fault.pointer for fault in caught.value.faults] == ["ISOGYRE_MINERALS_DIR"]
        with pytest.raises(MineralDataError, match="ISOGYRE_MINERALS_DIR"):
            minerals_db.minerals()
        assert run(["minerals", "list"]) == 2
        assert run(["minerals", "check"]) == 1
