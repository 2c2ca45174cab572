"""What can be wrong with the mineral data.

``MineralDataError`` reports faulty files, ``UnknownMineralError`` a question for a mineral that is not there.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["DataFault", "MineralDataError", "UnknownMineralError"]


@dataclass(frozen=True, slots=True)
class DataFault:
    """One wrong place in the mineral data.

    Parameters
    ----------
    file : str
        Name of the file.
    field : str
        Dotted path of the field, "" for the whole file.
    reason : str
        What is wrong, one line.
    """

    file: str
    field: str
    reason: str

    def __str__(self) -> str:
        """Return ``file: field: reason``."""
        return ": ".join(part for part in (self.file, self.field, self.reason) if part)


class MineralDataError(Exception):
    """Mineral data that cannot be trusted; every fault found is named, one a line.

    It is no ``ValueError``: the question during which the data are read first is not what is wrong, and a validator of
    pydantic, which may be who reads them, must not take it for that.

    Parameters
    ----------
    faults : iterable of DataFault
        At least one.
    """

    def __init__(self, faults: Iterable[DataFault]) -> None:
        self.faults = tuple(faults)
        if not self.faults:
            raise ValueError("a MineralDataError names at least one fault")
        super().__init__("\n".join(str(fault) for fault in self.faults))

    def __reduce__(self) -> tuple[type[MineralDataError], tuple[tuple[DataFault, ...]]]:
        """Keep the faults across process boundaries."""
        return type(self), (self.faults,)


class UnknownMineralError(KeyError):
    """No mineral has this id.

    Parameters
    ----------
    mineral_id : str
        The id asked for.
    known : iterable of str
        The ids there are.
    """

    def __init__(self, mineral_id: str, known: Iterable[str]) -> None:
        self.mineral_id = mineral_id
        self.known = tuple(known)
        super().__init__(mineral_id)

    def __str__(self) -> str:
        """Return a sentence: KeyError alone would show the bare key in quotes."""
        near = difflib.get_close_matches(self.mineral_id.lower(), self.known)
        meant = f"do you mean {' or '.join(near)}?" if near else f"{len(self.known)} are known, none of them like it"
        return f"no mineral {self.mineral_id!r}; {meant}"

    def __reduce__(self) -> tuple[type[UnknownMineralError], tuple[str, tuple[str, ...]]]:
        """Keep the known ids across process boundaries."""
        return type(self), (self.mineral_id, self.known)
