"""Biaxial, uniaxial and isotropic media are one theory: equal where indices are equal, and near where they are near."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from crystal_core.optics import Medium, Scattering, Wave, scatter
from tests.reference.arithmetic import Array
from tests.reference.cases import Cases, random_cases
from tests.reference.media import Kind, Media, random_frames, random_units

SPREADS = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16, 0.0]
PATTERNS = [(0.0, 0.3, 1.0), (0.0, 0.0, 1.0), (0.0, 1.0, 1.0)]


def order(ours: tuple[Wave, Wave], theirs: tuple[Wave, Wave]) -> Array:
    """Return which mode of the one pair, (2, N), is mode 0 and 1 of the other, by wave vectors."""
    k = [w.k + 1j * w.k_imag for w in (*ours, *theirs)]
    crossed = np.linalg.norm(k[0] - k[3], axis=0) < np.linalg.norm(k[0] - k[2], axis=0)
    return np.array([crossed, ~crossed]).astype(int)


def in_order(values: Any, places: Array) -> Array:
    """Return values[places[i]] of two arrays (..., N), for each ray."""
    first, second = values
    return np.array([np.where(place == 0, first, second) for place in places])


def assert_same_answer(ours: Scattering, theirs: Scattering, rays: Array, bound: float) -> None:
    """Compare two answers for some rays, modes matched by wave vectors: waves, rays, fields and powers."""
    pairs = [
        (ours.incident, theirs.incident),
        (ours.reflected, theirs.reflected),
        (ours.transmitted, theirs.transmitted),
    ]
    places = [order(a, b) for a, b in pairs]
    for (a, b), place in zip(pairs, places, strict=True):
        for name in ("k", "k_imag", "flux"):
            one = np.array([getattr(w, name) for w in a])
            other = in_order([getattr(w, name) for w in b], place)
            np.testing.assert_allclose(one[..., rays], other[..., rays], rtol=0, atol=bound)
        free = np.array([w.propagating for w in a])
        np.testing.assert_array_equal(free[:, rays], in_order([w.propagating for w in b], place)[:, rays])
        one, other = np.array([w.ray for w in a]), in_order([w.ray for w in b], place)
        np.testing.assert_allclose(one[..., rays], other[..., rays], rtol=0, atol=bound)  # NaN where evanescent
        one = np.array([w.field[:, None] * w.field.conj() for w in a])
        other = in_order([w.field[:, None] * w.field.conj() for w in b], place)
        np.testing.assert_allclose(one[..., rays], other[..., rays], rtol=0, atol=bound)
    for name, out in (("power_reflected", 1), ("power_transmitted", 2)):
        one = np.array(getattr(ours, name))
        rows = [in_order(row, places[0]) for row in getattr(theirs, name)]
        other = in_order(rows, places[out])
        np.testing.assert_allclose(one[..., rays], other[..., rays], rtol=0, atol=bound)


def far_from_axis(cases: Cases, got: Scattering) -> Array:
    """Return the rays whose waves in uniaxial media stand 1e-2 from the axis and slant by as much from grazing."""
    good = np.ones(cases.normal.shape[1], bool)
    for pair, media in (
        (got.incident, cases.source),
        (got.reflected, cases.source),
        (got.transmitted, cases.target),
    ):
        for wave in pair:
            k = wave.k + 1j * wave.k_imag
            good &= np.abs(np.sum(k * cases.normal, axis=0)) > 1e-2
            if media.kind == "uniaxial":
                good &= np.linalg.norm(np.cross(wave.k, media.axes[2], axis=0), axis=0) > 1e-2
                good &= ~wave.propagating | (np.abs(wave.flux) > 1e-2)
    return np.asarray(good)


@pytest.mark.parametrize("names", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
@pytest.mark.parametrize(("source", "target"), [("isotropic", "uniaxial"), ("uniaxial", "isotropic")])
def test_two_equal_indices_are_uniaxial(source: Kind, target: Kind, names: tuple[int, int, int]) -> None:
    """The same crystal given by three indices, two of them equal, answers the same to 1e-12."""
    cases = random_cases(201, source, target, 4000)

    def three(media: Media) -> Medium:
        place = list(names)
        return (
            media.medium()
            if media.kind == "isotropic"
            else Medium.biaxial(list(media.indices[place]), media.axes[place])
        )

    got = cases.run()
    same = scatter(cases.normal, cases.tangential, three(cases.source), three(cases.target))
    rays = far_from_axis(cases, got)
    assert rays.sum() > 3500
    assert_same_answer(same, got, rays, 1e-12)


def jones(got: Scattering, normal: Array, tangential: Array) -> Array:
    """Return the reflected field for an incident field along s and p, in the same frames, (2, 2, N), [out, in].

    For a source that is isotropic or all but so: the fields of its waves are then orthonormal.
    """
    along = tangential / np.linalg.norm(tangential, axis=0)
    s = np.cross(normal, along, axis=0)

    def frames(waves: tuple[Wave, Wave]) -> list[Array]:
        k = waves[0].k / np.linalg.norm(waves[0].k, axis=0)
        return [s, np.cross(s, k, axis=0)]

    def part(u: Array, v: Array) -> Array:
        return np.asarray(np.sum(np.conj(u) * v, axis=0))

    result = np.zeros((2, 2, normal.shape[1]), complex)
    before, after = frames(got.incident), frames(got.reflected)
    for i, j, out, into in itertools.product(range(2), repeat=4):
        r = got.amplitude_reflected[i][j]
        into_j, out_i = part(got.incident[j].field, before[into]), part(after[out], got.reflected[i].field)
        result[out, into] += out_i * r * into_j
    return result


def fresnel(n1: float, n2: float, kappa: Array) -> Array:
    """Return r_ss and r_pp for p = s x k, (2, N), complex when totally reflected (Born & Wolf, 1.5.2 and 1.5.4)."""
    q1, q2 = np.sqrt(n1**2 - kappa**2), np.sqrt(n2**2 - kappa**2 + 0j)
    return np.array([(q1 - q2) / (q1 + q2), (n2**2 * q1 - n1**2 * q2) / (n2**2 * q1 + n1**2 * q2)])


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize(("n1", "n2"), [(1.0, 1.55), (1.55, 1.0)])
@pytest.mark.parametrize("crystal_first", [False, True], ids=["glass-first", "crystal-first"])
def test_isotropic_limit(crystal_first: bool, n1: float, n2: float, pattern: tuple[float, float, float]) -> None:
    """Fresnel's amplitudes are met as the indices come together, and nothing jumps on the way, phases included."""
    rng = np.random.default_rng(202)
    count = 60
    frame = random_frames(rng, 1)[:, :, 0]
    normal = np.broadcast_to(random_units(rng, 1), (3, count))
    across = np.cross(normal[:, 0], random_units(rng, 1)[:, 0])
    # up to 0.99 of grazing, across the critical angle but not at it
    kappa = np.linspace(0.01, 0.99, count) * n1
    kappa = np.where(np.abs(kappa - n2) < 0.02, n2 - 0.02, kappa)
    tangential = np.outer(across / np.linalg.norm(across), kappa)
    expected = fresnel(n1, n2, kappa)
    if n1 > n2:
        assert (np.abs(expected.imag) > 0.1).any()
    for spread in SPREADS:
        indices = [(n1 if crystal_first else n2) + spread * x for x in pattern]
        crystal, glass = Medium.biaxial(indices, frame), Medium.isotropic(n2 if crystal_first else n1)
        got = scatter(normal, tangential, *((crystal, glass) if crystal_first else (glass, crystal)))
        matrix = jones(got, normal, tangential)
        bound = 40 * spread + 1e-12
        np.testing.assert_allclose(matrix[[0, 1], [0, 1]], expected, rtol=0, atol=bound)
        np.testing.assert_allclose(matrix[[0, 1], [1, 0]], 0, rtol=0, atol=bound)


