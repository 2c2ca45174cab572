"""Shapes with exact planar faces, and which face a ray meets first."""

from crystal_core.geometry.polyhedron import ConvexPolyhedron
from crystal_core.geometry.visibility import FaceFinder, face_finder

__all__ = ["ConvexPolyhedron", "FaceFinder", "face_finder"]
