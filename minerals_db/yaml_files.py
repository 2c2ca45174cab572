"""Reading data files: YAML without its traps, and faults as places in a file."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from typing import Any

import yaml
from pydantic import ValidationError

from minerals_db.errors import DataFault

__all__ = ["faults_of", "parse"]

# libyaml is about eight times as fast; PyYAML without it reads the same.
_BASE: type[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _Loader(_BASE):  # type: ignore[misc]  # the base is chosen at run time
    """A safe YAML loader that refuses a repeated key: YAML would silently keep the last one."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        seen: set[Hashable] = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if not isinstance(key, Hashable):
                continue  # the loader itself refuses it below
            if key in seen:
                raise yaml.constructor.ConstructorError(None, None, f"repeated key {key!r}", key_node.start_mark)
            seen.add(key)
        mapping: dict[Hashable, Any] = super().construct_mapping(node, deep)
        return mapping


def parse(name: str, data: bytes, faults: list[DataFault]) -> dict[Hashable, Any] | None:
    """Return the mapping that a YAML file holds; add a fault and return None where it holds none."""
    try:
        content = yaml.load(data, Loader=_Loader)  # a SafeLoader, as above
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        reason = getattr(error, "problem", None) or str(error)
        mark = getattr(error, "problem_mark", None)
        where = f", line {mark.line + 1}" if mark is not None else ""
        faults.append(DataFault(name, "", f"not YAML: {' '.join(reason.split())}{where}"))
        return None
    if not isinstance(content, dict):
        faults.append(DataFault(name, "", "must hold a mapping of fields"))
        return None
    return content


def faults_of(name: str, content: object, error: ValidationError) -> Iterator[DataFault]:
    """Translate pydantic's list into places of the file and plain words.

    Parameters
    ----------
    name : str
        Name of the file.
    content : object
        What the file holds, as it was validated: it tells the fields from the names of pydantic's alternatives.
    error : ValidationError
        What is wrong with it.
    """
    told = error.errors(include_url=False, include_context=False, include_input=False)
    # Of a list with a wrong item pydantic also says that it has one item less.
    wrong_inside = {fault["loc"][:-1] for fault in told}
    told = [fault for fault in told if not (fault["type"] == "too_short" and fault["loc"] in wrong_inside)]
    absent = [fault["loc"] for fault in told if fault["type"] == "missing"]
    for fault in told:
        reason = {"extra_forbidden": "unknown field", "missing": "missing"}.get(fault["type"], fault["msg"])
        if fault["type"] == "extra_forbidden":
            reason += _meant(fault["loc"], absent)
        place = _place(content, fault["loc"], fault["type"] == "missing")
        yield DataFault(name, place, reason.removeprefix("Value error, "))


def _meant(unknown: Sequence[int | str], absent: Sequence[Sequence[int | str]]) -> str:
    """Name the missing field beside an unknown one of the same quantity: its unit is another."""
    for missing in absent:
        if missing[:-1] == unknown[:-1] and str(missing[-1]).split("_")[0] == str(unknown[-1]).split("_")[0]:
            return f"; the quantity is wanted as {missing[-1]}"
    return ""


def _place(content: object, location: Sequence[int | str], is_missing: bool) -> str:
    """Return the dotted path of a fault without the steps that are no field but one of pydantic's alternatives."""
    path: list[str] = []
    for number, step in enumerate(location):
        last = number == len(location) - 1
        if isinstance(content, dict) and (step in content or (last and is_missing)):
            content = content.get(step)
        elif isinstance(content, list | tuple) and isinstance(step, int):
            content = content[step] if step < len(content) else None
        elif number > 0:
            continue
        path.append(str(step))
    return ".".join(path)
