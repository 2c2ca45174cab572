"""The batch functions in float32, against themselves in float64: within the bound that `Medium.astype` states."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from crystal_core.optics import Medium, interface_frame
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.interface import Face, solve_face

COUNT = 20_000
ROOTS, ENERGY = 5e-6, 2e-6
KINDS = ("isotropic", "uniaxial", "biaxial")


def _medium(kind: str, rng: np.random.Generator) -> Medium:
    indices = rng.uniform(1.3, 2.3, (3, COUNT))
    axes = np.moveaxis(np.linalg.qr(rng.normal(size=(COUNT, 3, 3)))[0], 0, 2)
    if kind == "isotropic":
        return Medium.isotropic(indices[0])
    if kind == "uniaxial":
        return Medium.uniaxial(indices[0], indices[1], axes[0] / np.linalg.norm(axes[0], axis=0))
    return Medium.biaxial(tuple(indices), axes)


def _face(source: Medium, target: Medium, angle: NDArray, kappa: NDArray, precision: type[np.floating]) -> Face:
    normal = np.zeros((3, COUNT), precision)
    normal[2] = 1
    tangential = np.stack((kappa * np.cos(angle), kappa * np.sin(angle), 0 * kappa)).astype(precision)
    frame = interface_frame(normal, tangential)
    here, there = framed(source.astype(precision), frame), framed(target.astype(precision), frame)
    return solve_face(here, there, False, False)


@pytest.mark.parametrize("target", KINDS)
@pytest.mark.parametrize("source", KINDS)
def test_single_precision_keeps_its_bound(source: str, target: str) -> None:
    rng = np.random.default_rng(1)
    media = _medium(source, rng), _medium(target, rng)
    angle = rng.uniform(0, 2 * np.pi, COUNT)
    kappa = rng.uniform(0, 0.95, COUNT) * np.min(np.broadcast_arrays(*media[0].indices, *media[1].indices), axis=0)
    double, single = (_face(*media, angle, kappa, precision) for precision in (np.float64, np.float32))
    for ours, truth in zip(
        (*single.reflected, *single.transmitted), (*double.reflected, *double.transmitted), strict=True
    ):
        assert ours.q.dtype == np.float32
        np.testing.assert_allclose(ours.q, truth.q, rtol=0, atol=ROOTS)
        # not double precision in disguise
        assert np.abs(ours.q - truth.q).max() > 1e-8
    for j in (0, 1):
        flow = [np.abs(single.transmission(j)[i]) ** 2 * single.transmitted[i].flux() for i in (0, 1)]
        flow += [-(np.abs(single.reflection(i, j)) ** 2) * single.reflected[i].flux() for i in (0, 1)]
        np.testing.assert_allclose(sum(flow) / single.incident[j].flux(), 1, rtol=0, atol=ENERGY)


def test_a_medium_keeps_all_its_parts() -> None:
    medium = Medium.biaxial((1.5, 1.6, 1.7), np.eye(3), (0.1, 0.2, 0.3)).active(1e-4 * np.eye(3))
    single = medium.astype(np.float32)
    parts = (*single.indices, single.axes, *single.absorption_per_mm, single.absorption_axes, single.gyration)
    assert all(part.dtype == np.float32 for part in parts)
    assert single.astype(np.float64).indices[1] == pytest.approx(1.6, abs=1e-7)
