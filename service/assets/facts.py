"""What there is to know of an asset, found by reading all of it."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from PIL import Image
from scipy.spatial import ConvexHull

from crystal_core.errors import InputError
from crystal_core.geometry.mesh_contents import SUFFIXES as MESH_SUFFIXES
from crystal_core.geometry.mesh_contents import mesh_triangles
from crystal_core.geometry.mesh_file import load_mesh
from crystal_core.scene.texture import decode_texture

__all__ = ["AssetFacts", "read_facts"]

Kind = Literal["texture", "mesh"]

SIZE_MM = 10.0
"""A mesh is looked at in this size: only the scene that names it says how large it is."""

CONVEX = 1e-6
"""By what part of its volume the convex hull of a convex body may be larger."""


@dataclass(frozen=True)
class AssetFacts:
    """What an asset is.

    Parameters
    ----------
    kind : str
        "texture" or "mesh".
    facts : dict
        JSON-able.
    notes : tuple of str
        What will be mended or left out when it is used, a sentence each.
    """

    kind: Kind
    facts: dict[str, Any]
    notes: tuple[str, ...] = field(default=())


def read_facts(data: bytes, suffix: str) -> AssetFacts:
    """Return the facts of a file.

    Parameters
    ----------
    data : bytes
        The file.
    suffix : str
        As `crystal_core.scene.contents.file_suffix` tells it.

    Raises
    ------
    InputError
        It is broken, or larger than may be.
    """
    return _mesh(data, suffix) if suffix in MESH_SUFFIXES else _picture(data)


def _picture(data: bytes) -> AssetFacts:
    texels = decode_texture(data, "")
    with Image.open(io.BytesIO(data)) as picture:
        kind, transparent = picture.format, picture.has_transparency_data
    height, width, channels = texels.shape
    facts = {
        "format": kind,
        "width_px": width,
        "height_px": height,
        "colour": channels == 3,
        "mean_reflectance": round(float(texels.mean(dtype=np.float64)), 4),
    }
    return AssetFacts("texture", facts, ("Transparent parts show white paper.",) if transparent else ())


def _mesh(data: bytes, suffix: str) -> AssetFacts:
    vertices, _, _ = mesh_triangles(data, suffix)
    loaded = load_mesh(data, suffix, SIZE_MM)
    body = loaded.solid.body
    largest = float(np.ptp(body.vertices, axis=0).max())
    extent = np.ptp(vertices, axis=0) if len(vertices) else np.zeros(3)
    if not np.isfinite(extent).all():  # load_mesh has refused it: for whoever reads this
        raise InputError.at("", "the mesh has corners that are no numbers")
    facts = {
        "format": suffix.removeprefix(".").upper(),
        "faces": body.face_count,
        "triangles": len(body.triangles[0]),
        "corners": len(body.vertices),
        "convex": float(ConvexHull(body.vertices).volume) <= body.volume_mm3 * (1.0 + CONVEX),
        "extent": [float(f"{value:.6g}") for value in extent],
        "filled_fraction": round(float(body.volume_mm3) / largest**3, 4),
    }
    return AssetFacts("mesh", facts, loaded.notes)
