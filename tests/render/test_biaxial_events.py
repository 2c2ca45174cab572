"""Rays at the faces of a biaxial crystal against `optics.scatter`, which is held to independent solvers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from crystal_core.geometry.boxes import box
from crystal_core.geometry.visibility import face_finder
from crystal_core.optics import Coherency, Medium, optic_axes, scatter
from crystal_core.render.anisotropic_events import AnisotropicEvents
from crystal_core.render.rays import InsideRays
from crystal_core.render.tracer import AIR, Arrivals, Roulette
from crystal_core.scene import StagedSpecimen
from crystal_core.scene.media import Made, Optics
from crystal_core.scene.staged.medium import StagedMedium

COUNT = 3000
# Indices far apart: about one wave in fifty that goes to a face comes from a pair of two slow ones.
INDICES = (1.5, 1.75, 2.1)


def _keep_all() -> Roulette:
    return Roulette(1e-300, np.random.default_rng(0))


def _crystal(seed: int) -> tuple[StagedSpecimen, Medium]:
    rotation = Rotation.random(random_state=seed).as_matrix()
    body = box((5.0, 4.0, 3.0)).body
    filling = StagedMedium(Made(optics=Optics(alpha=1.5, beta=1.75, gamma=2.1)), rotation)
    specimen = StagedSpecimen(body, face_finder(body), filling)
    return specimen, Medium.biaxial(INDICES, rotation.T)


def _events(specimen: StagedSpecimen, medium: Medium) -> AnisotropicEvents:
    """Return the events of a pass of one wavelength."""
    assert medium.axes is not None
    return AnisotropicEvents(specimen, Medium.biaxial([np.full(1, n) for n in INDICES], medium.axes))


def _matching(k: np.ndarray, waves: tuple) -> np.ndarray:
    """Return the place of the wave of each ray in a pair, by its wave vector."""
    off = [np.sum((wave.k - k) ** 2, axis=0) for wave in waves]
    assert np.minimum(*off).max() < 1e-16
    return np.where(off[1] < off[0], 1, 0)


@pytest.mark.parametrize("seed", [1, 5, 8, 12])  # orientations in which faces meet the dimple of the outer sheet
def test_rays_at_faces(seed: int) -> None:
    rng = np.random.default_rng(seed)
    specimen, medium = _crystal(seed)
    events = _events(specimen, medium)
    face = rng.integers(0, 6, COUNT)
    z = -specimen.body.normals.T[:, face]
    d = rng.normal(size=(3, COUNT))
    d /= np.sqrt(np.sum(d * d, axis=0))
    d *= np.where(np.sum(d * z, axis=0) > 0, 1.0, -1.0)
    middle = np.array([specimen.body.vertices[list(specimen.body.faces[f])].mean(axis=0) for f in face]).T
    lane = np.arange(COUNT)
    unpolarized = Coherency.unpolarized(np.ones(COUNT))
    arrivals = Arrivals(middle, d, face, unpolarized, lane, np.zeros(COUNT, np.intp))
    leaving, inside = events.enter(arrivals, _keep_all())
    expected = scatter(z, d - np.sum(d * z, axis=0) * z, AIR, medium)
    for mode, rays in enumerate(inside):
        wave = expected.transmitted[mode]
        np.testing.assert_allclose(rays.k, wave.k[:, rays.lane], atol=1e-9)
        power = 0.5 * (expected.power_transmitted[mode][0] + expected.power_transmitted[mode][1])
        np.testing.assert_allclose(rays.importance[0], power[rays.lane], atol=1e-9)
        along = rays.ray / np.sqrt(np.sum(rays.ray**2, axis=0))
        np.testing.assert_allclose(along, wave.ray[:, rays.lane], atol=1e-7)
    reflected = 0.5 * sum(expected.power_reflected[i][j] for i in (0, 1) for j in (0, 1))
    np.testing.assert_allclose(leaving.importance, reflected, atol=1e-9)

    both_slow = 0
    for _ in range(4):  # faces: slanting waves, of which some meet others of their own sheet, come with reflections
        following: list[list[InsideRays]] = [[], []]
        for mode, rays in enumerate(inside):
            met, kept = _check_exit(specimen, medium, events, mode, rays)
            both_slow += met
            for pool, piece in zip(following, kept, strict=True):
                pool.append(piece)
        inside = [InsideRays.joined(pieces) for pieces in following]
        for number, rays in enumerate(inside):  # one of each lane, so that sums over lanes stay those of single rays
            one = np.unique(rays.lane, return_index=True)[1]
            one = one[rays.importance[0, one] > 1e-10]  # less is rounding: waves that carry nothing
            inside[number] = InsideRays(rays.state[:, one], rays.lane[one], rays.depth[one])
    assert both_slow > 10, "hardly a ray met the case of two slow waves"


def _check_exit(
    specimen: StagedSpecimen, medium: Medium, events: AnisotropicEvents, mode: int, rays: InsideRays
) -> tuple[int, list[InsideRays]]:
    """Check what leaves at the next face, and what stays; return how many rays had two slow waves, and what stays."""
    _, exit_face = specimen.body.exit(rays.point, rays.ray)
    z = specimen.body.normals.T[:, exit_face]
    kt = rays.k - np.sum(rays.k * z, axis=0) * z
    expected = scatter(z, kt, medium, AIR)
    column = _matching(rays.k, expected.incident)
    at = np.arange(len(rays))
    transmitted = np.array(
        [[expected.power_transmitted[i][j] for i in (0, 1)] for j in (0, 1)]
    ).sum(axis=1)[column, at]  # fmt: skip
    out, kept = events.leave(rays, mode, _keep_all())
    gone = np.bincount(out.lane, weights=out.importance, minlength=COUNT)[rays.lane] / rays.importance[0]
    np.testing.assert_allclose(gone, transmitted, atol=1e-8)
    for i, piece in enumerate(kept):
        power = np.array([expected.power_reflected[i][j] for j in (0, 1)])[column, at]
        found = np.bincount(piece.lane, weights=piece.importance[0], minlength=COUNT)[rays.lane] / rays.importance[0]
        np.testing.assert_allclose(found, power, atol=1e-8)
    slow = [wave.mode == "slow" for wave in expected.incident]
    return int(np.sum(slow[0] & slow[1])), kept


def test_rays_near_an_optic_axis_keep_energy_and_are_finite() -> None:
    """A cone of a thousandth of a degree about the axis, across which the two rays go round."""
    specimen, medium = _crystal(4)
    events = _events(specimen, medium)
    axis = optic_axes(Medium.biaxial(INDICES, specimen.filling.rotation.T))[0]
    top = int(np.argmax(specimen.body.normals @ axis))
    z = specimen.body.normals[top]
    index = INDICES[1]
    kt = index * (axis - (axis @ z) * z)
    if kt @ kt >= 1.0:
        pytest.skip("the axis cannot be reached from outside through this face")
    rng = np.random.default_rng(0)
    d = kt[:, None] + 1e-5 * rng.normal(size=(3, COUNT))
    d -= z[:, None] * (z @ d)
    d += -np.sqrt(1.0 - np.sum(d * d, axis=0)) * -z[:, None]
    point = np.repeat(specimen.body.vertices[list(specimen.body.faces[top])].mean(axis=0)[:, None], COUNT, axis=1)
    backward = -d
    face = np.full(COUNT, top)
    arrivals = Arrivals(
        point, backward, face, Coherency.unpolarized(np.ones(COUNT)), np.arange(COUNT), np.zeros(COUNT, np.intp)
    )
    leaving, inside = events.enter(arrivals, _keep_all())
    total = leaving.importance + sum(np.bincount(r.lane, weights=r.importance[0], minlength=COUNT) for r in inside)
    np.testing.assert_allclose(total, 1.0, atol=1e-12)
    for mode, rays in enumerate(inside):
        assert np.all(np.isfinite(rays.state))
        out, kept = events.leave(rays, mode, _keep_all())
        carried = np.bincount(out.lane, weights=out.importance, minlength=COUNT)
        carried += sum(np.bincount(r.lane, weights=r.importance[0], minlength=COUNT) for r in kept)
        np.testing.assert_allclose(carried[rays.lane], rays.importance[0], atol=1e-12)
