"""Finding minerals: what may be asked for, and which entries answer to it.

    >>> from minerals_db import minerals
    >>> from minerals_db.query import Query, find
    >>> [mineral.id for mineral in find(minerals(), Query(optical_class="uniaxial", birefringence_min=0.1))]

Every condition narrows the answer; a query without any finds everything.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Annotated, Literal, get_args

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationInfo, field_validator
from pydantic_core import PydanticCustomError

from minerals_db.chemistry import ELEMENTS, elements_of, plain_formula
from minerals_db.facts import Facts, facts
from minerals_db.groups import GROUPS
from minerals_db.properties import Colour, PleochroismStrength
from minerals_db.quality import ColourQuality, DispersionQuality, colour_quality, dispersion_quality
from minerals_db.schema import Mineral
from minerals_db.symmetry import CrystalSystem, OpticalClass

__all__ = ["SORT_KEYS", "Query", "find"]

STRENGTHS: tuple[PleochroismStrength, ...] = get_args(PleochroismStrength)
"""Of pleochroism, rising."""

Kind = Literal["mineral", "variety", "synthetic", "glass"]
Quality = Literal["published", "fallback", "measured", "estimated", "none"]
SORT_KEYS = ("id", "name", "name-ru", "index", "birefringence", "density", "2v", "hardness")
"""What an answer can be ordered by; backwards with a "-" before it."""


def _lower(value: object) -> object:
    return value.strip().lower() if isinstance(value, str) else value


def _parts(value: object) -> object:
    """Return a text with commas as its parts."""
    return tuple(part.strip() for part in value.split(",")) if isinstance(value, str) else value


def _lower_parts(value: object) -> object:
    parts = _parts(value)
    return tuple(map(_lower, parts)) if isinstance(parts, tuple) else value


def _refusal(reason: str) -> PydanticCustomError:
    """Return the error of a value, in words that need no preface."""
    return PydanticCustomError("description", "{reason}", {"reason": reason})


def _symbol(text: str) -> str:
    symbol = text.capitalize() if text.islower() else text
    if symbol not in ELEMENTS:
        raise _refusal(f"{text!r} is no element; give symbols such as Ca, C")
    return symbol


def _sort_key(text: str) -> str:
    if text.removeprefix("-") not in SORT_KEYS:
        raise _refusal(f"{text!r} is no order; those are {', '.join(SORT_KEYS)}, backwards with a '-' before it")
    return text


Word = Annotated[str, Field(min_length=1, max_length=200)]
Index = Annotated[float, Field(ge=1.0, le=10.0, allow_inf_nan=False)]
Difference = Annotated[float, Field(ge=0.0, le=10.0, allow_inf_nan=False)]
_Lower = BeforeValidator(_lower)


class Query(BaseModel):
    """Which minerals are wanted, and in what order.

    Texts are compared without regard to case, and ё is е. Facts are those at the D line, 589.3 nm.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: Word | None = Field(
        default=None,
        description="Part of an English or Russian name, of the id, of the group's name, or of a name of the mineral "
        "that a variety belongs to",
    )
    formula: Word | None = Field(
        default=None, description="Part of the formula as it is written, such as CO3; in small letters any case will do"
    )
    elements: Annotated[tuple[Annotated[str, AfterValidator(_symbol)], ...], BeforeValidator(_parts)] = Field(
        default=(),
        max_length=20,
        description="Elements that the formula must hold, all of them: symbols with commas between",
    )
    group: Word | None = Field(default=None, description="The family: its key or its name in English or Russian, whole")
    system: Annotated[CrystalSystem, _Lower] | None = Field(default=None, description="Crystal system")
    optical_class: Annotated[OpticalClass, _Lower] | None = Field(default=None, description="Shape of the indicatrix")
    optic_sign: Annotated[Literal["positive", "negative"], _Lower] | None = Field(
        default=None, description="Optic sign"
    )
    n_min: Index | None = Field(default=None, description="At least one principal index lies from here …")
    n_max: Index | None = Field(default=None, description="… to here (the same one)")
    birefringence_min: Difference | None = Field(default=None, description="Least birefringence")
    birefringence_max: Difference | None = Field(default=None, description="Largest birefringence")
    colour: Annotated[Colour, _Lower] | None = Field(default=None, description="A colour that the mineral commonly has")
    pleochroism: Annotated[PleochroismStrength, _Lower] | None = Field(
        default=None, description="At least so strong; none: those known to have none, and the isotropic ones"
    )
    quality: Annotated[tuple[Quality, ...], BeforeValidator(_lower_parts)] = Field(
        default=(),
        max_length=2,
        description="How good the data are. Dispersion: published or fallback; colour: measured, estimated or none; "
        "one of each with a comma between",
    )
    kind: Annotated[Kind, _Lower] | None = Field(
        default=None, description="What it is; a variety is no mineral of its own"
    )
    origin: Annotated[Literal["built-in", "own"], _Lower] | None = Field(
        default=None, description="Of the package, or of the user's own folder"
    )
    sort: Annotated[tuple[Annotated[str, AfterValidator(_sort_key)], ...], BeforeValidator(_lower_parts)] = Field(
        default=("id",),
        min_length=1,
        max_length=len(SORT_KEYS),
        description=f"Order: {', '.join(SORT_KEYS)}; backwards with a '-' before it; several with commas between. "
        "index is the mean index. What is not known comes last, equals in the order of their ids",
    )

    @field_validator("name", "formula", "group")
    @classmethod
    def _says_something(cls, text: str | None) -> str | None:
        if text is not None and not text.strip():
            raise _refusal("must not be blank")
        return text

    @field_validator("n_max", "birefringence_max")
    @classmethod
    def _is_a_range(cls, most: float | None, info: ValidationInfo) -> float | None:
        least = info.data.get(str(info.field_name).replace("_max", "_min"))
        if most is not None and least is not None and most < least:
            raise _refusal(f"must not be less than {str(info.field_name).replace('_max', '_min')}, {least:g}")
        return most

    @field_validator("quality")
    @classmethod
    def _one_of_each(cls, quality: tuple[Quality, ...]) -> tuple[Quality, ...]:
        for kind in (DispersionQuality, ColourQuality):
            if len(set(quality) & set(get_args(kind))) > 1:
                raise _refusal(f"only one of {', '.join(get_args(kind))} can be true of a mineral")
        return quality


