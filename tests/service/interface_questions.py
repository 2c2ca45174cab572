"""Questions to the probe of an interface, drawn at random."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Real = NDArray[np.float64]

CALCITE = {
    "wavelength_nm": 589.3,
    "normal": [0, 0, 1],
    "wave_normal": [0.5, 0, 0.75**0.5],
    "from": {"indices": [1.0]},
    # Rows across the optic axis (√6/4, √2/4, √2/2): 45° from the normal, at azimuth 30°.
    "to": {
        "indices": [1.6584, 1.4864],
        "axes": [[6**0.5 / 4, 2**0.5 / 4, -(0.5**0.5)], [-0.5, 0.75**0.5, 0], [6**0.5 / 4, 2**0.5 / 4, 0.5**0.5]],
    },
}
"""The first question of most textbooks, with its answer in `tests.reference.test_golden_interface`."""


def turned(rng: np.random.Generator) -> Real:
    return np.asarray(Rotation.random(rng=rng).as_matrix(), np.float64)


def any_medium(rng: np.random.Generator, indices: int, absorbing: bool) -> dict[str, Any]:
    """Return a medium of one to three indices, of either handedness."""
    medium: dict[str, Any] = {"indices": rng.uniform(1.2, 2.6, indices).tolist()}
    if indices > 1:
        medium["axes"] = (turned(rng) * rng.choice((-1, 1))).tolist()
    if absorbing:
        medium["absorption_per_mm"] = [0.3] * 3 if indices == 1 else rng.uniform(0, 2, 3).tolist()
        medium["absorption_axes"] = turned(rng).tolist()
    return medium


def any_question(rng: np.random.Generator, source: int, target: int, absorbing: bool = False) -> dict[str, Any]:
    """Return a question whose tangential wave vector reaches up to the largest index of `from`."""
    normal = turned(rng)[0]
    question = {
        "wavelength_nm": rng.uniform(380, 780),
        "normal": normal.tolist(),
        "from": any_medium(rng, source, absorbing),
        "to": any_medium(rng, target, absorbing),
    }
    direction = turned(rng)[0]
    if source == 1:
        question["wave_normal"] = (direction * np.sign(direction @ normal)).tolist()
        return question
    sideways = direction - (direction @ normal) * normal
    k = sideways / np.linalg.norm(sideways) * rng.uniform(0, 0.999) * max(question["from"]["indices"])
    question["tangential_k"] = (k - (k @ normal) * normal).tolist()
    return question


def activated(rng: np.random.Generator, medium: dict[str, Any]) -> dict[str, Any]:
    """Return a medium with a gyration that its symmetry allows, on right-handed axes."""
    first, second, third = (rng.uniform(-1, 1, 3) * 10 ** rng.uniform(-5, -2)).tolist()
    gyration = {1: [first] * 3, 2: [first, first, second], 3: [first, second, third]}[len(medium["indices"])]
    return {**medium, "axes": turned(rng).tolist(), "gyration": gyration}
