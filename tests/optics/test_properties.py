"""Invariants of scattering at a face, over media, orientations and incidences that Hypothesis draws."""

from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crystal_core.optics import Medium, Scattering, Wave, scatter
from tests.optics.faces import Crystal, DrawnFace, assert_sound, crystals, drawn_faces, frames
from tests.reference.cases import random_cases
from tests.reference.media import KINDS, Kind

drawn = settings(deadline=None, derandomize=True, max_examples=120, database=None)


def _powers(s: Scattering) -> np.ndarray:
    """Return (4, 2, N): R, R, T, T of each incident mode, 0 where that is evanescent."""
    return np.nan_to_num(np.array((*s.power_reflected, *s.power_transmitted)))


def _totals(s: Scattering) -> np.ndarray:
    """Return total R and T, summed over the incident modes: well defined however near two modes are."""
    powers = _powers(s)
    return np.array((powers[:2].sum(axis=(0, 1)), powers[2:].sum(axis=(0, 1))))


def _assert_equal_waves(ours: Wave, other: Wave, clear: np.ndarray, bound: float, turn: np.ndarray) -> None:
    free = clear & ours.propagating
    np.testing.assert_array_equal(ours.propagating[clear], other.propagating[clear])
    for name in ("k", "k_imag", "ray"):
        expected = np.einsum("ij,jn->in", turn, getattr(ours, name))
        keep = free if name == "ray" else clear
        np.testing.assert_allclose(getattr(other, name)[:, keep], expected[:, keep], atol=bound)
    field = np.einsum("ij,jn->in", turn, ours.field)
    overlap = np.abs(np.sum(np.conj(field) * other.field, axis=0))
    np.testing.assert_allclose(overlap[clear], 1.0, atol=bound)


def _assert_equal_pairs(
    ours: tuple[Wave, Wave], other: tuple[Wave, Wave], clear: np.ndarray, bound: float, turn: np.ndarray
) -> None:
    """Assert that two pairs of waves agree; evanescent ones, which carry nothing, have no order."""
    k = [np.einsum("ij,jn->in", turn, wave.k + 1j * wave.k_imag) for wave in ours]
    images = [wave.k + 1j * wave.k_imag for wave in other]
    straight, crossed = (
        sum(np.abs(a - b).sum(axis=0) for a, b in zip(k, p, strict=True)) for p in (images, images[::-1])
    )
    swapped = (crossed < straight) & ~ours[0].propagating & ~ours[1].propagating
    for wave, image, mirrored in zip(ours, other, other[::-1], strict=True):
        _assert_equal_waves(wave, image, clear & ~swapped, bound, turn)
        _assert_equal_waves(wave, mirrored, clear & swapped, bound, turn)


def _assert_same(face: DrawnFace, ours: Scattering, other: Scattering, bound: float, turn: np.ndarray) -> None:
    """Assert that two results agree: each wave and power where modes are apart, and the totals."""
    steep = face.steep(ours)
    apart = steep & face.apart(ours)
    for one, two in ((ours.incident, other.incident), (ours.reflected, other.reflected)):
        _assert_equal_pairs(one, two, apart, bound, turn)
    _assert_equal_pairs(ours.transmitted, other.transmitted, apart, bound, turn)
    np.testing.assert_allclose(_powers(other)[..., apart], _powers(ours)[..., apart], atol=bound)
    summed = steep & face.sums_are_known(ours)
    np.testing.assert_allclose(_totals(other)[:, summed], _totals(ours)[:, summed], atol=bound)


@pytest.mark.parametrize("count", [2000, pytest.param(20_000, marks=pytest.mark.full)])
@pytest.mark.parametrize(("source", "target"), list(product(KINDS, KINDS)))
def test_energy(source: Kind, target: Kind, count: int) -> None:
    """ΣR + ΣT = 1, total reflection, evanescent and inhibited waves included."""
    s = random_cases(31, source, target, count).run()
    assert_sound(s)
    assert sum(np.count_nonzero(~w.propagating) for w in s.transmitted) > 100


@drawn
@given(drawn_faces(), frames())
def test_turning_the_whole_setup_turns_the_answer(face: DrawnFace, turn: np.ndarray) -> None:
    """Mirror images included: nothing here is handed."""
    _assert_same(face, face.run(), face.turned(turn).run(), 1e-9, turn)


@drawn
@given(drawn_faces(("biaxial",)), st.sampled_from(list(permutations(range(3)))))
def test_names_of_the_indices_do_not_matter(face: DrawnFace, order: tuple[int, ...]) -> None:
    def renamed(crystal: Crystal) -> Crystal:
        return Crystal(tuple(crystal.indices[i] for i in order), crystal.frame[list(order)])

    other = replace(face, source=renamed(face.source), target=renamed(face.target))
    _assert_same(face, face.run(), other.run(), 1e-12, np.eye(3))


