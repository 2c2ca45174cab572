"""Light that comes back from faces of optically active media, and through crystals of them."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from crystal_core.optics.arrays import Complex, Real
from crystal_core.optics.interface import Scattering, scatter
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Wave
from tests.optics.active_cases import (
    KINDS,
    PAIRS,
    SIDES,
    Setup,
    full_k,
    random_medium,
    random_setup,
    sized,
    units,
    waves_of,
)


def scattering_matrix(setup: Setup) -> tuple[Complex, list[Wave], list[Wave]]:
    """Return S between waves of unit flux, [out, in] (4, 4, N), NaN where one is evanescent, and both lists of waves.

    Waves 0 and 1 are in the source, 2 and 3 in the target; light comes from both sides.
    """
    front = setup.scatter()
    back = setup.from_behind().scatter()
    incoming, outgoing = [*front.incident, *back.incident], [*front.reflected, *front.transmitted]
    s = np.empty((4, 4, setup.normal.shape[1]), np.complex128)
    for side, result in enumerate((front, back)):
        own, other = result.amplitude_reflected, result.amplitude_transmitted
        other_waves = [*result.reflected, *result.transmitted]
        for i, j in itertools.product(range(4), (0, 1)):
            amplitude = own[i][j] if i < 2 else other[i - 2][j]
            place = i if side == 0 else (i + 2) % 4
            # Both calls find the same wave; its phase is that of the first.
            turn = np.sum(np.conj(outgoing[place].field) * other_waves[i].field, axis=0)
            scale = np.sqrt(
                np.abs(outgoing[place].flux) / np.where(result.incident[j].flux > 0, result.incident[j].flux, np.nan)
            )
            s[place, 2 * side + j] = amplitude * turn * np.where(outgoing[place].propagating, scale, np.nan)
    return s, incoming, outgoing


def _apart(setup: Setup) -> Setup:
    """Keep the faces at which waves are told apart: two that all but agree are known to rounding/(their distance)."""
    result, behind = setup.scatter(), setup.from_behind().scatter()
    kept = np.ones(setup.normal.shape[1], np.bool_)
    source, target = setup.source.gyration is not None, setup.target.gyration is not None
    for active_side, waves in (
        (source, (*result.incident, *result.reflected)),
        (target, (*result.transmitted, *behind.incident)),
    ):
        for one, other in itertools.combinations(waves, 2):
            gap = np.abs(full_k(one) - full_k(other)).max(axis=0)
            kept &= (gap > 2e-5) | (not active_side)
    for wave in waves_of(result):
        kept &= ~wave.propagating | (wave.flux > 1e-3) | (wave.flux < -1e-3)
    return setup.take(np.flatnonzero(kept))


@pytest.mark.parametrize(("source", "target"), PAIRS)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("size", [1e-1, 1e-4])
def test_reversed_scattering_is_the_transpose(source: str, target: str, side: str, size: float) -> None:
    """The partner of (k, E) is (−k, E*), with the ray reversed: between these S(reversed) = Sᵀ, and S†S = 1."""
    setup = _apart(random_setup(4, source, target, 300, sized(side, size)))
    s, incoming, outgoing = scattering_matrix(setup)
    there = Setup(setup.normal, -setup.tangential, setup.source, setup.target)
    back, incoming_back, outgoing_back = scattering_matrix(there)
    phases = []
    for ours, partners in ((outgoing, incoming_back), (incoming, outgoing_back)):
        for wave, partner in zip(ours, partners, strict=True):
            free = wave.propagating
            np.testing.assert_array_equal(partner.propagating, free)
            np.testing.assert_allclose(partner.k[:, free], -wave.k[:, free], atol=1e-12)
            np.testing.assert_allclose(partner.ray[:, free], -wave.ray[:, free], atol=1e-9)
            phases.append(np.sum(wave.field * partner.field, axis=0))  # of E_partner = phase · E*
            np.testing.assert_allclose(np.abs(phases[-1][free]), 1.0, rtol=0, atol=1e-12)
    # An amplitude into a field that has a phase too much lacks it.
    out, into = np.array(phases[:4]), np.array(phases[4:])
    expected = s.swapaxes(0, 1) * out[None] / into[:, None]
    some = np.isfinite(expected) & np.isfinite(back)
    assert np.count_nonzero(some) > 1500
    np.testing.assert_allclose(back[some], expected[some], rtol=0, atol=1e-10)
    # The transposition says something, and so does the conjugation of the partner.
    different = np.abs(s - s.swapaxes(0, 1))[np.isfinite(s) & np.isfinite(s.swapaxes(0, 1))]
    assert np.quantile(different, 0.9) > 1e-3
    whole = np.flatnonzero(np.isfinite(s).all(axis=(0, 1)))
    assert whole.size > 20
    gram = np.einsum("kin,kjn->nij", np.conj(s[:, :, whole]), s[:, :, whole])
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(4), gram.shape), rtol=0, atol=1e-10)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("modes", list(itertools.product((0, 1), (0, 1))))
def test_a_path_through_an_active_crystal_comes_back(kind: str, modes: tuple[int, int]) -> None:
    """Air, crystal, reflection inside, air; then with −k from the end: every k and ray comes back."""
    count, rng = 600, np.random.default_rng(5)
    crystal, air = random_medium(rng, kind, count, 1e-2), Medium.isotropic(1.0)
    normals = [units(rng, count) for _ in range(3)]

    def step(k: Real, normal: Real, source: Medium, target: Medium) -> Scattering:
        return scatter(normal, k - normal * np.sum(k * normal, axis=0), source, target)

    def towards(ray: Real, normal: Real) -> Real:
        """Normals in the sense of the ray."""
        return np.asarray(normal * np.where(np.sum(ray * normal, axis=0) > 0, 1.0, -1.0))

    start = units(rng, count)
    z0 = towards(start, normals[0])
    inside = step(start, z0, air, crystal).transmitted[modes[0]]
    z1 = towards(inside.ray, normals[1])
    turned = step(inside.k, z1, crystal, air).reflected[modes[1]]
    z2 = towards(np.where(np.isfinite(turned.ray), turned.ray, 1.0), normals[2])
    out = step(turned.k, z2, crystal, air).transmitted[0]
    good = inside.propagating & turned.propagating & out.propagating
    for ray, z in ((start, z0), (inside.ray, z1), (turned.ray, z2)):
        good &= np.abs(np.sum(np.where(np.isfinite(ray), ray, 0.0) * z, axis=0)) > 1e-2
    rays = np.flatnonzero(good)
    assert rays.size > 40
    part = crystal.take(rays)
    back = step(-out.k[:, rays], -z2[:, rays], air, part)
    first = _nearest(back.transmitted, -turned.k[:, rays])
    np.testing.assert_allclose(first.ray, -turned.ray[:, rays], atol=1e-10)
    np.testing.assert_allclose(np.abs(np.sum(first.field * turned.field[:, rays], axis=0)), 1.0, atol=1e-11)
    second = _nearest(step(first.k, -z1[:, rays] * -1.0, part, air).reflected, -inside.k[:, rays])
    np.testing.assert_allclose(second.ray, -inside.ray[:, rays], atol=1e-10)
    last = _nearest(step(second.k, -z0[:, rays], part, air).transmitted, -start[:, rays])
    np.testing.assert_allclose(last.ray, -start[:, rays], atol=1e-10)


def _nearest(pair: tuple[Wave, Wave], k: Real) -> Wave:
    """Return, of each pair, the wave of the wave vector given, which must be there."""
    first, second = pair
    is_first = np.abs(first.k - k).max(axis=0) < np.abs(second.k - k).max(axis=0)

    wave = replace(
        first,
        k=np.where(is_first, first.k, second.k),
        ray=np.where(is_first, first.ray, second.ray),
        field=np.where(is_first, first.field, second.field),
    )
    np.testing.assert_allclose(wave.k, k, atol=1e-11)
    return wave
