from __future__ import annotations

import concurrent.futures
import errno
import io
import random
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
import pytest
from PIL import Image

from crystal_core import sequence
from crystal_core.output.images import decode_png, encode_animated_webp, encode_png
from crystal_core.spectra.colour import to_srgb8
from service import batch_folder
from service.batch import UNITS_PER_WORKER, Batch, BatchError
from service.batch_folder import open_batch_folder
from service.engine import InlineEngine
from tests.service.batch_tools import contents, never, plain_tile, read_manifest, small_request, snapshot


class StopError(Exception):
    pass


class ShuffledEngine:
    """Runs units in an order of its own, each only when the batch waits; notes how many were in flight."""

    workers = 2

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._queue: list[tuple[concurrent.futures.Future[Any], Callable[[], Any]]] = []
        self.most_in_flight = 0

    def submit(
        self, function: Callable[..., Any], /, *args: object, key: str, priority: int = 0
    ) -> concurrent.futures.Future[Any]:
        assert key
        assert priority == 0
        future: concurrent.futures.Future[Any] = concurrent.futures.Future()
        self._queue.append((future, lambda: function(*args)))
        self.most_in_flight = max(self.most_in_flight, len(self._queue))
        return future

    def run_one(self) -> None:
        future, work = self._queue.pop(self._random.randrange(len(self._queue)))
        future.set_result(work())

    def close(self) -> None:
        pass

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        pass


@pytest.fixture
def plain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sequence, "render_tile", plain_tile)


def render(path: Path, request: sequence.RenderRequest, keep_on: Callable[[], None] = never) -> int:
    """Render what is missing; return how many units that took."""
    done = 0

    def count() -> None:
        nonlocal done
        done += 1

    with open_batch_folder(path, request, never) as folder, InlineEngine() as engine:
        batch = Batch(folder, path, keep_on)
        units = batch.units
        batch.render(engine, count)
        batch.finish()
    assert done == units
    return done


def test_the_files_are_the_renderers_pictures(tmp_path: Path) -> None:
    request = small_request(size=[40, 30], frames=2)
    assert render(tmp_path, request) == 2
    pictures = []
    manifest = read_manifest(tmp_path)
    for index, record in enumerate(manifest["frames"]):
        frame = sequence.assemble(
            request, [sequence.render_tile(request, index, tile) for tile in range(len(sequence.tile_grid(request)))]
        )
        pictures.append(to_srgb8(frame.linear)[0])
        assert (tmp_path / f"frame-000{index}.png").read_bytes() == encode_png(pictures[-1])
        assert record["error_estimate"] == frame.error_estimate
        assert record["angle_deg"] == 180.0 * index
    assert (tmp_path / "sequence.webp").read_bytes() == encode_animated_webp(pictures, 200)
    assert manifest["complete"]
    assert sorted(snapshot(tmp_path)) == ["frame-0000.png", "frame-0001.png", "manifest.json", "sequence.webp"]


@pytest.mark.usefixtures("plain")
def test_whatever_ends_first_the_bytes_are_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    request = small_request(frames=6)
    assert len(sequence.tile_grid(request)) == 4
    render(tmp_path / "inline", request)
    wait = concurrent.futures.wait
    for seed in range(3):
        engine = ShuffledEngine(seed)

        def run_and_wait(futures: Any, timeout: float, when: str, engine: ShuffledEngine = engine) -> Any:
            engine.run_one()
            return wait(futures, timeout, when)

        monkeypatch.setattr(concurrent.futures, "wait", run_and_wait)
        with open_batch_folder(tmp_path / str(seed), request, never) as folder:
            batch = Batch(folder, tmp_path, never)
            batch.render(engine, never)
            batch.finish()
        monkeypatch.undo()
        monkeypatch.setattr(sequence, "render_tile", plain_tile)
        assert contents(tmp_path / str(seed)) == contents(tmp_path / "inline")
        assert engine.most_in_flight == UNITS_PER_WORKER * engine.workers < batch.units