@drawn
@given(drawn_faces(), st.lists(st.sampled_from((1.0, -1.0)), min_size=3, max_size=3))
def test_signs_of_the_axes_do_not_matter(face: DrawnFace, signs: list[float]) -> None:
    def flipped(crystal: Crystal) -> Crystal:
        return replace(crystal, frame=np.array(signs)[:, None] * crystal.frame)

    other = replace(face, source=flipped(face.source), target=flipped(face.target))
    _assert_same(face, face.run(), other.run(), 1e-10, np.eye(3))


@drawn
@given(drawn_faces(), st.sampled_from((0.5, 1.1, 2.0, 1e3)))
def test_only_ratios_of_indices_matter(face: DrawnFace, factor: float) -> None:
    """Powers, rays and fields of media n·f with tangential wave vectors k·f are those of n and k."""
    ours = face.run()
    other = DrawnFace(face.source.scaled(factor), face.target.scaled(factor), face.normal, factor * face.tangential)
    scaled = other.run()

    def unscaled(wave: Wave) -> Wave:
        return replace(wave, k=wave.k / factor, k_imag=wave.k_imag / factor)

    back = [tuple(unscaled(wave) for wave in pair) for pair in (scaled.incident, scaled.reflected, scaled.transmitted)]
    image = replace(scaled, incident=back[0], reflected=back[1], transmitted=back[2])
    _assert_same(face, ours, image, 1e-9, np.eye(3))


@drawn
@given(drawn_faces())
def test_the_way_back_has_the_same_waves_and_powers(face: DrawnFace) -> None:
    """(−k, −ray) solves the same problem; the share from mode j into mode i is that from i into j on the way back."""
    there, back = face.run(), face.reversed().run()
    apart = face.steep(there) & face.apart(there)
    for ours, theirs in ((there.transmitted, back.incident), (there.incident, back.transmitted)):
        for i in (0, 1):
            free = apart & ours[i].propagating
            np.testing.assert_allclose(theirs[i].k[:, free], -ours[i].k[:, free], atol=1e-12)
            np.testing.assert_allclose(theirs[i].ray[:, free], -ours[i].ray[:, free], atol=1e-10)
    for i in (0, 1):
        for j in (0, 1):
            free = apart & there.incident[j].propagating & there.transmitted[i].propagating
            np.testing.assert_allclose(
                back.power_transmitted[j][i][free], there.power_transmitted[i][j][free], atol=1e-10
            )


@drawn
@given(crystals(), drawn_faces())
def test_a_face_between_equal_media_is_none(crystal: Crystal, face: DrawnFace) -> None:
    """Every wave goes on as it is; nothing comes back."""
    s = replace(face, source=crystal, target=crystal, tangential=0.6 * face.tangential).run()
    for j in (0, 1):
        free = s.incident[j].propagating
        steep = free & (s.incident[j].flux > 1e-6)
        for i in (0, 1):
            np.testing.assert_allclose(s.power_reflected[i][j][steep], 0.0, atol=1e-12)
            np.testing.assert_allclose(s.power_transmitted[i][j][steep], float(i == j), atol=1e-12)


@drawn
@given(
    st.floats(1.1, 2.2),
    st.floats(-1.0, 1.0),
    st.floats(-1.0, 1.0),
    st.floats(0.0, 0.98),
    frames(),
    st.sampled_from((1e-3, 1e-6, 1e-9, 1e-12, 1e-15)),
)
def test_biaxial_uniaxial_isotropic_are_one_theory(
    n: float, first: float, second: float, fraction: float, frame: np.ndarray, size: float
) -> None:
    """As the differences of the indices go to 0 the totals go over into Fresnel's, at their own rate; no jump."""
    kt = fraction * min(1.0, n - 0.1) * np.array((0.6, 0.8, 0.0))[:, None]
    air = Medium.isotropic(1.0)
    isotropic = _totals(scatter((0.0, 0.0, 1.0), kt, air, Medium.isotropic(n)))
    uniaxial = Medium.uniaxial(n, n * (1 + size * first), frame[2])
    biaxial = Medium.biaxial((n, n * (1 + size * second), n * (1 + size * first)), frame)
    for medium in (uniaxial, biaxial):
        s = scatter((0.0, 0.0, 1.0), kt, air, medium)
        assert_sound(s)
        np.testing.assert_allclose(_totals(s), isotropic, atol=1e-12 + 4 * size)
        for wave in s.transmitted:
            straight = np.sqrt(n * n - np.sum(kt**2))
            np.testing.assert_allclose(wave.k[2], straight, rtol=1e-12 + 4 * size * (n / straight) ** 2)
