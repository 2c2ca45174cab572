"""What docs/errata.md says holds, and that it prints the numbers which the library gives."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import minimize

from crystal_core.optics import Coherency, Medium, Wave, absorption_along_ray, scatter
from crystal_core.optics.indicatrix import dissipation, permittivity
from crystal_core.optics.mueller import degree_of_polarization
from crystal_core.spectra.colour import xyz_to_linear_srgb
from crystal_core.spectra.illuminants import d65
from crystal_core.spectra.observer import colour_matching
from tests.docs.blocks import ROOT, section

Real = NDArray[np.float64]

PAGE = "docs/errata.md"
AIR = Medium.isotropic(1.0)
N_O, N_E = 1.6584, 1.4864
NORMAL = np.array((0.0, 0.0, 1.0))


def told(heading: str) -> str:
    """Return what the page says under a heading."""
    return section(PAGE, heading)


def inclined(degrees: float) -> Real:
    """Return the unit vector that makes an angle with +z, towards x."""
    return np.array((np.sin(np.deg2rad(degrees)), 0.0, np.cos(np.deg2rad(degrees))))


def tourmaline(axis: Real) -> Medium:
    return Medium.uniaxial(1.64, 1.62, axis, (3.0, 0.3))


def straight_into(medium: Medium) -> tuple[Wave, Wave]:
    """Return the two waves in a medium of light that falls on it along +z."""
    return scatter(NORMAL, np.zeros((3, 1)), AIR, medium).transmitted


def test_every_heading_of_the_table_has_its_number() -> None:
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    assert len(re.findall(r"^\| \[", text, re.MULTILINE)) == 10
    for name, number in (("calcite", f"n_o = {N_O}, n_e = {N_E}"), ("tourmaline", "n_o = 1.64, n_e = 1.62")):
        assert number in text, name


# Huygens and Maxwell


def huygens_ray(eps: Real, tangential_k: Real, sheet: int) -> Real:
    """Return the ray of a front that sweeps the face z = 0, by the earliest of all wavelets at a point inside.

    The wavelet in direction t is 1/n_t, n_t² the eigenvalues of ε on the plane across t (the ray surface; sheet 0 is
    the fast one). No wave vector of the crystal is used.
    """

    def arrival(start: Real) -> float:
        path = target - np.array((start[0], start[1], 0.0))
        length = float(np.sqrt(path @ path))
        across = np.linalg.svd((path / length)[None, :])[2][1:]
        index = float(np.sqrt(np.linalg.eigvalsh(across @ eps @ across.T)[sheet]))
        return float(tangential_k[:2] @ start) + index * length

    target = np.array((0.0, 0.0, 1.0))
    best = minimize(arrival, np.zeros(2), method="Nelder-Mead", options={"xatol": 1e-11, "fatol": 1e-17})
    path = target - np.array((best.x[0], best.x[1], 0.0))
    return np.asarray(path / np.sqrt(path @ path))


def test_huygens_and_maxwell_at_45_degrees() -> None:
    axis = inclined(45.0)
    calcite = Medium.uniaxial(N_O, N_E, axis)
    by_maxwell = straight_into(calcite)[1].ray[:, 0]
    by_huygens = huygens_ray(permittivity(calcite), np.zeros(3), 0)
    np.testing.assert_allclose(by_huygens, by_maxwell, atol=1e-6)
    walk_off = np.rad2deg(np.arctan2(np.hypot(*by_maxwell[:2]), by_maxwell[2]))
    assert f"extraordinary ray {walk_off:.4f}° off it" in told("Huygens and Maxwell")


MEDIA = [
    Medium.uniaxial(N_O, N_E, np.array((0.48, 0.6, 0.64))),
    Medium.biaxial((1.53, 1.681, 1.6854), ((0.6, 0.48, 0.64), (-0.8, 0.36, 0.48), (0.0, -0.8, 0.6))),
]


@pytest.mark.parametrize("medium", MEDIA, ids=["calcite", "aragonite"])
def test_huygens_and_maxwell_at_slanting_incidence(medium: Medium) -> None:
    for kappa_x, kappa_y in ((0.5, 0.0), (0.3, -0.7), (-0.6, 0.5)):
        kt = np.array((kappa_x, kappa_y, 0.0))
        waves = scatter(NORMAL, kt[:, None], AIR, medium).transmitted
        by_maxwell = [wave.ray[:, 0] for wave in sorted(waves, key=lambda wave: float(wave.index[0]))]
        for sheet in (0, 1):
            by_huygens = huygens_ray(permittivity(medium), kt, sheet)
            np.testing.assert_allclose(by_huygens, by_maxwell[sheet], atol=1e-6)


# Absorption


def test_absorption_belongs_to_the_vibration() -> None:
    along_c = straight_into(tourmaline(NORMAL))
    crystal = tourmaline(NORMAL)
    seen = [absorption_along_ray(crystal, wave.k, wave.field)[0] for wave in along_c]
    assert seen == pytest.approx([3.0, 3.0])
    by_direction_of_ray = 3.0 * 0.0 + 0.3 * 1.0
    text = told("Which direction absorption belongs to")
    assert f"absorbed by {seen[0]:.0f} mm⁻¹" in text
    assert f"the formula gives {by_direction_of_ray:.1f} mm⁻¹" in text


@pytest.mark.parametrize(("n_o", "n_e", "place"), [(1.64, 1.62, "in the tourmaline"), (N_O, N_E, "calcite")])
def test_the_formula_is_a_limit(n_o: float, n_e: float, place: str) -> None:
    worst = {"E": 0.0, "D": 0.0}
    for degrees in np.linspace(0.5, 90.0, 180):
        axis = inclined(float(degrees))
        crystal = Medium.uniaxial(n_o, n_e, axis, (3.0, 0.3))
        wave = straight_into(crystal)[1]
        exact = absorption_along_ray(crystal, wave.k, wave.field)[0]
        e = wave.field[:, 0].real
        for name, d in (("E", e), ("D", permittivity(crystal) @ e)):
            cosine2 = (d @ axis) ** 2 / (d @ d)
            worst[name] = max(worst[name], abs((3.0 * (1 - cosine2) + 0.3 * cosine2) / exact - 1.0))
    digits = 2 if place != "calcite" else 1
    by_e, by_d = (f"{100 * worst[name]:.{digits}f} %" for name in "ED")
    expected = (
        f"is {by_e} in the tourmaline if d is the direction of E, and {by_d} if d is that of D"
        if place != "calcite"
        else f"With the indices of calcite it is {by_e} and {by_d}"
    )
    assert expected in told("Which direction absorption belongs to")


def test_symmetry_makes_two_coefficients_equal() -> None:
    axis = np.array((0.48, 0.6, 0.64))
    tensor = dissipation(tourmaline(axis))
    for angle in (0.3, np.pi / 3, 2.0):
        cross = np.cross(np.eye(3), axis)
        turn = np.cos(angle) * np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * np.outer(axis, axis)
        np.testing.assert_allclose(turn @ tensor @ turn.T, tensor, atol=1e-15 * float(np.linalg.norm(tensor)))
    np.testing.assert_allclose(np.linalg.eigvalsh(tensor), (1.62 * 0.3, 1.64 * 3.0, 1.64 * 3.0), rtol=1e-14)


def test_unpolarized_light_has_the_mean_of_transmittances() -> None:
    crystal = tourmaline(np.array((1.0, 0.0, 0.0)))
    entering = scatter(NORMAL, np.zeros((3, 1)), AIR, crystal)
    absorption = [absorption_along_ray(crystal, wave.k, wave.field)[0] for wave in entering.transmitted]
    assert absorption == pytest.approx([3.0, 0.3])
    shares = [0.5 * sum(power[0] for power in row) for row in entering.power_transmitted]
    assert shares == pytest.approx([0.5 * (1 - (0.64 / 2.64) ** 2), 0.5 * (1 - (0.62 / 2.62) ** 2)])
    text = told("The colour of unpolarized light")
    for thickness, words in (
        (1.0, "across its axis, it is {:.3f} instead of {:.3f}"),
        (3.0, "for 3 mm it is {:.3f} instead of {:.3f}"),
    ):
        mean = np.mean([np.exp(-a * thickness) for a in absorption])
        of_mean = np.exp(-np.mean(absorption) * thickness)
        assert mean > of_mean
        assert words.format(mean, of_mean) in text


# Polarization


def degree(c: Coherency) -> float:
    """Return √(1 − 4 det C/(tr C)²)."""
    determinant = c.xx * c.yy - c.xy_re**2 - c.xy_im**2
    result = float(np.sqrt(np.maximum(1.0 - 4.0 * determinant / c.intensity() ** 2, 0.0))[0])
    assert degree_of_polarization(c)[0] == pytest.approx(result, abs=1e-12)
    return result


def test_modes_are_polarized_and_their_sum_is_not() -> None:
    block = Medium.uniaxial(N_O, N_E, np.array((1.0, 0.0, 0.0)))
    entry = scatter(NORMAL, np.zeros((3, 1)), AIR, block)
    exit_ = scatter(NORMAL, np.zeros((3, 1)), block, AIR)
    s, p = (wave.field[:, 0].real for wave in exit_.transmitted)
    total = np.zeros((2, 2), np.complex128)
    shares = []
    for mode in (0, 1):
        inside = sum(power[0] for power in entry.power_transmitted[mode]) / 2.0
        field = sum(exit_.amplitude_transmitted[i][mode][0] * v[:2] for i, v in enumerate((s, p)))
        out = inside * sum(exit_.power_transmitted[i][mode][0] for i in (0, 1))
        matrix = out * np.outer(field, field.conj()) / np.sum(np.abs(field) ** 2)
        assert abs(np.linalg.det(matrix)) < 1e-15  # one field: fully polarized
        shares.append(2.0 * out)
        total += matrix
    light = Coherency(
        *(np.array([v]) for v in (total[0, 0].real, total[1, 1].real, total[0, 1].real, total[0, 1].imag))
    )
    assert degree(light) == pytest.approx((shares[1] - shares[0]) / (shares[1] + shares[0]))
    text = told("Polarization of what leaves a crystal")
    assert f"comes out with {shares[0]:.4f} of its half, the extraordinary one with {shares[1]:.4f}" in text
    assert f"degree of polarization is their difference over their sum, {degree(light):.4f}" in text


def test_the_degree_of_polarization_does_not_depend_on_the_frame() -> None:
    angle = np.deg2rad(20.0)
    linear = Coherency.pure(np.array([np.cos(angle)]), np.array([np.sin(angle)]), np.array([0.7]))
    light = Coherency(linear.xx + 0.15, linear.yy + 0.15, linear.xy_re, linear.xy_im)
    sizes = []
    for degrees in (0.0, 20.0, 65.0):
        turn = np.deg2rad([degrees])
        turned = light.rotated(np.cos(turn), np.sin(turn))
        sizes.append(float(np.hypot(turned.xy_re, turned.xy_im)[0]))
        assert degree(turned) == pytest.approx(0.7, abs=1e-14)
    text = told("The degree of polarization")
    first, second, third = (f"{size:.3f}" for size in sizes)
    assert f"is {first} in the frame x, y; turned by 20° it is {second}, and by 65° it is {third}" in text
    assert f"P = {degree(light):.4f} in all of them" in text


# Daylight


def planck(wavelength_nm: Real, temperature_k: float) -> Real:
    """Return the spectrum of a black body, per wavelength (c₂ of the CODATA of 2018)."""
    return np.asarray(wavelength_nm**-5.0 / np.expm1(1.438776877e7 / (wavelength_nm * temperature_k)))


def test_d65_is_not_a_black_body() -> None:
    wavelengths = np.arange(360.0, 831.0)
    daylight = d65(wavelengths)
    body = 100.0 * planck(wavelengths, 6504.0) / planck(np.array(560.0), 6504.0)
    xyz = [np.sum(colour_matching(wavelengths) * spectrum, axis=-1) for spectrum in (daylight, body)]
    (day_x, day_y), (body_x, body_y) = (v[:2] / np.sum(v) for v in xyz)
    text = told("Daylight")
    assert f"D65 is at (x, y) = ({day_x:.4f}, {day_y:.4f})" in text
    assert f"a black body of 6504 K at ({body_x:.4f}, {body_y:.4f})" in text
    assert f"by {np.hypot(day_x - body_x, day_y - body_y):.4f} away" in text
    red, green, blue = xyz_to_linear_srgb(xyz[1] / xyz[1][1])
    assert f"colour ({red:.3f}, {green:.3f}, {blue:.3f})" in text
    at_400 = wavelengths == 400.0
    assert f"D65 has {daylight[at_400][0]:.1f} at 400 nm and the black body {body[at_400][0]:.1f}" in text
    seen = (wavelengths >= 380.0) & (wavelengths <= 780.0)
    ratio = (daylight / body)[seen]
    assert f"goes from {ratio.min():.2f} to {ratio.max():.2f} between 380 and 780 nm" in text


def test_the_nearest_black_body_is_that_of_6504_k() -> None:
    wavelengths = np.arange(360.0, 831.0)

    def uv(spectrum: Real) -> Real:
        """Return the CIE 1960 coordinates, in which "nearest" is meant."""
        x, y, z = np.sum(colour_matching(wavelengths) * spectrum, axis=-1)
        return np.asarray(np.array((4 * x, 6 * y)) / (x + 15 * y + 3 * z))

    temperatures = np.arange(6400.0, 6600.0, 1.0)
    away = [float(np.linalg.norm(uv(planck(wavelengths, t)) - uv(d65(wavelengths)))) for t in temperatures]
    assert temperatures[int(np.argmin(away))] == pytest.approx(6504.0, abs=3.0)
