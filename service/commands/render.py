"""`isogyre render`: the frames of a demonstration or a scene, animation and manifest in a folder."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crystal_core.errors import Fault, InputError, IsogyreError, NotSupportedError
from service.commands.complaint import complain
from service.interruption import Interruption

if TYPE_CHECKING:
    from crystal_core.sequence import RenderRequest
    from service.batch_folder import BatchFolder

__all__ = ["render"]

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"), "1")
"""Read by numeric libraries when they are loaded: the last bits must not depend on the number of processors."""


def render(
    what: Annotated[
        str,
        typer.Argument(
            help="A demonstration such as rotating-calcite, or the file of a scene: .yaml, .yml or .json.",
            metavar="DEMONSTRATION|FILE",
        ),
    ],
    out: Annotated[str, typer.Option(help="Folder for the frames; made if need be.", metavar="DIR")],
    assignments: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            help="A parameter of a demonstration, as JSON or a plain word; any number of times. texture takes a PNG "
            "or JPEG file.",
            metavar="KEY=VALUE",
        ),
    ] = None,
    frames: Annotated[
        int | None, typer.Option(help="Frames, 1 to 360; of a scene its own [default: 36].", metavar="N")
    ] = None,
    size: Annotated[
        str | None,
        typer.Option(
            help="Width and height in pixels, 16 to 2048 each; of a scene its own [default: 512x512].", metavar="WxH"
        ),
    ] = None,
    quality: Annotated[
        str | None,
        typer.Option(help="draft, standard or fine; of a scene its own [default: standard].", metavar="QUALITY"),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Of the random numbers; of a scene its own [default: 0].", metavar="N")
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            help="Processes to render with, 1 is this one [default: as many as there are processors].",
            metavar="N",
            min=1,
            max=256,
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one line of JSON on stdout at the end: what is in the folder.")
    ] = False,
) -> int:
    """Render a demonstration or a scene into a folder.

    The folder receives frame-0000.png and so on, sequence.webp and manifest.json.

    Ctrl-C leaves the finished frames; the same command goes on from there.
    """
    os.environ.update(_ONE_THREAD)
    asked = {"frames": frames, "quality": quality, "seed": seed}
    with Interruption() as interruption:
        try:
            folder = _render(what, asked, size, assignments or [], out, workers, interruption)
        except IsogyreError as error:
            # Whoever ends this process may have ended its workers too: what they then complain of is of no interest.
            if not interruption or isinstance(error, InputError | NotSupportedError):
                raise
            complain(f"interrupted; what is finished is in {out}, and the same command goes on")
            return interruption.exit_code
    if as_json:
        _print_outcome(folder)
    return 0


def _render(
    what: str,
    asked: Mapping[str, object],
    size: str | None,
    assignments: Sequence[str],
    out: str,
    workers: int | None,
    interruption: Interruption,
) -> BatchFolder:
    """Read the options, and fill the folder."""
    from service.batch_folder import open_batch_folder

    with tempfile.TemporaryDirectory(prefix="isogyre-assets-") as assets:
        request = _read_request(what, asked, size, assignments, out, Path(assets))
        with open_batch_folder(Path(out), request, interruption.check) as folder:
            if not folder.complete:
                _fill(folder, Path(assets), workers or len(os.sched_getaffinity(0)), interruption)
    return folder


def _read_request(
    what: str, asked: Mapping[str, object], size: str | None, assignments: Sequence[str], out: str, assets: Path
) -> RenderRequest:
    """Return the request of the options; one `InputError` tells of all that is wrong with them."""
    from service.batch_folder import unusable_reason
    from service.commands.assignment import parse_size
    from service.scenes.file import is_scene_file

    faults: list[Fault] = []
    request = {key: value for key, value in asked.items() if value is not None}
    try:
        if size is not None:
            request["size"] = parse_size(size)
    except InputError as error:
        faults += error.faults
    if (reason := unusable_reason(Path(out)) if out else "must name a folder") is not None:
        faults.append(Fault("--out", reason))
    try:
        read = _read_scene if is_scene_file(what) else _read_demonstration
        parsed = read(what, request, assignments, assets)
    except InputError as error:
        raise InputError([*faults, *error.faults]) from None
    if faults:
        raise InputError(faults)
    return parsed


def _read_demonstration(
    name: str, settings: Mapping[str, object], assignments: Sequence[str], assets: Path
) -> RenderRequest:
    from crystal_core.sequence import parse_request
    from service.commands.assignment import keep_texture, parse_assignments

    parameters, faults = parse_assignments(assignments)
    try:
        if "texture" in parameters:
            parameters["texture"] = keep_texture(str(parameters.pop("texture")), assets)
    except InputError as error:
        faults += error.faults
    try:
        parsed = parse_request({"demonstration": name, "parameters": parameters, **settings}, assets)
    except InputError as error:
        raise InputError([*faults, *error.faults]) from None
    if faults:
        raise InputError(faults)
    return parsed


def _read_scene(file: str, settings: Mapping[str, object], assignments: Sequence[str], assets: Path) -> RenderRequest:
    from crystal_core.sequence import parse_request
    from service.scenes.file import SceneFile

    faults = [Fault("--set", "goes with a demonstration: a scene's file says everything itself")] if assignments else []
    name = Path(file).name
    try:
        scene = SceneFile(file).with_assets(assets)
        parsed = parse_request({"scene": scene, **settings}, assets)
    except InputError as error:
        told = [Fault(_in_file(name, fault.pointer), fault.message) for fault in error.faults]
        raise InputError([*faults, *told]) from None
    except NotSupportedError as error:
        raise NotSupportedError(f"{name}: {str(error).removeprefix('/scene')}") from None
    if faults:
        raise InputError(faults)
    return parsed


def _in_file(name: str, pointer: str) -> str:
    """Return the place of a fault of a request in the file of its scene; a pointer that leads elsewhere as it is."""
    head, slash, rest = pointer[1:].partition("/")
    return pointer if head != "scene" or not pointer.startswith("/") else f"{name}: /{rest}" if slash else name


def _fill(folder: BatchFolder, assets: Path, workers: int, interruption: Interruption) -> None:
    """Render what is missing in the folder."""
    from service.batch import Batch
    from service.commands.progress import BatchProgress
    from service.engine import open_engine

    batch = Batch(folder, assets, interruption.check)
    with BatchProgress(batch) as progress:
        if batch.units:
            with open_engine(min(workers, batch.units)) as engine:
                batch.render(engine, progress.advance)
        progress.begin_film()
        batch.finish()


def _print_outcome(folder: BatchFolder) -> None:
    import json

    from service.batch_folder import MANIFEST

    outcome = {
        "manifest": str((folder.path / MANIFEST).absolute()),
        "frames": folder.request.frames,
        "complete": folder.complete,
    }
    typer.echo(json.dumps(outcome))
