"""A plain Berreman 4x4 solver of one interface between two arbitrary half spaces.

Written from Maxwell's equations alone, one case at a time, without any closed form of crystal optics, so that the
project's own optics can be judged by it. In double precision (complex128), or with ``digits`` in mpmath.

Conventions: fields vary as exp(i(k.r - wt)); k in units of the vacuum wave number; H scaled by the vacuum impedance.
Maxwell's curl equations of a plane wave are then

    k x E = H,        k x H = -eps E.

In a frame whose z is the normal, with k = (kx, ky, q), the two z components give

    Hz = kx Ey - ky Ex,
    Ez = -(eps_zx Ex + eps_zy Ey + kx Hy - ky Hx) / eps_zz,

and the four others are the eigenvalue problem q psi = Delta psi of psi = (Ex, Ey, Hx, Hy):

    q Ex = Hy + kx Ez                       q Ey = -Hx + ky Ez
    q Hx = kx Hz - (eps E)_y                q Hy = ky Hz + (eps E)_x

(D. W. Berreman, J. Opt. Soc. Am. 62, 502 (1972).) Of the four waves two carry energy, or decay, towards +normal. With
psi continuous at the interface the amplitudes solve [psi_2+ , -psi_1-] a = psi_incident.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from tests.reference.arithmetic import Arithmetic, Array, arithmetic, exact

__all__ = [
    "Mode",
    "Scattered",
    "cross",
    "dot",
    "label_isotropic",
    "label_uniaxial",
    "lorentz_matrix",
    "modes",
    "scatter_reference",
    "tensor_biaxial",
    "tensor_uniaxial",
]


def cross(a: Array, b: Array) -> Array:
    """Return a x b of two vectors (3,), without conjugation."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def dot(a: Array, b: Array) -> Any:
    """Return sum a_i b_i, without conjugation."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _real(a: Array) -> Array:
    return np.array([x.real for x in a])


@dataclass(frozen=True)
class Mode:
    """One plane wave: k, E with |E| = 1, H = k x E, all (3,) in the world, and whether it propagates unattenuated."""

    k: Array
    e: Array
    h: Array
    normal: Array
    propagating: bool

    @property
    def energy(self) -> Array:
        """Re(E x H*), twice the mean Poynting vector."""
        return _real(cross(self.e, np.conj(self.h)))

    @property
    def flux(self) -> Any:
        """Energy flow along the normal, signed."""
        return dot(self.energy, self.normal)

    @property
    def ray(self) -> Array:
        """Unit vector of the energy flow, double precision."""
        s = np.array([float(x) for x in self.energy])
        return np.asarray(s / np.linalg.norm(s))


@dataclass(frozen=True)
class Scattered:
    """What one interface does: waves and amplitudes.

    ``reflected[i][j]`` and ``transmitted[i][j]`` are the amplitudes of outgoing mode i from incident mode j (unit |E|);
    the powers are fractions of the flux of the incident mode along the normal, 0 for outgoing waves that carry none.
    """

    incident: tuple[Mode, Mode]
    backward: tuple[Mode, Mode]
    forward: tuple[Mode, Mode]
    reflected: Array
    transmitted: Array

    @property
    def separation(self) -> float:
        """Least distance of the two wave vectors of a pair, 0 for a degenerate pair.

        Double precision finds a mode within about 1e-16 / separation of it: nearer than 1e-2 ask for digits.
        """
        pairs = (self.incident, self.backward, self.forward)
        return min(float(max(abs(x) for x in p.k - q.k)) for p, q in pairs)

    def reordered(self, incident: Sequence[int], backward: Sequence[int], forward: Sequence[int]) -> Scattered:
        """Return the same with the modes of each pair in another order, (0, 1) or (1, 0)."""
        return Scattered(
            (self.incident[incident[0]], self.incident[incident[1]]),
            (self.backward[backward[0]], self.backward[backward[1]]),
            (self.forward[forward[0]], self.forward[forward[1]]),
            self.reflected[np.ix_(backward, incident)],
            self.transmitted[np.ix_(forward, incident)],
        )

    def _power(self, amplitudes: Array, outgoing: tuple[Mode, Mode]) -> NDArray[np.float64]:
        powers = np.zeros((2, 2))
        for i, out in enumerate(outgoing):
            for j, source in enumerate(self.incident):
                if out.propagating and source.propagating:
                    powers[i, j] = float(abs(amplitudes[i, j]) ** 2 * abs(out.flux) / source.flux)
        return powers

    @property
    def power_reflected(self) -> NDArray[np.float64]:
        """Fraction [outgoing, incident] of the incident flux in each reflected mode."""
        return self._power(self.reflected, self.backward)

    @property
    def power_transmitted(self) -> NDArray[np.float64]:
        """Fraction [outgoing, incident] of the incident flux in each transmitted mode."""
        return self._power(self.transmitted, self.forward)


def tensor_uniaxial(n_o: complex, n_e: complex, axis: Array, digits: int | None = None) -> Array:
    """Return eps (3, 3) of a uniaxial medium; the axis is normalised here (n_o = n_e: isotropic)."""
    a = arithmetic(digits)
    with mpmath.workdps(digits or 15):
        o, e, c = a.array([n_o])[0], a.array([n_e])[0], a.array(axis)
        unit = np.eye(3, dtype=int)
        return np.asarray(o * o * unit + (e * e - o * o) * np.outer(c, c) / dot(c, c))


def tensor_biaxial(indices: Sequence[complex] | Array, rotation: Array, digits: int | None = None) -> Array:
    """Return eps (3, 3) = R diag(n^2) R^T of principal indices (3,) along the columns of R (3, 3).

    With digits the columns, orthonormal to rounding only, are made so to all digits first.
    """
    if digits is None:
        eps = rotation @ np.diag(np.asarray(indices) ** 2) @ rotation.T
        return np.asarray((eps + eps.T) / 2)
    a = arithmetic(digits)
    with mpmath.workdps(digits):
        n, r = a.array(indices), a.array(rotation)
        z = r[:, 2] / a.sqrt(dot(r[:, 2], r[:, 2]))
        x = r[:, 0] - dot(r[:, 0], z) * z
        x = x / a.sqrt(dot(x, x))
        return np.asarray(sum(m * m * np.outer(u, u) for m, u in zip(n, (x, cross(z, x), z), strict=True)))


def _delta(eps: Array, kx: Any, ky: Any) -> Array:
    """Return Berreman's matrix (4, 4) in the frame whose z is the normal."""
    columns = []
    for unit in np.eye(4, dtype=int):
        ex, ey, hx, hy = (x + 0 * kx for x in unit.tolist())
        hz = kx * ey - ky * ex
        ez = -(eps[2, 0] * ex + eps[2, 1] * ey + kx * hy - ky * hx) / eps[2, 2]
        dx = eps[0, 0] * ex + eps[0, 1] * ey + eps[0, 2] * ez
        dy = eps[1, 0] * ex + eps[1, 1] * ey + eps[1, 2] * ez
        columns.append([hy + kx * ez, -hx + ky * ez, kx * hz - dy, ky * hz + dx])
    return np.array(columns).T


