"""From data files to checked entries.

A folder of ``<id>.yaml`` files and a shared ``sources.yaml`` become ``Mineral`` models. Everything that is wrong in any
of the files is collected and reported in one error.
"""

from __future__ import annotations

import hashlib
from collections.abc import Hashable, Iterator, Mapping
from functools import cache
from importlib import resources
from pathlib import PurePosixPath
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import yaml
from pydantic import TypeAdapter, ValidationError

from minerals_db.errors import DataFault, MineralDataError
from minerals_db.schema import Mineral, Source

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

__all__ = ["SOURCES_FILE", "builtin_digest", "builtin_minerals", "load_minerals"]

SOURCES_FILE = "sources.yaml"
"""Name of the file, beside the minerals' own, that holds the sources they share."""

_SOURCES: TypeAdapter[dict[str, Source]] = TypeAdapter(dict[str, Source])
# libyaml is about eight times as fast; PyYAML without it reads the same.
_BASE: type[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _Loader(_BASE):  # type: ignore[misc]  # the base is chosen at run time
    """A safe YAML loader that refuses a repeated key: YAML would silently keep the last one."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        seen: set[Hashable] = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if not isinstance(key, Hashable):
                continue  # the loader itself refuses it below
            if key in seen:
                raise yaml.constructor.ConstructorError(None, None, f"repeated key {key!r}", key_node.start_mark)
            seen.add(key)
        mapping: dict[Hashable, Any] = super().construct_mapping(node, deep)
        return mapping


def _parse(name: str, data: bytes, faults: list[DataFault]) -> dict[Hashable, Any] | None:
    """Return the mapping that a YAML file holds; a fault and None where it holds none."""
    try:
        content = yaml.load(data, Loader=_Loader)  # a SafeLoader, as above
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        reason = getattr(error, "problem", None) or str(error)
        mark = getattr(error, "problem_mark", None)
        where = f", line {mark.line + 1}" if mark is not None else ""
        faults.append(DataFault(name, "", f"not YAML: {' '.join(reason.split())}{where}"))
        return None
    if not isinstance(content, dict):
        faults.append(DataFault(name, "", "must hold a mapping of fields"))
        return None
    return content


def _faults(name: str, error: ValidationError) -> Iterator[DataFault]:
    """Translate pydantic's list into places of the file and plain words."""
    for fault in error.errors(include_url=False, include_context=False, include_input=False):
        place = list(fault["loc"])
        if place[:1] == ["dispersion"] or place[:2] == ["optical_rotation", "along_axis"]:
            del place[2:3]  # the name of the curve's model, which is no field
        reason = {"extra_forbidden": "unknown field", "missing": "missing"}.get(fault["type"], fault["msg"])
        yield DataFault(name, ".".join(map(str, place)), reason.removeprefix("Value error, "))


def _named_sources(node: object, path: tuple[str, ...] = ()) -> Iterator[tuple[str, str]]:
    """Yield the place and the key of every ``source`` and ``via`` in a file."""
    if isinstance(node, dict):
        for field, child in node.items():
            if field in ("source", "via") and isinstance(child, str):
                yield ".".join((*path, field)), child
            else:
                yield from _named_sources(child, (*path, str(field)))
    elif isinstance(node, list):
        for number, child in enumerate(node):
            yield from _named_sources(child, (*path, str(number)))


def _add_sources(
    name: str, entry: dict[Hashable, Any], shared: Mapping[str, Any], faults: list[DataFault]
) -> frozenset[str]:
    """Put the shared sources that an entry names, and those that carry them, beside its own; return their keys."""
    own = entry.get("sources", {})
    if not isinstance(own, dict):
        return frozenset()  # the schema says so
    told = {**shared, **own}
    named = list(_named_sources(entry))
    faults.extend(DataFault(name, field, f"unknown source {key!r}") for field, key in named if key not in told)
    used = set(own) | {key for _, key in named if key in told}
    used |= {via for key in used for _, via in _named_sources(told[key]) if via in told}
    entry["sources"] = {key: told[key] for key in sorted(used, key=str)}
    return frozenset(key for key in used if key not in own)


def _read_minerals(files: Mapping[str, bytes]) -> Mapping[str, Mineral]:
    """Return the minerals that the files (by name) describe."""
    faults = [DataFault(name, "", "must end in .yaml") for name in sorted(files) if not name.endswith(".yaml")]
    shared = _parse(SOURCES_FILE, files[SOURCES_FILE], faults) if SOURCES_FILE in files else None
    sources: dict[str, Any] = {}
    if shared is not None:
        sources = {str(key): source for key, source in shared.items()}
        faults += [
            DataFault(SOURCES_FILE, field, f"unknown source {key!r}")
            for field, key in _named_sources(sources)
            if key not in sources
        ]
        try:
            _SOURCES.validate_python(sources)
        except ValidationError as error:
            faults += _faults(SOURCES_FILE, error)
    found: dict[str, Mineral] = {}
    for name in sorted(files):
        if name == SOURCES_FILE or not name.endswith(".yaml"):
            continue
        entry = _parse(name, files[name], faults)
        if entry is None:
            continue
        added = tuple(f"sources.{key}." for key in _add_sources(name, entry, sources, faults))
        try:
            mineral = Mineral.model_validate(entry)
        except ValidationError as error:
            # What is wrong with a shared source has been said once, of its own file.
            faults += [fault for fault in _faults(name, error) if not f"{fault.field}.".startswith(added)]
            continue
        if mineral.id != PurePosixPath(name).stem:
            faults.append(DataFault(name, "id", f"must be the name of the file, not {mineral.id!r}"))
        found[mineral.id] = mineral
    if faults:
        raise MineralDataError(faults)
    return MappingProxyType(dict(sorted(found.items())))


def _read_files(folder: Traversable) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in folder.iterdir() if file.name.endswith((".yaml", ".yml"))}


def load_minerals(folder: Traversable) -> Mapping[str, Mineral]:
    """Read and check a folder of mineral data files.

    Parameters
    ----------
    folder : Traversable
        A ``pathlib.Path`` or package resource holding ``<id>.yaml`` files and, if they share sources, ``sources.yaml``.

    Returns
    -------
    Mapping of str to Mineral
        By id, sorted by id, read-only.

    Raises
    ------
    MineralDataError
        Where anything in any of the files is wrong: one error with all the faults.
    OSError
        Where the folder cannot be read.
    """
    return _read_minerals(_read_files(folder))


@cache
def _builtin_files() -> Mapping[str, bytes]:
    """Return the package's data files, read once so that the minerals and the digest speak of the same bytes."""
    return MappingProxyType(_read_files(resources.files("minerals_db") / "data"))


@cache
def builtin_minerals() -> Mapping[str, Mineral]:
    """Return the package's minerals; read once per process."""
    return _read_minerals(_builtin_files())


@cache
def builtin_digest() -> str:
    """Return the SHA-256 over names and bytes of the package's data files."""
    digest = hashlib.sha256()
    for name, data in sorted(_builtin_files().items()):
        digest.update(f"{name}\0{len(data)}\0".encode())
        digest.update(data)
    return digest.hexdigest()
