"""Scenes in files: YAML without its traps, JSON, files that they name."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest

from crystal_core.errors import InputError
from crystal_core.scene import SceneFiles, read_scene

SCENE = "isogyre: 1\nbodies:\n  a:\n    mineral: calcite\n    shape: {habit: {}}\n"


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def reason(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_scene(path)
    (fault,) = caught.value.faults
    assert fault.pointer == ""
    return fault.message


def test_yaml_and_json_are_the_same(tmp_path: Path) -> None:
    scene = read_scene(written(tmp_path, "a.yaml", SCENE))
    assert read_scene(written(tmp_path, "a.yml", scene.to_yaml(full=True))) == scene
    assert read_scene(written(tmp_path, "a.json", scene.to_json())) == scene
    assert scene.title is None


def test_unicode_and_canonical_order(tmp_path: Path) -> None:
    scene = read_scene(written(tmp_path, "a.yaml", "title: Кальцит\n" + SCENE))
    assert scene.to_yaml().splitlines()[:2] == ["isogyre: 1", "title: Кальцит"]
    assert list(json.loads(scene.to_json())) == ["isogyre", "title", "bodies"]


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.yaml", "isogyre: 1\nbodies: [1\nx: 2\n", "line 3"),
        ("a.yaml", SCENE + "isogyre: 1\n", "repeated key 'isogyre', line 6"),
        ("a.yaml", "- 1\n", "must hold a mapping"),
        ("a.yaml", "isogyre: !!python/object/apply:os.getcwd []\n", "line 1"),
        ("a.json", '{"isogyre": 1, "isogyre": 1}', "repeated key 'isogyre'"),
        ("a.json", '{"isogyre": NaN}', "NaN is no number"),
        ("a.json", "[1]", "must hold an object"),
        ("a.json", "{", "not JSON"),
        ("a.json", "[" * 100_000, "not JSON"),
        ("a.txt", SCENE, "a scene is a file .yaml, .yml, .json"),
    ],
)
def test_broken_files(tmp_path: Path, name: str, text: str, words: str) -> None:
    told = reason(written(tmp_path, name, text))
    assert name in told
    assert words in told


def test_a_missing_and_a_huge_file(tmp_path: Path) -> None:
    assert "cannot read" in reason(tmp_path / "none.yaml")
    assert "bytes" in reason(written(tmp_path, "big.yaml", "# " + "x" * (4 * 1024 * 1024)))


def test_yaml_that_stands_for_gigabytes(tmp_path: Path) -> None:
    lines = ["a0: &a0 [1,1,1,1,1,1,1,1,1,1]"]
    lines += [f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 9)]
    assert "values" in reason(written(tmp_path, "bomb.yaml", "\n".join(lines)))


def test_files_are_relative_to_the_scene(tmp_path: Path) -> None:
    written(tmp_path, "page.png", "no picture")
    text = "isogyre: 1\nsurfaces: {p: {print: page.png}}\n"
    scene = read_scene(written(tmp_path, "a.yaml", text))
    assert scene.file_references() == (("/surfaces/p/print", "page.png"),)
    assert SceneFiles(folder=tmp_path).read("page.png", "/x") == b"no picture"
    with pytest.raises(InputError, match=r"/x: cannot read other\.png"):
        SceneFiles(folder=tmp_path).read("other.png", "/x")
    with pytest.raises(InputError, match="upload the file"):
        SceneFiles().read("page.png", "/x")


@pytest.mark.parametrize("name", ["/etc/a.png", "~/a.png", "file:a.png", "C:a.png"])
def test_paths_leave_no_doubt(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="relative to the file"):
        read_scene(written(tmp_path, "a.yaml", f"isogyre: 1\nsurfaces: {{p: {{print: '{name}'}}}}\n"))


def test_assets_are_named_by_their_bytes(tmp_path: Path) -> None:
    digest = hashlib.sha256(b"bytes").hexdigest()
    (tmp_path / digest).write_bytes(b"bytes")
    assert SceneFiles(assets=tmp_path).read(f"asset:{digest}", "/x") == b"bytes"
    with pytest.raises(InputError, match="/x: unknown asset"):
        SceneFiles(assets=tmp_path).read(f"asset:{'0' * 64}", "/x")
