"""Pages of a list, and the cursors that lead from one to the next."""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import minerals_db
import service
from crystal_core.errors import InputError
from minerals_db import Mineral

__all__ = ["Page", "answer_version", "digest_of", "page"]


@dataclass(frozen=True, slots=True)
class Page:
    """A part of a list, and the cursor of the next part, None after the last."""

    minerals: Sequence[Mineral]
    next_cursor: str | None


def page(found: Sequence[Mineral], query: Mapping[str, Any], limit: int, cursor: str | None, where: str) -> Page:
    """Return a part of what a query has found.

    A cursor holds the digests of the query and of the data and the id of the last mineral that was told, so that it
    leads on in the same list or nowhere.

    Parameters
    ----------
    found : sequence of Mineral
        All of it, in its order.
    query : mapping
        What was asked for, as JSON values: a cursor of another query is refused.
    limit : int
        Most minerals of a page.
    cursor : str or None
        Of a page before; None for the first.
    where : str
        Pointer of a fault of the cursor.

    Raises
    ------
    InputError
        No cursor of this service; one of another query; one from before the data changed.
    """
    of_query, of_data = digest_of(query), answer_version()
    start = 0
    if cursor is not None:
        told_query, told_data, last = _read(cursor, where)
        if told_data != of_data:
            raise InputError.at(where, "the minerals have changed since; begin again without a cursor")
        ids = [mineral.id for mineral in found]
        if told_query != of_query or last not in ids:
            raise InputError.at(where, "belongs to another query; its links give the cursors of a list")
        start = ids.index(last) + 1
    part = found[start : start + limit]
    more = start + len(part) < len(found)
    return Page(part, _write((of_query, of_data, part[-1].id)) if part and more else None)


def digest_of(value: object) -> str:
    """Return a short digest of a JSON value."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def answer_version() -> str:
    """Return a short digest of the data and of the code that answers with them: what answers depend on besides."""
    return digest_of([minerals_db.data_digest(), _code_digest()])


@cache
def _code_digest() -> str:
    digest = hashlib.sha256()
    for package in (minerals_db, service):
        root = Path(str(package.__file__)).parent
        for path in sorted(root.rglob("*.py")):
            digest.update(f"{package.__name__}/{path.relative_to(root).as_posix()}\0".encode())
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def _write(place: tuple[str, str, str]) -> str:
    return base64.urlsafe_b64encode(json.dumps(place, separators=(",", ":")).encode()).decode().rstrip("=")


def _read(cursor: str, where: str) -> tuple[str, str, str]:
    try:
        place = json.loads(base64.b64decode(cursor + "=" * (-len(cursor) % 4), altchars=b"-_", validate=True))
    except (binascii.Error, ValueError, RecursionError):
        place = None
    if not isinstance(place, list) or len(place) != 3 or not all(isinstance(part, str) for part in place):
        raise InputError.at(where, "is no cursor of this service")
    return (place[0], place[1], place[2])
