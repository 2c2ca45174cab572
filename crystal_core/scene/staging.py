"""A scene description turned into the arrays that the renderer works on; what frames share is staged once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

import minerals_db
from crystal_core.errors import InputError
from crystal_core.geometry import ConvexPolyhedron, FaceFinder, block, face_finder, rhombohedron
from crystal_core.geometry.cuts import rotation_about_z
from crystal_core.geometry.lattice import direct_basis, face_normal
from crystal_core.materials import medium, principal_indices
from crystal_core.optics import Medium
from crystal_core.scene.description import Camera, Page, Scene, Shape
from crystal_core.scene.prints import decoded_print, with_marks
from crystal_core.scene.texture import Texture, read_asset

__all__ = [
    "StagedCamera",
    "StagedPage",
    "StagedScene",
    "StagedSpecimen",
    "cleavage_pole_deg",
    "stage",
]

Real = NDArray[np.float64]


@dataclass(frozen=True)
class StagedSpecimen:
    """The crystal in the world at one stage angle.

    Parameters
    ----------
    mineral : minerals_db.Mineral
        Its entry.
    body : ConvexPolyhedron
        In the world, mm.
    finder : FaceFinder
        First face on a ray from outside.
    rotation : Real
        R of v_world = R v_crystal, shape (3, 3).
    """

    mineral: minerals_db.Mineral
    body: ConvexPolyhedron
    finder: FaceFinder
    rotation: Real

    @property
    def axis(self) -> Real:
        """The direction of c*, the optic axis of a uniaxial crystal, shape (3,)."""
        return self.rotation[:, 2]

    def indices(self, wavelength_nm: ArrayLike) -> tuple[Real, ...]:
        """Return the principal indices at the wavelengths: in the order of `materials.principal_indices`."""
        return principal_indices(self.mineral, wavelength_nm)

    def medium(self, wavelength_nm: ArrayLike) -> Medium:
        """Return the crystal's medium at the wavelengths, absorption included; optical activity is left out."""
        return medium(self.mineral, wavelength_nm, self.rotation).inactive()


@dataclass(frozen=True)
class StagedPage:
    """The printed sheet: its texture and the table around it."""

    texture: Texture
    table_reflectance: float


@dataclass(frozen=True)
class StagedCamera:
    """Pinhole at `eye` with unit vectors forward, right, up and tan(vfov/2); `analyser` a unit vector or None."""

    eye: Real
    forward: Real
    right: Real
    up: Real
    tan_half: float
    analyser: Real | None


@dataclass(frozen=True)
class StagedScene:
    """Everything one frame needs."""

    specimen: StagedSpecimen
    page: StagedPage
    light_mm: Real
    sky_fraction: float
    camera: StagedCamera
    exposure: float

    def turned(self, angle_deg: float) -> StagedScene:
        """Return the scene with the specimen (body, lattice and indicatrix) turned counter-clockwise about +z."""
        rotation = rotation_about_z(angle_deg)
        body = self.specimen.body.transformed(rotation, np.zeros(3))
        specimen = replace(
            self.specimen, body=body, finder=face_finder(body), rotation=rotation @ self.specimen.rotation
        )
        return replace(self, specimen=specimen)


def stage(scene: Scene, assets: Path | None = None) -> StagedScene:
    """Return the scene as arrays, the specimen at stage angle 0.

    Parameters
    ----------
    scene : Scene
        The description.
    assets : Path, optional
        Folder of uploaded files, named by their sha256.

    Raises
    ------
    InputError
        Unknown mineral or asset, a cut that the mineral does not have, a camera or a light inside the specimen.
    """
    specimen = _specimen(scene)
    camera = _camera(scene.camera)
    light = np.asarray(scene.light.position_mm)
    if camera.eye[2] <= 0:
        raise InputError.at("/camera/eye_mm", "the camera must stand above the page (z > 0)")
    if np.all(specimen.body.normals @ camera.eye <= specimen.body.offsets):
        raise InputError.at("/camera/eye_mm", "the camera stands inside the specimen")
    if light[2] <= specimen.body.vertices[:, 2].max():
        raise InputError.at("/light/position_mm", "the light must stand higher than the specimen")
    return StagedScene(specimen, _page(scene.page, assets), light, scene.sky.fraction, camera, scene.exposure)


