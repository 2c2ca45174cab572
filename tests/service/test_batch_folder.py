from __future__ import annotations

import errno
import hashlib
import json
from pathlib import Path
from typing import Any

import pytest

from crystal_core import sequence
from crystal_core.errors import InputError
from service import batch_folder
from service.batch_folder import BatchFolder, open_batch_folder, unusable_reason
from tests.service.batch_tools import never, read_manifest, small_request, snapshot


class StopError(Exception):
    pass


def fill(folder: BatchFolder, *indices: int) -> None:
    for index in indices:
        picture = f"picture {index}".encode()
        folder.add_frame(index, picture, seconds=1.5, error_estimate=0.01 * (index + 1), clipped_fraction=0.25)


def make(path: Path, *indices: int, film: bool = False, **changes: Any) -> None:
    with open_batch_folder(path, small_request(**changes), never) as folder:
        fill(folder, *indices)
        if film:
            folder.finish(b"film", 100)


def refusal(path: Path, **changes: Any) -> str:
    with pytest.raises(InputError) as caught, open_batch_folder(path, small_request(**changes), never):
        pass
    (fault,) = caught.value.faults
    assert fault.pointer == "--out"
    return fault.message


def test_a_new_folder_says_that_nothing_is_there_yet(tmp_path: Path) -> None:
    path = tmp_path / "a" / "b"
    with open_batch_folder(path, small_request(), never) as folder:
        assert [entry.name for entry in path.iterdir()] == ["manifest.json"]
        manifest = read_manifest(path)
        assert (manifest["complete"], manifest["frames"], manifest["animation"]) == (False, [], None)
        assert folder.missing == [0, 1, 2]
        assert not folder.complete


def test_the_manifest_follows_every_frame(tmp_path: Path) -> None:
    with open_batch_folder(tmp_path, small_request(), never) as folder:
        fill(folder, 2)
        assert read_manifest(tmp_path)["frames"] == [
            {
                "index": 2,
                "angle_deg": 240.0,
                "file": "frame-0002.png",
                "sha256": hashlib.sha256(b"picture 2").hexdigest(),
                "seconds": 1.5,
                "error_estimate": 0.03,
                "clipped_fraction": 0.25,
            }
        ]
        fill(folder, 0)
        manifest = read_manifest(tmp_path)
        assert [frame["index"] for frame in manifest["frames"]] == [0, 2]
        assert not manifest["complete"]
        assert folder.missing == [1]
        assert folder.read_frame(2) == b"picture 2"


def test_a_finished_folder_names_its_film(tmp_path: Path) -> None:
    make(tmp_path, 0, 1, 2, film=True)
    manifest = read_manifest(tmp_path)
    assert manifest["complete"]
    assert manifest["reproducible"] is True
    assert manifest["animation"] == {
        "file": "sequence.webp",
        "sha256": hashlib.sha256(b"film").hexdigest(),
        "frame_ms": 100,
    }
    before = snapshot(tmp_path)
    with open_batch_folder(tmp_path, small_request(), never) as folder:
        assert folder.complete
        assert folder.missing == []
    assert snapshot(tmp_path) == before


def test_what_is_there_is_kept(tmp_path: Path) -> None:
    make(tmp_path, 0, 2)
    before = snapshot(tmp_path)
    with open_batch_folder(tmp_path, small_request(), never) as folder:
        assert folder.missing == [1]
        fill(folder, 1)
        folder.finish(b"film", 100)
    after = snapshot(tmp_path)
    assert {name: after[name] for name in ("frame-0000.png", "frame-0002.png")} == {
        name: before[name] for name in ("frame-0000.png", "frame-0002.png")
    }
    assert [frame["seconds"] for frame in read_manifest(tmp_path)["frames"]] == [1.5] * 3


def test_damage_and_leftovers_are_cleared_away(tmp_path: Path) -> None:
    make(tmp_path, 0, 1, film=False)
    (tmp_path / "frame-0001.png").write_bytes(b"picture 7")  # damaged
    (tmp_path / "frame-0002.png").write_bytes(b"picture 2")  # written, but its run was killed before the manifest
    (tmp_path / ".frame-0002.png.0123456789ab.part").write_bytes(b"pic")
    (tmp_path / ".manifest.json.0123456789ab.part").write_bytes(b"{")
    (tmp_path / ".notes.part").write_bytes(b"somebody else's")
    (tmp_path / "frame-0003.png").write_bytes(b"somebody else's too")
    with open_batch_folder(tmp_path, small_request(), never) as folder:
        assert folder.missing == [1, 2]
        assert sorted(path.name for path in tmp_path.iterdir()) == [
            ".notes.part",
            "frame-0000.png",
            "frame-0003.png",
            "manifest.json",
        ]
        assert [frame["index"] for frame in read_manifest(tmp_path)["frames"]] == [0]


