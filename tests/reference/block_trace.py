"""Exact trace of the doubled picture of a mark under a crystal block, written apart from any renderer.

A mark on the page is seen through a block with horizontal faces: from the pixel a ray enters the top face, goes along
the ray of one mode, leaves through the bottom face, crosses the air gap and meets the page. The pixel where that page
point is the mark is where the mark's image by that mode stands. Everything is followed from the camera down, against
the light, which is exact: the index surface is centrosymmetric, so the mode with (-k, -ray) solves the same problem.

Closed forms of a uniaxial crystal (n_o, n_e, unit optic axis c), from k x (k x E) = -eps E:

* Ordinary: E perpendicular to c and k, so eps E = n_o^2 E, |k| = n_o, and the energy goes along k.
* Extraordinary: eps E lies in the plane of k and c, perpendicular to k. Projecting the wave equation on it gives
      F(k) = (k.c)^2 / n_o^2 + (|k|^2 - (k.c)^2) / n_e^2 = 1,
  and energy flows along the normal of that surface, grad F / 2 = (k.c) c / n_o^2 + (k - (k.c) c) / n_e^2.
  The field follows from the displacement: D ~ c - k (k.c)/|k|^2, E = eps^-1 D.

With k = t + q n (t tangential, n the unit normal) F is a quadratic in q, A q^2 + 2 B q + C = 0:
      A = n.M n, B = n.M t, C = t.M t - 1, M = 1/n_e^2 + (1/n_o^2 - 1/n_e^2) c c^T,
and since grad F . n / 2 = A q + B = +-sqrt(B^2 - A C), the sign of the root is the side the energy goes to.

World: page in the plane z = page_z, z towards the camera. Pixel coordinates: (0, 0) is the top left corner of the top
left pixel, x to the right, y down, so that the centre of pixel (i, j) is (i + 0.5, j + 0.5).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tests.reference.berreman import scatter_reference, tensor_uniaxial

__all__ = [
    "MODES",
    "Block",
    "Camera",
    "Image",
    "ModeName",
    "Rule",
    "Trace",
    "analyser_angles",
    "analyser_share",
    "find_image",
    "light_field",
    "mean_image",
    "trace_down",
    "uniaxial_wave",
    "visible_weights",
]

Vector = NDArray[np.float64]
ModeName = Literal["ordinary", "extraordinary"]
Rule = Literal["exact", "along k", "refract ray"]
MODES: tuple[ModeName, ModeName] = ("ordinary", "extraordinary")
UP: Vector = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Camera:
    """Pinhole of a manifest: eye (3,) mm, forward, right, up unit vectors (3,), tan(vfov/2), size (W, H) in pixels."""

    eye: Vector
    forward: Vector
    right: Vector
    up: Vector
    scale: float
    size: tuple[int, int]

    @classmethod
    def of(cls, manifest: Mapping[str, Any]) -> Camera:
        """Return the camera that a manifest describes."""
        camera = manifest["camera"]
        eye, target, up = (np.array(camera[key], dtype=float) for key in ("eye_mm", "target_mm", "up"))
        forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(forward, up)
        right /= np.linalg.norm(right)
        width, height = manifest["size"]
        scale = float(np.tan(np.radians(camera["vfov_deg"]) / 2))
        return cls(eye, forward, right, np.cross(right, forward), scale, (int(width), int(height)))

    def direction(self, pixel: Vector) -> Vector:
        """Return the unit vector from the eye through pixel coordinates (2,)."""
        width, height = self.size
        x = (2 * pixel[0] / width - 1) * width / height
        y = 1 - 2 * pixel[1] / height
        d = self.forward + self.scale * (x * self.right + y * self.up)
        return np.asarray(d / np.linalg.norm(d))

    def pixel(self, point: Vector) -> Vector:
        """Return the pixel coordinates (2,) of a point (3,) seen through air alone."""
        width, height = self.size
        d = point - self.eye
        x, y = np.array([d @ self.right, d @ self.up]) / (d @ self.forward) / self.scale
        return np.array([(x * height / width + 1) * width / 2, (1 - y) * height / 2])


@dataclass(frozen=True)
class Block:
    """The block of a manifest turned by an angle; lengths in mm, optic axis (3,) in the world."""

    half_size: Vector
    z0: float
    z1: float
    page_z: float
    axis: Vector
    angle_deg: float

    @classmethod
    def of(cls, manifest: Mapping[str, Any], angle_deg: float) -> Block:
        """Return the block of a manifest, its lattice turned counter-clockwise about +z by angle_deg."""
        scene = manifest["scene"]
        if scene["cut"] != "block":
            raise ValueError(f"this trace knows horizontal faces only, not the cut {scene['cut']!r}")
        axis = np.array(scene["optic_axis"], dtype=float)
        axis = _turn(axis / np.linalg.norm(axis), angle_deg)
        half = np.array(scene["half_size_mm"], dtype=float)
        return cls(half, float(scene["z0_mm"]), float(scene["z1_mm"]), float(scene["page_z_mm"]), axis, angle_deg)

    def covers(self, point: Vector) -> bool:
        """Whether a point (3,) lies over the block's rectangle."""
        local = _turn(point, -self.angle_deg)
        return bool(np.all(np.abs(local[:2]) < self.half_size))


