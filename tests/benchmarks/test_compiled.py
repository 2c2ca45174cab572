"""The compiled yardstick of the benchmark computes what the package computes, in its rare branches too."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np
import pytest

pytest.importorskip("numba", reason="Numba is a dependency of the benchmarks alone: `make benchmarks` installs it")

from benchmarks.interface import AGREEMENT, KINDS, Compiled, Faces, numpy_outcome, random_faces, worst_difference
from crystal_core.optics.indicatrix import BiaxialIndicatrix

PAIRS = list(itertools.product(KINDS, KINDS))
SIZE = 2000


@pytest.mark.parametrize(("source", "target"), PAIRS)
def test_compiled_and_numpy_agree(source: str, target: str) -> None:
    for seed, largest in ((0, 1.4), (1, 1.4995)):
        faces = random_faces(source, target, SIZE, seed, largest)
        faces.tangential[:, ::50] = 0.0
        assert worst_difference(faces, Compiled(source, target, faces).outcome) <= AGREEMENT


@pytest.mark.parametrize("kinds", [("biaxial", "isotropic"), ("isotropic", "biaxial")])
@pytest.mark.parametrize("angle", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5])
def test_they_agree_near_an_optic_axis(kinds: tuple[str, str], angle: float) -> None:
    faces = random_faces(*kinds, SIZE)
    crystal = faces.source if kinds[0] == "biaxial" else faces.target
    rng = np.random.default_rng(2)
    along = crystal.indices[1] * (BiaxialIndicatrix.of(crystal).optic_axes()[0] + angle * rng.normal(size=(3, SIZE)))
    reach = np.sqrt(np.sum(along[:2] ** 2, axis=0)) < 1.4
    rays = np.flatnonzero(reach)
    assert rays.size > SIZE / 4
    along[2] = 0.0
    near = Faces(
        faces.normal[:, rays], np.ascontiguousarray(along[:, rays]), faces.source.take(rays), faces.target.take(rays)
    )
    # The direction of either wave is uncertain by rounding over the angle to the axis.
    assert worst_difference(near, Compiled(*kinds, near).outcome) <= AGREEMENT + 1e-14 / angle


def test_a_difference_would_be_seen() -> None:
    faces = random_faces("uniaxial", "biaxial", 50)
    outcome = numpy_outcome(faces)
    assert worst_difference(faces, outcome) == 0.0
    assert worst_difference(dataclasses.replace(faces, source=faces.source.take(np.arange(50)[::-1])), outcome) > 1e-3
    outcome[3, 7] += 1e-10
    assert worst_difference(faces, outcome) > AGREEMENT
    outcome[3, 7] = np.nan
    assert not worst_difference(faces, outcome) <= AGREEMENT
