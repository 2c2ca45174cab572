"""A mineral's entry as bodies: habits, cleavage fragments and twins by their names."""

from __future__ import annotations

import numpy as np
import pytest

import minerals_db
from crystal_core.errors import InputError
from crystal_core.geometry.habit import Form, diameter
from crystal_core.scene.specimen import (
    cleavage_body,
    habit_of,
    lattice_of,
    point_group_of,
    specimen_solid,
    specimen_twin,
    twin_law,
)


def test_calcite_and_quartz() -> None:
    """The rhombohedron of calcite has six faces, the prism of quartz eighteen."""
    assert len(specimen_solid(minerals_db.mineral("calcite")).labels) == 6
    assert len(specimen_solid(minerals_db.mineral("quartz"), "prismatic").labels) == 18


def test_the_first_habit_unless_one_is_named() -> None:
    quartz = minerals_db.mineral("quartz")
    assert habit_of(quartz) is quartz.habits[0]
    first, named = specimen_solid(quartz), specimen_solid(quartz, quartz.habits[0].name)
    np.testing.assert_array_equal(first.body.vertices, named.body.vertices)
    assert diameter(first.body.vertices) == pytest.approx(10.0)


@pytest.mark.parametrize(
    "name", ["prismatic with s x", "Prismatic-with-s-x", "prismatic_with_s_x", " prismatic  with s x"]
)
def test_names_are_found_however_they_are_written(name: str) -> None:
    assert habit_of(minerals_db.mineral("quartz"), name).name == "prismatic with s x"


def test_a_variety_has_the_shapes_of_its_mineral() -> None:
    ruby, corundum = minerals_db.mineral("ruby"), minerals_db.mineral("corundum")
    np.testing.assert_array_equal(specimen_solid(ruby).body.vertices, specimen_solid(corundum).body.vertices)


def test_forms_of_ones_own() -> None:
    solid = specimen_solid(minerals_db.mineral("calcite"), [Form((1, 0, 0), 1.0, "m"), Form((0, 0, 1), 2.0)], 5.0)
    assert len(solid.labels) == 8
    assert {label.split()[0] for label in solid.labels} == {"m", "0"}
    assert diameter(solid.body.vertices) == pytest.approx(5.0)


