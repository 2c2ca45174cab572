"""The demonstrations that there are, by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from crystal_core.sequence.demonstration import Demonstration
from crystal_core.sequence.rotating_calcite import ROTATING_CALCITE

__all__ = ["demonstrations"]

_ALL = MappingProxyType({demonstration.name: demonstration for demonstration in (ROTATING_CALCITE,)})


def demonstrations() -> Mapping[str, Demonstration]:
    """Return every demonstration by its name."""
    return _ALL
