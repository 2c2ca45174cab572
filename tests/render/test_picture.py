"""Pictures: the same bits for the same request, the promised error, the sky in a mirror, the light on a page."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike

import minerals_db
from crystal_core.optics import Medium
from crystal_core.render import QUALITIES, Illumination, Quality, TilePixels, render_pixels, tuned_quality
from crystal_core.render.sampling import passes
from crystal_core.scene import StagedScene
from crystal_core.scene.staged.medium import StagedMedium
from tests.render.tabletops import tabletop

SIDE = 96
SIZE = (SIDE, SIDE)


class _AsUniaxial(StagedMedium):
    """An isotropic medium as a uniaxial one of two equal indices."""

    def at(self, wavelength_nm: ArrayLike) -> Medium:
        (n,) = super().at(wavelength_nm).indices
        return Medium.uniaxial(n, n, self.rotation[:, 2])


def _scene(mineral: str = "calcite", tilt_deg: float = 15.0, analyser_deg: float | None = None) -> StagedScene:
    tilt = np.deg2rad(tilt_deg)
    return tabletop(
        mineral,
        stage_deg=30.0,
        eye_mm=(0.0, -170 * np.sin(tilt), 7 + 170 * np.cos(tilt)),
        target_mm=(0.0, 0.0, 7.0),
        vfov_deg=16.0,
        analyser_deg=analyser_deg,
    )


def _render(scene: StagedScene, quality: Quality, box: tuple[int, int, int, int], seed: int = 0) -> TilePixels:
    return render_pixels(scene, Illumination(scene), quality, SIZE, box, (seed, 0, 0))


def test_same_arguments_same_bits() -> None:
    scene = _scene()
    box = (30, 50, 62, 82)
    first, again = (_render(scene, QUALITIES["standard"], box) for _ in range(2))
    np.testing.assert_array_equal(first.pixels, again.pixels)
    assert first.squared_error == again.squared_error
    assert not np.array_equal(first.pixels, _render(scene, QUALITIES["standard"], box, seed=1).pixels)


REFERENCE = Quality("reference", 0.0, (14,), 4, 9.0, 0.1)
"""196 positions with 784 wavelengths a pixel, textures averaged over 1/14 of it: nine and more times the samples of
what it judges."""


@pytest.mark.parametrize(
    ("name", "tilt_deg"),
    [
        pytest.param("draft", 15.0, id="draft"),
        pytest.param("standard", 15.0, id="standard"),
        pytest.param("standard", 50.0, id="standard, side faces", marks=pytest.mark.full),
        pytest.param("fine", 15.0, id="fine", marks=pytest.mark.full),
        pytest.param(
            "fine",
            50.0,
            id="fine, side faces",
            # Measured 0.008, estimated 0.0025: told in docs/rendering.md. Strict: whoever mends it is told so.
            marks=[pytest.mark.full, pytest.mark.xfail(strict=True, reason="0.008 instead of 0.004 on side faces")],
        ),
    ],
)
def test_the_promised_error(name: str, tilt_deg: float) -> None:
    """RMS difference from a converged picture, in linear sRGB with white = 1, is what the quality promises.

    In a view of much print and in one of much of the side faces, in which light goes round and round. The estimate must
    tell the error within a factor of two.
    """
    scene = _scene(tilt_deg=tilt_deg)
    illumination = Illumination(scene)
    box = (0, 0, *SIZE)
    reference = REFERENCE if name != "fine" else replace(REFERENCE, sides=(28,))
    converged = render_pixels(scene, illumination, reference, SIZE, box, (77, 0, 0)).pixels.astype(np.float64)
    quality = tuned_quality(scene, illumination, QUALITIES[name], SIZE, (0, 0))
    done = render_pixels(scene, illumination, quality, SIZE, box, (0, 0, 0))
    error = float(np.sqrt(np.mean((done.pixels - converged) ** 2)))
    estimate = float(np.sqrt(done.squared_error / converged[..., 0].size))
    print(f"{name}: error {error:.4f}, estimate {estimate:.4f}, promised {quality.target_error}")
    assert error <= quality.target_error
    assert error / 2 < estimate < error * 2


def test_white_balance() -> None:
    """A clear crystal under daylight adds no colour of its own beyond its fringes."""
    pixels = _render(_scene("fluorite"), QUALITIES["standard"], (38, 40, 58, 56)).pixels.astype(np.float64)
    mean = pixels.mean(axis=(0, 1))
    np.testing.assert_allclose(mean / mean.mean(), 1.0, atol=0.01)


def test_isotropic_rays_agree_with_the_equal_index_limit() -> None:
    """A uniaxial crystal with n_o = n_e looks as an isotropic one does.

    Two renderers of the same slab: one ray with its coherency matrix, or two modes along one path. They differ only in
    how polarized light fares at later faces.
    """
    from crystal_core.render import level

    scene = _scene("fluorite")
    box = (38, 40, 70, 60)
    quality = Quality("plain", 0.0, (4,), 4, 9.0, 0.02)
    isotropic = _render(scene, quality, box).pixels.astype(np.float64)
    limit = replace(scene, specimen=replace(scene.specimen, filling=_AsUniaxial(**vars(scene.specimen.filling))))
    assert level._events(limit.specimen, np.array((550.0,))).modes == 2
    uniaxial = _render(limit, quality, box).pixels.astype(np.float64)
    assert np.abs(isotropic.mean(axis=(0, 1)) - uniaxial.mean(axis=(0, 1))).max() < 2e-3
    assert np.sqrt(np.mean((isotropic - uniaxial) ** 2)) < 0.02


def test_point_light_and_sky_on_the_bare_page() -> None:
    """Inverse square and cosine, h/r³, against the closed form; the sky adds its share everywhere."""
    light = (-60.0, 80.0, 200.0)
    scene = tabletop(light_mm=light, sky_fraction=0.25)
    x, y = np.array((100.0, -80.0, 60.0)), np.array((-90.0, 70.0, 120.0))  # none in the shadow
    r2 = (x - light[0]) ** 2 + (y - light[1]) ** 2 + light[2] ** 2
    centre = light[2] / (light[0] ** 2 + light[1] ** 2 + light[2] ** 2) ** 1.5
    expected = 0.75 * (light[2] / r2**1.5) / centre + 0.25
    np.testing.assert_allclose(Illumination(scene).at(x, y), expected, rtol=1e-12)


def test_shadow_and_light_through_the_block() -> None:
    """Under the block the light is dimmed as by a plate; beside it, away from the light, it is blocked."""
    scene = tabletop(light_mm=(-100.0, 0.0, 400.0), sky_fraction=0.0)
    illumination = Illumination(scene)
    under, beside, clear = illumination.at(np.array((0.0, 12.5, -13.0)), np.zeros(3))
    assert under == pytest.approx(0.89, abs=0.02)  # 2n/(n²+1) for n about 1.57, slightly less on a slant
    assert beside == 0.0
    assert clear > 0.99


def test_light_through_a_coloured_block_has_its_colour() -> None:
    """Ruby lets red light through to the page and stops green; what goes through is Beer's law over the way inside."""
    scene = tabletop("ruby", light_mm=(0.0, 0.0, 4000.0), sky_fraction=0.0)
    illumination = Illumination(scene)
    lines = np.array((550.0, 650.0))
    coefficients = illumination.absorption_per_mm(lines)
    assert coefficients is not None
    ruby = minerals_db.mineral("ruby").absorption
    assert ruby is not None
    for axis, row in zip("ooe", coefficients, strict=True):
        np.testing.assert_array_equal(row, ruby.per_mm(axis, lines))
    place = np.zeros(1)
    way = illumination.way_mm(place, place)
    assert way[0] == pytest.approx(12.0, abs=1e-3)
    clear = illumination.at(place, place)
    green, red = (float(illumination.coloured(clear, way, coefficients[:, [k]])[0] / clear[0]) for k in (0, 1))
    assert red == pytest.approx(np.exp(-12.0 * coefficients[:, 1]).mean(), rel=1e-3)
    assert red > 10.0 * green
    beside = illumination.way_mm(np.array((30.0,)), place)
    assert beside[0] == 0.0


@pytest.mark.parametrize("side", [2, 4])
def test_passes_come_through_all_cells_along_rows_and_columns(side: int) -> None:
    """Else a fine line along a row of pixels would be seen by some wavelengths only, and be coloured."""
    along = np.arange(side * side, dtype=float)
    still = np.full(along.size, 3.0)
    for sample in passes(side, 4, seed=5):
        for across, down in ((along, still), (still, along)):
            x, y = sample.positions(across, down)
            assert (
                len({(int((x[i] - across[i]) * side), int((y[i] - down[i]) * side)) for i in range(x.size)}) == side**2
            )


def test_positions_tile_the_pixel() -> None:
    for side in (2, 4, 8):
        samples = passes(side, 4, seed=5)
        for pixel in (0.0, 5.0):
            across, down = np.array((pixel,)), np.array((2 * pixel,))
            positions = [sample.positions(across, down) for sample in samples]
            cells = {(int((x[0] - pixel) * side), int((y[0] - 2 * pixel) * side)) for x, y in positions}
            assert len(cells) == side * side == len(samples)
        assert sum(sample.half for sample in samples) == side * side // 2
        nm = np.concatenate([sample.wavelengths.wavelength_nm for sample in samples])
        assert np.unique(nm).size == 4 * side * side
