"""Contact twins: two bodies that share a face and do not overlap, and how the second lattice stands."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import minerals_db
from crystal_core.errors import InputError, NotSupportedError
from crystal_core.geometry.habit import Form, centroid, diameter
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.point_groups import point_group
from crystal_core.geometry.twins import ContactTwin, twin
from crystal_core.scene.specimen import lattice_of, point_group_of, specimen_twin
from tests.geometry.test_habits import check_closed, check_volume
from tests.geometry.test_point_groups import CELLS

SIZE_MM = 8.0
LAWS = [
    (mineral_id, law.law, habit.name)
    for mineral_id, entry in minerals_db.minerals().items()
    if not entry.is_variety
    for law in entry.twinning
    for habit in entry.habits
]
CUBIC = Lattice((1.0, 1.0, 1.0), (90.0, 90.0, 90.0))
NOT_IN_ONE_FACE = {
    ("albite", "pericline"),
    ("albite", "Carlsbad"),
    ("anorthoclase", "pericline"),
    ("anorthoclase", "Carlsbad"),
    ("biotite", "mica law"),
    ("kyanite", "c axis"),
    ("microcline", "pericline"),
    ("microcline", "Carlsbad"),
    ("muscovite", "mica law"),
    ("phlogopite", "mica law"),
    ("wollastonite", "b axis"),
}
"""Laws of axes in crystals whose symmetry maps no section along the axis onto itself."""


def check_contact(pair: ContactTwin) -> None:
    first, second = (individual.solid.body for individual in pair.individuals)
    for body in (first, second):
        check_closed(body)
        check_volume(body)
    here, there = pair.contact
    corners = first.vertices[list(first.faces[here])]
    others = second.vertices[list(second.faces[there])]
    # To the last bit the same corners, run through the other way round.
    assert {tuple(corner) for corner in corners} == {tuple(corner) for corner in others}
    start = next(i for i, corner in enumerate(others) if (corner == corners[0]).all())
    np.testing.assert_array_equal(np.roll(others[::-1], start + 1 - len(others), axis=0), corners)
    np.testing.assert_array_equal(first.normals[here], -second.normals[there])
    # On either side of the common plane: they cannot overlap.
    normal, offset = first.normals[here], first.offsets[here]
    assert (first.vertices @ normal).max() <= offset + 1e-12
    assert (second.vertices @ normal).min() >= offset - 1e-12
    both = np.concatenate((first.vertices, second.vertices))
    assert diameter(both) == pytest.approx(SIZE_MM, rel=1e-12)
    volumes = np.array([first.volume_mm3, second.volume_mm3])
    np.testing.assert_allclose(volumes @ [centroid(first), centroid(second)], 0.0, atol=1e-9)
    assert ConvexHull(both).volume >= volumes.sum() * (1.0 - 1e-12)


@pytest.mark.parametrize(("mineral_id", "law", "habit"), LAWS)
def test_laws_of_the_database(mineral_id: str, law: str, habit: str) -> None:
    entry = minerals_db.mineral(mineral_id)
    if (mineral_id, law) in NOT_IN_ONE_FACE:
        with pytest.raises(NotSupportedError, match="different outlines"):
            specimen_twin(entry, law, habit, SIZE_MM)
        return
    pair = specimen_twin(entry, law, habit, SIZE_MM)
    check_contact(pair)
    lattice, group = lattice_of(entry), point_group_of(entry)
    first, second = pair.individuals
    np.testing.assert_array_equal(first.rotation, np.eye(3))
    assert (first.hand, second.hand) == (1, 1 if not group.is_chiral or entry_axis(mineral_id, law) else -1)
    for individual in pair.individuals:
        rotation = individual.rotation
        np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(rotation) == pytest.approx(1.0)
        # The hkl are those of the individual's own lattice, and only forms of the habit and the contact occur.
        for hkl, normal in zip(individual.solid.hkl, individual.solid.body.normals, strict=True):
            assert hkl is not None
            np.testing.assert_allclose(rotation @ lattice.face_normal(hkl), normal, atol=1e-7)
    forms = next(known.forms for known in entry.habits if known.name == habit)
    allowed = {face for form in forms for face in group.equivalents(form.hkl)}
    for individual, contact in zip(pair.individuals, pair.contact, strict=True):
        faces = [hkl for face, hkl in enumerate(individual.solid.hkl) if face != contact and hkl is not None]
        sign = individual.hand  # the faces of a mirror image are those of the opposite form
        assert {(sign * h, sign * k, sign * m) for h, k, m in faces} <= allowed
        assert individual.solid.labels[contact] == "composition"


def entry_axis(mineral_id: str, law: str) -> bool:
    return next(twin.axis_uvw for twin in minerals_db.mineral(mineral_id).twinning if twin.law == law) is not None


def turned_deg(rotation: np.ndarray) -> float:
    return float(np.rad2deg(np.arccos(np.clip((np.trace(rotation) - 1.0) / 2.0, -1.0, 1.0))))


def test_calcite_e_twin() -> None:
    """{018} of the structural cell: the c axes enclose twice the angle of c and e."""
    calcite = minerals_db.mineral("calcite")
    pair = specimen_twin(calcite, "e twin", None, SIZE_MM)
    assert pair.composition_hkl == (0, 1, 8)
    rotation = pair.individuals[1].rotation
    between = np.rad2deg(np.arccos(abs(rotation[2, 2])))
    assert between == pytest.approx(2.0 * lattice_of(calcite).interfacial_angle_deg((0, 0, 1), (0, 1, 8)))
    assert between == pytest.approx(52.5, abs=0.1)  # 127°30' between the axes of classical drawings
    # The reflection that the law names takes one lattice to the other.
    normal = lattice_of(calcite).face_normal((0, 1, 8))
    mirror = np.eye(3) - 2.0 * np.outer(normal, normal)
    symmetry = point_group_of(calcite).cartesian(lattice_of(calcite))
    assert min(np.abs(mirror @ operation - rotation).max() for operation in symmetry) < 1e-12


def test_quartz_dauphine_is_a_rotation() -> None:
    pair = specimen_twin(minerals_db.mineral("quartz"), "Dauphiné law", "prismatic", SIZE_MM)
    np.testing.assert_allclose(pair.individuals[1].rotation, np.diag((-1.0, -1.0, 1.0)), atol=1e-12)
    assert pair.individuals[1].hand == 1
    # In the pair, r of one stands where z of the other would be: above and below, r at the same azimuths.
    upper = max(pair.individuals, key=lambda individual: individual.solid.body.vertices[:, 2].max())
    lower = next(individual for individual in pair.individuals if individual is not upper)

    def azimuths(individual: object, sign: float) -> list[float]:
        solid = individual.solid  # type: ignore[attr-defined]
        normals = [n for n, label in zip(solid.body.normals, solid.labels, strict=True) if label.startswith("r ")]
        return sorted(round(float(np.rad2deg(np.arctan2(n[1], n[0]))) % 360.0, 6) for n in normals if sign * n[2] > 0)

    assert azimuths(upper, 1.0) == azimuths(lower, -1.0)


def test_quartz_dauphine_side_by_side() -> None:
    pair = specimen_twin(minerals_db.mineral("quartz"), "Dauphiné law", "prismatic", SIZE_MM, composition_hkl=(0, 1, 0))
    check_contact(pair)
    volumes = [individual.solid.body.volume_mm3 for individual in pair.individuals]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-12)


def test_quartz_brazil_is_the_other_hand() -> None:
    """Parallel lattices, r on r, and the mirror image of the trapezohedron x: activity changes its sign."""
    pair = specimen_twin(minerals_db.mineral("quartz"), "Brazil law", "prismatic with s x", SIZE_MM)
    second = pair.individuals[1]
    np.testing.assert_allclose(second.rotation, np.eye(3), atol=1e-12)
    assert second.hand == -1
    group = point_group("321")
    right = set(group.equivalents((5, 1, 1)))
    found = {hkl for hkl, label in zip(second.solid.hkl, second.solid.labels, strict=True) if label.startswith("x ")}
    assert found
    assert not found & right
    assert found <= {(-h, -k, -m) for h, k, m in right}


def test_quartz_japan_law() -> None:
    """The c axes of Japan twins enclose 84°33' (V. Goldschmidt, Z. Kryst. 44 (1908) 407)."""
    pair = specimen_twin(minerals_db.mineral("quartz"), "Japan law", None, SIZE_MM)
    assert np.rad2deg(np.arccos(abs(pair.individuals[1].rotation[2, 2]))) == pytest.approx(84.55, abs=0.02)


