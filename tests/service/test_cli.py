from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import service.serve
from crystal_core import __version__, sequence
from service.cli import run
from service.commands.complaint import complain
from tests.service.batch_tools import plain_tile, read_manifest, snapshot

DEFAULTS = ("--size", "64x48", "--quality", "draft", "--frames", "2", "--workers", "1")


@pytest.fixture(autouse=True)
def _surroundings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep what a command does to its process and to the machine inside the test."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"):
        monkeypatch.setenv(name, "1")
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")


def png(size: tuple[int, int] = (32, 32), mode: str = "L") -> bytes:
    stream = io.BytesIO()
    Image.new(mode, size, 1).save(stream, "PNG")
    return stream.getvalue()


PICTURES = {
    "text.png": b"This is no picture.\n",
    "empty.png": b"",
    "cut.png": png((300, 300))[:60],
    "bomb.png": png((12_000, 12_000), "1"),
    "bomb.gif": b"GIF89a" + b"\xff" * 64,
    "heavy.png": png() + bytes(9_000_000),
}


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        # what is asked for
        (["rotating-topaz"], "demonstration: unknown demonstration 'rotating-topaz'; known: rotating-calcite"),
        ([""], "demonstration: unknown demonstration ''"),
        (["--set", "mineral=unobtainium"], "--set mineral: no mineral 'unobtainium'; "),
        (["--set", "mineral=3"], "--set mineral: input should be a valid string, not 3"),
        (["--set", "colour=red"], "--set colour: unknown key"),
        (["--set", "gap_mm"], "--set: must be key=value, not 'gap_mm'"),
        (["--set", "=0.5"], "--set: must be key=value, not '=0.5'"),
        (["--set", "gap_mm=1", "--set", "gap_mm=1"], "--set gap_mm: is set more than once"),
        (["--set", "gap_mm=NaN"], "--set gap_mm: "),
        (["--set", "gap_mm=[" + "[" * 100_000], "--set gap_mm: "),
        (["--set", "gap_mm=" + "9" * 5_000], "--set gap_mm: "),
        (["--set", "size_mm=[22, 0, 14]"], "--set size_mm: [1]: input should be greater than or equal to 0.5, not 0"),
        (["--set", "marks=[[0, 0], [1]]"], "--set marks: [1][1]: field required"),
        (["--set", "a\x1b[2J\nb=1"], "--set a\\x1b[2J\\nb: unknown key"),
        # numbers
        (["--size", "0x0"], "--size: width: input should be greater than or equal to 16, not 0; height: "),
        (["--size", "100000x100000"], "--size: width: input should be less than or equal to 2048, not 100000; "),
        (["--size", "100000x64"], "--size: width: input should be less than or equal to 2048, not 100000"),
        (["--size", "abc"], "--size: must be WIDTHxHEIGHT in pixels, such as 640x480, not 'abc'"),
        (["--size", "-64x48"], "--size: must be WIDTHxHEIGHT"),
        (["--size", "64"], "--size: must be WIDTHxHEIGHT"),
        (["--size", "64x48x3"], "--size: must be WIDTHxHEIGHT"),
        (["--size", "9" * 5000 + "x64"], "--size: must be WIDTHxHEIGHT"),
        (["--frames", "0"], "--frames: input should be greater than or equal to 1, not 0"),
        (["--frames", "361"], "--frames: input should be less than or equal to 360, not 361"),
        (["--frames", "many"], "Invalid value for '--frames': "),
        (["--seed", "-1"], "--seed: input should be greater than or equal to 0, not -1"),
        (["--seed", str(2**63)], "--seed: input should be less than or equal to 9223372036854775807"),
        (["--seed", "1.5"], "Invalid value for '--seed': "),
        (["--quality", "best"], "--quality: input should be 'draft', 'standard' or 'fine', not \"best\""),
        (["--workers", "0"], "Invalid value for '--workers': "),
        (["--colour"], "No such option: --colour"),
        # pictures
        (["--set", "texture=missing.png"], "--set texture: 'missing.png' cannot be read: No such file or directory"),
        (["--set", "texture=text.png"], "--set texture: not a PNG or JPEG picture"),
        (["--set", "texture=empty.png"], "--set texture: not a PNG or JPEG picture"),
        (["--set", "texture=cut.png"], "--set texture: the picture "),
        (["--set", "texture=bomb.png"], "--set texture: the picture has 12000 × 12000 pixels; at most 16000000 "),
        (["--set", "texture=bomb.gif"], "--set texture: not a PNG or JPEG picture"),
        (["--set", "texture=heavy.png"], "--set texture: the picture has 9"),
        (["--set", "texture=/dev/zero"], "--set texture: '/dev/zero' is not a file"),
        (["--set", "texture=pipe"], "--set texture: 'pipe' is not a file"),
        (["--set", "texture="], "--set texture: '.' is not a file"),
        (["--set", "texture=5"], "--set texture: '5' cannot be read: No such file or directory"),
        (["--set", 'texture="a\\u0000b"'], "--set texture: 'a\\x00b' cannot be read: embedded null byte"),
        (["--set", "texture=asset:" + "0" * 64], "--set texture: 'asset:0000000"),
        # the folder
        (["--out", "text.png"], "--out: text.png is not a folder"),
        (["--out", "text.png/below/deep"], "--out: text.png is not a folder"),
        (["--out", "/proc/isogyre"], "--out: /proc/isogyre cannot be written to: "),
        (["--out", ""], "--out: must name a folder"),
        (["--out", "x" * 300], "--out: xxxxx"),
    ],
)
def test_bad_input_is_one_line_and_nothing_is_made(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], line: str
) -> None:
    for name, data in PICTURES.items():
        Path(name).write_bytes(data)
    os.mkfifo("pipe")
    before = sorted(tmp_path.rglob("*"))
    demonstration = [] if arguments[0].startswith("-") is False else ["rotating-calcite"]
    assert run(["render", *demonstration, "--out", "new/folder", *DEFAULTS, *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"isogyre: {line}")
    assert err.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


def test_each_wrong_option_has_its_line(capsys: pytest.CaptureFixture[str]) -> None:
    Path("file").write_bytes(b"")
    arguments = ["--size", "x", "--frames", "0", "--set", "colour=1", "--set", "texture=no", "--out", "file"]
    assert run(["render", "rotating-calcite", *arguments]) == 2
    assert [line.split(": ")[1] for line in capsys.readouterr().err.splitlines()] == [
        "--size",
        "--out",
        "--set texture",
        "--frames",
        "--set colour",
    ]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ([], "Missing command"),
        (["rneder"], "No such command 'rneder'"),
        (["render"], "Missing "),
        (["render", "rotating-calcite"], "Missing option '--out'"),
        (["serve", "--port", "70000"], "Invalid value for '--port': "),
        (["serve", "now"], "Got unexpected extra argument"),
    ],
)
def test_a_wrong_command_is_one_line(capsys: pytest.CaptureFixture[str], arguments: list[str], line: str) -> None:
    assert run(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"isogyre: {line}")
    assert err.count("\n") == 1


