"""Plates of active minerals: the plane of polarization turns as far, and in the sense, that the entry says."""

from __future__ import annotations

import numpy as np
import pytest

import minerals_db
from crystal_core.materials import medium, principal_indices
from crystal_core.optics.plates import Plate, plate_stack
from minerals_db import Mineral

HORIZONTAL = np.array((1.0, 1.0, 0.0, 0.0))
DOWN = np.diag((1.0, -1.0, -1.0))  # a half turn about x: the optic axis points against the light


def mirrored(mineral: Mineral) -> Mineral:
    rotation = mineral.optical_rotation
    assert rotation is not None
    hand = rotation.hand.model_copy(update={"sense": "left" if rotation.hand.sense == "right" else "right"})
    return mineral.model_copy(update={"optical_rotation": rotation.model_copy(update={"hand": hand})})


def turned_deg(mineral: Mineral, nm: float, micrometres: float, rotation: np.ndarray | None = None) -> float:
    """Return by how much a plate cut across c turns horizontal light, degrees, counter-clockwise facing the source."""
    (n_o, _) = principal_indices(mineral, [nm])
    plate = Plate(medium(mineral, [nm], rotation), micrometres)
    # In a mount of its own index no light goes to and fro.
    mueller = plate_stack([plate], [nm], n_o).mueller_transmitted[:, :, 0]
    _, s1, s2, s3 = mueller @ HORIZONTAL
    assert abs(s3) < 1e-6
    return float(np.rad2deg(0.5 * np.arctan2(s2, s1)))


@pytest.mark.parametrize("nm", [430.8, 486.1, 589.3, 656.3])
@pytest.mark.parametrize(("mineral_id", "micrometres"), [("quartz", 1000.0), ("paratellurite", 200.0)])
def test_a_right_crystal_turns_clockwise_by_the_entry(mineral_id: str, micrometres: float, nm: float) -> None:
    mineral = minerals_db.mineral(mineral_id)
    assert mineral.optical_rotation is not None
    told = 1e-3 * micrometres * float(mineral.optical_rotation.along_axis.degrees_per_mm_at(nm))
    # The frame of transmitted light is (x, y, propagation): who faces the source sees x to the right, y upwards.
    assert turned_deg(mineral, nm, micrometres) == pytest.approx(-told, rel=1e-6)
    assert turned_deg(mirrored(mineral), nm, micrometres) == pytest.approx(told, rel=1e-6)


def test_a_crystal_turned_over_turns_in_the_same_sense() -> None:
    quartz = minerals_db.mineral("quartz")
    assert turned_deg(quartz, 589.3, 1000.0, DOWN) == pytest.approx(turned_deg(quartz, 589.3, 1000.0), rel=1e-9)
