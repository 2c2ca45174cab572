"""What the models of the scene language share: strict numbers, directions, choices, and faults in plain words."""

from __future__ import annotations

import difflib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    ModelWrapValidatorHandler,
    ValidationError,
    model_validator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError, core_schema

__all__ = [
    "BRANCH",
    "Angle",
    "Choice",
    "Coordinate",
    "Direction",
    "FileName",
    "Fraction",
    "Length",
    "Location",
    "Name",
    "Number",
    "Part",
    "Point",
    "Positive",
    "Text",
    "Wavelength",
]

Location = tuple[int | str, ...]
"""A place below a model: keys and positions."""

BRANCH = "\x1f"
"""Begins the tags of alternatives, which are no steps of a path."""

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=1e9)]
Fraction = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1)]
Length = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1e-3, le=1e4)]
Coordinate = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1e4, le=1e4)]
Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-3600, le=3600)]
Wavelength = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=360, le=830)]
Point = tuple[Coordinate, Coordinate, Coordinate]
Text = Annotated[str, Field(strict=True, min_length=1, max_length=4000)]
Name = Annotated[str, Field(strict=True, pattern=r"^[A-Za-z][A-Za-z0-9_-]{0,39}$")]
"""Of a body, a surface, a sheet or a light."""

FileName = Annotated[str, Field(strict=True, min_length=1, max_length=500)]
"""`asset:` with the sha256 of a file's bytes, or a path relative to the scene's file."""

_AXES = {
    sign + axis: tuple((-1.0 if sign else 1.0) if axis == other else 0.0 for other in "xyz")
    for axis in "xyz"
    for sign in ("", "-")
}


def _vector(value: object) -> object:
    if isinstance(value, str):
        if value not in _AXES:
            raise PydanticCustomError("scene", "must be x, y, z, -x, -y, -z or three numbers")
        return _AXES[value]
    return value


def _not_zero(vector: Point) -> Point:
    if math.hypot(*vector) < 1e-9:
        raise PydanticCustomError("scene", "must have a length: [0, 0, 0] points nowhere")
    return vector


Direction = Annotated[
    tuple[Coordinate, Coordinate, Coordinate],
    AfterValidator(_not_zero),
    BeforeValidator(_vector, json_schema_input_type=Literal["x", "y", "z", "-x", "-y", "-z"] | Point),
]
"""A direction of any length; axes may be named."""


