"""What holds of every built-in entry, checked apart from the code that reads them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import pairwise

import numpy as np
import pytest
from pydantic import BaseModel
from scipy.spatial import ConvexHull

from crystal_core.geometry.lattice import face_normal
from minerals_db import Mineral
from minerals_db.fields import Entry, Known
from minerals_db.library import builtin_minerals
from minerals_db.schema import TWO_V_BOUND_DEG
from tests.minerals_db.crystal_classes import (
    GROUP_ORDERS,
    Real,
    basis_of,
    contains,
    faces,
    half_turn,
    mirror,
    operations,
)

MINERALS = builtin_minerals()
BIAXIAL = [key for key, mineral in MINERALS.items() if mineral.optical_class == "biaxial"]
CRYSTALS = [key for key, mineral in MINERALS.items() if mineral.system != "amorphous"]
ABSORBING = [key for key, mineral in MINERALS.items() if mineral.absorption is not None]
SODIUM_D_NM = 589.3
VISIBLE_NM = np.linspace(380.0, 780.0, 401)


# What there is


def kind_of(mineral: Mineral) -> str:
    return f"{mineral.optical_class} {mineral.optic_sign or ''}".strip()


def test_there_are_seventy() -> None:
    assert len(MINERALS) >= 70


@pytest.mark.parametrize(
    "kind",
    ["isotropic", "uniaxial positive", "uniaxial negative", "biaxial positive", "biaxial negative"],
)
def test_eight_of_each_kind(kind: str) -> None:
    assert sum(kind_of(mineral) == kind for mineral in MINERALS.values()) >= 8


def test_all_crystal_systems() -> None:
    systems = {"cubic", "tetragonal", "hexagonal", "trigonal", "orthorhombic", "monoclinic", "triclinic"}
    assert {mineral.system for mineral in MINERALS.values()} - {"amorphous"} == systems


COLOURED = [
    "ruby", "sapphire", "emerald", "aquamarine", "amethyst", "alexandrite", "tanzanite", "tanzanite-unheated",
    "peridot", "elbaite", "verdelite", "rubellite", "dravite", "schorl", "iolite", "cordierite", "andalusite",
    "kunzite", "epidote", "biotite", "hornblende", "kyanite", "spessartine", "tsavorite", "demantoid",
]  # fmt: skip


@pytest.mark.parametrize("key", COLOURED)
def test_minerals_known_for_their_colour_have_one(key: str) -> None:
    absorption = MINERALS[key].absorption
    assert absorption is not None
    strongest = max(float(absorption.per_mm(axis, VISIBLE_NM).max()) for axis in absorption.axes)
    assert strongest > 0.01, "a millimetre takes at least a hundredth of some light"


# Indices


def indices_in_order(mineral: Mineral, wavelength_nm: float = SODIUM_D_NM) -> list[float]:
    """Return n_α, n_β, n_γ of a biaxial mineral by what the entry calls α, β, γ."""
    if mineral.system == "orthorhombic":
        axes = [getattr(mineral.orientation, name) for name in ("alpha", "beta", "gamma")]
    else:
        axes = ["alpha", "beta", "gamma"]
    return [float(mineral.dispersion[axis].index(wavelength_nm)) for axis in axes]


@pytest.mark.parametrize("key", BIAXIAL)
def test_indices_rise_from_alpha_to_gamma(key: str) -> None:
    alpha, beta, gamma = indices_in_order(MINERALS[key])
    assert 1.0 < alpha <= beta <= gamma
    assert alpha < gamma


def two_v_gamma_deg(alpha: float, beta: float, gamma: float) -> float:
    """Return 2V_γ, degrees; E. E. Wahlstrom, Optical Crystallography (1979): cos² V_γ."""
    cosine2 = alpha**2 * (gamma**2 - beta**2) / (beta**2 * (gamma**2 - alpha**2))
    return float(2.0 * np.rad2deg(np.arccos(np.sqrt(min(max(cosine2, 0.0), 1.0)))))


@pytest.mark.parametrize("key", [key for key, mineral in MINERALS.items() if mineral.optic_sign is not None])
def test_sign_is_that_of_the_indices(key: str) -> None:
    mineral = MINERALS[key]
    if mineral.optical_class == "uniaxial":
        n_o, n_e = (float(mineral.dispersion[axis].index(SODIUM_D_NM)) for axis in "oe")
        positive = n_e > n_o
    else:
        positive = two_v_gamma_deg(*indices_in_order(mineral)) < 90.0
    assert positive == (mineral.optic_sign == "positive")


MEASURED_2V = [(key, number) for key in BIAXIAL for number in range(len(MINERALS[key].axial_angle))]


@pytest.mark.parametrize(("key", "number"), MEASURED_2V)
def test_measured_2v_agrees_or_the_entry_explains(key: str, number: int) -> None:
    mineral = MINERALS[key]
    measured = mineral.axial_angle[number]
    about_gamma = two_v_gamma_deg(*sorted(indices_in_order(mineral, measured.wavelength_nm or SODIUM_D_NM)))
    ours = about_gamma if measured.bisectrix == "gamma" else 180.0 - about_gamma
    lowest, highest = measured.two_v_deg
    outside = max(lowest - ours, ours - highest, 0.0)
    assert (outside > TWO_V_BOUND_DEG) == (measured.disagreement is not None), f"{ours:.2f}"


def test_2v_was_measured_of_many_biaxial_minerals() -> None:
    assert len({key for key, _ in MEASURED_2V}) >= 10


# Frames


@pytest.mark.parametrize("which", ["principal_axes", "absorption_axes"])
@pytest.mark.parametrize("key", MINERALS)
def test_frames_are_right_handed_and_allowed(key: str, which: str) -> None:
    mineral = MINERALS[key]
    for wavelength in (400.0, SODIUM_D_NM, 700.0):
        frame = getattr(mineral, which)(wavelength)
        assert frame.shape == (3, 3)
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(frame) > 0.0
        if mineral.optical_class != "biaxial":
            np.testing.assert_allclose(np.abs(frame[2]), (0.0, 0.0, 1.0), atol=1e-12)  # the optic axis, along c
        elif mineral.system == "orthorhombic":
            np.testing.assert_allclose(frame, np.eye(3), atol=1e-12)
        elif mineral.system == "monoclinic":
            along_b = np.abs(frame @ (0.0, 1.0, 0.0))
            np.testing.assert_allclose(np.sort(along_b), (0.0, 0.0, 1.0), atol=1e-12)


@pytest.mark.parametrize("key", CRYSTALS)
def test_tensors_have_the_symmetry_of_the_crystal(key: str) -> None:
    """Neumann's principle, by the matrices of the class: ε and the absorption are left as they are."""
    mineral = MINERALS[key]
    principal = [float(curve.index(SODIUM_D_NM)) for curve in mineral.dispersion.values()]
    tensors = [(mineral.principal_axes(SODIUM_D_NM), principal)]
    if mineral.absorption is not None:
        absorbed = [float(mineral.absorption.per_mm(axis, SODIUM_D_NM)) for axis in mineral.dispersion]
        tensors.append((mineral.absorption_axes(SODIUM_D_NM), absorbed))
    for frame, values in tensors:
        full = {1: [0, 0, 0], 2: [0, 0, 1], 3: [0, 1, 2]}[len(values)]
        tensor = frame.T @ np.diag([values[index] for index in full]) @ frame
        for matrix in operations(mineral):
            np.testing.assert_allclose(matrix @ tensor @ matrix.T, tensor, atol=1e-9 * (1.0 + max(values)))


