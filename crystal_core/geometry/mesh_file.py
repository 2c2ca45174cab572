"""Bodies from files of one's own: OBJ, PLY, STL, glTF."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from crystal_core.errors import InputError
from crystal_core.geometry.convex_mesh import as_polyhedron
from crystal_core.geometry.crossing_edges import crossing_place
from crystal_core.geometry.habit import check_size
from crystal_core.geometry.mesh import Mesh
from crystal_core.geometry.mesh_contents import mesh_triangles
from crystal_core.geometry.planar_faces import planar_faces
from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.solid import Solid
from crystal_core.geometry.surface import Surface, closed_surface

__all__ = ["LoadedMesh", "load_mesh"]

Real = NDArray[np.float64]

_SMALLEST_MM, _LARGEST_MM = 1e-3, 1e4


@dataclass(frozen=True)
class LoadedMesh:
    """A body from a file.

    Parameters
    ----------
    solid : Solid
        Faces ``face 1`` …, by falling area. A convex body of at most `convex_mesh.MOST_PLANES` faces is a
        `ConvexPolyhedron` with exact planes, any other a `Mesh`.
    notes : tuple of str
        What was mended or left out, a sentence each.
    """

    solid: Solid[ConvexPolyhedron] | Solid[Mesh]
    notes: tuple[str, ...]


def load_mesh(data: bytes, suffix: str, size_mm: float | None = None, *, pointer: str = "") -> LoadedMesh:
    """Return the body of a file, along the file's axes, its centre of mass at the origin.

    Parameters
    ----------
    data : bytes
        The file. Only these bytes are read, whatever other files or addresses they name.
    suffix : str
        ``.obj``, ``.ply``, ``.stl``, ``.glb`` or ``.gltf``.
    size_mm : float, optional
        Greatest distance between two corners; without it the file's numbers are mm.
    pointer : str
        Where ``{"file", "size_mm"}`` stands in the input.

    Raises
    ------
    InputError
        At the pointer: what `mesh_contents` cannot read, what `surface` refuses, a surface that passes through itself,
        a body of no sensible size. At ``/size_mm``: not a length.

    Notes
    -----
    Triangles whose corners lie in a plane within `planar_faces.FLAT` of the body's extent are one face. The surface is
    what the file has, flat triangles: normals for shading are not read.
    """
    if size_mm is not None:
        check_size(size_mm, f"{pointer}/size_mm")
    vertices, triangles, left_out = mesh_triangles(data, suffix, pointer=pointer)
    surface = closed_surface(vertices, triangles, pointer=pointer)
    diameter = _diameter(surface.vertices)
    if size_mm is None and not _SMALLEST_MM <= diameter <= _LARGEST_MM:
        raise InputError.at(
            pointer, f"the mesh is {diameter:.3g} mm across if its numbers are mm; say size_mm if they are not"
        )
    scale = 1.0 if size_mm is None else size_mm / diameter
    scaled = Surface(scale * (surface.vertices - _centroid(surface)), surface.triangles, surface.notes)
    solid = _solid(scaled, 1.0 / scale, _centroid(surface), pointer)
    return LoadedMesh(solid, left_out + surface.notes)


def _solid(surface: Surface, scale: float, shift: Real, pointer: str) -> Solid[ConvexPolyhedron] | Solid[Mesh]:
    """Return the solid of a surface; scale and shift lead back to the file's numbers, for messages."""
    faces = planar_faces(surface)
    labels = tuple(f"face {number + 1}" for number in range(len(faces.normals)))
    hkl = (None,) * len(labels)
    if faces.folded:
        raise InputError.at(
            pointer,
            "the surface of the mesh folds back on itself: if it has polygons that are not convex, triangulate them",
        )
    polyhedron = as_polyhedron(surface, faces)
    if polyhedron is not None:
        return Solid(polyhedron, labels, hkl)
    try:
        place = crossing_place(surface)
    except OverflowError as error:
        raise InputError.at(pointer, "too many triangles of the mesh lie over each other") from error
    if place is not None:
        told = "({:.4g}, {:.4g}, {:.4g})".format(*(place * scale + shift + 0.0))
        raise InputError.at(pointer, f"the surface of the mesh passes through itself, for instance near {told}")
    corners, owners = surface.triangles.astype(np.int32), faces.owners.astype(np.int32)
    return Solid(Mesh(surface.vertices, corners, owners, faces.normals, faces.offsets), labels, hkl)


def _centroid(surface: Surface) -> Real:
    """Return the centre of mass of what a surface encloses, shape (3,)."""
    middle = surface.vertices.mean(axis=0)
    a, b, c = (surface.vertices[surface.triangles[:, i]] - middle for i in range(3))
    parts = np.sum(a * np.cross(b, c), axis=1)
    return np.asarray(middle + np.sum(parts[:, None] * (a + b + c), axis=0) / (4.0 * parts.sum()))


def _diameter(vertices: Real) -> float:
    """Return the greatest distance between two of many points, shape (V, 3)."""
    from_centre = np.linalg.norm(vertices - 0.5 * (vertices.min(axis=0) + vertices.max(axis=0)), axis=1)
    outermost = int(from_centre.argmax())
    least = float(np.linalg.norm(vertices - vertices[outermost], axis=1).max())
    # No point is farther from another than both are from the centre together.
    outer = vertices[from_centre + from_centre[outermost] >= least]
    return max(float(cdist(outer[start : start + 500], outer).max()) for start in range(0, len(outer), 500))
