"""Directions and media in which the equations degenerate: nothing is NaN, no energy is lost, nothing jumps."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import pytest

from crystal_core.optics import Scattering
from tests.reference.arithmetic import Array
from tests.reference.cases import Cases
from tests.reference.comparison import assert_same_totals, kept_energy
from tests.reference.media import Kind, Media, random_frames

NORMAL = np.array([0.0, 0.0, 1.0])
OBLIQUE = np.array([0.48, 0.6, 0.64])
X, Y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
TURNED = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
ARAGONITE = (1.53, 1.681, 1.6854)


def medium(kind: Kind, indices: Sequence[float], axes: Array) -> Media:
    return Media(kind, np.array(indices)[:, None], np.array(axes, float)[:, :, None])


def glass(n: float) -> Media:
    return medium("isotropic", (n, n, n), np.eye(3))


def uniaxial(n_o: float, n_e: float, axis: Array) -> Media:
    across = np.cross(axis, X if abs(axis[0]) < 0.9 else Y)
    across /= np.linalg.norm(across)
    return medium("uniaxial", (n_o, n_o, n_e), np.array([across, np.cross(axis, across), axis]))


def biaxial(indices: Sequence[float] = ARAGONITE, axes: Array = TURNED) -> Media:
    return medium("biaxial", indices, axes)


def with_optic_axis(direction: Array, indices: Sequence[float] = ARAGONITE) -> Media:
    """Return a biaxial crystal turned so that an optic axis points along z, y or x."""
    a, b, c = np.array(indices) ** -2.0
    x, z = np.sqrt((a - b) / (a - c)), np.sqrt((b - c) / (a - c))
    across = np.roll(direction, 1)
    return biaxial(indices, np.array([x * direction + z * across, np.roll(direction, 2), z * direction - x * across]))


def cases_along_x(source: Media, target: Media, tangential: Sequence[float]) -> Cases:
    """Return the same two media, the normal along z, with tangential wave vectors along x."""
    count = len(tangential)
    along = np.zeros((3, count))
    along[0] = tangential
    first = np.zeros(count, int)
    return Cases(source.take(first), target.take(first), np.repeat(NORMAL[:, None], count, axis=1), along)


def turned(cases: Cases, seed: int, turns: int) -> Cases:
    """Return every case in some turned frames, where rounding spoils what was exact in the first."""
    frames = random_frames(np.random.default_rng(seed), turns)
    count = cases.normal.shape[1]
    spread = np.tile(np.arange(count), turns)
    turn = np.repeat(frames, count, axis=2)

    def vectors(v: Array) -> Array:
        return np.asarray(np.einsum("abn,b...n->a...n", turn, v))

    wide = cases.take(spread)

    def media(m: Media) -> Media:
        return Media(m.kind, m.indices, np.ascontiguousarray(vectors(m.axes.swapaxes(0, 1)).swapaxes(0, 1)))

    return Cases(media(wide.source), media(wide.target), vectors(wide.normal), vectors(wide.tangential))


AIR, CALCITE = glass(1.0), uniaxial(1.6584, 1.4864, OBLIQUE)
SMALL = (0.0, 1e-300, 1e-160, 1e-16, 1e-9, 0.5)
BEYOND = np.nextafter(1.55, 2)
PERMUTED = biaxial((1.6854, 1.53, 1.681), -TURNED[[2, 0, 1]])
DEGENERATE: dict[str, tuple[Media, Media, Sequence[float]]] = {
    "glass, normal incidence": (AIR, glass(1.5), (0.0,)),
    "calcite, normal incidence": (AIR, CALCITE, (0.0,)),
    "axis along the normal": (AIR, uniaxial(1.6584, 1.4864, NORMAL), SMALL),
    "axis along the normal, from inside": (uniaxial(1.6584, 1.4864, NORMAL), AIR, SMALL),
    "axis in the face": (AIR, uniaxial(1.6584, 1.4864, Y), (0.0, 1e-16, 0.5)),
    "no birefringence": (AIR, uniaxial(1.55, 1.55, OBLIQUE), (0.0, 1e-9, 0.5, 0.999)),
    "no birefringence, from inside": (uniaxial(1.55, 1.55, OBLIQUE), AIR, (0.0, 1e-9, 0.5, 0.999)),
    "an ulp of birefringence": (AIR, uniaxial(1.55, BEYOND, OBLIQUE), (0.0, 1e-9, 0.5, 0.999)),
    "equal glasses": (glass(1.5), glass(1.5), (0.0, 0.5, 1.499)),
    "equal crystals": (CALCITE, CALCITE, (0.0, 0.5, 1.3)),
    "equal crystals, one reversed axis": (CALCITE, uniaxial(1.6584, 1.4864, -OBLIQUE), (0.0, 0.5, 1.3)),
    "aragonite, normal incidence": (AIR, biaxial(), (0.0, 1e-160)),
    "aragonite from inside, normal incidence": (biaxial(), AIR, (0.0, 1e-160)),
    "optic axis along the normal": (AIR, with_optic_axis(NORMAL), SMALL),
    "optic axis along the normal, from inside": (with_optic_axis(NORMAL), AIR, SMALL),
    "optic axis along both normals": (with_optic_axis(NORMAL), with_optic_axis(NORMAL, (1.5, 1.55, 1.65)), SMALL),
    "optic axis along s": (AIR, with_optic_axis(Y), (0.0, 1e-16, 0.5)),
    "optic axis along the tangential k": (with_optic_axis(X), AIR, (0.0, 1e-16, 0.5)),
    "principal directions along the frame": (AIR, biaxial(axes=np.eye(3)), SMALL),
    "principal directions along the frame, from inside": (biaxial(axes=np.eye(3)[::-1]), AIR, SMALL),
    "plane of incidence of the optic axes": (AIR, biaxial(axes=np.eye(3)[[0, 1, 2]]), (0.3, 0.999)),
    "plane of incidence across the optic axes": (AIR, biaxial(axes=np.eye(3)[[1, 0, 2]]), (0.3, 0.999)),
    "two indices an ulp apart": (AIR, biaxial((1.55, BEYOND, 1.6)), (0.0, 1e-9, 0.5, 0.999)),
    "three indices ulps apart": (AIR, biaxial((1.55, BEYOND, np.nextafter(BEYOND, 2))), (0.0, 1e-9, 0.5, 0.999)),
    "three indices ulps apart, from inside": (biaxial((1.55, BEYOND, np.nextafter(BEYOND, 2))), AIR, (0.0, 0.5)),
    "lower two equal": (AIR, biaxial((1.5, 1.5, 1.6)), (0.0, 1e-9, 0.5, 0.999)),
    "upper two equal, from inside": (biaxial((1.5, 1.6, 1.6)), AIR, (0.0, 1e-9, 0.5, 0.999)),
    "all equal": (AIR, biaxial((1.55, 1.55, 1.55)), (0.0, 1e-9, 0.5, 0.999)),
    "all equal, from inside": (biaxial((1.55, 1.55, 1.55)), AIR, (0.0, 1e-9, 0.5, 0.999)),
    "equal biaxial crystals": (biaxial(), biaxial(), (0.0, 0.5, 1.3)),
    "equal biaxial crystals, axes named anew": (biaxial(), PERMUTED, (0.0, 0.5, 1.3)),
    "equal biaxial crystals, along an optic axis": (with_optic_axis(NORMAL), with_optic_axis(NORMAL), SMALL),
}


def assert_finite(got: Scattering) -> None:
    """No NaN in anything that a wave which came in gives, and unit fields."""
    for wave in (*got.incident, *got.reflected, *got.transmitted):
        assert np.isfinite(wave.k).all()
        assert np.isfinite(wave.k_imag).all()
        assert not wave.k_imag[:, wave.propagating].any()
        assert np.isfinite(wave.flux).all()
        assert np.isfinite(wave.ray[:, wave.propagating]).all()
        np.testing.assert_allclose(np.linalg.norm(wave.ray[:, wave.propagating], axis=0), 1, rtol=0, atol=1e-14)
        np.testing.assert_allclose(np.linalg.norm(wave.field, axis=0), 1, rtol=0, atol=1e-14)
    for i, j in itertools.product(range(2), range(2)):
        live = got.incident[j].propagating
        for table in (got.amplitude_reflected, got.amplitude_transmitted, got.power_reflected, got.power_transmitted):
            assert np.isfinite(table[i][j][live]).all()


def assert_energy(got: Scattering, bound: float = 1e-12) -> None:
    for j in range(2):
        live = got.incident[j].propagating
        np.testing.assert_allclose(kept_energy(got, j)[live], 1, rtol=0, atol=bound)


@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_directions(name: str) -> None:
    cases = cases_along_x(*DEGENERATE[name])
    got = cases.run()
    assert_finite(got)
    assert_energy(got)
    assert got.incident[0].propagating.all()
    for case in range(cases.tangential.shape[1]):
        assert_same_totals(got, cases.truth(case, digits=80), case, 1e-9)
    if name.startswith("equal"):
        for i, j in itertools.product(range(2), range(2)):
            np.testing.assert_allclose(got.power_reflected[i][j], 0, rtol=0, atol=1e-24)


CRITICAL: dict[str, tuple[Media, Media, float]] = {
    "glass to air": (glass(1.5), AIR, 1.0),
    "calcite to air": (CALCITE, AIR, 1.0),
    "glass to calcite, ordinary": (glass(1.9), CALCITE, 1.6584),
    "glass to calcite, extraordinary": (glass(1.9), uniaxial(1.6584, 1.4864, Y), 1.4864),
    "calcite to glass": (CALCITE, glass(1.4), 1.4),
    "glass to quartz, axis along the tangential k": (glass(1.9), uniaxial(1.544, 1.553, X), 1.544),
    "grazing in glass": (glass(1.5), glass(1.7), 1.5),
    "grazing in air over calcite": (AIR, CALCITE, 1.0),
    "grazing and critical at once": (glass(1.5), glass(1.5), 1.5),
    "grazing ordinary in calcite": (CALCITE, glass(1.7), 1.6584),
    "aragonite to air": (biaxial(), AIR, 1.0),
    "grazing in air over aragonite": (AIR, biaxial(), 1.0),
    # Along x, in a face across z, the waves of a crystal on these axes have the indices of y and of z.
    "glass to aragonite, E along y": (glass(1.9), biaxial((1.6854, 1.681, 1.53), np.eye(3)), 1.681),
    "glass to aragonite, E along z": (glass(1.9), biaxial((1.6854, 1.681, 1.53), np.eye(3)), 1.53),
    "glass to aragonite, slow E along z": (glass(1.9), biaxial((1.53, 1.681, 1.6854), np.eye(3)), 1.6854),
    "grazing in aragonite, E along y": (biaxial((1.6854, 1.53, 1.681), np.eye(3)), glass(1.7), 1.53),
    "grazing in aragonite, E along z": (biaxial((1.6854, 1.53, 1.681), np.eye(3)), glass(1.7), 1.681),
    "grazing in aragonite, fast E along z": (biaxial((1.681, 1.6854, 1.53), np.eye(3)), AIR, 1.53),
    "optic axis of aragonite along the tangential k": (with_optic_axis(X), glass(1.7), 1.681),
    "glass to aragonite, optic axis along the tangential k": (glass(1.9), with_optic_axis(X), 1.681),
    "grazing in a crystal of two equal indices": (biaxial((1.5, 1.5, 1.7), np.eye(3)), AIR, 1.5),
    "uniaxial to aragonite": (uniaxial(1.5, 1.7, Y), biaxial((1.6854, 1.681, 1.53), np.eye(3)), 1.681),
    "uniaxial, an ulp apart, to air": (uniaxial(1.55, BEYOND, OBLIQUE), AIR, 1.0),
    "glass to uniaxial, an ulp apart": (glass(1.9), uniaxial(1.55, BEYOND, OBLIQUE), 1.55),
    "grazing in uniaxial, an ulp apart": (uniaxial(1.55, BEYOND, OBLIQUE), AIR, 1.55),
    "glass to biaxial, ulps apart": (glass(1.9), biaxial((1.55, BEYOND, 1.5500001)), 1.55),
    "grazing in biaxial, ulps apart": (biaxial((1.55, BEYOND, 1.5500001)), AIR, 1.55),
    "grazing and critical in aragonite": (biaxial(axes=np.eye(3)), biaxial(axes=np.eye(3)), 1.681),
}

# A wave along an optic axis that grazes the face has its twin on the other side of it, as the wave that comes back.
# What each of them is depends on the direction in which k leaves the axis, so powers have no limit there.
SINGULAR = {
    "optic axis of aragonite along the tangential k",
    "glass to aragonite, optic axis along the tangential k",
}


# Where all four waves of a crystal meet, grazing the face along its optic axis or nearly without birefringence, each is
# known to the square root of rounding, and in one of a thousand frames energy is off by as much as one of them carries.
FOUR_MEET = {
    "glass to quartz, axis along the tangential k": 1e-7,
    "grazing in uniaxial, an ulp apart": 2e-9,
}


@pytest.mark.parametrize("name", CRITICAL)
@pytest.mark.parametrize("turns", [20, pytest.param(500, marks=pytest.mark.full)])
def test_any_frame(name: str, turns: int) -> None:
    """Turned as a whole, so that nothing is exact any more, faces at and about an edge keep energy and stay finite."""
    source, target, edge = CRITICAL[name]
    steps = [-1e-6, -1e-9, -1e-12, -1e-15, -1e-16, 0.0, 1e-16, 1e-15, 1e-12, 1e-9, 1e-6]
    got = turned(cases_along_x(source, target, [edge + d for d in steps]), 401, turns).run()
    assert_finite(got)
    assert_energy(got, FOUR_MEET.get(name, 1e-12))


@pytest.mark.parametrize("name", DEGENERATE)
@pytest.mark.parametrize("turns", [20, pytest.param(500, marks=pytest.mark.full)])
def test_degenerate_in_any_frame(name: str, turns: int) -> None:
    got = turned(cases_along_x(*DEGENERATE[name]), 402, turns).run()
    assert_finite(got)
    assert_energy(got)


@pytest.mark.parametrize("name", CRITICAL)
def test_critical_and_grazing(name: str) -> None:
    """Exactly at the edge, one ulp to both sides, and further: nothing is NaN, energy is kept, nothing jumps."""
    source, target, edge = CRITICAL[name]
    steps = [-1e-6, -1e-9, -1e-12, -1e-15, 0.0, 1e-15, 1e-12, 1e-9, 1e-6]
    tangential = [edge + d for d in steps]
    tangential += [float(np.nextafter(edge, 0)), float(np.nextafter(edge, 3))]
    got = cases_along_x(source, target, tangential).run()
    assert_finite(got)
    assert_energy(got)
    for j in range(2):
        live = got.incident[j].propagating
        if live.all() and name not in SINGULAR:
            # powers go like the square root of the distance from the edge
            total = got.power_reflected[0][j] + got.power_reflected[1][j]
            for here, distance in zip(total, [*steps, 1e-15, 1e-15], strict=True):
                assert abs(here - total[steps.index(0.0)]) < 50 * np.sqrt(abs(distance)) + 1e-6
