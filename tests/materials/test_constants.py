"""From an entry to a medium: which index stands along which axis, where that axis stands, and what turns the plane."""

from __future__ import annotations

import numpy as np
import pytest

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials import SODIUM_D_NM, gyration, medium, principal_indices
from crystal_core.optics.indicatrix import optic_axes, permittivity

LINES = np.array((486.1, 546.1, 589.3, 656.3))

# A turn by 40° about z, then by 25° about x, then by 70° about z: no axis of the crystal stays on one of the world.
A, B, C = np.deg2rad((40.0, 25.0, 70.0))


def about_z(angle: float) -> np.ndarray:
    return np.array(((np.cos(angle), -np.sin(angle), 0.0), (np.sin(angle), np.cos(angle), 0.0), (0.0, 0.0, 1.0)))


def about_x(angle: float) -> np.ndarray:
    return np.array(((1.0, 0.0, 0.0), (0.0, np.cos(angle), -np.sin(angle)), (0.0, np.sin(angle), np.cos(angle))))


ARAGONITE = minerals_db.mineral("aragonite")
TURNED = about_z(C) @ about_x(B) @ about_z(A)


def test_indices_come_by_class() -> None:
    (n,) = principal_indices(minerals_db.mineral("diamond"), LINES)
    np.testing.assert_array_equal(n, minerals_db.mineral("diamond").dispersion["n"].index(LINES))
    n_o, n_e = principal_indices(minerals_db.mineral("calcite"), LINES)
    assert np.all(n_o - n_e > 0.16)
    n_a, n_b, n_c = principal_indices(ARAGONITE, LINES)
    for found, axis in ((n_a, "a"), (n_b, "b"), (n_c, "c")):
        np.testing.assert_array_equal(found, ARAGONITE.dispersion[axis].index(LINES))
    # Every handbook: X = c, Y = a, Z = b.
    assert np.all(n_c < n_a)
    assert np.all(n_a < n_b)


@pytest.mark.parametrize("shape", [(), (4,), (2, 3)])
def test_indices_have_the_shape_of_the_wavelengths(shape: tuple[int, ...]) -> None:
    for mineral in (minerals_db.mineral("diamond"), minerals_db.mineral("calcite"), ARAGONITE):
        assert {n.shape for n in principal_indices(mineral, np.full(shape, 550.0))} == {shape}


def test_a_wave_along_each_axis_of_the_turned_crystal_sees_that_axis_index() -> None:
    # ε of a direction R e_i is n_i² whatever the code does with frames: that is what v_world = R v_crystal says.
    calcite = minerals_db.mineral("calcite")
    n_o, n_e = (float(n) for n in principal_indices(calcite, SODIUM_D_NM))
    n_a, n_b, n_c = (float(n) for n in principal_indices(ARAGONITE, SODIUM_D_NM))
    for mineral, expected in ((calcite, (n_o, n_o, n_e)), (ARAGONITE, (n_a, n_b, n_c))):
        epsilon = permittivity(medium(mineral, SODIUM_D_NM, TURNED))
        along = [TURNED[:, i] @ epsilon @ TURNED[:, i] for i in range(3)]
        np.testing.assert_allclose(np.sqrt(along), expected, rtol=1e-14)
        np.testing.assert_allclose(TURNED.T @ epsilon @ TURNED, np.diag(np.square(expected)), atol=1e-14)


def test_optic_axes_turn_with_the_crystal() -> None:
    (axis,) = optic_axes(medium(minerals_db.mineral("calcite"), SODIUM_D_NM, TURNED))
    np.testing.assert_array_equal(axis, TURNED[:, 2])
    for still, turned in zip(
        optic_axes(medium(ARAGONITE, SODIUM_D_NM)), optic_axes(medium(ARAGONITE, SODIUM_D_NM, TURNED)), strict=True
    ):
        # n_a is β: the optic axes lie in the plane of b and c.
        assert abs(still[0]) < 1e-15
        np.testing.assert_allclose(np.abs(turned @ TURNED @ still), 1.0, rtol=1e-14)


def test_without_a_rotation_the_crystal_stands_in_its_own_frame() -> None:
    for mineral in (minerals_db.mineral("quartz"), ARAGONITE):
        np.testing.assert_array_equal(
            permittivity(medium(mineral, SODIUM_D_NM)), permittivity(medium(mineral, SODIUM_D_NM, np.eye(3)))
        )


def test_each_ray_has_the_indices_of_its_wavelength() -> None:
    for mineral in (minerals_db.mineral("diamond"), minerals_db.mineral("calcite"), ARAGONITE):
        whole = medium(mineral, LINES, TURNED)
        for ray, nm in enumerate(LINES):
            alone = medium(mineral, float(nm), TURNED)
            np.testing.assert_array_equal([n[ray] for n in whole.indices], alone.indices)


