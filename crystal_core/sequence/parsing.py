"""Requests of either kind from JSON-able values."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from crystal_core.errors import Fault, InputError
from crystal_core.sequence.demonstration_request import read_demonstration
from crystal_core.sequence.request import RenderRequest
from crystal_core.sequence.scene_request import read_scene_request

__all__ = ["parse_request", "read_request"]


def parse_request(obj: Mapping[str, object], assets: Path | None = None) -> RenderRequest:
    """Return the request that `obj` describes, checked so far that only the rendering is left to do.

    Parameters
    ----------
    obj : mapping
        ``demonstration`` (its name) or ``scene`` (a scene of the description language) says what is shown;
        ``parameters`` go with the first. ``frames``, ``size``, ``quality`` and ``seed`` go with either.
    assets : Path, optional
        Folder of files that may be named as ``asset:<sha256>``.

    Raises
    ------
    InputError
        One fault for every wrong place, each with its JSON pointer into `obj`.
    NotSupportedError
        A sound scene that the renderer cannot draw.
    """
    return _read(obj, staging=True, assets=assets)


def read_request(obj: Mapping[str, object]) -> RenderRequest:
    """Return a request that `parse_request` has taken before: nothing is staged, and no asset is looked at.

    Raises
    ------
    InputError
        `obj` is no request of this version.
    """
    return _read(obj, staging=False, assets=None)


def _read(obj: Mapping[str, object], *, staging: bool, assets: Path | None) -> RenderRequest:
    if "scene" not in obj:
        return read_demonstration(obj, staging=staging, assets=assets)
    extra = [key for key in ("demonstration", "parameters") if key in obj]
    if extra:
        raise InputError(Fault(f"/{key}", "does not go with scene") for key in extra)
    return read_scene_request(obj, staging=staging, assets=assets)