def test_complaints_keep_to_their_line(capsys: pytest.CaptureFixture[str]) -> None:
    complain("a\nb\x1b[31m\u2028c × «д»")
    assert capsys.readouterr().err == "isogyre: a\\nb\\x1b[31m\\u2028c × «д»\n"


def test_version_and_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["--version"]) == 0
    assert capsys.readouterr().out == f"isogyre {__version__}\n"
    assert run(["--help"]) == 0
    assert "render" in capsys.readouterr().out
    assert run(["render", "-h"]) == 0
    text = capsys.readouterr().out
    for option in ("--set", "--frames", "--size", "--quality", "--seed", "--workers", "--out"):
        assert option in text


def test_help_tells_the_true_defaults(capsys: pytest.CaptureFixture[str]) -> None:
    run(["render", "--help"])
    text = " ".join(capsys.readouterr().out.split())
    request = sequence.parse_request({"demonstration": "rotating-calcite"})
    width, height = request.size
    for default in (request.frames, f"{width}x{height}", request.quality, request.seed):
        assert f"[default: {default}]" in text


def test_help_loads_nothing_slow() -> None:
    script = """
import sys
from service.cli import run
assert run(["render", "--help"]) == 0
slow = {"numpy", "scipy", "fastapi", "distributed", "sqlalchemy", "PIL"} & set(sys.modules)
assert not slow, slow
"""
    subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, timeout=60)


