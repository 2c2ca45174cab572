"""Paths through crystals and glass, met from either end, with what they do to polarization; from `scatter` alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics import Medium, scatter, transverse_frame

__all__ = ["AIR", "Glass", "Paths", "across", "dot", "facing", "reversed_pair", "units"]

Real = NDArray[np.float64]
Array = NDArray[Any]

AIR = Medium.isotropic(1.0)


def dot(a: Array, b: Array) -> Array:
    """Return a·b over the first axis, without conjugation."""
    return np.asarray(np.sum(a * b, axis=0))


def units(rng: np.random.Generator, count: int) -> Real:
    """Return unit vectors in all directions alike, shape (3, count)."""
    v = rng.normal(size=(3, count))
    return np.asarray(v / np.sqrt(dot(v, v)))


def across(k: Real, normal: Real) -> Real:
    """Return the part of k in a face."""
    return np.asarray(k - dot(k, normal) * normal)


def facing(normal: Real, direction: Real) -> Real:
    """Return the normal on the side to which a direction goes."""
    return np.asarray(normal * np.sign(dot(normal, direction)))


class Paths:
    """Air → a mode of a crystal → reflected into a mode of it → air: crystals, faces and directions at random.

    Jones matrices are in (x, y, propagation), amplitudes normalised to equal flux, shape (N, 2, 2).
    """

    def __init__(self, seed: int, first: int, second: int, count: int = 4000) -> None:
        rng = np.random.default_rng(seed)
        crystal = Medium.uniaxial(rng.uniform(1.3, 2.0, count), rng.uniform(1.3, 2.0, count), units(rng, count))
        start = units(rng, count)
        faces = [facing(units(rng, count), start), units(rng, count), units(rng, count)]
        inside = scatter(faces[0], across(start, faces[0]), AIR, crystal).transmitted[first]
        faces[1] = facing(faces[1], inside.ray)
        turned = scatter(faces[1], across(inside.k, faces[1]), crystal, AIR).reflected[second]
        # Where the reflected mode is evanescent there is no path; any normal serves until it is sorted out.
        faces[2] = facing(faces[2], np.where(turned.propagating, turned.ray, faces[2]))
        out = scatter(faces[2], across(turned.k, faces[2]), crystal, AIR).transmitted[0]
        # Paths that leave, not too steeply for a digit: the accuracy is 1e-16 over the normal part of a wave vector.
        good = turned.propagating & out.propagating
        for k, z in (
            (start, faces[0]),
            (inside.k, faces[1]),
            (turned.k, faces[1]),
            (turned.k, faces[2]),
            (out.k, faces[2]),
        ):
            good &= np.abs(dot(k, z)) > 0.05
        keep = np.flatnonzero(good)
        self.crystal, self.start, self.end = crystal.take(keep), start[:, keep], out.k[:, keep]
        self.faces = [z[:, keep] for z in faces]
        self.modes = (first, second)

    def forward(self) -> tuple[Array, Real]:
        """Return the Jones matrices and the direction at the end."""
        return self._through(self.start, self.faces, self.modes)[:2]

    def backward(self) -> tuple[Array, Real]:
        """Return those of light that enters where the other left."""
        (entry, mirror, exit_), (first, second) = self.faces, self.modes
        return self._through(-self.end, [-exit_, mirror, -entry], (second, first))[:2]

    def rays(self) -> tuple[list[Real], list[Real]]:
        """Return the rays of both legs inside, and those of the backward path from its end."""
        (entry, mirror, exit_), (first, second) = self.faces, self.modes
        there = self._through(self.start, self.faces, self.modes)[2]
        return there, self._through(-self.end, [-exit_, mirror, -entry], (second, first))[2][::-1]

    def _through(self, direction: Real, faces: list[Real], modes: tuple[int, int]) -> tuple[Array, Real, list[Real]]:
        entry, mirror, exit_ = faces
        first, second = modes
        x, y = transverse_frame(direction)
        enters = scatter(entry, across(direction, entry), AIR, self.crystal)
        leg = enters.transmitted[first]
        row = sum(
            enters.amplitude_transmitted[first][j]
            * np.sqrt(leg.flux / wave.flux)
            * np.stack((dot(wave.field.conj(), x), dot(wave.field.conj(), y)))
            for j, wave in enumerate(enters.incident)
        )
        turns = scatter(facing(mirror, leg.ray), across(leg.k, mirror), self.crystal, AIR)
        arrives, goes = turns.incident[first], turns.reflected[second]
        amplitude = dot(arrives.field.conj(), leg.field)  # the same wave, perhaps with the other sign
        amplitude = amplitude * turns.amplitude_reflected[second][first] * np.sqrt(np.abs(goes.flux) / arrives.flux)
        leaves = scatter(exit_, across(goes.k, exit_), self.crystal, AIR)
        inner = leaves.incident[second]
        amplitude = amplitude * dot(inner.field.conj(), goes.field)
        end = leaves.transmitted[0].k
        u, v = transverse_frame(end)
        column = sum(
            leaves.amplitude_transmitted[i][second]
            * np.sqrt(wave.flux / inner.flux)
            * np.stack((dot(wave.field, u), dot(wave.field, v)))
            for i, wave in enumerate(leaves.transmitted)
        )
        return np.einsum("in,jn,n->nij", column, row, amplitude), end, [leg.ray, goes.ray]


@dataclass(frozen=True)
class Glass:
    """Glass → two total reflections in different planes → glass: elliptic polarization, from the phases."""

    seed: int = 5
    count: int = 4000

    def both(self) -> tuple[Array, Array, Real, Real]:
        """Return Jones matrices forward and backward, and the directions at the start and the end."""
        rng = np.random.default_rng(self.seed)
        glass = Medium.isotropic(1.5)
        start, first, second = units(rng, self.count), units(rng, self.count), units(rng, self.count)
        middle = start - 2 * dot(start, first) * first
        end = middle - 2 * dot(middle, second) * second
        total = np.ones(self.count, np.bool_)
        for d, z in ((start, first), (middle, second)):
            cosine = np.abs(dot(d, z))
            total &= (1.5 * np.sqrt(1 - cosine**2) > 1.0) & (cosine > 0.05)
        start, middle, end, first, second = (v[:, total] for v in (start, middle, end, first, second))
        forth = self._after(glass, middle, second) @ self._after(glass, start, first)
        back = self._after(glass, -middle, first) @ self._after(glass, -end, second)
        return forth, back, start, end

    @staticmethod
    def _after(glass: Medium, direction: Real, normal: Real) -> Array:
        """Return the Jones matrices of one reflection, between transverse frames."""
        z = facing(normal, direction)
        k = 1.5 * direction
        event = scatter(z, across(k, z), glass, AIR)
        new = direction - 2 * dot(direction, z) * z
        before, behind = np.stack(transverse_frame(direction)), np.stack(transverse_frame(new))
        matrix = sum(
            event.amplitude_reflected[i][i]
            * np.einsum("acn,cn->an", behind, event.reflected[i].field)[:, None]
            * np.einsum("acn,cn->an", before, event.incident[i].field.conj())[None, :]
            for i in (0, 1)
        )
        return np.asarray(np.moveaxis(matrix, -1, 0))


def axes_of_light(jones: Array, start: Real, end: Real) -> Array:
    """Return backward Jones matrices in the frames of the forward light: x, y of −d become those of d at both ends."""

    def turn(d: Real) -> Array:
        return np.moveaxis(np.array([[dot(a, b) for b in transverse_frame(-d)] for a in transverse_frame(d)]), -1, 0)

    return np.asarray(turn(start) @ jones @ np.swapaxes(turn(end), 1, 2))


def reversed_pair(paths: Paths | Glass) -> tuple[Array, Array]:
    """Return J forward and J backward, written with the same axes for the field."""
    if isinstance(paths, Glass):
        forth, back, start, end = paths.both()
    else:
        forth, end = paths.forward()
        back, home = paths.backward()
        start = paths.start
        np.testing.assert_allclose(home, -start, atol=1e-12)
    assert len(forth) > 500
    return forth, axes_of_light(back, start, end)
