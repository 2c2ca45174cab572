"""`isogyre wave-surface`: the index or the ray surface of a mineral, as JSON or PLY."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, cast

import typer

from crystal_core.errors import InputError
from service.commands.output import print_text, write_file

__all__ = ["wave_surface"]


def wave_surface(
    mineral: Annotated[str, typer.Argument(help="Such as aragonite.", metavar="MINERAL")],
    kind: Annotated[str, typer.Option(help="index: wave vectors; ray: ray velocities.", metavar="index|ray")] = "index",
    wavelength_nm: Annotated[float, typer.Option(help="Vacuum wavelength, nm.", metavar="NM")] = 589.3,
    resolution: Annotated[
        int, typer.Option(help="Steps to a quarter of a turn: 16 N² triangles a sheet.", metavar="N", min=2, max=256)
    ] = 32,
    out: Annotated[
        str | None,
        typer.Option(
            help="A file to write instead of stdout; .json, or .ply for MeshLab, Blender and the like.", metavar="FILE"
        ),
    ] = None,
) -> None:
    """Make the wave surface of a mineral: two closed sheets of triangles and the points where they touch.

    All is in the crystal frame: x along a, z along c*, y = z × x. The index surface holds the wave vectors in units of
    2π/λ, the ray surface the ray velocities in units of c. Optical activity is left out.

    JSON on stdout, or in a file: mineral, wavelength_nm, kind, indices, axes (a row for each index; two indices are n_o
    and n_e, and the third row is the optic axis), optical_class, optic_axes, two_v_deg, optic_sign, contact_points,
    outer and inner, each with its mode, vertices and triangles (counter-clockwise from outside).

    PLY (binary) holds both sheets in one file: two loose parts, the outer orange, the inner blue, with the vertex
    property sheet (0 outer, 1 inner). Take them apart by Separate > By Loose Parts in Blender, by Split in Connected
    Components in MeshLab.
    """
    if out is not None and Path(out).suffix.lower() not in {".ply", ".json"}:
        raise InputError.at("--out", f"must end in .ply or .json, not {out!r}")

    from service.probes.probe import encode
    from service.probes.wave_surface import mineral_surface

    surface = mineral_surface(mineral, wavelength_nm, cast(Literal["index", "ray"], kind), resolution)
    if out is None:
        print_text(encode(surface.document()))
    elif Path(out).suffix.lower() == ".ply":
        write_file(out, surface.ply(), "--out")
    else:
        write_file(out, f"{encode(surface.document())}\n".encode("ascii"), "--out")
