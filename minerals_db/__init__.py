"""Minerals: one data file each, every number with its source and status.

    >>> import minerals_db
    >>> minerals_db.mineral("calcite").dispersion["o"].index([486.1, 589.3, 656.3])

Importing this package reads nothing and imports neither pydantic nor NumPy: the data are loaded at the first question.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from minerals_db.errors import DataFault, MineralDataError, UnknownMineralError

if TYPE_CHECKING:
    from minerals_db.absorption import Absorption
    from minerals_db.dispersion import Dispersion
    from minerals_db.fields import Status
    from minerals_db.morphology import Cell, Cleavage, Habit
    from minerals_db.optical_rotation import OpticalRotation
    from minerals_db.orientation import MonoclinicOrientation, OrthorhombicOrientation, TriclinicOrientation
    from minerals_db.schema import Mineral, Names, Source
    from minerals_db.store import load_minerals

__all__ = [
    "Absorption",
    "Cell",
    "Cleavage",
    "DataFault",
    "Dispersion",
    "Habit",
    "Mineral",
    "MineralDataError",
    "MonoclinicOrientation",
    "Names",
    "OpticalRotation",
    "OrthorhombicOrientation",
    "Source",
    "Status",
    "TriclinicOrientation",
    "UnknownMineralError",
    "data_digest",
    "entry_schema",
    "load_minerals",
    "mineral",
    "minerals",
]

_LAZY = {
    "Absorption": "minerals_db.absorption",
    "Cell": "minerals_db.morphology",
    "Cleavage": "minerals_db.morphology",
    "Dispersion": "minerals_db.dispersion",
    "Habit": "minerals_db.morphology",
    "Mineral": "minerals_db.schema",
    "MonoclinicOrientation": "minerals_db.orientation",
    "Names": "minerals_db.schema",
    "OpticalRotation": "minerals_db.optical_rotation",
    "OrthorhombicOrientation": "minerals_db.orientation",
    "Source": "minerals_db.schema",
    "Status": "minerals_db.fields",
    "TriclinicOrientation": "minerals_db.orientation",
    "load_minerals": "minerals_db.store",
}


def __getattr__(name: str) -> object:
    """Import the models when they are first named (PEP 562)."""
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_LAZY[name]), name)


def minerals() -> Mapping[str, Mineral]:
    """Return every mineral: those of the package, and those of the folder that ``ISOGYRE_MINERALS_DIR`` names.

    Returns
    -------
    Mapping of str to Mineral
        By id, sorted by id; loaded once per process, read-only.

    Raises
    ------
    MineralDataError
        Where a data file is faulty; all faults of all files are named.
    """
    from minerals_db.library import all_minerals

    return all_minerals()


def mineral(mineral_id: str) -> Mineral:
    """Return one mineral.

    Parameters
    ----------
    mineral_id : str
        Its id, the name of its data file.

    Raises
    ------
    UnknownMineralError
        Where no mineral has this id; the message names those there are.
    MineralDataError
        Where a data file is faulty.
    """
    known = minerals()
    try:
        return known[mineral_id]
    except KeyError:
        raise UnknownMineralError(mineral_id, known) from None


def data_digest() -> str:
    """Return the SHA-256 (64 hex digits) over the names and bytes of all data files, the user's own included.

    Raises
    ------
    MineralDataError
        Where the user's folder cannot be read.
    """
    from minerals_db.library import data_digest as digest

    return digest()


def entry_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a data file."""
    from minerals_db.schema import Mineral

    return Mineral.model_json_schema()