def test_solids_move_with_their_labels() -> None:
    solid = specimen_solid(minerals_db.mineral("quartz"))
    turn = np.array(((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    moved = solid.transformed(turn, np.array((1.0, 2.0, 3.0)))
    np.testing.assert_allclose(moved.body.vertices, solid.body.vertices @ turn.T + (1.0, 2.0, 3.0))
    assert (moved.labels, moved.hkl) == (solid.labels, solid.hkl)


@pytest.mark.parametrize(
    ("mineral_id", "habit", "size_mm", "pointer", "told"),
    [
        ("soda-lime-glass", None, 1.0, "/shape", "is a glass"),
        ("bbo", None, 1.0, "/shape/name", "no habit of bbo is known"),
        ("quartz", "prismatik", 1.0, "/shape/name", "do you mean prismatic"),
        ("quartz", "", 1.0, "/shape/name", "those known are prismatic"),
        ("quartz", None, -1.0, "/shape/size_mm", "must be a length"),
        ("quartz", [Form((1, 0, 0), 1.0)], 1.0, "/shape/forms", "do not close"),
        (
            "quartz",
            [Form((1, 0, 0), 1.0), Form((1, 0, 1), 1.0), Form((0, 0, 1), 9.0)],
            1.0,
            "/shape/forms/2",
            "nothing",
        ),
    ],
)
def test_errors_name_the_place(
    mineral_id: str, habit: str | list[Form] | None, size_mm: float, pointer: str, told: str
) -> None:
    with pytest.raises(InputError, match=told) as caught:
        specimen_solid(minerals_db.mineral(mineral_id), habit, size_mm, pointer="/shape")
    assert [fault.pointer for fault in caught.value.faults] == [pointer]


@pytest.mark.parametrize("mineral_id", ["soda-lime-glass", "glass-n-bk7"])
def test_a_glass_has_no_lattice(mineral_id: str) -> None:
    for join in (lattice_of, point_group_of):
        with pytest.raises(InputError, match="is a glass") as caught:
            join(minerals_db.mineral(mineral_id), pointer="/mineral")
        assert caught.value.faults[0].pointer == "/mineral"


# Cleavage


@pytest.mark.parametrize(
    ("mineral_id", "planes"),
    [
        ("calcite", {(1, 0, 4)}),
        ("fluorite", {(1, 1, 1)}),
        ("halite", {(0, 0, 1)}),
        ("sphalerite", {(1, 1, 0)}),
        ("barite", {(0, 0, 1), (2, 1, 0)}),  # the perfect one alone is open
        ("anhydrite", {(1, 0, 0), (0, 1, 0), (0, 0, 1)}),
        ("periclase", {(0, 0, 1)}),  # not {111}, which is good and would close too
        ("proustite", {(1, 0, 1)}),  # a polar crystal cleaves on both sides of a plane
    ],
)
def test_fragments(mineral_id: str, planes: set[tuple[int, int, int]]) -> None:
    mineral = minerals_db.mineral(mineral_id)
    laue = point_group_of(mineral).laue
    solid = cleavage_body(mineral, 2.0)
    assert set(solid.hkl) == {face for hkl in planes for face in laue.equivalents(hkl)}
    np.testing.assert_allclose(solid.body.offsets, 1.0, rtol=1e-12)


def test_a_fragment_by_one_plane() -> None:
    solid = cleavage_body(minerals_db.mineral("periclase"), 2.0, (1, 1, 1))
    assert len(solid.labels) == 8


@pytest.mark.parametrize(
    ("mineral_id", "hkl", "told"),
    [
        ("muscovite", None, "muscovite: .* enclose no body"),
        ("topaz", None, "topaz: .* enclose no body"),
        ("quartz", None, "no distinct cleavage"),
        ("almandine", None, "no distinct cleavage"),
        ("soda-lime-glass", None, "is a glass"),
        ("calcite", (0, 0, 1), "enclose no body"),
    ],
)
def test_fragments_that_are_none(mineral_id: str, hkl: tuple[int, int, int] | None, told: str) -> None:
    with pytest.raises(InputError, match=told) as caught:
        cleavage_body(minerals_db.mineral(mineral_id), 2.0, hkl, pointer="/shape/cleavage")
    assert [fault.pointer for fault in caught.value.faults] == ["/shape/cleavage"]


# Twins


def test_twin_laws_by_name() -> None:
    calcite = minerals_db.mineral("calcite")
    assert twin_law(calcite) is calcite.twinning[0]
    assert twin_law(calcite, "Basal-Twin").plane_hkl == (0, 0, 1)
    pair = specimen_twin(calcite, "basal twin", "dogtooth", 6.0)
    assert pair.composition_hkl == (0, 0, 1)
    both = np.concatenate([individual.solid.body.vertices for individual in pair.individuals])
    assert diameter(both) == pytest.approx(6.0)


def test_a_law_of_ones_own() -> None:
    pair = specimen_twin(minerals_db.mineral("halite"), plane_hkl=(1, 1, 1))
    assert pair.composition_hkl == (1, 1, 1)


@pytest.mark.parametrize(
    ("mineral_id", "law", "habit", "pointer"),
    [
        ("halite", None, None, "/twin/law"),
        ("calcite", "Japan law", None, "/twin/law"),
        ("calcite", None, "cube", "/shape/name"),
    ],
)
def test_errors_of_twins_name_the_place(mineral_id: str, law: str | None, habit: str | None, pointer: str) -> None:
    with pytest.raises(InputError) as caught:
        specimen_twin(minerals_db.mineral(mineral_id), law, habit, pointer="/twin", shape_pointer="/shape")
    assert [fault.pointer for fault in caught.value.faults] == [pointer]
