"""A scene written down: version 1 of the scene description language.

World frame: right-handed, x right, y away (up on a page), z up. Lengths in mm, angles in degrees, vacuum wavelengths in
nm; units stand in the names.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Annotated, Any, Literal

import yaml
from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from crystal_core.scene.bodies import Body
from crystal_core.scene.cameras import Fitted, ViewCamera
from crystal_core.scene.lights import Light, PointSource, SkyLight
from crystal_core.scene.media import Optics, Surroundings
from crystal_core.scene.motions import Motion
from crystal_core.scene.parts import Location, Name, Part, Text
from crystal_core.scene.references import reference_faults
from crystal_core.scene.settings import RenderSettings
from crystal_core.scene.sheets import Sheet
from crystal_core.scene.surfaces import Surface

__all__ = ["MAX_BODIES", "FileReference", "SceneDocument", "scene_schema"]

MAX_BODIES = 1000

FileReference = tuple[str, str]
"""JSON pointer of the key, and the name of the file."""


def _no_truth(value: object) -> object:
    """Refuse true, which Python takes for 1."""
    if isinstance(value, bool):
        raise PydanticCustomError("scene", "must be 1")
    return value


class SceneDocument(Part):
    """A scene: what is there, who looks at it, and what moves. Make it with `parse_scene` or `read_scene`."""

    isogyre: Annotated[Literal[1], BeforeValidator(_no_truth)] = Field(description="Version of the language")
    title: Text | None = None
    description: Text | None = None
    surroundings: Surroundings = Surroundings(optics=Optics(n=1.0))
    bodies: Annotated[dict[Name, Body], Field(max_length=MAX_BODIES)] = Field(default={})
    surfaces: Annotated[dict[Name, Surface], Field(max_length=100)] = Field(default={})
    sheets: Annotated[dict[Name, Sheet], Field(max_length=50)] = Field(default={})
    lights: Annotated[dict[Name, Light], Field(min_length=1, max_length=50)] = Field(
        default={"lamp": Light(point=PointSource()), "sky": Light(sky=SkyLight())}
    )
    camera: ViewCamera = ViewCamera(fitted=Fitted())
    motion: Motion | None = None
    render: RenderSettings = RenderSettings()

    def after(self) -> Iterator[tuple[Location, str]]:
        """Refuse a scene of nothing, names that stand for two things, and names that stand for none."""
        if not (self.bodies or self.surfaces or self.sheets):
            yield (), "the scene is empty: give it bodies, surfaces or sheets"
        taken: dict[str, str] = {}
        for section in ("bodies", "surfaces", "sheets", "lights"):
            for name in getattr(self, section):
                if name in taken:
                    yield (section, name), f"the name is taken by /{taken[name]}/{name}"
                taken.setdefault(name, section)
        yield from reference_faults(self)

    @property
    def frames(self) -> int:
        """Number of frames."""
        return 1 if self.motion is None else self.motion.frames

    def file_references(self) -> tuple[FileReference, ...]:
        """Return the files and assets that the scene names, with the pointers of their keys."""
        meshes = (
            (f"/bodies/{name}/shape/mesh/file", body.shape.mesh.file)
            for name, body in self.bodies.items()
            if body.shape.mesh is not None
        )
        prints = (
            (f"/surfaces/{name}/print", surface.print)
            for name, surface in self.surfaces.items()
            if surface.print is not None and surface.print != "digits"
        )
        return *meshes, *prints

    def to_mapping(self, full: bool = False) -> dict[str, Any]:
        """Return the scene as JSON-able values in canonical order, without what is default unless `full`."""
        written = self.model_dump(mode="json", exclude_defaults=not full, exclude_none=True)
        tidied: dict[str, Any] = _tidied(written)
        return tidied

    def to_json(self, full: bool = False) -> str:
        """Return the scene as JSON text."""
        return json.dumps(self.to_mapping(full), ensure_ascii=False, indent=2) + "\n"

    def to_yaml(self, full: bool = False) -> str:
        """Return the scene as YAML text."""
        text: str = yaml.safe_dump(
            self.to_mapping(full), sort_keys=False, allow_unicode=True, width=120, default_flow_style=None
        )
        return text


def scene_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of the language."""
    schema = SceneDocument.model_json_schema()
    for described in schema["properties"].values():
        if "patternProperties" in described:  # names that do not match are refused
            described["additionalProperties"] = False
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | schema


def _tidied(value: Any) -> Any:
    """Return whole numbers without the point."""
    if isinstance(value, dict):
        return {key: _tidied(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_tidied(item) for item in value]
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return int(value)
    return value
