"""`isogyre specimen`: the shape of a crystal of a mineral, face by face, or as a mesh."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crystal_core.errors import Fault, InputError
from service.commands.complaint import one_line
from service.commands.output import print_json, print_text, write_file

if TYPE_CHECKING:
    from typing import Any

    from minerals_db import Mineral

__all__ = ["specimen"]

_OPTIONS = {"": "MINERAL", "/name": "--habit", "/size_mm": "--size"}


def specimen(
    mineral: Annotated[str, typer.Argument(help="Such as quartz.", metavar="MINERAL")],
    habit: Annotated[
        str | None, typer.Option(help="One of its habits [default: the first of its entry].", metavar="NAME")
    ] = None,
    size_mm: Annotated[
        float, typer.Option("--size", help="The greatest distance between two corners, mm.", metavar="MM")
    ] = 10.0,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    mesh: Annotated[
        str | None, typer.Option(help="A .ply file to write besides, its faces polygons.", metavar="FILE.ply")
    ] = None,
) -> None:
    """Show the shape of a crystal: forms and faces, angles between them, volume.

    The size is the greatest distance between two corners of the crystal. Miller indices are those of the cell of the
    mineral's entry. All is in the crystal frame, x along a, z along c*, y = z × x, with the centroid at the origin.

    JSON: mineral, habit, size_mm, point_group, forms, source, status, note, volume_mm3, area_mm2, extent_mm,
    vertices_mm, faces (hkl, form by number, label, outward normal, distance_mm from the centroid, area_mm2, vertices by
    number and vertices_mm, counter-clockwise from outside) and edges (vertices and faces by number, length_mm,
    angle_deg between the normals).
    """
    if mesh is not None and Path(mesh).suffix.lower() != ".ply":
        raise InputError.at("--mesh", f"must end in .ply, not {mesh!r}")

    from crystal_core.scene.specimen import habit_of, specimen_solid
    from service.minerals.habits import habit_document, ply

    entry = _entry(mineral)
    try:
        solid = specimen_solid(entry, habit, size_mm)
        known = habit_of(entry, habit)
    except InputError as error:
        raise InputError(Fault(_option(fault.pointer), fault.message) for fault in error.faults) from None
    if mesh is not None:
        write_file(mesh, ply(solid, f"{entry.id}, {known.name}, {size_mm:g} mm"), "--mesh")
    document = habit_document(entry, known, size_mm, solid)
    if as_json:
        print_json(document)
    else:
        print_text("\n".join(_page(document)))


def _entry(mineral_id: str) -> Mineral:
    import minerals_db

    try:
        return minerals_db.mineral(mineral_id)
    except minerals_db.UnknownMineralError as error:
        raise InputError.at("MINERAL", f"{error} (see isogyre minerals list)") from None


def _option(pointer: str) -> str:
    """Return the option that is wrong; where the forms of a habit are, in an entry of the user's own, its name."""
    return "--habit" if pointer.startswith("/forms") else _OPTIONS[pointer]


def _page(document: dict[str, Any]) -> list[str]:
    """Return the lines of a page for people."""
    faces, edges = document["faces"], document["edges"]
    across = " × ".join(f"{extent:.3g}" for extent in document["extent_mm"])
    names = [one_line(f"{form['name'] or ''} {{{_indices(form['hkl'])}}}".strip()) for form in document["forms"]]
    width = max(12, *map(len, names))
    lines = [
        f"{document['mineral']}, {one_line(document['habit'])}",
        f"class {document['point_group']}; {len(faces)} faces, {len(edges)} edges, "
        f"{len(document['vertices_mm'])} corners",
        f"{document['size_mm']:g} mm between the farthest corners; {across} mm along x, y, z",
        f"volume {document['volume_mm3']:.4g} mm³, surface {document['area_mm2']:.4g} mm²",
        "",
        f"{'form':<{width}}  distance  faces  surface",
    ]
    for number, (name, form) in enumerate(zip(names, document["forms"], strict=True)):
        areas = [face["area_mm2"] for face in faces if face["form"] == number]
        share = sum(areas) / document["area_mm2"]
        lines.append(f"{name:<{width}}  {form['central_distance']:>8g}  {len(areas):>5}  {share:>7.1%}")
    return [*lines, "", "edges, and the angle between the normals", *_angles(faces, edges)]


def _angles(faces: list[dict[str, Any]], edges: list[dict[str, Any]]) -> list[str]:
    """Return a line for each kind of edge: the forms that meet there, and the angle between their normals."""
    labels = [one_line(face["label"]) for face in faces]
    width = 2 * max(map(len, labels)) + 4
    found: dict[tuple[int, int, float], str] = {}
    for edge in edges:
        one, other = sorted(edge["faces"])
        told = f"{labels[one]} ∧ {labels[other]}"
        kind = (faces[one]["form"], faces[other]["form"], round(edge["angle_deg"], 2))
        found.setdefault(kind, f"{told:<{width}}{edge['angle_deg']:>7.2f}°")
    return [found[kind] for kind in sorted(found)]


def _indices(hkl: list[int]) -> str:
    return " ".join(str(index) for index in hkl)
