"""Stacks of plates against pyElli, an independent implementation of Berreman's method."""

from __future__ import annotations

import numpy as np
import pytest

from crystal_core.optics.medium import Medium
from crystal_core.optics.plates import Plate, plate_stack
from tests.optics.plate_cases import pyelli_jones, random_stack

WAVELENGTHS = np.array((382.7, 467.8, 546.1, 589.3, 656.3, 779.1))


def worst_difference(seed: int, count: int, absorption: float, thickest_um: float) -> tuple[float, int]:
    """Largest difference of a Jones element over random stacks, and how many matrices were compared."""
    rng = np.random.default_rng(seed)
    worst, compared = 0.0, 0
    for _ in range(count):
        plates = random_stack(rng, int(rng.integers(1, 4)), thickest_um, absorption)
        mount = rng.uniform(1.0, 1.8)
        kappa = mount * rng.choice((0.0, rng.uniform(0.0, 0.98)))
        ours = plate_stack(plates, WAVELENGTHS, mount, (kappa, 0.0, 0.0))
        assert ours.jones_transmitted is not None
        assert ours.jones_reflected is not None
        # pyElli multiplies transfer matrices, which lose their digits where a wave hardly gets through.
        opaque = np.linalg.svd(np.moveaxis(ours.jones_transmitted, 2, 0), compute_uv=False).min() < 1e-5
        if opaque:
            continue
        transmitted, reflected = pyelli_jones(plates, WAVELENGTHS, mount, kappa)
        compared += WAVELENGTHS.size
        worst = max(
            worst,
            float(np.abs(ours.jones_transmitted - transmitted).max()),
            float(np.abs(ours.jones_reflected - reflected).max()),
        )
    return worst, compared


@pytest.mark.parametrize(("absorption", "thickest_um"), [(0.0, 30.0), (30.0, 30.0), (3000.0, 1.0)])
def test_jones_matrices_of_random_stacks(absorption: float, thickest_um: float) -> None:
    worst, compared = worst_difference(1, 40, absorption, thickest_um)
    assert compared > 150
    assert worst < 1e-9


@pytest.mark.full
@pytest.mark.parametrize(("absorption", "thickest_um"), [(0.0, 30.0), (30.0, 30.0), (3000.0, 1.0)])
def test_jones_matrices_of_many_random_stacks(absorption: float, thickest_um: float) -> None:
    worst, compared = worst_difference(2, 700, absorption, thickest_um)
    assert compared >= 2000
    assert worst < 1e-9


def test_absorbing_biaxial_plate_at_one_oblique_incidence() -> None:
    """One case that anyone can type in again: three indices, three coefficients on axes of their own."""
    turn = np.array(((0.6, 0.8, 0.0), (-0.48, 0.36, 0.8), (0.64, -0.48, 0.6)))
    medium = Medium.biaxial((1.53, 1.61, 1.69), turn).absorbing((200.0, 50.0, 900.0), turn[::-1])
    plates = [Plate(medium, 2.0)]
    ours = plate_stack(plates, WAVELENGTHS, 1.2, (0.9, 0.0, 0.0))
    transmitted, reflected = pyelli_jones(plates, WAVELENGTHS, 1.2, 0.9)
    np.testing.assert_allclose(ours.jones_transmitted, transmitted, rtol=0, atol=1e-12)
    np.testing.assert_allclose(ours.jones_reflected, reflected, rtol=0, atol=1e-12)
    assert np.abs(transmitted[0, 1]).min() > 0.01  # the case does couple s and p