def test_serve_hands_over_what_was_asked(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    calls: list[tuple[str, int, object]] = []
    monkeypatch.setattr(service.serve, "run", lambda *call: calls.append(call))
    monkeypatch.setenv("ISOGYRE_WORKERS", "3")
    assert run(["serve"]) == 0
    assert run(["serve", "--host", "::1", "--port", "0"]) == 0
    assert [(host, port) for host, port, _ in calls] == [("127.0.0.1", 8000), ("::1", 0)]
    assert {settings.workers for *_, settings in calls} == {3}
    monkeypatch.setenv("ISOGYRE_WORKERS", "many")
    assert run(["serve"]) == 2
    assert capsys.readouterr().err.startswith("isogyre: ISOGYRE_WORKERS: ")
    assert len(calls) == 2


def test_parameters_reach_the_renderer(capsys: pytest.CaptureFixture[str]) -> None:
    Path("photo.png").write_bytes(png((40, 30)))
    settings = {"mineral": "quartz", "gap_mm": 0.5, "marks": [[1, 2], [-3.5, 0]], "analyser_deg": 45, "cut": "block"}
    texts = [f"{key}={value if isinstance(value, str) else json.dumps(value)}" for key, value in settings.items()]
    sets = [part for text in [*texts, "texture=photo.png"] for part in ("--set", text)]
    assert run(["render", "rotating-calcite", *sets, "--seed", "7", *DEFAULTS, "--out", "out"]) == 0
    assert capsys.readouterr() == ("", "")
    manifest = read_manifest(Path("out"))
    told: dict[str, Any] = manifest["parameters"]
    assert {key: told[key] for key in settings} == settings
    assert told["texture"].startswith("asset:")
    assert (manifest["seed"], manifest["size"], manifest["quality"]) == (7, [64, 48], "draft")
    assert len(manifest["frames"]) == 2
    assert not list(Path(tempfile.gettempdir()).iterdir())


def test_a_texture_may_be_named_digits_or_like_json(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sequence, "render_tile", plain_tile)
    Path("5").write_bytes(png())
    for index, (text, start) in enumerate([("digits", "digits"), ('"digits"', "digits"), ("5", "asset:")]):
        out = f"out-{index}"
        assert run(["render", "rotating-calcite", "--set", f"texture={text}", *DEFAULTS, "--out", out]) == 0
        assert read_manifest(Path(out))["parameters"]["texture"].startswith(start)


def test_json_is_all_that_stdout_gets(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sequence, "render_tile", plain_tile)
    for _ in range(2):
        assert run(["render", "rotating-calcite", *DEFAULTS, "--out", "out", "--json"]) == 0
        out, err = capsys.readouterr()
        told = json.loads(out)
        assert Path(told["manifest"]) == Path("out/manifest.json").absolute()
        assert (told["frames"], told["complete"], err) == (2, True, "")


def test_a_finished_folder_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    command = ["render", "rotating-calcite", *DEFAULTS, "--out", "out"]
    assert run(command) == 0
    before = snapshot(Path("out"))

    def refuse(*_: object) -> None:
        raise AssertionError("nothing is to be rendered")

    monkeypatch.setattr(sequence, "render_tile", refuse)
    assert run(command) == 0
    assert snapshot(Path("out")) == before
    assert run([*command, "--workers", "2"]) == 0  # is no part of the request
    assert snapshot(Path("out")) == before


def test_another_request_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    command = ["render", "rotating-calcite", *DEFAULTS, "--out", "out"]
    assert run(command) == 0
    before = snapshot(Path("out"))
    assert run([*command, "--seed", "1"]) == 2
    assert capsys.readouterr().err == "isogyre: --out: out holds another sequence (seed differs); give another folder\n"
    assert snapshot(Path("out")) == before


def test_only_what_is_damaged_is_rendered_again(monkeypatch: pytest.MonkeyPatch) -> None:
    command = ["render", "rotating-calcite", *DEFAULTS, "--out", "out"]
    assert run(command) == 0
    before = snapshot(Path("out"))
    Path("out/frame-0001.png").write_bytes(before["frame-0001.png"][0][:-9])
    rendered = []
    render_tile = sequence.render_tile

    def note(request: sequence.RenderRequest, frame: int, tile: int, assets: Path) -> sequence.TileResult:
        rendered.append(frame)
        return render_tile(request, frame, tile, assets)

    monkeypatch.setattr(sequence, "render_tile", note)
    assert run(command) == 0
    assert rendered == [1]
    after = snapshot(Path("out"))
    assert {name: data for name, (data, _) in after.items() if name != "manifest.json"} == {
        name: data for name, (data, _) in before.items() if name != "manifest.json"
    }
    assert after["frame-0000.png"] == before["frame-0000.png"]
    assert read_manifest(Path("out"))["complete"]


def test_a_failure_is_one_line_its_trace_and_exit_code_1(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("the lattice came apart")

    monkeypatch.setattr(sequence, "render_tile", fail)
    assert run(["render", "rotating-calcite", *DEFAULTS, "--out", "out"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    first, *trace = err.splitlines()
    assert first == "isogyre: frame 0, tile 0 failed: RuntimeError: the lattice came apart"
    assert trace[0].startswith("Traceback")
    assert read_manifest(Path("out"))["complete"] is False


def test_a_full_disk_is_a_failure(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sequence, "render_tile", plain_tile)

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fail)
    assert run(["render", "rotating-calcite", *DEFAULTS, "--out", "out"]) == 1
    assert capsys.readouterr().err == "isogyre: a file: No space left on device\n"
    assert not Path("out").exists()
