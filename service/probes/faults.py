"""From what pydantic finds wrong to faults with JSON pointers."""

from __future__ import annotations

import json
from typing import Any

from pydantic import ValidationError

from crystal_core.errors import Fault

__all__ = ["faults_of"]

_PLAIN = {
    "extra_forbidden": "unknown key",
    "missing": "required",
    "tuple_type": "must be a list",
    "list_type": "must be a list",
    "model_type": "must be an object",
    "model_attributes_type": "must be an object",
    "float_type": "must be a number",
    "finite_number": "must be a finite number",
}


def faults_of(error: ValidationError) -> list[Fault]:
    """Return a fault for each wrong place, in the order of the model's fields."""
    faults = [_fault(detail) for detail in error.errors(include_url=False)]
    # Of a list with a faulty item pydantic also says that it has one item less.
    return [fault for fault in faults if not any(other.pointer.startswith(f"{fault.pointer}/") for other in faults)]


def _fault(detail: Any) -> Fault:
    pointer = "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in detail["loc"])
    message = _PLAIN.get(detail["type"], detail["msg"])
    if detail["type"] == "too_long":
        message = f"must have at most {detail['ctx']['max_length']} items, not {detail['ctx']['actual_length']}"
    elif detail["type"] == "too_short":
        message = f"must have at least {detail['ctx']['min_length']} items, not {detail['ctx']['actual_length']}"
    return Fault(pointer, f"{message[0].lower()}{message[1:]}{_shown(detail)}")


def _shown(detail: Any) -> str:
    """Return the offending value, if it is short enough to help and the message does not tell of it."""
    if detail["type"] in {"missing", "extra_forbidden", "too_long", "too_short", "description"}:
        return ""
    try:
        text = json.dumps(detail["input"], default=str, ensure_ascii=False)
    except (ValueError, RecursionError):  # an integer of thousands of digits
        return ""
    return f", not {text}" if len(text) <= 60 else ""