# Absorption


@pytest.mark.parametrize("key", ABSORBING)
def test_absorption_is_never_negative(key: str) -> None:
    absorption = MINERALS[key].absorption
    assert absorption is not None
    for times in (0.0, 1.0, 4.0):
        amounts = {name: times * known.weight_percent for name, known in absorption.chromophores.items()}
        for axis in absorption.axes:
            coefficients = absorption.per_mm(axis, VISIBLE_NM, amounts)
            assert np.all(np.isfinite(coefficients))
            assert np.all(coefficients >= 0.0)


@pytest.mark.parametrize("key", [key for key in ABSORBING if MINERALS[key].absorption.chromophores])  # type: ignore[union-attr]
def test_four_times_the_chromophore_absorbs_more(key: str) -> None:
    absorption = MINERALS[key].absorption
    assert absorption is not None
    for name, known in absorption.chromophores.items():
        less, as_it_is, more = (
            sum(
                absorption.per_mm(axis, VISIBLE_NM, {name: times * known.weight_percent}).sum()
                for axis in absorption.axes
            )
            for times in (0.0, 1.0, 4.0)
        )
        assert 0.0 <= less < as_it_is < more


# Sources


def numbers_without_source(node: object, sources: Mapping[str, object], path: str, known: bool) -> Iterator[str]:
    """Yield the places of numbers that stand in no record, nor in a part of one, which has a source and a status."""
    if isinstance(node, BaseModel):
        if isinstance(node, Known):
            if node.source not in sources:
                yield f"{path}.source"
            known = bool(node.status)
        for field in type(node).model_fields:
            yield from numbers_without_source(getattr(node, field), sources, f"{path}.{field}", known)
    elif isinstance(node, Mapping):
        for field, child in node.items():
            yield from numbers_without_source(child, sources, f"{path}.{field}", known)
    elif isinstance(node, tuple | list):
        for number, child in enumerate(node):
            yield from numbers_without_source(child, sources, f"{path}.{number}", known)
    elif isinstance(node, int | float) and not isinstance(node, bool) and not known:
        yield path


