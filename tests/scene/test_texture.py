"""Textures: averages over squares, marks where they belong, and files that are no pictures."""

import io

import numpy as np
import pytest
from PIL import Image

from crystal_core.errors import InputError
from crystal_core.scene.printed_page import printed_digits
from crystal_core.scene.prints import with_marks
from crystal_core.scene.texture import MAX_BYTES, Texture, check_texture, decode_texture


def _png(picture: Image.Image) -> bytes:
    buffer = io.BytesIO()
    picture.save(buffer, "PNG")
    return buffer.getvalue()


def test_average_over_a_square() -> None:
    rng = np.random.default_rng(0)
    texture = Texture(rng.random((64, 96, 3)).astype(np.float32), 9.6)  # texels of 0.1 mm
    x, y = rng.uniform(-2.5, 2.5, 50), rng.uniform(-1.5, 1.5, 50)
    fine = (np.arange(60) + 0.5) / 60 - 0.5
    for width in (0.2, 0.8, 1.6):
        got = texture.average(x, y, width)
        squares = []
        for i in range(x.size):
            dx, dy = np.meshgrid(x[i] + width * fine, y[i] + width * fine)
            exact = texture.average(dx.ravel(), dy.ravel(), 0.0).mean(axis=1)
            squares.append(np.mean((got[:, i] - exact) ** 2))
        # The texels are white noise of standard deviation 0.29; a square of w texels keeps 0.29/w of it. The kernel's
        # shape, though not its width, differs from a box's, by up to two fifths of what is left.
        assert np.sqrt(np.mean(squares)) < 0.4 * 0.29 / (width / 0.1)


def test_orientation() -> None:
    """Row 0 is the top, +y; column 0 the left, −x."""
    texels = np.zeros((2, 2, 1), np.float32)
    texels[0, 1] = 1.0
    texture = Texture(texels, 2.0)
    corners = texture.average(np.array((0.5, -0.5, 0.5)), np.array((0.5, 0.5, -0.5)), 0.0)[0]
    np.testing.assert_allclose(corners, (1.0, 0.0, 0.0), atol=1e-5)


def test_marks_stand_where_they_were_put() -> None:
    marks = ((3.137, -2.291), (-11.003, 7.717))
    bare = printed_digits()
    texture = with_marks(Texture(bare, 64.0), marks, 0.5, "/page")
    rows, columns = np.mgrid[0 : bare.shape[0], 0 : bare.shape[1]] + 0.5
    covered = 1.0 - texture.texels[..., 0] / bare[..., 0]
    for x, y in marks:
        column, row = (x + 32.0) / texture.texel_mm, (32.0 - y) / texture.texel_mm
        near = np.where(np.hypot(columns - column, rows - row) < 20, covered, 0.0)
        assert np.sum(near * columns) / near.sum() == pytest.approx(column, abs=0.01)
        assert np.sum(near * rows) / near.sum() == pytest.approx(row, abs=0.01)
        assert near.sum() * texture.texel_mm**2 == pytest.approx(np.pi * 0.25**2, rel=0.01)


def test_printed_digits_are_paper_and_ink() -> None:
    page = printed_digits()
    assert page.shape == (2048, 2048, 1)
    assert 0.03 < page.min() < 0.1
    assert page.max() == pytest.approx(0.9, abs=1e-6)
    assert 0.7 < np.mean(page > 0.85) < 0.95


def test_decoding() -> None:
    grey = decode_texture(_png(Image.new("L", (3, 2), 188)), "/t")
    assert grey.shape == (2, 3, 1)
    np.testing.assert_allclose(grey, 0.5029, atol=1e-4)  # IEC 61966-2-1: 188/255 → 0.5029
    coloured = decode_texture(_png(Image.new("RGBA", (2, 2), (255, 0, 0, 0))), "/t")
    np.testing.assert_allclose(coloured, 1.0)  # transparent: white paper


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"not a picture",
        _png(Image.new("L", (4, 4)))[:40],
        b"GIF89a" + b"\0" * 40,
        b"\x89PNG\r\n\x1a\n" + b"\0" * (MAX_BYTES + 1),
        _png(Image.new("1", (5000, 4000))),  # 20 MP in a few kB: a bomb
        _png(Image.new("1", (20000, 20000))),
    ],
    ids=["empty", "text", "cut off", "gif", "too many bytes", "bomb", "large bomb"],
)
def test_what_is_no_texture_is_refused(data: bytes) -> None:
    def both() -> None:
        check_texture(data, "/parameters/texture")  # cannot see what is broken further on in the file
        decode_texture(data, "/parameters/texture")

    with pytest.raises(InputError, match="/parameters/texture"):
        both()
