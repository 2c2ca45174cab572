"""Waves of one medium made orthogonal to rounding, g(ψ_i, ψ_j) = 0, where their fields are uncertain by more.

The exact waves are orthogonal (`modes.bilinear`), and the face projects on them; what they keep of one another is lost
energy.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics.arrays import Field, Rays, Real
from crystal_core.optics.modes import Mode, bilinear

__all__ = ["balance", "orthogonalize"]

SLANTING = 0.1
"""|g(ψ, ψ)|/|E|² below which a wave is made orthogonal to its neighbours."""

LARGEST_SHARE = 1e-2
"""Largest share of a wave in another that is taken for rounding."""


def orthogonalize(modes: tuple[Mode, Mode], rays: NDArray[np.intp]) -> None:
    """Take from the second mode of some rays, near an optic axis, what it has of the first.

    Each wave near an axis is uncertain by rounding/θ, but within the plane of both: what is summed over the pair
    keeps all digits if the two are orthogonal.
    """
    if not rays.size:
        return
    first, second = modes
    a, b = _selected(first, rays), _selected(second, rays)
    norm = a.norm()
    grazing = np.abs(norm) <= np.sqrt(np.finfo(norm.real.dtype).eps) * _square_of_field(a)
    share = np.where(grazing, 0.0, bilinear(a, b)) / np.where(grazing, 1.0, norm)
    for values, change in zip(_components(second), _components(a), strict=True):
        values[rays] -= share * change


def balance(modes: tuple[Mode, Mode, Mode, Mode]) -> None:
    """Make waves orthogonal that slant so much that their roots have lost digits.

    A wave of flux f has its root within rounding/f, and a share of the other waves in it of the same order, by which
    energy would be off. Half of it is taken from either (Löwdin's symmetric step), which leaves the square of it.
    """
    norms = [np.abs(mode.norm()) for mode in modes]
    slants = [norm < SLANTING * _square_of_field(mode) for norm, mode in zip(norms, modes, strict=True)]
    rays = np.flatnonzero(slants[0] | slants[1] | slants[2] | slants[3])
    if not rays.size:
        return
    parts = [_selected(mode, rays) for mode in modes]
    own = [part.norm() for part in parts]
    steps: list[list[Field]] = [[np.zeros_like(value) for value in _components(part)] for part in parts]
    for i, j in itertools.permutations(range(4), 2):
        overlap = 0.5 * bilinear(parts[i], parts[j])
        # Two waves that all but coincide (exactly grazing) are no pair to be told apart.
        small = np.abs(overlap) <= LARGEST_SHARE * np.minimum(np.abs(own[i]), np.abs(own[j]))
        share = np.where(small, overlap, 0.0) / np.where(small & (own[j] != 0.0), own[j], 1.0)
        steps[i] = [step + share * value for step, value in zip(steps[i], _components(parts[j]), strict=True)]
    for mode, changes in zip(modes, steps, strict=True):
        for values, change in zip(_components(mode), changes, strict=True):
            values[rays] -= change


def _components(mode: Mode) -> list[Field]:
    return [v for v in (mode.ex, mode.ey, mode.ez, mode.hx, mode.hy, mode.hz) if v is not None]


def _selected(mode: Mode, rays: Rays) -> Mode:
    def part(values: Field | None) -> Field | None:
        return None if values is None else values[rays]

    return Mode(
        mode.q[rays],
        part(mode.ex),
        part(mode.ey),
        part(mode.ez),
        part(mode.hx),
        part(mode.hy),
        None,
        mode.name,
        part(mode.hz),
    )


def _square_of_field(mode: Mode) -> Real:
    first, *rest = (_squared(component) for component in _components(mode)[:3])
    return sum(rest, start=first)


def _squared(values: Field) -> Real:
    """Return |values|²."""
    if np.iscomplexobj(values):
        return np.asarray(values.real * values.real + values.imag * values.imag)
    return np.asarray(values * values)
