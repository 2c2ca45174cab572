"""A scene as a line drawing, in the manner of crystal drawings."""

from crystal_core.scene.wireframe.drawing import wireframe
from crystal_core.scene.wireframe.lens import View

__all__ = ["View", "wireframe"]
