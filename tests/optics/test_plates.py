"""Stacks of plates against closed forms, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from crystal_core.errors import InputError
from crystal_core.optics.medium import Medium
from crystal_core.optics.plates import Coherence, Plate, StackOptics, plate_stack

WAVELENGTHS = np.linspace(400.0, 700.0, 31)
MODES: tuple[Coherence, ...] = ("exact", "single-pass", "incoherent")
X, Y, Z = np.eye(3)


def jones(optics: StackOptics) -> tuple[np.ndarray, np.ndarray]:
    assert optics.jones_transmitted is not None
    assert optics.jones_reflected is not None
    return optics.jones_transmitted, optics.jones_reflected


def fresnel(n1: float, n2: float, kappa: float) -> tuple[complex, complex]:
    """r_p, r_s with p = (q, 0, −κ)/n in both directions."""
    q1, q2 = np.sqrt(n1**2 - kappa**2 + 0j), np.sqrt(n2**2 - kappa**2 + 0j)
    return (n2**2 * q1 - n1**2 * q2) / (n2**2 * q1 + n1**2 * q2), (q1 - q2) / (q1 + q2)


def airy(n1: float, n2: float, kappa: float, k0d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Transmission and reflection of a slab, for p and s: Born & Wolf, 7th ed., §1.6.4, eqs. 55–58."""
    r = np.array(fresnel(n1, n2, kappa))[:, None]
    beta = k0d * np.sqrt(n2**2 - kappa**2 + 0j)
    once, twice = np.exp(1j * beta), np.exp(2j * beta)
    return (1 - r**2) * once / (1 - r**2 * twice), r * (1 - twice) / (1 - r**2 * twice)


@pytest.mark.parametrize("kappa", [0.0, 0.7, 1.1, 1.45])
@pytest.mark.parametrize(("n1", "n2"), [(1.5, 1.0), (1.5, 2.4), (1.5, 1.5)])
def test_isotropic_slab_is_airys(n1: float, n2: float, kappa: float) -> None:
    """Frustrated total reflection included: κ > 1 in a gap of air."""
    t, r = jones(plate_stack([Plate(Medium.isotropic(n2), 0.7)], WAVELENGTHS, n1, (kappa, 0.0, 0.0)))
    expected_t, expected_r = airy(n1, n2, kappa, 2e3 * np.pi * 0.7 / WAVELENGTHS)
    for i in (0, 1):
        np.testing.assert_allclose(t[i, i], expected_t[i], rtol=0, atol=2e-13)
        np.testing.assert_allclose(r[i, i], expected_r[i], rtol=0, atol=2e-13)
    assert np.abs(t[0, 1]).max() < 1e-14
    assert np.abs(r[1, 0]).max() < 1e-14


def test_signs_of_reflection_at_normal_incidence() -> None:
    """r_s = −0.2 but r_p = +0.2 on thick glass: both stand for the same reversal of the field."""
    opaque = Medium.isotropic(1.5, 20.0)
    _, r = jones(plate_stack([Plate(opaque, 2000.0)], [589.3]))
    np.testing.assert_allclose(r[:, :, 0], np.diag((0.2, -0.2)), atol=1e-3)


@pytest.mark.parametrize("coherent", MODES)
def test_no_plates_and_plates_of_the_mount_change_nothing(coherent: Coherence) -> None:
    nothing = plate_stack([], WAVELENGTHS, 1.5, (0.4, 0.3, 0.0), coherent)
    same = plate_stack([Plate(Medium.isotropic(1.5), 20.0)], WAVELENGTHS, 1.5, (0.4, 0.3, 0.0), coherent)
    for optics in (nothing, same):
        np.testing.assert_allclose(optics.mueller_transmitted, np.eye(4)[:, :, None] * np.ones(31), atol=1e-12)
        np.testing.assert_allclose(optics.mueller_reflected, 0.0, atol=1e-13)


