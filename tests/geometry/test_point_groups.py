"""The 32 point groups: orders, forms and settings, against International Tables."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

import minerals_db
from crystal_core.errors import InputError
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.point_groups import GENERATORS, point_group, setting_of
from crystal_core.scene.specimen import lattice_of, point_group_of
from minerals_db.symmetry import POINT_GROUPS
from tests.minerals_db.crystal_classes import operations

CELLS = {
    "triclinic": Lattice((5.0, 6.0, 7.0), (85.0, 95.0, 105.0)),
    "monoclinic": Lattice((5.0, 6.0, 7.0), (90.0, 110.0, 90.0)),
    "orthorhombic": Lattice((5.0, 6.0, 7.0), (90.0, 90.0, 90.0)),
    "tetragonal": Lattice((5.0, 5.0, 7.0), (90.0, 90.0, 90.0)),
    "hexagonal": Lattice((5.0, 5.0, 7.0), (90.0, 90.0, 120.0)),
    "cubic": Lattice((5.0, 5.0, 5.0), (90.0, 90.0, 90.0)),
}

FORMS: dict[str, tuple[str, dict[tuple[int, int, int], int]]] = {
    "1": ("triclinic", {(1, 2, 3): 1, (0, 0, 1): 1}),
    "-1": ("triclinic", {(1, 2, 3): 2, (0, 0, 1): 2}),
    "2": ("monoclinic", {(1, 2, 3): 2, (1, 0, 2): 2, (0, 1, 0): 1}),
    "m": ("monoclinic", {(1, 2, 3): 2, (1, 0, 2): 1, (0, 1, 0): 2}),
    "2/m": ("monoclinic", {(1, 2, 3): 4, (1, 0, 2): 2, (0, 1, 0): 2}),
    "222": ("orthorhombic", {(1, 2, 3): 4, (1, 2, 0): 4, (0, 1, 2): 4, (1, 0, 0): 2, (0, 0, 1): 2}),
    "mm2": ("orthorhombic", {(1, 2, 3): 4, (1, 2, 0): 4, (1, 0, 2): 2, (0, 1, 2): 2, (1, 0, 0): 2, (0, 0, 1): 1}),
    "m2m": ("orthorhombic", {(1, 2, 3): 4, (1, 2, 0): 2, (1, 0, 2): 4, (0, 1, 2): 2, (0, 1, 0): 1, (0, 0, 1): 2}),
    "2mm": ("orthorhombic", {(1, 2, 3): 4, (1, 2, 0): 2, (1, 0, 2): 2, (0, 1, 2): 4, (1, 0, 0): 1, (0, 0, 1): 2}),
    "mmm": ("orthorhombic", {(1, 2, 3): 8, (1, 2, 0): 4, (1, 0, 2): 4, (0, 1, 2): 4, (1, 0, 0): 2, (0, 0, 1): 2}),
    "4": ("tetragonal", {(1, 2, 3): 4, (1, 2, 0): 4, (1, 0, 0): 4, (0, 0, 1): 1}),
    "-4": ("tetragonal", {(1, 2, 3): 4, (1, 2, 0): 4, (1, 0, 0): 4, (0, 0, 1): 2}),
    "4/m": ("tetragonal", {(1, 2, 3): 8, (1, 2, 0): 4, (1, 0, 0): 4, (0, 0, 1): 2}),
    "422": (
        "tetragonal",
        {(1, 2, 3): 8, (1, 1, 2): 8, (1, 0, 2): 8, (1, 2, 0): 8, (1, 1, 0): 4, (1, 0, 0): 4, (0, 0, 1): 2},
    ),
    "4mm": (
        "tetragonal",
        {(1, 2, 3): 8, (1, 1, 2): 4, (1, 0, 2): 4, (1, 2, 0): 8, (1, 1, 0): 4, (1, 0, 0): 4, (0, 0, 1): 1},
    ),
    "-42m": (
        "tetragonal",
        {(1, 2, 3): 8, (1, 1, 2): 4, (1, 0, 2): 8, (1, 2, 0): 8, (1, 1, 0): 4, (1, 0, 0): 4, (0, 0, 1): 2},
    ),
    "-4m2": (
        "tetragonal",
        {(1, 2, 3): 8, (1, 1, 2): 8, (1, 0, 2): 4, (1, 2, 0): 8, (1, 1, 0): 4, (1, 0, 0): 4, (0, 0, 1): 2},
    ),
    "4/mmm": (
        "tetragonal",
        {(1, 2, 3): 16, (1, 1, 2): 8, (1, 0, 2): 8, (1, 2, 0): 8, (1, 1, 0): 4, (1, 0, 0): 4, (0, 0, 1): 2},
    ),
    "3": ("hexagonal", {(2, 1, 3): 3, (2, 1, 0): 3, (1, 0, 0): 3, (1, 1, 0): 3, (0, 0, 1): 1}),
    "-3": ("hexagonal", {(2, 1, 3): 6, (2, 1, 0): 6, (1, 0, 0): 6, (1, 1, 0): 6, (0, 0, 1): 2}),
    "321": (
        "hexagonal",
        {(2, 1, 3): 6, (1, 0, 2): 6, (1, 1, 2): 6, (2, 1, 0): 6, (1, 0, 0): 6, (1, 1, 0): 3, (0, 0, 1): 2},
    ),
    "312": (
        "hexagonal",
        {(2, 1, 3): 6, (1, 0, 2): 6, (1, 1, 2): 6, (2, 1, 0): 6, (1, 0, 0): 3, (1, 1, 0): 6, (0, 0, 1): 2},
    ),
    "3m1": (
        "hexagonal",
        {(2, 1, 3): 6, (1, 0, 2): 3, (1, 1, 2): 6, (2, 1, 0): 6, (1, 0, 0): 3, (1, 1, 0): 6, (0, 0, 1): 1},
    ),
    "31m": (
        "hexagonal",
        {(2, 1, 3): 6, (1, 0, 2): 6, (1, 1, 2): 3, (2, 1, 0): 6, (1, 0, 0): 6, (1, 1, 0): 3, (0, 0, 1): 1},
    ),
    "-3m1": (
        "hexagonal",
        {(2, 1, 3): 12, (1, 0, 2): 6, (1, 1, 2): 12, (2, 1, 0): 12, (1, 0, 0): 6, (1, 1, 0): 6, (0, 0, 1): 2},
    ),
    "-31m": (
        "hexagonal",
        {(2, 1, 3): 12, (1, 0, 2): 12, (1, 1, 2): 6, (2, 1, 0): 12, (1, 0, 0): 6, (1, 1, 0): 6, (0, 0, 1): 2},
    ),
    "6": ("hexagonal", {(2, 1, 3): 6, (2, 1, 0): 6, (1, 0, 0): 6, (0, 0, 1): 1}),
    "-6": ("hexagonal", {(2, 1, 3): 6, (2, 1, 0): 3, (1, 0, 0): 3, (0, 0, 1): 2}),
    "6/m": ("hexagonal", {(2, 1, 3): 12, (2, 1, 0): 6, (1, 0, 0): 6, (0, 0, 1): 2}),
    "622": (
        "hexagonal",
        {(2, 1, 3): 12, (1, 0, 2): 12, (1, 1, 2): 12, (2, 1, 0): 12, (1, 0, 0): 6, (1, 1, 0): 6, (0, 0, 1): 2},
    ),
    "6mm": (
        "hexagonal",
        {(2, 1, 3): 12, (1, 0, 2): 6, (1, 1, 2): 6, (2, 1, 0): 12, (1, 0, 0): 6, (1, 1, 0): 6, (0, 0, 1): 1},
    ),
    "-6m2": (
        "hexagonal",
        {(2, 1, 3): 12, (1, 0, 2): 6, (1, 1, 2): 12, (2, 1, 0): 6, (1, 0, 0): 3, (1, 1, 0): 6, (0, 0, 1): 2},
    ),
    "-62m": (
        "hexagonal",
        {(2, 1, 3): 12, (1, 0, 2): 12, (1, 1, 2): 6, (2, 1, 0): 6, (1, 0, 0): 6, (1, 1, 0): 3, (0, 0, 1): 2},
    ),
    "6/mmm": (
        "hexagonal",
        {(2, 1, 3): 24, (1, 0, 2): 12, (1, 1, 2): 12, (2, 1, 0): 12, (1, 0, 0): 6, (1, 1, 0): 6, (0, 0, 1): 2},
    ),
    "23": ("cubic", {(1, 2, 3): 12, (1, 1, 2): 12, (0, 1, 2): 12, (1, 1, 1): 4, (1, 1, 0): 12, (1, 0, 0): 6}),
    "m-3": ("cubic", {(1, 2, 3): 24, (1, 1, 2): 24, (0, 1, 2): 12, (1, 1, 1): 8, (1, 1, 0): 12, (1, 0, 0): 6}),
    "432": ("cubic", {(1, 2, 3): 24, (1, 1, 2): 24, (0, 1, 2): 24, (1, 1, 1): 8, (1, 1, 0): 12, (1, 0, 0): 6}),
    "-43m": ("cubic", {(1, 2, 3): 24, (1, 1, 2): 12, (0, 1, 2): 24, (1, 1, 1): 4, (1, 1, 0): 12, (1, 0, 0): 6}),
    "m-3m": ("cubic", {(1, 2, 3): 48, (1, 1, 2): 24, (0, 1, 2): 24, (1, 1, 1): 8, (1, 1, 0): 12, (1, 0, 0): 6}),
}
"""Multiplicities of general and special forms (International Tables for Crystallography A, table 3.2.3.2); the first of
each group is the general form, whose multiplicity is the order of the group."""

LAUE = {
    "-1": ("1", "-1"),
    "2/m": ("2", "m", "2/m"),
    "mmm": ("222", "mm2", "m2m", "2mm", "mmm"),
    "4/m": ("4", "-4", "4/m"),
    "4/mmm": ("422", "4mm", "-42m", "-4m2", "4/mmm"),
    "-3": ("3", "-3"),
    "-3m1": ("321", "3m1", "-3m1"),
    "-31m": ("312", "31m", "-31m"),
    "6/m": ("6", "-6", "6/m"),
    "6/mmm": ("622", "6mm", "-6m2", "-62m", "6/mmm"),
    "m-3": ("23", "m-3"),
    "m-3m": ("432", "-43m", "m-3m"),
}

ENANTIOMORPHIC = ("1", "2", "222", "4", "422", "3", "321", "312", "6", "622", "23", "432")

CRYSTALS = [mineral_id for mineral_id, entry in minerals_db.minerals().items() if entry.cell is not None]


def test_all_are_told() -> None:
    assert set(FORMS) == set(GENERATORS)
    assert set(GENERATORS) == {symbol for group in LAUE.values() for symbol in group}
    short = {symbol for groups in POINT_GROUPS.values() for symbol in groups}
    assert len(short) == 32
    assert short - set(GENERATORS) == {"32", "3m", "-3m"}  # of which only the settings stand there


@pytest.mark.parametrize("symbol", FORMS)
def test_forms(symbol: str) -> None:
    system, multiplicities = FORMS[symbol]
    group, lattice = point_group(symbol), CELLS[system]
    assert group.order == next(iter(multiplicities.values()))
    for hkl, multiplicity in multiplicities.items():
        faces = group.equivalents(hkl)
        assert faces[0] == hkl
        assert len(set(faces)) == len(faces) == multiplicity
        spacings = [lattice.d_spacing(face) for face in faces]
        np.testing.assert_allclose(spacings, spacings[0], rtol=1e-12)
        assert all(set(group.equivalents(face)) == set(faces) for face in faces)


@pytest.mark.parametrize("symbol", FORMS)
def test_they_are_groups_of_isometries(symbol: str) -> None:
    system, _ = FORMS[symbol]
    group, lattice = point_group(symbol), CELLS[system]
    known = {matrix.tobytes() for matrix in group.matrices}
    assert len(known) == group.order
    assert (group.matrices[0] == np.eye(3)).all()
    assert all((a @ b).tobytes() in known for a, b in product(group.matrices, repeat=2))
    for matrix in group.matrices:
        assert np.rint(np.linalg.inv(matrix)).astype(np.int64).tobytes() in known
        np.testing.assert_allclose(matrix.T @ lattice.metric @ matrix, lattice.metric, atol=1e-9)
    assert group.fits(lattice)
    cartesian = group.cartesian(lattice)
    np.testing.assert_allclose(
        cartesian @ cartesian.transpose(0, 2, 1), np.broadcast_to(np.eye(3), cartesian.shape), atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.det(cartesian), group.determinants, atol=1e-12)
    # A face's normal moves with the operation.
    for rotation in cartesian:
        moved = rotation @ lattice.face_normal((1, 2, 3))
        assert min(np.abs(moved - lattice.face_normal(face)).max() for face in group.equivalents((1, 2, 3))) < 1e-12


@pytest.mark.parametrize("symbol", FORMS)
def test_a_cell_of_less_symmetry_does_not_fit(symbol: str) -> None:
    assert point_group(symbol).fits(CELLS["triclinic"]) == (symbol in ("1", "-1"))


@pytest.mark.parametrize("laue", LAUE)
def test_laue_classes(laue: str) -> None:
    for symbol in LAUE[laue]:
        group = point_group(symbol)
        both = {matrix.tobytes() for matrix in np.concatenate((group.matrices, -group.matrices))}
        assert group.laue.symbol == laue
        assert {matrix.tobytes() for matrix in group.laue.matrices} == both
        assert group.is_centrosymmetric == (symbol == laue)
        assert group.is_chiral == (symbol in ENANTIOMORPHIC)


@pytest.mark.parametrize(
    ("group", "space_group", "setting"),
    [
        ("32", "P 32 2 1", "321"),
        ("32", "P 31 1 2", "312"),
        ("32", "R 3 2", "321"),
        ("3m", "R 3 m", "3m1"),
        ("3m", "P 3 1 c", "31m"),
        ("3m", "P 3 c 1", "3m1"),
        ("-3m", "R -3 c", "-3m1"),
        ("-3m", "P -3 1 m", "-31m"),
        ("-3m", "P -3 m 1", "-3m1"),
        ("-6m2", "P -6 c 2", "-6m2"),
        ("-6m2", "P -6 2 m", "-62m"),
        ("-42m", "I -4 2 d", "-42m"),
        ("-42m", "I -4 m 2", "-4m2"),
        ("-42m", "P -4 c 2", "-4m2"),
        ("mm2", "P n a 21", "mm2"),
        ("mm2", "P 21 n b", "2mm"),
        ("mm2", "P c 21 n", "m2m"),
        ("m-3m", "whatever it says", "m-3m"),
    ],
)
def test_settings(group: str, space_group: str, setting: str) -> None:
    assert setting_of(group, space_group) == setting


@pytest.mark.parametrize("space_group", ["P 3", "R -3 c", "quartz", "", "P 32 2"])
def test_a_space_group_that_does_not_tell(space_group: str) -> None:
    if space_group == "P 32 2":  # what is not said of the last place is 1
        assert setting_of("32", space_group) == "321"
        return
    with pytest.raises(InputError, match="/cell/space_group"):
        setting_of("32", space_group)


@pytest.mark.parametrize("symbol", ["32", "3m", "-3m", "7", ""])
def test_no_group_or_no_setting(symbol: str) -> None:
    with pytest.raises(InputError, match="/point_group"):
        point_group(symbol)


@pytest.mark.parametrize("mineral_id", CRYSTALS)
def test_groups_of_the_minerals_are_those_of_their_space_groups(mineral_id: str) -> None:
    """Against matrices made from the places of the space group's symbol, in the crystal frame."""
    entry = minerals_db.mineral(mineral_id)
    group, lattice = point_group_of(entry), lattice_of(entry)
    assert group.fits(lattice)
    ours, theirs = group.cartesian(lattice), operations(entry)
    assert len(ours) == len(theirs)
    gaps = np.abs(ours[:, None] - theirs[None]).max(axis=(2, 3))
    assert (gaps.min(axis=1) < 1e-9).all()
