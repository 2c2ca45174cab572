"""The store of artifacts and the shelf of units' results."""

from __future__ import annotations

import hashlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from service.artifacts import ArtifactStore
from service.tile_shelf import TileShelf


def test_bytes_stand_under_their_digest(tmp_path: Path) -> None:
    store = ArtifactStore(tmp_path / "deep" / "store")
    digest = store.put(b"calcite")
    assert digest == hashlib.sha256(b"calcite").hexdigest()
    assert store.path(digest).read_bytes() == b"calcite"
    assert store.path(digest).relative_to(tmp_path) == Path("deep/store") / digest[:2] / digest


def test_what_is_there_is_not_written_again(tmp_path: Path) -> None:
    store = ArtifactStore(tmp_path)
    path = store.path(store.put(b"calcite"))
    before = path.stat()
    store.put(b"calcite")
    assert (path.stat().st_ino, path.stat().st_mtime_ns) == (before.st_ino, before.st_mtime_ns)


def test_many_threads_may_put_the_same(tmp_path: Path) -> None:
    store = ArtifactStore(tmp_path)
    with ThreadPoolExecutor(8) as threads:
        digests = set(threads.map(store.put, [b"calcite" * 10000] * 32))
    assert len(digests) == 1
    assert [path.name for path in tmp_path.glob("*/*")] == list(digests)


def test_an_unwritable_store_is_an_error_at_once(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(OSError, match="Not a directory"):
        ArtifactStore(tmp_path / "file" / "store")


def test_a_result_comes_back_only_as_it_was_put(tmp_path: Path) -> None:
    shelf = TileShelf(tmp_path)
    digest = shelf.put("RUN", 3, 7, {"any": "result"})  # type: ignore[arg-type]
    assert shelf.get("RUN", 3, 7, digest) == {"any": "result"}
    assert shelf.get("RUN", 3, 7, "0" * 64) is None
    assert shelf.get("RUN", 3, 7, None) is None
    assert shelf.get("RUN", 3, 8, digest) is None
    (path,) = tmp_path.glob("RUN/*")
    path.write_bytes(path.read_bytes()[:-1])
    assert shelf.get("RUN", 3, 7, digest) is None


def test_frames_and_runs_are_dropped_alone(tmp_path: Path) -> None:
    shelf = TileShelf(tmp_path)
    kept = {(run, frame): shelf.put(run, frame, 0, (run, frame)) for run in "AB" for frame in (1, 10)}  # type: ignore[arg-type]
    shelf.drop_frame("A", 1)
    assert shelf.get("A", 1, 0, kept["A", 1]) is None
    assert shelf.get("A", 10, 0, kept["A", 10]) == ("A", 10)
    assert shelf.sweep(["A"]) == 1
    assert shelf.get("B", 1, 0, kept["B", 1]) is None
    assert shelf.get("A", 10, 0, kept["A", 10]) == ("A", 10)
