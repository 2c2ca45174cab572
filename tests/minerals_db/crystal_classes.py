"""Crystal classes as matrices, from the symbol of a space group, and what they make of a face. For tests alone."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.lattice import direct_basis
from minerals_db import Cell, Mineral

__all__ = ["GROUP_ORDERS", "Real", "basis_of", "contains", "faces", "operations"]

Real = NDArray[np.float64]

GROUP_ORDERS = {
    "1": 1, "-1": 2,
    "2": 2, "m": 2, "2/m": 4,
    "222": 4, "mm2": 4, "mmm": 8,
    "4": 4, "-4": 4, "4/m": 8, "422": 8, "4mm": 8, "-42m": 8, "4/mmm": 16,
    "3": 3, "-3": 6, "32": 6, "3m": 6, "-3m": 12,
    "6": 6, "-6": 6, "6/m": 12, "622": 12, "6mm": 12, "-6m2": 12, "6/mmm": 24,
    "23": 12, "m-3": 24, "432": 24, "-43m": 24, "m-3m": 48,
}  # fmt: skip
"""Orders of the 32 classes (International Tables for Crystallography A)."""

DIRECTIONS = {
    "triclinic": ((0, 0, 1),),
    "monoclinic": ((0, 1, 0),),
    "orthorhombic": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "tetragonal": ((0, 0, 1), (1, 0, 0), (1, 1, 0)),
    "trigonal": ((0, 0, 1), (1, 0, 0), (1, -1, 0)),
    "hexagonal": ((0, 0, 1), (1, 0, 0), (1, -1, 0)),
    "cubic": ((0, 0, 1), (1, 1, 1), (1, 1, 0)),
}
"""What the places of a Hermann-Mauguin symbol stand for (International Tables A, table 2.1.3.1)."""


def basis_of(cell: Cell) -> Real:
    """Return the cell vectors as rows, shape (3, 3), Å, in the crystal frame."""
    lengths = (cell.a_angstrom, cell.b_angstrom, cell.c_angstrom)
    return direct_basis(lengths, (cell.alpha_deg, cell.beta_deg, cell.gamma_deg))


def operations(mineral: Mineral) -> Real:
    """Return the matrices of the class in the crystal frame, shape (order, 3, 3), after the symbol of the space group.

    Screw axes and glide planes leave out their translations.
    """
    assert mineral.cell is not None
    basis = basis_of(mineral.cell)
    places = mineral.cell.space_group.split()[1:]
    if mineral.system == "monoclinic" and len(places) == 3:
        assert places[0] == places[2] == "1", "b is the unique axis"
        places = places[1:2]
    group = np.eye(3)[None]
    for place, direction in zip(places, DIRECTIONS[mineral.system], strict=False):
        along = np.asarray(direction) @ basis
        for generator in _generators(place, along / np.linalg.norm(along)):
            group = _distinct(np.concatenate((group, generator[None])))
    while True:
        larger = _distinct(np.array([a @ b for a, b in product(group, group)]))
        if len(larger) == len(group):
            return group
        assert len(larger) <= 48, "no crystal class: the cell is not of this symmetry"
        group = larger


def _generators(place: str, along: Real) -> list[Real]:
    """Return the operations that one place of a symbol, such as 63/m, stands for, about or across a direction."""
    found = []
    for element in place.split("/"):
        if element in "mabcnde":
            found.append(_rotation(along, 2, -1))
        elif element.startswith("-"):
            found.append(_rotation(along, int(element[1:]), -1))
        else:
            found.append(_rotation(along, int(element[0]), 1))  # 63: the screw axis turns like 6
    return found


def _rotation(along: Real, fold: int, sign: int) -> Real:
    """Return a rotation by 360°/fold; with sign −1 followed by the inversion, so that −2 is a mirror."""
    angle = 2.0 * np.pi / fold
    cross = np.cross(np.eye(3), along)
    turn = np.cos(angle) * np.eye(3) - np.sin(angle) * cross + (1.0 - np.cos(angle)) * np.outer(along, along)
    return np.asarray(sign * turn)


def _distinct(matrices: Real) -> Real:
    """Return each matrix once; they differ by far more than rounding."""
    rounded = np.round(matrices, 3) + 0.0
    return np.asarray(matrices[np.unique(rounded.reshape(-1, 9), axis=0, return_index=True)[1]])


def contains(group: Real, matrix: Real) -> bool:
    """Tell whether a matrix is one of the group's; metrics of cells are known to about 1e-4."""
    return bool(np.any(np.abs(group - matrix).max(axis=(1, 2)) < 2e-3))


def mirror(normal: Real) -> Real:
    """Return the reflection in the plane across a unit vector."""
    return np.asarray(np.eye(3) - 2.0 * np.outer(normal, normal))


def half_turn(along: Real) -> Real:
    """Return the rotation by 180° about a unit vector."""
    return -mirror(along)


def faces(group: Real, normal: Real) -> Real:
    """Return the unit normals of all faces of the form of one, shape (N, 3)."""
    normals = group @ normal
    return np.asarray(normals[np.unique(np.round(normals, 6) + 0.0, axis=0, return_index=True)[1]])
