"""Random faces between media of every class, with the independent answer to each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crystal_core.optics import Scattering, scatter
from tests.reference.arithmetic import Array
from tests.reference.berreman import Mode, Scattered, dot, scatter_reference
from tests.reference.media import Kind, Media, random_media, random_units

__all__ = ["Cases", "angle_to_axes", "as_float", "is_fair", "random_cases"]

STEERED = 0.3
"""Share of the cases sent to where a biaxial surface is dimpled."""


@dataclass(frozen=True)
class Cases:
    """Faces with normals (3, N) from source to target, and tangential wave vectors (3, N)."""

    source: Media
    target: Media
    normal: Array
    tangential: Array

    def run(self) -> Scattering:
        return scatter(self.normal, self.tangential, self.source.medium(), self.target.medium())

    def reversed(self) -> Cases:
        """Return the same faces met from the far side by -k."""
        return Cases(self.target, self.source, -self.normal, -self.tangential)

    def take(self, cases: Array) -> Cases:
        return Cases(self.source.take(cases), self.target.take(cases), self.normal[:, cases], self.tangential[:, cases])

    def truth(self, case: int, digits: int | None = None) -> Scattered:
        """Return the independent answer, to 40 digits where double precision would not do."""
        result = scatter_reference(
            self.normal[:, case],
            self.tangential[:, case],
            self.source.tensor(case, digits),
            self.target.tensor(case, digits),
            source_axis=self.source.label_axis(case),
            target_axis=self.target.label_axis(case),
            digits=digits,
        )
        if digits is None:
            sides = (
                (self.source.kind, (*result.incident, *result.backward)),
                (self.target.kind, result.forward),
            )
            near = any(nearest(waves) < 1e-4 for kind, waves in sides if kind != "isotropic")
            steep = any(abs(dot(m.k, m.normal)) < 1e-2 for _, waves in sides for m in waves)
            if near or steep:
                return self.truth(case, 40)
        return result


def nearest(waves: tuple[Mode, ...]) -> float:
    """Return the least distance between two of the wave vectors."""
    return min(float(np.abs(p.k - q.k).max()) for i, p in enumerate(waves) for q in waves[:i])


def random_cases(seed: int, source: Kind, target: Kind, count: int) -> Cases:
    """Return faces at random, the tangential k up to 0.999 of the largest index of the source."""
    rng = np.random.default_rng(seed)
    first, second = random_media(rng, source, count), random_media(rng, target, count)
    normal = random_units(rng, count)
    across = np.cross(normal, random_units(rng, count), axis=0)
    across /= np.linalg.norm(across, axis=0)
    across -= normal * np.sum(normal * across, axis=0)
    tangential = across * rng.uniform(0, 0.999, count) * first.largest
    for media in (second, first):
        if media.kind == "biaxial":
            _steer(rng, media, first.largest, normal, tangential)
    return Cases(first, second, normal, tangential)


def _steer(rng: np.random.Generator, media: Media, largest: Array, normal: Array, tangential: Array) -> None:
    """Send some cases, in place, to the dimples of the outer sheet, where it takes all four waves.

    About an optic axis the outer sheet is a funnel of the slope c = tan(chi)/2, chi the angle of internal conical
    refraction, under a lid that touches it along a circle. Lines across the axis, just beyond the funnel's tip, meet
    the outer sheet four times.
    """
    for case in np.flatnonzero(rng.random(normal.shape[1]) < STEERED):
        a, b, c = np.sort(media.indices[:, case])
        axis = media.optic_axes(int(case))[int(rng.integers(2))]
        slope = np.sqrt((c * c - b * b) * (b * b - a * a)) / (a * c) / 2
        reach = b * (1 + slope * slope * rng.uniform() ** 2)
        across = np.cross(axis, random_units(rng, 1)[:, 0])
        across /= np.linalg.norm(across)
        along = axis - across * np.sum(across * axis)
        if slope > 0.02 and reach < 0.999 * largest[case]:
            normal[:, case] = across
            tangential[:, case] = reach * along


def as_float(v: Array) -> Array:
    return np.array([complex(x) for x in v])


def angle_to_axes(k: Array, axes: list[Array]) -> float:
    """Return the angle in radians between a real wave vector and the nearest of some axes, infinity without one."""
    length = np.linalg.norm(k)
    return min((float(np.linalg.norm(np.cross(k, axis)) / length) for axis in axes), default=float("inf"))


def is_fair(truth: Scattered, cases: Cases, case: int) -> bool:
    """Whether every wave is at least 1e-3 rad from the optic axes and has |k_n| >= 1e-3."""
    source, target = cases.source.optic_axes(case), cases.target.optic_axes(case)
    for pair, axes in ((truth.incident, source), (truth.backward, source), (truth.forward, target)):
        for mode in pair:
            k = as_float(mode.k)
            if abs(k @ as_float(mode.normal)) < 1e-3:
                return False
            if mode.propagating and angle_to_axes(k.real, axes) < 1e-3:
                return False
    return True
