"""The adjoint along paths with total reflection: tr(W · J C J†) = tr(J† W J · C), by light that runs backward."""

import numpy as np
import pytest

from crystal_core.optics import Coherency, transverse_frame
from crystal_core.optics.mueller import importance_before, measured, transported
from tests.optics.paths import PATH_KINDS, Beam, PathKind, Turn, internal_path, reversed_path

COUNT = 500
MODES = [(0, 0), (0, 1), (1, 0)]


def _hermitian(rng: np.random.Generator) -> Coherency:
    a = rng.standard_normal((2, 2, COUNT)) + 1j * rng.standard_normal((2, 2, COUNT))
    c = np.einsum("ijn,kjn->ikn", a, np.conj(a))
    return Coherency(c[0, 0].real, c[1, 1].real, c[0, 1].real, c[0, 1].imag)


def _conjugated(c: Coherency) -> Coherency:
    return Coherency(c.xx, c.yy, c.xy_re, -c.xy_im)


def _frame_change(direction: np.ndarray) -> np.ndarray:
    """Return components in `transverse_frame(−direction)` of those in `transverse_frame(direction)`, (2, 2, N)."""
    return np.einsum("aib,cib->acb", transverse_frame(-direction), transverse_frame(direction))


class Path:
    """A path from air through a crystal to air, with what it does to light from either end."""

    def __init__(self, seed: int, kind: PathKind, modes: tuple[int, int]) -> None:
        start, self.turns, self.beams, good = internal_path(np.random.default_rng(seed), kind, COUNT, modes)
        assert np.count_nonzero(good) > 0.6 * COUNT
        self.good = good
        self.start: Beam = start
        self.d_in = start.k
        self.d_out = np.where(good, self.beams[-1].k, start.k)
        self.jones = np.where(good, self.beams[-1].jones(*transverse_frame(self.d_out)), 0.0)

    def carried_back(self, light: Coherency) -> Coherency:
        """Return light that comes in from the far end, in the frame of its direction, behind the way back."""
        turns: list[Turn] = self.turns
        last = reversed_path(self.beams, turns, *transverse_frame(-self.d_out))[-1]
        return transported(light, np.where(self.good, last.jones(*transverse_frame(-self.d_in)), 0.0))

    def importance_before(self, w: Coherency) -> Coherency:
        """Return J† W J by carrying conj(W) along the reversed path as if it were light."""
        carried = self.carried_back(transported(_conjugated(w), _frame_change(self.d_out)))
        return _conjugated(transported(carried, np.swapaxes(_frame_change(self.d_in), 0, 1)))


@pytest.mark.parametrize("kind", PATH_KINDS)
@pytest.mark.parametrize("modes", MODES)
def test_a_path_gives_the_same_number_from_either_end(kind: PathKind, modes: tuple[int, int]) -> None:
    rng = np.random.default_rng(41)
    path, c, w = Path(42, kind, modes), _hermitian(rng), _hermitian(rng)
    good = path.good
    there = measured(w, transported(c, path.jones))
    assert (there[good] > 0).all()
    assert np.median(there[good]) > 0.01
    by_formula = measured(importance_before(w, path.jones), c)
    by_light = measured(path.importance_before(w), c)
    np.testing.assert_allclose(by_formula[good], there[good], rtol=1e-11)
    np.testing.assert_allclose(by_light[good], there[good], rtol=1e-9)


@pytest.mark.parametrize("kind", PATH_KINDS)
@pytest.mark.parametrize("modes", MODES)
def test_mutants_are_caught(kind: PathKind, modes: tuple[int, int]) -> None:
    """W not conjugated; the turn of the frame dropped (O); multiplied on the left, J W J†."""
    rng = np.random.default_rng(43)
    path, c, w = Path(44, kind, modes), _hermitian(rng), _hermitian(rng)
    good = path.good
    there = measured(w, transported(c, path.jones))[good]

    def error(importance: Coherency) -> float:
        return float(np.median(np.abs(measured(importance, c)[good] / there - 1.0)))

    plain = transported(w, _frame_change(path.d_out))
    no_conjugate = transported(path.carried_back(plain), np.swapaxes(_frame_change(path.d_in), 0, 1))
    same_frames = _conjugated(path.carried_back(_conjugated(w)))
    assert error(path.importance_before(w)) < 1e-12
    for mutant in (same_frames, transported(w, path.jones)):
        assert error(mutant) > 0.03
    # The waves of crystals without activity are linear, whatever phase total reflection adds: they do not see Im W.
    assert (error(no_conjugate) > 0.03) == (kind in ("isotropic", "active"))
