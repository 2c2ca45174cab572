"""Media as they are written down: what is taken, what is refused and where, what becomes of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pydantic import ValidationError
from scipy.spatial.transform import Rotation

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials import medium
from crystal_core.materials.description import MediumDescription, joint_medium
from crystal_core.optics import Medium
from crystal_core.optics.indicatrix import dissipation, permittivity
from tests.materials.entries import monoclinic

Real = NDArray[np.float64]

TURNED: Real = Rotation.from_euler("ZYX", [30, 50, 70], degrees=True).as_matrix()
OTHER: Real = Rotation.from_euler("ZYX", [-20, 10, 130], degrees=True).as_matrix()
AXES = TURNED.tolist()
MIRRORED = (-TURNED).tolist()
LINES = np.array([486.1, 589.3, 656.3])


def described(**keys: Any) -> MediumDescription:
    return MediumDescription.model_validate(keys)


def faults(keys: dict[str, Any]) -> list[tuple[str, str]]:
    with pytest.raises(ValidationError) as caught:
        MediumDescription.model_validate(keys)
    found = [("/".join(map(str, error["loc"])), error["msg"]) for error in caught.value.errors()]
    # Of a list with a faulty item pydantic also says that it has one item less.
    return [
        (place, message) for place, message in found if not any(other.startswith(f"{place}/") for other, _ in found)
    ]


def tilted(angle: float) -> list[list[float]]:
    """Return axes of which the first leans towards the second."""
    return [[1.0, angle, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


@pytest.mark.parametrize(
    ("keys", "where", "what"),
    [
        ({}, "indices", "required, unless a mineral is named"),
        ({"indices": [1.5], "colour": 1}, "colour", "Extra inputs"),
        ({"indices": []}, "indices", "at least 1"),
        ({"indices": [1.5] * 4, "axes": AXES}, "indices", "at most 3"),
        ({"indices": [0.0]}, "indices/0", "greater than or equal to 0.01"),
        ({"indices": [1.5, -1.4], "axes": AXES}, "indices/1", "greater than or equal to 0.01"),
        ({"indices": [float("nan")]}, "indices/0", "finite"),
        ({"indices": [float("inf")]}, "indices/0", "finite"),
        ({"indices": [1e300]}, "indices/0", "less than or equal to 100"),
        ({"indices": ["1.5"]}, "indices/0", "valid number"),
        ({"indices": [True]}, "indices/0", "valid number"),
        ({"indices": 1.5}, "indices", "valid tuple"),
        ({"indices": [1.5, 1.6]}, "axes", "required: the medium is anisotropic"),
        ({"indices": [1.5, 1.6, 1.7]}, "axes", "required: the medium is anisotropic"),
        ({"indices": [1.5, 1.6], "axes": tilted(0.01)}, "axes", "must be orthonormal"),
        ({"indices": [1.5, 1.6], "axes": tilted(3e-6)}, "axes", "must be orthonormal"),
        ({"indices": [1.5], "axes": tilted(0.01)}, "axes", "must be orthonormal"),
        ({"indices": [1.5, 1.6], "axes": (1.001 * TURNED).tolist()}, "axes", "must be orthonormal"),
        ({"indices": [1.5, 1.6], "axes": [[0.0] * 3] * 3}, "axes", "must be orthonormal"),
        ({"indices": [1.5, 1.6], "axes": [[1e200] * 3] * 3}, "axes", "must be orthonormal"),
        ({"indices": [1.5, 1.6], "axes": AXES[:2]}, "axes/2", "required"),
        ({"indices": [1.5, 1.6], "axes": [AXES[0], AXES[1], [0, 1]]}, "axes/2/2", "required"),
        ({"indices": [1.5, 1.6], "axes": [AXES[0], AXES[1], [0, float("nan"), 1]]}, "axes/2/1", "finite"),
        ({"indices": [1.5, 1.6], "axes": AXES, "absorption_per_mm": [1, 1]}, "absorption_per_mm", "three"),
        ({"indices": [1.5, 1.6], "axes": AXES, "absorption_per_mm": [1]}, "absorption_per_mm", "three"),
        ({"indices": [1.5, 1.6], "axes": AXES, "absorption_per_mm": [1, -1, 1]}, "absorption_per_mm/1", "greater"),
        ({"indices": [1.5], "absorption_per_mm": [1, 1, 2]}, "absorption_per_mm", "one coefficient"),
        ({"indices": [1.5], "absorption_per_mm": [1, 1]}, "absorption_per_mm", "three"),
        ({"indices": [1.5, 1.6], "axes": AXES, "absorption_axes": tilted(1)}, "absorption_axes", "orthonormal"),
        ({"indices": [1.5, 1.6], "axes": MIRRORED, "gyration": [0, 0, 1e-5]}, "axes", "right-handed"),
        ({"indices": [1.5, 1.6], "axes": AXES, "gyration": [0, 0, 2]}, "gyration", "from -1 to 1"),
        ({"indices": [1.5, 1.6], "axes": AXES, "gyration": [0, 0, "x"]}, "gyration", "three principal values"),
        ({"indices": [1.5, 1.6], "axes": AXES, "gyration": [0, float("nan"), 0]}, "gyration", "from -1 to 1"),
        ({"indices": [1.5, 1.6], "axes": AXES, "gyration": tilted(1e-3)}, "gyration", "symmetric"),
        ({"mineral": "unobtainium"}, "mineral", "no mineral 'unobtainium'; "),
        ({"mineral": 5}, "mineral", "valid string"),
        ({"mineral": "calcite", "rotation": MIRRORED}, "rotation", "its determinant is -1"),
        ({"mineral": "calcite", "rotation": tilted(0.1)}, "rotation", "orthonormal"),
        ({"mineral": "calcite", "indices": [1.5]}, "indices", "does not go with a mineral"),
        ({"mineral": "calcite", "axes": AXES}, "axes", "does not go with a mineral"),
        ({"mineral": "calcite", "gyration": [0, 0, 0]}, "gyration", "does not go with a mineral"),
        ({"mineral": "calcite", "absorption_per_mm": [0, 0, 0]}, "absorption_per_mm", "does not go with a mineral"),
        ({"indices": [1.5], "rotation": AXES}, "rotation", "turns a mineral"),
    ],
)
def test_what_is_wrong_is_told_at_its_place(keys: dict[str, Any], where: str, what: str) -> None:
    found = faults(keys)
    assert [place for place, _ in found] == [where]
    assert what in found[0][1]


def test_every_wrong_place_is_told() -> None:
    found = faults({"indices": [0, 1.5, -1], "axes": tilted(1), "absorption_axes": 5, "x": 1})
    assert [place for place, _ in found] == ["indices/0", "indices/2", "axes", "absorption_axes", "x"]


@pytest.mark.parametrize("kind", [2, 3])
def test_the_rows_are_the_directions_of_the_indices(kind: int) -> None:
    indices = [1.5, 1.7, 1.6][:kind]
    squares = np.array([indices[0], indices[0], indices[1]] if kind == 2 else indices) ** 2
    for axes in (AXES, MIRRORED):
        epsilon = permittivity(described(indices=indices, axes=axes).medium(LINES))
        for square, direction in zip(squares, TURNED, strict=True):
            np.testing.assert_allclose(np.einsum("ij...,j->i...", epsilon, direction).T, [square * direction] * 3)


def test_absorption_has_axes_of_its_own_and_the_frame_of_the_indices_without() -> None:
    keys = {"indices": [1.5, 1.7, 1.6], "axes": AXES, "absorption_per_mm": [0.5, 1.0, 2.0]}
    expected = Medium.biaxial([1.5, 1.7, 1.6], TURNED)
    own = described(**keys, absorption_axes=OTHER.tolist()).medium(LINES[:1])
    np.testing.assert_allclose(
        dissipation(own)[..., 0], dissipation(expected.absorbing([0.5, 1.0, 2.0], OTHER)), rtol=1e-14, atol=1e-15
    )
    shared = described(**keys).medium(LINES[:1])
    np.testing.assert_allclose(
        dissipation(shared)[..., 0], dissipation(expected.absorbing([0.5, 1.0, 2.0], TURNED)), rtol=1e-14, atol=1e-15
    )


def test_one_coefficient_or_three_equal_ones_of_an_isotropic_medium() -> None:
    for given in ([0.7], [0.7, 0.7, 0.7]):
        coefficients = described(indices=[1.5], absorption_per_mm=given).medium(LINES).absorption_per_mm
        assert coefficients is not None
        np.testing.assert_array_equal(coefficients, [[0.7] * 3])
    assert described(indices=[1.5], absorption_per_mm=[0, 0, 0]).medium(LINES).absorption_per_mm is None


def test_a_gyration_stands_on_the_axes() -> None:
    principal = [1e-5, 2e-5, -3e-5]
    expected = TURNED.T @ np.diag(principal) @ TURNED
    for given in (principal, np.diag(principal).tolist()):
        for indices in ([1.5], [1.5, 1.6], [1.5, 1.6, 1.7]):
            gyration = described(indices=indices, axes=AXES, gyration=given).medium(LINES).gyration
            np.testing.assert_allclose(gyration, expected, rtol=1e-13, atol=1e-19)
    full = [[1e-5, 2e-6, 0.0], [2e-6, 2e-5, 3e-6], [0.0, 3e-6, 0.0]]
    gyration = described(indices=[1.5, 1.6], axes=AXES, gyration=full).medium(LINES).gyration
    np.testing.assert_allclose(gyration, TURNED.T @ np.array(full) @ TURNED, rtol=1e-12, atol=1e-19)


def test_a_mineral_has_its_dispersion_and_is_turned() -> None:
    calcite = minerals_db.mineral("calcite")
    made = described(mineral="calcite", rotation=AXES).medium(LINES)
    expected = medium(calcite, LINES, TURNED)
    np.testing.assert_array_equal(made.indices, expected.indices)
    assert np.ptp(made.indices[0]) > 0.01
    np.testing.assert_allclose(made.axis, TURNED @ [0, 0, 1], atol=1e-15)
    np.testing.assert_array_equal(described(mineral="calcite").medium(LINES).axis, [0, 0, 1])


def test_digits_of_a_typed_frame_are_made_up_for() -> None:
    typed = np.round(TURNED, 7)
    axes = np.array(described(indices=[1.5, 1.6], axes=typed.tolist()).axes)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    # The nearest orthonormal frame W minimises |W - typed|: then typed Wᵀ is symmetric.
    product = typed @ axes.T
    np.testing.assert_allclose(product, product.T, atol=1e-15)
    assert np.abs(axes - typed).max() < 1e-7
    np.testing.assert_array_equal(described(indices=[1.5, 1.6], axes=AXES).axes, TURNED)  # not a bit changed


FAMILIES: dict[str, list[dict[str, Any]]] = {
    "isotropic": [{"indices": [1.5]}, {"indices": [1.2], "axes": AXES}],
    "absorbing glass": [{"indices": [1.5], "absorption_per_mm": [a]} for a in (1, 2)],
    "uniaxial": [{"indices": [1.5, n], "axes": axes} for n, axes in ((1.6, AXES), (1.7, OTHER.tolist()))],
    "biaxial": [{"indices": [1.5, n, 1.8], "axes": axes} for n, axes in ((1.6, AXES), (1.7, MIRRORED))],
    "pleochroic": [
        {"indices": [1.5, 1.6, 1.8], "axes": AXES, "absorption_per_mm": [0, 1, 2], "absorption_axes": OTHER.tolist()},
        {"indices": [1.5, 1.6, 1.7], "axes": OTHER.tolist(), "absorption_per_mm": [3, 1, 0]},
    ],
    "active": [
        {"indices": [1.5, 1.6], "axes": axes, "gyration": [1e-5, 1e-5, g]} for g, axes in ((2e-5, AXES), (0, AXES))
    ],
    "calcite": [{"mineral": "calcite"}, {"mineral": "calcite", "rotation": AXES}],
    "quartz": [{"mineral": "quartz", "rotation": OTHER.tolist()}, {"mineral": "quartz", "rotation": AXES}],
    "topaz": [{"mineral": "topaz", "rotation": OTHER.tolist()}, {"mineral": "topaz", "rotation": AXES}],
}


@pytest.mark.parametrize("family", FAMILIES)
def test_a_joint_medium_holds_each_by_itself(family: str) -> None:
    descriptions = [MediumDescription.model_validate(keys) for keys in FAMILIES[family]]
    joint = joint_medium(descriptions, LINES[:2])
    for ray, description in enumerate(descriptions):
        alone = description.medium(LINES[ray : ray + 1])
        part = joint.take(np.array([ray]))
        np.testing.assert_allclose(
            *(np.squeeze(permittivity(m)).astype(float) for m in (part, alone)), rtol=1e-14, atol=1e-15
        )
        assert (part.absorption_per_mm is None) == (alone.absorption_per_mm is None)
        if alone.absorption_per_mm is not None and not alone.is_isotropic:
            np.testing.assert_allclose(dissipation(part), dissipation(alone), rtol=1e-13, atol=1e-15)
        assert (part.gyration is None) == (alone.gyration is None)
        if alone.gyration is not None:
            assert part.gyration is not None
            np.testing.assert_allclose(np.squeeze(part.gyration), np.squeeze(alone.gyration), rtol=1e-13, atol=1e-18)


def test_media_of_different_families_have_no_joint_medium() -> None:
    two = [described(indices=[1.5]), described(mineral="fluorite")]
    with pytest.raises(ValueError, match="of one family"):
        joint_medium(two, LINES[:2])
    with pytest.raises(ValueError, match="one description per wavelength"):
        joint_medium(two[:1], LINES)


@pytest.mark.parametrize("wavelengths", [[0.0], [-5.0], [np.nan], [[589.3]], 589.3])
def test_wavelengths_make_sense(wavelengths: Any) -> None:
    with pytest.raises(InputError, match="wavelengths must be finite and positive"):
        described(indices=[1.5]).medium(wavelengths)


def test_the_kind_decides_not_the_values() -> None:
    assert described(indices=[1.5]).is_isotropic
    assert not described(indices=[1.5, 1.5, 1.5], axes=AXES).is_isotropic
    assert described(mineral="fluorite").is_isotropic


def test_concentrations_of_a_minerals_chromophores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(minerals_db, "minerals", lambda: {"made-up": monoclinic()})
    monkeypatch.setattr(minerals_db, "mineral", lambda _: monoclinic())
    plain, strong = described(mineral="made-up"), described(mineral="made-up", concentrations={"iron": 8.0})
    assert plain.family != strong.family
    for one, gamma in ((plain, 3.3), (strong, 12.3)):
        for found in (one.medium(LINES[:2]), joint_medium([one, one], LINES[:2])):
            assert found.absorption_per_mm is not None
            np.testing.assert_allclose(found.absorption_per_mm[2], gamma)
    for wrong, said in (({"copper": 1.0}, "made-up has the chromophores iron, not copper"), ({"iron": -1.0}, "equal")):
        with pytest.raises(ValidationError, match=said):
            described(mineral="made-up", concentrations=wrong)
    with pytest.raises(ValidationError, match="those of a mineral"):
        described(indices=[1.5], concentrations={"iron": 1.0})
