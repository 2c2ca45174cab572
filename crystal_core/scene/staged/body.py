"""Bodies in the world: their solids, what fills them, and what lies on either side of every face."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.habit import Form
from crystal_core.scene.bodies import Body
from crystal_core.scene.scene_files import SceneFiles
from crystal_core.scene.shapes import Habit
from crystal_core.scene.specimen import cleavage_body, specimen_solid, specimen_twin
from crystal_core.scene.staged.convex import highest
from crystal_core.scene.staged.cutting import AnySolid, cut_solid
from crystal_core.scene.staged.medium import StagedMedium
from crystal_core.scene.staged.stance import crystal_rotation, turned

__all__ = ["NOBODY", "MadeBody", "StagedBody", "made_body"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]

NOBODY = -1
"""Stands for no body where a number of a body is wanted."""


@dataclass(frozen=True)
class MadeBody:
    """A body at its own centre, turned, not yet moved: one individual, or the two of a twin.

    Parameters
    ----------
    solids : tuple of Solid
        In axes parallel to the world's, centred on the origin.
    media : tuple of StagedMedium
        Of each, turned into the world.
    contact : tuple of int or None
        The number of the common face in each individual of a twin.
    notes : tuple of str
        What was mended of a mesh.
    """

    solids: tuple[AnySolid, ...]
    media: tuple[StagedMedium, ...]
    contact: tuple[int, int] | None
    notes: tuple[str, ...] = ()

    def highest(self, direction: Real) -> float:
        """Return how far it reaches in a direction from its centre, mm."""
        return max(highest(solid.body, direction) for solid in self.solids)


@dataclass(frozen=True)
class StagedBody:
    """One crystal, or piece of glass, in the world.

    Parameters
    ----------
    name, pointer : str
        In the scene.
    individual : int
        0, or 1 for the second crystal of a twin.
    solid : Solid
        In the world, mm.
    centre : Real
        Of the body, shape (3,).
    medium : int
        Number of what fills it.
    outside : Index
        Number of the medium on the other side of each face, shape (F,).
    neighbour : Index
        Number of the body that touches each face, `NOBODY` where none does, shape (F,).
    host : int
        Number of the body that it is inside of, `NOBODY` if none.
    """

    name: str
    pointer: str
    individual: int
    solid: AnySolid
    centre: Real
    medium: int
    outside: Index
    neighbour: Index
    host: int

    def moved(self, rotation: Real, shift: Real) -> StagedBody:
        """Return the body with every point x moved to rotation·x + shift."""
        return replace(self, solid=self.solid.transformed(rotation, shift), centre=rotation @ self.centre + shift)


def made_body(body: Body, files: SceneFiles, dispersion: bool, pointer: str) -> MadeBody:
    """Return a body's solids at its centre, turned as its scene says.

    Parameters
    ----------
    body : Body
        As written.
    files : SceneFiles
        Where its mesh is.
    dispersion : bool
        Whether its indices depend on the wavelength.
    pointer : str
        Of the body.

    Raises
    ------
    InputError
        Forms that do not close, a mesh that is none, a direction that the crystal does not have.
    """
    unturned = StagedMedium(body, np.eye(3), dispersion=dispersion)
    stands = crystal_rotation(body.orientation, body, unturned, f"{pointer}/orientation")
    turn = turned(body.turns)
    crystal = turn @ stands
    origin = np.zeros(3)
    if not body.shape.grows:
        solid, notes = cut_solid(body.shape, files, f"{pointer}/shape")
        return MadeBody((solid.transformed(turn, origin),), (replace(unturned, rotation=crystal),), None, notes)
    entry = body.entry
    assert entry is not None
    if body.twin is not None:
        assert body.shape.habit is not None
        pair = specimen_twin(
            entry,
            body.twin.law,
            _forms(body.shape.habit),
            body.shape.habit.size_mm,
            plane_hkl=body.twin.plane_hkl,
            axis_uvw=body.twin.axis_uvw,
            composition_hkl=body.twin.composition_hkl,
            pointer=f"{pointer}/twin",
            shape_pointer=f"{pointer}/shape/habit",
        )
        return MadeBody(
            tuple(one.solid.transformed(crystal, origin) for one in pair.individuals),
            tuple(replace(unturned, rotation=crystal @ one.rotation, hand=one.hand) for one in pair.individuals),
            pair.contact,
        )
    if body.shape.habit is not None:
        habit = body.shape.habit
        solid = specimen_solid(entry, _forms(habit), habit.size_mm, pointer=f"{pointer}/shape/habit")
    else:
        cleavage = body.shape.cleavage
        assert cleavage is not None
        spacing = cleavage.spacing_mm if len(cleavage.spacing_mm) > 1 else cleavage.spacing_mm[0]
        solid = cleavage_body(entry, spacing, cleavage.hkl, pointer=f"{pointer}/shape/cleavage")
    return MadeBody((solid.transformed(crystal, origin),), (replace(unturned, rotation=crystal),), None)


def _forms(habit: Habit) -> str | tuple[Form, ...] | None:
    if habit.forms is None:
        return habit.name
    return tuple(Form(form.hkl, form.central_distance) for form in habit.forms)
