"""Energy, reciprocity, limits, and mutants of stacks of plates."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crystal_core.optics import beams, berreman, plates
from crystal_core.optics.arrays import Complex, Field
from crystal_core.optics.interface import scatter
from crystal_core.optics.layer_waves import phase_matrix, split
from crystal_core.optics.medium import Medium
from crystal_core.optics.mueller import reversed_mueller
from crystal_core.optics.plates import Coherence, Plate, plate_stack
from crystal_core.optics.slices import sliced_plate
from tests.optics.plate_cases import random_medium, random_stack, turned

MODES: tuple[Coherence, ...] = ("exact", "single-pass", "incoherent")
WAVELENGTHS = np.array((404.7, 546.1, 589.3, 706.5))
TURN_OVER = np.diag((1.0, -1.0, -1.0))


def random_incidence(rng: np.random.Generator) -> tuple[float, np.ndarray]:
    mount = float(rng.uniform(1.0, 2.4))
    kappa, azimuth = mount * rng.uniform(0, 0.999), rng.uniform(0, 2 * np.pi)
    return mount, np.array((kappa * np.cos(azimuth), kappa * np.sin(azimuth), 0.0))


@pytest.mark.parametrize("coherent", MODES)
@given(seed=st.integers(0, 2**32 - 1), active=st.booleans())
@settings(max_examples=60, deadline=None)
def test_energy_is_kept_without_absorption(coherent: Coherence, seed: int, active: bool) -> None:
    """Up to total reflection, inhibited reflection and frustrated total reflection, for any polarization."""
    rng = np.random.default_rng(seed)
    stack = random_stack(rng, int(rng.integers(1, 4)), 30.0, gyration=3e-3 * active)
    mount, kt = random_incidence(rng)
    optics = plate_stack(stack, WAVELENGTHS, mount, kt, coherent)
    total = optics.mueller_transmitted[0] + optics.mueller_reflected[0]
    np.testing.assert_allclose(total, np.array((1.0, 0, 0, 0))[:, None] * np.ones(4), atol=1e-12)


@pytest.mark.parametrize("coherent", MODES)
@given(seed=st.integers(0, 2**32 - 1), strong=st.booleans())
@settings(max_examples=60, deadline=None)
def test_absorbers_never_give_light(coherent: Coherence, seed: int, strong: bool) -> None:
    rng = np.random.default_rng(seed)
    stack = random_stack(rng, int(rng.integers(1, 4)), 30.0, absorption=3000.0 if strong else 30.0)
    mount, kt = random_incidence(rng)
    optics = plate_stack(stack, WAVELENGTHS, mount, kt, coherent)
    total = optics.mueller_transmitted[0] + optics.mueller_reflected[0]
    # The most that any polarization gets back: S0 of the brightest.
    assert (total[0] + np.sqrt((total[1:] ** 2).sum(axis=0))).max() <= 1 + 1e-12


@pytest.mark.parametrize("coherent", MODES)
@given(seed=st.integers(0, 2**32 - 1), absorption=st.sampled_from((0.0, 30.0, 1000.0)), active=st.booleans())
@settings(max_examples=60, deadline=None)
def test_reciprocity(coherent: Coherence, seed: int, absorption: float, active: bool) -> None:
    """M_b = O Mᵀ O of light sent back: the stack turned over about x, its order reversed, k reversed."""
    rng = np.random.default_rng(seed)
    stack = random_stack(rng, int(rng.integers(1, 4)), 30.0, absorption, 3e-3 * active)
    mount, kt = random_incidence(rng)
    forth = plate_stack(stack, WAVELENGTHS, mount, kt, coherent)
    back = plate_stack(turned(stack[::-1], TURN_OVER), WAVELENGTHS, mount, TURN_OVER @ -kt, coherent)
    np.testing.assert_allclose(back.mueller_transmitted, reversed_mueller(forth.mueller_transmitted), atol=2e-11)
    # Reflection from one side is its own reverse: k reversed sends the reflected light home.
    mirrored = plate_stack(stack, WAVELENGTHS, mount, -kt, coherent)
    np.testing.assert_allclose(mirrored.mueller_reflected, reversed_mueller(forth.mueller_reflected), atol=2e-11)


def test_reciprocity_needs_the_reversal_of_s2() -> None:
    rng = np.random.default_rng(5)
    differences = []
    for _ in range(50):
        stack = random_stack(rng, 2, 30.0)
        mount, kt = random_incidence(rng)
        forth = plate_stack(stack, WAVELENGTHS, mount, kt).mueller_transmitted
        back = plate_stack(turned(stack[::-1], TURN_OVER), WAVELENGTHS, mount, TURN_OVER @ -kt).mueller_transmitted
        differences.append(np.abs(back - np.swapaxes(forth, 0, 1)).max())
    assert np.median(differences) > 0.1


def modes_by_interfaces(stack: list[Plate], wavelength: float, mount: float, kt: np.ndarray) -> Complex:
    """The direct path from the solver of single faces: t_n P_n … P_1 t_0 between fields, with phases k0 k_z d."""
    air = Medium.isotropic(mount)
    column, normal = kt[:, None], np.array((0.0, 0.0, 1.0))
    media = [air, *(plate.medium for plate in stack), air]
    arriving = None
    jones = np.eye(2, dtype=complex)
    for place, (source, target) in enumerate(pairwise(media)):
        face = scatter(normal, column, source, target)
        if arriving is None:  # from (p, s) to the solver's s, p
            assert [str(w.mode[0]) for w in face.incident] == ["s", "p"]
            first_frame = [face.incident[1].field[:, 0], face.incident[0].field[:, 0]]
            jones = np.array(((0, 1), (1, 0)), complex)
        else:
            links = [np.vdot(w.field[:, 0], a) for w, a in zip(face.incident, arriving, strict=True)]
            np.testing.assert_allclose(np.abs(links), 1.0, atol=1e-9)
            jones = np.diag(links) @ jones
        t = np.array([[face.amplitude_transmitted[i][j][0] for j in (0, 1)] for i in (0, 1)])
        jones = t @ jones
        arriving = [w.field[:, 0] for w in face.transmitted]
        if place < len(stack):
            k0d = 2e3 * np.pi * stack[place].thickness_um / wavelength
            jones = np.diag([np.exp(1j * k0d * w.k[2, 0]) for w in face.transmitted]) @ jones
    assert arriving is not None
    last = np.array([[np.vdot(frame, a) for a in arriving] for frame in first_frame])
    return np.asarray(last @ jones)


def test_single_pass_is_the_product_of_faces_and_phases() -> None:
    """Against the solver of single faces, which knows nothing of Berreman's matrix."""
    rng = np.random.default_rng(11)
    compared = 0
    for _ in range(60):
        stack = random_stack(rng, int(rng.integers(1, 4)), 30.0)
        mount = float(rng.uniform(1.0, 1.3))  # below all indices: every wave propagates
        azimuth = rng.uniform(0, 2 * np.pi)
        kt = rng.uniform(0.05, 0.99) * mount * np.array((np.cos(azimuth), np.sin(azimuth), 0.0))
        ours = plate_stack(stack, [546.1], mount, kt, "single-pass").jones_transmitted
        assert ours is not None
        np.testing.assert_allclose(ours[:, :, 0], modes_by_interfaces(stack, 546.1, mount, kt), atol=1e-10)
        compared += 1
    assert compared == 60


