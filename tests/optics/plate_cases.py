"""Random plates and stacks, and the same stacks computed by pyElli (a test dependency only)."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from crystal_core.optics.indicatrix import dissipation, permittivity
from crystal_core.optics.medium import Medium
from crystal_core.optics.plates import Plate

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # of pyElli's own imports
    import elli

Array = NDArray[np.float64]
KINDS = ("isotropic", "uniaxial", "biaxial")


def rotation(rng: np.random.Generator) -> Array:
    return Rotation.random(random_state=rng).as_matrix()


def random_medium(rng: np.random.Generator, kind: str, absorption: float = 0.0, gyration: float = 0.0) -> Medium:
    """Indices 1.3 to 2.3 on any axes; absorption up to so many per mm on axes of its own."""
    n = rng.uniform(1.3, 2.3, 3)
    axes = rotation(rng)
    if kind == "isotropic":
        medium = Medium.isotropic(n[0])
    elif kind == "uniaxial":
        medium = Medium.uniaxial(n[0], n[1], axes[2])
    else:
        medium = Medium.biaxial(tuple(n), axes)
    if absorption:
        medium = medium.absorbing(tuple(rng.uniform(0, absorption, 3)), rotation(rng))
    if gyration:
        g = rng.uniform(-gyration, gyration, (3, 3))
        medium = medium.active(g + g.T)
    return medium


def random_stack(
    rng: np.random.Generator, count: int, thickest_um: float, absorption: float = 0.0, gyration: float = 0.0
) -> list[Plate]:
    return [
        Plate(random_medium(rng, KINDS[rng.integers(3)], absorption, gyration), rng.uniform(0.1, thickest_um))
        for _ in range(count)
    ]


def turned(plates: Sequence[Plate], turn: Array) -> list[Plate]:
    """The same plates with their crystals turned, v' = turn v."""
    result = []
    for plate in plates:
        m = plate.medium
        medium = Medium(
            m.indices,
            None if m.axis is None else turn @ m.axis,
            None if m.axes is None else m.axes @ turn.T,
            m.absorption_per_mm,
            None if m.absorption_axes is None else m.absorption_axes @ turn.T,
            None if m.gyration is None else turn @ m.gyration @ turn.T,
        )
        result.append(Plate(medium, plate.thickness_um))
    return result


class _Tensor(elli.Material):
    """A material of a given permittivity at each wavelength, (N, 3, 3)."""

    def __init__(self, epsilon: NDArray[np.complex128]) -> None:
        self.epsilon = epsilon

    def get_tensor(self, lbda: Array) -> NDArray[np.complex128]:
        assert np.size(lbda) == len(self.epsilon)
        return self.epsilon


def pyelli_jones(
    plates: Sequence[Plate], wavelength_nm: Array, mount_index: float, kappa: float
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Transmitted and reflected Jones matrices (2, 2, N), components p, s, plane of incidence xz."""
    layers = []
    for plate in plates:
        k0 = 2e6 * np.pi / wavelength_nm
        epsilon = permittivity(plate.medium) + 1j * dissipation(plate.medium) / k0[:, None, None]
        layers.append(elli.Layer(_Tensor(epsilon), plate.thickness_um * 1e3))
    mount = elli.IsotropicMaterial(elli.ConstantRefractiveIndex(mount_index))
    structure = elli.Structure(mount, layers, mount)
    angle = float(np.degrees(np.arcsin(kappa / mount_index)))
    result = structure.evaluate(wavelength_nm, angle, solver=elli.Solver4x4)
    return np.moveaxis(result.jones_matrix_t, 0, 2), np.moveaxis(result.jones_matrix_r, 0, 2)
