"""Optically active media to test with, and their equations written down once more."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics.arrays import BoolArray, Complex, Field, Real
from crystal_core.optics.directions import PlaneWave
from crystal_core.optics.interface import Scattering, scatter
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Wave

__all__ = [
    "KINDS",
    "NORMAL",
    "PAIRS",
    "SIDES",
    "SIZES",
    "Setup",
    "conserved",
    "frames",
    "full_k",
    "jump",
    "magnetic",
    "material",
    "maxwell_error",
    "poynting",
    "random_medium",
    "random_setup",
    "sized",
    "units",
    "waves_of",
]

KINDS = ("isotropic", "uniaxial", "biaxial")
PAIRS = list(itertools.product(KINDS, KINDS))
SIDES = {"from active": (1, None), "into active": (None, 1), "both active": (1, 1)}
SIZES = (0.1, 1e-3, 1e-5, 1e-8, 1e-12)
NORMAL = np.array((0.0, 0.0, 1.0))


def units(rng: np.random.Generator, count: int) -> Real:
    v = rng.normal(size=(3, count))
    return np.asarray(v / np.linalg.norm(v, axis=0))


def frames(rng: np.random.Generator, count: int) -> Real:
    return np.moveaxis(np.linalg.qr(rng.normal(size=(count, 3, 3)))[0], 0, 2)


def random_medium(rng: np.random.Generator, kind: str, count: int, size: float | None) -> Medium:
    """Return media of indices from 1.2 to 2.5; `size`: the scale of their gyration, None: inactive."""
    n = rng.uniform(1.2, 2.5, (3, count))
    if kind == "isotropic":
        medium = Medium.isotropic(n[0])
    elif kind == "uniaxial":
        medium = Medium.uniaxial(n[0], n[1], units(rng, count))
    else:
        medium = Medium.biaxial(list(n), frames(rng, count))
    if size is None:
        return medium
    half = rng.normal(size=(3, 3, count)) * size
    return medium.active(half + half.swapaxes(0, 1))


def material(medium: Medium, count: int) -> tuple[Real, Real]:
    """Return ε and κ of D = ε E + i κ H, B = H − i κ E, shape (3, 3, N), straight from their definitions."""
    axes = medium.axes
    if axes is None:
        axes = np.eye(3) if medium.axis is None else np.array([np.zeros_like(medium.axis)] * 2 + [medium.axis])
    wide = np.broadcast_to(axes[:, :, None] if axes.ndim == 2 else axes, (3, 3, count))
    n = [np.broadcast_to(value, count) for value in medium.indices]
    if len(n) < 3:
        base = n[0] ** 2 * np.eye(3)[:, :, None]
        last = 0.0 if len(n) == 1 else (n[1] ** 2 - n[0] ** 2) * np.einsum("in,jn->ijn", wide[2], wide[2])
        epsilon = base + last
        middle = n[0]
    else:
        epsilon = np.einsum("an,ain,ajn->ijn", np.array(n) ** 2, wide, wide)
        epsilon = 0.5 * (epsilon + epsilon.swapaxes(0, 1))
        middle = (n[0] + n[1] + n[2]) / 3
    if medium.gyration is None:
        return epsilon, np.zeros((3, 3, count))
    g = np.broadcast_to(medium.gyration[:, :, None] if medium.gyration.ndim == 2 else medium.gyration, (3, 3, count))
    return epsilon, (0.5 * np.einsum("iin->n", g) * np.eye(3)[:, :, None] - g) / middle


def magnetic(medium: Medium, k: Complex | Real, e: Complex | Real) -> Complex:
    """Return H = k × E + i κ E, shape (3, N)."""
    kappa = material(medium, k.shape[1])[1]
    return np.asarray(np.cross(k, e, axis=0) + 1j * np.einsum("ijn,jn->in", kappa, e))


def maxwell_error(medium: Medium, k: Complex | Real, e: Complex | Real) -> float:
    """Return the largest component of k × H + D over all waves, |E| = 1."""
    epsilon, kappa = material(medium, k.shape[1])
    h = magnetic(medium, k, e)
    d = np.einsum("ijn,jn->in", epsilon, e) + 1j * np.einsum("ijn,jn->in", kappa, h)
    return float(np.abs(np.cross(k, h, axis=0) + d).max())


@dataclass(frozen=True)
class Setup:
    """Faces with a tangential wave vector for each, (3, N)."""

    normal: Real
    tangential: Real
    source: Medium
    target: Medium

    def scatter(self) -> Scattering:
        return scatter(self.normal, self.tangential, self.source, self.target)

    def from_behind(self) -> Setup:
        """Return the same faces for light from the other side, of the same tangential wave vector."""
        return Setup(-self.normal, self.tangential, self.target, self.source)

    def take(self, rays: NDArray[np.intp]) -> Setup:
        return Setup(self.normal[:, rays], self.tangential[:, rays], self.source.take(rays), self.target.take(rays))


def random_setup(
    seed: int, source: str, target: str, count: int, sizes: tuple[float | None, float | None], reach: float = 0.999
) -> Setup:
    rng = np.random.default_rng(seed)
    media = [random_medium(rng, kind, count, size) for kind, size in zip((source, target), sizes, strict=True)]
    normal = units(rng, count)
    across = np.cross(normal, units(rng, count), axis=0)
    largest = np.max(np.broadcast_arrays(*media[0].indices), axis=0)
    across *= rng.uniform(0, reach, count) * largest / np.linalg.norm(across, axis=0)
    return Setup(normal, across, *media)


def full_k(wave: Wave) -> Complex:
    return np.asarray(wave.k + 1j * wave.k_imag)


def conserved(result: Scattering, mode: int) -> Real:
    """Return ΣR + ΣT of the incident waves of a mode that propagate."""
    free: BoolArray = result.incident[mode].propagating
    parts = (*result.power_reflected, *result.power_transmitted)
    return np.asarray(sum((power[mode][free] for power in parts), np.zeros(int(free.sum()))))


def poynting(medium: Medium, wave: PlaneWave) -> Real:
    flow = np.cross(wave.e, np.conj(magnetic(medium, wave.k, wave.e)), axis=0).real
    return np.asarray(flow / np.linalg.norm(flow, axis=0))


def sized(side: str, size: float) -> tuple[float | None, float | None]:
    first, second = SIDES[side]
    return (None if first is None else size), (None if second is None else size)


def jump(setup: Setup, result: Scattering, mode: int) -> float:
    """Return the largest jump of tangential E or H over the faces, for one incident wave of unit E."""
    free = result.incident[mode].propagating
    total = np.zeros((2, 3, free.size), np.complex128)
    waves: list[tuple[Wave, Field, Medium]] = [(result.incident[mode], np.ones(free.size), setup.source)]
    waves += [(result.reflected[i], result.amplitude_reflected[i][mode], setup.source) for i in (0, 1)]
    waves += [(result.transmitted[i], -result.amplitude_transmitted[i][mode], setup.target) for i in (0, 1)]
    for wave, amplitude, medium in waves:
        total += amplitude * np.stack((wave.field, magnetic(medium, full_k(wave), wave.field)))
    total -= setup.normal * np.sum(total * setup.normal, axis=1, keepdims=True)
    return float(np.abs(total[:, :, free]).max())


def waves_of(result: Scattering) -> list[Wave]:
    return [*result.incident, *result.reflected, *result.transmitted]