def find(minerals: Mapping[str, Mineral], query: Query) -> tuple[Mineral, ...]:
    """Return the minerals that a query finds, in its order.

    Parameters
    ----------
    minerals : mapping of str to Mineral
        What to look through, by id; a variety is found by the names of its mineral if that is among them.
    query : Query
        What is wanted.
    """
    known = [(mineral, facts(mineral)) for _, mineral in sorted(minerals.items())]
    tests = tuple(_tests(minerals, query))
    found = [(mineral, numbers) for mineral, numbers in known if all(test(mineral, numbers) for test in tests)]
    for key in reversed(
        query.sort
    ):  # sorting is stable: the first key has the last word, the id decides between equals
        found = _sorted(found, _ORDERS[key.removeprefix("-")], key.startswith("-"))
    return tuple(mineral for mineral, _ in found)


_Test = Callable[[Mineral, Facts], bool]


def _tests(minerals: Mapping[str, Mineral], query: Query) -> Iterator[_Test]:
    """Yield a test for each condition of a query."""
    if query.name is not None:
        wanted = _plain(query.name)
        yield lambda mineral, _: any(wanted in _plain(name) for name in _names(minerals, mineral))
    if query.formula is not None:
        part = plain_formula(query.formula)
        small = part.lower() if part == part.lower() else None
        yield (
            lambda mineral, _: (
                part in plain_formula(mineral.formula)
                if small is None
                else small in plain_formula(mineral.formula).lower()
            )
        )
    if query.elements:
        yield lambda mineral, _: elements_of(mineral.formula).issuperset(query.elements)
    if query.group is not None:
        group = _plain(query.group)
        yield lambda mineral, _: group in map(_plain, _group_names(mineral))
    for field in ("system", "optical_class", "optic_sign", "origin"):
        if (value := getattr(query, field)) is not None:
            yield _has(field, value)
    if query.n_min is not None or query.n_max is not None:
        yield lambda _, numbers: any(_within(n, query.n_min, query.n_max) for n in numbers.indices.values())
    if query.birefringence_min is not None or query.birefringence_max is not None:
        yield (
            lambda _, numbers: (
                numbers.birefringence is not None
                and _within(numbers.birefringence, query.birefringence_min, query.birefringence_max)
            )
        )
    if query.colour is not None:
        yield lambda mineral, _: mineral.appearance is not None and query.colour in mineral.appearance.colours
    if query.pleochroism is not None:
        yield lambda mineral, _: _is_pleochroic(mineral, query.pleochroism)
    if query.quality:
        yield lambda mineral, _: {dispersion_quality(mineral), colour_quality(mineral)}.issuperset(query.quality)
    if query.kind is not None:
        yield lambda mineral, _: _is_kind(mineral, query.kind)