def _frame(normal: Array, tangential: Array, a: Arithmetic) -> Array:
    """Return rows x, y, z of a right-handed frame with z = normal, x along the tangential k where there is one."""
    z = normal / a.sqrt(dot(normal, normal))
    across = tangential - dot(tangential, z) * z
    if dot(across, across) == 0:
        across = a.array(np.eye(3)[int(np.argmin([abs(float(x)) for x in z]))])
        across = across - dot(across, z) * z
    x = across / a.sqrt(dot(across, across))
    return np.array([x, cross(z, x), z])


def _flux_product(first: Array, second: Array) -> Any:
    """Return the sesquilinear form whose diagonal is 2 Re(E x H*) along the normal."""
    f, s = first, np.conj(second)
    return f[0] * s[3] - f[1] * s[2] + f[3] * s[0] - f[2] * s[1]


def _waves_of_roots(roots: list[Any], delta: Array, a: Arithmetic) -> list[tuple[Any, Array]]:
    """Return (q, psi) of every root.

    Equal roots (isotropic media, optic axes) get a basis of their kernel whose two waves exchange no energy, so that
    the powers add up; for waves without flux any basis serves.
    """
    unit = np.eye(len(delta), dtype=int)
    waves: list[tuple[Any, Array]] = []
    left = list(roots)
    while left:
        q = left.pop(0)
        twins = [p for p in left if abs(p - q) < a.tolerance_equal]
        if len(twins) == 1:
            left.remove(twins[0])
            first, second = a.kernel(delta - q * unit, 2)
            if abs(q.imag) <= a.tolerance_real:
                second = second - _flux_product(second, first) / _flux_product(first, first) * first
            waves += [(q, first), (q, second)]
        else:
            q = a.polish(q, delta)
            waves.append((q, a.kernel(delta - q * unit, 1)[0]))
    return waves


