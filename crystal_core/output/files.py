"""Files that are either whole or not there."""

from __future__ import annotations

import contextlib
import hashlib
import os
import secrets
from pathlib import Path

__all__ = ["PART_SUFFIX", "file_digest", "write_atomically"]

PART_SUFFIX = ".part"
"""Ending of a file that is still being written; its name begins with a dot."""

_READ_BYTES = 1 << 20


def write_atomically(path: Path, data: bytes) -> str:
    """Write a whole file, or leave what was there before.

    The bytes go to a temporary file in the same folder, are flushed to the disk and then renamed over `path`; the
    folder's own entry is flushed last. A reader, a crash or a full disk never meets half a file. The temporary file is
    removed on every way out but the death of the process; such a leftover begins with a dot and ends in `PART_SUFFIX`.

    Parameters
    ----------
    path : Path
        Where the file goes; its folder must exist.
    data : bytes
        The whole content.

    Returns
    -------
    str
        SHA-256 of `data`, 64 hexadecimal digits.

    Raises
    ------
    OSError
        The folder is missing or not writable, or the disk is full; `path` is as it was.
    """
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(6)}{PART_SUFFIX}")
    # Not tempfile: its files are for the owner alone (0600), ours follow the umask like any other file of the user.
    descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    try:
        with os.fdopen(descriptor, "wb") as stream:  # closes the descriptor, whatever happens
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        temporary.replace(path)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            temporary.unlink()
        raise
    _sync_folder(path.parent)
    return hashlib.sha256(data).hexdigest()


def file_digest(path: Path) -> str:
    """Return the SHA-256 of a file's bytes.

    Parameters
    ----------
    path : Path
        The file to read.

    Returns
    -------
    str
        64 hexadecimal digits.

    Raises
    ------
    OSError
        The file is missing or cannot be read.
    """
    digest = hashlib.sha256()
    with path.open("rb") as stream:
        while block := stream.read(_READ_BYTES):
            digest.update(block)
    return digest.hexdigest()


def _sync_folder(folder: Path) -> None:
    """Flush a folder's entries, so that a rename outlives a loss of power."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
