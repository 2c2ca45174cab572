"""What a scene is made of: one crystal specimen over a printed page, a point light, a sky, a camera.

Lengths in mm, angles in degrees, world frame: the page lies in z = 0, x right, y up, z towards the viewer.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

__all__ = ["AnalyserAngle", "Camera", "Page", "PointLight", "Scene", "Shape", "Sky", "Specimen"]

Length = Annotated[float, Field(gt=0, le=1e4, allow_inf_nan=False)]
Coordinate = Annotated[float, Field(ge=-1e4, le=1e4, allow_inf_nan=False)]
Angle = Annotated[float, Field(ge=-360, le=360, allow_inf_nan=False)]
AnalyserAngle = Annotated[float, Field(ge=0, le=180, allow_inf_nan=False)]
Point = tuple[Coordinate, Coordinate, Coordinate]


class Part(BaseModel):
    """Base of the parts of a scene: immutable, unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Shape(Part):
    """The specimen's body.

    A block is sawn: `size_mm` are its edges, and the optic axis stands where it is told to. A cleavage rhombohedron
    lies on one of its faces: `size_mm` are the distances between its three pairs of faces, the last one horizontal,
    and the tilt of the optic axis follows from the mineral's cell.
    """

    cut: Literal["block", "cleavage"] = "block"
    size_mm: tuple[Length, Length, Length] = (20.0, 20.0, 12.0)
    axis_tilt_deg: Annotated[float, Field(ge=0, le=180)] = 44.64
    axis_azimuth_deg: Angle = 0.0


class Specimen(Part):
    """A crystal with a size and an orientation, centred over the origin."""

    mineral: str = "calcite"
    shape: Shape = Shape()
    gap_mm: Annotated[float, Field(gt=0, le=1000)] = 0.02


class Page(Part):
    """A printed sheet in z = 0, centred on the origin, on a matte grey table without end."""

    texture: Annotated[str, Field(pattern=r"^(digits|asset:[0-9a-f]{64})$")] = "digits"
    width_mm: Length = 64.0
    marks_mm: tuple[tuple[Coordinate, Coordinate], ...] = ()
    mark_diameter_mm: Length = 0.4
    table_reflectance: Annotated[float, Field(ge=0, le=1)] = 0.25


class PointLight(Part):
    """A point source of daylight (D65), unpolarized, the same in all directions."""

    position_mm: Point = (-90.0, 130.0, 380.0)


class Sky(Part):
    """Unpolarized daylight (D65) of equal radiance from everywhere.

    `fraction` is its share of the illuminance at the centre of the page with no specimen on it; the light has the rest.
    """

    fraction: Annotated[float, Field(ge=0, le=1)] = 0.3


class Camera(Part):
    """A pinhole with a perspective picture; the analyser in front of it passes the field along one direction.

    `analyser_deg` is the angle of that direction d from the picture's +x, counter-clockwise as seen in the picture;
    for a ray that is not the central one the transmitted direction is d made transverse to the ray.
    """

    eye_mm: Point
    target_mm: Point
    up: Point
    vfov_deg: Annotated[float, Field(ge=0.01, le=120)]
    analyser_deg: AnalyserAngle | None = None


class Scene(Part):
    """All of it. `exposure` is the linear value of a white diffuser at the centre of the bare page."""

    specimen: Specimen
    page: Page = Page()
    light: PointLight = PointLight()
    sky: Sky = Sky()
    camera: Camera
    exposure: Annotated[float, Field(gt=0, le=100)] = 0.85
