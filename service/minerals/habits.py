"""A habit told as JSON: the polyhedron of a crystal, face by face; and as a mesh."""

from __future__ import annotations

from typing import Any

import numpy as np

from crystal_core.geometry.solid import Solid
from crystal_core.scene.specimen import point_group_of
from minerals_db import Habit, Mineral

__all__ = ["habit_document", "habit_summary", "ply"]


def habit_summary(habit: Habit) -> dict[str, Any]:
    """Return what an entry says of a habit: its forms, where they come from, and how far to trust them."""
    return {
        "name": habit.name,
        "forms": [
            {"hkl": list(form.hkl), "name": form.name, "central_distance": form.central_distance}
            for form in habit.forms
        ],
        "source": habit.source,
        "status": habit.status,
        "note": habit.note,
    }


def habit_document(mineral: Mineral, habit: Habit, size_mm: float, solid: Solid) -> dict[str, Any]:
    """Return a crystal of a habit as JSON.

    All is in the crystal frame (x along a, z along c*, y = z × x), with the centroid at the origin. Corners of a face
    run counter-clockwise seen from outside; the angle of an edge is that between the normals of its faces, as
    crystallographers tabulate it.

    Parameters
    ----------
    mineral : Mineral
        The entry.
    habit : Habit
        One of its habits.
    size_mm : float
        The greatest distance between two corners.
    solid : Solid
        The crystal, from `crystal_core.scene.specimen.specimen_solid`.
    """
    body = solid.body
    areas = body.areas_mm2
    group = point_group_of(mineral)
    # The faces come form by form.
    owners = [number for number, form in enumerate(habit.forms) for _ in group.equivalents(form.hkl)]
    return {
        "mineral": mineral.id,
        "habit": habit.name,
        "size_mm": size_mm,
        "point_group": group.symbol,
        "forms": habit_summary(habit)["forms"],
        "source": habit.source,
        "status": habit.status,
        "note": habit.note,
        "volume_mm3": body.volume_mm3,
        "area_mm2": float(areas.sum()),
        "extent_mm": np.ptp(body.vertices, axis=0).tolist(),
        "vertices_mm": body.vertices.tolist(),
        "faces": [
            {
                "hkl": None if hkl is None else list(hkl),
                "form": owner,
                "label": label,
                "normal": normal.tolist(),
                "distance_mm": float(offset),
                "area_mm2": float(area),
                "vertices": list(ring),
                "vertices_mm": body.vertices[list(ring)].tolist(),
            }
            for ring, normal, offset, area, label, hkl, owner in zip(
                body.faces, body.normals, body.offsets, areas, solid.labels, solid.hkl, owners, strict=True
            )
        ],
        "edges": [
            {
                "vertices": list(ends),
                "faces": list(sides),
                "length_mm": float(np.linalg.norm(np.subtract(*body.vertices[list(ends)]))),
                "angle_deg": _angle_deg(*body.normals[list(sides)]),
            }
            for ends, sides in body.edges.items()
        ],
    }


def ply(solid: Solid, title: str) -> bytes:
    """Return a solid as an ASCII PLY file whose faces are polygons, with the indices of each face as its properties."""
    body = solid.body
    head = [
        "ply",
        "format ascii 1.0",
        f"comment {title.encode('ascii', 'replace').decode('ascii')}",
        "comment lengths in mm; crystal frame: x along a, z along c*, y = z x x; h k l on the lattice of the crystal",
        f"element vertex {len(body.vertices)}",
        *(f"property double {axis}" for axis in "xyz"),
        f"element face {len(body.faces)}",
        "property list uchar int vertex_indices",
        *(f"property int {index}" for index in "hkl"),
        "end_header",
    ]
    corners = [" ".join(repr(float(x)) for x in corner) for corner in body.vertices]
    faces = [
        " ".join(str(number) for number in (len(ring), *ring, *(hkl or (0, 0, 0))))
        for ring, hkl in zip(body.faces, solid.hkl, strict=True)
    ]
    return "\n".join((*head, *corners, *faces, "")).encode("ascii")


def _angle_deg(one: np.ndarray[Any, Any], other: np.ndarray[Any, Any]) -> float:
    return float(np.rad2deg(np.arctan2(np.linalg.norm(np.cross(one, other)), one @ other)))
