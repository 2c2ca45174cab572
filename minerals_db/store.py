"""From data files to checked entries.

A folder of ``<id>.yaml`` files and the ``sources*.yaml`` that they share become ``Mineral`` models. A variety takes
from its mineral what it does not state itself. Everything that is wrong in any of the files is collected and reported
in one error.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from pathlib import PurePosixPath
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter, ValidationError

from minerals_db.data_files import read_files
from minerals_db.errors import DataFault, MineralDataError
from minerals_db.schema import VARIETY_OWN, Mineral, Source
from minerals_db.yaml_files import faults_of, parse

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

__all__ = ["SOURCES_PREFIX", "load_minerals", "read_minerals"]

SOURCES_PREFIX = "sources"
"""How the names of the files begin that hold sources for all minerals, as ``sources-structures.yaml``."""

_SOURCES: TypeAdapter[dict[str, Source]] = TypeAdapter(dict[str, Source])
_Fields = dict[Hashable, Any]


def load_minerals(folder: Traversable, base: Mapping[str, Mineral] = MappingProxyType({})) -> Mapping[str, Mineral]:
    """Read and check a folder of mineral data files.

    Parameters
    ----------
    folder : Traversable
        A ``pathlib.Path`` or package resource holding ``<id>.yaml`` files and, if they share sources, files whose names
        begin with ``sources``.
    base : Mapping of str to Mineral
        Entries that the folder may build upon: their varieties, their sources. None of their ids may stand in it again.

    Returns
    -------
    Mapping of str to Mineral
        Those of the folder by id, sorted by id, read-only.

    Raises
    ------
    MineralDataError
        Where anything in any of the files is wrong: one error with all the faults.
    OSError
        Where the folder cannot be read.
    """
    return read_minerals(read_files(folder), base)


def read_minerals(files: Mapping[str, bytes], base: Mapping[str, Mineral]) -> Mapping[str, Mineral]:
    """Return the minerals that files (by name) describe; see `load_minerals`."""
    faults = [DataFault(name, "", "must end in .yaml") for name in sorted(files) if not name.endswith(".yaml")]
    shared = _shared_sources(files, base, faults)
    entries: dict[str, _Fields] = {}
    for name in sorted(files):
        if name.endswith(".yaml") and not name.startswith(SOURCES_PREFIX):
            entry = parse(name, files[name], faults)
            if entry is not None:
                entries[name] = entry
    known = {mineral.id: _fields_of(mineral) for mineral in base.values()}
    known |= {entry["id"]: entry for entry in entries.values() if isinstance(entry.get("id"), str)}
    found: dict[str, Mineral] = {}
    # Minerals before their varieties, which are not told again what is wrong with their mineral.
    for name, entry in sorted(entries.items(), key=lambda item: ("variety_of" in item[1], item[0])):
        whole = _with_mineral(name, entry, known, faults)
        if whole is None:
            continue
        taken = _add_sources(name, entry, whole, {**shared, **_own_sources(known, entry)}, faults)
        try:
            mineral = Mineral.model_validate(whole)
        except ValidationError as error:
            # What is wrong with a shared source, or with the mineral of a variety, has been said once, of its own file.
            parent = entry.get("variety_of")
            faulty = parent is not None and parent not in found and parent not in base
            inherited = set(whole) - set(entry) - {"sources"} if faulty else set()
            passed = tuple(f"{field}." for field in (*taken, *inherited))
            faults += [fault for fault in faults_of(name, whole, error) if not f"{fault.field}.".startswith(passed)]
            continue
        if mineral.id != PurePosixPath(name).stem:
            faults.append(DataFault(name, "id", f"must be the name of the file, not {mineral.id!r}"))
        if mineral.id in base:
            faults.append(DataFault(name, "id", f"{mineral.id!r} is a built-in mineral: choose another id"))
        found[mineral.id] = mineral
    if faults:
        raise MineralDataError(faults)
    return MappingProxyType(dict(sorted(found.items())))


def _shared_sources(
    files: Mapping[str, bytes], base: Mapping[str, Mineral], faults: list[DataFault]
) -> Mapping[Hashable, Any]:
    """Return the sources that entries may name, by key."""
    shared: _Fields = {}
    for mineral in base.values():
        shared.update({key: source.model_dump(exclude_unset=True) for key, source in mineral.sources.items()})
    own: dict[str, _Fields] = {}
    for name in sorted(files):
        if name.startswith(SOURCES_PREFIX) and name.endswith(".yaml"):
            content = parse(name, files[name], faults)
            if content is not None:
                own[name] = content
    for name, content in own.items():
        faults += [DataFault(name, str(key), "stands in another file already") for key in content if key in shared]
        shared.update(content)
    for name, content in own.items():
        faults += [
            DataFault(name, field, f"unknown source {key!r}")
            for field, key in _named_sources(content)
            if key not in shared
        ]
        try:
            _SOURCES.validate_python(content)
        except ValidationError as error:
            faults += faults_of(name, content, error)
    return shared


def _fields_of(mineral: Mineral) -> _Fields:
    """Return what a data file of the whole entry would hold."""
    return mineral.model_dump(mode="json", exclude_unset=True)  # type: ignore[return-value]  # str is Hashable


def _with_mineral(name: str, entry: _Fields, known: Mapping[str, _Fields], faults: list[DataFault]) -> _Fields | None:
    """Return an entry with what a variety takes from its mineral; None, and a fault, where that is not there."""
    parent = entry.get("variety_of")
    if not isinstance(parent, str):
        return dict(entry)
    if parent not in known:
        faults.append(DataFault(name, "variety_of", f"there is no mineral {parent!r}"))
        return None
    if known[parent].get("variety_of") is not None:
        faults.append(DataFault(name, "variety_of", f"{parent!r} is a variety itself; name its mineral"))
        return None
    return {**{field: value for field, value in known[parent].items() if field not in VARIETY_OWN}, **entry}


def _own_sources(known: Mapping[str, _Fields], entry: _Fields) -> _Fields:
    """Return the sources that stand in the entry of a variety's mineral itself."""
    parent = entry.get("variety_of")
    own = known.get(parent, {}).get("sources") if isinstance(parent, str) else None
    return own if isinstance(own, dict) else {}


