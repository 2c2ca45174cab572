"""The programs of docs/tour.md, run as they stand there, and what their picture shows."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter

from crystal_core.sequence import assemble, manifest, parse_request, render_tile, tile_grid
from tests.docs.blocks import ROOT, programs, run
from tests.reference.block_trace import find_image

Real = NDArray[np.float64]

PICTURE, OPTICS = programs("docs/tour.md")


@dataclass(frozen=True)
class Outcome:
    """A program after its run: its variables, what it printed, where it ran."""

    variables: dict[str, Any]
    printed: str
    folder: Path


@pytest.fixture(scope="module")
def picture(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    folder = tmp_path_factory.mktemp("tour")
    return Outcome(*run(PICTURE, folder), folder)


def on_top(side: int) -> tuple[slice, slice]:
    """Return rows and columns of a square on the top face alone, in the light."""
    return slice(int(0.35 * side), int(0.57 * side)), slice(int(0.44 * side), int(0.66 * side))


def correlation(linear: NDArray[np.float32]) -> tuple[Real, int]:
    """Return how much the print seen through the top face resembles itself shifted, 1 without a shift, and the reach.

    Row reach + dy, column reach + dx hold the shift by (dx, dy) pixels. Shading, which changes slowly, is taken off.
    """
    side = linear.shape[0]
    grey = linear.mean(axis=-1, dtype=np.float64)
    grey -= gaussian_filter(grey, side / 48)
    reach = side // 16
    still = grey[on_top(side)]
    shifts = range(-reach, reach + 1)
    rolled = [[np.roll(grey, (-dy, -dx), (0, 1))[on_top(side)] for dx in shifts] for dy in shifts]
    return np.sum(still * np.array(rolled), axis=(2, 3)) / np.sum(still**2), reach


def test_the_first_picture_takes_thirty_lines() -> None:
    assert len(PICTURE.source.splitlines()) <= 30


def test_it_prints_what_the_page_says(picture: Outcome) -> None:
    assert picture.printed == PICTURE.prints


def test_it_writes_the_picture(picture: Outcome) -> None:
    written = np.asarray(Image.open(picture.folder / "calcite.png"))
    np.testing.assert_array_equal(written, picture.variables["pixels"])


def test_the_picture_of_the_page_is_this_one(picture: Outcome) -> None:
    shown = np.asarray(Image.open(ROOT / "docs" / "pictures" / "tour.png"), np.float64)
    made = picture.variables["pixels"].astype(np.float64)
    assert shown.shape == made.shape
    # Another machine may end other faint branches; another scene differs by far more.
    assert np.sqrt(np.mean((shown - made) ** 2)) < 8.0, "make it anew: python tools/make_pictures.py"


def test_the_picture_is_doubled_where_an_exact_trace_says(picture: Outcome) -> None:
    request = picture.variables["request"]
    facts = manifest(request, [], complete=False)
    angle = request.parameters.first_angle_deg
    ordinary, extraordinary = (
        find_image(facts, (0.0, 0.0), mode, angle, facts["scene"]["n_o"], facts["scene"]["n_e"]).pixel
        for mode in ("ordinary", "extraordinary")
    )
    expected = extraordinary - ordinary
    assert np.hypot(*expected) > 8.0  # pixels: more than a stroke of a digit is wide

    seen, reach = correlation(picture.variables["frame"].linear)
    dy, dx = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    seen[dx**2 + dy**2 < 0.6 * np.hypot(*expected) ** 2] = 0.0  # a stroke resembles itself beside itself
    row, column = np.unravel_index(np.argmax(seen), seen.shape)
    found = np.array((column - reach, row - reach))
    found = found if found @ expected > 0 else -found  # a correlation is the same both ways
    assert np.hypot(*(found - expected)) < 1.0
    assert seen.max() > 0.35  # two images of equal darkness: 0.5 if nothing else resembled or disturbed


def test_an_isotropic_block_does_not_double(picture: Outcome) -> None:
    request = picture.variables["request"].canonical()
    request["parameters"]["mineral"] = "spinel"  # of an index near calcite's
    parsed = parse_request(request)
    single = assemble(parsed, [render_tile(parsed, 0, number) for number in range(len(tile_grid(parsed)))]).linear
    double = picture.variables["frame"].linear

    of_single, of_double = correlation(single)[0], correlation(double)[0]
    peak = np.unravel_index(np.argmax(of_double - of_single), of_double.shape)
    assert abs(of_single[peak]) < 0.15
    assert of_double[peak] > of_single[peak] + 0.3
    # Where a stroke covers a point in one of two images, the other shows paper: hardly anything is black any more.
    side = single.shape[0]
    single_top, double_top = (linear[on_top(side)].mean(axis=-1) for linear in (single, double))
    dark = 0.35 * np.median(single_top)
    assert np.mean(single_top < dark) > 0.05
    assert np.mean(double_top < dark) < 0.2 * np.mean(single_top < dark)
    # Beside the block, away from its shadow, nothing is different but how many samples a pixel got.
    np.testing.assert_allclose(double[: side // 12], single[: side // 12], atol=0.08)


def test_the_optics_print_what_the_page_says(tmp_path: Path) -> None:
    assert run(OPTICS, tmp_path)[1] == OPTICS.prints
