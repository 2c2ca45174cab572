"""Files under their content digest: written once, whole, and never changed."""

from __future__ import annotations

import contextlib
import hashlib
import os
from pathlib import Path

from crystal_core.output.files import PART_SUFFIX, write_atomically

__all__ = ["ArtifactStore", "make_folder"]


def make_folder(path: Path) -> None:
    """Make a folder and those above it, and see to it that they are on the disk.

    Raises
    ------
    OSError
        The folder cannot be made.
    """
    if path.is_dir():
        return
    make_folder(path.parent)
    with contextlib.suppress(FileExistsError):
        path.mkdir()
    # The new entry in the folder above must outlive a loss of power, like the files that will stand below it.
    descriptor = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


class ArtifactStore:
    """Artifacts on the local disk.

    Parameters
    ----------
    root : Path
        Folder of the store, made if missing. A file stands at ``root/<first two digits>/<digest>``.

    Raises
    ------
    OSError
        The folder cannot be made.
    """

    def __init__(self, root: Path) -> None:
        self._root = root
        make_folder(root)

    def put(self, data: bytes) -> str:
        """Keep some bytes.

        Parameters
        ----------
        data : bytes
            The whole content.

        Returns
        -------
        str
            Its SHA-256, 64 hexadecimal digits; on return the bytes are on the disk.

        Raises
        ------
        OSError
            The disk is full or not writable; nothing half is left.
        """
        digest = hashlib.sha256(data).hexdigest()
        path = self.path(digest)
        if not path.exists():
            make_folder(path.parent)
            write_atomically(path, data)
        return digest

    def path(self, digest: str) -> Path:
        """Return where the artifact of this digest stands, whether it exists or not."""
        return self._root / digest[:2] / digest

    def sweep(self) -> int:
        """Remove what a dying process left half-written; return the number of files. Only while nobody writes."""
        leftovers = list(self._root.glob(f"*/.*{PART_SUFFIX}"))
        for path in leftovers:
            path.unlink(missing_ok=True)
        return len(leftovers)