@pytest.mark.parametrize("damage", ["changed", "gone"])
def test_a_finished_folder_that_is_damaged_is_not_finished(tmp_path: Path, damage: str) -> None:
    for name, missing in (("frame-0001.png", [1]), ("sequence.webp", [])):
        path = tmp_path / name
        make(path, 0, 1, 2, film=True)
        (path / name).write_bytes(b"other") if damage == "changed" else (path / name).unlink()
        with open_batch_folder(path, small_request(), never) as folder:
            assert not folder.complete
            assert folder.missing == missing
            assert not read_manifest(path)["complete"]
            assert not (missing and (path / "sequence.webp").exists())  # a film of all frames or none


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frames": 4}, "frames differs"),
        ({"size": [160, 131]}, "size differs"),
        ({"seed": 1, "quality": "standard"}, "seed, quality differ"),
        ({"parameters": {"gap_mm": 0.5, "mineral": "quartz"}}, "gap_mm, mineral differ"),
    ],
)
def test_a_folder_of_another_request_is_refused_untouched(tmp_path: Path, changes: Any, words: str) -> None:
    make(tmp_path, 0)
    (tmp_path / ".frame-0002.png.0123456789ab.part").write_bytes(b"pic")
    before = snapshot(tmp_path)
    message = refusal(tmp_path, **changes)
    assert f"holds another sequence ({words})" in message
    assert snapshot(tmp_path) == before


def test_the_same_request_to_other_code_is_another_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(tmp_path, 0)
    before = snapshot(tmp_path)
    monkeypatch.setattr(sequence.RenderRequest, "digest", lambda _: "0" * 64)
    assert "another version" in refusal(tmp_path)
    assert snapshot(tmp_path) == before


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"request_digest": "a", "frames": 3}', "\xff", "[" * 100_000])
def test_a_manifest_of_something_else_is_refused_untouched(tmp_path: Path, text: str) -> None:
    (tmp_path / "manifest.json").write_bytes(text.encode("latin-1"))
    before = snapshot(tmp_path)
    assert "is no manifest of a sequence" in refusal(tmp_path)
    assert snapshot(tmp_path) == before


@pytest.mark.parametrize("name", ["frame-0002.png", "sequence.webp"])
def test_files_that_would_be_lost_are_a_reason_to_refuse(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"precious")
    before = snapshot(tmp_path)
    assert f"holds {name} but no manifest.json" in refusal(tmp_path)
    assert snapshot(tmp_path) == before


def test_a_manifest_cannot_point_elsewhere(tmp_path: Path) -> None:
    path = tmp_path / "out"
    make(path, 0)
    (tmp_path / "elsewhere.png").write_bytes(b"elsewhere")
    manifest = read_manifest(path)
    manifest["frames"][0] |= {"file": "../elsewhere.png", "sha256": hashlib.sha256(b"elsewhere").hexdigest()}
    manifest["frames"].append(manifest["frames"][0] | {"index": 9, "file": "frame-0009.png"})
    (path / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    with open_batch_folder(path, small_request(), never) as folder:
        assert folder.missing == [0, 1, 2]


def test_a_folder_has_one_user_at_a_time(tmp_path: Path) -> None:
    with open_batch_folder(tmp_path, small_request(), never) as folder:
        fill(folder, 0)
        assert "another isogyre" in refusal(tmp_path)
        assert folder.missing == [1, 2]
    with open_batch_folder(tmp_path, small_request(), never) as folder:
        assert folder.missing == [1, 2]


def test_a_file_system_without_locks_is_used_without(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(batch_folder.fcntl, "flock", refuse)
    make(tmp_path, 0)
    assert (tmp_path / "frame-0000.png").exists()


def test_stopping_while_frames_are_read_changes_nothing(tmp_path: Path) -> None:
    make(tmp_path, 0, 1)
    (tmp_path / "frame-0000.png").unlink()
    before = snapshot(tmp_path)

    def stop() -> None:
        raise StopError

    with pytest.raises(StopError), open_batch_folder(tmp_path, small_request(), stop):
        pass
    assert snapshot(tmp_path) == before


def test_a_full_disk_is_no_bad_input_and_leaves_no_new_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> str:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(batch_folder, "write_atomically", fail)
    with pytest.raises(OSError, match="No space") as caught:
        make(tmp_path / "a" / "b")
    assert not isinstance(caught.value, InputError)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("place", ["file", "file/below", "/proc/below", "/sys/below/deep", "dangling"])
def test_where_no_folder_can_be_is_bad_input(tmp_path: Path, place: str) -> None:
    (tmp_path / "file").write_bytes(b"x")
    (tmp_path / "dangling").symlink_to("nowhere")
    path = tmp_path / place
    refusal(path)
    assert not path.is_dir()
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["dangling", "file"]


def test_what_can_be_told_beforehand(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"x")
    (tmp_path / "dangling").symlink_to("nowhere")
    assert unusable_reason(tmp_path) is None
    assert unusable_reason(tmp_path / "a" / "b") is None
    for place in ("file", "file/below/deep", "dangling"):
        assert "is not a folder" in str(unusable_reason(tmp_path / place))
    assert "too long" in str(unusable_reason(tmp_path / ("x" * 300)))