@pytest.mark.usefixtures("plain")
@pytest.mark.parametrize("units", [1, 3, 4, 9, 11])
def test_a_batch_that_was_stopped_goes_on_to_the_same_bytes(tmp_path: Path, units: int) -> None:
    request = small_request()
    render(tmp_path / "whole", request)
    path = tmp_path / "stopped"
    done = 0

    def stop() -> None:
        nonlocal done
        done += 1
        if done == units:
            raise StopError

    with open_batch_folder(path, request, never) as folder, InlineEngine() as engine:
        batch = Batch(folder, tmp_path, never)
        with pytest.raises(StopError):
            batch.render(engine, stop)
    manifest = read_manifest(path)
    assert not manifest["complete"]
    named = [frame["file"] for frame in manifest["frames"]]
    assert sorted(snapshot(path)) == [*named, "manifest.json"]
    assert render(path, request) == 4 * (3 - len(named))
    assert contents(path) == contents(tmp_path / "whole")
    assert read_manifest(path)["complete"]


@pytest.mark.usefixtures("plain")
def test_a_stop_during_the_film_leaves_the_frames(tmp_path: Path) -> None:
    request = small_request()
    with open_batch_folder(tmp_path, request, never) as folder, InlineEngine() as engine:
        batch = Batch(folder, tmp_path, never)
        batch.render(engine, never)
        asked = 0

        def stop() -> None:
            nonlocal asked
            asked += 1
            if asked == 2:
                raise StopError

        with pytest.raises(StopError):
            Batch(folder, tmp_path, stop).finish()
    assert sorted(snapshot(tmp_path)) == ["frame-0000.png", "frame-0001.png", "frame-0002.png", "manifest.json"]
    assert not read_manifest(tmp_path)["complete"]
    assert render(tmp_path, request) == 0
    assert read_manifest(tmp_path)["complete"]


def test_a_unit_that_fails_ends_the_batch_and_keeps_what_is_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[tuple[int, int]] = []

    def fail_late(request: sequence.RenderRequest, frame: int, tile: int, assets: Path | None) -> sequence.TileResult:
        begun.append((frame, tile))
        if (frame, tile) == (1, 2):
            raise RuntimeError("the lattice came apart")
        return plain_tile(request, frame, tile, assets)

    monkeypatch.setattr(sequence, "render_tile", fail_late)
    request = small_request(frames=30)
    with (
        open_batch_folder(tmp_path, request, never) as folder,
        InlineEngine() as engine,
        pytest.raises(BatchError, match="frame 1, tile 2 failed: RuntimeError: the lattice came apart") as caught,
    ):
        Batch(folder, tmp_path, never).render(engine, never)
    assert isinstance(caught.value.__cause__, RuntimeError)
    assert sorted(snapshot(tmp_path)) == ["frame-0000.png", "manifest.json"]
    assert not read_manifest(tmp_path)["complete"]
    assert len(begun) < 20


@pytest.mark.usefixtures("plain")
def test_a_disk_that_is_full_keeps_what_is_finished(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write = batch_folder.write_atomically

    def fail_late(path: Path, data: bytes) -> str:
        if path.name == "frame-0001.png":
            raise OSError(errno.ENOSPC, "No space left on device", str(path))
        return write(path, data)

    request = small_request()
    with open_batch_folder(tmp_path, request, never) as folder, InlineEngine() as engine:
        monkeypatch.setattr(batch_folder, "write_atomically", fail_late)
        with pytest.raises(OSError, match="No space"):
            Batch(folder, tmp_path, never).render(engine, never)
    monkeypatch.setattr(batch_folder, "write_atomically", write)
    assert sorted(snapshot(tmp_path)) == ["frame-0000.png", "manifest.json"]
    assert render(tmp_path, request) == 8
    assert read_manifest(tmp_path)["complete"]


@pytest.mark.usefixtures("plain")
def test_the_film_shows_every_frame(tmp_path: Path) -> None:
    render(tmp_path, small_request(frames=5))
    with Image.open(io.BytesIO((tmp_path / "sequence.webp").read_bytes())) as film:
        assert film.n_frames == 5
        for index in range(5):
            film.seek(index)
            film.load()
            picture = decode_png((tmp_path / f"frame-000{index}.png").read_bytes())
            assert np.abs(np.asarray(film.convert("RGB")).astype(int) - picture).mean() < 3
