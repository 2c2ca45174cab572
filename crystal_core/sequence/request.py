"""A request for a sequence, checked whole before anything is rendered."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
from pydantic import BaseModel, ConfigDict, Field, SerializeAsAny

import crystal_core
import minerals_db
from crystal_core.errors import Fault, InputError
from crystal_core.scene import stage
from crystal_core.sequence.catalogue import demonstrations
from crystal_core.sequence.demonstration import Parameters

__all__ = ["MAX_FRAMES", "MAX_SIDE", "MIN_SIDE", "RenderRequest", "parse_request"]

MAX_FRAMES = 360
MIN_SIDE, MAX_SIDE = 16, 2048
MAX_SEED = 2**63 - 1

PixelCount = Annotated[int, Field(ge=MIN_SIDE, le=MAX_SIDE, strict=True)]


class _Envelope(BaseModel):
    """The request with its parameters not looked at yet."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    demonstration: str
    parameters: dict[str, Any] = {}
    frames: Annotated[int, Field(ge=1, le=MAX_FRAMES, strict=True)] = 36
    size: tuple[PixelCount, PixelCount] = (512, 512)
    quality: Literal["draft", "standard", "fine"] = "standard"
    seed: Annotated[int, Field(ge=0, le=MAX_SEED, strict=True)] = 0


class RenderRequest(BaseModel):
    """A sequence asked for, every default filled in. Make it with `parse_request`.

    Parameters
    ----------
    demonstration : str
        Name of a demonstration.
    parameters : Parameters
        Of that demonstration.
    frames : int
        Number of frames of a full turn, 1–360.
    size : tuple of int
        Width and height in pixels, each 16–2048.
    quality : str
        "draft", "standard" or "fine".
    seed : int
        Of the random numbers, 0 … 2⁶³ − 1.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    demonstration: str
    parameters: SerializeAsAny[Parameters]
    frames: int
    size: tuple[int, int]
    quality: Literal["draft", "standard", "fine"]
    seed: int

    def canonical(self) -> dict[str, Any]:
        """Return the request as JSON-able values, every default filled in."""
        return self.model_dump(mode="json")

    def digest(self) -> str:
        """Return the sha256 (hex) of the request with the mineral data and the code that answer it."""
        text = json.dumps(
            {"request": self.canonical(), "data": minerals_db.data_digest(), "code": code_digest()},
            sort_keys=True,
            separators=(",", ":"),
        )
        return hashlib.sha256(text.encode()).hexdigest()


def parse_request(obj: Mapping[str, object], assets: Path | None = None) -> RenderRequest:
    """Return the request that `obj` describes, checked so far that only the rendering is left to do.

    Parameters
    ----------
    obj : mapping
        Keys as the fields of `RenderRequest`; only `demonstration` is required.
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
        faults += _faults(error, "")
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
            faults += _faults(error, "/parameters")
            # What else is wrong shows with the faulty values left out.
            faulty = {detail["loc"][0] for detail in error.errors(include_url=False)}
            parameters = model.model_validate({key: value for key, value in raw.items() if key not in faulty})
        try:
            stage(parameters.scene(), assets)
        except InputError as error:
            faults += [_of_parameter(fault, parameters) for fault in error.faults]
    if faults:
        raise InputError(faults)
    assert envelope is not None
    assert parameters is not None
    return RenderRequest(**{**dict(envelope), "parameters": parameters})


@lru_cache(maxsize=1)
def code_digest() -> str:
    """Return the sha256 (hex) of this package's sources and tables: what else a picture depends on."""
    root = Path(crystal_core.__file__).parent
    digest = hashlib.sha256()
    for path in sorted(path for path in root.rglob("*") if path.suffix in {".py", ".csv"}):
        digest.update(path.relative_to(root).as_posix().encode() + b"\0")
        digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def _faults(error: pydantic.ValidationError, prefix: str) -> list[Fault]:
    faults = []
    for detail in error.errors(include_url=False):
        pointer = prefix + "".join(f"/{_escaped(str(part))}" for part in detail["loc"])
        message = "unknown key" if detail["type"] == "extra_forbidden" else detail["msg"]
        faults.append(Fault(pointer, f"{message[0].lower()}{message[1:]}{_shown(detail)}"))
    return faults


def _shown(detail: Any) -> str:
    """Return the offending value, if it is short enough to help."""
    if detail["type"] in {"missing", "extra_forbidden"}:
        return ""
    text = json.dumps(detail["input"], default=str, ensure_ascii=False)
    return f", not {text}" if len(text) <= 60 else ""


def _escaped(part: str) -> str:
    return part.replace("~", "~0").replace("/", "~1")


def _of_parameter(fault: Fault, parameters: Parameters) -> Fault:
    """Return the fault of a scene as one of the parameter that it comes from."""
    for prefix, parameter in parameters.scene_pointers.items():
        if fault.pointer == prefix or fault.pointer.startswith(f"{prefix}/"):
            rest = fault.pointer[len(prefix) :] if prefix.endswith(parameter) or parameter == "marks" else ""
            return Fault(f"/parameters/{parameter}{rest}", fault.message)
    return Fault("/parameters", fault.message)
