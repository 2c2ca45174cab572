"""A plate as many thin slices: slower, but at home where the waves of a plate are no basis of its fields."""

from __future__ import annotations

import numpy as np

from crystal_core.optics.arrays import Complex, Field, Real
from crystal_core.optics.two_ports import TwoPort, product

__all__ = ["sliced_plate"]

THIN = 0.25
"""k0 h |Δ| of one slice."""

TERMS = 12
"""Terms of the exponential series: 0.25¹³/13! is below rounding."""


def sliced_plate(delta: Field, phase: Real, mount: tuple[Field, Field]) -> TwoPort:
    """Return a plate between two half-spaces of its mount.

    A slice so thin that its transfer matrix exp(i k0 h Δ) is a short series is put together with itself, that with
    itself, and so on: 2^m slices in m steps. Nothing is asked of the waves inside, so that exactly critical incidence,
    where a forward and a backward wave fall together, is like any other. Rounding grows with the number of slices, to
    about 1e-15 k0 n d.

    Parameters
    ----------
    delta : Field
        Berreman's matrix, shape (N, 4, 4).
    phase : Real
        k0 d, shape (N,).
    mount : pair of Field
        Tangential fields of the mount's forward and backward waves as columns, shape (N, 4, 2).
    """
    size = float((phase * np.abs(delta).sum(axis=2).max(axis=1)).max(initial=0.0))
    doublings = max(0, int(np.ceil(np.log2(max(size, 1e-300) / THIN))))
    step = 1j * (phase / 2.0**doublings)[:, None, None] * delta
    transfer: Complex = np.broadcast_to(np.eye(4, dtype=np.complex128), delta.shape)
    term = transfer
    for order in range(1, TERMS + 1):
        term = product(term, step) / order
        transfer = transfer + term
    waves = np.concatenate(mount, axis=2).astype(np.complex128)
    m = np.asarray(np.linalg.solve(waves, product(transfer, waves)), np.complex128)
    back = np.asarray(np.linalg.inv(m[:, 2:, 2:]), np.complex128)
    slab = TwoPort(
        m[:, :2, :2] - product(m[:, :2, 2:], back, m[:, 2:, :2]),
        -product(back, m[:, 2:, :2]),
        back,
        product(m[:, :2, 2:], back),
    )
    for _ in range(doublings):
        slab = slab.then(slab)
    return slab
