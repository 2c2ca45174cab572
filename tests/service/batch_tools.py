"""What the tests of the batch and of the command line share."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from crystal_core import sequence

Snapshot = Mapping[str, tuple[bytes, int]]


def small_request(**changes: Any) -> sequence.RenderRequest:
    """A request that takes a moment: 3 frames of 4 tiles if size and quality are left alone."""
    asked = {"demonstration": "rotating-calcite", "frames": 3, "size": [160, 130], "quality": "draft"}
    return sequence.parse_request(asked | changes)


def plain_tile(
    request: sequence.RenderRequest,
    frame: int,
    tile: int,
    assets: Path | None = None,  # noqa: ARG001
) -> sequence.TileResult:
    """Stand in for the renderer: a tile of one colour that tells frame and tile apart."""
    place = sequence.tile_grid(request)[tile]
    pixels = np.empty((place.y1 - place.y0, place.x1 - place.x0, 3), np.float32)
    pixels[:] = (frame / request.frames, tile / 8, 0.5)
    return sequence.TileResult(place, pixels, 0.01, 0.25, {}, 0)


def snapshot(folder: Path) -> Snapshot:
    """Every file of a folder: content and time of the last change, by name."""
    return {
        str(path.relative_to(folder)): (path.read_bytes(), path.stat().st_mtime_ns)
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def contents(folder: Path) -> dict[str, bytes]:
    """What must not depend on who rendered when: every file but the manifest, which holds seconds."""
    return {name: data for name, (data, _) in snapshot(folder).items() if name != "manifest.json"}


def read_manifest(folder: Path) -> dict[str, Any]:
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    assert isinstance(manifest, dict)
    return manifest


def never() -> None:
    """Never ask to stop."""
