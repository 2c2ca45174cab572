"""isogyre scene validate, show, schema; isogyre render with the file of a scene."""

from __future__ import annotations

import json
import shutil
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from crystal_core.scene import scene_schema
from service.cli import run
from tests.service.asset_files import cube, png

SCENE = """\
isogyre: 1
title: Calcite over a page
bodies:
  crystal:
    mineral: calcite
    shape: {cleavage: {spacing_mm: [12, 20, 20]}}
    orientation: {z: {hkl: [1, 0, 4]}}
    rests_on: page
surfaces:
  page: {print: digits}
motion: {frames: 2, moves: [{turn: {what: crystal, angles_deg: [0, 360]}}]}
render: {size_px: [24, 16], quality: draft}
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"):
        monkeypatch.setenv(name, "1")
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    work = tmp_path / "work"
    (work / "scenes").mkdir(parents=True)
    (work / "scenes" / "calcite.yaml").write_text(SCENE, encoding="utf-8")
    monkeypatch.chdir(work)
    return work


def written(text: str, name: str = "other.yaml") -> str:
    Path(name).write_text(text, encoding="utf-8")
    return name


def test_a_valid_scene(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["scene", "validate", "scenes/calcite.yaml"]) == 0
    assert capsys.readouterr() == ("scenes/calcite.yaml: valid; 1 body, 1 surface, 2 lights, 2 frames\n", "")
    assert run(["scene", "validate", "scenes/calcite.yaml", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["valid"], told["warnings"]) == (True, [])
    assert told["summary"]["bodies"][0]["name"] == "crystal"


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        (
            SCENE.replace("rests_on", "rest_on"),
            ["other.yaml: /bodies/crystal/rest_on: unknown key; did you mean rests_on?"],
        ),
        (
            SCENE.replace("[12, 20, 20]", "[12, 20, -1]").replace("digits", "3"),
            ["other.yaml: /bodies/crystal/shape/cleavage/spacing_mm", "other.yaml: /surfaces/page/print: "],
        ),
        ("isogyre: 1\n", ["other.yaml: the scene is empty"]),
        ("isogyre: [1\n", ["other.yaml: "]),
        (
            SCENE.replace(
                "bodies:\n", "bodies:\n  ball: {mineral: quartz, shape: {sphere: {}}, position_mm: [0, 0, 12]}\n"
            ),
            ["other.yaml: /bodies/crystal: crystal and ball overlap"],
        ),
        (SCENE.replace("digits", "photo.png"), ["other.yaml: /surfaces/page/print: cannot read photo.png"]),
    ],
)
def test_a_faulty_scene_is_told_by_file_and_place(
    capsys: pytest.CaptureFixture[str], text: str, lines: list[str], tmp_path: Path
) -> None:
    file = written(text)
    for name in (file, str(tmp_path / "work" / file)):  # a path that begins with / is no place in the scene
        assert run(["scene", "validate", name]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert len(err.splitlines()) == len(lines)
        for line, start in zip(err.splitlines(), lines, strict=True):
            assert line.startswith(f"isogyre: {start}"), line
    assert run(["scene", "validate", file, "--json"]) == 2
    out, err = capsys.readouterr()
    assert err == ""
    told = json.loads(out)
    assert told["valid"] is False
    for error, start in zip(told["errors"], lines, strict=True):
        place = f"{error['pointer']}: " if error["pointer"] else ""
        assert f"other.yaml: {place}{error['detail']}".startswith(start)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["scene", "validate", "nothing.yaml"], "nothing.yaml: cannot read nothing.yaml: No such file or directory"),
        (["scene", "validate", "calcite.txt"], "calcite.txt: calcite.txt: a scene is a file .yaml, .yml, .json"),
        (["scene", "validate", "a\0.yaml"], ""),
        (["scene", "show", "scenes/calcite.yaml", "--wireframe", "a.png"], "--wireframe: must end in .svg"),
        (
            ["scene", "show", "scenes/calcite.yaml", "--wireframe", "no/a.svg"],
            "--wireframe: no/a.svg cannot be written",
        ),
        (["scene", "show", "scenes/calcite.yaml", "--view", "plan"], "--view: goes with --wireframe"),
        (["scene", "show", "scenes/calcite.yaml", "--indicatrix"], "--indicatrix: goes with --wireframe"),
        (
            ["scene", "show", "scenes/calcite.yaml", "--view", "up", "--wireframe", "a.svg"],
            "--view: must be one of camera",
        ),
        (["scene", "show", "scenes/calcite.yaml", "--frame", "2"], "--frame: must be 0 to 1, not 2"),
        (["render", "scenes/calcite.yaml", "--out", "o", "--set", "a=1"], "--set: goes with a demonstration"),
        (["render", "nothing.json", "--out", "o"], "nothing.json: cannot read nothing.json"),
        (["render", "scenes/calcite.yaml", "--out", "o", "--size", "1x16"], "--size: width: "),
        (["render", "scenes/calcite.yaml", "--out", "o", "--frames", "0"], "--frames: "),
    ],
)
def test_wrong_options(capsys: pytest.CaptureFixture[str], arguments: list[str], line: str) -> None:
    assert run(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"isogyre: {line}")
    assert len(err.splitlines()) == 1
    assert not Path("o").exists()
    assert not list(Path.cwd().glob("**/*.svg"))


def test_show_tells_and_draws(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["scene", "show", "scenes/calcite.yaml"]) == 0
    page = capsys.readouterr().out
    for words in ("Calcite over a page", "frame 0 of 2", "crystal: calcite (uniaxial), cleavage, 6 faces", "on page"):
        assert words in page
    assert run(["scene", "show", "scenes/calcite.yaml", "--json"]) == 0
    first = json.loads(capsys.readouterr().out)["bodies"][0]["optic_axes"][0]
    command = ["scene", "show", "scenes/calcite.yaml", "--frame", "1", "--json", "--wireframe"]
    assert run([*command, "a.svg", "--view", "plan", "--indicatrix"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["frame"] == 1
    half_a_turn = [-first[0], -first[1], first[2]]
    assert told["bodies"][0]["optic_axes"][0] == pytest.approx(half_a_turn)
    drawn = Path("a.svg").read_bytes()
    assert ElementTree.fromstring(drawn).tag == "{http://www.w3.org/2000/svg}svg"
    assert run([*command, "b.svg", "--view", "plan", "--indicatrix"]) == 0
    assert Path("b.svg").read_bytes() == drawn


def test_the_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["scene", "schema"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads(json.dumps(scene_schema()))


def test_a_scene_is_rendered_and_taken_up_again(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["render", "scenes/calcite.yaml", "--out", "out", "--workers", "1", "--json"]
    assert run(command) == 0
    assert json.loads(capsys.readouterr().out)["frames"] == 2
    out = folder / "out"
    assert sorted(path.name for path in out.iterdir()) == [
        "frame-0000.png",
        "frame-0001.png",
        "manifest.json",
        "sequence.webp",
    ]
    manifest = json.loads((out / "manifest.json").read_text(encoding="utf-8"))
    assert (manifest["complete"], manifest["size"], manifest["document"]["title"]) == (
        True,
        [24, 16],
        "Calcite over a page",
    )
    assert [frame["angle_deg"] for frame in manifest["frames"]] == [0, 180]
    before = {path: path.stat().st_mtime_ns for path in out.iterdir()}
    assert run(command) == 0
    assert {path: path.stat().st_mtime_ns for path in out.iterdir()} == before
    written(SCENE.replace("[12, 20, 20]", "[11, 20, 20]"), "scenes/calcite.yaml")
    assert run(command) == 2
    assert "out holds another sequence (bodies differs); give another folder" in capsys.readouterr().err
    assert run(["render", "rotating-calcite", "--out", "out"]) == 2
    assert "holds another sequence (" in capsys.readouterr().err


def test_files_of_a_scene_are_relative_to_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "scenes" / "photo.png").write_bytes(png((40, 20)))
    (folder / "scenes" / "stone.ply").write_bytes(cube("ply"))
    text = SCENE.replace("digits", "photo.png").replace(
        "cleavage: {spacing_mm: [12, 20, 20]}", "mesh: {file: stone.ply, size_mm: 12}"
    )
    written(text, "scenes/own.yaml")
    shutil.copytree(folder / "scenes", folder / "elsewhere")
    command = ["--workers", "1", "--frames", "1", "--out"]
    assert run(["render", "scenes/own.yaml", *command, "out"]) == 0
    manifest = json.loads(Path("out/manifest.json").read_text(encoding="utf-8"))
    assert manifest["document"]["surfaces"]["page"]["print"].startswith("asset:")
    assert manifest["document"]["bodies"]["crystal"]["shape"]["mesh"]["file"].startswith("asset:")
    # The same content under another path is the same request; other content is another one.
    assert run(["render", "elsewhere/own.yaml", *command, "out"]) == 0
    (folder / "elsewhere" / "photo.png").write_bytes(png((60, 20)))
    assert run(["render", "elsewhere/own.yaml", *command, "out"]) == 2
    assert "surfaces differs" in capsys.readouterr().err
    assert not list((folder.parent / "temporary").iterdir())


def test_what_the_renderer_cannot_draw_is_refused_by_its_place(capsys: pytest.CaptureFixture[str]) -> None:
    ball = "  ball: {mineral: quartz, shape: {sphere: {diameter_mm: 5}}, position_mm: [0, 0, 30]}\n"
    file = written(SCENE.replace("surfaces:\n", ball + "surfaces:\n"))
    assert run(["render", file, "--out", "out"]) == 2
    assert capsys.readouterr().err == "isogyre: other.yaml: /bodies/ball: only one body can be drawn yet\n"
    assert not Path("out").exists()
    assert run(["scene", "validate", file]) == 0
    assert "note: /bodies/ball: cannot be rendered by this version: only one body" in capsys.readouterr().out
