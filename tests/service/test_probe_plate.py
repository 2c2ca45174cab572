"""What the probe of plates answers: colours that are known, matrices and their angles, defaults."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crystal_core.materials import medium
from crystal_core.optics.plates import Plate, plate_stack
from minerals_db import mineral
from service.probes.plate import PLATE, PlateAnswer

LYING = [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
"""The optic axis, the third row, along x."""


def retarder(gamma_nm: float, axes: list[list[float]] | None = None) -> dict[str, Any]:
    """Return a plate of this retardation at all wavelengths, its slow axis along x, in a mount that hides its faces."""
    return {"indices": [1.5396, 1.5404], "axes": axes or LYING, "thickness_um": gamma_nm / 0.8}


def ask(*plates: dict[str, Any], **keys: Any) -> dict[str, Any]:
    return PLATE.ask({"plates": list(plates), "mount_index": 1.54, **keys})


def along(degrees: float) -> list[list[float]]:
    """Return axes with the third row in the plane, `degrees` from x towards y."""
    angle = np.radians(degrees)
    c, s = float(np.cos(angle)), float(np.sin(angle))
    return [[0, 0, 1], [-s, c, 0], [c, s, 0]]


def jones(answer: dict[str, Any]) -> NDArray[np.complex128]:
    return np.array(answer["jones"]) @ (1, 1j)


@pytest.mark.parametrize(
    ("gamma_nm", "srgb"),
    [
        (100, (128, 148, 174)),
        (332, (255, 242, 189)),
        (551, (104, 0, 179)),
        (664, (0, 175, 255)),
        (1334, (97, 249, 89)),
    ],
)
def test_interference_colours_are_those_of_the_chart(gamma_nm: float, srgb: tuple[int, int, int]) -> None:
    # Computed elsewhere from sin²(πΓ/λ), D65 and the 1931 observer.
    for coherent in ("exact", "single-pass"):
        answer = ask(retarder(gamma_nm), polarizer_deg=45, analyser_deg=135, coherent=coherent)
        np.testing.assert_allclose(np.array(answer["srgb"]) * 255, srgb, atol=1.0)
        np.testing.assert_allclose(answer["retardation_nm"], gamma_nm, rtol=1e-9)
        wavelengths = np.array(answer["wavelengths_nm"])
        np.testing.assert_allclose(answer["transmittance"], np.sin(np.pi * gamma_nm / wavelengths) ** 2, atol=1e-5)


def test_white_is_the_open_field() -> None:
    nothing = {"indices": [1.54], "thickness_um": 30}
    for polars in ((0, 0), (30, 30), (None, None), (20, None), (None, 70)):
        answer = ask(nothing, polarizer_deg=polars[0], analyser_deg=polars[1], wavelengths_nm=[400, 700])
        np.testing.assert_allclose(answer["transmittance"], 1, atol=1e-12)
        np.testing.assert_allclose(answer["srgb"], 1, atol=1e-9)
        np.testing.assert_allclose(answer["xyz"], (0.9504707, 1, 1.0888285), atol=1e-7)
    dark = ask(nothing)
    np.testing.assert_allclose([*dark["transmittance"], *dark["srgb"], *dark["xyz"]], 0, atol=1e-12)


def test_what_is_not_said_is_air_crossed_polars_single_pass_and_the_visible() -> None:
    plate = retarder(551, along(45))
    spoken = {
        "mount_index": 1.0,
        "polarizer_deg": 0,
        "analyser_deg": 90,
        "coherent": "single-pass",
        "wavelengths_nm": list(range(380, 781, 5)),
    }
    assert PLATE.ask({"plates": [plate]}) == PLATE.ask({"plates": [plate], **spoken})


def test_angles_are_counted_from_x_towards_y() -> None:
    # A half-wave plate turns the field by twice the angle of its axis: from 0° to 60°.
    half = retarder(295, along(30))
    for analyser, expected in ((60, 1), (150, 0), (-120, 1), (0, 0.25), (90, 0.75)):
        answer = ask(half, polarizer_deg=0, analyser_deg=analyser, wavelengths_nm=[590])
        assert answer["transmittance"][0] == pytest.approx(expected, abs=1e-6)
    # Light passes the first plate first: x, turned to 60°, turned by a second one at 75° to 90°.
    answer = ask(half, retarder(295, along(75)), polarizer_deg=0, analyser_deg=90, wavelengths_nm=[590])
    assert answer["transmittance"][0] == pytest.approx(1, abs=1e-6)
    assert abs(jones(answer)[0, 1, 0]) == pytest.approx(1, abs=1e-6)


def test_the_retarded_component_has_the_later_phase() -> None:
    # exp(i(kz − ωt)): the slow wave, along x here, is ahead in phase by 2π Γ/λ.
    matrix = jones(ask(retarder(100), wavelengths_nm=[500.0]))[0]
    assert np.angle(matrix[0, 0] / matrix[1, 1]) == pytest.approx(2 * np.pi * 100 / 500, abs=1e-5)
    # A quarter-wave plate makes x + y counter-clockwise if its slow axis is y: (1, i), S3 > 0.
    answer = ask(retarder(125, along(90)), wavelengths_nm=[500.0])
    field = jones(answer)[0] @ (1, 1)
    assert field[1] / field[0] == pytest.approx(1j, abs=1e-4)
    stokes = np.array(answer["mueller"][0]) @ (1, 0, 1, 0)
    np.testing.assert_allclose(stokes, (1, 0, 0, 1), atol=1e-4)


def test_matrices_are_those_of_the_optics() -> None:
    turned = [[0.8, 0, 0.6], [0.6, 0, -0.8], [0, 1, 0]]
    wavelengths = [450.0, 589.3]
    plates = [
        Plate(medium(mineral("calcite"), wavelengths, turned), 20.0),
        Plate(medium(mineral("topaz"), wavelengths), 9.0),
    ]
    question = {
        "plates": [
            {"mineral": "calcite", "rotation": turned, "thickness_um": 20},
            {"mineral": "topaz", "thickness_um": 9},
        ],
        "wavelengths_nm": wavelengths,
        "mount_index": 1.3,
    }
    for coherent in ("exact", "single-pass", "incoherent"):
        expected = plate_stack(plates, wavelengths, 1.3, coherent=coherent)
        answer = PLATE.ask({**question, "coherent": coherent})
        np.testing.assert_array_equal(np.moveaxis(answer["mueller"], 0, 2), expected.mueller_transmitted)
        if expected.jones_transmitted is None:
            assert answer["jones"] is None
        else:
            np.testing.assert_array_equal(np.moveaxis(jones(answer), 0, 2), expected.jones_transmitted)


def test_only_plates_that_share_their_axes_have_a_retardation() -> None:
    keys = {"wavelengths_nm": [500, 600]}
    assert ask(retarder(300), retarder(200), **keys)["retardation_nm"] == pytest.approx([500, 500])
    assert ask(retarder(300), retarder(200, along(90)), **keys)["retardation_nm"] == pytest.approx([100, 100])
    assert ask(retarder(300), retarder(200, along(20)), **keys)["retardation_nm"] is None
    assert ask({"indices": [1.5], "thickness_um": 5}, **keys)["retardation_nm"] == [0, 0]


def test_absorption_dims_its_own_vibration() -> None:
    tinted = {**retarder(0.8), "thickness_um": 1000.0, "absorption_per_mm": [0, 0, 0.5]}
    answer = ask(tinted, polarizer_deg=0, analyser_deg=0, wavelengths_nm=[500])
    assert answer["transmittance"][0] == pytest.approx(np.exp(-0.5), abs=1e-4)
    answer = ask(tinted, polarizer_deg=90, analyser_deg=90, wavelengths_nm=[500])
    assert answer["transmittance"][0] == pytest.approx(1, abs=1e-4)


def test_colours_do_not_depend_on_the_wavelengths_asked_for() -> None:
    thick = {"mineral": "calcite", "rotation": [[1, 0, 0], [0, 0, -1], [0, 1, 0]], "thickness_um": 500}
    few, many = (
        ask(thick, polarizer_deg=45, analyser_deg=-45, wavelengths_nm=wavelengths)
        for wavelengths in ([589.3], list(range(400, 700, 50)))
    )
    assert few["srgb"] == many["srgb"]
    # White of a high order: half of the open field, without colour.
    np.testing.assert_allclose(few["xyz"], np.array((0.9504707, 1, 1.0888285)) / 2 * 0.98, rtol=0.02)


def test_an_answer_is_as_the_description_says() -> None:
    for coherent in ("single-pass", "incoherent"):
        answer = ask(retarder(300), retarder(200, along(20)), coherent=coherent)
        assert PlateAnswer.model_validate(answer).model_dump(mode="json") == answer
        assert len(answer["wavelengths_nm"]) == 81
        assert {len(answer[key]) for key in ("transmittance", "mueller")} == {81}
