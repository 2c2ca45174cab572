"""Light that goes back: paths, amplitudes and polarization of the reversed problem, over all pairs of media."""

import numpy as np
import pytest

from crystal_core.optics import transverse_frame
from crystal_core.optics.mueller import mueller, reversed_mueller
from tests.optics.paths import PATH_KINDS, Beam, PathKind, Turn, internal_path, norm, reversed_path
from tests.optics.ports import Ports, ports
from tests.reference.cases import Cases, random_cases
from tests.reference.media import KINDS, Kind

COUNT = 500
PAIRS = [(a, b) for a in KINDS for b in KINDS]
MODES = [(0, 0), (0, 1), (1, 0), (1, 1)]


def _both_ways(cases: Cases) -> tuple[Ports, Ports]:
    """Return the ports of the faces and, in the order of the partners, those of the reversed problem."""
    media = cases.source.medium(), cases.target.medium()
    forward = ports(cases.normal, cases.tangential, *media)
    backward = ports(cases.normal, -cases.tangential, *media)
    return forward, backward.in_order([-p.k for p in forward.outgoing], [-p.k for p in forward.incoming])


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_the_waves_come_back(source: Kind, target: Kind) -> None:
    """To a wave (k, E) there is the wave (−k, E), evanescent ones included, the other way through the same face."""
    forward, backward = _both_ways(random_cases(11, source, target, COUNT))
    for ours, partners in ((forward.outgoing, backward.incoming), (forward.incoming, backward.outgoing)):
        for wave, partner in zip(ours, partners, strict=True):
            np.testing.assert_allclose(partner.k, -wave.k, atol=1e-14)
            field, back = (p.e / norm(np.abs(p.e)) for p in (wave, partner))
            overlap = np.abs(np.sum(np.conj(field) * back, axis=0))
            np.testing.assert_allclose(overlap, 1.0, atol=1e-12)


@pytest.mark.parametrize("count", [1000, pytest.param(20_000, marks=pytest.mark.full)])
@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_the_reversed_scattering_matrix_is_the_transpose(source: Kind, target: Kind, count: int) -> None:
    """S(reversed) = Sᵀ, modes of unit √(2(E_x H_y − E_y H_x)) without conjugation: evanescent waves have no other."""
    forward, backward = _both_ways(random_cases(12, source, target, count))
    s = forward.matrix(forward.incoming, forward.outgoing)
    back = backward.matrix(forward.outgoing, forward.incoming)
    size = np.maximum(1.0, np.abs(s).max(axis=(0, 1)))
    assert np.max(np.abs(back - np.swapaxes(s, 0, 1)).max(axis=(0, 1)) / size) < 1e-10

    evanescent = [np.abs(p.k.imag).max(axis=0) > 1e-12 for p in forward.incoming]
    assert np.count_nonzero(np.any(evanescent, axis=0)) > count // 20
    # It is not symmetric by itself, so the transposition says something, nor is it without the right norm.
    assert np.median(np.abs(s - np.swapaxes(s, 0, 1)).max(axis=(0, 1))) > 0.005
    raw = np.abs(backward.amplitudes) - np.abs(np.swapaxes(forward.amplitudes, 0, 1))
    assert np.median(np.abs(raw).max(axis=(0, 1))) > 0.005


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_propagating_waves_of_lossless_media_keep_their_energy(source: Kind, target: Kind) -> None:
    """There the Lorentz norm is that of the flux: S† S = 1 between propagating waves."""
    forward, _ = _both_ways(random_cases(13, source, target, COUNT))
    s = forward.matrix(forward.incoming, forward.outgoing)
    ends = []
    for waves in (forward.incoming, forward.outgoing):
        ends.append(np.array([np.abs(p.k.imag).max(axis=0) < 1e-12 for p in waves]))
    inside = s * ends[1][:, None] * ends[0][None]
    gram = np.einsum("kin,kjn->ijn", np.conj(inside), inside)
    free = np.where(np.eye(4)[:, :, None] == 1, ends[0], 0.0)
    np.testing.assert_allclose(gram, free, atol=1e-10)


def _path(seed: int, kind: PathKind, modes: tuple[int, int]) -> tuple[Beam, list[Turn], list[Beam], np.ndarray]:
    start, turns, beams, good = internal_path(np.random.default_rng(seed), kind, COUNT, modes)
    assert np.count_nonzero(good) > 0.6 * COUNT
    return start, turns, beams, good


@pytest.mark.parametrize("kind", PATH_KINDS)
@pytest.mark.parametrize("modes", MODES)
def test_a_path_through_a_crystal_comes_back(kind: PathKind, modes: tuple[int, int]) -> None:
    """Trace in, be reflected, trace out; negate k and trace back: each k and ray comes back."""
    start, turns, beams, good = _path(21, kind, modes)
    back = reversed_path(beams, turns, *transverse_frame(start.k))
    for there, here in zip([start, *beams[:-1]], back[::-1], strict=True):
        np.testing.assert_allclose(here.k[:, good], -there.k[:, good], atol=1e-11)
        np.testing.assert_allclose(here.ray[:, good], -there.ray[:, good], atol=1e-11)


@pytest.mark.parametrize("kind", PATH_KINDS)
@pytest.mark.parametrize("modes", MODES)
def test_a_path_has_the_transposed_jones_matrix(kind: PathKind, modes: tuple[int, int]) -> None:
    """J_b = J_fᵀ on the same axes; in the beam's own right-handed frames M_b = O Mᵀ O.

    Mutants: O dropped, and M itself.
    """
    start, turns, beams, good = _path(22, kind, modes)
    out_x, out_y = transverse_frame(np.where(good, beams[-1].k, start.k))
    in_x, in_y = transverse_frame(start.k)
    forward = beams[-1].jones(out_x, out_y)[..., good]
    same_axes = reversed_path(beams, turns, out_x, out_y)[-1].jones(in_x, in_y)[..., good]
    np.testing.assert_allclose(same_axes, np.swapaxes(forward, 0, 1), atol=2e-12)

    own_frames = reversed_path(beams, turns, -out_x, out_y)[-1].jones(-in_x, in_y)[..., good]
    there, back = mueller(forward), mueller(own_frames)
    np.testing.assert_allclose(back, reversed_mueller(there), atol=4e-12)
    for mutant in (there, np.swapaxes(there, 0, 1)):
        assert np.median(np.abs(back - mutant).max(axis=(0, 1))) > 0.05
    assert np.median(np.abs(forward.imag).max(axis=(0, 1))) > 0.01  # total reflection sees to phases
