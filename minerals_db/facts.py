"""The numbers by which minerals are found and listed: indices, birefringence, 2V at the D line; density, hardness."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from minerals_db.curve import OutsideRangeError
from minerals_db.indicatrix import SODIUM_D_NM, angle_about_gamma_deg, principal_indices

if TYPE_CHECKING:
    from minerals_db.schema import Mineral

__all__ = ["Facts", "facts"]


@dataclass(frozen=True, slots=True)
class Facts:
    """A mineral in a few numbers; what is not known is None.

    Parameters
    ----------
    indices : mapping of str to float
        Principal indices at the D line (589.3 nm) by the name of their curve, in the order of the entry. Empty if a
        curve refuses the D line.
    clamped : bool
        Whether the D line lies outside the range of a curve, so that the index at its nearer end stands for it.
    birefringence : float or None
        Largest less smallest index at the D line; 0 of an isotropic mineral.
    mean_index : float or None
        Mean over the three principal directions, so (2 n_o + n_e)/3 of a uniaxial mineral.
    two_v_deg : float or None
        Acute angle between the optic axes at the D line, degrees; None unless biaxial.
    density_g_per_cm3, hardness_mohs : tuple of two floats or None
        The range the entry gives.
    """

    indices: Mapping[str, float]
    clamped: bool
    birefringence: float | None
    mean_index: float | None
    two_v_deg: float | None
    density_g_per_cm3: tuple[float, float] | None
    hardness_mohs: tuple[float, float] | None


def facts(mineral: Mineral) -> Facts:
    """Return what is known of a mineral.

    Parameters
    ----------
    mineral : Mineral
        An entry.
    """
    density = mineral.density.g_per_cm3 if mineral.density is not None else None
    hardness = mineral.hardness.mohs if mineral.hardness is not None else None
    try:
        n = {axis: float(index) for axis, index in principal_indices(mineral, SODIUM_D_NM).items()}
    except OutsideRangeError:
        return Facts({}, False, 0.0 if mineral.optical_class == "isotropic" else None, None, None, density, hardness)
    weights = {"o": 2.0}
    total = sum(weights.get(axis, 1.0) for axis in n)
    mean = sum(weights.get(axis, 1.0) * index for axis, index in n.items()) / total
    # As `indicatrix` has it, but from indices that are asked for once: a list takes the facts of all minerals.
    rising = sorted(n.values())
    two_v = float(angle_about_gamma_deg(rising)) if mineral.optical_class == "biaxial" else math.nan
    acute = None if math.isnan(two_v) else min(two_v, 180.0 - two_v)
    clamped = not all(curve.covers(SODIUM_D_NM, SODIUM_D_NM) for curve in mineral.dispersion.values())
    return Facts(n, clamped, rising[-1] - rising[0], mean, acute, density, hardness)
