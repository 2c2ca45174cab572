"""Cuts and meshes of a scene as solids in their own frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import PurePath
from typing import Any

from crystal_core.errors import InputError
from crystal_core.geometry.boxes import box, plate, wedge
from crystal_core.geometry.brilliant import PROPORTIONS, brilliant
from crystal_core.geometry.cabochon import Cabochon, cabochon
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.mesh_file import load_mesh
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.prisms import column, prism
from crystal_core.geometry.solid import Solid
from crystal_core.geometry.sphere import Sphere, sphere
from crystal_core.geometry.step_cut import StepProportions, step_cut
from crystal_core.scene.contents import file_suffix
from crystal_core.scene.scene_files import SceneFiles
from crystal_core.scene.shapes import MESH_SUFFIXES, Brilliant, Shape, StepCut

__all__ = ["AnySolid", "cut_solid"]

AnySolid = Solid[ConvexPolyhedron] | Solid[Sphere] | Solid[Cabochon] | Solid[Mesh]

MM_PER_UM = 1e-3


def cut_solid(shape: Shape, files: SceneFiles, pointer: str) -> tuple[AnySolid, tuple[str, ...]]:
    """Return the solid of a cut or a mesh, centred on the origin, and what was mended of a mesh.

    Parameters
    ----------
    shape : Shape
        None that a lattice makes.
    files : SceneFiles
        Where its mesh is.
    pointer : str
        Of the shape.

    Raises
    ------
    InputError
        Proportions with which the facets do not meet; a mesh that is not closed.
    """
    at = f"{pointer}/{shape.kind}"
    if shape.mesh is not None:
        data = files.read(shape.mesh.file, f"{at}/file")
        loaded = load_mesh(data, _suffix(shape.mesh.file, data, f"{at}/file"), shape.mesh.size_mm, pointer=at)
        return loaded.solid, loaded.notes
    return _CUTTERS[shape.kind](shape, at), ()


def _suffix(name: str, data: bytes, pointer: str) -> str:
    """Return the suffix that tells a mesh's format: of its name, or what an asset's bytes look like."""
    if not name.startswith("asset:"):
        return PurePath(name).suffix.lower()
    suffix = file_suffix(data)
    if suffix not in MESH_SUFFIXES:
        raise InputError.at(pointer, f"the asset is no mesh: those are {', '.join(MESH_SUFFIXES)}")
    return suffix


def _box(shape: Shape, pointer: str) -> Solid:
    assert shape.box is not None
    return box(shape.box.size_mm, pointer=pointer)


def _plate(shape: Shape, pointer: str) -> Solid:
    assert shape.plate is not None
    return plate(shape.plate.size_mm, MM_PER_UM * shape.plate.thickness_um, pointer=pointer)


def _wedge(shape: Shape, pointer: str) -> Solid:
    assert shape.wedge is not None
    thin, thick = shape.wedge.thickness_um
    return wedge(shape.wedge.size_mm, (MM_PER_UM * thin, MM_PER_UM * thick), pointer=pointer)


def _prism(shape: Shape, pointer: str) -> Solid:
    assert shape.prism is not None
    return prism(shape.prism.apex_deg, shape.prism.side_mm, shape.prism.length_mm, pointer=pointer)


def _column(shape: Shape, pointer: str) -> Solid:
    assert shape.column is not None
    return column(shape.column.sides, shape.column.diameter_mm, shape.column.length_mm, pointer=pointer)


def _sphere(shape: Shape, pointer: str) -> Solid[Sphere]:
    assert shape.sphere is not None
    return sphere(shape.sphere.diameter_mm, pointer=pointer)


def _cabochon(shape: Shape, pointer: str) -> Solid[Cabochon]:
    assert shape.cabochon is not None
    written = shape.cabochon
    return cabochon(written.size_mm, written.height_mm, profile=written.profile, pointer=pointer)


def _brilliant(shape: Shape, pointer: str) -> Solid:
    assert shape.brilliant is not None
    proportions = replace(PROPORTIONS[shape.brilliant.proportions], **_given(shape.brilliant))
    return brilliant(shape.brilliant.diameter_mm, proportions, pointer=pointer)


def _step_cut(shape: Shape, pointer: str) -> Solid:
    assert shape.step_cut is not None
    proportions = replace(StepProportions(), **_given(shape.step_cut))
    return step_cut(shape.step_cut.size_mm, proportions, pointer=pointer)


def _given(cut: Brilliant | StepCut) -> dict[str, Any]:
    """Return the proportions that are given one by one."""
    others = {"diameter_mm", "size_mm", "proportions"}
    return {
        name: value
        for name in type(cut).model_fields
        if name not in others and (value := getattr(cut, name)) is not None
    }


_CUTTERS: dict[str, Callable[[Shape, str], AnySolid]] = {
    "box": _box,
    "plate": _plate,
    "wedge": _wedge,
    "prism": _prism,
    "column": _column,
    "sphere": _sphere,
    "cabochon": _cabochon,
    "brilliant": _brilliant,
    "step_cut": _step_cut,
}
