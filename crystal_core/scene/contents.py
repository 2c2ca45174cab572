"""What kind of file some bytes are: assets have no names."""

from __future__ import annotations

import re

__all__ = ["file_suffix"]

_HEAD = 4096

_OBJ_LINE = re.compile(rb"(?m)^\s*(v\s+[-+0-9.]|f\s+[0-9-]|#|o\s|g\s|vn\s|vt\s|s\s|mtllib\s|usemtl\s)")


def file_suffix(data: bytes) -> str | None:
    """Return the suffix of a picture or a mesh by its first bytes.

    Parameters
    ----------
    data : bytes
        A whole file.

    Returns
    -------
    str or None
        ``.png``, ``.jpg``, ``.ply``, ``.glb``, ``.gltf``, ``.stl`` or ``.obj``; None if it is none of these. That the
        rest of the file is as it should be is not looked at.
    """
    head = data[:_HEAD]
    for magic, suffix in ((b"\x89PNG\r\n\x1a\n", ".png"), (b"\xff\xd8\xff", ".jpg"), (b"glTF", ".glb")):
        if head.startswith(magic):
            return suffix
    if re.match(rb"ply\r?\n", head):
        return ".ply"
    # Binary STL: 80 bytes of anything (some write "solid" there), a number of triangles, 50 bytes for each.
    if len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little"):
        return ".stl"
    text = head.lstrip(b"\xef\xbb\xbf").lstrip()
    if text.startswith(b"{") and b'"asset"' in data:
        return ".gltf"
    if text.lower().startswith(b"solid") and b"facet" in data[:_HEAD].lower():
        return ".stl"
    return ".obj" if b"\0" not in head and _OBJ_LINE.match(text) else None
