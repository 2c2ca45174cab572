"""Pictures as PNG and WebP bytes: the same picture always gives the same bytes."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, PngImagePlugin

__all__ = ["animation_frame_ms", "decode_png", "encode_animated_webp", "encode_png", "encode_webp"]

# Measured on a 512² page of digits and thin lines, with and without noise: the smallest files of levels 1 to 6, in half
# the time of level 6.
_PNG_LEVEL = 3
_SRGB_PERCEPTUAL = b"\x00"
# Measured on a 512² page of doubled digits and one-pixel lines, 36 frames: at quality 92 lightness is off by 1.4/255
# RMS and 9/255 at worst, 3.5 MB; lossless takes 14.6 MB. Method 4 saves 0.4 % of the size for 1.7 × the time of 2.
_WEBP: dict[str, Any] = {"quality": 92, "method": 2}
_WEBP_MAX_SIDE = 16383

_TURN_MS = 6000


def encode_png(rgb8: NDArray[np.uint8]) -> bytes:
    """Encode a picture as PNG, marked as sRGB, without a time stamp or any other thing that varies.

    Parameters
    ----------
    rgb8 : ndarray of uint8, shape (H, W, 3)
        Encoded sRGB, row 0 at the top.

    Returns
    -------
    bytes
        A PNG file; equal pictures give equal bytes under one version of Pillow.

    Raises
    ------
    ValueError
        The array is not a picture of this form.
    """
    info = PngImagePlugin.PngInfo()
    info.add(b"sRGB", _SRGB_PERCEPTUAL)
    stream = io.BytesIO()
    _picture(rgb8).save(stream, "PNG", compress_level=_PNG_LEVEL, pnginfo=info)
    return stream.getvalue()


def encode_webp(rgb8: NDArray[np.uint8]) -> bytes:
    """Encode a picture as WebP, thin dark lines kept clean.

    Lightness keeps the full resolution; WebP holds colour at half of it, so a coloured fringe one pixel wide fades.
    PNG is the exact picture.

    Parameters
    ----------
    rgb8 : ndarray of uint8, shape (H, W, 3)
        Encoded sRGB, row 0 at the top; sides of at most 16383.

    Returns
    -------
    bytes
        A WebP file; equal pictures give equal bytes under one version of Pillow.

    Raises
    ------
    ValueError
        The array is not a picture of this form.
    """
    stream = io.BytesIO()
    _picture(rgb8, _WEBP_MAX_SIDE).save(stream, "WEBP", **_WEBP)
    return stream.getvalue()


def encode_animated_webp(frames: Sequence[NDArray[np.uint8]], frame_ms: int) -> bytes:
    """Encode pictures as one animated WebP that plays for ever.

    Parameters
    ----------
    frames : sequence of ndarray of uint8, each of the same shape (H, W, 3)
        Encoded sRGB in the order of play, at least one. Each is asked for once, in order, when its turn comes: a
        sequence that reads its pictures late keeps one of them in memory at a time.
    frame_ms : int
        How long each picture stands, in milliseconds, at least 1.

    Returns
    -------
    bytes
        A WebP file; equal pictures give equal bytes under one version of Pillow.

    Raises
    ------
    ValueError
        There is no picture, the shapes differ, or a picture is not of this form.
    """
    if not frames:
        raise ValueError("an animation has at least one frame")
    if frame_ms < 1:
        raise ValueError(f"a frame stands for at least 1 ms, not {frame_ms}")
    first = _picture(frames[0], _WEBP_MAX_SIDE)
    rest = [_LatePicture(frames, index, first.size) for index in range(1, len(frames))]
    stream = io.BytesIO()
    first.save(stream, "WEBP", save_all=True, append_images=rest, duration=frame_ms, loop=0, **_WEBP)
    return stream.getvalue()


def animation_frame_ms(frames: int) -> int:
    """Return how long each of so many frames stands, so that a turn takes six seconds where that looks well.

    Parameters
    ----------
    frames : int
        Number of frames, at least 1.

    Returns
    -------
    int
        Milliseconds, 40 (25 pictures a second) to 200 (slower than that, the motion falls apart).
    """
    return min(max(round(_TURN_MS / frames), 40), 200)


def decode_png(data: bytes) -> NDArray[np.uint8]:
    """Return the picture in a file of `encode_png`.

    Parameters
    ----------
    data : bytes
        A whole PNG file.

    Returns
    -------
    ndarray of uint8, shape (H, W, 3)
        Encoded sRGB, row 0 at the top.

    Raises
    ------
    ValueError
        The file is not a PNG picture in 8-bit RGB, or is broken.
    """
    try:
        with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
            if picture.mode != "RGB":
                raise ValueError(f"a picture of ours is RGB, not {picture.mode}")
            return np.array(picture)
    except (OSError, SyntaxError) as error:
        raise ValueError(f"not a whole PNG picture: {error}") from error


class _LatePicture:
    """What Pillow's WebP writer asks of an appended picture; the pixels are fetched when it converts it to RGB."""

    mode = "late"
    has_transparency_data = False

    def __init__(self, frames: Sequence[NDArray[np.uint8]], index: int, size: tuple[int, int]) -> None:
        self._frames = frames
        self._index = index
        self._size = size

    def seek(self, frame: int) -> None:
        """Stand still: there is one frame."""

    def convert(self, mode: str) -> Image.Image:
        assert mode == "RGB", mode
        picture = _picture(self._frames[self._index])
        if picture.size != self._size:
            raise ValueError(f"the frames of an animation have one size, not {self._size} and {picture.size}")
        return picture


def _picture(rgb8: NDArray[np.uint8], max_side: int | None = None) -> Image.Image:
    if rgb8.dtype != np.uint8 or rgb8.ndim != 3 or rgb8.shape[2] != 3 or 0 in rgb8.shape:
        raise ValueError(f"a picture is uint8 of shape (H, W, 3), not {rgb8.dtype} of shape {rgb8.shape}")
    if max_side is not None and max(rgb8.shape[:2]) > max_side:
        raise ValueError(f"a WebP picture has sides of at most {max_side}, not {rgb8.shape[1]} × {rgb8.shape[0]}")
    return Image.fromarray(np.ascontiguousarray(rgb8))
