"""One level of a picture's sampling: its passes over a set of pixels."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics import Coherency, transverse_frame
from crystal_core.optics.arrays import columns, dot
from crystal_core.render.anisotropic_events import AnisotropicEvents
from crystal_core.render.illumination import Illumination
from crystal_core.render.isotropic_events import IsotropicEvents
from crystal_core.render.rays import BATCH
from crystal_core.render.sampling import passes
from crystal_core.render.surroundings import Surroundings
from crystal_core.render.tracer import Arrivals, Events, Roulette, Stopwatch, Tracer
from crystal_core.scene import StagedScene, StagedSpecimen

__all__ = ["Level", "Seen"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Seen:
    """What the passes of a level saw.

    Parameters
    ----------
    total : Real
        Sums of linear sRGB over the passes, shape (3, N).
    error : Real
        Estimated standard error of a pixel's mean over the passes, shape (N,).
    edge : NDArray
        Where positions of a pixel met different faces, shape (N,).
    events : int
        Rays that met a face of the specimen.
    """

    total: Real
    error: Real
    edge: NDArray[np.bool_]
    events: int


class Level:
    """The passes of one level over a set of pixels, traced together so that batches stay full."""

    def __init__(
        self,
        scene: StagedScene,
        illumination: Illumination,
        size: tuple[int, int],
        side: int,
        wavelengths: int,
        seed: int,
        watch: Stopwatch,
    ) -> None:
        self._scene = scene
        self._size = size
        self._samples = passes(side, wavelengths, seed)
        self._watch = watch
        self._wavelength_nm = np.concatenate([sample.wavelengths.wavelength_nm for sample in self._samples])
        footprint_mm = _pixel_on_page_mm(scene, size) / side
        weights = np.concatenate([sample.wavelengths.weights for sample in self._samples]) / len(self._samples)
        self._surroundings = Surroundings(scene, illumination, self._wavelength_nm, weights, footprint_mm)

    def render(self, across: Real, down: Real, roulette: Roulette) -> Seen:
        """Return what the passes see in the pixels of columns `across` and rows `down`, shape (N,).

        The roulette's threshold is for pixels of importance 1; behind an analyser theirs is a half.
        """
        if self._scene.camera.analyser is not None:
            roulette = replace(roulette, below=0.5 * roulette.below)
        colours = self._wavelength_nm.size
        tracer = Tracer(
            _events(self._scene.specimen, self._wavelength_nm),
            self._surroundings,
            colours,
            across.size * colours,
            roulette,
            self._watch,
        )
        direct, through = np.zeros((2, 3, across.size)), np.zeros((2, 3, across.size))
        faces = np.empty((len(self._samples), across.size), np.int32)
        first = 0
        for number, sample in enumerate(self._samples):
            self._watch.restart()
            direction = _directions(self._scene, self._size, *sample.positions(across, down))
            importance = _importance(self._scene, direction)
            eye = self._scene.camera.eye[:, None]
            face = faces[number]
            face[:] = self._scene.specimen.finder.first_face(np.broadcast_to(eye, direction.shape), direction)
            self._watch.stop("camera")
            missed = np.flatnonzero(face < 0)
            # A ray that meets no crystal sees all wavelengths along one path.
            direct[sample.half][:, missed] += importance.intensity()[missed] * self._surroundings.linear_srgb(
                np.broadcast_to(eye, (3, missed.size)), columns(direction, missed)
            )
            self._watch.stop("page")
            met = np.flatnonzero(face >= 0)
            count = sample.wavelengths.wavelength_nm.size
            step = max(1, BATCH // count)
            for start in range(0, met.size, step):
                pixels = met[start : start + step]
                tracer.arrive(self._arrivals(pixels, direction, face, importance, first, count))
            first += count
        radiance = tracer.finish().reshape(across.size, colours)
        self._watch.restart()
        white = np.zeros((2, 3))
        first = 0
        for sample in self._samples:
            for weights in sample.wavelengths.weights:
                white[sample.half] += weights
                for channel in range(3):
                    through[sample.half][channel] += weights[channel] * radiance[:, first]
                first += 1
        # Each half has its own wavelengths, whose weights alone do not add up to white: level that before comparing.
        positions = 0.5 * len(self._samples)
        means = direct / positions + through / white[:, :, None]
        error = np.sqrt(np.mean((0.5 * (means[0] - means[1])) ** 2, axis=0))
        total = direct[0] + direct[1] + through[0] + through[1]
        return Seen(total, error, np.any(faces != faces[0], axis=0), tracer.events_done)

    def _arrivals(
        self, pixels: Index, direction: Real, face: NDArray[np.int32], importance: Coherency, first: int, count: int
    ) -> Arrivals:
        """Return the rays of some pixels at the faces they meet, one for each of a pass's wavelengths."""
        body, eye = self._scene.specimen.body, self._scene.camera.eye[:, None]
        at = face[pixels].astype(np.intp)
        normal = columns(body.normals.T, at)
        ahead = columns(direction, pixels)
        distance = (body.offsets[at] - dot(eye, normal)) / dot(ahead, normal)
        colour = np.tile(np.arange(first, first + count), pixels.size)
        ray = np.repeat(pixels, count)
        return Arrivals(
            np.repeat(eye + distance * ahead, count, axis=1),
            columns(direction, ray),
            face[ray].astype(np.intp),
            importance.take(ray),
            ray * self._wavelength_nm.size + colour,
            colour,
        )


def _pixel_on_page_mm(scene: StagedScene, size: tuple[int, int]) -> float:
    """Return the side of a pixel's square on the page at the centre of the picture, measured across the line of sight.

    The same for all rays: plane faces keep angles, and where the true footprint is wider (a slanted page, a long way
    inside), the narrower one costs noise, never sharpness.
    """
    camera = scene.camera
    reach = camera.eye[2] / max(-camera.forward[2], 0.05)
    return float(reach * 2.0 * camera.tan_half / size[1])


def _directions(scene: StagedScene, size: tuple[int, int], x: Real, y: Real) -> Real:
    """Return unit directions through points of the picture, in pixels from its top left corner, shape (3, N)."""
    camera = scene.camera
    width, height = size
    across = camera.tan_half * (2.0 * x / width - 1.0) * (width / height)
    upward = camera.tan_half * (1.0 - 2.0 * y / height)
    direction = camera.forward[:, None] + camera.right[:, None] * across + camera.up[:, None] * upward
    return np.asarray(direction / np.sqrt(dot(direction, direction)), np.float64)


def _importance(scene: StagedScene, direction: Real) -> Coherency:
    """Return what the camera measures, per unit of unpolarized radiance: trace 1, or ½ behind an analyser."""
    if scene.camera.analyser is None:
        return Coherency.unpolarized(np.ones(direction.shape[1]))
    axis = scene.camera.analyser[:, None]
    along = axis - dot(axis, direction) * direction
    along = along / np.sqrt(dot(along, along))
    x, y = transverse_frame(direction)
    return Coherency.pure(dot(along, x), dot(along, y), np.full(direction.shape[1], 0.5))


def _events(specimen: StagedSpecimen, wavelength_nm: Real) -> Events:
    medium = specimen.medium(wavelength_nm)
    return IsotropicEvents(specimen, medium) if medium.is_isotropic else AnisotropicEvents(specimen, medium)
