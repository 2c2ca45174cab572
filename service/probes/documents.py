"""What a probe is asked: one JSON document, or JSON Lines; each faulty one is told by its line."""

from __future__ import annotations

import json
from dataclasses import dataclass

from crystal_core.errors import Fault, InputError, IsogyreError

__all__ = ["BadDocument", "Document", "InvalidJsonError", "read_document", "read_documents", "read_lines"]

BLANK = " \t\r"


class InvalidJsonError(InputError):
    """A text that is not JSON."""


@dataclass(frozen=True, slots=True)
class Document:
    """A JSON value, and the line of the input, from 1, on which it begins."""

    line: int
    value: object


@dataclass(frozen=True, slots=True)
class BadDocument:
    """A document that cannot be answered: the line on which it begins, and why."""

    line: int
    error: IsogyreError


def read_document(data: bytes) -> object:
    """Return the value of one JSON text.

    NaN and Infinity, which are no JSON, are read as numbers: whoever checks the value can tell where they stand.

    Raises
    ------
    InvalidJsonError
        The text is not JSON.
    """
    return _parsed(_text(data))


def read_lines(data: bytes) -> tuple[list[Document], list[BadDocument]]:
    """Read JSON Lines: a document on every line that is not blank.

    Returns
    -------
    list of Document, list of BadDocument
        What was read, and the lines that are not JSON, each in the order of the input.
    """
    lines = [(number, line) for number, line in enumerate(data.split(b"\n"), 1) if line.strip()]
    good, bad = [], []
    for number, line in lines:
        try:
            good.append(Document(number, _parsed(_text(line, first=number == 1))))
        except InvalidJsonError as error:
            bad.append(BadDocument(number, error))
    return good, bad


def read_documents(data: bytes) -> tuple[list[Document], list[BadDocument]]:
    """Read JSON Lines, or one document that may be spread over many lines.

    Returns
    -------
    list of Document, list of BadDocument
        As of `read_lines`. One document counts from the line of its first character; the line of a fault of its syntax
        is where the fault was found.
    """
    lines = data.split(b"\n")
    filled = [(number, line) for number, line in enumerate(lines, 1) if line.strip()]
    if len(filled) < 2:
        return read_lines(data)
    number, line = filled[0]
    if _is_json(line):
        return read_lines(data)
    try:
        return [Document(number, read_document(data))], []
    except InvalidJsonError:
        # Of the lines of one document, only the first begins with a brace at the margin.
        if sum(line.startswith(b"{") for _, line in filled) > 1:
            return read_lines(data)
        return [], [_syntax_fault(data)]


def _is_json(line: bytes) -> bool:
    try:
        read_document(line)
    except InvalidJsonError:
        return False
    return True


def _syntax_fault(data: bytes) -> BadDocument:
    """Return where a document spread over many lines stops being JSON."""
    try:
        text = _text(data)
    except InvalidJsonError as error:
        undecodable = next(n for n, line in enumerate(data.split(b"\n"), 1) if _undecodable(line))
        return BadDocument(undecodable, error)
    try:
        json.loads(text)
    except json.JSONDecodeError as error:
        return BadDocument(error.lineno, InvalidJsonError((Fault("", f"not JSON: {error.msg}, column {error.colno}"),)))
    except (ValueError, RecursionError) as error:
        return BadDocument(1, InvalidJsonError((Fault("", f"not JSON that can be read: {error}"),)))
    raise AssertionError("this text is JSON")


def _text(data: bytes, first: bool = True) -> str:
    try:
        return data.decode("utf-8-sig" if first else "utf-8")
    except UnicodeDecodeError as error:
        raise InvalidJsonError((Fault("", f"not JSON: not UTF-8 at byte {error.start}"),)) from None


def _undecodable(line: bytes) -> bool:
    try:
        line.decode()
    except UnicodeDecodeError:
        return True
    return False


def _parsed(text: str) -> object:
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        place = f"column {error.colno}" if error.lineno == 1 else f"line {error.lineno}, column {error.colno}"
        raise InvalidJsonError((Fault("", f"not JSON: {error.msg}, {place}"),)) from None
    except (ValueError, RecursionError) as error:  # an integer of thousands of digits; too deep
        raise InvalidJsonError((Fault("", f"not JSON that can be read: {error}"),)) from None