def _has(field: str, value: object) -> _Test:
    return lambda mineral, _: getattr(mineral, field) == value


def _names(minerals: Mapping[str, Mineral], mineral: Mineral) -> Iterator[str]:
    """Yield everything that a mineral is called or counted among."""
    yield from (mineral.id, mineral.names.en, mineral.names.ru, *_group_names(mineral))
    if mineral.variety_of is not None:
        yield mineral.variety_of
        if (parent := minerals.get(mineral.variety_of)) is not None:
            yield from (parent.names.en, parent.names.ru)


def _group_names(mineral: Mineral) -> Iterator[str]:
    if mineral.group is not None:
        yield mineral.group
        if (names := GROUPS.get(mineral.group)) is not None:
            yield from (names.en, names.ru)


def _plain(text: str) -> str:
    """Return a text as it is compared: composed letters, no case, е for ё, single blanks for blanks and hyphens."""
    folded = unicodedata.normalize("NFKC", text).casefold().replace("ё", "е")
    return " ".join(folded.replace("-", " ").split())


def _within(value: float, least: float | None, most: float | None) -> bool:
    return (least is None or value >= least) and (most is None or value <= most)


def _is_pleochroic(mineral: Mineral, at_least: PleochroismStrength | None) -> bool:
    known = mineral.pleochroism.strength if mineral.pleochroism is not None else None
    if mineral.optical_class == "isotropic":
        known = "none"
    if known is None or at_least is None:
        return False
    if at_least == "none":
        return known == "none"
    return STRENGTHS.index(known) >= STRENGTHS.index(at_least)


def _is_kind(mineral: Mineral, kind: Kind | None) -> bool:
    if kind == "variety":
        return mineral.is_variety
    return mineral.kind == kind and not (kind == "mineral" and mineral.is_variety)


_Order = Callable[[Mineral, Facts], str | float | None]


def _middle(interval: tuple[float, float] | None) -> float | None:
    return None if interval is None else (interval[0] + interval[1]) / 2.0


_ORDERS: Mapping[str, _Order] = {
    "id": lambda mineral, _: mineral.id,
    "name": lambda mineral, _: _plain(mineral.names.en),
    "name-ru": lambda mineral, _: _plain(mineral.names.ru),
    "index": lambda _, numbers: numbers.mean_index,
    "birefringence": lambda _, numbers: numbers.birefringence,
    "density": lambda _, numbers: _middle(numbers.density_g_per_cm3),
    "2v": lambda _, numbers: numbers.two_v_deg,
    "hardness": lambda _, numbers: _middle(numbers.hardness_mohs),
}


def _sorted(found: Iterable[tuple[Mineral, Facts]], order: _Order, descending: bool) -> list[tuple[Mineral, Facts]]:
    """Return them in an order that leaves equals as they stand, those without the value at the end."""
    ranked = [(order(*pair), pair) for pair in found]
    known = [(value, pair) for value, pair in ranked if value is not None]
    known.sort(key=lambda item: item[0], reverse=descending)
    return [pair for _, pair in known] + [pair for value, pair in ranked if value is None]
