"""Bad input of the optics: a named error, before any arithmetic."""

import numpy as np
import pytest

from crystal_core.errors import InputError
from crystal_core.optics import Medium, scatter

AIR = Medium.isotropic(1.0)
KT = np.zeros((3, 1))


@pytest.mark.parametrize("n", [0.0, -1.5, np.nan, np.inf, [[1.5]]])
def test_an_index_must_be_finite_and_positive(n: object) -> None:
    with pytest.raises(InputError, match="/indices/0"):
        Medium.isotropic(n)  # type: ignore[arg-type]


@pytest.mark.parametrize("axis", [(0, 0, 0), (0, 0, 2), (np.nan, 0, 1), (1, 0)])
def test_an_axis_must_be_a_unit_vector(axis: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match="/axis"):
        Medium.uniaxial(1.5, 1.6, axis)


def test_an_absorption_must_not_be_negative() -> None:
    with pytest.raises(InputError, match="/absorption_per_mm/1"):
        Medium.uniaxial(1.5, 1.6, (0, 0, 1), (0.0, -1.0))


@pytest.mark.parametrize("axes", [np.eye(3) * 1.001, np.ones((3, 3)), np.eye(2), np.full((3, 3), np.nan)])
def test_axes_must_be_orthonormal(axes: np.ndarray) -> None:
    with pytest.raises(InputError, match="/axes"):
        Medium.biaxial((1.5, 1.6, 1.7), axes)


def test_absorption_and_gyration_are_checked() -> None:
    medium = Medium.biaxial((1.5, 1.6, 1.7), np.eye(3))
    with pytest.raises(InputError, match="/absorption_per_mm/2"):
        medium.absorbing((0, 1, -1), np.eye(3))
    with pytest.raises(InputError, match="/absorption_axes"):
        medium.absorbing((0, 1, 1), 2 * np.eye(3))
    with pytest.raises(InputError, match="/gyration"):
        medium.active(np.triu(np.ones((3, 3))))


@pytest.mark.parametrize(
    ("normal", "kt", "pointer"),
    [
        ((0, 0, 0), KT, "/normal"),
        ((0, 0, 2), KT, "/normal"),
        ((0, 0, 1), np.array([[0.0], [0.0], [0.1]]), "/tangential_k"),
        ((0, 0, 1), np.full((3, 1), np.nan), "/tangential_k"),
        ((0, 0, 1), np.zeros(3), "/tangential_k"),
    ],
)
def test_a_face_needs_a_unit_normal_and_a_tangential_k(normal: object, kt: np.ndarray, pointer: str) -> None:
    with pytest.raises(InputError, match=pointer):
        scatter(normal, kt, AIR, AIR)  # type: ignore[arg-type]
