"""Reflection at crystals of every class against pyElli, for light from an isotropic medium."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tests.reference.arithmetic import Array
from tests.reference.cases import Cases, random_cases
from tests.reference.media import KINDS, Kind
from tests.reference.pyelli import reflection, separation


def frames(cases: Cases) -> tuple[Array, Array]:
    """Return the length of each tangential k and the frame (3, 3, N) of rows x, y, z with x along it."""
    kappa = np.linalg.norm(cases.tangential, axis=0)
    x = cases.tangential / kappa
    return kappa, np.array([x, np.cross(cases.normal, x, axis=0), cases.normal])


def reflected_fields(cases: Cases, frame: Array) -> tuple[Array, Array]:
    """Return the reflected vector field for an incident field along s and p, by the project, (3, 2, N), and its r.

    The fields of the two incident waves are an orthonormal basis of those across k.
    """
    got = cases.run()
    n = cases.source.indices[0]
    s = frame[1]
    p = np.cross(s, got.incident[0].k / n, axis=0)
    field = np.zeros((3, 2, cases.normal.shape[1]), complex)
    for j, i in itertools.product(range(2), range(2)):
        out = got.amplitude_reflected[i][j] * got.reflected[i].field
        for column, wanted in enumerate((s, p)):
            field[:, column] += np.sum(np.conj(got.incident[j].field) * wanted, axis=0) * out
    powers = np.array(got.power_reflected).sum(axis=(0, 1))
    return field, powers


@pytest.mark.parametrize("size", [500, pytest.param(4000, marks=pytest.mark.full)])
@pytest.mark.parametrize("target", KINDS)
def test_reflection_agrees_with_pyelli(target: Kind, size: int) -> None:
    cases = random_cases(301, "isotropic", target, size)
    kappa, frame = frames(cases)
    eps = np.array([cases.target.tensor(case, None) for case in range(size)])
    local = np.einsum("ian,nab,jbn->nij", frame, eps, frame)
    n = cases.source.indices[0]
    truth = reflection(n, kappa, local)
    # s = y and, for the reflected wave too, p = s x k: with its own q, so its x component changes sign
    q = np.sqrt(n**2 - kappa**2)
    s, p = frame[1], (-q * frame[0] - kappa * frame[2]) / n
    expected = np.array([[truth[0, j] * s[a] + truth[1, j] * p[a] for j in range(2)] for a in range(3)])
    ours, powers = reflected_fields(cases, frame)
    fair = separation(kappa, local) > 1e-3 if target != "isotropic" else np.ones(size, bool)
    assert fair.sum() > 0.9 * size
    np.testing.assert_allclose(ours[..., fair], expected[..., fair], rtol=0, atol=1e-9)
    shares = (np.abs(truth) ** 2).sum(axis=0)
    np.testing.assert_allclose(powers[fair], shares.sum(axis=0)[fair], rtol=0, atol=1e-9)
    assert (np.abs(shares - 1).max(axis=0) < 1e-9)[fair].sum() > size // 50  # total reflection
    if target != "isotropic":
        assert (np.abs(truth[0, 1, fair]) ** 2 > 1e-3).sum() > size // 20  # s and p exchange light
