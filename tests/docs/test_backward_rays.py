"""What docs/backward-rays.md says holds, and that it prints the numbers which the library gives."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crystal_core.optics import Medium, scatter
from crystal_core.optics.curvature import gaussian_curvature
from crystal_core.optics.indicatrix import permittivity
from crystal_core.optics.mueller import reversed_mueller
from tests.docs.blocks import ROOT, section
from tests.docs.reversed_paths import AIR, Glass, Paths, across, dot, reversed_pair, units

Real = NDArray[np.float64]
Array = NDArray[Any]

PAGE = "docs/backward-rays.md"
N_O, N_E = 1.6584, 1.4864
NORMAL = np.array((0.0, 0.0, 1.0))


def told(heading: str) -> str:
    """Return what the page says under a heading."""
    return section(PAGE, heading)


# Which plane


def in_air(tangential: Real) -> Real:
    """Return directions in air along +z, NaN where there is none."""
    rest = 1.0 - dot(tangential, tangential)
    with np.errstate(invalid="ignore"):
        return np.asarray(tangential + NORMAL[:, None] * np.sqrt(rest))


def angle_deg(a: Real, b: Real) -> Real:
    return np.asarray(np.rad2deg(2.0 * np.arcsin(np.sqrt(dot(a - b, a - b)) / 2.0)))


def vector(v: Real) -> str:
    return "(" + ", ".join(f"{x:.4f}".replace("-", "−") for x in v) + ")"


def test_the_worked_example() -> None:
    axis = np.array((np.sqrt(6.0), np.sqrt(2.0), np.sqrt(8.0))) / 4.0
    calcite = Medium.uniaxial(N_O, N_E, axis)
    kt = np.array(((0.5,), (0.0,), (0.0,)))
    wave = scatter(NORMAL, kt, AIR, calcite).transmitted[1]
    k, ray = wave.k, wave.ray
    leaving = scatter(NORMAL, kt, calcite, AIR).transmitted[0].ray
    by_paper = in_air(across(wave.index * ray, NORMAL[:, None]))
    other = in_air(np.sqrt(dot(kt, kt)) * across(ray, NORMAL[:, None]) / np.sqrt(dot(ray[:2], ray[:2])))

    # Backward through either face: -k has -ray, and comes out along the light that came.
    back = scatter(-NORMAL, -kt, AIR, calcite).transmitted[1]
    np.testing.assert_allclose(back.k, -k, atol=1e-15)
    np.testing.assert_allclose(back.ray, -ray, atol=1e-15)
    out = scatter(-NORMAL, -kt, calcite, AIR).transmitted[0].ray
    np.testing.assert_allclose(out, -in_air(kt), atol=1e-15)

    text = told("The exit lies in the plane of k and the normal")
    for direction in (k, ray, leaving, by_paper, other):
        assert vector(direction[:, 0]) in text
    assert f"{np.rad2deg(np.arctan2(-ray[1, 0], ray[0, 0])):.2f}° out of" in text
    errors = [f"{angle_deg(d, leaving)[0]:.2f}°" for d in (by_paper, other)]
    assert all(f"| {error} |" in text for error in errors)
    drawn = (ROOT / "docs" / "pictures" / "backward-rays.svg").read_text(encoding="utf-8")
    for shown in (vector(k[:, 0]), vector(ray[:, 0]), vector(by_paper[:, 0]), f"wrong by {errors[0]}"):
        assert shown in drawn.replace("</tspan><tspan>", "")


def test_how_wrong_the_rule_of_the_paper_is() -> None:
    count = 100_000
    rng = np.random.default_rng(2026)
    # Light of a uniform sky: equal shares of the disc of tangential k. Axes in all directions.
    radius, turn = np.sqrt(rng.uniform(size=count)), rng.uniform(0.0, 2.0 * np.pi, count)
    kt = np.stack((radius * np.cos(turn), radius * np.sin(turn), np.zeros(count)))
    event = scatter(NORMAL, kt, Medium.uniaxial(N_O, N_E, units(rng, count)), AIR)
    wave, right = event.incident[1], event.transmitted[0].ray
    side = across(wave.ray, NORMAL[:, None])
    text = told("The exit lies in the plane of k and the normal")
    for name, tangential in (
        ("the angle of the ray", wave.index * side),
        ("the angle of the wave vector", radius * side / np.sqrt(dot(side, side))),
    ):
        error = angle_deg(in_air(tangential), right)
        lost = np.isnan(error)
        worst = error[~lost]
        row = f"| {np.mean(worst):.1f}° | {np.quantile(worst, 0.95):.1f}° | {np.max(worst):.0f}° |"
        row += f" {100 * np.mean(lost):.0f} % |"
        assert f"{name} {row}" in text
        # Of so many rays the mean is known far better than to the digit that is printed.
        assert np.std(worst) / np.sqrt(len(worst)) < 0.02
    np.testing.assert_allclose(event.incident[0].ray * N_O, event.incident[0].k, atol=1e-14)  # ordinary: no error


def test_a_biaxial_crystal_spares_neither_wave() -> None:
    count = 100_000
    rng = np.random.default_rng(2027)
    radius, turn = np.sqrt(rng.uniform(size=count)), rng.uniform(0.0, 2.0 * np.pi, count)
    kt = np.stack((radius * np.cos(turn), radius * np.sin(turn), np.zeros(count)))
    first, helper = units(rng, count), units(rng, count)
    second = np.cross(first, helper, axis=0)
    second /= np.sqrt(dot(second, second))
    axes = np.stack((first, second, np.cross(first, second, axis=0)))
    event = scatter(NORMAL, kt, Medium.biaxial((1.53, 1.681, 1.6854), axes), AIR)
    means = []
    for wave in event.incident:
        error = angle_deg(in_air(wave.index * across(wave.ray, NORMAL[:, None])), event.transmitted[0].ray)
        means.append(float(np.nanmean(error)))
    said = f"is {means[0]:.1f}° for the slow wave and {means[1]:.1f}° for the fast one"
    assert said in told("The exit lies in the plane of k and the normal")


# Polarization


PAULI = np.array(([[1, 0], [0, 1]], [[1, 0], [0, -1]], [[0, 1], [1, 0]], [[0, -1j], [1j, 0]]), np.complex128)
"""C = ½ Σ S_i σ_i with the signs of docs/conventions.md: S3 = −2 Im C_xy."""

REVERSE = np.diag((1.0, 1.0, -1.0, 1.0))
FLIP = np.diag((1.0, -1.0)).astype(np.complex128)
"""From the axes of the forward light to a right-handed frame of the backward light: y turns round."""


def mueller(jones: Array) -> Real:
    """Return M_ij = ½ tr(σ_i J σ_j J†), shape (N, 4, 4)."""
    return np.asarray(0.5 * np.einsum("iab,nbc,jcd,nad->nij", PAULI, jones, PAULI, jones.conj()).real)


def test_paths_are_reversible() -> None:
    for seed, modes in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
        paths = Paths(20 + seed, *modes)
        _, home = paths.backward()
        np.testing.assert_allclose(home, -paths.start, rtol=0, atol=1e-12)
        for there, back in zip(*paths.rays(), strict=True):
            assert there.shape[1] > 500
            np.testing.assert_allclose(back, -there, rtol=0, atol=1e-12)


def test_pauli_matrices_have_the_signs_of_stokes() -> None:
    circular = np.outer((1.0, 1j), (1.0, -1j)) / 2.0
    assert np.einsum("iab,ba->i", PAULI, circular).real == pytest.approx((1.0, 0.0, 0.0, 1.0))


KINDS: list[tuple[str, Callable[[], Paths | Glass]]] = [
    ("one mode of a crystal, reflected into the same", lambda: Paths(1, 1, 1)),
    ("one mode of a crystal, reflected into the other", lambda: Paths(2, 0, 1)),
    ("glass, two total reflections", Glass),
]


@pytest.mark.parametrize(("name", "paths"), KINDS, ids=[name for name, _ in KINDS])
def test_reciprocity_of_matrices(name: str, paths: Callable[[], Paths | Glass]) -> None:
    forth, back = reversed_pair(paths())
    # A field has no absolute sign, nor has a path of one mode.
    size = np.sqrt(np.sum(np.abs(forth) ** 2, axis=(1, 2), keepdims=True))
    transposed = np.swapaxes(forth, 1, 2)
    off = np.minimum(*(np.max(np.abs(back - sign * transposed) / size, axis=(1, 2)) for sign in (1, -1)))
    assert off.max() < 1e-10

    m_f, m_b = mueller(forth), mueller(FLIP @ back @ FLIP)
    scale = m_f[:, :1, :1]
    m_t = np.swapaxes(m_f, 1, 2)
    assert np.max(np.abs(m_b - REVERSE @ m_t @ REVERSE) / scale) < 1e-10
    np.testing.assert_allclose(np.moveaxis(reversed_mueller(np.moveaxis(m_f, 0, -1)), -1, 0), REVERSE @ m_t @ REVERSE)
    without, same = (float(np.median(np.max(np.abs(m_b - wrong) / scale, axis=(1, 2)))) for wrong in (m_t, m_f))
    assert f"| {name} | {without:.2f} | {same:.2f} |" in told("Polarization goes backward by the adjoint")


@pytest.mark.parametrize("paths", [KINDS[1][1], KINDS[2][1]], ids=["crystal", "glass"])
def test_importance_goes_backward_by_the_adjoint(paths: Callable[[], Paths | Glass]) -> None:
    forth, back = reversed_pair(paths())
    rng = np.random.default_rng(8)
    importance, light = (hermitian(rng, len(forth)) for _ in range(2))
    adjoint = np.swapaxes(forth.conj(), 1, 2)
    measured = trace(importance, forth @ light @ adjoint)
    scale = mueller(forth)[:, 0, 0]
    np.testing.assert_allclose(trace(adjoint @ importance @ forth, light) / scale, measured / scale, atol=1e-12)
    # The ray that is traced carries conj(W), by the rules of light.
    carried = back @ importance.conj() @ np.swapaxes(back.conj(), 1, 2)
    np.testing.assert_allclose(trace(carried.conj(), light) / scale, measured / scale, atol=1e-10)
    text = told("Polarization goes backward by the adjoint")
    left = np.median(np.abs(trace(forth @ importance @ adjoint, light) - measured) / scale)
    plain = np.median(np.abs(trace(back @ importance @ np.swapaxes(back.conj(), 1, 2), light) - measured) / scale)
    name = "glass" if paths is Glass else "crystal"
    assert f"{left:.2f} in the {name}" in text
    if paths is Glass:
        assert f"Without the conjugate it is {plain:.2f} off" in text
    else:
        assert plain < 0.05 * left


def hermitian(rng: np.random.Generator, count: int) -> Array:
    """Return fully polarized coherency matrices or importances of trace 1, of all states alike, shape (count, 2, 2)."""
    e = rng.normal(size=(count, 2)) + 1j * rng.normal(size=(count, 2))
    e /= np.sqrt(np.sum(np.abs(e) ** 2, axis=1, keepdims=True))
    return np.asarray(e[:, :, None] * e[:, None, :].conj())


def trace(a: Array, b: Array) -> Real:
    """Return tr(a b), real for Hermitian matrices."""
    return np.asarray(np.einsum("nij,nji->n", a, b).real)


# Radiance


def test_radiance_in_contact() -> None:
    text = told("Radiance")
    for name, n_o, n_e in (("calcite", N_O, N_E), ("quartz", 1.5442, 1.5533)):
        medium = Medium.uniaxial(n_o, n_e, NORMAL)
        values = []
        for degrees in (0.0, 45.0, 90.0):
            angle = np.deg2rad(degrees)
            s = np.array((np.sin(angle), 0.0, np.cos(angle)))
            n = n_o * n_e / np.hypot(n_o * s[0], n_e * s[2])
            values.append(float(gaussian_curvature(medium, n * s[:, None], "extraordinary")[0] * n * n))
            assert gaussian_curvature(medium, n_o * s[:, None], "ordinary")[0] * n_o**2 == pytest.approx(1.0)
        assert values[0] == pytest.approx((n_o / n_e) ** 4)
        assert values[2] == pytest.approx((n_e / n_o) ** 2)
        row = " | ".join(f"{value:.3f}" for value in values)
        assert f"| {name} | {row} |" in text


def test_curvature_turns_tangential_k_into_solid_angle() -> None:
    rng = np.random.default_rng(9)
    count, step = 500, 1e-5
    kt = 0.7 * np.sqrt(rng.uniform(size=count)) * np.stack(angles(rng, count))
    medium = Medium.uniaxial(N_O, N_E, units(rng, count))

    def waves(dx: float, dy: float) -> tuple[Any, Any]:
        return scatter(NORMAL, kt + np.array(((dx,), (dy,), (0.0,))), AIR, medium).transmitted

    for mode, name in enumerate(("ordinary", "extraordinary")):
        centre = waves(0.0, 0.0)[mode]
        along_x = (waves(step, 0.0)[mode].ray - waves(-step, 0.0)[mode].ray) / (2 * step)
        along_y = (waves(0.0, step)[mode].ray - waves(0.0, -step)[mode].ray) / (2 * step)
        solid_angle = dot(centre.ray, np.cross(along_x, along_y, axis=0))  # per d²k_t
        curvature = gaussian_curvature(medium, centre.k, name)
        np.testing.assert_allclose(np.abs(solid_angle) * centre.ray[2] / curvature, 1.0, rtol=1e-8)


def angles(rng: np.random.Generator, count: int) -> tuple[Real, Real, Real]:
    turn = rng.uniform(0.0, 2.0 * np.pi, count)
    return np.cos(turn), np.sin(turn), np.zeros(count)


def test_the_flux_through_a_face() -> None:
    """The area of the extraordinary sheet's shadow on the face, against ∫ n² cos dΩ over its rays."""
    told_numbers = []
    for degrees in (0.0, 45.0, 90.0):
        c = np.array((np.sin(np.deg2rad(degrees)), 0.0, np.cos(np.deg2rad(degrees))))
        medium = Medium.uniaxial(N_O, N_E, c)
        eps = permittivity(medium)
        steps = 400
        theta = (np.arange(steps) + 0.5) * np.pi / steps
        phi = (np.arange(2 * steps) + 0.5) * np.pi / steps
        polar, turn = (v.ravel() for v in np.meshgrid(theta, phi, indexing="ij"))
        s = np.stack((np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)))
        n = N_O * N_E / np.sqrt(np.einsum("in,ij,jn->n", s, eps, s))
        gradient = eps @ s
        ray = gradient / np.sqrt(dot(gradient, gradient))
        area = n**2 * np.sin(polar) * (np.pi / steps) ** 2 / dot(ray, s)
        shadow = np.where(ray[2] > 0, ray[2] * area, 0.0)
        curvature = gaussian_curvature(medium, n * s, "extraordinary")
        told_numbers.append(float(np.sum(n**2 * curvature * shadow) / np.sum(shadow)))
        if degrees == 0.0:
            assert np.sum(shadow) == pytest.approx(np.pi * N_E**2, rel=1e-4)  # the shadow is a disc
    along, inclined, across_ = (f"{100 * (value - 1):+.1f} %".replace("-", "−") for value in told_numbers)
    assert (
        f"is {along} off where the axis stands on the face, {inclined} at 45° and {across_} where it lies in it"
        in told("Radiance")
    )
