"""A mineral's entry made into bodies: its lattice and class, habits, cleavage fragments and twins."""

from __future__ import annotations

import difflib
from collections.abc import Sequence

from crystal_core.errors import InputError
from crystal_core.geometry.cleavage import cleavage_closes, cleavage_solid
from crystal_core.geometry.habit import Form, habit_solid
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.point_groups import PointGroup, point_group, setting_of
from crystal_core.geometry.solid import Hkl, Solid
from crystal_core.geometry.twins import ContactTwin, twin
from minerals_db import Habit, Mineral
from minerals_db.morphology import Twin

__all__ = [
    "cleavage_body",
    "habit_of",
    "lattice_of",
    "point_group_of",
    "specimen_solid",
    "specimen_twin",
    "twin_law",
]

_QUALITIES = ("perfect", "good", "distinct")
"""Cleavages that a fragment shows, from the best on; the others are seldom seen."""


def lattice_of(mineral: Mineral, *, pointer: str = "") -> Lattice:
    """Return the lattice of a mineral, in Å.

    Raises
    ------
    InputError
        At the pointer: a glass has none.
    """
    cell = mineral.cell
    if cell is None:
        raise InputError.at(pointer, f"{mineral.id} is a glass: it has no lattice, and no faces of its own")
    return Lattice((cell.a_angstrom, cell.b_angstrom, cell.c_angstrom), (cell.alpha_deg, cell.beta_deg, cell.gamma_deg))


def point_group_of(mineral: Mineral, *, pointer: str = "") -> PointGroup:
    """Return the point group of a mineral as it stands on the axes of its cell.

    Raises
    ------
    InputError
        At the pointer: a glass has none, or the entry's space group does not tell how the group stands.
    """
    if mineral.cell is None or mineral.point_group is None:
        raise InputError.at(pointer, f"{mineral.id} is a glass: it has no lattice, and no faces of its own")
    try:
        return point_group(setting_of(mineral.point_group, mineral.cell.space_group))
    except InputError as error:
        raise InputError.at(pointer, f"{mineral.id}: {error.faults[0].message}") from None


def habit_of(mineral: Mineral, name: str | None = None, *, pointer: str = "") -> Habit:
    """Return a habit of a mineral.

    Parameters
    ----------
    mineral : Mineral
        The entry.
    name : str or None
        The habit's name, whatever the case, with blanks, hyphens or underscores; None: the entry's first.
    pointer : str
        Where the name stands in the input, for errors.

    Raises
    ------
    InputError
        At the pointer: the entry has no habit, or none of this name.
    """
    if not mineral.habits:
        raise InputError.at(pointer, f"no habit of {mineral.id} is known")
    if name is None:
        return mineral.habits[0]
    known = {_plain(habit.name): habit for habit in mineral.habits}
    if _plain(name) in known:
        return known[_plain(name)]
    near = difflib.get_close_matches(_plain(name), known, 1)
    names = ", ".join(habit.name for habit in mineral.habits)
    meant = f"; do you mean {known[near[0]].name}?" if near else ""
    raise InputError.at(pointer, f"{mineral.id} has no habit {name!r}; those known are {names}{meant}")


def specimen_solid(
    mineral: Mineral, habit: str | Sequence[Form] | None = None, size_mm: float = 10.0, *, pointer: str = ""
) -> Solid:
    """Return a crystal of a mineral, in the crystal frame, its centroid at the origin.

    Parameters
    ----------
    mineral : Mineral
        The entry.
    habit : str, sequence of Form, or None
        The name of a habit of the entry, forms of one's own, or the entry's first habit.
    size_mm : float
        The greatest distance between two corners.
    pointer : str
        Where habit and size stand in the input, for errors.

    Raises
    ------
    InputError
        At the pointer: a glass. At ``/name``: no such habit. At ``/forms`` and ``/size_mm``: see `habit_solid`.
    """
    lattice, group = lattice_of(mineral, pointer=pointer), point_group_of(mineral, pointer=pointer)
    return habit_solid(lattice, group, _forms(mineral, habit, pointer), size_mm, pointer=pointer)


