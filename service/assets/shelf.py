"""The assets of a service: checked before they are kept, under the digest of their bytes, and never changed."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from crystal_core.errors import InputError, IsogyreError
from crystal_core.output.files import PART_SUFFIX, write_atomically
from service.artifacts import make_folder
from service.assets.checker import CPU_S

__all__ = ["Asset", "AssetShelf", "CheckerFailedError", "ShelfBusyError"]

CHECKS = 2
"""Files that are read at the same time."""

PATIENCE_S = 60.0
"""How long a file waits for its turn, and how long the reading of it may take by the clock."""

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"), "1")


class ShelfBusyError(IsogyreError):
    """Too many files are being read."""


class CheckerFailedError(IsogyreError):
    """The process that reads a file has failed, not the file."""


@dataclass(frozen=True)
class Asset:
    """An asset that is kept.

    Parameters
    ----------
    digest : str
        SHA-256 of its bytes.
    size : int
        Bytes.
    kind : str
        "texture" or "mesh".
    facts : dict
        What it is.
    notes : tuple of str
        What will be mended or left out when it is used.
    """

    digest: str
    size: int
    kind: str
    facts: dict[str, Any]
    notes: tuple[str, ...]

    @property
    def name(self) -> str:
        """What scenes call it."""
        return f"asset:{self.digest}"


class AssetShelf:
    """Assets in a folder: each stands at ``folder/<digest>``, what is known of it at ``folder/<digest>.json``.

    Parameters
    ----------
    folder : Path
        Made if missing; renderers read the files there.

    Raises
    ------
    OSError
        The folder cannot be made.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        make_folder(folder)
        self._turns = threading.BoundedSemaphore(CHECKS)

    def put(self, data: bytes, suffix: str) -> tuple[Asset, bool]:
        """Check a file and keep it; one that is kept already is not looked at again.

        Parameters
        ----------
        data : bytes
            The file.
        suffix : str
            What it is, such as ``.ply``.

        Returns
        -------
        Asset
            It is on the disk.
        bool
            Whether it is new.

        Raises
        ------
        InputError
            With pointer "": what is wrong with the file.
        ShelfBusyError
            Other files are being read; a later try may succeed.
        CheckerFailedError
            The file could not be read for a reason of ours.
        OSError
            The disk is full or not writable; nothing of the file is kept.
        """
        digest = hashlib.sha256(data).hexdigest()
        known = self.get(digest)
        if known is not None:
            return known, False
        answer = self._checked(data, suffix)
        if "refused" in answer:
            raise InputError.at("", str(answer["refused"]))
        text = json.dumps({"size": len(data), **answer}, ensure_ascii=False)
        write_atomically(self._facts_path(digest), text.encode())  # first: whoever finds the file finds its facts
        write_atomically(self.folder / digest, data)
        return self._asset(digest), True

    def get(self, digest: str) -> Asset | None:
        """Return an asset, None if there is none of this digest (64 hexadecimal digits)."""
        return self._asset(digest) if (self.folder / digest).is_file() else None

    def sweep(self) -> int:
        """Remove what a dying process left half-written; return the number of files. Only while nobody writes."""
        leftovers = list(self.folder.glob(f".*{PART_SUFFIX}"))
        for path in leftovers:
            path.unlink(missing_ok=True)
        return len(leftovers)

    def _asset(self, digest: str) -> Asset:
        known = json.loads(self._facts_path(digest).read_bytes())
        return Asset(digest, known["size"], known["kind"], known["facts"], tuple(known["notes"]))

    def _facts_path(self, digest: str) -> Path:
        return self.folder / f"{digest}.json"

    def _checked(self, data: bytes, suffix: str) -> dict[str, Any]:
        if not self._turns.acquire(timeout=PATIENCE_S):
            raise ShelfBusyError("Other files are being read")
        try:
            done = subprocess.run(
                [sys.executable, "-P", "-m", "service.assets.checker", suffix],
                input=data,
                capture_output=True,
                timeout=PATIENCE_S,
                check=False,
                env={**os.environ, **_ONE_THREAD},
            )
        except subprocess.TimeoutExpired:
            return {"refused": f"reading it takes more than {PATIENCE_S:g} s"}
        finally:
            self._turns.release()
        if done.returncode < 0:  # by a signal: the limit of time, or of memory where the system counts it otherwise
            return {"refused": f"reading it takes more than {CPU_S} s, or too much memory"}
        if done.returncode != 0:
            raise CheckerFailedError(done.stderr.decode(errors="replace").strip().rpartition("\n")[2])
        answer: dict[str, Any] = json.loads(done.stdout)
        return answer