class Part(BaseModel):
    """Base of the models of the language: immutable, and whatever is not understood is an error.

    All that is wrong with a part is told at once, each fault at its own key.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", hide_input_in_errors=True)

    @classmethod
    def before(cls, raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:  # noqa: ARG003
        """Yield what is wrong with the keys that are given, whatever their values."""
        yield from ()

    def after(self) -> Iterator[tuple[Location, str]]:
        """Yield what is wrong with values that are right by themselves."""
        yield from ()

    @model_validator(mode="wrap")
    @classmethod
    def _told_at_once(cls, value: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        faults: list[tuple[Location, str, Any]] = []
        misfits: list[tuple[Location, str]] = []
        if isinstance(value, Mapping):
            faults += [((key,), cls._unknown(key), None) for key in value if key not in cls.model_fields]
            misfits = list(cls.before(value))
            faults += [(place, reason, None) for place, reason in misfits]
        try:
            part = handler(value)
        except ValidationError as error:
            details = error.errors(include_url=False)
            for detail in details:
                if detail["type"] != "extra_forbidden" and not _follows_from_others(detail, details):
                    too_few = detail["type"] == "missing" and isinstance(detail["loc"][-1], int)
                    place = detail["loc"][:-1] if too_few else detail["loc"]
                    faults.append((place, _plainly(detail), detail["input"]))
        else:
            if not misfits:
                faults += [(place, reason, None) for place, reason in part.after()]
        if faults:
            raise ValidationError.from_exception_data(
                cls.__name__,
                [
                    InitErrorDetails(
                        type=PydanticCustomError("scene", "{reason}", {"reason": reason}), loc=place, input=given
                    )
                    for place, reason, given in faults
                ],
            )
        return part

    @classmethod
    def _unknown(cls, key: object) -> str:
        known = list(cls.model_fields)
        if not isinstance(key, str):
            return f"unknown key {key!r}: keys are text (put it in quotes)"
        stem = key.rsplit("_", 1)[0]  # the unit is missing, or another
        near = [name for name in known if name.startswith(f"{stem}_")] or difflib.get_close_matches(key, known, 1, 0.75)
        return f"unknown key; did you mean {near[0]}?" if near else f"unknown key; the keys are {', '.join(known)}"


class Choice(Part):
    """A part of which exactly one of several keys says what it is."""

    choices: ClassVar[tuple[str, ...]]
    optional_choice: ClassVar[bool] = False

    @classmethod
    def before(cls, raw: Mapping[str, Any]) -> Iterator[tuple[Location, str]]:
        """Refuse none and more than one of the choices."""
        given = [key for key in cls.choices if raw.get(key) is not None]
        if len(given) > 1:
            yield (given[1],), f"does not go with {given[0]}: give one of {', '.join(cls.choices)}"
        elif not given and not cls.optional_choice:
            yield (), f"give one of {', '.join(cls.choices)}"

    @property
    def kind(self) -> str:
        """Which of the keys is given."""
        return next(key for key in self.choices if getattr(self, key) is not None)

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Add the rule of one key to the schema of the keys."""
        described = handler(schema)
        null = {"type": "null"}
        alone = [
            {"required": [key], "properties": {o: {"not": null} if o == key else null for o in cls.choices}}
            for key in cls.choices
        ]
        if cls.optional_choice:
            alone.append({"properties": dict.fromkeys(cls.choices, null)})
        handler.resolve_ref_schema(described)["oneOf"] = alone
        return described


def _follows_from_others(detail: Any, details: Sequence[Any]) -> bool:
    """Tell whether a list or mapping is too short only because items are wrong: pydantic counts the right ones."""
    place = detail["loc"]
    return detail["type"] == "too_short" and any(
        len(other["loc"]) > len(place) and other["loc"][: len(place)] == place for other in details
    )


_PLAIN = {
    "missing": "required",
    "float_type": "must be a number",
    "int_type": "must be a whole number",
    "string_type": "must be text",
    "bool_type": "must be true or false",
    "tuple_type": "must be a list",
    "model_type": "must be a mapping of keys",
    "model_attributes_type": "must be a mapping of keys",
    "dict_type": "must be a mapping of names",
    "finite_number": "must be finite",
}


def _plainly(detail: Any) -> str:
    """Return pydantic's complaint in plain words, with the value where it is short."""
    kind, context = detail["type"], detail.get("ctx") or {}
    if kind == "scene":
        return str(detail["msg"])
    limits = {
        "greater_than": "greater than {gt:g}",
        "greater_than_equal": "at least {ge:g}",
        "less_than": "less than {lt:g}",
        "less_than_equal": "at most {le:g}",
        "literal_error": "{expected}",
    }
    if kind in limits:
        reason = "must be " + limits[kind].format(**context)
    elif kind == "missing" and isinstance(detail["loc"][-1], int):
        return "there are too few values"
    elif kind == "too_long":
        reason = f"has {context['actual_length']} values; at most {context['max_length']} are taken"
    elif kind == "too_short":
        reason = f"needs at least {context['min_length']} values"
    elif kind == "string_pattern_mismatch":
        reason = f"must match {context['pattern']}"
    else:
        reason = _PLAIN.get(kind, detail["msg"][:1].lower() + detail["msg"][1:])
    if kind in {"missing", "too_long", "too_short"}:
        return reason
    shown = json.dumps(detail["input"], default=str, ensure_ascii=False)
    hint = ""
    if kind == "float_type" and isinstance(detail["input"], str):
        hint = " (a number in quotes, or one like 1e3, is text: write 1000 or 1.0e+3)"
    return reason + (f", not {shown}" if len(shown) <= 60 else "") + hint
