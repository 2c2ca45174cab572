"""Colours through a crystal, per principal direction."""

from __future__ import annotations

import numpy as np
import pytest

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials.swatches import hexadecimal, swatches
from crystal_core.spectra.colour import encode_srgb
from tests.materials.entries import monoclinic


def test_grey_filters_follow_beers_law() -> None:
    colours = swatches(monoclinic(), 0.5)
    for axis, coefficient in (("alpha", 1.1), ("beta", 0.2), ("gamma", 3.3)):
        np.testing.assert_allclose(colours[axis], encode_srgb(np.full(3, np.exp(-0.5 * coefficient))), atol=2e-4)


def test_concentrations_darken() -> None:
    assert np.all(swatches(monoclinic(), 1.0, {"iron": 4.0})["gamma"] < swatches(monoclinic(), 1.0)["gamma"])


def test_a_mineral_without_absorption_is_white() -> None:
    colours = swatches(minerals_db.mineral("calcite"))
    assert set(colours) == {"o", "e"}
    assert hexadecimal(colours["o"]) == hexadecimal(colours["e"]) == "#ffffff"


@pytest.mark.parametrize("thickness", [0.0, -1.0, np.nan, np.inf])
def test_what_is_no_thickness(thickness: float) -> None:
    with pytest.raises(InputError, match="thickness"):
        swatches(minerals_db.mineral("calcite"), thickness)


def test_hexadecimal() -> None:
    assert hexadecimal(np.array((1.0, 0.5, 0.0))) == "#ff8000"
