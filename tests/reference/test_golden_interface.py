"""The project's optics on published numbers: air to calcite, and the walk-off of calcite."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics import Medium, scatter

NORMAL = np.array([0.0, 0.0, 1.0])
N_O, N_E = 1.6584, 1.4864  # calcite, 589.3 nm
AIR = Medium.isotropic(1.0)


def table(powers: Any) -> NDArray[np.float64]:
    """Return power fractions [outgoing, incident] of the first ray."""
    return np.array([[powers[i][j][0] for j in range(2)] for i in range(2)])


def test_air_to_calcite() -> None:
    """k = (0.5, 0, 0.866), axis at 45 degrees, azimuth 30: confirmed by prtLab, pyrate, pyElli and GeneralTmm."""
    axis = np.array([np.cos(np.pi / 6), np.sin(np.pi / 6), 1.0]) / np.sqrt(2)
    result = scatter(NORMAL, np.array([[0.5], [0.0], [0.0]]), AIR, Medium.uniaxial(N_O, N_E, axis))
    ordinary, extraordinary = result.transmitted
    np.testing.assert_allclose(ordinary.k[:, 0], [0.5, 0, 1.581230710554], rtol=0, atol=1e-12)
    np.testing.assert_allclose(ordinary.ray[:, 0], [0.301495417, 0, 0.953467626], rtol=0, atol=1e-9)
    np.testing.assert_allclose(extraordinary.k[:, 0], [0.5, 0, 1.529032971460], rtol=0, atol=1e-12)
    np.testing.assert_allclose(extraordinary.index[0], 1.608708123872, rtol=0, atol=1e-12)
    expected = [0.241182822203, -0.069889615624, 0.967959858621]
    np.testing.assert_allclose(extraordinary.ray[:, 0], expected, rtol=0, atol=1e-11)
    reflected = [[0.0811628663, 0.0000623979], [0.000288497951, 0.0337737125]]
    transmitted = [[0.477826885719, 0.458064137860], [0.440721750006, 0.508099751736]]
    np.testing.assert_allclose(table(result.power_reflected), reflected, rtol=0, atol=1e-10)
    np.testing.assert_allclose(table(result.power_transmitted), transmitted, rtol=0, atol=1e-12)
    # as ratios of vector fields, free of the signs of the modes: s along y, p along k x y
    (s_in, p_in), (s_out, p_out) = result.incident, result.reflected
    r_ss = result.amplitude_reflected[0][0][0] * s_out.field[1, 0] / s_in.field[1, 0]
    np.testing.assert_allclose(r_ss, -0.284890973, rtol=0, atol=1e-9)
    y = np.array([0.0, 1.0, 0.0])
    p_before, p_after = (wave.field[:, 0] @ np.cross(wave.k[:, 0], y) for wave in (p_in, p_out))
    r_pp = result.amplitude_reflected[1][1][0] * p_after / p_before
    np.testing.assert_allclose(r_pp, 0.183776257, rtol=0, atol=1e-9)


def test_walk_off_at_normal_incidence() -> None:
    axis = np.array([1.0, 0.0, 1.0]) / np.sqrt(2)
    ray = scatter(NORMAL, np.zeros((3, 1)), AIR, Medium.uniaxial(N_O, N_E, axis)).transmitted[1].ray[:, 0]
    np.testing.assert_allclose(np.degrees(np.arctan2(-ray[0], ray[2])), 6.2241176, rtol=0, atol=1e-7)
    np.testing.assert_allclose(-ray[0] / ray[2] * 10.0, 1.0906068, rtol=0, atol=1e-7)
