"""The demonstration `rotating-calcite`: a crystal block turns over a printed page (figure 8 of Debelov & Sattarov)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

import minerals_db
from crystal_core.errors import InputError
from crystal_core.materials import SODIUM_D_NM
from crystal_core.scene import SceneDocument, StagedScene, parse_scene
from crystal_core.sequence.demonstration import Demonstration, Parameters
from minerals_db.quality import colour_quality, dispersion_quality

__all__ = ["ROTATING_CALCITE", "RotatingCalcite"]

Side = Annotated[float, Field(ge=0.5, le=100, allow_inf_nan=False)]
OnPage = Annotated[float, Field(ge=-500, le=500, allow_inf_nan=False)]
Far = Annotated[float, Field(ge=-5000, le=5000, allow_inf_nan=False)]
Height = Annotated[float, Field(ge=1, le=5000, allow_inf_nan=False)]

AnalyserAngle = Annotated[float, Field(ge=0, le=180, allow_inf_nan=False)]

TABLE_REFLECTANCE = 0.25
"""Of the matte grey table that the page lies on."""

SPECIMEN = {"en": "Specimen", "ru": "Образец"}
PAGE = {"en": "Page", "ru": "Страница"}
CAMERA = {"en": "Camera", "ru": "Камера"}
LIGHT = {"en": "Light", "ru": "Свет"}


def _extra(en: str, ru: str, group: dict[str, str], unit: str | None = None, **more: Any) -> dict[str, Any]:
    extra: dict[str, Any] = {"x-label": {"en": en, "ru": ru}, "x-group": group, **more}
    if unit is not None:
        extra["x-unit"] = unit
    return extra


class RotatingCalcite(Parameters):
    """Parameters of `rotating-calcite`.

    The page lies in z = 0 with x to the right and y up in a vertical view; the specimen is centred over the origin.
    """

    scene_pointers: ClassVar[Mapping[str, str]] = {
        "/bodies/crystal/mineral": "mineral",
        "/bodies/crystal/shape/box": "size_mm",
        "/bodies/crystal/shape": "cut",
        "/bodies/crystal": "size_mm",
        "/surfaces/page/print": "texture",
        "/surfaces/page/marks_mm": "marks",
        "/surfaces/page/mark_diameter_mm": "mark_diameter_mm",
        "/camera": "camera_distance_mm",
        "/lights": "light_position_mm",
    }

    mineral: Annotated[str, Field(min_length=1, max_length=64)] = Field(
        "calcite",
        title="Mineral",
        description="Id of a mineral of the database.",
        json_schema_extra=_extra("Mineral", "Минерал", SPECIMEN) | {"x-choices": "minerals"},
    )
    cut: Literal["block", "cleavage"] = Field(
        "block",
        title="Cut",
        description="A sawn block, or the rhombohedron that the crystal cleaves into, lying on a face.",
        json_schema_extra=_extra("Cut", "Форма", SPECIMEN),
    )
    size_mm: tuple[Side, Side, Side] = Field(
        (20.0, 20.0, 12.0),
        title="Size",
        description="Edges of the block, or distances between the pairs of cleavage faces; the last is the thickness.",
        json_schema_extra=_extra("Size", "Размеры", SPECIMEN, "mm"),
    )
    axis_tilt_deg: float = Field(
        44.64,
        ge=0,
        le=180,
        title="Tilt of the crystal's z axis",
        description="Angle of c* (the optic axis of a uniaxial crystal) from the upward normal; 44.64° is that of a "
        "calcite cleavage face. A cleavage rhombohedron takes it from the cell.",
        json_schema_extra=_extra("Axis c*, tilt", "Наклон оси c*", SPECIMEN, "°"),
    )
    axis_azimuth_deg: float = Field(
        0.0,
        ge=-360,
        le=360,
        title="Azimuth of the crystal's z axis",
        description="Azimuth of c* at stage angle 0, counter-clockwise from x; the axis a lies in the plane of c* and "
        "the vertical.",
        json_schema_extra=_extra("Axis c*, azimuth", "Азимут оси c*", SPECIMEN, "°"),
    )
    gap_mm: float = Field(
        0.02,
        gt=0,
        le=50,
        title="Air gap",
        description="Height of the specimen's lowest point above the page.",
        json_schema_extra=_extra("Air gap", "Воздушный зазор", SPECIMEN, "mm"),
    )
    first_angle_deg: float = Field(
        0.0,
        ge=-360,
        le=360,
        title="Stage angle of frame 0",
        description="Frame i of N stands at this angle + 360°·i/N, counter-clockwise seen from above.",
        json_schema_extra=_extra("First stage angle", "Начальный угол столика", SPECIMEN, "°"),
    )
    texture: Annotated[str, Field(pattern=r"^(digits|asset:[0-9a-f]{64})$")] = Field(
        "digits",
        title="Texture",
        description="What is printed on the page: digits between fine lines, or a picture of one's own.",
        json_schema_extra=_extra("Print", "Печать", PAGE),
    )
    page_width_mm: float = Field(
        64.0,
        ge=1,
        le=1000,
        title="Width of the page",
        description="Width of the printed sheet; its height follows from the picture.",
        json_schema_extra=_extra("Page width", "Ширина листа", PAGE, "mm"),
    )
    marks: Annotated[tuple[tuple[OnPage, OnPage], ...], Field(max_length=64)] = Field(
        (),
        title="Marks",
        description="Centres [x, y] of black dots on the page, for measuring.",
        json_schema_extra=_extra("Marks", "Метки", PAGE, "mm"),
    )
    mark_diameter_mm: float = Field(
        0.4,
        ge=0.05,
        le=20,
        title="Diameter of a mark",
        description="Diameter of the dots.",
        json_schema_extra=_extra("Mark diameter", "Диаметр метки", PAGE, "mm"),
    )
    camera_tilt_deg: float = Field(
        15.0,
        ge=0,
        le=75,
        title="Tilt of the camera",
        description="Angle of the line of sight from the vertical; 0 looks straight down.",
        json_schema_extra=_extra("Camera tilt", "Наклон камеры", CAMERA, "°"),
    )
    camera_distance_mm: float = Field(
        170.0,
        ge=20,
        le=9000,
        title="Distance of the camera",
        description="From the eye to the middle of the specimen.",
        json_schema_extra=_extra("Camera distance", "Расстояние камеры", CAMERA, "mm"),
    )
    vfov_deg: float = Field(
        16.0,
        ge=0.05,
        le=90,
        title="Field of view",
        description="Vertical angle of the picture.",
        json_schema_extra=_extra("Field of view", "Поле зрения", CAMERA, "°"),
    )
    analyser_deg: AnalyserAngle | None = Field(
        None,
        title="Analyser",
        description="Transmission direction of an analyser in front of the camera, from the picture's +x, "
        "counter-clockwise as seen in the picture; none if null.",
        json_schema_extra=_extra("Analyser", "Анализатор", CAMERA, "°"),
    )
    light_position_mm: tuple[Far, Far, Height] = Field(
        (-90.0, 130.0, 380.0),
        title="Position of the light",
        description="A point source of daylight (D65).",
        json_schema_extra=_extra("Light position", "Положение источника", LIGHT, "mm"),
    )
    sky_fraction: float = Field(
        0.3,
        ge=0,
        le=1,
        title="Share of the sky",
        description="Share of a uniform sky in the illuminance at the centre of the bare page.",
        json_schema_extra=_extra("Share of sky light", "Доля рассеянного света", LIGHT),
    )

    def document(self, frames: int = 1) -> SceneDocument:
        """Return the scene in the scene language, with the motion of as many frames.

        Raises
        ------
        InputError
            An unknown mineral, or a cleavage that it does not have; the pointers are those of the scene.
        """
        tilt = np.deg2rad(self.camera_tilt_deg)
        middle, reach = self.gap_mm + 0.5 * self.size_mm[2], self.camera_distance_mm
        eye = [0.0, -reach * float(np.sin(tilt)), middle + reach * float(np.cos(tilt))]
        page: dict[str, Any] = {"print": self.texture, "shape": {"rectangle": {"width_mm": self.page_width_mm}}}
        if self.marks:
            page |= {"marks_mm": self.marks, "mark_diameter_mm": self.mark_diameter_mm}
        camera: dict[str, Any] = {
            "perspective": {
                "eye_mm": eye,
                "target_mm": [0.0, 0.0, middle],
                "up": [0.0, float(np.cos(tilt)), float(np.sin(tilt))],
                "vfov_deg": self.vfov_deg,
            }
        }
        if self.analyser_deg is not None:
            camera["analyser_deg"] = self.analyser_deg
        turned = [self.first_angle_deg, self.first_angle_deg + 360.0]
        return parse_scene(
            {
                "isogyre": 1,
                "title": "Rotating calcite",
                "bodies": {"crystal": self._crystal() | {"rests_on": "page", "gap_mm": self.gap_mm}},
                "surfaces": {
                    "page": page,
                    "table": {"reflectance": TABLE_REFLECTANCE, "shape": {"endless": {}}},
                },
                "lights": self._lights(),
                "camera": camera,
                "motion": {"frames": frames, "moves": [{"stage": {"angles_deg": turned}}]},
            }
        )

    def _crystal(self) -> dict[str, Any]:
        """Return the body, its crystal as the cut and the axis have it."""
        if self.cut == "block":
            tilt, azimuth = np.deg2rad((self.axis_tilt_deg, self.axis_azimuth_deg))
            lean = np.array(((np.cos(tilt), 0.0, np.sin(tilt)), (0.0, 1.0, 0.0), (-np.sin(tilt), 0.0, np.cos(tilt))))
            turn = np.array(
                ((np.cos(azimuth), -np.sin(azimuth), 0.0), (np.sin(azimuth), np.cos(azimuth), 0.0), (0.0, 0.0, 1.0))
            )
            return {
                "mineral": self.mineral,
                "shape": {"box": {"size_mm": self.size_mm}},
                "orientation": {"matrix": (turn @ lean).tolist()},
            }
        return {
            "mineral": self.mineral,
            # The face that lies on the page comes first.
            "shape": {"cleavage": {"spacing_mm": [self.size_mm[2], self.size_mm[0], self.size_mm[1]]}},
            "orientation": {"z": {"hkl": self._cleavage()}, "x": {"uvw": [0, 0, 1]}},
            "turns": [{"about": "z", "angle_deg": self.axis_azimuth_deg}],
        }

    def _cleavage(self) -> list[int]:
        """Return the plane of the mineral's rhombohedral cleavage."""
        mineral = minerals_db.minerals().get(self.mineral)
        if mineral is None:
            return [1, 0, 4]  # that the mineral is unknown is told of the scene
        # A poor cleavage gives no rhombohedron, as every hammer finds with quartz.
        good = [c.hkl for c in mineral.cleavage if c.quality in ("perfect", "good")]
        rhombohedra = [hkl for hkl in good if hkl[1] == 0 and hkl[0] != 0 and hkl[2] != 0]
        if mineral.system != "trigonal" or not rhombohedra:
            raise InputError.at(
                "/bodies/crystal/shape", f"{mineral.id} does not cleave into a rhombohedron; cut it as a block"
            )
        return list(rhombohedra[0])

    def _lights(self) -> dict[str, Any]:
        """Return lamp and sky, together 1000 lx at the centre of the bare page."""
        lights: dict[str, Any] = {}
        position = np.array(self.light_position_mm)
        if self.sky_fraction < 1.0:
            slant = float(position[2] / np.sqrt(position @ position))
            illuminance = 1000.0 * (1.0 - self.sky_fraction) / slant
            lights["lamp"] = {"point": {"position_mm": self.light_position_mm, "illuminance_lx": illuminance}}
        if self.sky_fraction > 0.0:
            lights["sky"] = {"sky": {"illuminance_lx": 1000.0 * self.sky_fraction}}
        return lights

    def angle_deg(self, index: int, frames: int) -> float:
        """Return the stage angle of a frame; 360° itself is not repeated."""
        return self.first_angle_deg + 360.0 * index / frames

    def facts(self, staged: StagedScene) -> dict[str, Any]:
        """Return what repeats the geometry by hand, for the manifest."""
        body, mineral = staged.specimen.body, minerals_db.mineral(self.mineral)
        indices = [float(n) for n in staged.specimen.indices(SODIUM_D_NM)]
        facts: dict[str, Any] = {
            "mineral": self.mineral,
            "data_quality": {
                "dispersion": dispersion_quality(mineral),
                "colour": colour_quality(mineral),
            },
            "cut": self.cut,
            "z0_mm": float(body.vertices[:, 2].min()),
            "z1_mm": float(body.vertices[:, 2].max()),
            "page_z_mm": 0.0,
            "gap_mm": self.gap_mm,
            "vertices_mm": body.vertices.tolist(),
            "faces": [
                {"normal": normal.tolist(), "offset_mm": float(offset)}
                for normal, offset in zip(body.normals, body.offsets, strict=True)
            ],
            "marks_mm": [list(mark) for mark in self.marks],
            "mark_diameter_mm": self.mark_diameter_mm,
            "page_width_mm": self.page_width_mm,
            "light_mm": list(self.light_position_mm),
            "sky_fraction": self.sky_fraction,
            "analyser_deg": self.analyser_deg,
            "indices_wavelength_nm": SODIUM_D_NM,
        }
        if self.cut == "block":
            facts["half_size_mm"] = [0.5 * self.size_mm[0], 0.5 * self.size_mm[1]]
        if len(indices) == 1:
            facts["n"] = indices[0]
        elif len(indices) == 2:
            facts |= {"optic_axis": staged.specimen.axis.tolist(), "n_o": indices[0], "n_e": indices[1]}
        else:
            axes = staged.specimen.medium(SODIUM_D_NM).axes
            assert axes is not None  # of every biaxial medium
            facts |= {"indices": indices, "principal_axes": axes.tolist()}
        return facts


ROTATING_CALCITE = Demonstration(
    "rotating-calcite",
    {"en": "Rotating calcite", "ru": "Вращающийся кальцит"},
    {
        "en": "A calcite block turns over a printed page. Each digit is seen twice: the ordinary image stands still, "
        "the extraordinary one circles it.",
        "ru": "Кристалл кальцита вращается над печатной страницей. Каждая цифра видна дважды: обыкновенное изображение "
        "неподвижно, необыкновенное обходит его по кругу.",
    },
    RotatingCalcite,
)