def cleavage_pole_deg(mineral: minerals_db.Mineral) -> float:
    """Return the angle between the c axis and the poles of the mineral's rhombohedral cleavage.

    Raises
    ------
    InputError
        The mineral is not trigonal or has no such cleavage.
    """
    # A poor cleavage gives no rhombohedron, as every hammer finds with quartz.
    good = [c.hkl for c in mineral.cleavage if c.quality in ("perfect", "good")]
    forms = [hkl for hkl in good if hkl[1] == 0 and hkl[0] != 0 and hkl[2] != 0]
    if mineral.system != "trigonal" or mineral.cell is None or not forms:
        raise InputError.at(
            "/specimen/shape/cut", f"{mineral.id} does not cleave into a rhombohedron; cut it as a block"
        )
    cell = mineral.cell
    basis = direct_basis(
        (cell.a_angstrom, cell.b_angstrom, cell.c_angstrom), (cell.alpha_deg, cell.beta_deg, cell.gamma_deg)
    )
    return float(np.rad2deg(np.arccos(abs(face_normal(basis, forms[0])[2]))))


def _specimen(scene: Scene) -> StagedSpecimen:
    wanted = scene.specimen.mineral
    known = minerals_db.minerals()
    if wanted not in known:
        raise InputError.at("/specimen/mineral", str(minerals_db.UnknownMineralError(wanted, known)))
    mineral = known[wanted]
    body, rotation = _body(scene.specimen.shape, mineral)
    lowest = float(body.vertices[:, 2].min())
    body = body.transformed(np.eye(3), np.array((0.0, 0.0, scene.specimen.gap_mm - lowest)))
    return StagedSpecimen(mineral, body, face_finder(body), rotation)


def _body(shape: Shape, mineral: minerals_db.Mineral) -> tuple[ConvexPolyhedron, Real]:
    if shape.cut == "cleavage":
        return rhombohedron(cleavage_pole_deg(mineral), shape.size_mm, shape.axis_azimuth_deg)
    tilt = np.deg2rad(shape.axis_tilt_deg)
    lean = np.array(((np.cos(tilt), 0.0, np.sin(tilt)), (0.0, 1.0, 0.0), (-np.sin(tilt), 0.0, np.cos(tilt))))
    return block(shape.size_mm), rotation_about_z(shape.axis_azimuth_deg) @ lean


def _page(page: Page, assets: Path | None) -> StagedPage:
    data = None if page.texture == "digits" else read_asset(assets, page.texture, "/page/texture")
    texture = Texture(decoded_print(data, "/page/texture"), page.width_mm)
    if page.marks_mm:
        texture = with_marks(texture, page.marks_mm, page.mark_diameter_mm, "/page")
    return StagedPage(texture, page.table_reflectance)


def _camera(camera: Camera) -> StagedCamera:
    eye, target, up = (np.asarray(v, np.float64) for v in (camera.eye_mm, camera.target_mm, camera.up))
    forward = target - eye
    right = np.cross(forward, up)
    if np.linalg.norm(right) <= 1e-9 * np.linalg.norm(forward) * np.linalg.norm(up):
        raise InputError.at("/camera/up", "up must not be parallel to the line of sight, nor eye and target coincide")
    forward = forward / np.linalg.norm(forward)
    right = right / np.linalg.norm(right)
    upright = np.cross(right, forward)
    analyser = None
    if camera.analyser_deg is not None:
        angle = np.deg2rad(camera.analyser_deg)
        analyser = np.cos(angle) * right + np.sin(angle) * upright
    return StagedCamera(eye, forward, right, upright, float(np.tan(0.5 * np.deg2rad(camera.vfov_deg))), analyser)
