"""From an entry to a medium: which index stands along which axis of the crystal, and where that axis stands."""

from __future__ import annotations

import numpy as np
import pytest

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials import SODIUM_D_NM, medium, principal_indices
from crystal_core.optics.indicatrix import optic_axes, permittivity
from minerals_db import Mineral

LINES = np.array((486.1, 546.1, 589.3, 656.3))

# A turn by 40° about z, then by 25° about x, then by 70° about z: no axis of the crystal stays on one of the world.
A, B, C = np.deg2rad((40.0, 25.0, 70.0))


def about_z(angle: float) -> np.ndarray:
    return np.array(((np.cos(angle), -np.sin(angle), 0.0), (np.sin(angle), np.cos(angle), 0.0), (0.0, 0.0, 1.0)))


def about_x(angle: float) -> np.ndarray:
    return np.array(((1.0, 0.0, 0.0), (0.0, np.cos(angle), -np.sin(angle)), (0.0, np.sin(angle), np.cos(angle))))


TURNED = about_z(C) @ about_x(B) @ about_z(A)


@pytest.fixture(scope="module")
def rhombic() -> Mineral:
    """Return an orthorhombic mineral with n_c < n_a < n_b, as in aragonite."""

    def curve(strength: float) -> dict[str, object]:
        terms = [{"strength": strength, "resonance_um2": 0.01}]
        return {"model": "sellmeier-2", "terms": terms, "range_nm": [400, 700], "source": "me", "status": "measured"}

    cell = {f"{length}_angstrom": 5.0 + number for number, length in enumerate("abc")}
    return Mineral.model_validate(
        {
            "id": "testite",
            "names": {"en": "Testite", "ru": "Тестит"},
            "formula": "CaCO3",
            "system": "orthorhombic",
            "point_group": "mmm",
            "optical_class": "biaxial",
            "optic_sign": "negative",
            "cell": {
                **cell,
                **{f"{angle}_deg": 90 for angle in ("alpha", "beta", "gamma")},
                "space_group": "P m m m",
                "source": "me",
                "status": "measured",
            },
            "dispersion": {"a": curve(1.75), "b": curve(1.78), "c": curve(1.3)},
            "sources": {"me": {"citation": "My own notebook.", "licence": "CC0 1.0"}},
        }
    )


def test_indices_come_by_class(rhombic: Mineral) -> None:
    (n,) = principal_indices(minerals_db.mineral("diamond"), LINES)
    np.testing.assert_array_equal(n, minerals_db.mineral("diamond").dispersion["n"].index(LINES))
    n_o, n_e = principal_indices(minerals_db.mineral("calcite"), LINES)
    assert np.all(n_o - n_e > 0.16)
    n_a, n_b, n_c = principal_indices(rhombic, LINES)
    for found, axis in ((n_a, "a"), (n_b, "b"), (n_c, "c")):
        np.testing.assert_array_equal(found, rhombic.dispersion[axis].index(LINES))
    assert np.all(n_c < n_a)
    assert np.all(n_a < n_b)


@pytest.mark.parametrize("shape", [(), (4,), (2, 3)])
def test_indices_have_the_shape_of_the_wavelengths(rhombic: Mineral, shape: tuple[int, ...]) -> None:
    for mineral in (minerals_db.mineral("diamond"), minerals_db.mineral("calcite"), rhombic):
        assert {n.shape for n in principal_indices(mineral, np.full(shape, 550.0))} == {shape}


def test_a_wave_along_each_axis_of_the_turned_crystal_sees_that_axis_index(rhombic: Mineral) -> None:
    # ε of a direction R e_i is n_i² whatever the code does with frames: that is what v_world = R v_crystal says.
    calcite = minerals_db.mineral("calcite")
    n_o, n_e = (float(n) for n in principal_indices(calcite, SODIUM_D_NM))
    n_a, n_b, n_c = (float(n) for n in principal_indices(rhombic, SODIUM_D_NM))
    for mineral, expected in ((calcite, (n_o, n_o, n_e)), (rhombic, (n_a, n_b, n_c))):
        epsilon = permittivity(medium(mineral, SODIUM_D_NM, TURNED))
        along = [TURNED[:, i] @ epsilon @ TURNED[:, i] for i in range(3)]
        np.testing.assert_allclose(np.sqrt(along), expected, rtol=1e-14)
        np.testing.assert_allclose(TURNED.T @ epsilon @ TURNED, np.diag(np.square(expected)), atol=1e-14)


def test_optic_axes_turn_with_the_crystal(rhombic: Mineral) -> None:
    (axis,) = optic_axes(medium(minerals_db.mineral("calcite"), SODIUM_D_NM, TURNED))
    np.testing.assert_array_equal(axis, TURNED[:, 2])
    for still, turned in zip(
        optic_axes(medium(rhombic, SODIUM_D_NM)), optic_axes(medium(rhombic, SODIUM_D_NM, TURNED)), strict=True
    ):
        # n_a is β: the optic axes lie in the plane of b and c.
        assert abs(still[0]) < 1e-15
        np.testing.assert_allclose(np.abs(turned @ TURNED @ still), 1.0, rtol=1e-14)


def test_without_a_rotation_the_crystal_stands_in_its_own_frame(rhombic: Mineral) -> None:
    for mineral in (minerals_db.mineral("quartz"), rhombic):
        np.testing.assert_array_equal(
            permittivity(medium(mineral, SODIUM_D_NM)), permittivity(medium(mineral, SODIUM_D_NM, np.eye(3)))
        )


def test_each_ray_has_the_indices_of_its_wavelength(rhombic: Mineral) -> None:
    for mineral in (minerals_db.mineral("diamond"), minerals_db.mineral("calcite"), rhombic):
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
