"""Single precision: rays and powers between each two modes against double precision, which is proven beside it.

Where all waves propagate, slant no more than 0.1 and stand 0.1 rad from the optic axes. Powers are within 2e-5 where no
medium is biaxial and within 4e-4 where one is: its optic axes follow from differences of indices, which single
precision rounds by 1e-7, and half of the crystals here have indices a few 1e-3 apart.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from crystal_core.optics import Scattering, interface_frame
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.interface import Face, solve_face
from crystal_core.optics.modes import Mode
from tests.reference.arithmetic import Array
from tests.reference.cases import Cases, angle_to_axes, random_cases
from tests.reference.media import KINDS, Kind

CASES = 3_000
RAYS = 5e-6
POWERS = {False: 2e-5, True: 4e-4}
"""By whether a medium is biaxial."""


def single(cases: Cases) -> tuple[Face, Array]:
    """Return the faces in float32 and the frames (3, 3, N) in which their components are counted."""
    frame = interface_frame(cases.normal.astype(np.float32), cases.tangential.astype(np.float32))
    here, there = (framed(media.medium().astype(np.float32), frame) for media in (cases.source, cases.target))
    return solve_face(here, there, False, False), np.array([frame.x, frame.y, frame.z])


def ray(mode: Mode, frame: Array) -> Array:
    parts = [np.zeros_like(mode.q) if v is None else v for v in mode.ray]
    vector = sum(part * row for part, row in zip(parts, frame, strict=True))
    return np.asarray(vector / np.linalg.norm(vector, axis=0))


def is_fair(cases: Cases, truth: Scattering) -> Array:
    """Return the cases whose waves all propagate, slant no more than 0.1 and stand 0.1 rad from the optic axes."""
    good = np.ones(cases.normal.shape[1], bool)
    for pair, media in (
        (truth.incident, cases.source),
        (truth.reflected, cases.source),
        (truth.transmitted, cases.target),
    ):
        for wave in pair:
            good &= wave.propagating & (np.abs(wave.flux) > 0.1)
            good &= np.abs(np.sum(wave.k * cases.normal, axis=0)) > 0.1
            for case in np.flatnonzero(good).tolist():
                good[case] = angle_to_axes(wave.k[:, case], media.optic_axes(case)) > 0.1
    return np.flatnonzero(good)


@pytest.mark.parametrize(("source", "target"), list(itertools.product(KINDS, KINDS)))
def test_rays_and_powers_in_single_precision(source: Kind, target: Kind) -> None:
    cases = random_cases(401, source, target, CASES)
    truth = cases.run()
    fair = is_fair(cases, truth)
    assert len(fair) > CASES // 3
    face, frame = single(cases.take(fair))
    waves = (*truth.incident, *truth.reflected, *truth.transmitted)
    modes = (*face.incident, *face.reflected, *face.transmitted)
    for wave, mode in zip(waves, modes, strict=True):
        assert mode.q.dtype == np.float32
        np.testing.assert_allclose(ray(mode, frame), wave.ray[:, fair], rtol=0, atol=RAYS)
    bound = POWERS["biaxial" in (source, target)]
    worst = 0.0
    for i, j in itertools.product(range(2), range(2)):
        flux = face.incident[j].flux()
        transmitted = np.abs(face.transmission(j)[i]) ** 2 * face.transmitted[i].flux() / flux
        reflected = -(np.abs(face.reflection(i, j)) ** 2) * face.reflected[i].flux() / flux
        for ours, theirs in (
            (transmitted, truth.power_transmitted[i][j][fair]),
            (reflected, truth.power_reflected[i][j][fair]),
        ):
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=bound)
            worst = max(worst, float(np.abs(ours - theirs).max()))
    assert worst > 1e-7  # not double precision in disguise
