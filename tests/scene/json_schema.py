"""A small validator of JSON Schema (draft 2020-12): the keywords that our schemas use, and no other is let through."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import Any

ANNOTATIONS = {"title", "description", "default", "examples", "$schema", "$defs", "$ref", "$comment"}
TYPES: dict[str, Callable[[Any], bool]] = {
    "object": lambda v: isinstance(v, dict),
    "array": lambda v: isinstance(v, list),
    "string": lambda v: isinstance(v, str),
    "number": lambda v: isinstance(v, int | float) and not isinstance(v, bool),
    "integer": lambda v: (isinstance(v, int) and not isinstance(v, bool)) or (isinstance(v, float) and v.is_integer()),
    "boolean": lambda v: isinstance(v, bool),
    "null": lambda v: v is None,
}


def is_number(value: Any) -> bool:
    return TYPES["number"](value)


def check_schema(schema: Any, root: Any) -> None:
    """Check that a schema is one: known keywords of the right kinds, references that lead to schemas."""
    if isinstance(schema, bool):
        return
    assert isinstance(schema, dict), schema
    for key, value in schema.items():
        if key in {"properties", "$defs", "patternProperties"}:
            assert isinstance(value, dict)
            for part in value.values():
                check_schema(part, root)
        elif key in {"anyOf", "oneOf", "allOf", "prefixItems"}:
            assert isinstance(value, list)
            assert value
            for part in value:
                check_schema(part, root)
        elif key in {"not", "items", "additionalProperties", "propertyNames"}:
            check_schema(value, root)
        elif key == "type":
            assert set([value] if isinstance(value, str) else value) <= set(TYPES)
        elif key in {"enum", "required"}:
            assert isinstance(value, list)
        elif key in {"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "multipleOf"}:
            assert is_number(value)
        elif key in {"minItems", "maxItems", "minLength", "maxLength", "minProperties", "maxProperties"}:
            assert isinstance(value, int)
        elif key == "pattern":
            re.compile(value)
        elif key == "$ref":
            assert resolve(value, root) is not None
        else:
            assert key in ANNOTATIONS or key == "const", f"unknown keyword {key}"


def resolve(reference: str, root: Any) -> Any:
    assert reference.startswith("#/")
    for step in reference[2:].split("/"):
        root = root[step]
    return root


def accepts(schema: Any, value: Any, root: Any) -> bool:
    """Tell whether a schema accepts a value."""
    if isinstance(schema, bool):
        return schema
    if "$ref" in schema and not accepts(resolve(schema["$ref"], root), value, root):
        return False
    return all(_about_any(schema, value, root)) and all(_about_kind(schema, value, root))


def _about_any(schema: Any, value: Any, root: Any) -> Iterator[bool]:
    if "type" in schema:
        kinds = schema["type"]
        yield any(TYPES[kind](value) for kind in ([kinds] if isinstance(kinds, str) else kinds))
    if "enum" in schema:
        yield value in schema["enum"]
    if "const" in schema:
        yield value == schema["const"] and isinstance(value, bool) == isinstance(schema["const"], bool)
    if "anyOf" in schema:
        yield any(accepts(part, value, root) for part in schema["anyOf"])
    if "oneOf" in schema:
        yield sum(accepts(part, value, root) for part in schema["oneOf"]) == 1
    if "allOf" in schema:
        yield all(accepts(part, value, root) for part in schema["allOf"])
    if "not" in schema:
        yield not accepts(schema["not"], value, root)


def _about_kind(schema: Any, value: Any, root: Any) -> Iterator[bool]:
    if isinstance(value, dict):
        yield set(schema.get("required", ())) <= set(value)
        yield schema.get("minProperties", 0) <= len(value) <= schema.get("maxProperties", math.inf)
        for key, item in value.items():
            yield accepts(schema.get("propertyNames", True), key, root)
            rest = schema.get("additionalProperties", True)
            patterns = [part for p, part in schema.get("patternProperties", {}).items() if re.search(p, key)]
            if key in schema.get("properties", {}):
                yield accepts(schema["properties"][key], item, root)
            elif not patterns:
                yield accepts(rest, item, root)
            yield from (accepts(part, item, root) for part in patterns)
    elif isinstance(value, list):
        yield schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", math.inf)
        first = schema.get("prefixItems", [])
        yield from (accepts(part, item, root) for part, item in zip(first, value, strict=False))
        yield from (accepts(schema.get("items", True), item, root) for item in value[len(first) :])
    elif isinstance(value, str):
        yield schema.get("minLength", 0) <= len(value) <= schema.get("maxLength", math.inf)
        yield re.search(schema.get("pattern", ""), value) is not None
    elif is_number(value):
        yield schema.get("minimum", -math.inf) <= value <= schema.get("maximum", math.inf)
        yield schema.get("exclusiveMinimum", -math.inf) < value < schema.get("exclusiveMaximum", math.inf)
        yield "multipleOf" not in schema or value % schema["multipleOf"] == 0
