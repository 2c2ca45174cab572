"""Where the indicatrix and the absorption of monoclinic and triclinic crystals stand, and how strongly they absorb."""

from __future__ import annotations

import numpy as np
import pytest

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials import absorption_coefficients, axial_dispersion, medium
from crystal_core.optics import absorption_along_ray
from crystal_core.optics.directions import waves_along
from crystal_core.optics.indicatrix import dissipation, permittivity
from tests.materials.entries import monoclinic

BETA = np.deg2rad(118.43)
B = np.array((0.0, 1.0, 0.0))
C = np.array((np.cos(BETA), 0.0, np.sin(BETA)))  # x ∥ a, z ∥ c*
TURN = np.array(((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))


def towards_a(degrees: float) -> np.ndarray:
    """Return +c turned towards +a, through the obtuse angle β: c and a make 118.43°, so that a is reached there."""
    angle = np.deg2rad(degrees)
    across = np.cross(B, C)
    return np.cos(angle) * C + np.sin(angle) * across


def test_a_is_reached_after_beta() -> None:
    np.testing.assert_allclose(towards_a(118.43), (1.0, 0.0, 0.0), atol=1e-15)


@pytest.mark.parametrize("rotation", [np.eye(3), TURN])
def test_each_principal_direction_sees_its_index(rotation: np.ndarray) -> None:
    epsilon = permittivity(medium(monoclinic(), 589.3, rotation))
    for direction, n in ((towards_a(52.0), 1.53), (B, 1.523), (towards_a(142.0), 1.52)):
        world = rotation @ direction
        np.testing.assert_allclose(epsilon @ world, n * n * world, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize(
    ("orientation", "direction", "n"),
    [
        ({"parallel_to_b": "gamma", "direction": "alpha", "from_axis": "a", "angle_deg": -5}, 118.43 - 5.0, 1.52),
        ({"parallel_to_b": "gamma", "direction": "beta", "from_axis": "c", "angle_deg": 23.43}, 23.43, 1.523),
        ({"parallel_to_b": "alpha", "direction": "gamma", "from_axis": "c", "angle_deg": -13}, -13.0, 1.53),
    ],
)
def test_angles_from_either_axis_and_of_either_direction(
    orientation: dict[str, object], direction: float, n: float
) -> None:
    """Orthoclase: X at 5° from a inside β. Its Y is then at 23.43° from c, and that says the same."""
    known = {"source": "me", "status": "estimated"}
    mineral = monoclinic(orientation={**orientation, **known}, absorption=None)
    epsilon = permittivity(medium(mineral, 589.3))
    along = towards_a(direction)
    np.testing.assert_allclose(epsilon @ along, n * n * along, rtol=1e-14, atol=1e-14)
    assert np.linalg.det(mineral.principal_axes(589.3)) == pytest.approx(1.0)


def test_axes_may_turn_with_the_wavelength() -> None:
    table = {
        "wavelengths_nm": [400, 589.3, 700], "angles_deg": [50.0, 52.0, 53.0], "range_nm": [400, 700],
        "source": "me", "status": "estimated",
    }  # fmt: skip
    orientation = {
        "parallel_to_b": "beta", "direction": "gamma", "from_axis": "c", "angle_deg": table,
        "source": "me", "status": "estimated",
    }  # fmt: skip
    lines = np.array((400.0, 589.3, 700.0, 900.0))
    found = medium(monoclinic(orientation=orientation), lines)
    assert found.axes is not None
    assert found.axes.shape == (3, 3, 4)
    for ray, degrees in enumerate((50.0, 52.0, 53.0, 53.0)):
        np.testing.assert_allclose(found.axes[2, :, ray], towards_a(degrees), atol=1e-15)
        np.testing.assert_allclose(
            permittivity(found)[:, :, ray], permittivity(medium(monoclinic(orientation=orientation), lines[ray]))
        )


def test_triclinic_axes_stand_where_the_entry_says() -> None:
    known = {"source": "me", "status": "estimated"}
    cell = {
        "a_angstrom": 7.1, "b_angstrom": 7.9, "c_angstrom": 5.6, "alpha_deg": 90, "beta_deg": 101, "gamma_deg": 106,
        "space_group": "P -1", **known,
    }  # fmt: skip
    orientation = {
        "alpha": {"polar_deg": 90, "azimuth_deg": 20}, "gamma": {"polar_deg": 30, "azimuth_deg": 110}, **known
    }  # fmt: skip
    mineral = monoclinic(system="triclinic", point_group="-1", cell=cell, orientation=orientation, absorption=None)
    epsilon = permittivity(medium(mineral, 589.3))
    alpha = np.array((np.cos(np.deg2rad(20.0)), np.sin(np.deg2rad(20.0)), 0.0))
    gamma = np.array((0.5 * np.cos(np.deg2rad(110.0)), 0.5 * np.sin(np.deg2rad(110.0)), np.sqrt(0.75)))
    for direction, n in ((alpha, 1.52), (gamma, 1.53), (np.cross(gamma, alpha), 1.523)):
        np.testing.assert_allclose(epsilon @ direction, n * n * direction, rtol=1e-14, atol=1e-14)


def test_waves_along_principal_directions_are_absorbed_by_their_coefficients() -> None:
    """A wave that goes along b and vibrates along Z is dimmed by a_γ = 0.3 + 3, one along X by 0.1 + 1."""
    crystal = medium(monoclinic(), 550.0)
    for wave in waves_along(crystal, B[:, None]):
        field = wave.e[:, 0].real
        expected = 3.3 if abs(field @ towards_a(52.0)) > 0.9 else 1.1
        assert absorption_along_ray(crystal, wave.k, wave.e)[0] == pytest.approx(expected, rel=1e-12)


def test_concentration_of_a_chromophore() -> None:
    a_alpha, a_beta, a_gamma = absorption_coefficients(monoclinic(), [500.0, 600.0], {"iron": 8.0}) or ()
    np.testing.assert_allclose(a_alpha, 0.1 + 4.0)
    np.testing.assert_allclose(a_beta, 0.2)
    np.testing.assert_allclose(a_gamma, 0.3 + 12.0)
    four_times = dissipation(medium(monoclinic(), 550.0, concentrations={"iron": 8.0}))
    once = dissipation(medium(monoclinic(), 550.0, concentrations={"iron": 2.0}))
    np.testing.assert_array_equal(once, dissipation(medium(monoclinic(), 550.0)))
    assert np.all(np.linalg.eigvalsh(four_times - once) > -1e-12)


@pytest.mark.parametrize(
    ("mineral", "concentrations", "said"),
    [
        (monoclinic(), {"copper": 1.0}, "iron"),
        (monoclinic(), {"iron": -1.0}, "iron"),
        (minerals_db.mineral("calcite"), {"iron": 1.0}, "calcite has no chromophores"),
    ],
)
def test_wrong_concentrations(mineral: minerals_db.Mineral, concentrations: dict[str, float], said: str) -> None:
    with pytest.raises(InputError, match=said) as caught:
        medium(mineral, 550.0, concentrations=concentrations)
    assert caught.value.faults[0].pointer == "/concentrations"


def test_absorption_on_a_frame_of_its_own() -> None:
    frame = {
        "parallel_to_b": "beta", "direction": "gamma", "from_axis": "c", "angle_deg": 30,
        "source": "me", "status": "estimated",
    }  # fmt: skip
    absorption = monoclinic().absorption
    assert absorption is not None
    mineral = monoclinic(absorption={**absorption.model_dump(mode="json", exclude_unset=True), "frame": frame})
    crystal = medium(mineral, 550.0)
    assert crystal.absorption_axes is not None
    np.testing.assert_allclose(crystal.absorption_axes[2], towards_a(30.0), atol=1e-15)
    np.testing.assert_allclose(permittivity(crystal), permittivity(medium(monoclinic(), 550.0)))


def test_axial_dispersion_as_published() -> None:
    """Topaz: 2V is larger in red, aragonite: in violet (A. Beer, Einleitung in die höhere Optik, 1853, pp. 380-381)."""
    topaz = axial_dispersion(minerals_db.mineral("topaz"), 589.3, 396.85)
    assert topaz.sense == "r>v"
    assert topaz.two_v_red_deg == pytest.approx(56.95, abs=0.1)
    assert topaz.two_v_violet_deg == pytest.approx(55.18, abs=0.1)
    aragonite = axial_dispersion(minerals_db.mineral("aragonite"), 656.28, 430.79)
    assert aragonite.sense == "r<v"
    assert aragonite.two_v_red_deg == pytest.approx(17.80, abs=0.1)
    assert aragonite.two_v_violet_deg == pytest.approx(18.29, abs=0.1)
    assert not topaz.crossed_planes


def test_axial_dispersion_without_dispersion_has_no_sense() -> None:
    found = axial_dispersion(monoclinic())
    assert found.sense is None
    assert found.two_v_red_deg == found.two_v_violet_deg
    with pytest.raises(InputError, match="no two optic axes"):
        axial_dispersion(minerals_db.mineral("calcite"))
