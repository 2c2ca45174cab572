"""Where rays cross triangles, in float64 and without gaps: a tree of boxes, walked by all rays at once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crystal_core.geometry.body import dot

__all__ = ["Crossings", "TriangleTree"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]

_LEAF = 4
"""Triangles in a leaf."""

_CHUNK = 4096
"""Rays that walk the tree together."""

_PAIRS = 400_000
"""Pairs of ray and box at a time, where more than one ray is left to take apart: about 100 MB."""

_BITS = 10
"""Of each coordinate in the order of the leaves."""

_MARGIN = 1e-12
"""By which boxes are wider than their triangles, in units of the whole: rounding never hides a triangle."""


@dataclass(frozen=True)
class Crossings:
    """Pairs of a ray and a triangle that it crosses.

    Parameters
    ----------
    ray, triangle : NDArray of int
        Shape (P,).
    distance : Real
        In lengths of the direction, any sign, shape (P,).
    leaves : NDArray of bool
        Whether the ray goes from the inner to the outer side, shape (P,).
    """

    ray: Index
    triangle: Index
    distance: Real
    leaves: NDArray[np.bool_]


class TriangleTree:
    """Triangles in the order of a space-filling curve, under a complete binary tree of boxes.

    Parameters
    ----------
    corners : Real
        Corners of the triangles, counter-clockwise from outside, shape (T, 3, 3): triangle, corner, coordinate.

    Notes
    -----
    The test of a ray and a triangle is that of S. Woop, C. Benthin, I. Wald, Watertight Ray/Triangle Intersection, J.
    Computer Graphics Techniques 2(1), 2013: triangles that share an edge decide on it with the same products, so that
    no ray slips between them.
    """

    def __init__(self, corners: Real) -> None:
        self._corners = corners
        low, high = corners.min(axis=1), corners.max(axis=1)
        self.size = float((high.max(axis=0) - low.min(axis=0)).max())
        order = np.argsort(_curve(low + high), kind="stable")
        leaves = 1
        while leaves * _LEAF < len(order):
            leaves *= 2
        # Missing triangles of the last leaves: repeat the last one.
        filled = np.concatenate((order, np.full(leaves * _LEAF - len(order), order[-1])))
        self._order = filled.reshape(leaves, _LEAF)
        margin = _MARGIN * self.size
        lows = [low[self._order].min(axis=1) - margin]
        highs = [high[self._order].max(axis=1) + margin]
        while len(lows[-1]) > 1:
            lows.append(lows[-1].reshape(-1, 2, 3).min(axis=1))
            highs.append(highs[-1].reshape(-1, 2, 3).max(axis=1))
        self._levels = list(zip(reversed(lows), reversed(highs), strict=True))

    def nearest(self, origin: Real, direction: Real, *, leaving: bool, least: float = 0.0) -> tuple[Real, Index]:
        """Return the first triangle through which rays leave, or enter, what the triangles enclose.

        Parameters
        ----------
        origin, direction : Real
            Shape (3, N).
        leaving : bool
            Whether to look for triangles crossed outwards; else inwards.
        least : float
            Distance, in the unit of the triangles, from which on crossings count.

        Returns
        -------
        distance : Real
            In lengths of the direction; inf where there is none, shape (N,).
        triangle : NDArray of int
            −1 where there is none, shape (N,).
        """
        count = origin.shape[1]
        distance, triangle = np.full(count, np.inf), np.full(count, -1, np.intp)
        lengths = np.sqrt(dot(direction, direction))
        found = self.crossings(origin, direction, least=least)
        kept = (found.leaves == leaving) & (found.distance * lengths[found.ray] >= least)
        ray, number, far = found.ray[kept], found.triangle[kept], found.distance[kept]
        order = np.lexsort((number, far, ray))
        ray, first = np.unique(ray[order], return_index=True)
        distance[ray], triangle[ray] = far[order][first], number[order][first]
        return distance, triangle

    def crossings(self, origin: Real, direction: Real, *, least: float = -np.inf, until: float = np.inf) -> Crossings:
        """Return all crossings of rays, shape (3, N), with triangles, and perhaps some outside of what is asked for.

        Parameters
        ----------
        origin, direction : Real
            Shape (3, N).
        least : float
            Boxes nearer than this, in the unit of the triangles, are passed over.
        until : float
            Boxes farther than this, in lengths of the direction, are passed over.
        """
        parts = list(self.in_parts(origin, direction, least=least, until=until))
        return Crossings(
            np.concatenate([part.ray for part in parts]),
            np.concatenate([part.triangle for part in parts]),
            np.concatenate([part.distance for part in parts]),
            np.concatenate([part.leaves for part in parts]),
        )

    def in_parts(
        self, origin: Real, direction: Real, *, least: float = -np.inf, until: float = np.inf, most: float = np.inf
    ) -> Iterator[Crossings]:
        """Yield what `crossings` returns, for some rays after the others.

        Raises
        ------
        OverflowError
            More than `most` pairs of a ray and a triangle would have to be looked at.
        """
        waiting = [(start, min(start + _CHUNK, origin.shape[1])) for start in range(0, max(origin.shape[1], 1), _CHUNK)]
        waiting.reverse()
        while waiting:
            start, stop = waiting.pop()
            pairs = self._candidates(origin.T[start:stop], direction.T[start:stop], least, until)
            if pairs is None:
                middle = (start + stop) // 2
                waiting += [(middle, stop), (start, middle)]
                continue
            most -= len(pairs[0])
            if most < 0:
                raise OverflowError("more pairs of rays and triangles than are allowed")
            yield self._tested(origin.T[start:stop], direction.T[start:stop], *pairs, start)

    def _candidates(self, from_: Real, ahead: Real, least: float, until: float) -> tuple[Index, Index] | None:
        """Return rays, rows of shape (N, 3), and triangles in boxes that they meet; None if too many for once."""
        scale = np.abs(ahead).max(axis=1, initial=0.0)
        # A ray along a side of a box: any tiny speed sends the crossing far away, without 0/0.
        speed = np.where(ahead == 0.0, 1e-200 * np.where(scale > 0.0, scale, 1.0)[:, None], ahead)
        inverse = 1.0 / speed
        near_limit = (min(least, 0.0) - 1e-9 * self.size) / np.where(scale > 0.0, scale, 1.0)
        ray, node = np.arange(len(from_)), np.zeros(len(from_), np.intp)
        for depth, (low, high) in enumerate(self._levels):
            if depth:
                ray, node = np.repeat(ray, 2), np.stack((2 * node, 2 * node + 1), axis=-1).reshape(-1)
            if len(ray) > _PAIRS and len(from_) > 1:
                return None
            one, other = (low[node] - from_[ray]) * inverse[ray], (high[node] - from_[ray]) * inverse[ray]
            near, far = np.minimum(one, other).max(axis=1), np.maximum(one, other).min(axis=1)
            met = (near <= far) & (far >= near_limit[ray]) & (near <= until)
            ray, node = ray[met], node[met]
        ray, triangle = np.repeat(ray, _LEAF), self._order[node].reshape(-1)
        # The last triangle fills up the last leaves: once is enough.
        pairs = np.unique(ray * len(self._corners) + triangle)
        return pairs // len(self._corners), pairs % len(self._corners)

    def _tested(self, origin: Real, direction: Real, ray: Index, triangle: Index, first: int) -> Crossings:
        # Axes of each ray: z the one it goes along most; x and y such that triangles keep their sense.
        z = np.abs(direction).argmax(axis=1)
        x, y = (z + 1) % 3, (z + 2) % 3
        rows = np.arange(len(direction))
        back = direction[rows, z] < 0.0
        x, y = np.where(back, y, x), np.where(back, x, y)
        along = direction[rows, z]
        with np.errstate(divide="ignore", invalid="ignore"):  # no direction at all: no crossing
            shear_x, shear_y, shear_z = direction[rows, x] / along, direction[rows, y] / along, 1.0 / along
            flat = []
            for corner in range(3):
                relative = self._corners[triangle, corner] - origin[ray]
                pick = np.arange(len(ray))
                height = relative[pick, z[ray]]
                flat.append(
                    (
                        relative[pick, x[ray]] - shear_x[ray] * height,
                        relative[pick, y[ray]] - shear_y[ray] * height,
                        shear_z[ray] * height,
                    )
                )
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = flat
            u, v, w = cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax
            total = u + v + w
            inside = ((u >= 0.0) & (v >= 0.0) & (w >= 0.0)) | ((u <= 0.0) & (v <= 0.0) & (w <= 0.0))
            distance = (u * az + v * bz + w * cz) / total
        hit = inside & (total != 0.0) & np.isfinite(distance)
        return Crossings(ray[hit] + first, triangle[hit], distance[hit], total[hit] < 0.0)


def _curve(points: Real) -> NDArray[np.int64]:
    """Return places along Morton's curve, shape (T,)."""
    extent = np.ptp(points, axis=0).max()
    cells = ((points - points.min(axis=0)) / (extent if extent > 0.0 else 1.0) * (2**_BITS - 1)).astype(np.int64)
    place = np.zeros(len(points), np.int64)
    for bit in range(_BITS):
        for axis in range(3):
            place |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return place