def cleavage_body(
    mineral: Mineral, spacing_mm: float | Sequence[float], hkl: Hkl | None = None, *, pointer: str = ""
) -> Solid:
    """Return a fragment of a mineral that its cleavage bounds, in the crystal frame, its centroid at the origin.

    Parameters
    ----------
    mineral : Mineral
        The entry.
    spacing_mm : float or sequence of float
        Between parallel faces, as `cleavage_solid` takes it.
    hkl : tuple of int, or None
        One plane of the cleavage. None: the perfect cleavage that encloses a body by itself, else all the perfect ones
        together; where those leave it open, the good ones are taken too, and then the distinct ones.
    pointer : str
        Where the spacing stands in the input, for errors.

    Raises
    ------
    InputError
        At the pointer: a glass, no cleavage, or none that encloses a body. At ``/spacing_mm``: see `cleavage_solid`.
    """
    lattice, group = lattice_of(mineral, pointer=pointer), point_group_of(mineral, pointer=pointer)
    if hkl is not None:
        return cleavage_solid(lattice, group, (hkl,), spacing_mm, pointer=pointer)
    planes: list[Hkl] = []
    for quality in _QUALITIES:
        planes += [cleavage.hkl for cleavage in mineral.cleavage if cleavage.quality == quality]
        choices = [(plane,) for plane in planes] + [tuple(planes)] * bool(planes)
        for choice in choices:
            if cleavage_closes(lattice, group, choice):
                return cleavage_solid(lattice, group, choice, spacing_mm, pointer=pointer)
    if not planes:
        raise InputError.at(pointer, f"{mineral.id} has no distinct cleavage")
    try:
        return cleavage_solid(lattice, group, planes, spacing_mm, pointer=pointer)
    except InputError as error:
        raise InputError.at(pointer, f"{mineral.id}: {error.faults[0].message}") from None


def twin_law(mineral: Mineral, law: str | None = None, *, pointer: str = "") -> Twin:
    """Return a twin law of a mineral, by its name as `habit_of` takes it; None: the entry's first.

    Raises
    ------
    InputError
        At the pointer: the entry has no law, or none of this name.
    """
    if not mineral.twinning:
        raise InputError.at(pointer, f"no twin law of {mineral.id} is known")
    if law is None:
        return mineral.twinning[0]
    found = [entry for entry in mineral.twinning if _plain(entry.law) == _plain(law)]
    if not found:
        names = ", ".join(entry.law for entry in mineral.twinning)
        raise InputError.at(pointer, f"{mineral.id} has no twin law {law!r}; those known are {names}")
    return found[0]


def specimen_twin(
    mineral: Mineral,
    law: str | None = None,
    habit: str | Sequence[Form] | None = None,
    size_mm: float = 10.0,
    *,
    plane_hkl: Hkl | None = None,
    axis_uvw: Hkl | None = None,
    composition_hkl: Hkl | None = None,
    pointer: str = "",
    shape_pointer: str = "",
) -> ContactTwin:
    """Return a contact twin of a mineral, in the crystal frame of its first individual.

    Parameters
    ----------
    mineral : Mineral
        The entry.
    law : str or None
        The name of a law of the entry; None: its first, unless a plane or an axis is given.
    habit, size_mm
        As `specimen_solid` takes them; the size is that of the pair.
    plane_hkl, axis_uvw : tuple of int, or None
        A law of one's own: a twin plane or a twin axis.
    composition_hkl : tuple of int, or None
        The plane in which the individuals meet, as `twin` takes it.
    pointer, shape_pointer : str
        Where the law, and habit and size stand in the input, for errors.

    Raises
    ------
    InputError, NotSupportedError
        As `twin_law`, `specimen_solid` and `twin` say.
    """
    if plane_hkl is None and axis_uvw is None:
        entry = twin_law(mineral, law, pointer=f"{pointer}/law")
        plane_hkl, axis_uvw = entry.plane_hkl, entry.axis_uvw
    lattice, group = lattice_of(mineral, pointer=shape_pointer), point_group_of(mineral, pointer=shape_pointer)
    return twin(
        lattice,
        group,
        _forms(mineral, habit, shape_pointer),
        size_mm,
        plane_hkl=plane_hkl,
        axis_uvw=axis_uvw,
        composition_hkl=composition_hkl,
        pointer=pointer,
        shape_pointer=shape_pointer,
    )


def _forms(mineral: Mineral, habit: str | Sequence[Form] | None, pointer: str) -> Sequence[Form]:
    if habit is None or isinstance(habit, str):
        known = habit_of(mineral, habit, pointer=f"{pointer}/name")
        return [Form(form.hkl, form.central_distance, form.name) for form in known.forms]
    return habit


def _plain(name: str) -> str:
    return " ".join(name.replace("-", " ").replace("_", " ").casefold().split())