def _turn(v: Vector, angle_deg: float) -> Vector:
    """Return v turned counter-clockwise about +z."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    return np.array([c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]])


def _unit(v: Vector) -> Vector:
    size = float(np.linalg.norm(v))
    if size < 1e-12:
        raise ValueError("a wave along the optic axis has no modes of its own")
    return np.asarray(v / size)


def uniaxial_wave(
    mode: ModeName, n_o: float, n_e: float, axis: Vector, normal: Vector, tangential: Vector
) -> tuple[Vector, Vector, Vector]:
    """Return k, unit ray and unit E, each (3,), of the mode whose energy goes along +normal (unit).

    Raises
    ------
    ValueError
        If that wave is evanescent, or goes along the optic axis, where the modes have no fields of their own.
    """
    if mode == "ordinary":
        square = n_o**2 - tangential @ tangential
        if square <= 0:
            raise ValueError("the ordinary wave is evanescent")
        k = tangential + np.sqrt(square) * normal
        return k, k / n_o, _unit(np.cross(k, axis))
    m = np.eye(3) / n_e**2 + (1 / n_o**2 - 1 / n_e**2) * np.outer(axis, axis)
    a, b, c = normal @ m @ normal, normal @ m @ tangential, tangential @ m @ tangential - 1
    square = b * b - a * c
    if square <= 0:
        raise ValueError("the extraordinary wave is evanescent")
    k = tangential + (np.sqrt(square) - b) / a * normal
    inverse = np.eye(3) / n_o**2 + (1 / n_e**2 - 1 / n_o**2) * np.outer(axis, axis)
    return k, _unit(m @ k), _unit(inverse @ (axis - k * (k @ axis) / (k @ k)))


@dataclass(frozen=True)
class Trace:
    """A path from the camera down: direction in air (3,), the wave in the block, points (3,) mm, and validity.

    ``inside`` says that the path really enters by the top face and leaves by the bottom face.
    """

    direction: Vector
    k: Vector
    ray: Vector
    top: Vector
    bottom: Vector
    page: Vector
    inside: bool


def _to_plane(point: Vector, direction: Vector, z: float) -> Vector:
    return np.asarray(point + (z - point[2]) / direction[2] * direction)


def trace_down(
    camera: Camera, block: Block, mode: ModeName, n_o: float, n_e: float, pixel: Vector, rule: Rule = "exact"
) -> Trace:
    """Follow pixel coordinates (2,) through the block by one mode to the page.

    ``rule`` other than "exact" gives a deliberately wrong path, to show what a measurement would catch: "along k" moves
    in the block along the wave normal; "refract ray" applies Snell's law with |k| to the ray, in the plane of ray and
    normal, where it leaves the block.
    """
    direction = camera.direction(pixel)
    if direction[2] >= 0:
        raise ValueError(f"pixel {pixel} looks above the horizon")
    top = _to_plane(camera.eye, direction, block.z1)
    # air has index 1, so its wave vector is the direction, and its tangential part is the same in the crystal
    k, ray, _ = uniaxial_wave(mode, n_o, n_e, block.axis, -UP, direction - (direction @ UP) * UP)
    if rule == "along k":
        ray = k / np.linalg.norm(k)
    bottom = _to_plane(top, ray, block.z0)
    tangential = k - (k @ UP) * UP
    if rule == "refract ray":
        tangential = np.linalg.norm(k) * (ray - (ray @ UP) * UP)
    air = tangential - np.sqrt(1 - tangential @ tangential) * UP
    page = _to_plane(bottom, air, block.page_z)
    return Trace(direction, k, ray, top, bottom, page, block.covers(top) and block.covers(bottom))


@dataclass(frozen=True)
class Image:
    """Where one image of a mark stands: pixel coordinates (2,) and the path that shows it."""

    pixel: Vector
    trace: Trace


def find_image(
    manifest: Mapping[str, Any],
    mark: Sequence[float],
    mode: ModeName,
    angle_deg: float,
    n_o: float,
    n_e: float,
    rule: Rule = "exact",
) -> Image:
    """Return the image of a mark (x, y) mm by one mode, with the block turned by angle_deg.

    Raises
    ------
    ArithmeticError
        If Newton's iteration does not bring the page point within 1e-9 mm of the mark.
    """
    camera, block = Camera.of(manifest), Block.of(manifest, angle_deg)
    target = np.array([mark[0], mark[1]], dtype=float)

    def page(pixel: Vector) -> Vector:
        return trace_down(camera, block, mode, n_o, n_e, pixel, rule).page[:2]

    pixel = camera.pixel(np.array([target[0], target[1], block.page_z]))
    step = 1e-3
    for _ in range(30):
        miss = page(pixel) - target
        if np.linalg.norm(miss) < 1e-9:
            return Image(pixel, trace_down(camera, block, mode, n_o, n_e, pixel, rule))
        columns = [(page(pixel + h) - page(pixel - h)) / (2 * step) for h in step * np.eye(2)]
        pixel = pixel - np.linalg.solve(np.array(columns).T, miss)
    raise ArithmeticError(f"the image of mark {mark} was not found; {miss} mm are left")


def visible_weights(wavelength_nm: Vector) -> Vector:
    """Return weights, sum 1, proportional to D65 times the CIE 1931 luminous efficiency.

    D65 from CIE 15 at every 20 nm, linear between; ybar by the fit of C. Wyman, P.-P. Sloan, P. Shirley, J. Computer
    Graphics Techniques 2(2), 1 (2013), eq. (4): its mean wavelength is right within 0.5 nm, more than is needed here.
    """
    d65 = [49.98, 82.75, 93.43, 104.86, 117.81, 115.92, 109.35, 104.79, 104.41, 100.0, 95.79]
    d65 += [90.01, 87.70, 83.70, 80.21, 78.28, 71.61, 61.60]
    nm = np.asarray(wavelength_nm, dtype=float)

    def lobe(centre: float, left: float, right: float) -> Vector:
        return np.asarray(np.exp(-0.5 * ((nm - centre) * np.where(nm < centre, left, right)) ** 2))

    y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322)
    weights = y * np.interp(nm, np.arange(380.0, 721.0, 20.0), d65)
    return np.asarray(weights / weights.sum())


def mean_image(
    manifest: Mapping[str, Any],
    mark: Sequence[float],
    mode: ModeName,
    angle_deg: float,
    indices: Callable[[Vector], tuple[Vector, Vector]],
    rule: Rule = "exact",
) -> Vector:
    """Return the luminance-weighted mean pixel (2,) of an image; indices(nm) gives (n_o, n_e)."""
    nm = np.linspace(430.0, 690.0, 14)
    weights = visible_weights(nm)
    n_o, n_e = indices(nm)
    total = np.zeros(2)
    for weight, o, e in zip(weights, n_o, n_e, strict=True):
        total += weight * find_image(manifest, mark, mode, angle_deg, float(o), float(e), rule).pixel
    return total


def light_field(
    manifest: Mapping[str, Any], mark: Sequence[float], mode: ModeName, angle_deg: float, n_o: float, n_e: float
) -> tuple[Vector, Vector]:
    """Return the direction (3,), away from the eye, and the unit field E (3,) of the light that shows one image.

    That light comes up the path of the image as one mode and leaves the top face linearly polarized.
    """
    block = Block.of(manifest, angle_deg)
    down = find_image(manifest, mark, mode, angle_deg, n_o, n_e).trace.direction
    tensor = tensor_uniaxial(n_o, n_e, block.axis)
    result = scatter_reference(UP, -(down - (down @ UP) * UP), tensor, np.eye(3), source_axis=block.axis)
    field = sum(result.transmitted[i, MODES.index(mode)] * wave.e for i, wave in enumerate(result.forward))
    field = field * np.conj(field[int(np.argmax(np.abs(field)))])
    if np.linalg.norm(field.imag) > 1e-9 * np.linalg.norm(field.real):
        raise ArithmeticError("the light of one mode left the block elliptically polarized")
    return down, _unit(field.real)


def analyser_share(camera: Camera, direction: Vector, field: Vector, analyser_deg: float) -> float:
    """Return the share of light with this direction and unit field that an analyser before the camera passes.

    The analyser at angle a (from the picture's +x, counter-clockwise as seen) passes the field along
    t = (d - (d.k) k), normalised, with d = cos(a) right + sin(a) up of the camera and k the light's direction.
    """
    a = np.radians(analyser_deg)
    d = np.cos(a) * camera.right + np.sin(a) * camera.up
    return float(_unit(d - (d @ direction) * direction) @ field) ** 2


def analyser_angles(
    manifest: Mapping[str, Any], mark: Sequence[float], angle_deg: float, n_o: float, n_e: float
) -> tuple[float, float]:
    """Return the analyser angles in [0, 180) that put out the ordinary and the extraordinary image of a mark.

    With t as in `analyser_share` and E.k = 0, nothing passes when cos(a) right.E + sin(a) up.E = 0.
    """
    camera = Camera.of(manifest)
    angles = []
    for mode in MODES:
        _, field = light_field(manifest, mark, mode, angle_deg, n_o, n_e)
        angles.append(float(np.degrees(np.arctan2(-camera.right @ field, camera.up @ field)) % 180.0))
    return angles[0], angles[1]