@pytest.mark.parametrize("key", MINERALS)
def test_every_number_has_source_and_status(key: str) -> None:
    mineral = MINERALS[key]
    assert list(numbers_without_source(mineral, mineral.sources, key, known=False)) == []


def test_a_number_without_source_is_found() -> None:
    class Sourced(Known):
        value: float

    class Record(Entry):
        bare: float
        inside: tuple[int, ...]
        sourced: Sourced

    sourced = Sourced(value=4.0, source="nobody", status="published", note=None)
    record = Record(bare=1.0, inside=(2, 3), sourced=sourced)
    found = list(numbers_without_source(record, {}, "it", known=False))
    assert found == ["it.bare", "it.inside.0", "it.inside.1", "it.sourced.source"]


# What the committed files may not speak of: how a number was reached is no source, and nothing is left to be done.
HOW_IT_WAS_REACHED = re.compile(r"\bstored page\b|\bTODO\b|\bCHECK\b|\bOCR\b|\bindex id\b")


@pytest.mark.parametrize("key", MINERALS)
def test_sources_are_primary(key: str) -> None:
    for name, source in MINERALS[key].sources.items():
        assert len(source.citation) > 10, name
    assert HOW_IT_WAS_REACHED.search(MINERALS[key].model_dump_json()) is None


# Shapes


@pytest.mark.parametrize("key", CRYSTALS)
def test_the_space_group_belongs_to_the_class(key: str) -> None:
    mineral = MINERALS[key]
    group = operations(mineral)
    assert len(group) == GROUP_ORDERS[str(mineral.point_group)]
    centred = contains(group, -np.eye(3))
    assert centred == (mineral.point_group in CENTROSYMMETRIC)
    turns_only = bool(np.all(np.linalg.det(group) > 0.0))
    assert turns_only == ("m" not in str(mineral.point_group) and "-" not in str(mineral.point_group))


CENTROSYMMETRIC = {"-1", "2/m", "mmm", "4/m", "4/mmm", "-3", "-3m", "6/m", "6/mmm", "m-3", "m-3m"}


def form(mineral: Mineral, hkl: tuple[int, int, int]) -> Real:
    """Return the normals of the faces that the class makes of one."""
    assert mineral.cell is not None
    return faces(operations(mineral), face_normal(basis_of(mineral.cell), hkl))


HABITS = [(key, number) for key in CRYSTALS for number in range(len(MINERALS[key].habits))]


