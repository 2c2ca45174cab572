"""Random media of every optical class, as the project describes them and as the independent solver does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from crystal_core.optics import Medium
from tests.reference.arithmetic import Array
from tests.reference.berreman import tensor_biaxial, tensor_uniaxial

__all__ = ["KINDS", "Kind", "Media", "random_frames", "random_media", "random_units"]

Kind = Literal["isotropic", "uniaxial", "biaxial"]
KINDS: tuple[Kind, ...] = ("isotropic", "uniaxial", "biaxial")


@dataclass(frozen=True)
class Media:
    """One medium per case: principal indices (3, N) on directions ``axes[i]``, (3, 3, N); uniaxial: o, o, e."""

    kind: Kind
    indices: Array
    axes: Array

    def medium(self) -> Medium:
        if self.kind == "isotropic":
            return Medium.isotropic(self.indices[0])
        if self.kind == "uniaxial":
            return Medium.uniaxial(self.indices[0], self.indices[2], self.axes[2])
        return Medium.biaxial(list(self.indices), self.axes)

    def tensor(self, case: int, digits: int | None) -> Array:
        """Return eps (3, 3) of one case."""
        if self.kind == "biaxial":
            return tensor_biaxial(self.indices[:, case], self.axes[:, :, case].T, digits)
        n_o, _, n_e = self.indices[:, case].tolist()
        return tensor_uniaxial(n_o, n_e, self.axes[2, :, case], digits)

    def label_axis(self, case: int) -> Array | None:
        """Return the axis by which ordinary and extraordinary waves are told apart, if the medium has such waves."""
        return self.axes[2, :, case] if self.kind == "uniaxial" else None

    def optic_axes(self, case: int) -> list[Array]:
        """Return the optic axes of one case: none, one or two unit vectors."""
        if self.kind == "isotropic":
            return []
        if self.kind == "uniaxial":
            return [self.axes[2, :, case]]
        order = np.argsort(self.indices[:, case])
        a, b, c = self.indices[order, case] ** -2
        low, high = self.axes[order[0], :, case], self.axes[order[2], :, case]
        # at such an angle from the direction of the largest index the section of the indicatrix is a circle
        x, z = np.sqrt((a - b) / (a - c)), np.sqrt((b - c) / (a - c))
        return [z * high + x * low, z * high - x * low]

    @property
    def largest(self) -> Array:
        return np.asarray(self.indices.max(axis=0))

    def take(self, cases: Array) -> Media:
        return Media(self.kind, self.indices[:, cases], self.axes[:, :, cases])


def random_units(rng: np.random.Generator, count: int) -> Array:
    v = rng.standard_normal((3, count))
    return np.asarray(v / np.linalg.norm(v, axis=0))


def random_frames(rng: np.random.Generator, count: int) -> Array:
    """Return orthonormal frames of either handedness, (3, 3, N): [i] is the i-th direction."""
    q, r = np.linalg.qr(rng.standard_normal((count, 3, 3)))
    frames = q * np.sign(np.diagonal(r, axis1=1, axis2=2))[:, None, :]
    return np.asarray(np.ascontiguousarray(np.moveaxis(frames, 0, 2).swapaxes(0, 1)))


def random_media(rng: np.random.Generator, kind: Kind, count: int) -> Media:
    """Return media with indices from 1 to 2.6; half of the crystals as weakly birefringent as quartz or feldspar."""
    indices = rng.uniform(1.0, 2.6, (3, count))
    weak = rng.random(count) < 0.5
    indices[1:] = np.where(weak, indices[0] * rng.uniform(0.99, 1.01, (2, count)), indices[1:])
    if kind == "isotropic":
        indices[:] = indices[0]
    elif kind == "uniaxial":
        indices[1] = indices[0]
    return Media(kind, indices, random_frames(rng, count))
