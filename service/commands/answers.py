"""A probe at the command line: questions from a file or stdin, answers on stdout once all of them are there."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from crystal_core.errors import Fault, InputError, NotSupportedError

if TYPE_CHECKING:
    from typing import Any

    from service.probes.documents import BadDocument
    from service.probes.probe import Probe

__all__ = ["MAX_DOCUMENTS", "print_answers"]

MAX_DOCUMENTS = 100_000
"""Most questions of one run."""

_CHUNK = 5_000
_IN_MEMORY = 1 << 26


def print_answers(probe: Probe[Any], file: str) -> None:
    """Print a line of JSON for each question, in their order.

    Parameters
    ----------
    probe : Probe
        What is asked.
    file : str
        A file of one JSON document or of JSON Lines; "-" for stdin.

    Raises
    ------
    InputError, NotSupportedError
        The first line that cannot be answered, by its number; nothing has been printed then.
    """
    from service.probes.documents import read_documents
    from service.probes.probe import UnanswerableError, encode

    documents, bad = read_documents(_read(file))
    if not documents and not bad:
        raise InputError.at("FILE", "there is nothing in it; one JSON document or JSON Lines are expected")
    if len(documents) > MAX_DOCUMENTS:
        raise InputError.at("FILE", f"has {len(documents)} documents; at most {MAX_DOCUMENTS} are answered in one run")
    if bad:
        documents = [document for document in documents if document.line < bad[0].line]
    with tempfile.SpooledTemporaryFile(_IN_MEMORY, "w+", encoding="ascii", newline="\n") as answers:
        try:
            for start in range(0, len(documents), _CHUNK):
                for answer in probe.ask_all(documents[start : start + _CHUNK]):
                    answers.write(encode(answer) + "\n")
        except UnanswerableError as error:
            raise _complaint(error.documents[0]) from None
        if bad:
            raise _complaint(bad[0])
        answers.seek(0)
        _print(answers)


def _read(file: str) -> bytes:
    try:
        return sys.stdin.buffer.read() if file == "-" else Path(file).read_bytes()
    except (OSError, ValueError) as error:  # ValueError: no name that a file could have
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError.at("FILE", f"{file!r} cannot be read: {reason}") from error


def _complaint(bad: BadDocument) -> InputError | NotSupportedError:
    """Return the error of a line as one that the command line tells in a line."""
    where = f"line {bad.line}"
    if isinstance(bad.error, InputError):
        return InputError(Fault(where, str(fault) if fault.pointer else fault.message) for fault in bad.error.faults)
    return NotSupportedError(f"{where}: {bad.error}")


def _print(answers: tempfile.SpooledTemporaryFile[str]) -> None:
    try:
        shutil.copyfileobj(answers, sys.stdout)
        sys.stdout.flush()
    except BrokenPipeError:
        # Whoever reads has seen enough. The interpreter would complain of what is left when it flushes at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
