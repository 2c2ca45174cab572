"""Minerals: one data file each, every number with its source and status.

    >>> import minerals_db
    >>> minerals_db.mineral("calcite").dispersion["o"].index([486.1, 589.3, 656.3])

Importing this package reads nothing and imports neither pydantic nor NumPy: the data are loaded at the first question.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

from minerals_db.errors import DataFault, MineralDataError, UnknownMineralError

if TYPE_CHECKING:
    from minerals_db.dispersion import Dispersion
    from minerals_db.optical_rotation import OpticalRotation
    from minerals_db.schema import Cell, Cleavage, Mineral, Names, Orientation, Source, Status
    from minerals_db.store import load_minerals

__all__ = [
    "Cell",
    "Cleavage",
    "DataFault",
    "Dispersion",
    "Mineral",
    "MineralDataError",
    "Names",
    "OpticalRotation",
    "Orientation",
    "Source",
    "Status",
    "UnknownMineralError",
    "data_digest",
    "load_minerals",
    "mineral",
    "minerals",
]

_LAZY = {
    "Cell": "minerals_db.schema",
    "Cleavage": "minerals_db.schema",
    "Dispersion": "minerals_db.dispersion",
    "Mineral": "minerals_db.schema",
    "Names": "minerals_db.schema",
    "OpticalRotation": "minerals_db.optical_rotation",
    "Orientation": "minerals_db.schema",
    "Source": "minerals_db.schema",
    "Status": "minerals_db.schema",
    "load_minerals": "minerals_db.store",
}


def __getattr__(name: str) -> object:
    """Import the models when they are first named (PEP 562)."""
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_LAZY[name]), name)


def minerals() -> Mapping[str, Mineral]:
    """Return every mineral of the package.

    Returns
    -------
    Mapping of str to Mineral
        By id, sorted by id; loaded once per process, read-only.

    Raises
    ------
    MineralDataError
        Where a data file is faulty; all faults of all files are named.
    """
    from minerals_db.store import builtin_minerals

    return builtin_minerals()


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
    """Return the SHA-256 (64 hex digits) over the names and bytes of all data files of the package."""
    from minerals_db.store import builtin_digest

    return builtin_digest()
