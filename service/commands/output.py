"""What a command prints on stdout: read by people, by programs, or by nobody any more."""

from __future__ import annotations

import io
import json
import os
import sys

__all__ = ["print_json", "print_text"]


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
