"""The examples of the documentation are scenes, each of them, and say what they promise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from crystal_core.scene import SceneFiles, parse_scene, read_scene, stage_scene
from crystal_core.scene.staged import StagedDocument

FOLDER = Path(__file__).parents[2] / "docs" / "scenes"
EXAMPLES = sorted(FOLDER.glob("*.yaml"))


def example(name: str) -> StagedDocument:
    return stage_scene(read_scene(FOLDER / f"{name}.yaml"), SceneFiles(folder=FOLDER))


def test_there_are_enough_of_them() -> None:
    assert len(EXAMPLES) >= 10


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_it_is_a_scene_in_all_its_frames(path: Path) -> None:
    scene = read_scene(path)
    assert scene.title
    staged = stage_scene(scene, SceneFiles(folder=FOLDER))
    assert staged.at(staged.frames - 1).frame == staged.frames - 1
    assert parse_scene(yaml.safe_load(scene.to_yaml()), paths=True) == scene


def test_calcite_over_a_page_is_ten_lines() -> None:
    lines = (FOLDER / "calcite-over-page.yaml").read_text().splitlines()
    assert len(lines) <= 10


def test_the_oil_has_the_ordinary_index_of_calcite() -> None:
    media = example("calcite-in-oil").media
    oil, calcite = (medium.at([589.3]).indices[0][0] for medium in media[1:])
    assert oil == pytest.approx(calcite, abs=5e-4)


def test_the_gypsum_plate_has_one_wavelength_of_retardation() -> None:
    (gypsum,) = [sheet for sheet in example("gypsum-plate").sheets if sheet.medium is not None]
    assert gypsum.medium is not None
    assert gypsum.sheet.plate is not None
    medium = gypsum.medium.at([550.0])
    axes = np.asarray(medium.axes).reshape(3, 3, -1)[:, :, 0]
    permittivity = (axes.T * np.array([n[0] for n in medium.indices]) ** 2) @ axes
    turn = gypsum.plane.frame[:, :2]
    slow, fast = np.linalg.eigvalsh(turn.T @ np.linalg.inv(permittivity) @ turn) ** -0.5
    assert gypsum.sheet.plate.thickness_um * 1e3 * (slow - fast) == pytest.approx(550, abs=25)


def test_the_beam_meets_the_prism_and_then_the_screen() -> None:
    staged = example("prism")
    (prism,), (screen,), beam = staged.bodies, staged.surfaces, staged.lights[0]
    assert beam.plane is not None
    start, ahead = beam.plane.centre[:, None], beam.plane.normal[:, None]
    body = prism.solid.body
    enters, leaves, entry, _ = body.span(start, ahead)
    assert enters[0] < leaves[0]
    assert prism.solid.labels[entry[0]] == "left"
    landed = []
    for wavelength in (400.0, 700.0):
        n = float(staged.media[prism.medium].at([wavelength]).indices[0][0])
        inside = refracted(beam.plane.normal, body.normals[entry[0]], 1.0 / n)
        point = (start + enters * ahead)[:, 0]
        distance, face = body.exit(point[:, None], inside[:, None])
        assert prism.solid.labels[face[0]] == "right"
        point = point + distance[0] * inside
        out = refracted(inside, -body.normals[face[0]], n)
        reach = (screen.plane.centre - point) @ screen.plane.normal / (out @ screen.plane.normal)
        assert reach > 0
        assert screen.plane.covers(point + reach * out)
        landed.append(point + reach * out)
    assert np.linalg.norm(landed[0] - landed[1]) > 5  # a spectrum that can be seen


def refracted(direction: np.ndarray, normal: np.ndarray, ratio: float) -> np.ndarray:
    """Return the direction after Snell's law; the normal points against it."""
    cos = -direction @ normal
    return ratio * direction + (ratio * cos - np.sqrt(1 - ratio**2 * (1 - cos**2))) * normal


def test_the_beam_goes_along_an_optic_axis() -> None:
    staged = example("conical-refraction")
    medium = staged.media[1].at([532.0])
    axes = np.asarray(medium.axes).reshape(3, 3, -1)[:, :, 0]
    inverse = (axes.T * np.array([n[0] for n in medium.indices]) ** -2.0) @ axes
    split = np.linalg.eigvalsh(inverse[:2, :2]) ** -0.5
    assert split[0] - split[1] < 2e-4  # the axis is that of 589 nm