def test_cassiterite_knee() -> None:
    """The chief axes enclose 112°10' (M. F. Heddle, Mineralogy, Encyclopædia Britannica, 9th ed., vol. 16, p. 387)."""
    pair = specimen_twin(minerals_db.mineral("cassiterite"), None, None, SIZE_MM)
    between = np.rad2deg(np.arccos(abs(pair.individuals[1].rotation[2, 2])))
    assert 180.0 - between == pytest.approx(112.0 + 10.0 / 60.0, abs=0.05)


def test_spinel_law() -> None:
    pair = specimen_twin(minerals_db.mineral("spinel"), "spinel law", "octahedron", SIZE_MM)
    rotation = pair.individuals[1].rotation
    assert turned_deg(rotation) == pytest.approx(60.0)
    np.testing.assert_allclose(rotation @ np.ones(3), np.ones(3), atol=1e-12)  # about [111]
    # Half an octahedron each: the contact is a regular hexagon.
    contact = pair.individuals[0].solid.body.faces[pair.contact[0]]
    corners = pair.individuals[0].solid.body.vertices[list(contact)]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
    np.testing.assert_allclose(sides, np.full(6, sides[0]))


def test_half_a_turn_and_reflection_are_one_law_with_a_centre() -> None:
    """Of a centrosymmetric crystal, half a turn about the normal of a plane does what the reflection does."""
    forms = [Form((1, 1, 1), 1.0), Form((1, 0, 0), 0.8)]
    group = point_group("m-3m")
    plane = twin(CUBIC, group, forms, SIZE_MM, plane_hkl=(1, 1, 1))
    axis = twin(CUBIC, group, forms, SIZE_MM, axis_uvw=(1, 1, 1))
    assert axis.composition_hkl == (1, 1, 1)
    for one, other in zip(plane.individuals, axis.individuals, strict=True):
        gaps = np.abs(one.solid.body.vertices[:, None] - other.solid.body.vertices[None]).max(axis=2)
        assert gaps.min(axis=1).max() < 1e-12
    symmetry = group.cartesian(CUBIC)
    rotations = [plane.individuals[1].rotation, axis.individuals[1].rotation]
    assert min(np.abs(rotations[0] @ operation - rotations[1]).max() for operation in symmetry) < 1e-12


