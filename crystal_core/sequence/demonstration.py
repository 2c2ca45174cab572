"""What a demonstration is: a named, parameterised scene with a motion."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from pydantic import BaseModel, ConfigDict

from crystal_core.scene import SceneDocument, StagedScene

__all__ = ["Demonstration", "Parameters"]


class Parameters(BaseModel, ABC):
    """The parameters of a demonstration: immutable, with defaults, unknown keys are errors.

    The JSON Schema of a subclass is all that a user interface needs to build its controls: every property has a title,
    a description, a default, limits, and under ``x-label``, ``x-unit`` and ``x-group`` what people read. A property
    with ``x-choices: minerals`` takes the id of a mineral, of one of its ``x-optical-classes`` where it has them.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    scene_pointers: ClassVar[Mapping[str, str]]
    """Where a fault of the scene, by its JSON pointer, comes from: the name of a parameter."""

    @abstractmethod
    def document(self, frames: int = 1) -> SceneDocument:
        """Return the scene in the scene language, with the motion of as many frames.

        Raises
        ------
        InputError
            The parameters make no scene; the pointers are those of the scene.
        """

    @abstractmethod
    def angle_deg(self, index: int, frames: int) -> float:
        """Return the stage angle of a frame."""

    @abstractmethod
    def facts(self, staged: StagedScene) -> dict[str, Any]:
        """Return what repeats the geometry by hand, for the manifest."""


@dataclass(frozen=True)
class Demonstration:
    """A demonstration.

    Parameters
    ----------
    name : str
        As in requests and on the command line.
    title, summary : mapping
        By language: "en", "ru".
    Parameters : type
        The model of its parameters.
    """

    name: str
    title: Mapping[str, str]
    summary: Mapping[str, str]
    Parameters: type[Parameters]
