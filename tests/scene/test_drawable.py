"""What the renderer can draw of the language, and what it says of the rest."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crystal_core.errors import NotSupportedError
from crystal_core.scene import StagedScene, drawable, stage_scene
from crystal_core.scene.staged import StagedDocument
from crystal_core.sequence.rotating_calcite import RotatingCalcite
from tests.scene.staging import BALL, BOX, TABLE, body, close, scene, staged

CALCITE: dict[str, Any] = {
    "mineral": "calcite",
    "shape": {"cleavage": {"spacing_mm": [12, 20, 20]}},
    "orientation": {"z": {"hkl": [1, 0, 4]}, "x": {"uvw": [0, 0, 1]}},
    "rests_on": "page",
}
PAGE: dict[str, Any] = {"page": {"print": "digits"}, "table": {"reflectance": 0.25, "shape": {"endless": {}}}}
COS = 380 / np.linalg.norm((-90, 130, 380))


def demonstration(**more: Any) -> dict[str, Any]:
    """Return the demonstration `rotating-calcite` with its cleavage rhombohedron as a scene."""
    tilt, reach = np.deg2rad(15.0), 170.0
    target = np.array((0.0, 0.0, 0.02 + 6.0))
    eye = target + reach * np.array((0.0, -np.sin(tilt), np.cos(tilt)))
    mapping = scene(
        bodies={"crystal": CALCITE},
        surfaces=PAGE,
        lights={
            "lamp": {"point": {"position_mm": [-90, 130, 380], "illuminance_lx": 700 / COS}},
            "sky": {"sky": {"illuminance_lx": 300}},
        },
        camera={"perspective": {"eye_mm": eye.tolist(), "target_mm": target.tolist(), "vfov_deg": 16}},
        motion={"moves": [{"turn": {"what": "crystal", "angles_deg": [0, 360]}}]},
    )
    return mapping | more


def same(one: StagedScene, other: StagedScene) -> bool:
    wavelengths = np.array([450.0, 650.0])
    media = one.specimen.medium(wavelengths), other.specimen.medium(wavelengths)
    a, b = one.specimen.body, other.specimen.body
    pairs: list[tuple[Any, Any]] = [
        (np.sort(a.normals @ (1, 10, 100)), np.sort(b.normals @ (1, 10, 100))),
        (np.sort(a.vertices @ (1, 10, 100)), np.sort(b.vertices @ (1, 10, 100))),
        (media[0].indices, media[1].indices),
        (np.abs(np.asarray(media[0].axis).T @ np.asarray(media[1].axis)), 1.0),
        (one.specimen.indices(589.3), other.specimen.indices(589.3)),
        (one.page.texture.texels[::64, ::64], other.page.texture.texels[::64, ::64]),
        (one.page.texture.width_mm, other.page.texture.width_mm),
        (one.page.table_reflectance, other.page.table_reflectance),
        (one.light_mm, other.light_mm),
        (one.sky_fraction, other.sky_fraction),
        (one.exposure, other.exposure),
        *(
            (getattr(one.camera, key), getattr(other.camera, key))
            for key in ("eye", "forward", "right", "up", "tan_half")
        ),
    ]
    return all(close(x, y, 1e-9) for x, y in pairs)


def demonstrated(frame: int = 0, **parameters: Any) -> StagedScene:
    return drawable(stage_scene(RotatingCalcite(cut="cleavage", **parameters).document(36)).at(frame))


def test_the_demonstration_is_a_scene() -> None:
    by_hand = staged(demonstration())
    assert same(demonstrated(), drawable(by_hand))
    assert same(demonstrated(7), drawable(by_hand.at(7)))
    assert not same(demonstrated(8), drawable(by_hand.at(7)))


def test_the_analyser_and_the_exposure() -> None:
    mapping = demonstration()
    mapping["camera"] = mapping["camera"] | {"analyser_deg": 30}
    old, new = demonstrated(analyser_deg=30), drawable(staged(mapping))
    assert same(old, new)
    assert new.camera.analyser is not None
    assert old.camera.analyser is not None
    assert close(new.camera.analyser, old.camera.analyser)
    brighter = drawable(staged(mapping | {"render": {"exposure": 2.5}}))
    assert brighter.exposure == pytest.approx(2.5)


def test_a_sky_alone() -> None:
    dark = demonstrated(sky_fraction=1.0)
    assert dark.sky_fraction == 1.0
    assert dark.exposure == demonstrated().exposure


def test_a_scene_elsewhere_is_brought_to_the_renderers_page() -> None:
    mapping = demonstration()
    shift = np.array((100.0, -50.0, 30.0))
    for surface in ("page", "table"):
        mapping["surfaces"] = mapping["surfaces"] | {
            surface: PAGE[surface] | {"position_mm": shift.tolist()},
        }
    mapping["bodies"] = {"crystal": CALCITE | {"position_mm": shift[:2].tolist()}}
    camera = mapping["camera"]["perspective"]
    for key in ("eye_mm", "target_mm"):
        camera[key] = (np.array(camera[key]) + shift).tolist()
    lamp = np.array((-90.0, 130.0, 380.0))
    illuminance = 700 / COS * (lamp @ lamp) / ((lamp + shift) @ (lamp + shift))
    point = {"position_mm": (lamp + shift).tolist(), "illuminance_lx": illuminance}
    mapping["lights"] = {"lamp": {"point": point}, "sky": {"sky": {}}}
    assert same(demonstrated(), drawable(staged(mapping)))


def test_any_convex_crystal_on_a_table_alone() -> None:
    topaz = {"mineral": "topaz", "shape": {"habit": {}}, "rests_on": "table"}
    staged_scene = drawable(staged(scene(bodies={"a": topaz}, surfaces={"table": PAGE["table"]})))
    assert staged_scene.page.table_reflectance == 0.25
    assert float(staged_scene.page.texture.mean) == pytest.approx(0.25)
    assert len(staged_scene.specimen.indices(550.0)) == 3


def test_dispersion_and_concentrations_are_drawn() -> None:
    ruby = {"mineral": "ruby", "concentrations": {"chromium": 4}, "shape": {"habit": {}}, "rests_on": "table"}
    mapping = scene(bodies={"a": ruby}, surfaces={"table": PAGE["table"]}, render={"dispersion": False})
    specimen = drawable(staged(mapping)).specimen
    assert specimen.filling.mineral is not None
    pale = specimen.filling.mineral.absorption
    assert pale is not None
    n_o, _ = specimen.indices([400.0, 700.0])
    assert n_o[0] == n_o[1]
    coefficients = specimen.medium([550.0]).absorption_per_mm
    assert coefficients is not None
    assert coefficients[0][0] > 2 * pale.per_mm("o", 550.0)


ONE = {"a": body(BOX, mineral="glass-n-bk7", rests_on="table") | {"optics": None}}


def drawn(**parts: Any) -> StagedDocument:
    return staged(scene(**({"bodies": ONE, "surfaces": {"table": TABLE}} | parts)))


def test_a_glass_box_can_be_drawn() -> None:
    assert drawable(drawn()).sky_fraction > 0


@pytest.mark.parametrize(
    ("parts", "pointer"),
    [
        ({"bodies": {}}, "/bodies"),
        ({"bodies": ONE | {"b": body(BALL, rests_on="a")}}, "/bodies/b"),
        ({"bodies": {"b": body(BALL, rests_on="table")}}, "/bodies/b/shape/sphere"),
        (
            {
                "bodies": {
                    "t": {
                        "mineral": "spinel",
                        "shape": {"habit": {}},
                        "twin": {"law": "spinel law"},
                        "rests_on": "table",
                    }
                }
            },
            "/bodies/t/twin",
        ),
        (
            {
                "bodies": {
                    "w": {"mineral": "quartz", "shape": {"wedge": {"thickness_um": [0, 250]}}, "rests_on": "table"}
                }
            },
            "/bodies/w/shape/wedge",
        ),
        ({"surroundings": {"optics": {"n": 1.3}}}, "/surroundings"),
        ({"sheets": {"p": {"polarizer": {}, "position_mm": [0, 0, 50]}}}, "/sheets/p"),
        ({"surfaces": {"table": TABLE | {"reflectance": {"srgb": [1, 0, 0]}}}}, "/surfaces/table/reflectance"),
        ({"surfaces": {"table": TABLE, "d": {"reflectance": 0.1, "shape": {"disc": {}}}}}, "/surfaces/d/shape"),
        (
            {"surfaces": {"table": TABLE, "d": {"print": "digits", "position_mm": [0, 0, 99]}}},
            "/surfaces/table",
        ),
        ({"lights": {"l": {"point": {}, "spectrum": "A"}}}, "/lights/l/spectrum"),
        ({"lights": {"l": {"point": {}, "polarization": {"vibration": "x"}}}}, "/lights/l/polarization"),
        ({"lights": {"l": {"area": {"position_mm": [0, 0, 99]}}}}, "/lights/l/area"),
        ({"lights": {"l": {"point": {}}, "m": {"point": {}}}}, "/lights/m"),
        ({"lights": {"l": {"point": {"position_mm": [50, 0, 5]}}}}, "/lights/l/point/position_mm"),
        ({"camera": {"orthographic": {"eye_mm": [0, 0, 99]}}}, "/camera/orthographic"),
    ],
)
def test_the_rest_is_refused_by_name_and_place(parts: dict[str, Any], pointer: str) -> None:
    document = drawn(**parts)
    with pytest.raises(NotSupportedError, match=f"^{pointer}: .* drawn") as caught:
        drawable(document)
    assert "\n" not in str(caught.value)
