"""What the crystal system allows: point groups, cell shapes, optical classes and the names of principal indices."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

__all__ = [
    "CELL_SHAPE",
    "GYROTROPIC_ALONG_AXIS",
    "OPTICAL_CLASS",
    "POINT_GROUPS",
    "PRINCIPAL_AXES",
    "CellShape",
    "CrystalSystem",
    "OpticalClass",
    "PointGroup",
]

CrystalSystem = Literal[
    "cubic", "tetragonal", "hexagonal", "trigonal", "orthorhombic", "monoclinic", "triclinic", "amorphous"
]
"""The seven crystal systems, and glass, which has none."""
OpticalClass = Literal["isotropic", "uniaxial", "biaxial"]
PointGroup = Literal[
    "1", "-1",
    "2", "m", "2/m",
    "222", "mm2", "mmm",
    "4", "-4", "4/m", "422", "4mm", "-42m", "4/mmm",
    "3", "-3", "32", "3m", "-3m",
    "6", "-6", "6/m", "622", "6mm", "-6m2", "6/mmm",
    "23", "m-3", "432", "-43m", "m-3m",
]  # fmt: skip

POINT_GROUPS: Mapping[CrystalSystem, tuple[PointGroup, ...]] = MappingProxyType(
    {
        "triclinic": ("1", "-1"),
        "monoclinic": ("2", "m", "2/m"),
        "orthorhombic": ("222", "mm2", "mmm"),
        "tetragonal": ("4", "-4", "4/m", "422", "4mm", "-42m", "4/mmm"),
        "trigonal": ("3", "-3", "32", "3m", "-3m"),
        "hexagonal": ("6", "-6", "6/m", "622", "6mm", "-6m2", "6/mmm"),
        "cubic": ("23", "m-3", "432", "-43m", "m-3m"),
        "amorphous": (),
    }
)
"""The 32 crystal classes by system (International Tables for Crystallography A, table 3.2.1.4)."""

OPTICAL_CLASS: Mapping[CrystalSystem, OpticalClass] = MappingProxyType(
    {
        "cubic": "isotropic",
        "tetragonal": "uniaxial",
        "hexagonal": "uniaxial",
        "trigonal": "uniaxial",
        "orthorhombic": "biaxial",
        "monoclinic": "biaxial",
        "triclinic": "biaxial",
        "amorphous": "isotropic",
    }
)
"""The shape of the indicatrix that the symmetry of the system leaves (Neumann's principle)."""

PRINCIPAL_AXES: Mapping[CrystalSystem, tuple[str, ...]] = MappingProxyType(
    {
        "amorphous": ("n",),
        "cubic": ("n",),
        "tetragonal": ("o", "e"),
        "hexagonal": ("o", "e"),
        "trigonal": ("o", "e"),
        # Keyed by crystal directions: which of them is X, Y or Z is a question of the wavelength.
        "orthorhombic": ("a", "b", "c"),
        # Their directions stand in `orientation`; they are named by their order at the D line.
        "monoclinic": ("alpha", "beta", "gamma"),
        "triclinic": ("alpha", "beta", "gamma"),
    }
)
"""Names of the principal curves, in the order in which the optics takes them."""

GYROTROPIC_ALONG_AXIS: frozenset[PointGroup] = frozenset({"3", "32", "4", "422", "6", "622"})
"""The classes of uniaxial crystals that turn the plane of polarization along their optic axis (Nye, Physical Properties
of Crystals, 1957, ch. 14, table 20). −4 and −42m are active too, but not along the axis."""


class CellShape:
    """The equalities among a, b, c and the fixed angles of a system's cell.

    Parameters
    ----------
    equal : tuple of str
        Lengths that are equal.
    alpha, beta, gamma : float or None
        Fixed angles in degrees, None where free.
    """

    def __init__(self, equal: tuple[str, ...], alpha: float | None, beta: float | None, gamma: float | None) -> None:
        self.equal = equal
        self.angles = {"alpha_deg": alpha, "beta_deg": beta, "gamma_deg": gamma}


_AB = ("a_angstrom", "b_angstrom")
CELL_SHAPE: Mapping[CrystalSystem, CellShape] = MappingProxyType(
    {
        "cubic": CellShape((*_AB, "c_angstrom"), 90.0, 90.0, 90.0),
        "tetragonal": CellShape(_AB, 90.0, 90.0, 90.0),
        "hexagonal": CellShape(_AB, 90.0, 90.0, 120.0),
        "trigonal": CellShape(_AB, 90.0, 90.0, 120.0),
        "orthorhombic": CellShape((), 90.0, 90.0, 90.0),
        "monoclinic": CellShape((), 90.0, None, 90.0),
        "triclinic": CellShape((), None, None, None),
    }
)
"""The conventional cells: trigonal minerals in hexagonal axes, monoclinic ones with b unique."""
