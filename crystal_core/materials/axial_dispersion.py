"""How the optic axes of a biaxial crystal move from red to violet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from crystal_core.errors import InputError
from minerals_db import Mineral
from minerals_db.indicatrix import angle_about_gamma_deg, principal_indices

__all__ = ["FRAUNHOFER_C_NM", "FRAUNHOFER_F_NM", "AxialDispersion", "axial_dispersion"]

FRAUNHOFER_C_NM = 656.28
"""Red, Hα."""

FRAUNHOFER_F_NM = 486.13
"""Blue, Hβ."""


@dataclass(frozen=True, slots=True)
class AxialDispersion:
    """The angles between the optic axes in red and in violet light.

    Parameters
    ----------
    two_v_red_deg, two_v_violet_deg : float
        2V about the bisectrix that is acute in red light, degrees, 0 to 180.
    sense : "r>v", "r<v" or None
        Which of the two is larger; None where they are equal to 1e-9 degrees: one dispersion for all axes hardly moves
        them.
    crossed_planes : bool
        Whether the plane of the optic axes is another in violet light than in red, as in brookite.
    """

    two_v_red_deg: float
    two_v_violet_deg: float
    sense: Literal["r>v", "r<v"] | None
    crossed_planes: bool


def axial_dispersion(
    mineral: Mineral, red_nm: float = FRAUNHOFER_C_NM, violet_nm: float = FRAUNHOFER_F_NM
) -> AxialDispersion:
    """Return the axial dispersion that the principal indices of a biaxial mineral give.

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    red_nm, violet_nm : float
        Vacuum wavelengths to compare, nm.

    Raises
    ------
    InputError
        The mineral is not biaxial.
    """
    if mineral.optical_class != "biaxial":
        raise InputError.at("/mineral", f"{mineral.id} is {mineral.optical_class}: it has no two optic axes")
    angles, orders = [], []
    for wavelength in (red_nm, violet_nm):
        indices = {axis: float(n) for axis, n in principal_indices(mineral, wavelength).items()}
        order = sorted(indices, key=lambda axis: indices[axis])
        angles.append(float(angle_about_gamma_deg([indices[axis] for axis in order])))
        orders.append(order)
    if angles[0] > 90.0:
        angles = [180.0 - angle for angle in angles]
    crossed = orders[0][1] != orders[1][1]  # the optic plane is normal to Y
    difference = angles[0] - angles[1]
    sense: Literal["r>v", "r<v"] | None = None
    if not np.isclose(difference, 0.0, atol=1e-9) and not crossed:
        sense = "r>v" if difference > 0 else "r<v"
    return AxialDispersion(angles[0], angles[1], sense, crossed)
