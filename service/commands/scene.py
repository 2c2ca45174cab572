"""`isogyre scene`: whether a scene is written rightly, what it holds, how it looks in lines, what the language is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args

import typer

from crystal_core.errors import InputError, NotSupportedError
from service.commands.complaint import one_line
from service.commands.output import print_json, print_text, write_file

if TYPE_CHECKING:
    from crystal_core.scene import StagedDocument
    from crystal_core.scene.wireframe import View

__all__ = ["scene"]

scene = typer.Typer(
    add_completion=False, rich_markup_mode=None, help="Check a scene, show what is in it, print its language's schema."
)

_FAULTY = 2

SceneArgument = Annotated[str, typer.Argument(help="A scene: .yaml, .yml or .json.", metavar="FILE")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@scene.command()
def validate(file: SceneArgument, as_json: AsJson = False) -> int:
    """Check a scene: its keys and values, and what shows when it is put together, in all of its frames.

    What is wrong is told on stderr, a line each: file, place in the scene, reason. Exit code 0 or 2.

    JSON: valid, then summary and warnings (pointer, detail), or errors (pointer, detail).
    """
    from service.scenes.file import SceneFile
    from service.scenes.summary import summary, warnings_of

    try:
        staged = SceneFile(file).staged()
    except (InputError, NotSupportedError) as error:
        if not as_json:
            raise
        print_json({"valid": False, "errors": _errors(Path(file).name, error)})
        return _FAULTY
    warnings = warnings_of(staged)
    if as_json:
        told = [{"pointer": fault.pointer, "detail": fault.message} for fault in warnings]
        print_json({"valid": True, "summary": summary(staged), "warnings": told})
        return 0
    print_text(f"{one_line(file)}: valid; {_counted(staged)}")
    for fault in warnings:
        print_text(one_line(f"note: {fault}" if fault.pointer else f"note: {fault.message}"))
    return 0


@scene.command()
def show(
    file: SceneArgument,
    as_json: AsJson = False,
    wireframe: Annotated[
        str | None, typer.Option(help="An SVG to write besides: a drawing without light.", metavar="FILE.svg")
    ] = None,
    view: Annotated[
        str | None,
        typer.Option(
            help="Of the drawing: the scene's camera, from above, from the front (-y) or from the right (+x) "
            "[default: camera].",
            metavar="camera|plan|front|side",
        ),
    ] = None,
    indicatrix: Annotated[
        bool,
        typer.Option(
            "--indicatrix", help="Draw each crystal's section of the indicatrix across the line of sight too."
        ),
    ] = False,
    frame: Annotated[int, typer.Option(help="Which frame of a scene that moves.", metavar="N")] = 0,
) -> None:
    """Show what is in a scene, and draw it in lines as crystals are drawn.

    The drawing has front edges solid and the others in thin dashes, the axes of the cells, optic axes, lights,
    polarizer directions and a scale bar.

    JSON: title, frames, size_px, bodies (material, shape, faces, volume_mm3, extent_mm, centre_mm, rotation, cell_axes,
    optic_axes, what they rest on, lie in and touch), surfaces, sheets, lights, camera, moves. Lengths are in mm, in
    the axes of the world; directions are unit vectors.
    """
    if wireframe is not None and Path(wireframe).suffix.lower() != ".svg":
        raise InputError.at("--wireframe", f"must end in .svg, not {wireframe!r}")
    drawn_from = _view(view or "camera")
    if wireframe is None and (view is not None or indicatrix):
        raise InputError.at("--view" if view is not None else "--indicatrix", "goes with --wireframe")

    from service.scenes.file import SceneFile
    from service.scenes.summary import summary

    staged = SceneFile(file).staged()
    if not 0 <= frame < staged.frames:
        raise InputError.at("--frame", f"must be 0 to {staged.frames - 1}, not {frame}")
    staged = staged.at(frame)
    if wireframe is not None:
        from crystal_core.scene.wireframe import wireframe as draw

        write_file(wireframe, draw(staged, drawn_from, indicatrix=indicatrix).encode(), "--wireframe")
    if as_json:
        print_json(summary(staged))
    else:
        print_text("\n".join(map(one_line, _page(file, summary(staged)))))


@scene.command()
def schema() -> None:
    """Print the JSON Schema (draft 2020-12) of the scene description language."""
    import json

    from crystal_core.scene import scene_schema

    print_text(json.dumps(scene_schema(), indent=2, ensure_ascii=False))


def _view(text: str) -> View:
    from crystal_core.scene.wireframe import View

    known: tuple[View, ...] = get_args(View)
    if text not in known:
        raise InputError.at("--view", f"must be one of {', '.join(known)}, not {text!r}")
    return known[known.index(text)]


def _errors(name: str, error: InputError | NotSupportedError) -> list[dict[str, str]]:
    """Return the faults of a scene, by their places in it alone."""
    if isinstance(error, NotSupportedError):
        return [{"pointer": "", "detail": str(error).removeprefix(f"{name}: ")}]
    return [
        {"pointer": fault.pointer.removeprefix(name).removeprefix(": "), "detail": fault.message}
        for fault in error.faults
    ]


def _counted(staged: StagedDocument) -> str:
    document = staged.document
    counts = [
        (len(document.bodies), "body", "bodies"),
        (len(document.surfaces), "surface", "surfaces"),
        (len(document.sheets), "sheet", "sheets"),
        (len(document.lights), "light", "lights"),
        (staged.frames, "frame", "frames"),
    ]
    return ", ".join(f"{count} {one if count == 1 else many}" for count, one, many in counts if count)


def _page(file: str, told: dict[str, Any]) -> list[str]:
    """Return the lines of a page for people."""
    width, height = told["size_px"]
    frames = "1 frame" if told["frames"] == 1 else f"frame {told['frame']} of {told['frames']}"
    moving = f"; moves: {', '.join(told['moves'])}" if told["moves"] else ""
    lines = [told["title"] or file, f"{frames}, {width} × {height} pixels, {told['quality']}{moving}"]
    if told["bodies"]:
        lines += ["", "bodies (mm)"]
        for body in told["bodies"]:
            lines += _body_lines(body)
    for section, title in (("surfaces", "surfaces"), ("sheets", "sheets"), ("lights", "lights")):
        if told[section]:
            lines += ["", title]
            lines += [_thing_line(thing) for thing in told[section]]
    camera = told["camera"]
    seen = f"{camera['vfov_deg']:.4g}° high" if camera["vfov_deg"] is not None else f"{camera['height_mm']:.4g} mm high"
    behind = "" if camera["analyser_deg"] is None else f", analyser at {camera['analyser_deg']:g}°"
    return [
        *lines,
        "",
        f"camera at {_vector(camera['eye_mm'])}, looks along {_vector(camera['forward'])}, {seen}{behind}",
    ]


def _body_lines(body: dict[str, Any]) -> list[str]:
    name = body["name"] + ("′" if body["individual"] else "")
    across = " × ".join(f"{extent:.4g}" for extent in body["extent_mm"])
    how = [f"on {body['rests_on']}"] * bool(body["rests_on"]) + [f"inside {body['inside']}"] * bool(body["inside"])
    how += ["in contact with its twin" if other == body["name"] else f"touches {other}" for other in body["touches"]]
    faces = "1 face" if body["faces"] == 1 else f"{body['faces']} faces"
    lines = [
        f"  {name}: {body['material']} ({body['optical_class']}), {body['shape']}, {faces}, "
        f"{across} along x, y, z, volume {body['volume_mm3']:.4g} mm³",
        f"    centre {_vector(body['centre_mm'])}" + "".join(f", {part}" for part in how),
    ]
    axes = [f"{axis} {_vector(way)}" for axis, way in body["cell_axes"].items()]
    lines += [f"    axes of the cell: {'  '.join(axes)}"] if axes else []
    optic = [_vector(way) for way in body["optic_axes"]]
    lines += [f"    optic {'axis' if len(optic) == 1 else 'axes'}: {'  '.join(optic)}"] if optic else []
    return lines


def _thing_line(thing: dict[str, Any]) -> str:
    parts = [thing["kind"]]
    if "shape" in thing:
        parts.append(thing["shape"])
    if thing.get("size_mm"):
        parts.append(" × ".join(f"{side:.4g}" for side in thing["size_mm"]) + " mm")
    if thing.get("position_mm") is not None:
        parts.append(f"at {_vector(thing['position_mm'])}")
    for key, word in (("facing", "faces"), ("direction", "shines along")):
        if thing.get(key) is not None:
            parts.append(f"{word} {_vector(thing[key])}")
    if "spectrum" in thing:
        parts.append(thing["spectrum"] + (", polarized" if thing["polarized"] else ""))
    return f"  {thing['name']}: {', '.join(parts)}"


def _vector(values: list[float]) -> str:
    return f"({', '.join(f'{value:.4g}' for value in values)})"
