"""Tables as CSV (RFC 4180): a header row, commas, CRLF; empty where nothing is known."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence

__all__ = ["CSV_MEDIA_TYPE", "csv_text"]

CSV_MEDIA_TYPE = "text/csv; charset=utf-8; header=present"


def csv_text(columns: Sequence[str], rows: Iterable[Mapping[str, object]]) -> str:
    """Return a table as CSV.

    Parameters
    ----------
    columns : sequence of str
        Names of the columns, in their order, with the units in them.
    rows : iterable of mapping
        By the names of the columns, all of them and no others. Truth values are written true and false.
    """
    stream = io.StringIO(newline="")
    writer = csv.DictWriter(stream, columns, extrasaction="raise", lineterminator="\r\n")
    writer.writeheader()
    for row in rows:
        writer.writerow({key: str(value).lower() if isinstance(value, bool) else value for key, value in row.items()})
    return stream.getvalue()