def test_single_pass_energy_is_the_direct_path_and_more() -> None:
    """Of one plate: all light = the direct path plus what comes after two reflections or more, so a little more."""
    plate = [Plate(Medium.uniaxial(1.5442, 1.5533, (0.6, 0.8, 0.0)), 30.0)]
    optics = plate_stack(plate, WAVELENGTHS, 1.0, coherent="single-pass")
    assert optics.jones_transmitted is not None
    direct = 0.5 * (np.abs(optics.jones_transmitted) ** 2).sum(axis=(0, 1))
    more = optics.mueller_transmitted[0, 0] - direct
    r2 = ((1.5488 - 1) / (1.5488 + 1)) ** 2
    np.testing.assert_allclose(more, (1 - r2) ** 2 * r2**2 / (1 - r2**2), rtol=0.02)


def averaged_over_phases(medium: Medium, coherent: Coherence, unit_nm: float, absorption_um: float) -> np.ndarray:
    """Mueller matrix averaged over thicknesses that run through all phases of both waves, each pair equally often."""
    steps = 1024
    total = np.zeros((4, 4))
    for step in range(steps):
        thickness = absorption_um + unit_nm * 1e-3 * (step + 0.5) / steps
        total += plate_stack([Plate(medium, thickness)], [500.0], 1.0, coherent=coherent).mueller_transmitted[:, :, 0]
    return total / steps


