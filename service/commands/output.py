"""What a command gives out: on stdout, read by people, by programs, or by nobody any more; or in a file."""

from __future__ import annotations

import errno
import io
import json
import os
import sys
from pathlib import Path

from crystal_core.errors import InputError

__all__ = ["print_json", "print_text", "write_file"]

_FAILURES = {errno.ENOSPC, errno.EDQUOT, errno.EIO}
"""What goes wrong with a disk although the file was well chosen."""


def print_json(value: object) -> None:
    """Write a value to stdout as one line of JSON, every number with all its digits."""
    print_text(json.dumps(value, allow_nan=False, separators=(",", ":")))


def print_text(text: str, end: str = "\n") -> None:
    """Write a text to stdout.

    Letters that the terminal's encoding lacks are spelt out. A reader that has gone away ends the output without a
    complaint.

    Parameters
    ----------
    text : str
        What to write.
    end : str
        What follows it.
    """
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        print(text, end=end)
        sys.stdout.flush()
    except BrokenPipeError:
        # Whoever reads has seen enough. The interpreter would complain of what is left when it flushes at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def write_file(out: str, data: bytes, option: str) -> None:
    """Write a file that an option names, whole or not at all.

    Raises
    ------
    InputError
        At the option: the file cannot be written.
    OSError
        The disk fails.
    """
    from crystal_core.output.files import write_atomically

    try:
        write_atomically(Path(out), data)
    except OSError as error:
        if error.errno in _FAILURES:
            raise
        raise InputError.at(option, f"{out} cannot be written: {error.strerror}") from error
    except ValueError as error:  # no name that a file could have
        raise InputError.at(option, f"{out!r} cannot be written: {error}") from None
