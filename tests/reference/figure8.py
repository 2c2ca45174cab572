"""What the acceptance test of the rotating calcite needs: render a view, isolate one image, measure its marks."""

from __future__ import annotations

import functools
import hashlib
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image as Picture
from scipy import ndimage, optimize

import minerals_db
from crystal_core.sequence import RenderRequest, assemble, manifest, parse_request, render_tile, tile_grid
from tests.reference.block_trace import MODES, Camera, ModeName, Rule, analyser_angles, mean_image

__all__ = ["View", "calcite_indices", "luminance", "measure_marks", "white_page"]

Vector = NDArray[np.float64]


def white_page(folder: Path) -> str:
    """Write a plain white texture into an assets folder; return the value of the parameter `texture`.

    On a plain page the difference between a view with marks and one without is nothing but the marks, which are printed
    in the texture's own grain: 16 texels a mm on the default page, finer than any pixel of the test.
    """
    data = io.BytesIO()
    Picture.new("L", (1024, 1024), 255).save(data, "PNG")
    digest = hashlib.sha256(data.getvalue()).hexdigest()
    (folder / digest).write_bytes(data.getvalue())
    return f"asset:{digest}"


def calcite_indices(wavelength_nm: Vector) -> tuple[Vector, Vector]:
    """Return (n_o, n_e) of the database's calcite: the renderer's data, so that only the optics is under test."""
    dispersion = minerals_db.mineral("calcite").dispersion
    return dispersion["o"].index(wavelength_nm), dispersion["e"].index(wavelength_nm)


def luminance(linear: NDArray[Any]) -> Vector:
    """Return relative luminance (H, W) of linear sRGB (H, W, 3), IEC 61966-2-1."""
    return np.asarray(linear.astype(float) @ [0.2126, 0.7152, 0.0722])


def measure_marks(without: Vector, with_marks: Vector) -> list[Vector]:
    """Return the centroids, pixel coordinates (2,), of all dark marks, found without knowing where they should be.

    The weight of a pixel is the light the mark takes from it. A mark is a connected patch that takes at least a quarter
    of what the darkest place loses; around it two more pixels are counted, to take in its soft edge.
    """
    lost = without - with_marks
    labels, count = ndimage.label(lost > 0.25 * lost.max(), structure=np.ones((3, 3)))
    centres = []
    for patch in range(1, count + 1):
        window = ndimage.binary_dilation(labels == patch, iterations=2)
        rows, columns = np.nonzero(window)
        weight = lost[rows, columns]
        centres.append(np.array([columns + 0.5, rows + 0.5]) @ weight / weight.sum())
    return centres


@dataclass(frozen=True)
class View:
    """One stand of the stage under one camera; the exact trace and the rendered frames of it."""

    parameters: Mapping[str, Any]
    frames: int
    frame: int
    size: tuple[int, int]
    quality: str
    assets: Path

    def request(self, **parameters: Any) -> RenderRequest:
        """Return the request for this view, some parameters replaced."""
        return parse_request(
            {
                "demonstration": "rotating-calcite",
                "parameters": {**self.parameters, **parameters},
                "frames": self.frames,
                "size": list(self.size),
                "quality": self.quality,
                "seed": 7,
            },
            self.assets,
        )

    @functools.cached_property
    def manifest(self) -> dict[str, Any]:
        """Return the manifest: all that the trace knows of the scene."""
        return manifest(self.request(), [], complete=False)

    @property
    def angle_deg(self) -> float:
        """Return the angle of the stage, as the issue defines it."""
        return 360.0 * self.frame / self.frames

    @property
    def marks(self) -> list[Sequence[float]]:
        """Return the marks on the page, mm."""
        return list(self.parameters["marks"])

    def expected(self, mode: ModeName, rule: Rule = "exact") -> Vector:
        """Return where the trace puts each mark's image, (marks, 2) pixels."""
        scene = self.manifest
        return np.array([mean_image(scene, m, mode, self.angle_deg, calcite_indices, rule) for m in self.marks])

    def analyser_for(self, mode: ModeName) -> float:
        """Return the analyser angle that leaves this image of the marks by putting out the other.

        The angle differs from mark to mark; their mean serves while it is nearly the same for all.
        """
        n_o, n_e = (float(n[0]) for n in calcite_indices(np.array([557.0])))
        other = 1 - MODES.index(mode)
        angles = np.radians([analyser_angles(self.manifest, m, self.angle_deg, n_o, n_e)[other] for m in self.marks])
        mean = np.angle(np.exp(2j * angles).mean()) / 2
        spread = np.abs(np.angle(np.exp(2j * (angles - mean)))).max() / 2
        if spread > np.radians(5):
            raise ArithmeticError(f"no one analyser serves marks {np.degrees(spread):.1f} degrees apart")
        return float(np.degrees(mean) % 180.0)

    def render(self, **parameters: Any) -> Vector:
        """Return the luminance (H, W) of the frame, rendered tile by tile in this process."""
        request = self.request(**parameters)
        tiles = range(len(tile_grid(request)))
        results = [render_tile(request, self.frame, tile, self.assets) for tile in tiles]
        return luminance(assemble(request, results).linear)

    def measured(self, mode: ModeName) -> Vector:
        """Return where each mark's image by one mode stands in the rendered frame, in the order of the marks."""
        analyser = self.analyser_for(mode)
        centres = measure_marks(self.render(analyser_deg=analyser, marks=[]), self.render(analyser_deg=analyser))
        if len(centres) != len(self.marks):
            raise AssertionError(f"{len(centres)} {mode} images of {len(self.marks)} marks at {self.angle_deg} degrees")
        # an image is all but a shifted copy of the marks seen through air: match the two after shifting them together
        camera = Camera.of(self.manifest)
        seen = np.array([camera.pixel(np.array([x, y, 0.0])) for x, y in self.marks])
        found = np.array(centres)
        gaps = (seen - seen.mean(axis=0))[:, None, :] - (found - found.mean(axis=0))[None, :, :]
        return found[optimize.linear_sum_assignment(np.linalg.norm(gaps, axis=2))[1]]