def test_gypsum_swallowtail() -> None:
    """The plate of b, m and l: twinned on (100) of the classical axes, it has a notch at one end and a point below."""
    pair = specimen_twin(minerals_db.mineral("gypsum"), "swallowtail", "rhombic plate", SIZE_MM)
    check_contact(pair)
    assert pair.composition_hkl == (1, 0, -1)
    np.testing.assert_allclose(pair.individuals[1].rotation @ (0, 1, 0), (0, -1, 0), atol=1e-12)
    both = np.concatenate([individual.solid.body.vertices for individual in pair.individuals])
    volume = sum(individual.solid.body.volume_mm3 for individual in pair.individuals)
    assert ConvexHull(both).volume > 1.1 * volume


def test_polar_crystals_turn_without_a_change_of_hand() -> None:
    """Class −43m has mirrors: a reflection in {111} is a rotation of the crystal, too."""
    pair = specimen_twin(minerals_db.mineral("sodalite"), None, None, SIZE_MM)
    assert pair.individuals[1].hand == 1
    check_contact(pair)


@pytest.mark.parametrize(
    ("symbol", "law", "pointer", "told"),
    [
        ("m-3m", {"plane_hkl": (1, 0, 0)}, "/twin", "makes no twin"),
        ("m-3m", {"axis_uvw": (1, 1, 0)}, "/twin", "makes no twin"),
        ("m-3m", {}, "/twin", "either a plane or an axis"),
        ("m-3m", {"plane_hkl": (1, 1, 1), "axis_uvw": (1, 1, 1)}, "/twin", "either a plane or an axis"),
        ("m-3m", {"plane_hkl": (0, 0, 0)}, "/twin/plane_hkl", "no face"),
        ("m-3m", {"axis_uvw": (0, 0, 0)}, "/twin/axis_uvw", "no face"),
        ("m-3m", {"plane_hkl": (1, 1, 1), "composition_hkl": (0, 0, 0)}, "/twin/composition_hkl", "no face"),
    ],
)
def test_errors_name_the_place(symbol: str, law: dict[str, tuple[int, int, int]], pointer: str, told: str) -> None:
    forms = [Form((1, 0, 0), 1.0)]
    with pytest.raises(InputError, match=told) as caught:
        twin(CUBIC, point_group(symbol), forms, 1.0, pointer="/twin", **law)  # type: ignore[arg-type]
    assert [fault.pointer for fault in caught.value.faults] == [pointer]


def test_errors_of_the_shape_have_their_own_place() -> None:
    forms = [Form((1, 0, 0), 1.0), Form((1, 1, 1), 5.0)]
    for broken, size, pointer in ((forms, 1.0, "/shape/forms/1"), (forms[:1], 0.0, "/shape/size_mm")):
        with pytest.raises(InputError) as caught:
            twin(CUBIC, point_group("m-3m"), broken, size, plane_hkl=(1, 1, 1), pointer="/twin", shape_pointer="/shape")
        assert [fault.pointer for fault in caught.value.faults] == [pointer]


def test_no_common_face_is_told() -> None:
    forms = [Form((1, 0, 0), 1.0), Form((0, 1, 0), 1.2), Form((0, 0, 1), 1.4)]
    with pytest.raises(NotSupportedError, match=r"/twin: .*\(1 1 0\).* common face"):
        twin(
            CELLS["triclinic"],
            point_group("-1"),
            forms,
            1.0,
            plane_hkl=(1, 0, 0),
            composition_hkl=(1, 1, 0),
            pointer="/twin",
        )
