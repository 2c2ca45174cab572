"""A stand-in for ``crystal_core.sequence`` whose units do as the test says; worker processes import it by name.

Its one demonstration, ``fake``, has the parameters ``delay_s`` (per unit), ``gate`` (path of a file without which no
unit ends), ``fail`` ([frame, tile]: that unit raises), ``die`` ([frame, tile]: that unit ends its process), ``notes``
(path of a file to which each unit adds a line) and ``texture``.
"""

from __future__ import annotations

import hashlib
import json
import os
import signal
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from pydantic import BaseModel, Field

from crystal_core.errors import Fault, InputError

NAMES = (
    "FrameRecord",
    "RenderRequest",
    "TileResult",
    "assemble",
    "demonstrations",
    "frame_angle_deg",
    "manifest",
    "parse_request",
    "read_request",
    "render_tile",
    "tile_grid",
)
"""What takes the place of the real thing."""

TILE = 16
VERSION = {"code": "1"}


class Parameters(BaseModel, extra="forbid"):
    delay_s: float = Field(default=0.0, title="Delay", description="Of each unit")
    gate: str | None = None
    fail: tuple[int, int] | None = None
    die: tuple[int, int] | None = None
    notes: str | None = None
    texture: str = "digits"


@dataclass(frozen=True)
class Tile:
    x0: int
    y0: int
    x1: int
    y1: int


@dataclass(frozen=True)
class TileResult:
    tile: Tile
    pixels: np.ndarray
    squared_error: float
    seconds: float
    stages: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Frame:
    linear: np.ndarray
    error_estimate: float
    seconds: float


@dataclass(frozen=True)
class FrameRecord:
    index: int
    angle_deg: float
    file: str
    sha256: str
    seconds: float
    error_estimate: float
    clipped_fraction: float


class RenderRequest(BaseModel, frozen=True):
    demonstration: str
    parameters: Parameters
    frames: int
    size: tuple[int, int]
    quality: str
    seed: int

    def canonical(self) -> dict[str, Any]:
        return self.model_dump(mode="json")

    def digest(self) -> str:
        return hashlib.sha256(json.dumps([self.canonical(), VERSION]).encode()).hexdigest()


def demonstrations() -> Mapping[str, Any]:
    words = {"en": "Fake", "ru": "Подделка"}
    return {"fake": SimpleNamespace(name="fake", title=words, summary=words, Parameters=Parameters)}


def parse_request(obj: Mapping[str, object], assets: Path | None = None) -> RenderRequest:  # noqa: ARG001
    faults = [Fault(f"/{key}", "unknown") for key in set(obj) - set(RenderRequest.model_fields)]
    if obj.get("demonstration") != "fake":
        faults.append(Fault("/demonstration", "unknown"))
    size = obj.get("size", [32, 32])
    if not isinstance(size, list | tuple) or any(not 16 <= side <= 2048 for side in size):
        faults.append(Fault("/size", "16 to 2048"))
    if faults:
        raise InputError(faults)
    return RenderRequest(**{"parameters": {}, "frames": 3, "size": size, "quality": "draft", "seed": 0, **obj})


def read_request(obj: Mapping[str, object]) -> RenderRequest:
    return parse_request(obj)


def tile_grid(request: RenderRequest) -> tuple[Tile, ...]:
    width, height = request.size
    return tuple(
        Tile(x, y, min(x + TILE, width), min(y + TILE, height))
        for y in range(0, height, TILE)
        for x in range(0, width, TILE)
    )


def render_tile(request: RenderRequest, frame: int, tile: int, assets: Path | None = None) -> TileResult:
    assert assets is None or assets.is_dir()
    how = request.parameters
    time.sleep(how.delay_s)
    if how.notes:
        with Path(how.notes).open("a", encoding="utf-8") as file:
            file.write(f"{frame} {tile}\n")
    deadline = time.monotonic() + 90
    while how.gate and not Path(how.gate).exists():
        if time.monotonic() > deadline:
            raise TimeoutError(how.gate)
        time.sleep(0.005)
    if how.fail == (frame, tile):
        raise RuntimeError("the lattice came apart")
    if how.die == (frame, tile):
        os.kill(os.getpid(), signal.SIGKILL)
    place = tile_grid(request)[tile]
    y, x = np.mgrid[place.y0 : place.y1, place.x0 : place.x1]
    width, height = request.size
    pixels = np.stack([x / width, y / height, np.full_like(x, frame / request.frames, float)], -1).astype(np.float32)
    return TileResult(place, pixels, 0.01 * pixels[..., 0].size, 0.25)


def assemble(request: RenderRequest, results: Iterable[TileResult]) -> Frame:
    width, height = request.size
    linear = np.full((height, width, 3), np.nan, np.float32)
    seconds = 0.0
    for result in results:
        linear[result.tile.y0 : result.tile.y1, result.tile.x0 : result.tile.x1] = result.pixels
        seconds += result.seconds
    assert np.isfinite(linear).all()
    return Frame(linear, 0.1, seconds)


def frame_angle_deg(request: RenderRequest, index: int) -> float:
    return 360.0 * index / request.frames


def manifest(request: RenderRequest, frames: Sequence[FrameRecord], complete: bool) -> dict[str, Any]:
    return {**request.canonical(), "frames": [asdict(frame) for frame in frames], "complete": complete}


def stay_cold() -> None:
    """Take the place of a worker's warm-up: units of the stand-in need none."""