@pytest.mark.parametrize(
    "rotation",
    [
        np.diag((1.0, 1.0, -1.0)),  # a mirror
        np.diag((1.0, 1.0, 1.0 + 1e-6)),
        np.full((3, 3), np.nan),
        np.eye(2),
        np.zeros((3, 3)),
        np.array((0.0, 0.0, 1.0)),
    ],
)
@pytest.mark.parametrize("mineral", ["diamond", "calcite"])
def test_what_is_no_rotation_is_refused(mineral: str, rotation: np.ndarray) -> None:
    with pytest.raises(InputError, match="proper") as caught:
        medium(minerals_db.mineral(mineral), SODIUM_D_NM, rotation)
    assert caught.value.faults[0].pointer == "/rotation"


@pytest.mark.parametrize("nm", [0.0, -500.0, np.nan, np.inf, [500.0, np.nan], [[500.0]]])
def test_what_is_no_wavelength_is_refused(nm: float) -> None:
    with pytest.raises(InputError, match="finite and positive") as caught:
        medium(minerals_db.mineral("calcite"), nm)
    assert caught.value.faults[0].pointer == "/wavelength_nm"


# Rotation of right quartz along the axis, degrees per mm (A. Winkelmann, Handbuch der Physik 2/1, 1894, p. 801, first
# column, Soret and Sarasin).
QUARTZ = [(656.28, 17.318), (589.3, 21.71), (486.13, 32.773)]


def rotation_deg_per_mm(mineral: str, nm: float) -> float:
    """Return ρ = π g33/(λ n_o)."""
    entry = minerals_db.mineral(mineral)
    tensor = gyration(entry, nm)
    assert tensor is not None
    n_o, _ = principal_indices(entry, nm)
    return float(np.rad2deg(np.pi * tensor[2, 2] / (nm * 1e-6 * n_o)))


@pytest.mark.parametrize(("nm", "measured"), QUARTZ)
def test_quartz_turns_the_plane_as_measured(nm: float, measured: float) -> None:
    assert rotation_deg_per_mm("quartz", nm) == pytest.approx(measured, rel=2e-3)


def test_circular_waves_of_quartz_differ_as_measured() -> None:
    # n_L - n_R = ρ λ/π at the D line; textbooks, from memory: 1.54427 and 1.54420, 7.1e-5.
    tensor = gyration(minerals_db.mineral("quartz"), SODIUM_D_NM)
    assert tensor is not None
    n_o = float(principal_indices(minerals_db.mineral("quartz"), SODIUM_D_NM)[0])
    g33 = float(tensor[2, 2])
    assert np.sqrt(n_o**2 + g33) - np.sqrt(n_o**2 - g33) == pytest.approx(7.1e-5, abs=5e-7)


def test_paratellurite_turns_the_plane_as_measured() -> None:
    # N. Uchida, Phys. Rev. B 4, 3736 (1971), from memory: 86.9° per mm at 632.8 nm.
    assert rotation_deg_per_mm("paratellurite", 632.8) == pytest.approx(86.9, rel=1e-3)


def test_activity_of_quartz_vanishes_57_degrees_from_the_axis() -> None:
    # G(θ) = g33 cos² θ + g11 sin² θ. Szivessy and Münster 1934, from memory: 56°10'; Kobayashi 1988: 57.1°.
    tensor = gyration(minerals_db.mineral("quartz"), SODIUM_D_NM)
    assert tensor is not None
    angles = np.deg2rad((0.0, 56.0, 58.0, 90.0))
    normals = np.stack((np.sin(angles), 0.0 * angles, np.cos(angles)))
    along = np.einsum("in,ij,jn->n", normals, tensor, normals)
    assert along[0] > along[1] > 0.0 > along[2] > along[3]


def test_left_quartz_is_the_mirror_image() -> None:
    right = minerals_db.mineral("quartz")
    assert right.optical_rotation is not None
    hand = right.optical_rotation.hand.model_copy(update={"sense": "left"})
    left = right.model_copy(update={"optical_rotation": right.optical_rotation.model_copy(update={"hand": hand})})
    np.testing.assert_array_equal(gyration(left, LINES), -np.asarray(gyration(right, LINES)))


def test_gyration_has_a_column_for_each_wavelength() -> None:
    quartz = minerals_db.mineral("quartz")
    whole = gyration(quartz, LINES)
    assert whole is not None
    assert whole.shape == (3, 3, 4)
    for ray, nm in enumerate(LINES):
        np.testing.assert_array_equal(whole[:, :, ray], gyration(quartz, float(nm)))


def test_only_active_crystals_have_a_gyration() -> None:
    for mineral in ("diamond", "calcite", "aragonite"):
        assert gyration(minerals_db.mineral(mineral), LINES) is None
        assert medium(minerals_db.mineral(mineral), LINES).gyration is None


@pytest.mark.parametrize("nm", [SODIUM_D_NM, LINES])
def test_gyration_turns_with_the_crystal(nm: float | np.ndarray) -> None:
    quartz = minerals_db.mineral("quartz")
    still, turned = gyration(quartz, nm), medium(quartz, nm, TURNED).gyration
    assert still is not None
    assert turned is not None
    assert turned.shape == still.shape
    np.testing.assert_array_equal(turned, turned.swapaxes(0, 1))
    for direction in np.eye(3):
        world = TURNED @ direction
        np.testing.assert_allclose(
            np.einsum("i,ij...,j->...", world, turned, world),
            np.einsum("i,ij...,j->...", direction, still, direction),
            rtol=1e-12,
        )
