"""From a mineral's entry to what the optics needs. The only floor that knows both `minerals_db` and the optics."""

from crystal_core.materials.constants import SODIUM_D_NM, gyration, medium, principal_indices

__all__ = ["SODIUM_D_NM", "gyration", "medium", "principal_indices"]
