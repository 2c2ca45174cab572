"""Scenes from mappings and from files, and the files that they name."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pydantic

from crystal_core.errors import Fault, InputError
from crystal_core.scene.document import SceneDocument
from crystal_core.scene.parts import BRANCH, Location
from crystal_core.scene.texture import read_asset
from minerals_db.errors import DataFault
from minerals_db.yaml_files import parse

__all__ = ["SUFFIXES", "SceneFiles", "parse_scene", "read_scene"]

SUFFIXES = (".yaml", ".yml", ".json")

MAX_BYTES = 4 * 1024 * 1024
MAX_NODES = 500_000
"""Of a document, aliases followed: a few lines of YAML can stand for gigabytes."""

MAX_FILE_BYTES = 64 * 1024 * 1024


@dataclass(frozen=True)
class SceneFiles:
    """Where the files are that a scene names.

    Parameters
    ----------
    assets : Path, optional
        Folder of uploaded files, named by their sha256.
    folder : Path, optional
        Folder that paths are relative to; without it a scene may name assets only.
    """

    assets: Path | None = None
    folder: Path | None = None

    def read(self, name: str, pointer: str) -> bytes:
        """Return the bytes of a file or an asset.

        Raises
        ------
        InputError
            At `pointer`: there is no such file, or it is too large.
        """
        if name.startswith("asset:"):
            return read_asset(self.assets, name, pointer)
        if self.folder is None:
            raise InputError.at(pointer, "a path cannot be followed here: upload the file and name it asset:…")
        path = self.folder / name
        try:
            size = path.stat().st_size
            if size > MAX_FILE_BYTES:
                raise InputError.at(pointer, f"{name} has {size} bytes; at most {MAX_FILE_BYTES} are taken")
            return path.read_bytes()
        except OSError as error:
            raise InputError.at(pointer, f"cannot read {name}: {error.strerror or error}") from error


def parse_scene(mapping: Mapping[str, Any], *, paths: bool = False) -> SceneDocument:
    """Return the scene that a mapping describes.

    Parameters
    ----------
    mapping : mapping
        As of a YAML or JSON file. A body that rests on something must still be staged to know whether it fits.
    paths : bool
        Whether files may be named by their paths; otherwise only as assets.

    Raises
    ------
    InputError
        One fault for every wrong place, each with its JSON pointer.
    """
    if not isinstance(mapping, Mapping):
        raise InputError.at("", "a scene is a mapping of keys")
    _check_keys(mapping)
    try:
        scene = SceneDocument.model_validate(mapping)
    except pydantic.ValidationError as error:
        told = error.errors(include_url=False, include_input=False)
        raise InputError(_distinct(Fault(_pointer(detail["loc"]), str(detail["msg"])) for detail in told)) from None
    named = [] if paths else [(at, name) for at, name in scene.file_references() if not name.startswith("asset:")]
    if named:
        raise InputError(
            Fault(at, f"{name} is a path: upload the file and name it asset:… by its sha256") for at, name in named
        )
    return scene


def read_scene(path: Path) -> SceneDocument:
    """Return the scene of a YAML or JSON file; paths in it are relative to its folder (see `SceneFiles`).

    Raises
    ------
    InputError
        The file cannot be read, is neither YAML nor JSON, repeats a key, or describes no scene.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise InputError.at("", f"{path.name}: a scene is a file {', '.join(SUFFIXES)}")
    try:
        if path.stat().st_size > MAX_BYTES:
            raise InputError.at("", f"{path.name} has more than {MAX_BYTES} bytes")
        data = path.read_bytes()
    except OSError as error:
        raise InputError.at("", f"cannot read {path}: {error.strerror or error}") from error
    return parse_scene(_json(path.name, data) if path.suffix.lower() == ".json" else _yaml(path.name, data), paths=True)


def _yaml(name: str, data: bytes) -> Mapping[str, Any]:
    faults: list[DataFault] = []
    content: Any = parse(name, data, faults)
    if faults:
        raise InputError(Fault("", f"{fault.file}: {fault.reason}") for fault in faults)
    mapping: Mapping[str, Any] = content
    return mapping


def _json(name: str, data: bytes) -> Mapping[str, Any]:
    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        content = dict(pairs)
        if len(content) != len(pairs):
            keys = [key for key, _ in pairs]
            raise ValueError(f"repeated key {next(key for key in keys if keys.count(key) > 1)!r}")
        return content

    def refuse(constant: str) -> float:
        raise ValueError(f"{constant} is no number of JSON")

    try:
        content = json.loads(data, object_pairs_hook=once, parse_constant=refuse)
    except (ValueError, RecursionError) as error:
        raise InputError.at("", f"{name}: not JSON: {error}") from error
    if not isinstance(content, dict):
        raise InputError.at("", f"{name}: must hold an object of keys")
    return content


def _check_keys(mapping: Mapping[Any, Any]) -> None:
    """Refuse what unfolds into too many values, and keys that are no text."""
    waiting: list[tuple[Location, Any]] = [((), mapping)]
    seen, faults = 0, []
    while waiting:
        place, value = waiting.pop()
        seen += 1
        if seen > MAX_NODES:
            raise InputError.at("", f"the scene has more than {MAX_NODES} values")
        if isinstance(value, Mapping):
            odd = [key for key in value if not isinstance(key, str)]
            faults += [Fault(_pointer(place), f"the key {key!r} is no text: put it in quotes") for key in odd]
            waiting.extend(((*place, key), item) for key, item in value.items())
        elif isinstance(value, list | tuple):
            waiting.extend(((*place, number), item) for number, item in enumerate(value))
    if faults:
        raise InputError(faults)


def _pointer(location: Location) -> str:
    """Return the JSON pointer of a place, without the names of alternatives."""
    steps = [str(step) for step in location if not (isinstance(step, str) and step.startswith(BRANCH))]
    if steps and steps[-1] == "[key]":
        steps.pop()
    return "".join("/" + step.replace("~", "~0").replace("/", "~1") for step in steps)


def _distinct(faults: Iterable[Fault]) -> list[Fault]:
    return list(dict.fromkeys(faults))
