"""The independent interface solver against published values, classical formulas and conservation laws."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.reference.berreman import (
    Mode,
    cross,
    dot,
    lorentz_matrix,
    modes,
    scatter_reference,
    tensor_biaxial,
    tensor_uniaxial,
)

Array = NDArray[Any]
Z = np.array([0.0, 0.0, 1.0])
AIR = tensor_uniaxial(1.0, 1.0, Z)
N_O, N_E = 1.6584, 1.4864  # calcite, 589.3 nm
GOLDEN_AXIS = np.array([np.cos(np.pi / 6), np.sin(np.pi / 6), 1.0]) / np.sqrt(2)


def random_unit(rng: np.random.Generator) -> Array:
    v = rng.standard_normal(3)
    return np.asarray(v / np.linalg.norm(v))


def random_rotation(rng: np.random.Generator) -> Array:
    q, r = np.linalg.qr(rng.standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    return np.asarray(q * np.linalg.det(q))


def random_tangential(rng: np.random.Generator, normal: Array, largest: float) -> Array:
    v = np.cross(normal, random_unit(rng))
    return np.asarray(v / np.linalg.norm(v)) * rng.uniform(0, 0.999 * largest)


@pytest.mark.parametrize("digits", [None, 40])
def test_golden_air_to_calcite(digits: int | None) -> None:
    """Values confirmed by prtLab, pyrate, pyElli and GeneralTmm."""
    target = tensor_uniaxial(N_O, N_E, GOLDEN_AXIS, digits)
    result = scatter_reference(Z, np.array([0.5, 0, 0]), AIR, target, target_axis=GOLDEN_AXIS, digits=digits)
    ordinary, extraordinary = result.forward
    k_o, k_e = (np.array([float(x) for x in mode.k]) for mode in result.forward)
    np.testing.assert_allclose(k_o, [0.5, 0, 1.581230710554], rtol=0, atol=1e-12)
    np.testing.assert_allclose(k_e, [0.5, 0, 1.529032971460], rtol=0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(k_e), 1.608708123872, rtol=0, atol=1e-12)
    np.testing.assert_allclose(ordinary.ray, [0.301495417, 0, 0.953467626], rtol=0, atol=1e-9)
    expected = [0.241182822203, -0.069889615624, 0.967959858621]
    np.testing.assert_allclose(extraordinary.ray, expected, rtol=0, atol=1e-11)
    walk_off = np.degrees(np.arccos(extraordinary.ray @ k_e / np.linalg.norm(k_e)))
    np.testing.assert_allclose(walk_off, 5.742882, rtol=0, atol=1e-6)
    np.testing.assert_allclose(np.degrees(np.arcsin(-extraordinary.ray[1])), 4.007647, rtol=0, atol=1e-6)
    # [outgoing, incident] with (s, p) and (o, e)
    reflected = [[0.0811628663, 0.0000623979], [0.000288497951, 0.0337737125]]
    transmitted = [[0.477826885719, 0.458064137860], [0.440721750006, 0.508099751736]]
    np.testing.assert_allclose(result.power_reflected, reflected, rtol=0, atol=1e-10)
    np.testing.assert_allclose(result.power_transmitted, transmitted, rtol=0, atol=1e-12)
    # r_ss of the vector field; r_pp of the vector along (E x k), so the sign belongs to that frame
    r_ss = result.reflected[0, 0] * dot(result.backward[0].e, np.conj(result.incident[0].e))
    np.testing.assert_allclose(complex(r_ss), -0.284890973, rtol=0, atol=1e-9)
    np.testing.assert_allclose(abs(complex(result.reflected[1, 1])), 0.183776257, rtol=0, atol=1e-9)


def test_walk_off_at_normal_incidence() -> None:
    axis = np.array([1.0, 0, 1.0])
    result = scatter_reference(Z, np.zeros(3), AIR, tensor_uniaxial(N_O, N_E, axis), target_axis=axis)
    ray = result.forward[1].ray
    # negative crystal: the ray leans away from the optic axis, tilted to +x
    assert ray[0] < 0
    np.testing.assert_allclose(np.degrees(np.arctan2(-ray[0], ray[2])), 6.2241176, rtol=0, atol=1e-7)
    np.testing.assert_allclose(-ray[0] / ray[2] * 10.0, 1.0906068, rtol=0, atol=1e-7)
    np.testing.assert_allclose(result.forward[0].ray, Z, rtol=0, atol=1e-12)


def test_fresnel_amplitudes_and_total_reflection_phase() -> None:
    """s: Y = q, p: Y = n^2/q, r of the tangential E = (Y1 - Y2)/(Y1 + Y2), with q2 = +i|q2| when totally reflected."""
    rng = np.random.default_rng(1)
    total = 0
    for _ in range(300):
        n1, n2 = rng.uniform(1, 2.5, 2)
        normal = random_unit(rng)
        kt = random_tangential(rng, normal, n1)
        result = scatter_reference(normal, kt, tensor_uniaxial(n1, n1, Z), tensor_uniaxial(n2, n2, Z))
        q1, q2 = np.sqrt(n1**2 - kt @ kt), np.sqrt(complex(n2**2 - kt @ kt))
        total += q2.imag > 0
        incident_s, incident_p = result.incident
        along = kt / np.linalg.norm(kt)
        r_s = result.reflected[0, 0] * dot(result.backward[0].e, np.conj(incident_s.e))
        r_p = result.reflected[1, 1] * dot(result.backward[1].e, along) / dot(incident_p.e, along)
        np.testing.assert_allclose(r_s, (q1 - q2) / (q1 + q2), rtol=0, atol=1e-12)
        y1, y2 = n1**2 / q1, n2**2 / q2
        np.testing.assert_allclose(r_p, (y1 - y2) / (y1 + y2), rtol=0, atol=1e-10)
        np.testing.assert_allclose(result.power_reflected[[0, 1], [1, 0]], 0, rtol=0, atol=1e-20)
    assert total > 20


def test_brewster() -> None:
    for n in (1.33, 1.5, 2.417):
        angle = np.arctan(n)
        result = scatter_reference(Z, np.array([np.sin(angle), 0, 0]), AIR, tensor_uniaxial(n, n, Z))
        assert result.power_reflected[1, 1] < 1e-28
        assert result.power_reflected[0, 0] == pytest.approx(((n**2 - 1) / (n**2 + 1)) ** 2, abs=1e-13)


def random_tensor(rng: np.random.Generator, kind: str) -> tuple[Array, float]:
    n = rng.uniform(1.0, 2.6, 3)
    if kind == "isotropic":
        n[:] = n[0]
    elif kind == "uniaxial":
        n[1] = n[0]
    return tensor_biaxial(n, random_rotation(rng)), float(n.max())


def test_energy_over_random_pairs() -> None:
    """Every lossless pair, biaxial ones too, total reflection included."""
    rng = np.random.default_rng(2)
    kinds = ("isotropic", "uniaxial", "biaxial")
    worst, counted, inhibited = 0.0, 0, 0
    for case in range(450):
        (first, largest), (second, _) = (random_tensor(rng, kinds[i]) for i in (case % 3, case // 3 % 3))
        normal = random_unit(rng)
        kt = random_tangential(rng, normal, largest)
        result = scatter_reference(normal, kt, first, second)
        if 0 < result.separation < 1e-2:
            result = scatter_reference(normal, kt, first, second, digits=40)
        kept = result.power_reflected.sum(axis=0) + result.power_transmitted.sum(axis=0)
        for j, mode in enumerate(result.incident):
            if mode.propagating:
                worst, counted = max(worst, abs(kept[j] - 1)), counted + 1
            else:
                inhibited += 1
    assert worst < 1e-12
    assert counted > 800
    assert inhibited > 10


def test_modes_satisfy_maxwell() -> None:
    rng = np.random.default_rng(3)
    for case in range(150):
        eps, largest = random_tensor(rng, ("isotropic", "uniaxial", "biaxial")[case % 3])
        normal = random_unit(rng)
        kt = random_tangential(rng, normal, largest)
        forward, backward = modes(eps, normal, kt)
        for mode in (*forward, *backward):
            np.testing.assert_allclose(cross(mode.k, mode.h), -eps @ mode.e, rtol=0, atol=1e-11)
            np.testing.assert_allclose(mode.k - dot(mode.k, normal) * normal, kt, rtol=0, atol=1e-13)
            np.testing.assert_allclose(np.linalg.norm(mode.e), 1, rtol=0, atol=1e-13)
        assert all(m.flux > 0 for m in forward if m.propagating)
        assert all(m.k @ normal == pytest.approx(0) or (m.k @ normal).imag > 0 for m in forward if not m.propagating)


def partners(some: list[Mode], others: list[Mode]) -> tuple[list[int], Array]:
    """For each of some, the place of its reversed partner (-k, E) among the others, and the factor between the fields.

    Both fields are normalised by the Lorentz product: the factor is 1 or -1.
    """
    places, found = [], []
    for mode in some:
        place = int(np.argmin([np.linalg.norm(m.k + mode.k) for m in others]))
        np.testing.assert_allclose(others[place].k, -mode.k, rtol=0, atol=1e-9)
        pivot = int(np.argmax(np.abs(mode.e)))
        found.append(others[place].e[pivot] / mode.e[pivot])
        places.append(place)
    signs = np.array(found)
    np.testing.assert_allclose(signs**2, 1, rtol=0, atol=1e-9)
    return places, np.round(signs.real)


def test_reciprocity() -> None:
    """S of the reversed waves is the transpose of S, evanescent and absorbed waves included."""
    rng = np.random.default_rng(4)
    worst = 0.0
    for case in range(150):
        (first, largest), (second, _) = (
            random_tensor(rng, ("uniaxial", "biaxial")[i]) for i in (case % 2, case // 2 % 2)
        )
        if case % 3 == 0:
            rotation = random_rotation(rng)
            second = second + 1j * rotation @ np.diag(rng.uniform(0.01, 0.5, 3)) @ rotation.T
        normal = random_unit(rng)
        kt = random_tangential(rng, normal, 1.3 * largest if case % 5 == 0 else largest)
        s, entering, leaving = lorentz_matrix(normal, kt, first, second)
        back, entering_back, leaving_back = lorentz_matrix(normal, -kt, first, second)

        to_in, sign_in = partners(leaving, entering_back)
        to_out, sign_out = partners(entering, leaving_back)
        reversed_s = back[np.ix_(to_out, to_in)] * sign_out[:, None] / sign_in[None, :]
        worst = max(worst, float(np.abs(reversed_s - s.T).max()))
    assert worst < 1e-10


def test_many_digits_agree_with_double() -> None:
    rng = np.random.default_rng(5)
    for _ in range(8):
        axis = random_unit(rng)
        second_axis = random_unit(rng)
        normal, pair = random_unit(rng), rng.uniform(1.2, 2.2, (2, 2))
        kt = random_tangential(rng, normal, pair[0].max())
        plain, exact = (
            scatter_reference(
                normal,
                kt,
                tensor_uniaxial(pair[0, 0], pair[0, 1], axis, digits),
                tensor_uniaxial(pair[1, 0], pair[1, 1], second_axis, digits),
                source_axis=axis,
                target_axis=second_axis,
                digits=digits,
            )
            for digits in (None, 40)
        )
        np.testing.assert_allclose(plain.power_reflected, exact.power_reflected, rtol=0, atol=1e-11)
        np.testing.assert_allclose(plain.power_transmitted, exact.power_transmitted, rtol=0, atol=1e-11)
        for ours, theirs in zip(plain.forward, exact.forward, strict=True):
            np.testing.assert_allclose(ours.ray, theirs.ray, rtol=0, atol=1e-11)
        kept = exact.power_reflected.sum(axis=0) + exact.power_transmitted.sum(axis=0)
        assert all(abs(kept[j] - 1) < 1e-15 for j in (0, 1) if exact.incident[j].propagating)


def test_isotropic_limit_is_continuous() -> None:
    """Total powers jump nowhere as n_e goes to n_o."""
    kt, n = np.array([0.6, 0.1, 0]), 1.55
    glass = scatter_reference(Z, kt, AIR, tensor_uniaxial(n, n, Z))
    for split in (1e-3, 1e-7, 1e-7, 1e-10, 1e-13):
        near = scatter_reference(Z, kt, AIR, tensor_uniaxial(n, n + split, GOLDEN_AXIS))
        gap = near.power_reflected.sum(axis=0) - glass.power_reflected.sum(axis=0)
        assert np.abs(gap).max() < 2 * split + 1e-12


def test_internal_conical_refraction_of_aragonite() -> None:
    """Rays of waves all but along a biaxial optic axis fill a cone; its full angle is 1.882 degrees in aragonite."""
    a, b, c = 1.5300, 1.6810, 1.6854
    tan_v = np.sqrt((a**-2 - b**-2) / (b**-2 - c**-2))
    v = np.arctan(tan_v)  # from z, towards x
    assert np.degrees(2 * min(v, np.pi / 2 - v)) == pytest.approx(18.03, abs=0.01)
    axis = np.array([np.sin(v), 0, np.cos(v)])
    across = np.array([np.cos(v), 0, -np.sin(v)])
    eps = tensor_biaxial((a, b, c), np.eye(3))
    rays = [m.ray for s in (1, -1) for m in modes(eps, axis, s * 1e-7 * across, digits=40)[0]]
    rays += [m.ray for m in modes(eps, axis, 1e-7 * np.array([0, 1.0, 0]), digits=40)[0]]
    spread = max(np.degrees(np.arccos(min(1.0, float(p @ q)))) for p in rays for q in rays)
    assert spread == pytest.approx(1.882, abs=1e-3)
