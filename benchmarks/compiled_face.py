"""One event at a face between any two media, compiled: frame, waves, amplitudes of one incident mode, rays."""

from __future__ import annotations

from collections.abc import Callable

import llvmlite.binding
import numpy as np

from benchmarks.compiled_biaxial import biaxial_ahead, biaxial_all
from benchmarks.compiled_frame import Array, bilinear, compiled, frame_of, norm
from benchmarks.compiled_isotropic import isotropic_ahead, isotropic_all
from benchmarks.compiled_uniaxial import uniaxial_ahead, uniaxial_all
from crystal_core.optics import Medium

__all__ = ["OUTCOME", "compiled_events", "packed", "packed_medium", "vectorise_from_now_on"]

OUTCOME = 20
"""Numbers per event: two transmitted and two reflected amplitudes; q of the four outgoing waves (two reflected, two
transmitted); their rays."""

PADDING = 8

ALL = {"isotropic": isotropic_all, "uniaxial": uniaxial_all, "biaxial": biaxial_all}
AHEAD = {"isotropic": isotropic_ahead, "uniaxial": uniaxial_ahead, "biaxial": biaxial_ahead}


def packed(*columns: Array) -> Array:
    """Return values and vectors of every ray as the rows of one array, a few columns wider than there are rays.

    Without them rows a power of two bytes apart would share one set of the cache, and half of the time go to that.
    """
    rows = np.concatenate([np.atleast_2d(c).reshape(-1, c.shape[-1]) for c in columns])
    return np.pad(rows, ((0, 0), (0, PADDING)))


def packed_medium(medium: Medium) -> Array:
    """Return a medium of one value per ray as rows: its indices, then the components of its axis or axes."""
    return packed(*medium.indices, *(a for a in (medium.axis, medium.axes) if a is not None))


def vectorise_from_now_on() -> None:
    """Let LLVM use the vector unit in what is compiled from now on; whoever wants both compiles the plain one first.

    It leaves loops over so many arrays scalar, since it would have to check beforehand that no two of them overlap;
    this raises the number of such checks it may make. Nothing about the arithmetic changes.
    """
    llvmlite.binding.set_option("isogyre", "-vectorize-memory-check-threshold=10000")


def compiled_events(source: str, target: str) -> Callable[[int, Array, Array, Array, Array], None]:
    """Return the compiled loop of a pair of kinds.

    Its arguments are the number of rays; normal and tangential k, six rows; source; target; outcome, OUTCOME rows: all
    as `packed` makes them.
    """
    waves_of_source, waves_of_target = ALL[source], AHEAD[target]

    def events(rays: int, faces: Array, near: Array, far: Array, outcome: Array) -> None:
        for i in range(rays):
            frame = frame_of(faces[0, i], faces[1, i], faces[2, i], faces[3, i], faces[4, i], faces[5, i])
            in0, in1, back0, back1 = waves_of_source(near, i, frame)
            out0, out1 = waves_of_target(far, i, frame)

            g00, g01 = bilinear(in0, out0), bilinear(in0, out1)
            g10, g11 = bilinear(in1, out0), bilinear(in1, out1)
            scale = norm(in0) / (g00 * g11 - g01 * g10)
            t0, t1 = g11 * scale, -g10 * scale
            outcome[0, i], outcome[1, i] = t0, t1
            outcome[2, i] = (t0 * bilinear(back0, out0) + t1 * bilinear(back0, out1)) / norm(back0)
            outcome[3, i] = (t0 * bilinear(back1, out0) + t1 * bilinear(back1, out1)) / norm(back1)
            row = 4
            for wave in (back0, back1, out0, out1):
                outcome[row, i] = wave.q
                outcome[row + 1, i], outcome[row + 2, i], outcome[row + 3, i] = wave.rx, wave.ry, wave.rz
                row += 4

    return compiled(events)
