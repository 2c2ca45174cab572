"""From a mineral's entry to what the optics needs. The only floor that knows both `minerals_db` and the optics."""

from crystal_core.materials.axial_dispersion import AxialDispersion, axial_dispersion
from crystal_core.materials.constants import absorption_coefficients, gyration, medium, principal_indices
from crystal_core.materials.swatches import swatches
from minerals_db.indicatrix import SODIUM_D_NM, birefringence, optic_sign, sorted_indices, two_v_deg

__all__ = [
    "SODIUM_D_NM",
    "AxialDispersion",
    "absorption_coefficients",
    "axial_dispersion",
    "birefringence",
    "gyration",
    "medium",
    "optic_sign",
    "principal_indices",
    "sorted_indices",
    "swatches",
    "two_v_deg",
]
