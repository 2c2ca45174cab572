"""A request for the sequence of a demonstration."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
from pydantic import BaseModel, ConfigDict, Field, SerializeAsAny

from crystal_core.errors import Fault, InputError, NotSupportedError
from crystal_core.scene import SceneFiles, StagedDocument, StagedScene, drawable, stage_scene
from crystal_core.sequence.catalogue import demonstrations
from crystal_core.sequence.demonstration import Parameters
from crystal_core.sequence.request import MAX_FRAMES, MAX_SEED, MAX_SIDE, MIN_SIDE, RenderRequest, faults_of

__all__ = ["DemonstrationRequest", "read_demonstration"]

PixelCount = Annotated[int, Field(ge=MIN_SIDE, le=MAX_SIDE, strict=True)]

_PLAIN = {"texture": "digits", "marks": ()}


class _Envelope(BaseModel):
    """The request with its parameters not looked at yet."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    demonstration: str
    parameters: dict[str, Any] = {}
    frames: Annotated[int, Field(ge=1, le=MAX_FRAMES, strict=True)] = 36
    size: tuple[PixelCount, PixelCount] = (512, 512)
    quality: Literal["draft", "standard", "fine"] = "standard"
    seed: Annotated[int, Field(ge=0, le=MAX_SEED, strict=True)] = 0


class DemonstrationRequest(RenderRequest):
    """A demonstration asked for.

    Parameters
    ----------
    demonstration : str
        Its name.
    parameters : Parameters
        Of that demonstration.
    """

    demonstration: str
    parameters: SerializeAsAny[Parameters]

    @property
    def name(self) -> str:
        """The demonstration's name."""
        return self.demonstration

    def angle_deg(self, index: int) -> float:
        """Return the stage angle of a frame, in degrees, counter-clockwise seen from above."""
        return self.parameters.angle_deg(index, self.frames)

    def staged(self, index: int, assets: Path | None) -> StagedScene:
        """Return what a frame shows; see `RenderRequest.staged`."""
        return drawable(_staged(self, assets).at(index))

    def described(self) -> dict[str, Any]:
        """Return what a manifest says of the scene; see `RenderRequest.described`."""
        # The texture's pixels play no part in the facts; an asset may be gone by the time a manifest is asked for.
        document = self.parameters.model_copy(update=_PLAIN).document()
        # The facts are those of stage angle 0, from which the angles of the frames count.
        scene = drawable(stage_scene(document.model_copy(update={"motion": None})))
        camera = document.camera.perspective
        return {
            "demonstration": self.demonstration,
            "parameters": self.canonical()["parameters"],
            "exposure": scene.exposure,
            "camera": None if camera is None else camera.model_dump(mode="json"),
            "scene": self.parameters.facts(scene),
        }


def read_demonstration(obj: Mapping[str, object], *, staging: bool, assets: Path | None = None) -> DemonstrationRequest:
    """Return the request that `obj` describes; see `parse_request`.

    Parameters
    ----------
    obj : mapping
        With the key ``demonstration``.
    staging : bool
        Whether to find out what is wrong with the scene that the parameters make, too.
    assets : Path, optional
        Folder of files that parameters may name as ``asset:<sha256>``.

    Raises
    ------
    InputError
        One fault for every wrong place, each with its JSON pointer into `obj`.
    """
    faults: list[Fault] = []
    envelope: _Envelope | None = None
    try:
        envelope = _Envelope.model_validate(obj)
    except pydantic.ValidationError as error:
        faults += faults_of(error, "")
    name = obj.get("demonstration")
    if isinstance(name, str) and name not in demonstrations():
        known = ", ".join(sorted(demonstrations()))
        faults.append(Fault("/demonstration", f"unknown demonstration {name!r}; known: {known}"))
    raw = obj.get("parameters", {})
    parameters: Parameters | None = None
    if isinstance(name, str) and name in demonstrations() and isinstance(raw, Mapping):
        model = demonstrations()[name].Parameters
        try:
            parameters = model.model_validate(raw)
        except pydantic.ValidationError as error:
            faults += faults_of(error, "/parameters")
            # What else is wrong shows with the faulty values left out.
            faulty = {detail["loc"][0] for detail in error.errors(include_url=False)}
            parameters = model.model_validate({key: value for key, value in raw.items() if key not in faulty})
        if staging:
            faults += _faults_of_scene(parameters, assets)
    if faults:
        raise InputError(faults)
    assert envelope is not None
    assert parameters is not None
    return DemonstrationRequest(**{**dict(envelope), "parameters": parameters})


@lru_cache(maxsize=2)
def _staged(request: DemonstrationRequest, assets: Path | None) -> StagedDocument:
    """Stage what all frames share, once per process."""
    return stage_scene(request.parameters.document(request.frames), SceneFiles(assets=assets))


def _faults_of_scene(parameters: Parameters, assets: Path | None) -> list[Fault]:
    """Return what is wrong with the scene that parameters make, by the parameters that it comes from."""
    try:
        drawable(stage_scene(parameters.document(), SceneFiles(assets=assets)))
    except InputError as error:
        return [_of_parameter(fault, parameters) for fault in error.faults]
    except NotSupportedError as error:
        pointer, _, reason = str(error).partition(": ")
        return [_of_parameter(Fault(pointer, reason), parameters)]
    return []


def _of_parameter(fault: Fault, parameters: Parameters) -> Fault:
    """Return the fault of a scene as one of the parameter that it comes from."""
    for prefix, parameter in parameters.scene_pointers.items():
        if fault.pointer == prefix or fault.pointer.startswith(f"{prefix}/"):
            rest = fault.pointer[len(prefix) :] if prefix.endswith(parameter) or parameter == "marks" else ""
            return Fault(f"/parameters/{parameter}{rest}", fault.message)
    return Fault("/parameters", fault.message)