def _named_sources(node: object, path: tuple[str, ...] = ()) -> Iterator[tuple[str, str]]:
    """Yield the place and the key of every source that a file names."""
    if isinstance(node, dict):
        for field, child in node.items():
            if field in ("source", "dispersion_source", "via") and isinstance(child, str):
                yield ".".join((*path, field)), child
            else:
                yield from _named_sources(child, (*path, str(field)))
    elif isinstance(node, list):
        for number, child in enumerate(node):
            yield from _named_sources(child, (*path, str(number)))


def _add_sources(
    name: str, entry: _Fields, whole: _Fields, shared: Mapping[Hashable, Any], faults: list[DataFault]
) -> frozenset[str]:
    """Put the sources that an entry names, and those that carry them, beside its own; return where they were put."""
    own = entry.get("sources", {})
    if not isinstance(own, dict):
        return frozenset()  # the schema says so
    told = {**shared, **own}
    named = list(_named_sources({field: value for field, value in whole.items() if field != "sources"}))
    named += list(_named_sources({"sources": own}))
    inherited = set(whole) - set(entry)
    faults.extend(
        DataFault(name, field, f"unknown source {key!r}")
        for field, key in named
        if key not in told and field.split(".")[0] not in inherited
    )
    used = set(own) | {key for _, key in named if key in told}
    used |= {via for key in used for _, via in _named_sources(told[key]) if via in told}
    whole["sources"] = {key: told[key] for key in sorted(used, key=str)}
    return frozenset(f"sources.{key}" for key in used if key not in own)