def modes(eps: Array, normal: Array, tangential: Array, digits: int | None = None) -> tuple[list[Mode], list[Mode]]:
    """Return the two modes that go, or decay, along +normal and the two along -normal.

    Parameters
    ----------
    eps : (3, 3) array
        Symmetric dielectric tensor, real or complex.
    normal, tangential : (3,) arrays
        Normal of the interface; tangential wave vector (its part along the normal is ignored), units of k0.
    digits : int, optional
        Work in mpmath with so many digits.
    """
    a = arithmetic(digits)
    with mpmath.workdps(digits or 15):
        n, t = a.array(normal), a.array(tangential)
        rows = _frame(n, t, a)
        local = np.array([[dot(r, np.array([dot(row, s) for row in a.array(eps)])) for s in rows] for r in rows])
        kx, ky = dot(t, rows[0]), dot(t, rows[1])
        delta = _delta(local, kx, ky)
        forward: list[Mode] = []
        backward: list[Mode] = []
        for q, psi in _waves_of_roots(a.eigenvalues(delta), delta, a):
            ex, ey, hx, hy = psi
            ez = -(local[2, 0] * ex + local[2, 1] * ey + kx * hy - ky * hx) / local[2, 2]
            size = a.sqrt(abs(ex) ** 2 + abs(ey) ** 2 + abs(ez) ** 2)
            e = (ex * rows[0] + ey * rows[1] + ez * rows[2]) / size
            k = kx * rows[0] + ky * rows[1] + q * rows[2]
            propagating = bool(abs(q.imag) <= a.tolerance_real)
            if propagating:
                k = _real(k)
            mode = Mode(k, e, cross(k, e), rows[2], propagating)
            towards = mode.flux if propagating else q.imag
            (forward if towards > 0 else backward).append(mode)
    if len(forward) != 2 or len(backward) != 2:
        raise ArithmeticError(f"{len(forward)} forward and {len(backward)} backward waves: exactly grazing or critical")
    return forward, backward


def label_uniaxial(pair: Sequence[Mode], axis: Array) -> tuple[Mode, Mode]:
    """Return (ordinary, extraordinary): the ordinary wave has no E along the optic axis."""
    along = [abs(dot(mode.e, exact(axis) if mode.e.dtype == object else np.asarray(axis))) for mode in pair]
    return (pair[0], pair[1]) if along[0] <= along[1] else (pair[1], pair[0])


def label_isotropic(pair: Sequence[Mode]) -> tuple[Mode, Mode]:
    """Return (s, p) of a degenerate pair: s has no E along the normal (any orthogonal pair at normal incidence)."""
    first, second = pair
    a = arithmetic(mpmath.mp.dps if first.e.dtype == object else None)
    u, v = dot(first.e, first.normal), dot(second.e, second.normal)
    if abs(u) ** 2 + abs(v) ** 2 < a.tolerance_equal**2:
        return first, second

    def mixed(x: Any, y: Any) -> Mode:
        e = x * first.e + y * second.e
        size = a.sqrt(sum(abs(component) ** 2 for component in e))
        return replace(first, e=e / size, h=cross(first.k, e / size))

    s = mixed(v, -u)
    overlap_first = dot(first.e, np.conj(s.e))
    overlap_second = dot(second.e, np.conj(s.e))
    # p is the rest of whichever wave is less like s
    rest = (
        first.e - overlap_first * s.e if abs(overlap_first) < abs(overlap_second) else second.e - overlap_second * s.e
    )
    size = a.sqrt(sum(abs(component) ** 2 for component in rest))
    return s, replace(first, e=rest / size, h=cross(first.k, rest / size))


