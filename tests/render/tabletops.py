"""Scenes as the renderer takes them, for its tests: a block over a page, daylight and sky."""

from __future__ import annotations

from typing import Any

import numpy as np

from crystal_core.scene import StagedScene, drawable, parse_scene, stage_scene

Point = tuple[float, float, float]


def tabletop(
    mineral: str = "calcite",
    *,
    size_mm: Point = (20.0, 20.0, 12.0),
    azimuth_deg: float = 0.0,
    stage_deg: float = 0.0,
    eye_mm: Point = (0.0, 0.0, 300.0),
    target_mm: Point = (0.0, 0.0, 0.0),
    vfov_deg: float = 20.0,
    analyser_deg: float | None = None,
    light_mm: Point = (-90.0, 130.0, 380.0),
    sky_fraction: float = 0.3,
    page: dict[str, Any] | None = None,
    exposure: float | None = None,
) -> StagedScene:
    """Return a block whose c axis leans by 44.64° towards `azimuth_deg`, turned with the stage, just above a page."""
    position = np.array(light_mm)
    lamp = 1000.0 * (1.0 - sky_fraction) * float(np.sqrt(position @ position) / position[2])
    lights = {
        "lamp": {"point": {"position_mm": light_mm, "illuminance_lx": lamp}},
        "sky": {"sky": {"illuminance_lx": 1000.0 * sky_fraction}},
    }
    dark = {0.0: "sky", 1.0: "lamp"}.get(sky_fraction)
    tilt = np.deg2rad(44.64)
    lean = [[np.cos(tilt), 0.0, np.sin(tilt)], [0.0, 1.0, 0.0], [-np.sin(tilt), 0.0, np.cos(tilt)]]
    a = np.deg2rad(azimuth_deg)
    turn = np.array([[np.cos(a), -np.sin(a), 0.0], [np.sin(a), np.cos(a), 0.0], [0.0, 0.0, 1.0]])
    mapping: dict[str, Any] = {
        "isogyre": 1,
        "bodies": {
            "crystal": {
                "mineral": mineral,
                "shape": {"box": {"size_mm": size_mm}},
                "orientation": {"matrix": (turn @ np.array(lean)).tolist()},
                "turns": [{"about": "z", "angle_deg": stage_deg}],
                "rests_on": "page",
                "gap_mm": 0.02,
            }
        },
        "surfaces": {"page": {"print": "digits"} if page is None else page, "table": _TABLE},
        "lights": {name: light for name, light in lights.items() if name != dark},
        "camera": {
            "perspective": {"eye_mm": eye_mm, "target_mm": target_mm, "vfov_deg": vfov_deg},
            "analyser_deg": analyser_deg,
        },
    }
    if exposure is not None:
        mapping["render"] = {"exposure": exposure}
    return drawable(stage_scene(parse_scene(mapping)))


_TABLE = {"reflectance": 0.25, "shape": {"endless": {}}}
