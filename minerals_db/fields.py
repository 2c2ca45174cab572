"""The bricks of the schema: what every record and every number of the mineral data has."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

__all__ = ["AngleInterval", "Entry", "Interval", "Key", "Known", "Number", "Positive", "Status", "Text"]

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
"""A finite number. Strict: "1.5" in quotes and `yes` are not numbers."""

Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0.0)]
"""A finite number above zero."""


def _pair(value: object) -> object:
    """Return one number as the interval that holds nothing else."""
    return (value, value) if isinstance(value, int | float) and not isinstance(value, bool) else value


def _rising(pair: tuple[float, float]) -> tuple[float, float]:
    if pair[0] > pair[1]:
        raise ValueError(f"an interval rises, not from {pair[0]:g} to {pair[1]:g}")
    return pair


Interval = Annotated[
    tuple[Positive, Positive],
    BeforeValidator(_pair, json_schema_input_type=Positive | tuple[Positive, Positive]),
    AfterValidator(_rising),
]
"""A published range [lowest, highest]; one number stands for itself."""

_Degrees = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.0, le=180.0)]
AngleInterval = Annotated[
    tuple[_Degrees, _Degrees],
    BeforeValidator(_pair, json_schema_input_type=_Degrees | tuple[_Degrees, _Degrees]),
    AfterValidator(_rising),
]
"""A published range of an angle, degrees, 0 to 180; one number stands for itself."""

Text = Annotated[str, Field(strict=True, min_length=1, max_length=2000)]
"""Some text."""

Key = Annotated[str, Field(strict=True, pattern=r"^[a-z0-9]+(-[a-z0-9]+)*$", max_length=64)]
"""A name for programs: lower-case words joined by hyphens."""

Status = Literal["published", "measured", "fitted", "derived", "estimated", "recalled"]
"""How well a number is known.

published
    read in the source named (of a published range: a value inside it)
measured
    measured by the authors of this database
fitted
    parameters of a fit to data of the source named
derived
    computed from the inputs named in the note
estimated
    chosen by the authors of this database to look right
recalled
    a standard value of textbooks, not checked against a page
"""


class Entry(BaseModel):
    """A record of the mineral data: frozen, no unknown fields."""

    model_config = ConfigDict(frozen=True, extra="forbid", hide_input_in_errors=True, defer_build=True)


class Known(Entry):
    """A record that says where its numbers come from and how well they are known."""

    source: Key = Field(description="Key of the source")
    status: Status = Field(description="How well the numbers are known")
    note: Text | None = Field(None, description="What a user of the numbers should know")
