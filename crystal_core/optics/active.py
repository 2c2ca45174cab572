"""Eigenwaves of an optically active medium at an interface, by Berreman's matrix.

The tangential fields ψ = (E_x, E_y, H_x, H_y) of the four waves are the eigenvectors of Δ (`berreman_matrix`), their q
the eigenvalues. In a lossless medium K Δ is Hermitian, where ψ†K φ = (E_ψ* × H_φ + E_φ × H_ψ*)_z, so that

    ψ†K φ = 0   unless   q_φ = q_ψ*:

waves that propagate exchange no energy, an evanescent one carries none and goes with one partner that decays the other
way. Eigenvectors come with an error of rounding/(distance of their q); it is taken out as far as it breaks this rule,
whereby energy is kept to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from crystal_core.optics.active_directions import indices_along
from crystal_core.optics.arrays import BoolArray, Complex, Field, Rays, Real
from crystal_core.optics.berreman import activity, berreman_matrix, flux_product, normal_fields
from crystal_core.optics.framed import FramedMedium
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.indicatrix import permittivity
from crystal_core.optics.layer_waves import REAL, carried, split
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Mode
from crystal_core.optics.two_ports import product

__all__ = ["EllipticalMode", "FramedActive"]

NEAR = 1e-2
"""Distance of a forward and a backward q below which both are computed anew from the space of the two."""

FOREIGN = 1e4
"""Weight of q_forward − q*_backward, 0 for evanescent partners, beside the distance of both."""

EQUAL = 1e-13
"""Distance of two evanescent q below which any two fields of their common space serve for them."""

APART = 1e-14
"""Part of an index by which two indices must differ to be told apart."""

LARGEST_SHARE = 1e-2
"""Largest share of a wave in another that is taken for rounding."""

FORWARD, BACKWARD = slice(0, 2), slice(2, 4)
"""Places of the waves in arrays of four."""

ACROSS_SIDES = np.array(((0, 0, 1, 1), (0, 0, 1, 1), (1, 1, 0, 0), (1, 1, 0, 0)), np.bool_)


@dataclass(slots=True)
class EllipticalMode(Mode):
    """A mode that knows its flux: near grazing incidence that of its fields would be mostly rounding.

    Parameters
    ----------
    normal_flux : Real
        Re(E × H*)_z, shape (N,).
    """

    normal_flux: Real = field(kw_only=True)

    def flux(self) -> Real:
        """Return Re(E × H*)_z, shape (N,)."""
        return self.normal_flux


class FramedActive(FramedMedium):
    """An optically active medium in the frame of an interface: mode 0 is slow, mode 1 fast or a second slow one.

    A wave that propagates is slow or fast by its own sheet of the index surface, so two may be slow in a pair near an
    optic axis of a biaxial medium. A propagating wave is mode 0 beside an evanescent one; of two evanescent waves the
    one with the larger Re k·k is. Unlike those of other media the fields are elliptical, and they are not orthogonal
    by `modes.bilinear`: the partner of a wave (k, E) is (−k, E*).
    """

    def __init__(self, medium: Medium, frame: InterfaceFrame) -> None:
        super().__init__(medium, frame)
        kappa = activity(medium)
        assert kappa is not None
        epsilon, kappa = _in_frame(permittivity(medium), frame), _in_frame(kappa, frame)
        along = frame.kappa.astype(np.float64)
        across = np.zeros(along.shape)
        delta: Complex = np.asarray(berreman_matrix(epsilon, along, across, kappa), np.complex128)
        q, psi, free, flux = _waves(delta)
        slow = _on_slow_sheet(epsilon, kappa, along, q, free)
        # q² stands for k², κ being common to all.
        length = (q * q).real
        order = np.empty(q.shape, np.intp)
        for first, side in ((0, FORWARD), (2, BACKWARD)):
            order[:, side] = first + np.lexsort((-length[:, side], ~slow[:, side], ~free[:, side]))
        # Solved in double precision; handed out in that of the frame.
        kind = np.result_type(frame.kappa.dtype, np.complex64)
        self._q = np.take_along_axis(q, order, axis=1).astype(kind)
        self._slow, free = (np.take_along_axis(values, order, axis=1) for values in (slow, free))
        self._free: BoolArray = free[:, FORWARD] & free[:, BACKWARD]
        # The outermost wave of a side is on the outer sheet; of two evanescent ones the first counts as slow.
        self._slow[:, ::2] = True
        flux, psi = np.take_along_axis(flux, order, axis=1), np.take_along_axis(psi, order[:, None, :], axis=2)
        ez, hz = normal_fields(epsilon, along, across, kappa, psi)
        fields: Complex = np.concatenate((psi, ez[:, None, :], hz[:, None, :]), axis=1, dtype=np.complex128)
        scale = _unit_scale(fields[:, (0, 1, 4), :])
        self._fields = (fields * scale[:, None, :]).astype(kind)
        self._flux = (flux * np.abs(scale) ** 2).astype(frame.kappa.dtype)

    def take(self, rays: Rays) -> FramedActive:
        """Return the same for a selection of rays."""
        part = object.__new__(FramedActive)
        part.medium, part.frame = self.medium.take(rays), self.frame.take(rays)
        part._q, part._free, part._slow = self._q[rays], self._free[rays], self._slow[rays]
        part._fields, part._flux = self._fields[rays], self._flux[rays]
        return part

    def propagating(self) -> tuple[BoolArray, BoolArray]:
        """Return whether mode 0 and mode 1 propagate, shape (N,) each."""
        return self._free[:, 0], self._free[:, 1]

    def pair(self, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
        """Return the waves along sign·normal, as `FramedMedium.pair` says; their fields are complex in any case."""
        first = 0 if sign > 0 else 2
        return self._mode(first, evanescent), self._mode(first + 1, evanescent)

    def _mode(self, which: int, evanescent: bool) -> Mode:
        own = self._q[:, which]
        q: Field = own.copy() if evanescent else own.real.copy()
        ex, ey, hx, hy, ez, hz = np.ascontiguousarray(self._fields[:, :, which].T)
        a, b, c = np.conj((hx, hy, hz))
        flow = (ey * c - ez * b).real, (ez * a - ex * c).real, (ex * b - ey * a).real
        return EllipticalMode(q, ex, ey, ez, hx, hy, flow, self._slow[:, which], hz, normal_flux=self._flux[:, which])


def _in_frame(tensor: Real, frame: InterfaceFrame) -> Real:
    """Return a symmetric tensor of the world, shape (3, 3) or (3, 3, N), in the frame of each ray, shape (N, 3, 3)."""
    axes = np.stack((frame.x, frame.y, frame.z)).astype(np.float64)
    wide = np.broadcast_to(tensor[:, :, None] if tensor.ndim == 2 else tensor, axes.shape)
    turned = np.einsum("ibn,jbn->nij", np.einsum("ian,abn->ibn", axes, wide), axes)
    return np.asarray(0.5 * (turned + turned.swapaxes(1, 2)))


def _waves(delta: Complex) -> tuple[Complex, Complex, BoolArray, Real]:
    """Return q (N, 4), ψ as columns (N, 4, 4), which propagate and Re(E × H*)_z, (N, 4): two forward waves first."""
    parts = split(delta)
    q, psi = (
        np.concatenate(pair, axis=-1)
        for pair in ((parts.forward.q, parts.backward.q), (parts.forward.psi, parts.backward.psi))
    )
    q_of, psi_of, free = q.copy(), psi.copy(), np.zeros(q.shape, np.bool_)
    for side, pair, sign in ((slice(0, 2), parts.forward, +1), (slice(2, 4), parts.backward, -1)):
        q_of[:, side], psi_of[:, :, side], free[:, side] = carried(pair, delta, sign)
        # `carried` gives evanescent pairs as a basis of their space; here they are wanted one by one.
        apart = ~free[:, side].any(axis=1) & (np.abs(pair.q[:, 0] - pair.q[:, 1]) > EQUAL)
        psi_of[apart, :, side] = pair.psi[apart]
    near, flux = np.zeros(q.shape, np.bool_), np.zeros(q.shape)
    rays = np.flatnonzero(parts.separation < NEAR)
    q_of[rays], psi_of[rays], free[rays], near[rays], flux[rays] = _slanting(delta[rays], q[rays], psi[rays])
    square = np.sum(np.abs(psi_of) ** 2, axis=1)
    psi_of, flux = psi_of / np.sqrt(square)[:, None, :], flux / square
    for _ in range(2):
        psi_of = psi_of - product(psi_of, _shares(psi_of, free, near))
    flux = np.where(near, flux, 0.5 * np.einsum("nii->ni", flux_product(psi_of, psi_of)).real)
    return q_of, psi_of, free, flux


def _slanting(delta: Complex, q: Complex, psi: Complex) -> tuple[Complex, Complex, BoolArray, BoolArray, Real]:
    """Return q, ψ and which waves propagate, those of nearly coincident forward and backward waves computed anew.

    The eigenvectors of such two are good to rounding/(their distance) only. But the space of both is the one that
    exchanges no energy with the other two waves, and there they follow from `_two_ways`.

    Also returned, (N, 4): which waves were computed anew, and Re(E × H*)_z of those.
    """
    count = np.arange(q.shape[0])
    gap = _gap(q[:, :2, None], q[:, None, 2:]).reshape(-1, 4)
    nearest = np.argmin(gap, axis=1)
    ahead, back = nearest // 2, 2 + nearest % 2
    rest = np.stack((1 - ahead, 5 - back), axis=1)
    free, anew, flux = np.abs(q.imag) <= REAL, np.zeros(q.shape, np.bool_), np.zeros(q.shape)
    q_of, psi_of = q.copy(), psi.copy()
    space = _without_exchange(np.take_along_axis(psi, rest[:, None, :], axis=2))
    # Where the other two nearly coincide as well, they in turn are taken across the space of the first two.
    rest_too = gap[count, 3 - nearest] < NEAR
    for places, basis, rays in (
        (np.stack((ahead, back), axis=1), space, count),
        (rest, _without_exchange(space), np.flatnonzero(rest_too)),
    ):
        pair_q, pair_psi, pair_free, pair_flux = _two_ways(delta[rays], basis[rays])
        for column, place in enumerate(places[rays].T):
            q_of[rays, place], psi_of[rays, :, place] = pair_q[:, column], pair_psi[:, :, column]
            free[rays, place], flux[rays, place], anew[rays, place] = pair_free, pair_flux[:, column], True
    return np.where(free, q_of.real, q_of), psi_of, free, anew, flux


def _gap(ahead: Complex, back: Complex) -> Real:
    """Return how far two q are apart.

    An evanescent wave belongs to the one of conjugate q, not to a third that comes close at a conical point.
    """
    evanescent = (np.abs(ahead.imag) > REAL) | (np.abs(back.imag) > REAL)
    return np.asarray(np.abs(ahead - back) + np.where(evanescent, FOREIGN, 0.0) * np.abs(ahead - np.conj(back)))


def _without_exchange(psi: Complex) -> Complex:
    """Return an orthonormal basis, (N, 4, 2), of all φ with ψ†K φ = 0 for two ψ, shape (N, 4, 2)."""
    flipped = np.stack((psi[:, 3], -psi[:, 2], -psi[:, 1], psi[:, 0]), axis=1)
    return np.asarray(np.linalg.qr(flipped, mode="complete")[0][:, :, 2:], np.complex128)


def _two_ways(delta: Complex, basis: Complex) -> tuple[Complex, Complex, BoolArray, Real]:
    """Return a forward and a backward wave in the space of both, whose basis is given, shape (N, 4, 2).

    In a basis with ψ†Kψ = diag(1, −1), K Δ is (a, b; b*, d). With m = ½ (a + d) and r² = m² − |b|², r of the sign of m
    or positive imaginary,

        q = ½ (a − d) ± r,        ψ_forward = (−(m + r), b*),   ψ_backward = (b, −(m + r)),

    of fluxes ψ†Kψ = ± 2 r (m + r), or none where r is imaginary.

    Returns
    -------
    q (N, 2), ψ (N, 4, 2), whether both propagate (N,), Re(E × H*)_z (N, 2)
    """
    size, turn = np.linalg.eigh(flux_product(basis, basis))
    basis = (product(basis, turn) / np.sqrt(np.abs(size))[:, None, :])[:, :, ::-1]
    level = flux_product(basis, product(delta, basis))
    a, b, d = level[:, 0, 0].real, level[:, 0, 1], level[:, 1, 1].real
    middle = 0.5 * (a + d)
    square = (middle - np.abs(b)) * (middle + np.abs(b))
    free = square >= 0.0
    root = np.where(free, np.copysign(1.0, middle), 1j) * np.sqrt(np.abs(square))
    # Two waves that cross without a coupling: the basis has them already.
    crossing = (middle == 0.0) & (b == 0.0)
    lead = np.where(crossing, 1.0, middle + root)
    mixture = np.stack((np.stack((-lead, np.conj(b)), axis=1), np.stack((b, -lead), axis=1)), axis=2)
    flux = np.where(crossing, 0.5, np.where(free, (root * lead).real, 0.0))
    centre = 0.5 * (a - d)
    q = np.stack((centre + root, centre - root), axis=1)
    return q, product(basis, mixture), free, np.stack((flux, -flux), axis=1)


def _shares(psi: Complex, free: BoolArray, near: BoolArray) -> Complex:
    """Return X, (N, 4, 4), such that ψ (1 − X) keep the rule ψ†K φ = 0 up to the square of what they break it by.

    With G = ψ†Kψ and its permitted part T that is X = ½ T⁻¹ (G − T), Löwdin's symmetric step. The waves of `_slanting`
    keep the rule already.
    """
    gram = flux_product(psi, psi)
    lost = ~free
    one = np.eye(4, dtype=np.bool_)
    permitted = np.where(one, free[:, :, None], lost[:, :, None] & lost[:, None, :] & ACROSS_SIDES)
    kept = np.where(permitted, gram, 0.0)
    excess = gram - kept
    done = near | ~permitted.any(axis=2)
    done = done[:, :, None] | done[:, None, :]
    kept[done], excess[done] = 0.0, 0.0
    kept[done & one] = 1.0
    shares = 0.5 * np.linalg.solve(kept, excess)
    return np.where(np.abs(shares) <= LARGEST_SHARE, shares, 0.0)


def _on_slow_sheet(epsilon: Real, kappa: Real, along: Real, q: Complex, free: BoolArray) -> BoolArray:
    """Return whether each wave that propagates has the larger, by more than rounding, of the two indices along it."""
    slow = np.zeros(free.shape, np.bool_)
    for wave in range(4):
        rays = np.flatnonzero(free[:, wave])
        k = np.stack((along[rays], np.zeros(rays.size), q[rays, wave].real))
        length = np.sqrt(np.sum(k * k, axis=0))
        larger, smaller = indices_along(epsilon[rays], kappa[rays], k / length)
        slow[rays, wave] = length > (0.5 + APART) * (larger + smaller)
    return slow


def _unit_scale(electric: Complex) -> Complex:
    """Return the factors, (N, 4), that make E, (N, 3, 4), of unit length with its largest component real, positive."""
    size = np.abs(electric)
    largest = np.take_along_axis(electric, np.argmax(size, axis=1)[:, None, :], axis=1)[:, 0, :]
    return np.asarray(np.conj(largest) / (np.abs(largest) * np.sqrt(np.sum(size * size, axis=1))))
