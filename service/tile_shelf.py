"""Results of units, kept until their frame is finished, so that a restart does not lose them."""

from __future__ import annotations

import hashlib
import pickle
import shutil
from collections.abc import Iterable
from pathlib import Path

from crystal_core import sequence
from crystal_core.output.files import write_atomically
from service.artifacts import make_folder

__all__ = ["TileShelf"]


class TileShelf:
    """Files ``root/<run>/<frame>-<tile>``, each one pickled tile result.

    A pickle is read only if its bytes have the digest that the ledger knows, and never under another version of the
    code: a run whose digest (which covers the code) has changed begins anew.

    Parameters
    ----------
    root : Path
        Folder of the shelf, made if missing.

    Raises
    ------
    OSError
        The folder cannot be made.
    """

    def __init__(self, root: Path) -> None:
        self._root = root
        make_folder(root)

    def put(self, run_id: str, frame: int, tile: int, result: sequence.TileResult) -> str:
        """Keep a result; return the SHA-256 of its file, for the ledger.

        Raises
        ------
        OSError
            The disk is full or not writable; nothing half is left.
        """
        path = self._path(run_id, frame, tile)
        make_folder(path.parent)
        return write_atomically(path, pickle.dumps(result, protocol=5))

    def get(self, run_id: str, frame: int, tile: int, digest: str | None) -> sequence.TileResult | None:
        """Return a kept result, or None if its file is missing or is not the one of this digest."""
        try:
            data = self._path(run_id, frame, tile).read_bytes()
        except FileNotFoundError:
            return None
        if hashlib.sha256(data).hexdigest() != digest:
            return None
        result: sequence.TileResult = pickle.loads(data)
        return result

    def drop_frame(self, run_id: str, frame: int) -> None:
        """Remove the results of a finished frame."""
        for path in (self._root / run_id).glob(f"{frame:04d}-*"):
            path.unlink(missing_ok=True)

    def drop_run(self, run_id: str) -> None:
        """Remove all results of a run."""
        shutil.rmtree(self._root / run_id, ignore_errors=True)

    def sweep(self, live: Iterable[str]) -> int:
        """Remove what belongs to no live run; return the number of runs removed. Only while nobody writes."""
        dead = {path.name for path in self._root.iterdir()} - set(live)
        for run_id in dead:
            self.drop_run(run_id)
        return len(dead)

    def _path(self, run_id: str, frame: int, tile: int) -> Path:
        return self._root / run_id / f"{frame:04d}-{tile:05d}"
