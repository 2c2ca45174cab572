"""The errors that people and programs can mend.

Exception tree::

    IsogyreError
    ├── InputError        what was asked for is wrong; carries one Fault per wrong place
    └── NotSupportedError what was asked for is sound, but this version cannot do it
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["Fault", "InputError", "IsogyreError", "NotSupportedError"]


class IsogyreError(Exception):
    """Base of every error this project raises on purpose."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One wrong place in an input.

    Parameters
    ----------
    pointer : str
        JSON pointer (RFC 6901) into the input, "" for the whole of it.
    message : str
        What is wrong there and what would be right, one line.
    """

    pointer: str
    message: str

    def __str__(self) -> str:
        """Return ``pointer: message``."""
        return f"{self.pointer or '(input)'}: {self.message}"


class InputError(IsogyreError, ValueError):
    """What was asked for is wrong; nothing has been done.

    Parameters
    ----------
    faults : iterable of Fault
        Every wrong place found, at least one.
    """

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = tuple(faults)
        if not self.faults:
            raise ValueError("an InputError names at least one fault")
        super().__init__("; ".join(str(fault) for fault in self.faults))

    def __reduce__(self) -> tuple[type[InputError], tuple[tuple[Fault, ...]]]:
        """Keep the faults across process boundaries."""
        return type(self), (self.faults,)

    @classmethod
    def at(cls, pointer: str, message: str) -> InputError:
        """Return the error of one fault."""
        return cls((Fault(pointer, message),))


class NotSupportedError(IsogyreError):
    """A sound request that this version cannot carry out; the message says what would be needed."""
