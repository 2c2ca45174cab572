"""Files that may or may not serve as assets."""

from __future__ import annotations

import io
import struct

import numpy as np
import trimesh
from PIL import Image


def png(size: tuple[int, int] = (32, 16), mode: str = "L") -> bytes:
    stream = io.BytesIO()
    Image.new(mode, size, 128 if mode == "L" else None).save(stream, "PNG")
    return stream.getvalue()


def jpeg() -> bytes:
    stream = io.BytesIO()
    Image.new("RGB", (20, 10), (200, 30, 30)).save(stream, "JPEG")
    return stream.getvalue()


def cube(kind: str = "ply", *, hole: bool = False, inside_out: bool = False) -> bytes:
    """Return a cube of edge 2."""
    box = trimesh.creation.box((2.0, 2.0, 2.0))
    faces = box.faces[1:] if hole else box.faces
    mesh = trimesh.Trimesh(box.vertices, faces[:, ::-1] if inside_out else faces, process=False)
    data = mesh.export(file_type=kind)
    return data.encode() if isinstance(data, str) else bytes(data)


def heavy_stl(triangles: int) -> bytes:
    """Return a binary STL of so many triangles."""
    one = np.zeros(1, np.dtype([("numbers", "<f4", 12), ("spare", "<u2")]))
    one["numbers"][0, 3:] = (0, 0, 0, 1, 0, 0, 0, 1, 0)
    return bytes(80) + struct.pack("<I", triangles) + np.tile(one, triangles).tobytes()
