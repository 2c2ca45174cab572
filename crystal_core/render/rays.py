"""Backward rays inside the specimen, as structures of arrays, and the pool from which full batches are taken."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

__all__ = ["BATCH", "InsideRays", "Pool"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]

BATCH = 16384
"""Rays worked on together: the arrays of one event stay in a core's cache, and numpy's overhead per call is shared."""


@dataclass(slots=True)
class InsideRays:
    """Backward rays of one mode inside the specimen.

    Parameters
    ----------
    state : Real
        Shape (10 or 13, N). Rows 0–2: point in mm; 3–5: direction of the energy, of any length; 6–8: wave vector in
        units of 2π/λ; from row 9: the importance, one row per mode of an anisotropic crystal, or the four of a
        coherency matrix (`Coherency`) in the transverse frame of the wave vector.
    lane : Index
        Pixel and wavelength the ray belongs to, shape (N,).
    depth : NDArray
        Faces met so far, shape (N,).
    """

    state: Real
    lane: Index
    depth: NDArray[np.int16]

    @property
    def point(self) -> Real:
        """Points, shape (3, N)."""
        return self.state[0:3]

    @property
    def ray(self) -> Real:
        """Directions of the energy, shape (3, N)."""
        return self.state[3:6]

    @property
    def k(self) -> Real:
        """Wave vectors, shape (3, N)."""
        return self.state[6:9]

    @property
    def importance(self) -> Real:
        """Shape (1, N) of a mode, (4, N) of a coherency matrix."""
        return self.state[9:]

    def __len__(self) -> int:
        """Return the number of rays."""
        return self.lane.size


@dataclass(slots=True)
class Pool:
    """Rays that wait; depths mix, so that batches stay full down to the last few."""

    _waiting: list[InsideRays] = field(default_factory=list)
    _count: int = 0

    def push(self, rays: InsideRays) -> None:
        """Add rays."""
        if len(rays):
            self._waiting.append(rays)
            self._count += len(rays)

    def __len__(self) -> int:
        """Return the number of rays that wait."""
        return self._count

    def pop(self) -> InsideRays:
        """Take up to about `BATCH` rays, the newest first."""
        taken = [self._waiting.pop()]
        count = len(taken[0])
        while self._waiting and count + len(self._waiting[-1]) <= BATCH:
            taken.append(self._waiting.pop())
            count += len(taken[-1])
        self._count -= count
        if len(taken) == 1:
            return taken[0]
        return InsideRays(
            np.concatenate([rays.state for rays in taken], axis=1),
            np.concatenate([rays.lane for rays in taken]),
            np.concatenate([rays.depth for rays in taken]),
        )