def test_brewster() -> None:
    """At Brewster's angle p is not reflected, from a crystal in the isotropic limit either."""
    kappa = np.sin(np.arctan(1.55))
    frame = random_frames(np.random.default_rng(203), 1)[:, :, 0]
    for spread in SPREADS[1:]:
        medium = Medium.biaxial([1.55, 1.55 + 0.4 * spread, 1.55 + spread], frame)
        got = scatter(np.array([0.0, 0, 1]), np.array([[kappa], [0], [0]]), Medium.isotropic(1.0), medium)
        reflected = got.power_reflected[0][1][0] + got.power_reflected[1][1][0]
        assert reflected < spread**2 + 1e-28


@pytest.mark.parametrize("kappa", [0.0, 1e-9, 0.5, 0.9, 1.2])
def test_three_equal_indices_are_isotropic(kappa: float) -> None:
    """Whatever the axes: Fresnel's powers and one index, to 1e-12, from either side."""
    rng = np.random.default_rng(204)
    for axes in np.moveaxis(random_frames(rng, 10), 2, 0):
        three, one, air = Medium.biaxial([1.55] * 3, axes), Medium.isotropic(1.55), Medium.isotropic(1.0)
        normal, tangential = np.array([0.0, 0, 1]), np.array([[0.6 * kappa], [0.8 * kappa], [0.0]])
        for first, second in ((three, air), (air, three)) if kappa < 1 else ((three, air),):
            plain = [one if m is three else m for m in (first, second)]
            got, truth = scatter(normal, tangential, first, second), scatter(normal, tangential, *plain)
            for name in ("power_reflected", "power_transmitted"):
                ours, theirs = np.array(getattr(got, name)).sum(), np.array(getattr(truth, name)).sum()
                np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12)
            for a, b in zip((*got.incident, *got.transmitted), (*truth.incident, *truth.transmitted), strict=True):
                np.testing.assert_allclose(a.k, b.k, rtol=0, atol=1e-12)
                np.testing.assert_allclose(a.k_imag, b.k_imag, rtol=0, atol=1e-12)
                np.testing.assert_allclose(a.ray, b.ray, rtol=0, atol=1e-12)
            if kappa:
                ours, theirs = (jones(g, np.array([[0.0], [0], [1]]), tangential) for g in (got, truth))
                np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12)