def test_incoherent_slab_is_the_geometric_series() -> None:
    """T = (1 − R)² A/(1 − R² A²), A the loss of one way, s and p each for itself."""
    kappa, absorption = 0.8, 5.0
    slab = Plate(Medium.isotropic(1.6, absorption), 300.0)
    loss = np.exp(-absorption * 0.3 / np.sqrt(1 - (kappa / 1.6) ** 2))
    for coherent in ("single-pass", "incoherent"):
        optics = plate_stack([slab], [550.0], 1.0, (kappa, 0.0, 0.0), coherent)
        for sign, r in zip((1, -1), fresnel(1.0, 1.6, kappa), strict=True):
            R = abs(r) ** 2
            expected = (1 - R) ** 2 * loss / (1 - (R * loss) ** 2)
            light = np.array((1.0, sign, 0.0, 0.0))
            passed = optics.mueller_transmitted[:, :, 0] @ light
            thrown = optics.mueller_reflected[:, :, 0] @ light
            # (ε″/ε′)² = 1e-7 is all by which an absorption coefficient may differ from a damped wave's
            assert passed[0] == pytest.approx(expected, abs=2e-8)
            assert thrown[0] == pytest.approx(R + (1 - R) ** 2 * R * loss**2 / (1 - (R * loss) ** 2), abs=2e-8)


def test_thick_plates_between_crossed_polars_show_half_when_phases_are_averaged() -> None:
    """An axis at 45° in the plane, index-matched: linear light loses all its polarization."""
    plate = Plate(Medium.uniaxial(1.5, 1.5 + 1e-6, (X + Y) / np.sqrt(2)), 1000.0)
    m = plate_stack([plate], [550.0], 1.5, coherent="incoherent").mueller_transmitted[:, :, 0]
    np.testing.assert_allclose(m, np.diag((1.0, 0.0, 1.0, 0.0)), atol=1e-6)


def test_section_across_the_optic_axis_stays_polarized_when_phases_are_averaged() -> None:
    plate = Plate(Medium.uniaxial(1.5442, 1.5533, Z), 1000.0)
    m = plate_stack([plate], [550.0], 1.0, coherent="incoherent").mueller_transmitted[:, :, 0]
    np.testing.assert_allclose(m / m[0, 0], np.eye(4), atol=1e-13)


@pytest.mark.parametrize("coherent", MODES)
def test_polaroid(coherent: Coherence) -> None:
    """A plate that absorbs what vibrates along y passes x: the frame of the absorption is not the transposed one."""
    axes = np.array(((0.6, 0.8, 0.0), (-0.8, 0.6, 0.0), (0.0, 0.0, 1.0)))
    medium = Medium.isotropic(1.5).absorbing((0.0, 800.0, 800.0), axes)
    m = plate_stack([Plate(medium, 30.0)], [550.0], 1.5, coherent=coherent).mueller_transmitted[:, :, 0]
    along = 2 * np.arctan2(0.8, 0.6)
    light = np.array((1.0, np.cos(along), np.sin(along), 0.0))
    np.testing.assert_allclose(m @ light, light, atol=2e-3)
    assert (m @ (light * (1, -1, -1, 0)))[0] < 1e-8


@pytest.mark.parametrize("coherent", MODES)
@pytest.mark.parametrize("kappa", [0.0, 0.9])
def test_centimetres_of_a_strong_absorber_are_black_not_infinite(coherent: Coherence, kappa: float) -> None:
    turn = np.array(((0.6, 0.8, 0.0), (-0.48, 0.36, 0.8), (0.64, -0.48, 0.6)))
    medium = Medium.biaxial((1.5, 1.6, 1.7), turn).absorbing((1e4, 2e4, 3e4), turn[::-1])
    stack = [Plate(Medium.isotropic(1.4), 5.0), Plate(medium, 1e4), Plate(Medium.isotropic(1.0), 1e4)]
    optics = plate_stack(stack, WAVELENGTHS, 1.3, (kappa, 0.0, 0.0), coherent)
    assert np.abs(optics.mueller_transmitted).max() < 1e-300
    assert np.all(np.isfinite(optics.mueller_reflected))
    assert np.all(optics.mueller_reflected[0, 0] < 0.3)


