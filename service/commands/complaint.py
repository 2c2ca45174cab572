"""What went wrong, told to a person at the command line: a line on stderr for each wrong option."""

from __future__ import annotations

import sys

from crystal_core.errors import InputError

__all__ = ["complain", "input_complaints", "one_line"]


def complain(text: str) -> None:
    """Write one line to stderr, whatever control characters the text holds."""
    print(f"isogyre: {one_line(text)}", file=sys.stderr)


def one_line(text: str) -> str:
    """Return a text with its control characters spelt out, so that it stays one line and does nothing to a terminal."""
    return "".join(character if character.isprintable() else ascii(character)[1:-1] for character in text)


def input_complaints(error: InputError) -> list[str]:
    """Return a text for each wrong option, in the order of the faults.

    Parameters
    ----------
    error : InputError
        Its pointers lead into a render's request (``/size/0``, ``/parameters/marks/2``) or are names already
        (``--port``).

    Returns
    -------
    list of str
        Such as ``--size: width: must be …``; faults of one option share its text.
    """
    texts: dict[str, list[str]] = {}
    for fault in error.faults:
        option, place = _where(fault.pointer)
        texts.setdefault(option, []).append(f"{place}: {fault.message}" if place else fault.message)
    return [f"{option}: {'; '.join(messages)}" if option else "; ".join(messages) for option, messages in texts.items()]


def _where(pointer: str) -> tuple[str, str]:
    """Return the option that a pointer leads to, and the place inside its value."""
    if not pointer.startswith("/"):
        return pointer, ""
    head, *rest = (part.replace("~1", "/").replace("~0", "~") for part in pointer[1:].split("/"))
    if head == "demonstration":
        return head, ""
    if head == "size" and rest:
        return "--size", {"0": "width", "1": "height"}.get(rest[0], rest[0])
    if head == "parameters" and rest:
        return f"--set {rest[0]}", "".join(f"[{part}]" for part in rest[1:])
    return "--set" if head == "parameters" else f"--{head}", "".join(f"[{part}]" for part in rest)
