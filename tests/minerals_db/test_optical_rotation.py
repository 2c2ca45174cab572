"""Optical rotation: the two kinds of curves, the entries against what was published, and what the schema refuses."""

from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

import minerals_db
from minerals_db import Mineral, MineralDataError, load_minerals
from minerals_db.optical_rotation import AnyRotatoryPower, RotatoryPower

ADAPTER: TypeAdapter[RotatoryPower] = TypeAdapter(AnyRotatoryPower)
KNOWN = {"source": "somebody", "status": "published"}
DRUDE = {
    "model": "drude",
    "strength": 7.3,
    "resonance_um": 0.12,
    "constant": -0.3,
    "range_nm": [320.0, 760.0],
    **KNOWN,
}
TABLE = {
    "model": "table",
    "wavelengths_nm": [400.0, 500.0, 600.0, 700.0],
    "degrees_per_mm": [50.0, 30.0, 20.0, 15.0],
    "range_nm": [400.0, 700.0],
    **KNOWN,
}


def curve(data: dict[str, Any], **changes: Any) -> RotatoryPower:
    return ADAPTER.validate_python(data | changes)


def test_drude_formula() -> None:
    # by hand at 0.5 µm
    assert float(curve(DRUDE).degrees_per_mm_at(500.0)) == pytest.approx(7.3 / (0.25 - 0.0144) - 0.3, rel=1e-15)


def test_table_goes_through_its_points_and_never_beyond_them() -> None:
    table = curve(TABLE)
    np.testing.assert_array_equal(table.degrees_per_mm_at(TABLE["wavelengths_nm"]), TABLE["degrees_per_mm"])
    assert np.all(np.diff(table.degrees_per_mm_at(np.linspace(400.0, 700.0, 3001))) < 0.0)


@pytest.mark.parametrize("data", [DRUDE, TABLE])
def test_outside_its_range_a_curve_keeps_its_end_values(data: dict[str, Any]) -> None:
    model = curve(data)
    shortest, longest = model.range_nm
    ends = model.degrees_per_mm_at([shortest, longest])
    np.testing.assert_array_equal(model.degrees_per_mm_at([1.0, 1e9]), ends)
    assert np.isnan(model.degrees_per_mm_at(math.nan))


@pytest.mark.parametrize("data", [DRUDE, TABLE])
def test_bits_do_not_depend_on_the_batch(data: dict[str, Any]) -> None:
    model = curve(data)
    wavelengths = np.random.default_rng(7).uniform(350.0, 800.0, 1031)
    wavelengths[::7] = 500.0  # a point of the table among others
    whole = model.degrees_per_mm_at(wavelengths)
    for ray in (0, 1, 7, 500):
        assert float(model.degrees_per_mm_at(wavelengths[ray])) == whole[ray]
    there = pickle.loads(pickle.dumps(model))
    np.testing.assert_array_equal(there.degrees_per_mm_at(wavelengths), whole)


FAULTS = [
    (DRUDE, {"resonance_um": 0.4}, "pole at 400 nm, inside range_nm"),
    (DRUDE, {"resonance_um": 0.32}, "pole at 320 nm, inside range_nm"),
    (DRUDE, {"constant": -13.0}, "above zero over the whole of range_nm"),
    (DRUDE, {"strength": -7.3}, "above zero over the whole of range_nm"),
    (DRUDE, {"strength": math.inf}, "finite"),
    (DRUDE, {"range_nm": [760.0, 320.0]}, "must rise"),
    (TABLE, {"degrees_per_mm": [50.0, 30.0, 20.0]}, "4 wavelengths_nm but 3 degrees_per_mm"),
    (TABLE, {"degrees_per_mm": [50.0, 30.0, -20.0, 15.0]}, "greater than 0"),
    (TABLE, {"wavelengths_nm": [400.0, 600.0, 500.0, 700.0]}, "wavelengths_nm must rise"),
    (TABLE, {"range_nm": [300.0, 700.0]}, "range_nm must be the first and the last"),
    (TABLE, {"model": "cauchy"}, "does not match any of the expected tags"),
]


