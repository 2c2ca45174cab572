"""The minerals there are: those of the package, and those of the user's own folder.

The package's entries are checked once and kept in the user's cache folder as JSON, which loads ten times as fast as
their YAML. The cache is bound to the bytes of the data and of this package; what it holds passes the schema again.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Mapping
from functools import cache
from importlib import resources
from pathlib import Path
from types import MappingProxyType

from pydantic import RootModel, ValidationError

from minerals_db.data_files import digest_of, read_files
from minerals_db.errors import DataFault, MineralDataError
from minerals_db.schema import Mineral

__all__ = ["OWN_FOLDER_VARIABLE", "all_minerals", "builtin_minerals", "data_digest", "own_folder", "own_minerals"]

OWN_FOLDER_VARIABLE = "ISOGYRE_MINERALS_DIR"
"""Environment variable that names the folder of the user's own minerals. The environment, because every process of a
render, wherever it was started, has to see the same minerals."""


class _Minerals(RootModel[dict[str, Mineral]]):
    """What the cache holds."""


@cache
def builtin_minerals() -> Mapping[str, Mineral]:
    """Return the package's minerals by id; read once per process.

    Raises
    ------
    MineralDataError
        Where a data file is faulty.
    """
    key = f"{digest_of(_builtin_files())} {digest_of(_code())}\n".encode()
    file = _cache_file()
    found = _cached(file, key)
    if found is None:
        from minerals_db.store import read_minerals  # with its YAML: only for those who need it

        found = read_minerals(_builtin_files(), {})
        _keep(file, key + _Minerals(dict(found)).model_dump_json(exclude_unset=True).encode())
    return found


@cache
def own_minerals() -> Mapping[str, Mineral]:
    """Return the minerals of the user's own folder by id; read once per process.

    Raises
    ------
    MineralDataError
        Where the folder cannot be read or a file in it is faulty.
    """
    folder = own_folder()
    if folder is None:
        return MappingProxyType({})
    from minerals_db.store import read_minerals

    try:
        found = read_minerals(_own_files(), builtin_minerals())
    except MineralDataError as error:
        raise MineralDataError(
            DataFault(str(folder / fault.file), fault.field, fault.reason) for fault in error.faults
        ) from None
    for mineral in found.values():
        mineral._origin = "own"
    return found


@cache
def all_minerals() -> Mapping[str, Mineral]:
    """Return all minerals by id, sorted by id, read-only.

    Raises
    ------
    MineralDataError
        Where a data file is faulty, built in or of the user.
    """
    return MappingProxyType(dict(sorted({**builtin_minerals(), **own_minerals()}.items())))


@cache
def data_digest() -> str:
    """Return the SHA-256 (64 hex digits) over names and bytes of all data files, built in and of the user.

    Raises
    ------
    MineralDataError
        Where the user's folder cannot be read.
    """
    own = {f"own/{name}": data for name, data in _own_files().items()}
    return digest_of({**_builtin_files(), **own})


def own_folder() -> Path | None:
    """Return the folder of the user's own minerals, None if the environment names none."""
    named = os.environ.get(OWN_FOLDER_VARIABLE, "")
    return Path(named).expanduser().absolute() if named else None


@cache
def _builtin_files() -> Mapping[str, bytes]:
    """Return the package's data files, read once so that the minerals and the digest speak of the same bytes."""
    return MappingProxyType(read_files(resources.files("minerals_db") / "data"))


@cache
def _own_files() -> Mapping[str, bytes]:
    folder = own_folder()
    if folder is None:
        return MappingProxyType({})
    try:
        return MappingProxyType(read_files(folder))
    except OSError as error:
        raise MineralDataError([DataFault(str(folder), "", f"{OWN_FOLDER_VARIABLE}: {error.strerror}")]) from None


def _code() -> Mapping[str, bytes]:
    """Return the package's own modules: what the schema means may change while the data stay."""
    package = resources.files("minerals_db")
    return {file.name: file.read_bytes() for file in package.iterdir() if file.name.endswith(".py")}


def _cache_file() -> Path:
    """Return the file of the cache, after the XDG base directory specification."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    # A relative XDG_CACHE_HOME is to be ignored, says the specification.
    root = Path(base) if base and Path(base).is_absolute() else Path("~/.cache").expanduser()
    return root / "isogyre" / "minerals.json"


def _cached(file: Path, key: bytes) -> Mapping[str, Mineral] | None:
    """Return the minerals of the cache, None where there is none that fits the data and the code."""
    try:
        content = file.read_bytes()
    except OSError:
        return None
    if not content.startswith(key):
        return None
    try:
        return MappingProxyType(_Minerals.model_validate_json(content[len(key) :]).root)
    except ValidationError:
        return None  # damaged on the disk: the YAML is what counts


def _keep(file: Path, content: bytes) -> None:
    """Write the cache whole or not at all. Where there is no room for one the next process reads the YAML again."""
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=file.parent, prefix=file.name, delete=False) as written:
            written.write(content)
        try:
            Path(written.name).replace(file)
        except OSError:
            Path(written.name).unlink(missing_ok=True)
