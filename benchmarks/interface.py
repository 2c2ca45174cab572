"""Events per second at faces between isotropic and uniaxial media, on one core: one incident mode per event.

Run: ``python -m benchmarks.interface``.
"""

from __future__ import annotations

import time

import numpy as np

from crystal_core.optics import Medium, interface_frame
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.interface import solve_face
from crystal_core.render import keep_freed_memory
from crystal_core.render.rays import BATCH

ROUNDS = 40


def _medium(kind: str, rng: np.random.Generator) -> Medium:
    if kind == "isotropic":
        return Medium.isotropic(rng.uniform(1.5, 1.7, BATCH))
    if kind == "biaxial":
        axes = np.moveaxis(np.linalg.qr(rng.normal(size=(BATCH, 3, 3)))[0], 0, 2)
        return Medium.biaxial(tuple(np.sort(rng.uniform(1.5, 1.7, (3, BATCH)), axis=0)), axes)
    axis = rng.normal(size=(3, BATCH))
    return Medium.uniaxial(
        rng.uniform(1.5, 1.7, BATCH), rng.uniform(1.5, 1.7, BATCH), axis / np.sqrt(np.sum(axis * axis, axis=0))
    )


def events_per_second(source: str, target: str) -> float:
    """Return the rate: frame, four or six waves, amplitudes of one incident mode into all outgoing ones."""
    rng = np.random.default_rng(0)
    near, far = _medium(source, rng), _medium(target, rng)
    normal = np.zeros((3, BATCH))
    normal[2] = 1.0
    angle, length = rng.uniform(0, 2 * np.pi, BATCH), rng.uniform(0, 1.4, BATCH)
    tangential = np.stack((length * np.cos(angle), length * np.sin(angle), np.zeros(BATCH)))
    best = np.inf
    for _ in range(ROUNDS):
        started = time.perf_counter()
        frame = interface_frame(normal, tangential)
        face = solve_face(framed(near, frame), framed(far, frame), False, False)
        face.transmission(0)
        face.reflection(0, 0)
        face.reflection(1, 0)
        for wave in (*face.reflected, *face.transmitted):
            wave.ray  # noqa: B018
        best = min(best, time.perf_counter() - started)
    return BATCH / best


def main() -> None:
    """Print the rate for each kind of pair."""
    keep_freed_memory()
    for source in ("isotropic", "uniaxial", "biaxial"):
        for target in ("isotropic", "uniaxial", "biaxial"):
            print(f"{source:9s} -> {target:9s}  {events_per_second(source, target) / 1e6:6.2f} M events/s")


if __name__ == "__main__":
    main()
