"""The demonstration `rotating-calcite`: a crystal block turns over a printed page (figure 8 of Debelov & Sattarov)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from crystal_core.materials import SODIUM_D_NM
from crystal_core.scene import Camera, Page, PointLight, Scene, Shape, Sky, Specimen, StagedScene
from crystal_core.scene.description import AnalyserAngle
from crystal_core.sequence.demonstration import Demonstration, Parameters
from minerals_db.quality import colour_quality, dispersion_quality

__all__ = ["ROTATING_CALCITE", "RotatingCalcite"]

Side = Annotated[float, Field(ge=0.5, le=100, allow_inf_nan=False)]
OnPage = Annotated[float, Field(ge=-500, le=500, allow_inf_nan=False)]
Far = Annotated[float, Field(ge=-5000, le=5000, allow_inf_nan=False)]
Height = Annotated[float, Field(ge=1, le=5000, allow_inf_nan=False)]

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
        "/specimen/mineral": "mineral",
        "/specimen/shape/cut": "cut",
        "/page/texture": "texture",
        "/page/marks_mm": "marks",
        "/page/mark_diameter_mm": "mark_diameter_mm",
        "/camera": "camera_distance_mm",
        "/light": "light_position_mm",
        "/shape": "size_mm",
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

    def scene(self) -> Scene:
        """Return the scene, its specimen at stage angle 0."""
        tilt = np.deg2rad(self.camera_tilt_deg)
        target = (0.0, 0.0, self.gap_mm + 0.5 * self.size_mm[2])
        reach = self.camera_distance_mm
        return Scene(
            specimen=Specimen(
                mineral=self.mineral,
                shape=Shape(
                    cut=self.cut,
                    size_mm=self.size_mm,
                    axis_tilt_deg=self.axis_tilt_deg,
                    axis_azimuth_deg=self.axis_azimuth_deg,
                ),
                gap_mm=self.gap_mm,
            ),
            page=Page(
                texture=self.texture,
                width_mm=self.page_width_mm,
                marks_mm=self.marks,
                mark_diameter_mm=self.mark_diameter_mm,
            ),
            light=PointLight(position_mm=self.light_position_mm),
            sky=Sky(fraction=self.sky_fraction),
            camera=Camera(
                eye_mm=(0.0, -reach * float(np.sin(tilt)), target[2] + reach * float(np.cos(tilt))),
                target_mm=target,
                up=(0.0, float(np.cos(tilt)), float(np.sin(tilt))),
                vfov_deg=self.vfov_deg,
                analyser_deg=self.analyser_deg,
            ),
            # Half of unpolarized light passes an analyser; the exposure makes up for it, as a camera's would.
            exposure=0.85 if self.analyser_deg is None else 1.7,
        )

    def angle_deg(self, index: int, frames: int) -> float:
        """Return the stage angle of a frame; 360° itself is not repeated."""
        return self.first_angle_deg + 360.0 * index / frames

    def facts(self, staged: StagedScene) -> dict[str, Any]:
        """Return what repeats the geometry by hand, for the manifest."""
        body = staged.specimen.body
        indices = [float(n) for n in staged.specimen.indices(SODIUM_D_NM)]
        facts: dict[str, Any] = {
            "mineral": self.mineral,
            "data_quality": {
                "dispersion": dispersion_quality(staged.specimen.mineral),
                "colour": colour_quality(staged.specimen.mineral),
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
