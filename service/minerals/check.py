"""Checks of mineral data files: those of the package, of the user's own folder, or any others."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from crystal_core.errors import Fault, InputError
from minerals_db import DataFault, Mineral, MineralDataError
from minerals_db.data_files import read_files
from minerals_db.library import builtin_minerals, own_folder, own_minerals
from minerals_db.store import SOURCES_PREFIX, read_minerals
from minerals_db.yaml_files import parse

__all__ = ["Report", "check_all", "check_paths"]


@dataclass(frozen=True, slots=True)
class Report:
    """What a check has found.

    Parameters
    ----------
    checked : int
        How many entries were looked at.
    minerals : sequence of Mineral
        Those of the files among which there was no fault.
    faults : sequence of DataFault
        All of them.
    """

    checked: int
    minerals: Sequence[Mineral]
    faults: Sequence[DataFault]

    def document(self) -> dict[str, Any]:
        """Return it as a JSON object."""
        told = [{"file": fault.file, "field": fault.field, "reason": fault.reason} for fault in self.faults]
        return {"minerals": self.checked, "faults": told}

    def counts(self) -> str:
        """Return a line that says what was checked and found good."""
        varieties = sum(mineral.is_variety for mineral in self.minerals)
        own = sum(mineral.origin == "own" for mineral in self.minerals)
        told = [f"{self.checked} {'entry' if self.checked == 1 else 'entries'}"]
        told += [f"{varieties} of varieties"] if varieties else []
        told += [f"{own} of your own"] if own else []
        return f"{', '.join(told)}: nothing wrong"


def check_all() -> Report:
    """Check the built-in minerals and those of the user's own folder."""
    own = own_folder()
    checked = len(_entry_names(read_files(_builtin_folder())))
    try:
        minerals = list(builtin_minerals().values())
        if own is not None and own.is_dir():
            checked += len(_entry_names(read_files(own)))
        minerals += own_minerals().values()
    except MineralDataError as error:
        return Report(checked, (), error.faults)
    return Report(checked, minerals, ())


def check_paths(paths: Iterable[str]) -> Report:
    """Check folders of data files, and single data files.

    They may build upon the built-in minerals, as a user's own do. A file may also name the sources beside it, and be a
    variety of a mineral beside it, which is checked with it.

    Parameters
    ----------
    paths : iterable of str
        Folders and files.

    Raises
    ------
    InputError
        A path that is neither a folder nor a YAML file.
    OSError
        What cannot be read.
    """
    asked = [Path(text) for text in dict.fromkeys(paths)]
    if wrong := [Fault(repr(str(path)), reason) for path in asked if (reason := _unusable(path))]:
        raise InputError(wrong)
    checked = 0
    minerals: list[Mineral] = []
    faults: list[DataFault] = []
    for path in asked:
        folder = path if path.is_dir() else path.parent
        files = read_files(folder)
        if path != folder:
            files = dict(_beside(files, path.name))
        checked += len(_entry_names(files)) if path == folder else 1
        try:
            base = {} if folder.resolve() == _builtin_folder().resolve() else builtin_minerals()
        except MineralDataError as error:
            return Report(checked, (), error.faults)
        try:
            minerals += read_minerals(files, base).values()
        except MineralDataError as error:
            faults += [DataFault(str(folder / fault.file), fault.field, fault.reason) for fault in error.faults]
    return Report(checked, minerals, faults)


def _unusable(path: Path) -> str | None:
    """Return why a path cannot be checked, None if it can."""
    try:
        if path.is_dir():
            return None
        if not path.is_file():
            return "there is no such folder or file"
    except ValueError as error:  # no name that a file could have
        return str(error)
    if not path.name.endswith(".yaml"):
        return "must end in .yaml"
    return "holds sources; give its folder" if path.name.startswith(SOURCES_PREFIX) else None


def _builtin_folder() -> Path:
    return Path(str(resources.files("minerals_db") / "data"))


def _entry_names(files: Iterable[str]) -> list[str]:
    return [name for name in files if name.endswith(".yaml") and not name.startswith(SOURCES_PREFIX)]


def _beside(files: Mapping[str, bytes], name: str) -> Iterator[tuple[str, bytes]]:
    """Yield a data file with those it may build upon."""
    entry = parse(name, files[name], []) or {}
    wanted = {name, f"{entry.get('variety_of')}.yaml"}
    for other, data in files.items():
        if other in wanted or (other.startswith(SOURCES_PREFIX) and other.endswith(".yaml")):
            yield other, data
