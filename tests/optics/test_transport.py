"""Polarization carried along a path, forward and backward: C → J C J† against W → J† W J."""

import numpy as np
import pytest

from crystal_core.optics import Coherency, Medium, interface_frame, transverse_frame
from crystal_core.optics.interface import Face, solve_face
from crystal_core.optics.modes import FramedMedium

AIR = Medium.isotropic(1.0)
COUNT = 500


def _unit(rng: np.random.Generator, count: int) -> np.ndarray:
    v = rng.normal(size=(3, count))
    return v / np.sqrt(np.sum(v * v, axis=0))


def _hermitian(rng: np.random.Generator, count: int) -> tuple[Coherency, np.ndarray]:
    """Return random coherency matrices, ours and as (N, 2, 2)."""
    a = rng.normal(size=(count, 2, 2)) + 1j * rng.normal(size=(count, 2, 2))
    c = a @ np.conj(np.swapaxes(a, 1, 2))
    return Coherency(c[:, 0, 0].real, c[:, 1, 1].real, c[:, 0, 1].real, c[:, 0, 1].imag), c


def _matrix(c: Coherency) -> np.ndarray:
    xy = c.xy_re + 1j * c.xy_im
    return np.moveaxis(np.array(((c.xx, xy), (np.conj(xy), c.yy))), -1, 0)


def test_transverse_frame_is_right_handed() -> None:
    d = _unit(np.random.default_rng(0), COUNT)
    d[:, :2] = np.array(((0.0, 0.0), (0.0, 0.0), (1.0, -1.0)))
    x, y = transverse_frame(d)
    np.testing.assert_allclose(np.cross(x.T, y.T).T, d, atol=4e-16)
    np.testing.assert_allclose(np.sum(x * x, axis=0), 1.0, atol=4e-16)


def test_rotation_is_that_of_the_field() -> None:
    rng = np.random.default_rng(1)
    c, matrix = _hermitian(rng, COUNT)
    angle = rng.uniform(0, 2 * np.pi, COUNT)
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.moveaxis(np.array(((cos, sin), (-sin, cos))), -1, 0)
    np.testing.assert_allclose(_matrix(c.rotated(cos, sin)), turn @ matrix @ np.swapaxes(turn, 1, 2), atol=1e-13)


def test_stokes_signs() -> None:
    one = np.ones(1)
    # E_y leads by a quarter period in exp(-iωt): the tip turns from y to -x ... seen by one who faces the source,
    # who has x on his left when y is up, S3 = 2 Im(E_x* E_y) > 0 is counter-clockwise.
    time = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    ex, ey = np.exp(-1j * time).real, (1j * np.exp(-1j * time)).real
    turned = np.sum(ex * np.roll(ey, -1) - ey * np.roll(ex, -1))  # > 0: from x to y, right-handed about propagation
    s = Coherency.pure(one + 0j, 1j * one, one).stokes()[:, 0]
    # Facing the source one looks against the propagation, and a right-handed turn about it is counter-clockwise.
    assert np.sign(s[3]) == np.sign(turned)
    np.testing.assert_allclose(Coherency.pure(one, 0 * one, one).stokes()[:, 0], (1, 1, 0, 0))
    np.testing.assert_allclose(Coherency.pure(one, one, 0.5 * one).stokes()[:, 0], (1, 0, 1, 0))


def test_power_into_is_the_quadratic_form() -> None:
    rng = np.random.default_rng(2)
    c, matrix = _hermitian(rng, COUNT)
    j = rng.normal(size=(2, COUNT)) + 1j * rng.normal(size=(2, COUNT))
    expected = np.einsum("in,nij,jn->n", j, matrix, np.conj(j)).real
    np.testing.assert_allclose(c.power_into(j[0], j[1]), expected, rtol=1e-12)


def _jones(face: Face, source: int) -> np.ndarray:
    """Return flux-normalised amplitudes (N, 2, 2) into the two transmitted modes; source ±1 unused sign kept real."""
    del source
    columns = []
    for j in (0, 1):
        t = face.transmission(j)
        flux = face.incident[j].flux()
        columns.append([t[i] * np.sqrt(face.transmitted[i].flux() / flux) for i in (0, 1)])
    return np.moveaxis(np.array(columns), -1, 0).swapaxes(1, 2)