def test_two_plates_of_one_medium_are_one() -> None:
    turn = np.array(((0.6, 0.8, 0.0), (-0.48, 0.36, 0.8), (0.64, -0.48, 0.6)))
    medium = Medium.biaxial((1.5, 1.6, 1.7), turn, (10.0, 20.0, 30.0))
    for coherent in ("exact", "single-pass"):
        one = plate_stack([Plate(medium, 21.0)], WAVELENGTHS, 1.2, (0.3, 0.5, 0.0), coherent)
        two = plate_stack([Plate(medium, 13.0), Plate(medium, 8.0)], WAVELENGTHS, 1.2, (0.3, 0.5, 0.0), coherent)
        np.testing.assert_allclose(two.mueller_transmitted, one.mueller_transmitted, atol=3e-13)
        np.testing.assert_allclose(two.mueller_reflected, one.mueller_reflected, atol=3e-13)


def test_light_guide_that_no_light_can_enter() -> None:
    """Glass between gaps of air, beyond the critical angle: without tunnelling the guide is closed, not singular."""
    air, glass = Medium.isotropic(1.0), Medium.isotropic(1.5)
    stack = [Plate(air, 5.0), Plate(glass, 5.0), Plate(air, 5.0)]
    for coherent in MODES:
        optics = plate_stack(stack, WAVELENGTHS, 1.5, (1.3, 0.0, 0.0), coherent)
        np.testing.assert_allclose(optics.mueller_reflected[0, 0], 1.0, atol=1e-12)


def test_batches_do_not_depend_on_their_length() -> None:
    medium = Medium.uniaxial(np.linspace(1.66, 1.64, 31), np.linspace(1.49, 1.48, 31), (X + Z) / np.sqrt(2), (1.0, 9.0))
    kt = np.stack((np.linspace(0, 0.9, 31), np.linspace(0, 0.2, 31), np.zeros(31)))
    for coherent in MODES:
        whole = plate_stack([Plate(medium, 30.0)], WAVELENGTHS, 1.54, kt, coherent)
        part = slice(7, 11)
        some = plate_stack([Plate(medium.take(part), 30.0)], WAVELENGTHS[part], 1.54, kt[:, part], coherent)
        assert np.array_equal(some.mueller_transmitted, whole.mueller_transmitted[:, :, part])
        assert np.array_equal(some.mueller_reflected, whole.mueller_reflected[:, :, part])


@pytest.mark.parametrize(
    ("change", "pointer"),
    [
        ({"wavelength_nm": [0.0]}, "/wavelength_nm"),
        ({"wavelength_nm": [np.nan]}, "/wavelength_nm"),
        ({"mount_index": 0.0}, "/mount_index"),
        ({"mount_index": [1.0, 1.0]}, "/mount_index"),
        ({"tangential_k": (0.1, 0.0, 0.1)}, "/tangential_k"),
        ({"tangential_k": (1.0, 0.0, 0.0)}, "/tangential_k"),
        ({"tangential_k": (np.inf, 0.0, 0.0)}, "/tangential_k"),
        ({"tangential_k": (0.1, 0.0)}, "/tangential_k"),
        ({"coherent": "perhaps"}, "/coherent"),
        ({"plates": [Plate(Medium.isotropic([1.5, 1.6]), 1.0)]}, "/plates/0"),
    ],
)
def test_bad_input_is_named(change: dict[str, object], pointer: str) -> None:
    good: dict[str, object] = {"plates": [Plate(Medium.isotropic(1.5), 1.0)], "wavelength_nm": [550.0]}
    with pytest.raises(InputError) as caught:
        plate_stack(**{**good, **change})  # type: ignore[arg-type]
    assert [fault.pointer for fault in caught.value.faults] == [pointer]


@pytest.mark.parametrize("thickness", [0.0, -1.0, np.nan, np.inf])
def test_bad_thickness_is_named(thickness: float) -> None:
    with pytest.raises(InputError, match="/thickness_um"):
        Plate(Medium.isotropic(1.5), thickness)
