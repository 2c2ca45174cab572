"""XYZ to sRGB, the gamut rule, and the round trip of texture colours."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crystal_core.spectra import colour, illuminants, observer, reflectance

EVERY_NM = np.arange(360.0, 831.0)


def d65_white(wavelengths: np.ndarray = EVERY_NM) -> np.ndarray:
    """Return XYZ of D65, Y = 1."""
    xyz = np.sum(illuminants.d65(wavelengths) * observer.colour_matching(wavelengths), axis=-1)
    return xyz / xyz[1]


def test_white_of_d65() -> None:
    # CIE 015:2018, table of white points: 0.95047, 1, 1.08883.
    np.testing.assert_allclose(d65_white(), [0.95047, 1.0, 1.08883], rtol=0, atol=5e-6)


def test_white_is_what_the_tables_give() -> None:
    np.testing.assert_allclose(colour.D65_WHITE_XYZ, d65_white(), rtol=0, atol=1e-14)


def test_white_becomes_one() -> None:
    np.testing.assert_allclose(colour.xyz_to_linear_srgb(d65_white()), 1.0, rtol=0, atol=1e-14)


def test_matrices_keep_the_primaries_of_the_standard() -> None:
    # IEC 61966-2-1: red 0.64 0.33, green 0.30 0.60, blue 0.15 0.06; each column of the matrix is a primary's XYZ.
    primaries = np.array(colour.LINEAR_SRGB_TO_XYZ).T
    chromaticities = primaries[:, :2] / primaries.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(chromaticities, [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]], rtol=0, atol=1e-14)


def test_matrices_are_inverse_to_each_other() -> None:
    product = np.array(colour.LINEAR_SRGB_TO_XYZ) @ np.array(colour.XYZ_TO_LINEAR_SRGB)
    np.testing.assert_allclose(product, np.eye(3), rtol=0, atol=1e-14)


def test_matrix_is_near_the_printed_one(colour_science: ModuleType) -> None:
    printed = colour_science.RGB_COLOURSPACES["sRGB"].matrix_XYZ_to_RGB
    np.testing.assert_allclose(colour.XYZ_TO_LINEAR_SRGB, printed, rtol=0, atol=4e-4)


def test_transfer_curve_is_that_of_colour_science(colour_science: ModuleType) -> None:
    values = np.concatenate([[0.0, 0.0031308, 1.0], np.random.default_rng(2).uniform(0.0, 1.0, 500)])
    expected = colour_science.models.eotf_inverse_sRGB(values)
    np.testing.assert_allclose(colour.encode_srgb(values), expected, rtol=0, atol=1e-14)
    np.testing.assert_allclose(colour.decode_srgb(values), colour_science.models.eotf_sRGB(values), rtol=0, atol=1e-14)


@given(st.floats(0.0, 1.0))
def test_encoding_and_back(value: float) -> None:
    # The standard's two branches miss each other by 1e-8 where they meet.
    assert colour.decode_srgb(colour.encode_srgb(value)) == pytest.approx(value, abs=3e-8)


@given(st.integers(0, 255))
def test_eight_bits_and_back(code: int) -> None:
    linear = colour.decode_srgb(np.full((1, 1, 3), code / 255.0))
    pixels, clipped = colour.to_srgb8(linear)
    np.testing.assert_array_equal(pixels, code)
    assert clipped == 0.0


def test_xyz_and_back() -> None:
    xyz = np.random.default_rng(3).uniform(0.0, 1.2, (50, 4, 3))
    back = colour.linear_srgb_to_xyz(colour.xyz_to_linear_srgb(xyz))
    np.testing.assert_allclose(back, xyz, rtol=0, atol=5e-15)


def test_bits_do_not_depend_on_the_batch() -> None:
    xyz = np.random.default_rng(4).uniform(0.0, 1.2, (4097, 3))
    whole = colour.encode_srgb(colour.xyz_to_linear_srgb(xyz))
    for length in (1, 2, 3, 5, 8, 63, 1000):
        np.testing.assert_array_equal(colour.encode_srgb(colour.xyz_to_linear_srgb(xyz[:length])), whole[:length])


def test_gamut_rule_clips_each_channel_and_counts_pixels() -> None:
    linear = np.array([[[1.5, -0.2, 0.5], [0.2, 0.3, 0.4]], [[1.0, 0.0, 1.0], [0.5, 0.5, -0.01]]])
    pixels, clipped = colour.to_srgb8(linear)
    assert pixels.dtype == np.uint8
    np.testing.assert_array_equal(pixels[0, 0], [255, 0, 188])  # 0.5 encodes to 0.7354
    np.testing.assert_array_equal(pixels[1, 0], [255, 0, 255])
    assert clipped == 0.5


def test_rounding_errors_are_not_counted_as_clipping() -> None:
    pixels, clipped = colour.to_srgb8(np.array([[[1.0 + 1e-7, -1e-7, 1.0]]], dtype=np.float32))
    np.testing.assert_array_equal(pixels[0, 0], [255, 0, 255])
    assert clipped == 0.0


def test_what_counts_as_clipped_is_at_most_half_a_step() -> None:
    assert colour.encode_srgb(colour.GAMUT_TOLERANCE) * 255.0 == pytest.approx(0.5, abs=1e-12)


def test_picture_without_pixels() -> None:
    pixels, clipped = colour.to_srgb8(np.empty((0, 4, 3)))
    assert pixels.shape == (0, 4, 3)
    assert clipped == 0.0


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_not_hidden(bad: float) -> None:
    with pytest.raises(ValueError, match="NaN or infinite"):
        colour.to_srgb8(np.array([[[0.5, bad, 0.5]]]))


@pytest.mark.parametrize("function", [colour.xyz_to_linear_srgb, colour.linear_srgb_to_xyz, colour.to_srgb8])
@pytest.mark.parametrize("shape", [(), (4,), (3, 2)])
def test_three_components(function: object, shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="last axis"):
        function(np.zeros(shape))  # type: ignore[operator]


@pytest.mark.parametrize("step_nm", [0.25, 1.0])
def test_texture_colours_come_back_under_d65(step_nm: float) -> None:
    wavelengths = np.arange(360.0, 830.0 + step_nm / 2.0, step_nm)
    rng = np.random.default_rng(20_190_703)
    corners = np.array(np.meshgrid([0, 255], [0, 255], [0, 255])).reshape(3, -1).T
    codes = np.concatenate([corners, rng.integers(0, 256, (500, 3))])
    linear = colour.decode_srgb(codes / 255.0)
    spectra = np.sum(linear[:, :, None] * reflectance.basis(wavelengths), axis=1)
    assert spectra.min() >= 0.0
    assert spectra.max() <= 1.0 + 1e-15
    weights = illuminants.d65(wavelengths) * observer.colour_matching(wavelengths)
    xyz = np.sum(spectra[:, None, :] * weights, axis=-1) / np.sum(weights[1])
    seen = colour.encode_srgb(colour.xyz_to_linear_srgb(xyz)) * 255.0
    assert np.abs(seen - codes).max() < 1.0