def test_exact_averaged_over_thickness_is_the_incoherent_sum() -> None:
    """n = 1.5 and 1.6 at 500 nm: over 5 µm the waves gain 15 and 16 periods, so the pair goes through all phases."""
    medium = Medium.uniaxial(1.5, 1.6, (0.6, 0.8, 0.0))
    exact = averaged_over_phases(medium, "exact", 5000.0, 20.0)
    incoherent = plate_stack([Plate(medium, 20.0)], [500.0], coherent="incoherent").mueller_transmitted[:, :, 0]
    single = plate_stack([Plate(medium, 20.0)], [500.0], coherent="single-pass").mueller_transmitted[:, :, 0]
    np.testing.assert_allclose(exact, incoherent, atol=1e-11)
    assert np.abs(exact - single).max() > 0.1


def test_single_pass_is_exact_in_a_matched_mount() -> None:
    """No faces to speak of: strong dichroism on axes of its own, near an optic axis and away from it."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        medium = Medium.biaxial((1.6, 1.6 + 1e-5, 1.6 + 3e-5), turn).absorbing((3.0, 40.0, 90.0), turn[::-1])
        exact = plate_stack([Plate(medium, 30.0)], WAVELENGTHS, 1.6, (0.5, 0.2, 0.0)).mueller_transmitted
        single = plate_stack(
            [Plate(medium, 30.0)], WAVELENGTHS, 1.6, (0.5, 0.2, 0.0), "single-pass"
        ).mueller_transmitted
        np.testing.assert_allclose(single, exact, atol=1e-4)
        assert exact[0, 0].max() < 0.95


def test_slices_agree_with_waves() -> None:
    """Two ways that share nothing but Berreman's matrix: thin slices put together, and the four waves."""
    rng = np.random.default_rng(7)
    for absorption in (0.0, 300.0):
        for _ in range(30):
            plate = Plate(random_medium(rng, "biaxial", absorption, 1e-3), float(rng.uniform(0.5, 10.0)))
            mount, kt = random_incidence(rng)
            incidence = plates._incidence(WAVELENGTHS, mount, kt)
            slab = sliced_plate(incidence.matrix(plate), incidence.phase(plate), incidence.mount)
            optics = plate_stack([plate], WAVELENGTHS, mount, kt)
            np.testing.assert_allclose(np.moveaxis(slab.t, 0, 2), optics.jones_transmitted, atol=1e-11)
            np.testing.assert_allclose(np.moveaxis(slab.r, 0, 2), optics.jones_reflected, atol=1e-11)