def _crystal(rng: np.random.Generator) -> Medium:
    return Medium.uniaxial(rng.uniform(1.3, 2.0, COUNT), rng.uniform(1.3, 2.0, COUNT), _unit(rng, COUNT))


def _entry_and_exit(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return J into a crystal and J of the reversed path out of it, for random crystals and directions."""
    rng = np.random.default_rng(seed)
    crystal, z = _crystal(rng), _unit(rng, COUNT)
    d = _unit(rng, COUNT)
    d = d * np.sign(np.sum(d * z, axis=0))
    kt = d - np.sum(d * z, axis=0) * z
    forward = solve_face(
        FramedMedium(AIR, interface_frame(z, kt)), FramedMedium(crystal, interface_frame(z, kt)), False, False
    )
    # The reversed path: the waves -k come from the crystal; the frame's z and x turn round, y = z × x stays.
    back = interface_frame(-z, -kt)
    backward = solve_face(FramedMedium(crystal, back), FramedMedium(AIR, back), False, False)
    return _jones(forward, 1), _jones(backward, -1)


def test_reciprocity_of_an_entry() -> None:
    """J of the reversed path is the transpose, up to the sign with which each mode's field is written."""
    forward, backward = _entry_and_exit(3)
    np.testing.assert_allclose(np.abs(backward), np.abs(np.swapaxes(forward, 1, 2)), atol=1e-12)
    # Signs: products around a loop of two entries and two exits are free of them.
    loop_f = forward[:, 0, 0] * forward[:, 1, 1] * np.conj(forward[:, 0, 1] * forward[:, 1, 0])
    loop_b = backward[:, 0, 0] * backward[:, 1, 1] * np.conj(backward[:, 1, 0] * backward[:, 0, 1])
    np.testing.assert_allclose(loop_b, loop_f, atol=1e-12)


def test_a_path_gives_the_same_number_from_either_end() -> None:
    """tr(W · J C J†) = tr(J† W J · C), J a whole path: in, total reflection with o-e conversion, out."""
    rng = np.random.default_rng(4)
    _, c = _hermitian(rng, COUNT)
    _, w = _hermitian(rng, COUNT)
    path = rng.normal(size=(COUNT, 2, 2)) + 1j * rng.normal(size=(COUNT, 2, 2))
    adjoint = np.conj(np.swapaxes(path, 1, 2))
    forward = np.trace(w @ path @ c @ adjoint, axis1=1, axis2=2)
    # The renderer's way: conj(W) is carried by the transposed Jones matrix, as light would be.
    carried = np.swapaxes(path, 1, 2) @ np.conj(w) @ np.conj(path)
    backward = np.trace(np.conj(carried) @ c, axis1=1, axis2=2)
    np.testing.assert_allclose(backward, forward, rtol=1e-11)


def test_left_multiplication_would_be_caught() -> None:
    """The mutant W → J W J† differs by far more than any tolerance used here."""
    rng = np.random.default_rng(5)
    _, w = _hermitian(rng, COUNT)
    forward, _ = _entry_and_exit(6)
    right = np.conj(np.swapaxes(forward, 1, 2)) @ w @ forward
    wrong = forward @ w @ np.conj(np.swapaxes(forward, 1, 2))
    assert np.median(np.abs(right - wrong).max(axis=(1, 2)) / np.abs(right).max(axis=(1, 2))) > 0.1


@pytest.mark.parametrize("seed", [7, 8])
def test_plane_of_incidence_round_trip(seed: int) -> None:
    rng = np.random.default_rng(seed)
    c, matrix = _hermitian(rng, COUNT)
    d = _unit(rng, COUNT)
    x = np.cross(d.T, _unit(rng, COUNT).T).T
    x /= np.sqrt(np.sum(x * x, axis=0))
    np.testing.assert_allclose(_matrix(c.to_transverse_frame(d, x).in_frame(d, x)), matrix, atol=1e-12)