def _tangential(mode: Mode, rows: Array) -> list[Any]:
    return [dot(mode.e, rows[0]), dot(mode.e, rows[1]), dot(mode.h, rows[0]), dot(mode.h, rows[1])]


def scatter_reference(
    normal: Array,
    tangential: Array,
    source: Array,
    target: Array,
    *,
    source_axis: Array | None = None,
    target_axis: Array | None = None,
    digits: int | None = None,
) -> Scattered:
    """Scatter both modes that come through the source towards an interface.

    Parameters
    ----------
    normal : (3,) array
        From source to target.
    tangential : (3,) array
        Tangential wave vector, units of k0.
    source, target : (3, 3) arrays
        Dielectric tensors.
    source_axis, target_axis : (3,) arrays, optional
        Optic axes: then modes come as (ordinary, extraordinary). Without one an isotropic tensor gives (s, p).
    digits : int, optional
        Work in mpmath with so many digits.
    """
    a = arithmetic(digits)

    def labelled(pair: list[Mode], eps: Array, axis: Array | None) -> tuple[Mode, Mode]:
        if axis is not None:
            return label_uniaxial(pair, axis)
        off = eps - eps[0, 0] * np.eye(3, dtype=int)
        return label_isotropic(pair) if not np.any(off != 0) else (pair[0], pair[1])

    with mpmath.workdps(digits or 15):
        incoming, reflected = modes(source, normal, tangential, digits)
        transmitted, _ = modes(target, normal, tangential, digits)
        incident = labelled(incoming, source, source_axis)
        backward = labelled(reflected, source, source_axis)
        forward = labelled(transmitted, target, target_axis)
        rows = _frame(a.array(normal), a.array(tangential), a)
        columns = [_tangential(m, rows) for m in forward] + [[-x for x in _tangential(m, rows)] for m in backward]
        system = np.array(columns).T
        out = np.array([a.solve(system, np.array(_tangential(m, rows))) for m in incident]).T
    return Scattered(incident, backward, forward, out[2:], out[:2])


def lorentz_matrix(
    normal: Array, tangential: Array, first: Array, second: Array
) -> tuple[Array, list[Mode], list[Mode]]:
    """Return the scattering matrix (4, 4) of modes normalised by their Lorentz product, and the modes in and out.

    In: the two waves of the first medium that go along +normal, the two of the second that go along -normal. Out: the
    two of the second along +normal, the two of the first along -normal. The norm of a mode is the square root of
    +-2(Ex Hy - Ey Hx), x and y tangential, + for waves along +normal, without conjugation; for symmetric tensors the
    matrix of the reversed waves is then the transposed matrix, evanescent and absorbed waves included.
    """
    rows = _frame(normal, tangential, arithmetic(None))
    (forward1, backward1), (forward2, backward2) = (modes(eps, normal, tangential) for eps in (first, second))

    def normalised(mode: Mode, direction: int) -> Mode:
        ex, ey, hx, hy = _tangential(mode, rows)
        size = np.sqrt(2 * direction * (ex * hy - ey * hx) + 0j)
        return replace(mode, e=mode.e / size, h=mode.h / size)

    sides = (1, 1, -1, -1)
    entering = [normalised(m, side) for m, side in zip((*forward1, *backward2), sides, strict=True)]
    leaving = [normalised(m, side) for m, side in zip((*forward2, *backward1), sides, strict=True)]
    system = np.array([_tangential(m, rows) for m in leaving]).T * sides
    right = np.array([_tangential(m, rows) for m in entering]).T * sides
    return np.linalg.solve(system, right), entering, leaving
