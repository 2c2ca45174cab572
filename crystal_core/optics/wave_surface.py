"""The index surface and the ray surface of a medium, each as two triangulated sheets that touch at their contacts.

The *index surface* is the set of wave vectors, r = n(s) s over the wave normals s, from Fresnel's equation
(Born & Wolf, Principles of Optics, 7th ed., §15.2.2). The *ray surface* is the set of ray vectors, r = v(t) t over the
ray directions t, v in units of c: what a flash at the origin has reached after a unit of time. Each is the polar
reciprocal of the other, k·r = 1, and Fresnel's equation of one turns into that of the other when every index n is
replaced by 1/n (§15.2.3).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError, NotSupportedError
from crystal_core.optics.arrays import Real
from crystal_core.optics.berreman import is_active
from crystal_core.optics.directions import waves_along
from crystal_core.optics.indicatrix import BiaxialIndicatrix, optical_class, principal_frame
from crystal_core.optics.medium import Medium

__all__ = ["SurfaceKind", "SurfaceMesh", "WaveSurface", "dual", "wave_surface"]

SurfaceKind = Literal["index", "ray"]

TOUCHING = 1e-13
"""Difference of two indices below which the sheets of an active medium touch."""

Index = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class SurfaceMesh:
    """One sheet, a closed surface about the origin.

    Parameters
    ----------
    mode : str
        The waves that it belongs to: "ordinary", "extraordinary", "slow", "fast"; "s" or "p" if isotropic.
    vertices : Real
        Points on the sheet, shape (3, V), in the frame of the medium: wave vectors in units of 2π/λ (index surface) or
        ray velocities in units of c (ray surface).
    triangles : NDArray[np.intp]
        Vertices of each triangle, counter-clockwise seen from outside, shape (F, 3).
    """

    mode: str
    vertices: Real
    triangles: Index


@dataclass(frozen=True, slots=True)
class WaveSurface:
    """Both sheets of a medium's index or ray surface.

    The sheets have one set of triangles over one set of directions, so the inner one is inside the outer one
    everywhere, between the vertices too, and they meet at vertices only.

    Parameters
    ----------
    kind : str
        "index" or "ray".
    outer, inner : SurfaceMesh
        On the index surface the outer sheet is that of the slow waves, on the ray surface that of the fast rays. Of an
        isotropic medium both are the same sphere.
    contact_points : Real
        Where the sheets touch, shape (3, M), each a vertex of both: four points of a biaxial medium, on its optic axes
        (index surface) or biradials (ray surface); the two poles of a uniaxial one; none (M = 0) of an isotropic one,
        whose sheets coincide, and of an optically active one, whose sheets stay apart by G/n there.
    """

    kind: SurfaceKind
    outer: SurfaceMesh
    inner: SurfaceMesh
    contact_points: Real


def wave_surface(medium: Medium, kind: SurfaceKind = "index", resolution: int = 32) -> WaveSurface:
    """Return the index surface or the ray surface.

    Parameters
    ----------
    medium : Medium
        At one wavelength: indices of shape (), directions of shape (3,) or (3, 3). Its absorption is not looked at.
    kind : str
        "index" or "ray".
    resolution : int
        Steps to a quarter of a turn, at least 2: a biaxial sheet has 8·resolution² + 2 vertices and 16·resolution²
        triangles, a uniaxial or isotropic one slightly fewer. Towards the contacts of a biaxial medium the steps shrink
        with the square root of the distance, which resolves the funnels there.

    Raises
    ------
    InputError
        A medium of more than one wavelength, an unknown kind, a resolution below 2.
    NotSupportedError
        The ray surface of an optically active medium: the two surfaces are no duals there.
    """
    _check(medium, kind, resolution)
    active = is_active(medium)
    if active and kind == "ray":
        raise NotSupportedError("ray surfaces of optically active media (with a gyration tensor) are not drawn")
    along = medium if kind == "index" else dual(medium)
    grid = _grid(along, resolution)
    slow, fast = sorted(waves_along(along, grid.directions), key=lambda wave: float(np.sum(wave.index)), reverse=True)
    lengths = np.stack((slow.index, fast.index))
    contacts = grid.contacts
    if active:
        # The index of a circular wave is n ± G/2n. Where an axis has no gyration the sheets still touch.
        contacts = contacts[np.abs(lengths[0, contacts] - lengths[1, contacts]) <= TOUCHING]
    else:
        # At a contact both are the middle one of the principal indices, whatever the rounding of the two formulas.
        lengths[:, contacts] = np.sort(principal_frame(along)[0])[1]
    outer, inner = lengths[:, None, :] * grid.directions
    modes = [str(wave.mode[0]) for wave in (slow, fast)]
    if kind == "ray":
        swapped = {"slow": "fast", "fast": "slow"}
        modes = [swapped.get(mode, mode) for mode in modes]
    return WaveSurface(
        kind,
        SurfaceMesh(modes[0], outer, grid.triangles),
        SurfaceMesh(modes[1], inner, grid.triangles),
        outer[:, contacts].copy(),
    )


def dual(medium: Medium) -> Medium:
    """Return the medium whose index surface is the ray surface of this one: the principal indices 1/n, transparent.

    Its waves along a ray direction t have the ray velocity for an index, the wave normal for a ray, and D and E have
    changed places. Its optic axes are the *biradials*, along which both ray velocities are one.
    """
    return replace(medium.transparent(), indices=tuple(np.asarray(1.0 / n) for n in medium.indices))


@dataclass(frozen=True, slots=True)
class _Grid:
    """Directions (3, V) with their triangles (F, 3) on the sphere; `contacts` are the vertices at the optic axes."""

    directions: Real
    triangles: Index
    contacts: Index


def _grid(medium: Medium, steps: int) -> _Grid:
    """Return a triangulation of the sphere with a vertex at each optic axis.

    Biaxial: on sphero-conal coordinates (ρ, τ), whose lines are the spherical ellipses and hyperbolas with the optic
    axes for foci: θ₁ + θ₂ = const and θ₁ − θ₂ = const, so that either index is constant along them,

        s = (√(1 − cos²V cos²ρ) sin τ, sin ρ cos τ, √(1 − sin²V sin²τ) cos ρ) on (α, β, γ),

    0 ≤ ρ ≤ π, 0 ≤ τ < 2π. The row ρ = 0 is the arc between the two foci, run through twice, forth and back. With
    V → 0 these are polar coordinates about γ, and the arc is a pole: so it is made for a uniaxial medium.
    """
    kind = optical_class(medium)
    indices, axes = principal_frame(medium)
    indicatrix = BiaxialIndicatrix.of(Medium.biaxial(list(indices), axes))
    sin_v, cos_v = float(indicatrix.sin_v), float(indicatrix.cos_v)
    x, _, z = indicatrix.axes
    if kind == "uniaxial" and cos_v == 0.0:  # n_β = n_γ: the optic axis is α
        x, z, sin_v, cos_v = z, x, 0.0, 1.0
    y = np.cross(z, x)  # not β: the principal directions may be left-handed

    angle = 0.5 * np.pi * np.arange(4 * steps) / steps
    sin, cos = (np.where(np.abs(f) < 1e-15, 0.0, f) for f in (np.sin(angle), np.cos(angle)))
    rho, tau = np.divmod(np.arange((2 * steps + 1) * 4 * steps), 4 * steps)
    s_x = np.sqrt(sin_v**2 + (cos_v * sin[rho]) ** 2) * sin[tau]
    s_y = sin[rho] * cos[tau]
    s_z = np.sqrt(cos_v**2 + (sin_v * cos[tau]) ** 2) * cos[rho]

    number = _numbers(steps, pole=kind != "biaxial")
    directions = np.empty((3, int(number.max()) + 1))
    directions[:, number.ravel()] = s_x * x[:, None] + s_y * y[:, None] + s_z * z[:, None]
    directions /= np.sqrt(np.sum(directions**2, axis=0))
    contacts = np.empty(0, np.intp)
    if kind == "uniaxial":
        contacts = number[(0, -1), (0, 0)]
        directions[:, contacts] = np.stack((z, -z), axis=1)
    elif kind == "biaxial":
        first, second = indicatrix.optic_axes()
        contacts = number[(0, -1, 0, -1), (steps, 3 * steps, 3 * steps, steps)]
        directions[:, contacts] = np.stack((first, -first, second, -second), axis=1)
    return _Grid(directions, _triangles(number, steps), contacts)


def _numbers(steps: int, pole: bool) -> Index:
    """Return the vertex at each place (ρ, τ) of the grid, shape (2·steps + 1, 4·steps)."""
    columns = np.arange(4 * steps)
    # The first and the last row: one pole, or an arc on which τ and π − τ are the same point.
    back = (columns + steps) % (4 * steps)  # 0 at τ = −π/2
    row = np.zeros_like(columns) if pole else np.minimum(back, 4 * steps - back)
    inside = np.arange((2 * steps - 1) * 4 * steps).reshape(-1, 4 * steps) + row.max() + 1
    return np.concatenate((row[None, :], inside, row[None, :] + inside.max() + 1))


def _triangles(number: Index, steps: int) -> Index:
    """Return the triangles of the grid, (F, 3), counter-clockwise from outside."""
    a, b = number[:-1], np.roll(number[:-1], -1, axis=1)
    d, c = number[1:], np.roll(number[1:], -1, axis=1)
    # The diagonal of a cell starts at the corner that is nearest to an optic axis: a focus would otherwise belong to
    # two triangles only. It also makes the mesh as symmetric as the crystal.
    row, column = np.indices(a.shape)
    by_a = (column // steps % 2 == 1) == (row < steps)
    halves = np.where(
        by_a[:, :, None],
        np.stack((a, b, c, a, c, d), axis=2),
        np.stack((a, b, d, b, c, d), axis=2),
    )
    triangles = halves.reshape(-1, 3)
    i, j, k = triangles.T
    return np.ascontiguousarray(triangles[(i != j) & (j != k) & (k != i)])  # a cell at a pole is one triangle


def _check(medium: Medium, kind: str, resolution: int) -> None:
    if kind not in get_args(SurfaceKind):
        raise InputError.at("/kind", f"must be one of {', '.join(get_args(SurfaceKind))}, not {kind!r}")
    if resolution < 2:
        raise InputError.at("/resolution", f"must be at least 2, not {resolution}")
    several = any(n.ndim for n in medium.indices)
    several |= medium.axis is not None and medium.axis.ndim > 1
    several |= medium.axes is not None and medium.axes.ndim > 2
    several |= medium.gyration is not None and medium.gyration.ndim > 2
    if several:
        raise InputError.at("", "a wave surface belongs to one medium at one wavelength")
