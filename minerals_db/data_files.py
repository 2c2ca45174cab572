"""The bytes of data files."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

__all__ = ["digest_of", "read_files"]


def read_files(folder: Traversable) -> dict[str, bytes]:
    """Return the bytes of every YAML file of a folder, by name, sorted.

    Raises
    ------
    OSError
        Where the folder or a file cannot be read.
    """
    files = {file.name: file for file in folder.iterdir() if file.name.endswith((".yaml", ".yml"))}
    return {name: files[name].read_bytes() for name in sorted(files)}


def digest_of(files: Mapping[str, bytes]) -> str:
    """Return the SHA-256 (64 hex digits) over the names and bytes of files."""
    digest = hashlib.sha256()
    for name, data in sorted(files.items()):
        digest.update(f"{name}\0{len(data)}\0".encode())
        digest.update(data)
    return digest.hexdigest()
