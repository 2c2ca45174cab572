"""The 32 crystallographic point groups as integer matrices on the basis of the lattice, and the forms they make.

Axes: hexagonal ones for the trigonal and hexagonal groups, b unique for the monoclinic. Where a group can stand in more
than one way on the same axes, each way has a symbol of its own: 321 and 312, −42m and −4m2. The symbol of a space group
tells which it is.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.solid import Hkl

__all__ = ["GENERATORS", "PointGroup", "point_group", "setting_of"]

Whole = NDArray[np.int64]
Real = NDArray[np.float64]

_ROTATIONS: Mapping[str, tuple[tuple[int, int, int], ...]] = MappingProxyType(
    {
        "1": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        # Axes of which each is at right angles to the others, or b to a and c.
        "2 [100]": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
        "2 [010]": ((-1, 0, 0), (0, 1, 0), (0, 0, -1)),
        "2 [001]": ((-1, 0, 0), (0, -1, 0), (0, 0, 1)),
        "4 [001]": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
        "3 [111]": ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
        # The same matrices on square and hexagonal axes.
        "2 [110]": ((0, 1, 0), (1, 0, 0), (0, 0, -1)),
        "2 [1-10]": ((0, -1, 0), (-1, 0, 0), (0, 0, -1)),
        # Hexagonal axes.
        "3 [001]": ((0, -1, 0), (1, -1, 0), (0, 0, 1)),
        "6 [001]": ((1, -1, 0), (1, 0, 0), (0, 0, 1)),
    }
)
"""Rotations (International Tables for Crystallography A, tables 1.2.2.1 and 1.2.2.2): columns of coordinates x, y, z on
a, b, c become W·(x, y, z)."""

GENERATORS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "1": (),
        "-1": ("-1",),
        "2": ("2 [010]",),
        "m": ("-2 [010]",),
        "2/m": ("2 [010]", "-1"),
        "222": ("2 [001]", "2 [010]"),
        "mm2": ("2 [001]", "-2 [100]"),
        "m2m": ("2 [010]", "-2 [100]"),
        "2mm": ("2 [100]", "-2 [010]"),
        "mmm": ("2 [001]", "2 [010]", "-1"),
        "4": ("4 [001]",),
        "-4": ("-4 [001]",),
        "4/m": ("4 [001]", "-1"),
        "422": ("4 [001]", "2 [100]"),
        "4mm": ("4 [001]", "-2 [100]"),
        "-42m": ("-4 [001]", "2 [100]"),
        "-4m2": ("-4 [001]", "2 [110]"),
        "4/mmm": ("4 [001]", "2 [100]", "-1"),
        "3": ("3 [001]",),
        "-3": ("-3 [001]",),
        # [110] is one of the axes a1, a2, −(a1 + a2) of the second place of the symbol, [1-10] one between them.
        "321": ("3 [001]", "2 [110]"),
        "312": ("3 [001]", "2 [1-10]"),
        "3m1": ("3 [001]", "-2 [110]"),
        "31m": ("3 [001]", "-2 [1-10]"),
        "-3m1": ("-3 [001]", "2 [110]"),
        "-31m": ("-3 [001]", "2 [1-10]"),
        "6": ("6 [001]",),
        "-6": ("-6 [001]",),
        "6/m": ("6 [001]", "-1"),
        "622": ("6 [001]", "2 [110]"),
        "6mm": ("6 [001]", "-2 [110]"),
        "-6m2": ("-6 [001]", "2 [1-10]"),
        "-62m": ("-6 [001]", "2 [110]"),
        "6/mmm": ("6 [001]", "2 [110]", "-1"),
        "23": ("2 [001]", "3 [111]"),
        "m-3": ("2 [001]", "-3 [111]"),
        "432": ("4 [001]", "3 [111]"),
        "-43m": ("-4 [001]", "3 [111]"),
        "m-3m": ("4 [001]", "-3 [111]"),
    }
)
"""Generators of every group by its symbol, in each of its settings; a minus makes a rotation a rotoinversion, so that
−2 is a mirror."""

_SETTINGS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "mm2": ("mm2", "m2m", "2mm"),
        "-42m": ("-42m", "-4m2"),
        "32": ("321", "312"),
        "3m": ("3m1", "31m"),
        "-3m": ("-3m1", "-31m"),
        "-6m2": ("-6m2", "-62m"),
    }
)
"""The groups of which the symbol alone does not tell how they stand on the axes."""


@dataclass(frozen=True)
class PointGroup:
    """A point group in one setting; `point_group` finds it.

    Parameters
    ----------
    symbol : str
        Hermann-Mauguin symbol of the setting, such as ``-3m1``.
    """

    symbol: str

    @cached_property
    def matrices(self) -> Whole:
        """All operations, shape (order, 3, 3): columns of coordinates on a, b, c become W·(u, v, w); the first is 1."""
        found = [_matrix("1")]
        known = {found[0].tobytes()}
        generators = [_matrix(name) for name in GENERATORS[self.symbol]]
        for matrix in found:  # which grows meanwhile
            for generator in generators:
                product = generator @ matrix
                if product.tobytes() not in known:
                    known.add(product.tobytes())
                    found.append(product)
        return np.array(found, np.int64)

    @property
    def order(self) -> int:
        """How many operations there are."""
        return len(self.matrices)

    @cached_property
    def determinants(self) -> Whole:
        """1 for each rotation, −1 for each operation that turns a right hand into a left one, shape (order,)."""
        return np.asarray(np.rint(np.linalg.det(self.matrices)), np.int64)

    @property
    def is_chiral(self) -> bool:
        """Whether a crystal and its mirror image differ: none of the operations is a mirror or an inversion."""
        return bool((self.determinants > 0).all())

    @property
    def is_centrosymmetric(self) -> bool:
        """Whether the inversion is one of the operations."""
        return bool((self.matrices == -_matrix("1")).all(axis=(1, 2)).any())

    @property
    def laue(self) -> PointGroup:
        """The group with the inversion added, as diffraction and the cleavage of a crystal show it."""
        return self if self.is_centrosymmetric else point_group(_LAUE[self.symbol])

    def equivalents(self, hkl: Sequence[int]) -> tuple[Hkl, ...]:
        """Return the faces of the form {hkl}, each once, the given one first.

        A face moves with the inverse of the matrix, (h k l) W⁻¹; over the group these are also all (h k l) W.
        """
        rows = np.asarray(hkl, np.int64) @ self.matrices
        return tuple(dict.fromkeys((int(h), int(k), int(m)) for h, k, m in rows))

    def fits(self, lattice: Lattice) -> bool:
        """Return whether the lattice has the symmetry of the group: every operation keeps its metric tensor."""
        metric = lattice.metric
        changed = self.matrices.transpose(0, 2, 1) @ metric @ self.matrices
        return bool(np.allclose(changed, metric, rtol=0.0, atol=1e-9 * float(metric.max())))

    def cartesian(self, lattice: Lattice) -> Real:
        """Return the operations in the crystal frame of a lattice, shape (order, 3, 3).

        They are rotations and rotoinversions if the lattice has the symmetry of the group.
        """
        basis = lattice.direct.T
        return np.asarray(basis @ self.matrices @ np.linalg.inv(basis))


_LAUE: Mapping[str, str] = MappingProxyType(
    {
        "1": "-1", "2": "2/m", "m": "2/m",
        "222": "mmm", "mm2": "mmm", "m2m": "mmm", "2mm": "mmm",
        "4": "4/m", "-4": "4/m", "422": "4/mmm", "4mm": "4/mmm", "-42m": "4/mmm", "-4m2": "4/mmm",
        "3": "-3", "321": "-3m1", "312": "-31m", "3m1": "-3m1", "31m": "-31m",
        "6": "6/m", "-6": "6/m", "622": "6/mmm", "6mm": "6/mmm", "-6m2": "6/mmm", "-62m": "6/mmm",
        "23": "m-3", "432": "m-3m", "-43m": "m-3m",
    }
)  # fmt: skip
"""The group that each makes together with the inversion."""


@cache
def point_group(symbol: str) -> PointGroup:
    """Return the point group of a symbol.

    Parameters
    ----------
    symbol : str
        One of the keys of `GENERATORS`: of a group that can stand in several ways, the symbol of a setting.

    Raises
    ------
    InputError
        There is no such group, or the symbol leaves open how it stands.
    """
    if symbol in GENERATORS:
        return PointGroup(symbol)
    if symbol in _SETTINGS:
        raise InputError.at("/point_group", f"{symbol} can stand as {' or '.join(_SETTINGS[symbol])}: say which")
    raise InputError.at("/point_group", f"no point group {symbol!r}; those are {', '.join(GENERATORS)}")


def setting_of(symbol: str, space_group: str) -> str:
    """Return the symbol of a point group in the setting of a cell.

    Parameters
    ----------
    symbol : str
        One of the 32 short symbols, such as ``-6m2``.
    space_group : str
        Hermann-Mauguin symbol in the setting of the cell with blanks between its places, such as ``P -6 c 2``; read
        only where the point group alone leaves open how it stands on the axes.

    Raises
    ------
    InputError
        The symbol of the space group is none, or not one of this point group.
    """
    settings = _SETTINGS.get(symbol)
    if settings is None:
        return point_group(symbol).symbol
    places = space_group.split()[1:]
    elements = [_without_translation(place) for place in places]
    # R 3 m and its like, and a group written short: what is not said of the last place is 1.
    if symbol in ("32", "3m", "-3m") and len(elements) == 2:
        elements.append("1")
    found = "".join(elements)
    if found not in settings:
        raise InputError.at(
            "/cell/space_group", f"{space_group!r} does not tell whether {symbol} stands as {' or '.join(settings)}"
        )
    return found


def _without_translation(place: str) -> str:
    """Return what a place of a space group's symbol becomes in its point group's: m for c, 4 for 41."""
    return re.sub(r"^[abcden]$", "m", re.sub(r"^(-?[1-6])[1-5]?$", r"\1", place))


def _matrix(operation: str) -> Whole:
    if operation.startswith("-"):
        return -_matrix(operation[1:])
    return np.array(_ROTATIONS[operation], np.int64)
