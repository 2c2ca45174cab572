"""Backward rays inside the specimen, as structures of arrays, and the pool from which full batches are taken."""

from __future__ import annotations

from collections.abc import Iterator
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

    def part(self, rays: slice) -> InsideRays:
        """Return some of the rays."""
        return InsideRays(self.state[:, rays], self.lane[rays], self.depth[rays])

    @classmethod
    def joined(cls, parts: list[InsideRays]) -> InsideRays:
        """Return several batches, at least one, as one."""
        if len(parts) == 1:
            return parts[0]
        return cls(
            np.concatenate([part.state for part in parts], axis=1),
            np.concatenate([part.lane for part in parts]),
            np.concatenate([part.depth for part in parts]),
        )


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

    def __iter__(self) -> Iterator[InsideRays]:
        """Iterate over the batches that wait."""
        return iter(self._waiting)

    def __len__(self) -> int:
        """Return the number of rays that wait."""
        return self._count

    def pop(self) -> InsideRays:
        """Take `BATCH` rays, or all if there are fewer, the newest first."""
        taken: list[InsideRays] = []
        wanted = BATCH
        while self._waiting and wanted:
            rays = self._waiting.pop()
            if len(rays) > wanted:
                self._waiting.append(rays.part(slice(wanted, None)))
                rays = rays.part(slice(0, wanted))
            taken.append(rays)
            wanted -= len(rays)
        self._count -= BATCH - wanted
        return InsideRays.joined(taken)