@pytest.mark.parametrize("coherent", MODES)
@pytest.mark.parametrize("off", [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, -1e-15, -1e-12, -1e-9, -1e-7, -1e-5])
def test_nothing_happens_at_critical_incidence(coherent: Coherence, off: float) -> None:
    """A wave of each plate grazes: no NaN, no warning, no lost energy, no jump (exact)."""
    axis = np.array((0.0, 0.0, 1.0))
    for medium, kappa in (
        (Medium.isotropic(1.2), 1.2),
        (Medium.uniaxial(1.2, 1.3, axis), 1.2),
        (Medium.uniaxial(1.2, 1.3, axis), 1.3),
        (Medium.biaxial((1.2, 1.25, 1.3), np.eye(3)), 1.25),
    ):
        stack = [Plate(Medium.isotropic(1.6), 3.0), Plate(medium, 1.5), Plate(Medium.isotropic(1.7), 2.0)]
        optics = plate_stack(stack, WAVELENGTHS, 1.5, (kappa * (1 + off), 0.0, 0.0), coherent)
        total = optics.mueller_transmitted[0] + optics.mueller_reflected[0]
        np.testing.assert_allclose(total[0], 1.0, atol=1e-12)
        if coherent == "exact":
            beside = plate_stack(stack, WAVELENGTHS, 1.5, (kappa * (1 + off + 1e-4), 0.0, 0.0))
            np.testing.assert_allclose(beside.mueller_transmitted, optics.mueller_transmitted, atol=0.02)
        hazy = [Plate(p.medium.absorbing((1.0, 2.0, 30.0), np.eye(3)), p.thickness_um) for p in stack]
        optics = plate_stack(hazy, WAVELENGTHS, 1.5, (kappa * (1 + off), 0.0, 0.0), coherent)
        total = optics.mueller_transmitted[0] + optics.mueller_reflected[0]
        assert np.all(total[0] + np.sqrt((total[1:] ** 2).sum(axis=0)) <= 1 + 1e-12)
        assert np.all(total[0] > 0.5)


@pytest.mark.parametrize("coherent", ["exact", "single-pass"])
@pytest.mark.parametrize("kappa", [0.0, 0.8, 1.45, 1.55])
def test_the_isotropic_limit_has_no_jumps(coherent: Coherence, kappa: float) -> None:
    """n_e → n_o and three indices → one, total reflection included; also a hair off normal incidence."""
    axis = np.array((0.48, 0.6, 0.64))
    turn = np.array(((0.6, 0.8, 0.0), (-0.48, 0.36, 0.8), (0.64, -0.48, 0.6)))
    kt = (kappa, 0.0, 0.0)
    limit = plate_stack([Plate(Medium.isotropic(1.5), 3.0)], WAVELENGTHS, 1.6, kt, coherent)
    for split_ in (0.0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8):
        for medium in (
            Medium.uniaxial(1.5, 1.5 * (1 + split_), axis),
            Medium.biaxial((1.5, 1.5 * (1 + split_), 1.5 * (1 - split_)), turn),
        ):
            near = plate_stack([Plate(medium, 3.0)], WAVELENGTHS, 1.6, kt, coherent)
            bound = 1e-11 + 1e3 * split_
            np.testing.assert_allclose(near.mueller_transmitted, limit.mueller_transmitted, atol=bound)
            np.testing.assert_allclose(near.mueller_reflected, limit.mueller_reflected, atol=bound)


def test_a_hair_off_normal_incidence_is_normal_incidence() -> None:
    medium = Medium.biaxial((1.5, 1.6, 1.7), np.eye(3), (10.0, 20.0, 30.0))
    for coherent in MODES:
        normal = plate_stack([Plate(medium, 3.0)], WAVELENGTHS, 1.6, None, coherent)
        for hair in (1e-300, 1e-16, 1e-14, 1e-11):
            beside = plate_stack([Plate(medium, 3.0)], WAVELENGTHS, 1.6, (hair, 0.0, 0.0), coherent)
            np.testing.assert_allclose(beside.mueller_transmitted, normal.mueller_transmitted, atol=1e-9)
            np.testing.assert_allclose(beside.mueller_reflected, normal.mueller_reflected, atol=1e-9)


def test_a_matrix_with_one_eigenvector_travels() -> None:
    """exp(i s [[1, 1], [0, 1]]) = exp(i s) (1 + i s N): a singular axis of an absorbing crystal."""
    q = np.array([[[1.0, 1.0], [0.0, 1.0]]], complex)
    got = phase_matrix(q, np.array((3.0,)), lossless=False)[0]
    np.testing.assert_allclose(got, np.exp(3j) * np.array(((1, 3j), (0, 1))), atol=1e-14)
    near = phase_matrix(q + np.array([[[0, 0], [1e-10, 0]]]), np.array((3.0,)), lossless=False)[0]
    np.testing.assert_allclose(near, got, atol=1e-9)


