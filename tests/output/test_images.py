from __future__ import annotations

import hashlib
import io
import subprocess
import sys
from collections.abc import Sequence
from typing import overload

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from crystal_core.output.images import (
    animation_frame_ms,
    decode_png,
    encode_animated_webp,
    encode_png,
    encode_webp,
)

Picture = NDArray[np.uint8]


def printed(shift: int = 0, size: tuple[int, int] = (192, 160)) -> Picture:
    """A page with digits and lines of one pixel, warm white and shaded."""
    picture = Image.new("L", size, 255)
    draw = ImageDraw.Draw(picture)
    for y in range(4, size[1], 32):
        draw.text((6 + shift, y), "0123456789", font=ImageFont.load_default(size=22), fill=25)
        draw.line([(0, y + 26), (size[0], y + 26)], fill=40)
    for x in range(0, size[0], 24):
        draw.line([(x + shift, 0), (x + shift, size[1])], fill=40)
    shade = np.linspace(1.0, 0.7, size[0])[None, :, None] * np.array([1.0, 0.98, 0.93])
    return (np.asarray(picture)[..., None] * shade).astype(np.uint8)


def noise(seed: int = 0, shape: tuple[int, ...] = (24, 40, 3)) -> Picture:
    return np.random.default_rng(seed).integers(0, 256, shape, dtype=np.uint8)


def decoded(data: bytes) -> NDArray[np.int64]:
    with Image.open(io.BytesIO(data)) as picture:
        return np.asarray(picture.convert("RGB")).astype(np.int64)


def lightness(rgb: NDArray[np.int64]) -> NDArray[np.float64]:
    return rgb @ np.array([0.299, 0.587, 0.114])


@pytest.mark.parametrize("picture", [noise(), printed(), noise()[::-1, ::2], noise(shape=(1, 1, 3))])
def test_png_is_exact(picture: Picture) -> None:
    data = encode_png(picture)
    assert (decoded(data) == picture).all()
    assert (decode_png(data) == picture).all()


def test_png_says_srgb_and_nothing_that_varies() -> None:
    data = encode_png(noise())
    kinds, at = [], 8
    while at < len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        kinds.append(data[at + 4 : at + 8].decode())
        at += 12 + length
    assert list(dict.fromkeys(kinds)) == ["IHDR", "sRGB", "IDAT", "IEND"]


SHOW_DIGESTS = """
import hashlib
from crystal_core.output.images import encode_animated_webp, encode_png, encode_webp
from tests.output.test_images import printed
for data in (encode_png(printed()), encode_webp(printed()), encode_animated_webp([printed(0), printed(3)], 100)):
    print(hashlib.sha256(data).hexdigest())
"""


def test_another_process_makes_the_same_bytes() -> None:
    ours = [encode_png(printed()), encode_webp(printed()), encode_animated_webp([printed(0), printed(3)], 100)]
    theirs = subprocess.run(
        [sys.executable, "-c", SHOW_DIGESTS], capture_output=True, text=True, check=True, timeout=60
    ).stdout.split()
    assert theirs == [hashlib.sha256(data).hexdigest() for data in ours]


@pytest.mark.parametrize("animated", [False, True])
def test_webp_keeps_thin_lines_and_digits(animated: bool) -> None:
    picture = printed()
    data = encode_animated_webp([picture, printed(3)], 100) if animated else encode_webp(picture)
    error = lightness(decoded(data)) - lightness(picture.astype(np.int64))
    assert np.sqrt((error**2).mean()) < 2.0
    assert np.abs(error).max() < 14.0


def test_the_animation_plays_every_frame_for_ever() -> None:
    pictures = [printed(shift) for shift in (0, 4, 8, 12, 16)]
    with Image.open(io.BytesIO(encode_animated_webp(pictures, 70))) as film:
        assert (film.n_frames, film.info["loop"], film.size) == (5, 0, (192, 160))
        for index, picture in enumerate(pictures):
            film.seek(index)
            film.load()
            error = lightness(np.asarray(film.convert("RGB")).astype(np.int64)) - lightness(picture.astype(np.int64))
            assert np.sqrt((error**2).mean()) < 2.0
            assert film.info["duration"] == 70


def test_an_animation_of_one_frame_is_a_picture() -> None:
    with Image.open(io.BytesIO(encode_animated_webp([printed()], 70))) as film:
        assert film.size == (192, 160)


class LateFrames(Sequence[Picture]):
    """Notes which pictures have been asked for."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.asked: list[int] = []

    def __len__(self) -> int:
        return self.count

    @overload
    def __getitem__(self, index: int) -> Picture: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Picture]: ...
    def __getitem__(self, index: int | slice) -> Picture | Sequence[Picture]:
        assert isinstance(index, int)
        self.asked.append(index)
        return printed(index)


def test_each_frame_is_asked_for_once_in_order() -> None:
    frames = LateFrames(6)
    assert encode_animated_webp(frames, 50) == encode_animated_webp([printed(index) for index in range(6)], 50)
    assert frames.asked == list(range(6))


@pytest.mark.parametrize(("frames", "milliseconds"), [(1, 200), (30, 200), (36, 167), (60, 100), (150, 40), (360, 40)])
def test_a_turn_takes_six_seconds_where_that_looks_well(frames: int, milliseconds: int) -> None:
    assert animation_frame_ms(frames) == milliseconds


@pytest.mark.parametrize(
    "picture",
    [noise().astype(np.float32), noise()[..., 0], noise(shape=(4, 4, 4)), noise(shape=(0, 4, 3))],
    ids=["float", "grey", "four channels", "empty"],
)
def test_what_is_no_picture_is_refused(picture: Picture) -> None:
    for encode in (encode_png, encode_webp, lambda p: encode_animated_webp([p], 100)):
        with pytest.raises(ValueError, match="a picture is uint8"):
            encode(picture)


def test_bad_animations_are_refused() -> None:
    with pytest.raises(ValueError, match="at least one frame"):
        encode_animated_webp([], 100)
    with pytest.raises(ValueError, match="at least 1 ms"):
        encode_animated_webp([noise()], 0)
    with pytest.raises(ValueError, match="one size"):
        encode_animated_webp([noise(), noise(shape=(24, 41, 3))], 100)


def test_too_wide_for_webp() -> None:
    with pytest.raises(ValueError, match="at most 16383"):
        encode_webp(np.zeros((1, 16384, 3), np.uint8))


@pytest.mark.parametrize("cut", [4, 60, -200])
def test_a_broken_png_is_refused(cut: int) -> None:
    with pytest.raises(ValueError, match="not a whole PNG"):
        decode_png(encode_png(noise(shape=(64, 64, 3)))[:cut])


def test_a_png_of_another_kind_is_refused() -> None:
    stream = io.BytesIO()
    Image.new("L", (4, 4)).save(stream, "PNG")
    with pytest.raises(ValueError, match="RGB, not L"):
        decode_png(stream.getvalue())
