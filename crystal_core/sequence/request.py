"""What every request for a sequence has, whatever it shows."""

from __future__ import annotations

import hashlib
import json
from abc import ABC, abstractmethod
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

import pydantic
from pydantic import BaseModel, ConfigDict

import crystal_core
import minerals_db
from crystal_core.errors import Fault
from crystal_core.scene import StagedScene

__all__ = ["MAX_FRAMES", "MAX_SEED", "MAX_SIDE", "MIN_SIDE", "RenderRequest", "code_digest", "faults_of"]

MAX_FRAMES = 360
MIN_SIDE, MAX_SIDE = 16, 2048
MAX_SEED = 2**63 - 1


class RenderRequest(BaseModel, ABC):
    """A sequence asked for, every default filled in. Make it with `parse_request`.

    Parameters
    ----------
    frames : int
        Number of frames, 1–360.
    size : tuple of int
        Width and height in pixels, each 16–2048.
    quality : str
        "draft", "standard" or "fine".
    seed : int
        Of the random numbers, 0 … 2⁶³ − 1.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    frames: int
    size: tuple[int, int]
    quality: Literal["draft", "standard", "fine"]
    seed: int

    @property
    @abstractmethod
    def name(self) -> str:
        """A word for what is shown: a demonstration's name, or "scene"."""

    @abstractmethod
    def angle_deg(self, index: int) -> float:
        """Return the stage angle of a frame, in degrees, counter-clockwise seen from above."""

    @abstractmethod
    def staged(self, index: int, assets: Path | None) -> StagedScene:
        """Return what a frame shows; what frames share is staged once per process.

        Parameters
        ----------
        index : int
            Which frame.
        assets : Path, optional
            Folder of files that the request names as ``asset:<sha256>``.
        """

    @abstractmethod
    def described(self) -> dict[str, Any]:
        """Return what a manifest says of the scene, as JSON-able values; no asset is looked at."""

    def canonical(self) -> dict[str, Any]:
        """Return the request as JSON-able values, every default filled in."""
        return self.model_dump(mode="json")

    def digest(self) -> str:
        """Return the sha256 (hex) of the request with the mineral data and the code that answer it."""
        text = json.dumps(
            {"request": self.canonical(), "data": minerals_db.data_digest(), "code": code_digest()},
            sort_keys=True,
            separators=(",", ":"),
        )
        return hashlib.sha256(text.encode()).hexdigest()


@lru_cache(maxsize=1)
def code_digest() -> str:
    """Return the sha256 (hex) of this package's sources and tables: what else a picture depends on."""
    root = Path(crystal_core.__file__).parent
    digest = hashlib.sha256()
    for path in sorted(path for path in root.rglob("*") if path.suffix in {".py", ".csv"}):
        digest.update(path.relative_to(root).as_posix().encode() + b"\0")
        digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def faults_of(error: pydantic.ValidationError, prefix: str) -> list[Fault]:
    """Return what a model refuses, at JSON pointers below a prefix."""
    faults = []
    for detail in error.errors(include_url=False):
        pointer = prefix + "".join(f"/{_escaped(str(part))}" for part in detail["loc"])
        message = "unknown key" if detail["type"] == "extra_forbidden" else detail["msg"]
        faults.append(Fault(pointer, f"{message[0].lower()}{message[1:]}{_shown(detail)}"))
    return faults


def _shown(detail: Any) -> str:
    """Return the offending value, if it is short enough to help."""
    if detail["type"] in {"missing", "extra_forbidden"}:
        return ""
    text = json.dumps(detail["input"], default=str, ensure_ascii=False)
    return f", not {text}" if len(text) <= 60 else ""


def _escaped(part: str) -> str:
    return part.replace("~", "~0").replace("/", "~1")
