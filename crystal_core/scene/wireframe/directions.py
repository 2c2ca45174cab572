"""Directions of a crystal that a drawing shows: the axes of its cell, its optic axes, a section of its indicatrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics.indicatrix import BiaxialIndicatrix, permittivity
from crystal_core.scene.specimen import lattice_of
from crystal_core.scene.staged.medium import StagedMedium

__all__ = ["IndicatrixSection", "cell_axes", "indicatrix_section", "optic_axes"]

Real = NDArray[np.float64]

SODIUM_D_NM = 589.3

VISIBLE_RATIO = 0.8
"""Ratio of its semi-axes below which an ellipse is seen to be one."""

EXAGGERATIONS = (1, 2, 5, 10, 20, 50, 100, 200, 500)


@dataclass(frozen=True)
class IndicatrixSection:
    """The section of the indicatrix across a direction: what vibrates along its semi-axes goes through unchanged.

    Parameters
    ----------
    indices : tuple of float
        The larger and the smaller, those of the two waves along the direction.
    directions : Real
        Of their vibrations in the world, shape (2, 3).
    exaggeration : int
        By how much their difference is drawn larger than it is, so that the ellipse is seen to be one.
    """

    indices: tuple[float, float]
    directions: Real
    exaggeration: int

    @property
    def radii(self) -> tuple[float, float]:
        """Semi-axes as drawn; the larger is 1."""
        larger, smaller = self.indices
        return 1.0, 1.0 - self.exaggeration * (larger - smaller) / larger


def cell_axes(medium: StagedMedium) -> list[tuple[str, Real]]:
    """Return names and directions in the world, shape (3,), of the axes of the cell; none of a glass."""
    mineral = medium.mineral
    if mineral is None or mineral.cell is None:
        return []
    names = {"trigonal": ("a₁", "a₂", "c"), "hexagonal": ("a₁", "a₂", "c"), "tetragonal": ("a₁", "a₂", "c")}
    cubic = ("a₁", "a₂", "a₃")
    chosen = cubic if mineral.system == "cubic" else names.get(mineral.system, ("a", "b", "c"))
    if mineral.system == "trigonal" and abs(mineral.cell.gamma_deg - 90.0) < 1.0:
        chosen = ("a", "b", "c")
    directions = lattice_of(mineral).direct @ medium.rotation.T
    return [(name, np.asarray(row / np.linalg.norm(row))) for name, row in zip(chosen, directions, strict=True)]


def optic_axes(medium: StagedMedium) -> list[Real]:
    """Return the optic axes in the world at 589.3 nm, unit, shape (3,): none, one or two."""
    at_d = medium.at(np.array([SODIUM_D_NM]))
    if len(at_d.indices) == 1:
        return []
    if at_d.axis is not None:
        return [np.asarray(at_d.axis).reshape(3, -1)[:, 0]]
    return [np.asarray(axis).reshape(3, -1)[:, 0] for axis in BiaxialIndicatrix.of(at_d).optic_axes()]


def indicatrix_section(medium: StagedMedium, sight: Real) -> IndicatrixSection | None:
    """Return the section across a unit vector, shape (3,), at 589.3 nm; None where it is a circle.

    The semi-axes of the section with normal s are 1/√λ, λ the eigenvalues of ε⁻¹ in the plane across s: M. Born,
    E. Wolf, Principles of Optics, 7th ed., §15.2.3.
    """
    at_d = medium.at(np.array([SODIUM_D_NM]))
    if len(at_d.indices) == 1:
        return None
    tensor = permittivity(at_d)
    inverse = np.linalg.inv(tensor.reshape(3, 3, -1)[:, :, 0])
    helper = np.eye(3)[int(np.argmin(np.abs(sight)))]
    x = np.cross(helper, sight)
    x /= np.linalg.norm(x)
    across = np.stack((x, np.cross(sight, x)))
    values, vectors = np.linalg.eigh(across @ inverse @ across.T)
    larger, smaller = (float(n) for n in 1.0 / np.sqrt(values))
    if larger - smaller < 1e-5:
        return None
    part = (larger - smaller) / larger
    exaggeration = next((e for e in EXAGGERATIONS if 1.0 - e * part <= VISIBLE_RATIO), EXAGGERATIONS[-1])
    return IndicatrixSection((larger, smaller), np.asarray(vectors.T @ across), exaggeration)