def singular_axis_jones() -> tuple[Complex, Complex]:
    """The exact plate in the singular direction of an absorbing crystal, by waves and by slices."""
    # ε_t = ε + [[a, i b], [i b, −a]] with a = b: one eigenvector (1, i) only.
    b = 0.01
    k0 = 2e6 * np.pi / 546.1
    n = 1.6
    medium = Medium.biaxial((np.sqrt(n**2 + b), np.sqrt(n**2 - b), n), np.eye(3))
    # ε″ with principal axes at 45° and an off-diagonal part b: b (1 ± 1)
    diagonal = np.array(((1, 1, 0), (1, -1, 0), (0, 0, np.sqrt(2)))) / np.sqrt(2)
    along = 1 / np.sqrt(0.5 / (n**2 + b) + 0.5 / (n**2 - b))
    medium = medium.absorbing((2 * b * k0 / along, 0.0, 0.0), diagonal)
    plate = Plate(medium, 5.0)
    incidence = plates._incidence([546.1], 1.0, None)
    layer = split(incidence.matrix(plate))
    gap = abs(layer.forward.q[0, 0] - layer.forward.q[0, 1])
    assert gap < 1e-7  # it is the singular axis, to the √rounding that eigenvalues have there
    slab = sliced_plate(incidence.matrix(plate), incidence.phase(plate), incidence.mount)
    optics = plate_stack([plate], [546.1])
    assert optics.jones_transmitted is not None
    return optics.jones_transmitted[:, :, 0], slab.t[0]


def test_singular_axis_of_an_absorbing_crystal() -> None:
    by_waves, by_slices = singular_axis_jones()
    np.testing.assert_allclose(by_waves, by_slices, atol=1e-12)
    # Left and right circular light are not the same there: Voigt's phenomenon.
    circular = np.abs(by_waves @ np.array((1, 1j))) ** 2, np.abs(by_waves @ np.array((1, -1j))) ** 2
    assert abs(circular[0].sum() - circular[1].sum()) > 0.1


# Mutants: a wrong variant of the physics must not pass the check beside it.


def check_loss() -> None:
    plate = Plate(Medium.isotropic(1.5, 20.0), 50.0)
    for coherent in MODES:
        got = plate_stack([plate], WAVELENGTHS, 1.5, coherent=coherent).mueller_transmitted[0, 0]
        np.testing.assert_allclose(got, np.exp(-1.0), rtol=1e-5)


def check_oblique_phase() -> None:
    """An index-matched plate at κ = 0.9: phase k0 d √(n² − κ²)."""
    for coherent in ("exact", "single-pass"):
        got = plate_stack([Plate(Medium.isotropic(1.5), 7.0)], WAVELENGTHS, 1.5, (0.9, 0, 0), coherent)
        assert got.jones_transmitted is not None
        expected = np.exp(2e3j * np.pi * 7.0 / WAVELENGTHS * 1.2)
        np.testing.assert_allclose(got.jones_transmitted[1, 1], expected, atol=1e-10)


def conjugated(original: Callable[[Medium], Field]) -> Callable[[Medium], Field]:
    return lambda medium: -original(medium)


def test_mutant_conjugated_absorption_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    check_loss()
    monkeypatch.setattr(berreman, "dissipation", conjugated(berreman.dissipation))
    with pytest.raises(AssertionError):
        check_loss()


@pytest.mark.parametrize("where", ["exact", "single-pass"])
def test_mutant_index_times_length_of_the_ray_is_caught(monkeypatch: pytest.MonkeyPatch, where: str) -> None:
    check_oblique_phase()
    if where == "exact":

        def along_ray(q_matrix: Complex, phase: Field, lossless: bool) -> Complex:
            return phase_matrix(1.5**2 * np.linalg.inv(q_matrix), phase, lossless)

        monkeypatch.setattr(plates, "phase_matrix", along_ray)
    else:
        original = beams.carried

        def carried(*arguments: object) -> tuple[Complex, Complex, np.ndarray]:
            q, psi, carries = original(*arguments)  # type: ignore[arg-type]
            return 1.5**2 / q, psi, carries

        monkeypatch.setattr(beams, "carried", carried)
    with pytest.raises(AssertionError):
        check_oblique_phase()
