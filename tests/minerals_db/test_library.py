"""The minerals there are: the user's own beside the built-in ones, varieties, the cache, the digest."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

import minerals_db
from minerals_db import MineralDataError, library, load_minerals
from minerals_db.store import read_minerals
from tests.minerals_db.test_store import SOUND

OWN = SOUND.encode()
VARIETY = """
id: blue-calcite
variety_of: calcite
names: {en: Blue calcite, ru: Голубой кальцит}
appearance: {colours: [blue], source: me, status: measured}
sources:
  me: {citation: My own notebook., licence: CC0 1.0}
""".encode()


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return a folder of the user's own minerals; what was loaded before is forgotten, before and after."""
    own = tmp_path / "own"
    own.mkdir()
    monkeypatch.setenv(library.OWN_FOLDER_VARIABLE, str(own))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    _forget()
    yield own
    _forget()


def _forget() -> None:
    for remembered in (
        library.builtin_minerals,
        library.own_minerals,
        library.all_minerals,
        library.data_digest,
        library._builtin_files,
        library._own_files,
    ):
        remembered.cache_clear()


def test_own_minerals_stand_beside_the_built_in_ones(folder: Path) -> None:
    (folder / "testite.yaml").write_bytes(OWN)
    (folder / "blue-calcite.yaml").write_bytes(VARIETY)
    found = minerals_db.minerals()
    assert found["testite"].origin == found["blue-calcite"].origin == "own"
    assert found["calcite"].origin == "built-in"
    assert list(found) == sorted(found)
    assert minerals_db.mineral("testite").names.en == "Testite"


def test_a_variety_takes_what_it_does_not_state(folder: Path) -> None:
    (folder / "blue-calcite.yaml").write_bytes(VARIETY)
    variety, mineral = minerals_db.mineral("blue-calcite"), minerals_db.mineral("calcite")
    assert variety.is_variety
    assert variety.dispersion == mineral.dispersion
    assert variety.cell == mineral.cell
    assert variety.names.en == "Blue calcite"
    assert variety.appearance is not None
    assert variety.appearance.colours == ("blue",)
    assert variety.absorption is None
    assert {"me", "ghosh-1999"} <= set(variety.sources)  # its own, and those of what it took


def test_an_own_mineral_cannot_stand_for_a_built_in_one(folder: Path) -> None:
    (folder / "calcite.yaml").write_bytes(OWN.replace(b"id: testite", b"id: calcite"))
    with pytest.raises(MineralDataError) as caught:
        minerals_db.minerals()
    assert str(caught.value) == f"{folder / 'calcite.yaml'}: id: 'calcite' is a built-in mineral: choose another id"


def test_faults_of_own_minerals_name_the_whole_path(folder: Path) -> None:
    (folder / "testite.yaml").write_bytes(OWN.replace(b"5.4", b".nan"))
    (folder / "other.yaml").write_bytes(b"id: [")
    with pytest.raises(MineralDataError) as caught:
        minerals_db.minerals()
    said = str(caught.value).splitlines()
    assert any(line.startswith(f"{folder / 'other.yaml'}: not YAML") for line in said)
    assert f"{folder / 'testite.yaml'}: cell.c_angstrom: Input should be a finite number" in said


def test_a_folder_that_is_not_there(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(library.OWN_FOLDER_VARIABLE, str(folder / "nowhere"))
    for question in (minerals_db.minerals, minerals_db.data_digest):
        with pytest.raises(MineralDataError, match=r"nowhere: ISOGYRE_MINERALS_DIR: No such file"):
            question()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (b"variety_of: calcite", b"variety_of: nothing", "variety_of: there is no mineral 'nothing'"),
        (b"variety_of: calcite", b"variety_of: 7", "variety_of: Input should be a valid string"),
        (b"names:", b"system: cubic\nnames:", "point_group: -3m is no cubic class"),
    ],
)
def test_faulty_varieties(folder: Path, old: bytes, new: bytes, said: str) -> None:
    (folder / "blue-calcite.yaml").write_bytes(VARIETY.replace(old, new))
    with pytest.raises(MineralDataError) as caught:
        load_minerals(folder, library.builtin_minerals())
    assert any(line.startswith(f"blue-calcite.yaml: {said}") for line in str(caught.value).splitlines())


def test_a_variety_of_a_variety_is_refused() -> None:
    second = VARIETY.replace(b"id: blue-calcite", b"id: sky-calcite").replace(b"of: calcite", b"of: blue-calcite")
    with pytest.raises(MineralDataError, match=r"sky-calcite.yaml: variety_of: 'blue-calcite' is a variety itself"):
        read_minerals({"blue-calcite.yaml": VARIETY, "sky-calcite.yaml": second}, library.builtin_minerals())


def test_what_is_wrong_with_a_mineral_is_not_said_of_its_varieties() -> None:
    wrong = OWN.replace(b"[400, 700]", b"[700, 400]")
    variety = VARIETY.replace(b"of: calcite", b"of: testite")
    with pytest.raises(MineralDataError) as caught:
        read_minerals({"testite.yaml": wrong, "blue-calcite.yaml": variety}, {})
    assert {fault.file for fault in caught.value.faults} == {"testite.yaml"}


def test_cache_gives_the_same_minerals(folder: Path) -> None:
    read = dict(library.builtin_minerals())
    file = folder.parent / "cache" / "isogyre" / "minerals.json"
    assert file.is_file()
    written = file.stat().st_mtime_ns
    _forget()
    assert dict(library.builtin_minerals()) == read
    assert file.stat().st_mtime_ns == written  # it was read, not made anew


def test_cache_of_other_data_or_a_damaged_one_is_not_believed(folder: Path) -> None:
    read = dict(library.builtin_minerals())
    file = folder.parent / "cache" / "isogyre" / "minerals.json"
    sound = file.read_bytes()
    for damaged in (b"0" * 64 + sound[64:], sound[: len(sound) // 2], sound.replace(b'"Calcite"', b"7"), b""):
        file.write_bytes(damaged)
        _forget()
        assert dict(library.builtin_minerals()) == read
        assert file.read_bytes() == sound


def test_without_a_place_for_the_cache(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder.parent / "file").write_text("", encoding="utf-8")
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder.parent / "file"))
    assert "calcite" in library.builtin_minerals()


def test_digest_follows_names_and_bytes(folder: Path) -> None:
    def digest(files: dict[str, bytes]) -> str:
        for file in folder.iterdir():
            file.unlink()
        for name, data in files.items():
            (folder / f"{name}.yaml").write_bytes(data)
        _forget()
        return minerals_db.data_digest()

    first = digest({"a": b"bc", "d": b""})
    assert len(first) == 64
    assert int(first, 16) > 0
    assert digest({"d": b"", "a": b"bc"}) == first
    others = {digest({"a": b"bd", "d": b""}), digest({"ab": b"c", "d": b""}), digest({"a": b"bc"}), digest({})}
    assert len(others | {first}) == 5


def test_published_schema_describes_the_files_there_are() -> None:
    schema = minerals_db.entry_schema()
    assert set(schema["properties"]) >= set(yaml.safe_load(OWN))
    assert schema["additionalProperties"] is False
