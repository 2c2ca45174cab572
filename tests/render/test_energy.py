"""Energy: a lossless crystal in a uniform world cannot be seen, and a face gives out what it takes in."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike

from crystal_core.optics import Coherency, Medium, interface_frame
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.interface import solve_face
from crystal_core.render import Illumination, Quality, render_pixels
from crystal_core.render.anisotropic_events import AnisotropicEvents, _shares
from crystal_core.render.illumination import plate_transmittance
from crystal_core.render.rays import InsideRays
from crystal_core.render.tracer import AIR, Arrivals, Roulette
from crystal_core.scene import StagedPage, StagedScene
from crystal_core.scene.staged.medium import StagedMedium
from crystal_core.scene.texture import Texture
from tests.render.tabletops import tabletop

SIZE = (48, 48)


def _uniform(mineral: str, analyser_deg: float | None, tilt_deg: float = 40.0) -> StagedScene:
    """Return a specimen between a sky and a page of the same radiance, 1."""
    tilt = np.deg2rad(tilt_deg)
    staged = tabletop(
        mineral,
        size_mm=(20.0, 18.0, 12.0),
        azimuth_deg=20.0,
        stage_deg=25.0,
        eye_mm=(0.0, -150 * np.sin(tilt), 6 + 150 * np.cos(tilt)),
        target_mm=(0.0, 0.0, 6.0),
        vfov_deg=11.0,
        analyser_deg=analyser_deg,
        sky_fraction=1.0,
        exposure=1.0,
    )
    page = StagedPage(Texture(np.ones((4, 4, 1), np.float32), 64.0), table_reflectance=1.0)
    lossless = replace(staged.specimen, filling=_Lossless(**vars(staged.specimen.filling)))
    return replace(staged, page=page, specimen=lossless)


class _Lossless(StagedMedium):
    """A medium without its absorption."""

    def at(self, wavelength_nm: ArrayLike) -> Medium:
        return super().at(wavelength_nm).transparent()


@pytest.mark.parametrize("mineral", ["calcite", "rutile", "fluorite", "diamond", "topaz", "aragonite"])
@pytest.mark.parametrize("analyser_deg", [None, 30.0])
def test_furnace(mineral: str, analyser_deg: float | None) -> None:
    """Every pixel within noise, the mean within 0.5 % of what is seen with no crystal, at four wavelengths each.

    Roulette is the only noise here; what it ends it makes up for, so the mean over some thousand pixels tells a bias.
    """
    quality = Quality("furnace", 0.0, (2,), 4, 9.0, 0.02)
    scene = _uniform(mineral, analyser_deg)
    done = render_pixels(scene, Illumination(scene), quality, SIZE, (0, 0, *SIZE), (3, 0, 0))
    whole = 1.0 if analyser_deg is None else 0.5
    per_pixel = done.pixels.astype(np.float64) / whole
    assert done.events > 10_000
    assert np.abs(per_pixel.mean(axis=(0, 1)) - 1.0).max() < 5e-3
    assert np.abs(per_pixel - 1.0).max() < 0.5


@pytest.mark.parametrize("seed", [0, 1])
def test_a_face_gives_out_what_it_takes_in(seed: int) -> None:
    """Entry: reflected + refracted = arrived, for any polarization. Exit: the three shares add up to one."""
    rng = np.random.default_rng(seed)
    scene = _uniform("calcite", None)
    count = 4000
    face = rng.integers(0, 6, count)
    z = -scene.specimen.body.normals.T[:, face]
    d = rng.normal(size=(3, count))
    d /= np.sqrt(np.sum(d * d, axis=0))
    d *= np.where(np.sum(d * z, axis=0) > 0, 1.0, -1.0)
    a = rng.normal(size=(2, 2, count)) + 1j * rng.normal(size=(2, 2, count))
    c = np.einsum("ijn,kjn->ikn", a, np.conj(a))
    importance = Coherency(c[0, 0].real, c[1, 1].real, c[0, 1].real, c[0, 1].imag)
    lane = np.arange(count)
    medium = Medium.uniaxial(np.full(1, 1.6584), np.full(1, 1.4864), scene.specimen.axis)
    events = AnisotropicEvents(scene.specimen, medium)
    colour = np.zeros(count, np.intp)
    keep_all = Roulette(1e-300, np.random.default_rng(0))
    leaving, inside = events.enter(Arrivals(np.zeros((3, count)), d, face, importance, lane, colour), keep_all)
    out = leaving.importance.copy()
    for rays in inside:
        out += np.bincount(rays.lane, weights=rays.importance[0], minlength=count)
    np.testing.assert_allclose(out, importance.intensity(), rtol=1e-12)
    assert (leaving.importance > -1e-12 * out).all()

    for mode in (0, 1):
        rays = inside[mode]
        z_in = -z[:, rays.lane]
        kt = rays.k - np.sum(rays.k * z_in, axis=0) * z_in
        frame = interface_frame(z_in, kt)
        near = framed(Medium.uniaxial(1.6584, 1.4864, scene.specimen.axis), frame)
        back = solve_face(near, framed(AIR, frame), False, True)
        transmitted, reflected = _shares(back, mode)
        np.testing.assert_allclose(transmitted + reflected[0] + reflected[1], 1.0, atol=1e-12)
        # The other reflected mode takes the rest; its own amplitude says the same.
        other = 1 - mode
        exact = np.abs(back.reflection(other, mode)) ** 2 * np.abs(back.reflected[other].flux())
        np.testing.assert_allclose(reflected[other], exact / back.incident[mode].flux(), atol=1e-12)


def test_roulette_is_fair_and_keeps_siblings_together() -> None:
    rng = np.random.default_rng(5)
    count = 200_000
    shares = rng.uniform(0, 0.08, (2, count))
    depth = np.where(np.arange(count) % 2, 40, 0).astype(np.int16)
    roulette = Roulette(0.1, np.random.default_rng(6))
    survivors = roulette.survivors((shares[0], shares[1]), depth)
    carried = np.zeros((2, count))
    for row, (kept, factor) in enumerate(survivors):
        carried[row, kept] = shares[row, kept] * factor
    for row in (0, 1):  # the mean is kept: standard error about 1e-4
        assert carried[row].mean() == pytest.approx(shares[row].mean(), abs=5e-4)
    number = (carried > 0).sum(axis=0)
    expected = np.minimum(shares / 0.1, 1.0).sum(axis=0) * np.where(depth > 32, 0.95, 1.0)
    assert (np.abs(number - expected) < 1.0).all()


@pytest.mark.parametrize("n", [1.0001, 1.33, 1.66, 2.4])
def test_plate_transmittance_at_normal_incidence(n: float) -> None:
    """2n/(n² + 1): Born & Wolf §1.6.4, the incoherent sum of a plate's beams at normal incidence."""
    assert plate_transmittance(np.ones(1), n)[0] == pytest.approx(2 * n / (n * n + 1), rel=1e-12)
    grazing = plate_transmittance(np.array((1e-6,)), n)[0]
    assert 0.0 <= grazing < 0.02


def test_absorption_follows_beer_and_lambert() -> None:
    """A ray loses exp(−a·length) of its importance on its way to a face, each mode by its own coefficient."""
    scene = _uniform("calcite", None)
    per_mm = (0.05, 0.4)
    axis = np.array((1.0, 0.0, 0.0))
    medium = Medium.uniaxial(
        np.full(1, 1.6584), np.full(1, 1.4864), axis, (np.full(1, per_mm[0]), np.full(1, per_mm[1]))
    )
    events = AnisotropicEvents(scene.specimen, medium)
    assert not events.lossless
    body = scene.specimen.body
    middle = body.vertices.mean(axis=0)
    for mode, index in ((0, 1.6584), (1, 1.4864)):
        up = np.array((0.0, 0.0, 1.0))
        state = np.concatenate((middle, up, index * up, (1.0,)))[:, None]
        rays = InsideRays(state, np.zeros(1, np.intp), np.zeros(1, np.int16))
        leaving, inside = events.leave(rays, mode, Roulette(1e-300, np.random.default_rng(0)))
        out = leaving.importance.sum() + sum(part.importance.sum() for part in inside)
        assert out == pytest.approx(np.exp(-per_mm[mode] * 6.0), rel=1e-12)  # 6 mm from the middle to the top
