"""What is wrong with a scene is told in plain words, all of it at once, each fault at its place."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from crystal_core.errors import InputError
from crystal_core.scene import parse_scene
from tests.scene.staging import BOX, CALCITE, TABLE, bodies, body, scene


def faults(mapping: Any) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        parse_scene(mapping)
    return {fault.pointer: fault.message for fault in caught.value.faults}


def test_several_faults_are_told_at_once() -> None:
    told = faults(
        {
            "isogyre": 1,
            "titel": "x",
            "bodies": {"a": {"mineral": "calcit", "shape": {"box": {"size_mm": [1, "2", 3]}, "sphere": {}}}},
            "lights": {},
            "render": {"size_px": [8, 512], "dispersion": 1},
        }
    )
    assert told.pop("/bodies/a/mineral").startswith("no mineral 'calcit'; do you mean calcite")
    assert told == {
        "/titel": "unknown key; did you mean title?",
        "/bodies/a/shape/sphere": "does not go with box: give one of habit, cleavage, box, plate, wedge, prism, "
        "column, sphere, cabochon, brilliant, step_cut, mesh",
        "/bodies/a/shape/box/size_mm/1": 'must be a number, not "2" (a number in quotes, or one like 1e3, is text: '
        "write 1000 or 1.0e+3)",
        "/lights": "needs at least 1 values",
        "/render/size_px/0": "must be at least 16, not 8",
        "/render/dispersion": "must be true or false, not 1",
    }


@pytest.mark.parametrize(
    ("mapping", "pointer", "words"),
    [
        ({}, "/isogyre", "required"),
        ({"isogyre": 2, "bodies": {"a": CALCITE}}, "/isogyre", "must be 1"),
        ({"isogyre": True, "bodies": {"a": CALCITE}}, "/isogyre", "must be 1"),
        (scene(), "", "the scene is empty"),
        (scene(bodies={"a": CALCITE}, surfaces={"a": TABLE}), "/surfaces/a", "taken by /bodies/a"),
        (bodies(**{"2a": CALCITE}), "/bodies/2a", "must match"),
        (bodies(a={"shape": {"box": {}}}), "/bodies/a", "give one of mineral, optics"),
        (bodies(a={"mineral": "calcite"}), "/bodies/a/shape", "required"),
        (bodies(a=body(CALCITE, shape={})), "/bodies/a/shape", "give one of habit"),
        (bodies(a=body(CALCITE, optics={"n": 1})), "/bodies/a/optics", "does not go with mineral"),
        (bodies(a=body(BOX, optics={"n": 1, "o": 1})), "/bodies/a/optics", "give n, or o and e"),
        (bodies(a=body(BOX, optics={"n": 11})), "/bodies/a/optics/n", "must be at most 10"),
        (bodies(a=body(BOX, optics={"n": {"cauchy": {"a": 1, "b_um2": -1}}})), "/bodies/a/optics/n/cauchy", "from"),
        (bodies(a=body(BOX, concentrations={"chromium": 1})), "/bodies/a/concentrations", "goes with a mineral"),
        (bodies(a=body(CALCITE, concentrations={"iron": 1})), "/bodies/a/concentrations/iron", "calcite has no chrom"),
        (bodies(a=body(BOX, shape={"habit": {}})), "/bodies/a/shape/habit", "has no lattice"),
        (bodies(a={"mineral": "glass-n-bk7", "shape": {"cleavage": {}}}), "/bodies/a/shape/cleavage", "no lattice"),
        (bodies(a=body(BOX, orientation={"z": {"hkl": [1, 0, 0]}})), "/bodies/a/orientation/z/hkl", "no lattice"),
        (bodies(a=body(CALCITE, shape={"habit": {"name": "cube"}})), "/bodies/a/shape/habit/name", "no habit 'cube'"),
        (bodies(a=body(CALCITE, twin={"law": "mine"})), "/bodies/a/twin/law", "no twin law 'mine'"),
        (bodies(a=body(BOX, twin={"plane_hkl": [1, 0, 0]})), "/bodies/a/twin", "goes with the shape habit"),
        (bodies(a=body(CALCITE, position_mm=[1, 2])), "/bodies/a/position_mm", "must have 3 numbers"),
        (bodies(a=body(CALCITE, gap_mm=1)), "/bodies/a/gap_mm", "goes with rests_on"),
        (bodies(a=body(CALCITE, rests_on="b")), "/bodies/a/rests_on", "no surface or body 'b'; there are a"),
        (bodies(a=body(CALCITE, inside="a")), "/bodies/a/inside", "goes in a circle"),
        (bodies(a=body(CALCITE, inside="b"), b=body(CALCITE, joined_to="a")), "/bodies/b/joined_to", "in a circle"),
        (
            bodies(a=body(CALCITE, orientation={axis: {"uvw": [1, 0, 0]} for axis in "xyz"})),
            "/bodies/a/orientation/y",
            "two directions",
        ),
        (
            bodies(a=body(CALCITE, orientation={"matrix": [[1, 0, 0], [0, 1, 0], [0, 0, -1]]})),
            "/bodies/a/orientation/matrix",
            "mirror image",
        ),
        (bodies(a=body(CALCITE, turns=[{"about": "w", "angle_deg": 1}])), "/bodies/a/turns/0/about", "must be x, y, z"),
        (bodies(a=body(CALCITE, turns=[{"about": [0, 0, 0], "angle_deg": 1}])), "/bodies/a/turns/0/about", "nowhere"),
        (scene(surfaces={"p": {"print": "a.gif"}}), "/surfaces/p/print", "must be a file .png"),
        (scene(surfaces={"p": {"print": "asset:12"}}), "/surfaces/p/print", "64 hex digits"),
        (scene(surfaces={"p": {"print": "a.png"}}), "/surfaces/p/print", "is a path"),
        (scene(surfaces={"p": {"reflectance": 0.5, "marks_mm": [[0, 0]]}}), "/surfaces/p/marks_mm", "goes with print"),
        (
            scene(surfaces={"p": {"print": "digits", "shape": {"disc": {}}}}),
            "/surfaces/p/shape/disc",
            "a print is a rectangle",
        ),
        (scene(surfaces={"p": TABLE | {"up": "-z"}}), "/surfaces/p/up", "parallel to facing"),
        (
            scene(surfaces={"p": TABLE}, lights={"l": {"point": {}, "spectrum": "D55"}}),
            "/lights/l/spectrum",
            "must be 'D65', 'A' or 'E'",
        ),
        (
            scene(surfaces={"p": TABLE}, lights={"l": {"sky": {}, "spectrum": {"lines": [{"wavelength_nm": 200}]}}}),
            "/lights/l/spectrum/lines/0/wavelength_nm",
            "must be at least 360",
        ),
        (
            scene(
                surfaces={"p": TABLE},
                lights={"l": {"sky": {}, "spectrum": {"table": {"wavelengths_nm": [500, 400], "values": [1, 1]}}}},
            ),
            "/lights/l/spectrum/table/wavelengths_nm/1",
            "must rise",
        ),
        (scene(surfaces={"p": TABLE}, surroundings={"mineral": "calcite"}), "/surroundings/mineral", "isotropic"),
        (scene(surfaces={"p": TABLE}, camera={"perspective": {"eye_mm": [0, 0, 0]}}), "/camera/perspective", ""),
        (scene(surfaces={"p": TABLE}, camera={"analyser_deg": 3}), "/camera", "give one of fitted"),
    ],
)  # fmt: skip
def test_a_fault_has_its_place_and_reason(mapping: Any, pointer: str, words: str) -> None:
    told = faults(mapping)
    found = [
        message for place, message in told.items() if place == pointer or (not words and place.startswith(pointer))
    ]
    assert found, told
    assert words in found[0], told


MOVES = [
    ({"turn": {"what": "c", "angles_deg": [0, 90]}}, "turn/what", "no body, sheet or light 'c'"),
    ({"turn": {"what": "lamp", "angles_deg": [0, 90]}}, "turn/what", "alike in all directions"),
    ({"turn": {"what": "p", "about": "x", "angles_deg": [0, 90]}}, "turn/about", "turns about its normal"),
    ({"turn": {"what": "beam", "angles_deg": [0, 90]}}, "turn/about", "required for a light"),
    ({"shift": {"what": "a", "positions_mm": [[0, 0, 0], [1, 0, 0]]}}, "shift/what", "rests on t"),
    ({"shift": {"what": "sky", "positions_mm": [[0, 0, 0], [1, 0, 0]]}}, "shift/what", "stands nowhere"),
    ({"analyser": {"angles_deg": [0, 90]}}, "analyser", "no analyser"),
    ({"wavelength": {"of": "lamp", "wavelengths_nm": [400, 700]}}, "wavelength/of", "one line"),
    ({"turn": {"what": "a", "angles_deg": [0, 90], "at": [0, 0.5]}}, "turn/at", "from 0 to 1"),
    ({"turn": {"what": "a", "angles_deg": [0, 90], "at": [0, 0.5, 1]}}, "turn/at", "3 times for 2 values"),
    ({"turn": {"what": "a", "angles_deg": [0]}}, "turn/angles_deg", "at least 2 values"),
]


@pytest.mark.parametrize(("move", "place", "words"), MOVES)
def test_motions_name_what_can_move(move: Any, place: str, words: str) -> None:
    mapping = scene(
        bodies={"a": body(CALCITE, rests_on="t")},
        surfaces={"t": TABLE},
        sheets={"p": {"polarizer": {}, "position_mm": [0, 0, 40]}},
        lights={
            "lamp": {"point": {}},
            "sky": {"sky": {}},
            "beam": {"beam": {"position_mm": [0, 0, 50], "direction": "-z"}},
        },
        motion={"moves": [move]},
    )
    told = faults(mapping)
    assert list(told) == [f"/motion/moves/0/{place}"]
    assert words in told[f"/motion/moves/0/{place}"]


def test_the_same_thing_is_moved_once() -> None:
    move = {"turn": {"what": "a", "angles_deg": [0, 90]}}
    told = faults(scene(bodies={"a": CALCITE}, motion={"moves": [move, copy.deepcopy(move)]}))
    assert told == {"/motion/moves/1/turn": "the same is said by /motion/moves/0"}


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("size", "did you mean size_mm?"),
        ("size_cm", "did you mean size_mm?"),
        ("sise_mm", "did you mean size_mm?"),
        ("colour", "the keys are size_mm, thickness_um"),
    ],
)
def test_an_unknown_key_is_told_what_may_be_meant(key: str, words: str) -> None:
    plate = {"optics": {"n": 1.5}, "shape": {"plate": {"thickness_um": 1, key: 1}}}
    assert faults(bodies(a=plate)) == {f"/bodies/a/shape/plate/{key}": f"unknown key; {words}"}


def test_keys_are_text() -> None:
    assert faults({"isogyre": 1, "bodies": {True: CALCITE}}) == {"/bodies": "the key True is no text: put it in quotes"}


def test_a_scene_is_a_mapping() -> None:
    assert faults(["isogyre"]) == {"": "a scene is a mapping of keys"}


def test_what_unfolds_without_end_is_refused() -> None:
    lots: Any = [1] * 1000
    for _ in range(4):
        lots = [lots] * 100
    assert "values" in faults({"isogyre": 1, "title": lots})[""]