@pytest.mark.parametrize(("key", "number"), HABITS, ids=[f"{key}-{MINERALS[key].habits[n].name}" for key, n in HABITS])
def test_habits_close_and_show_every_form(key: str, number: int) -> None:
    mineral = MINERALS[key]
    habit = mineral.habits[number]
    # Faces are the corners of the dual body, points n/d; the crystal is closed if that body holds the centre.
    points, owners = [], []
    for place, one in enumerate(habit.forms):
        normals = form(mineral, one.hkl)
        points.append(normals / one.central_distance)
        owners += [place] * len(normals)
    every = np.concatenate(points)
    assert np.linalg.matrix_rank(every) == 3, "the faces are all parallel to one line"
    hull = ConvexHull(every)
    assert np.all(hull.equations[:, 3] < -1e-6), "the faces do not close"
    shown = {owners[corner] for corner in hull.vertices}
    hidden = [one.hkl for place, one in enumerate(habit.forms) if place not in shown]
    assert hidden == [], "too far out to cut anything off"


def test_most_minerals_have_a_habit() -> None:
    assert len({key for key, _ in HABITS}) >= 25


# Angles between normals of faces, degrees, of the textbooks: they hold cell, setting and indices together.
INTERFACIAL = [
    ("quartz", (1, 0, 0), (1, 0, 1), 38.21),
    ("quartz", (1, 0, 1), (0, 1, 1), 46.27),
    ("calcite", (1, 0, 4), (0, -1, 4), 74.92),
    ("beryl", (0, 0, 1), (1, 0, 2), 29.95),
    ("topaz", (1, 1, 0), (1, -1, 0), 55.7),
    ("augite", (1, 1, 0), (1, -1, 0), 92.7),
    ("albite", (0, 0, 1), (0, 1, 0), 86.4),
    ("fluorite", (1, 0, 0), (1, 1, 1), 54.74),
]


@pytest.mark.parametrize(("key", "first", "second", "angle_deg"), [row for row in INTERFACIAL if row[0] in MINERALS])
def test_interfacial_angles(
    key: str, first: tuple[int, int, int], second: tuple[int, int, int], angle_deg: float
) -> None:
    cell = MINERALS[key].cell
    assert cell is not None
    a, b = (face_normal(basis_of(cell), hkl) for hkl in (first, second))
    found = np.rad2deg(np.arccos(a @ b))
    assert min(abs(found - angle_deg), abs(180.0 - found - angle_deg)) < 0.6, f"{found:.2f}"


def test_calcite_cleaves_into_a_rhomb() -> None:
    calcite = MINERALS["calcite"]
    normals = form(calcite, calcite.cleavage[0].hkl)
    assert len(normals) == 6
    cosines = np.abs(normals @ normals.T)
    np.testing.assert_allclose(np.rad2deg(np.arccos(cosines[cosines < 0.99])), 74.92, atol=0.1)


TWINS = [(key, number) for key in CRYSTALS for number in range(len(MINERALS[key].twinning))]


@pytest.mark.parametrize(("key", "number"), TWINS)
def test_no_twin_law_is_a_symmetry_of_the_crystal(key: str, number: int) -> None:
    mineral = MINERALS[key]
    assert mineral.cell is not None
    basis, twin = basis_of(mineral.cell), mineral.twinning[number]
    if twin.plane_hkl is not None:
        operation = mirror(face_normal(basis, twin.plane_hkl))
    else:
        along = np.asarray(twin.axis_uvw) @ basis
        operation = half_turn(along / np.linalg.norm(along))
    assert not contains(operations(mineral), operation), f"{twin.law}: it would leave the crystal as it is"


@pytest.mark.parametrize("key", CRYSTALS)
def test_cleavages_are_named_once(key: str) -> None:
    mineral = MINERALS[key]
    if len(mineral.cleavage) < 2:
        return
    forms = [{tuple(np.round(normal, 4) + 0.0) for normal in form(mineral, one.hkl)} for one in mineral.cleavage]
    assert all(not first & second for first, second in pairwise(forms))


# Names


def test_no_name_is_used_twice() -> None:
    for language in ("en", "ru"):
        count = Counter(getattr(mineral.names, language) for mineral in MINERALS.values())
        assert [name for name, times in count.items() if times > 1] == []
