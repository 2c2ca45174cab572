"""Polarization carried along a path, forward and backward: C → J C J† against W → J† W J."""

import numpy as np
import pytest

from crystal_core.optics import Coherency, Medium, interface_frame, scatter, transverse_frame
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.interface import solve_face
from crystal_core.optics.mueller import measured
from tests.reference.media import random_frames

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
    """S3 > 0: the tip of E(t) turns from x to y, counter-clockwise to one who faces the source."""
    one = np.ones(1)
    circular = (one + 0j, 1j * one)
    time = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    ex, ey = ((component * np.exp(-1j * time)).real for component in circular)
    turns_from_x_to_y = np.sum(ex * np.roll(ey, -1) - ey * np.roll(ex, -1)) > 0
    assert turns_from_x_to_y
    np.testing.assert_allclose(Coherency.pure(*circular, one).stokes()[:, 0], (2, 0, 0, 2))
    np.testing.assert_allclose(Coherency.pure(one, 0 * one, one).stokes()[:, 0], (1, 1, 0, 0))
    np.testing.assert_allclose(Coherency.pure(one, one, 0.5 * one).stokes()[:, 0], (1, 0, 1, 0))


def test_power_into_is_the_quadratic_form() -> None:
    rng = np.random.default_rng(2)
    c, matrix = _hermitian(rng, COUNT)
    j = rng.normal(size=(2, COUNT)) + 1j * rng.normal(size=(2, COUNT))
    expected = np.einsum("in,nij,jn->n", j, matrix, np.conj(j)).real
    np.testing.assert_allclose(c.power_into(j[0], j[1]), expected, rtol=1e-12)


def _crystal(rng: np.random.Generator, kind: str) -> Medium:
    if kind == "uniaxial":
        return Medium.uniaxial(rng.uniform(1.3, 2.0, COUNT), rng.uniform(1.3, 2.0, COUNT), _unit(rng, COUNT))
    return Medium.biaxial(rng.uniform(1.3, 2.0, (3, COUNT)), random_frames(rng, COUNT))


def _facing(z: np.ndarray, v: np.ndarray) -> np.ndarray:
    return z * np.sign(np.sum(z * v, axis=0))


def _tangential(k: np.ndarray, z: np.ndarray) -> np.ndarray:
    return k - np.sum(k * z, axis=0) * z


class Path:
    """Air → one mode of a crystal → air, over random crystals, faces and directions, as the renderer goes it."""

    def __init__(self, seed: int, kind: str, mode: int) -> None:
        rng = np.random.default_rng(seed)
        self.mode = mode
        self.crystal = _crystal(rng, kind)
        self.d = _unit(rng, COUNT)
        self.z_in = _facing(_unit(rng, COUNT), self.d)
        wave = scatter(self.z_in, _tangential(self.d, self.z_in), AIR, self.crystal).transmitted[mode]
        self.k = wave.k
        # A face that the ray meets and that it can leave by: |k| < 2, so 0.2 rad or less from k lets it out.
        self.z_out = self.k + 0.2 * np.sqrt(np.sum(self.k**2, axis=0)) * _unit(rng, COUNT)
        self.z_out /= np.sqrt(np.sum(self.z_out**2, axis=0))

    def enter(self, d: np.ndarray, z: np.ndarray, c: Coherency) -> np.ndarray:
        """Return the power that enters the mode; c in (p, s, propagation)."""
        frame = interface_frame(z, _tangential(d, z))
        face = solve_face(framed(AIR, frame), framed(self.crystal, frame), False, False)
        power = c.power_into(face.transmission(1)[self.mode], face.transmission(0)[self.mode])
        return power * face.transmitted[self.mode].flux() / face.incident[0].flux()

    def leave(self, k: np.ndarray, z: np.ndarray, power: np.ndarray) -> Coherency:
        """Return what leaves, in (p, s, propagation)."""
        frame = interface_frame(z, _tangential(k, z))
        face = solve_face(framed(self.crystal, frame), framed(AIR, frame), False, False)
        s, p = face.transmission(self.mode)
        return Coherency.pure(p, s, power * face.transmitted[0].flux() / face.incident[self.mode].flux())

    def forward(self, c: Coherency) -> Coherency:
        return self.leave(self.k, self.z_out, self.enter(self.d, self.z_in, c))

    def backward(self, w: Coherency) -> Coherency:
        """Return J† W J, by carrying conj(W) along the reversed path as if it were light.

        Reversing a path turns the interface frame's x and z round: s stays, p changes sign, and so does C_xy.
        """
        d_out = interface_frame(self.z_out, _tangential(self.k, self.z_out))
        q = np.sqrt(1.0 - d_out.kappa**2)
        back = -(d_out.x * d_out.kappa + d_out.z * q)
        carried = Coherency(w.xx, w.yy, -w.xy_re, w.xy_im)  # conj, then the sign
        out = self.leave(-self.k, -self.z_in, self.enter(back, -self.z_out, carried))
        return Coherency(out.xx, out.yy, -out.xy_re, out.xy_im)


@pytest.mark.parametrize("kind", ["uniaxial", "biaxial"])
@pytest.mark.parametrize("mode", [0, 1])
def test_a_path_gives_the_same_number_from_either_end(kind: str, mode: int) -> None:
    """tr(W · J C J†) = tr(J† W J · C) with J from the code's own faces, met from either side."""
    rng = np.random.default_rng(4)
    path = Path(5, kind, mode)
    c, _ = _hermitian(rng, COUNT)
    w, _ = _hermitian(rng, COUNT)
    there, back = measured(w, path.forward(c)), measured(path.backward(w), c)
    assert there.min() > 0
    np.testing.assert_allclose(back, there, rtol=1e-10)


@pytest.mark.parametrize("kind", ["uniaxial", "biaxial"])
@pytest.mark.parametrize("mode", [0, 1])
def test_mutants_of_the_adjoint_are_caught(kind: str, mode: int) -> None:
    """The sign of p forgotten, and multiplication on the left."""
    rng = np.random.default_rng(6)
    path = Path(7, kind, mode)
    c, _ = _hermitian(rng, COUNT)
    w, _ = _hermitian(rng, COUNT)
    there = measured(w, path.forward(c))
    flipped = Coherency(w.xx, w.yy, -w.xy_re, w.xy_im)
    left = path.forward(w)  # J W J†: multiplied on the left
    for wrong in (path.backward(flipped), left):
        assert np.median(np.abs(measured(wrong, c) / there - 1.0)) > 0.03


@pytest.mark.parametrize("seed", [7, 8])
def test_plane_of_incidence_round_trip(seed: int) -> None:
    rng = np.random.default_rng(seed)
    c, matrix = _hermitian(rng, COUNT)
    d = _unit(rng, COUNT)
    x = np.cross(d.T, _unit(rng, COUNT).T).T
    x /= np.sqrt(np.sum(x * x, axis=0))
    np.testing.assert_allclose(_matrix(c.to_transverse_frame(d, x).in_frame(d, x)), matrix, atol=1e-12)
