"""Events per second at faces between media of every kind, on one core, in NumPy and as the same formulas compiled.

Run: ``python -m benchmarks.interface [--batch 16384] [--rounds 90]``. One event is one incident mode at one face: the
frame, the six waves, the amplitudes of that mode into the four outgoing ones, and their rays. All sides see the same
faces, in turns, in the same process, and must agree to 1e-12; the best round of each counts. "Compiled" is a loop over
the rays as Numba makes it, "vectorised" the same with the vector unit. See ``benchmarks/README.md``.
"""

from __future__ import annotations

import argparse
import platform
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numba
import numpy as np
from numpy.typing import NDArray

from benchmarks.compiled_face import (
    OUTCOME,
    compiled_events,
    packed,
    packed_medium,
    vectorise_from_now_on,
)
from crystal_core.optics import Medium, interface_frame
from crystal_core.optics.arrays import Field
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.interface import Face, solve_face
from crystal_core.render import keep_freed_memory
from crystal_core.render.rays import BATCH

__all__ = ["AGREEMENT", "KINDS", "Compiled", "Faces", "numpy_face", "numpy_outcome", "random_faces", "worst_difference"]

KINDS = ("isotropic", "uniaxial", "biaxial")

AGREEMENT = 1e-12
"""Largest difference of both results, relative where a number is larger than 1 (fields are not normalised)."""

TURN = 6
"""Rounds at a time."""


@dataclass(frozen=True, slots=True)
class Faces:
    """A batch of faces: unit normals and tangential wave vectors, shape (3, N), and the media on both sides."""

    normal: NDArray[np.float64]
    tangential: NDArray[np.float64]
    source: Medium
    target: Medium


def _medium(kind: str, rng: np.random.Generator, size: int) -> Medium:
    if kind == "isotropic":
        return Medium.isotropic(rng.uniform(1.5, 1.7, size))
    if kind == "uniaxial":
        axis = rng.normal(size=(3, size))
        length = np.sqrt(np.sum(axis * axis, axis=0))
        return Medium.uniaxial(rng.uniform(1.5, 1.7, size), rng.uniform(1.5, 1.7, size), axis / length)
    axes = np.ascontiguousarray(np.moveaxis(np.linalg.qr(rng.normal(size=(size, 3, 3)))[0], 0, 2))
    return Medium.biaxial(tuple(np.sort(rng.uniform(1.5, 1.7, (3, size)), axis=0)), axes)


def random_faces(source: str, target: str, size: int, seed: int = 0, largest: float = 1.4) -> Faces:
    """Return faces of random media, another for every ray, with tangential k up to `largest` (≤ 1.5: all propagate)."""
    rng = np.random.default_rng(seed)
    near, far = _medium(source, rng, size), _medium(target, rng, size)
    normal = np.zeros((3, size))
    normal[2] = 1.0
    angle, length = rng.uniform(0, 2 * np.pi, size), rng.uniform(0, largest, size)
    tangential = np.stack((length * np.cos(angle), length * np.sin(angle), np.zeros(size)))
    return Faces(normal, tangential, near, far)


def numpy_face(faces: Faces) -> Face:
    """Do with the package what one event is."""
    frame = interface_frame(faces.normal, faces.tangential)
    face = solve_face(framed(faces.source, frame), framed(faces.target, frame), False, False)
    face.transmission(0)
    face.reflection(0, 0)
    face.reflection(1, 0)
    for wave in (*face.reflected, *face.transmitted):
        wave.ray  # noqa: B018
    return face


def numpy_outcome(faces: Faces) -> NDArray[np.float64]:
    """Return what `compiled_events` writes, shape (OUTCOME, N), from the package."""
    face = numpy_face(faces)
    rows: list[Field | None] = [*face.transmission(0), face.reflection(0, 0), face.reflection(1, 0)]
    for wave in (*face.reflected, *face.transmitted):
        rows += [wave.q, *wave.ray]
    shape = face.frame.kappa.shape
    return np.stack([np.broadcast_to(0.0 if row is None else row, shape) for row in rows])


def worst_difference(faces: Faces, outcome: NDArray[np.float64]) -> float:
    """Return the largest difference between a compiled outcome and the package, relative where above 1."""
    expected = numpy_outcome(faces)
    difference = np.abs(outcome - expected) / np.maximum(1.0, np.abs(expected))
    return float(difference.max())  # NaN, which no limit lets pass, if there is one


class Compiled:
    """One batch of faces packed for a compiled loop, compiled when made.

    Parameters
    ----------
    source, target : str
        The kinds of media.
    faces : Faces
        The batch.
    """

    def __init__(self, source: str, target: str, faces: Faces) -> None:
        self.rays = faces.normal.shape[1]
        self._events = compiled_events(source, target)
        self._faces = packed(faces.normal, faces.tangential)
        self._media = packed_medium(faces.source), packed_medium(faces.target)
        self._outcome = packed(np.full((OUTCOME, self.rays), np.nan))
        self.run()

    def run(self) -> None:
        """Compute the outcome of every face."""
        self._events(self.rays, self._faces, *self._media, self._outcome)

    @property
    def outcome(self) -> NDArray[np.float64]:
        """The last outcome, shape (OUTCOME, N)."""
        return self._outcome[:, : self.rays]


def _best_times(rounds: int, runs: Sequence[Callable[[], object]]) -> list[float]:
    """Return the shortest time of each.

    They take turns, so that a busy moment of the machine meets all of them; each turn has a few rounds, since the first
    one finds the caches full of what the others did.
    """
    best = [np.inf] * len(runs)
    for _ in range(max(1, rounds // TURN)):
        for place, run in enumerate(runs):
            for _ in range(TURN):
                started = time.perf_counter()
                run()
                best[place] = min(best[place], time.perf_counter() - started)
    return best


def main() -> None:
    """Print the rates for each kind of pair."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--batch", type=int, default=BATCH, help="rays per call; the renderer's by default")
    parser.add_argument("--rounds", type=int, default=90)
    wanted = parser.parse_args()
    keep_freed_memory()
    print(f"Python {platform.python_version()}, NumPy {np.__version__}, Numba {numba.__version__}; ", end="")
    print(f"float64, batches of {wanted.batch}, one core, best of {wanted.rounds} rounds; million events per second")
    print(f"{'':24s}   NumPy  compiled  ratio  vectorised  ratio  difference")
    pairs = [(source, target) for source in KINDS for target in KINDS]
    batches = [random_faces(source, target, wanted.batch) for source, target in pairs]
    plain = [Compiled(*pair, faces) for pair, faces in zip(pairs, batches, strict=True)]
    vectorise_from_now_on()
    vectorised = [Compiled(*pair, faces) for pair, faces in zip(pairs, batches, strict=True)]
    for pair, faces, *both in zip(pairs, batches, plain, vectorised, strict=True):
        worst = max(worst_difference(faces, one.outcome) for one in both)
        if not worst <= AGREEMENT:
            raise SystemExit(f"{pair[0]} -> {pair[1]}: NumPy and compiled differ by {worst:.1e}")
        times = _best_times(wanted.rounds, (partial(numpy_face, faces), both[0].run, both[1].run))
        ours, scalar, vector = (wanted.batch / seconds / 1e6 for seconds in times)
        print(
            f"{pair[0]:9s} -> {pair[1]:9s}   {ours:8.2f}  {scalar:8.2f}  {scalar / ours:5.2f}"
            f"  {vector:10.2f}  {vector / ours:5.2f}     {worst:.1e}",
            flush=True,
        )


if __name__ == "__main__":
    main()
