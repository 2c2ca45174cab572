"""One JSON document or many lines of them: what is taken for which, and which line is told to be wrong."""

from __future__ import annotations

import pytest

from service.probes.documents import read_documents, read_lines

PRETTY = b'{\n  "plates": [\n    {"a": [1, 2]},\n    {"a": [3]}\n  ],\n  "b": 5\n}\n'
WHOLE = {"plates": [{"a": [1, 2]}, {"a": [3]}], "b": 5}


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (b'{"a": 1}', [(1, {"a": 1})]),
        (b'{"a": 1}\n', [(1, {"a": 1})]),
        (b'{"a": 1}\n{"a": 2}\n', [(1, {"a": 1}), (2, {"a": 2})]),
        (b'\n\n{"a": 1}\r\n   \n\t\n{"a": 2}', [(3, {"a": 1}), (6, {"a": 2})]),
        (b'\xef\xbb\xbf{"a": 1}\n{"a": 2}', [(1, {"a": 1}), (2, {"a": 2})]),
        (PRETTY, [(1, WHOLE)]),
        (b"\n \n" + PRETTY, [(3, WHOLE)]),
        (PRETTY.replace(b"\n", b"\r\n"), [(1, WHOLE)]),
        (PRETTY.replace(b"  ", b""), [(1, WHOLE)]),
        (b"\xef\xbb\xbf" + PRETTY, [(1, WHOLE)]),
        # What ends a line elsewhere may stand inside a text.
        ('{"a": "\u2028\x85"}\n{"a": 2}'.encode(), [(1, {"a": "\u2028\x85"}), (2, {"a": 2})]),
        (b"5\n[1]\nnull\n", [(1, 5), (2, [1]), (3, None)]),
        (b"", []),
        (b" \n\n", []),
    ],
)
def test_documents_and_their_lines(text: bytes, found: list[tuple[int, object]]) -> None:
    documents, bad = read_documents(text)
    assert [(document.line, document.value) for document in documents] == found
    assert bad == []


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        (b"{", [1]),
        (b'{"a": 1}\n{"a": \n{"a": 3}\n', [2]),
        (b'{"a": 1}\n\n{"a" 2}\nx\n{"a": 3}\n', [3, 4]),
        (b'{"a": \n{"a": 2}\n{"a": 3}\n', [1]),
        (b'{"a": \n{"a": \n{"a": 3}\n', [1, 2]),
        (b'{"a": 1} {"a": 2}\n', [1]),
        (b'{"a": 1}\n{"a": "\xff"}\n', [2]),
        (PRETTY.replace(b'"b": 5', b'"b" 5'), [6]),
        (PRETTY.replace(b"]},", b"]}"), [4]),
        (PRETTY[:-2], [7]),
        (PRETTY.replace(b'"b"', b'"\xff"'), [6]),
        (b'{\n"a": ' + b"9" * 5000 + b"\n}", [1]),
        (b'{"a": ' + b"[" * 100_000, [1]),
        (b"5\n\xef\xbb\xbf{}\n", [2]),
    ],
)
def test_lines_that_are_not_json(text: bytes, lines: list[int]) -> None:
    _, bad = read_documents(text)
    assert [document.line for document in bad] == lines
    for document in bad:
        assert str(document.error).startswith("(input): not JSON")
        assert "\n" not in str(document.error)


def test_lines_are_not_joined_where_lines_were_promised() -> None:
    documents, bad = read_lines(PRETTY)
    assert [document.line for document in documents] == [4]
    assert [document.line for document in bad] == [1, 2, 3, 5, 6, 7]