@pytest.mark.parametrize(("sound", "changes", "said"), FAULTS)
def test_faults_of_a_curve(sound: dict[str, Any], changes: dict[str, Any], said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        curve(sound, **changes)


# Winkelmann 1894, p. 801, first column: the lines whose print is undamaged, degrees per mm.
QUARTZ = [
    (759.37, 12.668),
    (718.5, 14.304),
    (430.79, 42.604),
    (410.17, 47.481),
    (393.37, 52.155),
    (382.04, 55.625),
    (372.76, 58.894),
    (358.1, 64.459),
    (336.1, 74.571),
    (317.98, 84.972),
]


def rotation(mineral: str, nm: float) -> float:
    found = minerals_db.mineral(mineral).optical_rotation
    assert found is not None
    return float(found.along_axis.degrees_per_mm_at(nm))


@pytest.mark.parametrize(("nm", "measured"), QUARTZ)
def test_quartz_follows_its_table(nm: float, measured: float) -> None:
    assert rotation("quartz", nm) == pytest.approx(measured, abs=0.07)


# Other observers on the same page, at C, D, E, F and G: two to four values each.
OTHERS = [
    (656.28, (17.24, 17.22, 17.299)),
    (589.3, (21.67, 21.67, 21.727)),
    (526.96, (27.46, 27.46)),
    (486.13, (32.50, 32.69, 32.722)),
    (430.79, (42.20, 42.31)),
]


@pytest.mark.parametrize(("nm", "measured"), OTHERS)
def test_quartz_agrees_with_other_observers(nm: float, measured: tuple[float, ...]) -> None:
    for value in measured:
        assert rotation("quartz", nm) == pytest.approx(value, rel=0.011)


def test_paratellurite_agrees_with_a_fit_of_another_form() -> None:
    # A λ²/(λ² − l²)² with A = 24.29, l = 0.24773 µm, 6.5 % off at worst: a wrong digit of the table would show.
    for nm in np.linspace(420.0, 1000.0, 59):
        squared = (nm * 1e-3) ** 2
        other = 24.29 * squared / (squared - 0.24773**2) ** 2
        assert rotation("paratellurite", float(nm)) == pytest.approx(other, rel=0.07)


def test_entries_name_their_hand_and_what_is_guessed() -> None:
    quartz = minerals_db.mineral("quartz")
    assert quartz.optical_rotation is not None
    # Donnay and Le Page 1978: the right screw, P 31 2 1, is laevorotatory.
    assert (quartz.cell.space_group, quartz.optical_rotation.hand.sense) == ("P 32 2 1", "right")
    assert quartz.optical_rotation.across_to_along.ratio == pytest.approx(5.7 / -13.6, abs=0.04)
    paratellurite = minerals_db.mineral("paratellurite").optical_rotation
    assert paratellurite is not None
    assert paratellurite.hand.status == paratellurite.across_to_along.status == "estimated"


@pytest.mark.parametrize(
    ("mineral", "group"), [("calcite", "-3m"), ("fluorapatite", "6/m"), ("rutile", "4/mmm"), ("fluorite", "m-3m")]
)
def test_symmetry_must_allow_rotation(mineral: str, group: str) -> None:
    quartz = minerals_db.mineral("quartz").model_dump(mode="json")
    entry = minerals_db.mineral(mineral).model_dump(mode="json") | {"optical_rotation": quartz["optical_rotation"]}
    with pytest.raises(ValidationError, match=f"class {group} turns nothing along an optic axis"):
        Mineral.model_validate(entry)


def test_faults_of_a_file_are_named_by_its_fields(tmp_path: Path) -> None:
    data = Path(minerals_db.__file__).parent / "data"
    text = (data / "quartz.yaml").read_text(encoding="utf-8")
    for old, new in (("strength: 7.30709", "strength: strong"), ("sense: right", "sense: up"), ("-0.42", ".nan")):
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "quartz.yaml").write_text(text, encoding="utf-8")
    for sources in data.glob("sources*.yaml"):
        (tmp_path / sources.name).write_bytes(sources.read_bytes())
    with pytest.raises(MineralDataError) as caught:
        load_minerals(tmp_path)
    assert [fault.field for fault in caught.value.faults] == [
        "optical_rotation.along_axis.strength",
        "optical_rotation.hand.sense",
        "optical_rotation.across_to_along.ratio",
    ]
