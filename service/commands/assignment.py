"""Values as they are typed on the command line: ``--set key=value`` and ``--size 640x480``."""

from __future__ import annotations

import hashlib
import json
import re
import stat
from collections.abc import Iterable
from pathlib import Path

from crystal_core.errors import Fault, InputError
from crystal_core.output.files import write_atomically
from crystal_core.scene.texture import MAX_BYTES, check_texture

__all__ = ["keep_texture", "parse_assignments", "parse_size"]

TEXTURE = "texture"


def parse_assignments(texts: Iterable[str]) -> tuple[dict[str, object], list[Fault]]:
    """Read the parameters of ``--set``.

    Parameters
    ----------
    texts : iterable of str
        Each ``key=value``; the value is JSON if it can be read as such, else a string.

    Returns
    -------
    dict
        The values by key. A texture is left as it was typed, for `keep_texture`.
    list of Fault
        An assignment without ``=`` or key, and a key that comes twice.
    """
    values: dict[str, object] = {}
    faults = []
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key:
            faults.append(Fault("--set", f"must be key=value, not {text!r}"))
        elif key in values:
            faults.append(Fault(f"/parameters/{_escaped(key)}", "is set more than once"))
        else:
            values[key] = _value(value)
            if key == TEXTURE and not isinstance(values[key], str):
                values[key] = value  # a file's name may look like a number
    return values, faults


def keep_texture(text: str, assets: Path) -> str:
    """Return what stands for a texture in a request, having put its picture among the assets.

    Parameters
    ----------
    text : str
        "digits", or the path of a PNG or JPEG picture.
    assets : Path
        Folder of the files that a request may name.

    Returns
    -------
    str
        "digits" or ``asset:<sha256>``.

    Raises
    ------
    InputError
        There is no such file, or it is no picture that can be taken.
    """
    if text == "digits":
        return text
    pointer = f"/parameters/{TEXTURE}"
    try:
        data = _read(Path(text), pointer)
    except InputError:
        raise
    except (OSError, ValueError) as error:  # ValueError: no name that a file could have
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError.at(pointer, f"{text!r} cannot be read: {reason}") from error
    check_texture(data, pointer)
    digest = hashlib.sha256(data).hexdigest()
    write_atomically(assets / digest, data)
    return f"asset:{digest}"


def parse_size(text: str) -> tuple[int, int]:
    """Read ``WIDTHxHEIGHT``.

    Raises
    ------
    InputError
        The text is not of this form; whether the numbers make sense is not looked at.
    """
    match = re.fullmatch(r"([0-9]{1,9})[x×]([0-9]{1,9})", text)
    if match is None:
        raise InputError.at("/size", f"must be WIDTHxHEIGHT in pixels, such as 640x480, not {text!r}")
    return int(match[1]), int(match[2])


def _value(text: str) -> object:
    def refuse(constant: str) -> object:
        raise ValueError(constant)  # NaN and Infinity are no JSON

    try:
        return json.loads(text, parse_constant=refuse)
    except (ValueError, RecursionError):
        return text


def _read(path: Path, pointer: str) -> bytes:
    status = path.stat()
    if not stat.S_ISREG(status.st_mode):  # a pipe or a device might never end
        raise InputError.at(pointer, f"{str(path)!r} is not a file")
    if status.st_size > MAX_BYTES:
        raise InputError.at(pointer, f"the picture has {status.st_size} bytes; at most {MAX_BYTES} are taken")
    with path.open("rb") as stream:
        return stream.read(MAX_BYTES + 1)


def _escaped(part: str) -> str:
    return part.replace("~", "~0").replace("/", "~1")
