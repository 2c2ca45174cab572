"""The wavefront: backward rays into the specimen, from face to face, and out to the surroundings.

A backward ray is traced as light that starts at the camera: the index surface is centrosymmetric, so the path is the
same, and by reciprocity so are the powers. What it carries is the importance W as C = conj(W) (`optics.Coherency`);
inside an anisotropic crystal, where the two modes are followed as rays of their own, one number per ray.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from time import perf_counter
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from crystal_core.optics import Coherency, Medium
from crystal_core.render.rays import BATCH, InsideRays, Pool
from crystal_core.render.surroundings import Surroundings
from crystal_core.scene import StagedSpecimen

__all__ = ["AIR", "MAX_DEPTH", "Arrivals", "Events", "Roulette", "Stopwatch", "Tracer"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]

AIR = Medium.isotropic(1.0)

MAX_DEPTH = 32
"""Faces after which every branch, however heavy, comes under roulette: light trapped by total reflection."""

SURVIVAL_BEYOND = 0.95
"""Chance per face of those branches: light trapped in a calcite block loses about as much of its energy."""

FEW = 1 / 256
"""Rays left, as a part of those that arrived, when they go to the wheel together: they would take a hundred faces more
in ever smaller batches, each of which costs numpy as much as a batch of some thousand rays."""

CHANCE_OF_FEW = 0.25
"""Chance that they all go on, with weights made up for it. They carry a thousandth of the tile's light; much
heavier ones would show, as specks."""


@dataclass(slots=True)
class Arrivals:
    """Backward rays that meet the specimen from outside.

    Parameters
    ----------
    point, direction : Real
        On the face, mm, and unit, shape (3, N).
    face : Index
        Shape (N,).
    importance : Coherency
        In the transverse frame of `direction`.
    lane, colour : Index
        Pixel-and-wavelength, and place of the wavelength in the pass, shape (N,).
    """

    point: Real
    direction: Real
    face: Index
    importance: Coherency
    lane: Index
    colour: Index


@dataclass(slots=True)
class Leaving:
    """Backward rays that go out into air: importance is the trace, as nothing polarizing is left on their way."""

    point: Real
    direction: Real
    importance: Real
    lane: Index

    @classmethod
    def joined(cls, parts: list[Leaving]) -> Leaving:
        """Return several as one."""
        if len(parts) == 1:
            return parts[0]
        if not parts:
            return cls(np.empty((3, 0)), np.empty((3, 0)), np.empty(0), np.empty(0, np.intp))
        return cls(
            np.concatenate([part.point for part in parts], axis=1),
            np.concatenate([part.direction for part in parts], axis=1),
            np.concatenate([part.importance for part in parts]),
            np.concatenate([part.lane for part in parts]),
        )


@dataclass(slots=True)
class Roulette:
    """Ends light branches at random without bias.

    Parameters
    ----------
    below : float
        Importance under which a branch is put to the wheel.
    random : numpy.random.Generator
        Its numbers.
    """

    below: float
    random: np.random.Generator

    def survivors(self, importances: tuple[Real, ...], depth: NDArray[np.int16]) -> list[tuple[Index, Real]]:
        """Return, for each sibling, which of the branches go on, and the factor that makes up for those that do not.

        Siblings share one random number (systematic sampling): each goes on with its own chance, but as few or as
        many together as those chances add up to. Two faint modes that leave one reflection thus mostly leave one ray
        with the weight of both, where independent draws would let the number of rays drift from face to face.

        Parameters
        ----------
        importances : tuple of Real
            Of the siblings that one ray splits into, shape (N,) each.
        depth : NDArray
            Faces met, shape (N,).
        """
        drawn = self.random.random(depth.size)
        scale = 1.0 / self.below
        survival = np.where(depth >= MAX_DEPTH, SURVIVAL_BEYOND, 1.0)
        before: Real = np.zeros(depth.size)
        result = []
        for importance in importances:
            chance = np.minimum(importance * scale, 1.0) * survival
            after = before + chance
            # Does one of the points drawn, drawn + 1, … lie in [before, after)?
            kept = np.flatnonzero(np.floor(after - drawn) > np.floor(before - drawn))
            result.append((kept, 1.0 / chance[kept]))
            before = after
        return result


@dataclass(slots=True)
class Stopwatch:
    """Seconds per stage."""

    seconds: dict[str, float] = field(default_factory=dict)
    _last: float = field(default_factory=perf_counter)

    def restart(self) -> None:
        """Begin a stage."""
        self._last = perf_counter()

    def stop(self, stage: str) -> None:
        """Charge the time since the last call to `stage`, and begin the next."""
        now = perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - self._last
        self._last = now


class Events(Protocol):
    """What happens at the faces of one kind of crystal."""

    lossless: bool
    """Whether the crystal absorbs nothing."""

    modes: int
    """Number of kinds of rays inside, each with its pool."""

    def enter(self, arrivals: Arrivals, roulette: Roulette) -> tuple[Leaving, list[InsideRays]]:
        """Return the reflected rays and, per mode, the refracted ones."""
        ...

    def leave(self, rays: InsideRays, mode: int, roulette: Roulette) -> tuple[Leaving, list[InsideRays]]:
        """Carry rays to the next face; return those that go out and, per mode, those reflected inside."""
        ...


class Tracer:
    """Traces the arrivals of a level's passes together and adds up what they see.

    In a lossless crystal the importance that arrives is the importance that leaves, whichever way, so a radiance that
    is the same everywhere needs no tracing. The usual radiance of the surroundings is therefore added whole at arrival,
    and only what is seen more or less than it is traced (a control variate): what roulette takes or gives weighs less.

    Parameters
    ----------
    events : Events
        Of the specimen's crystal at the wavelengths of the passes.
    surroundings : Surroundings
        At the same wavelengths.
    colours : int
        Number of wavelengths of all passes together; lane = pixel · colours + colour.
    lanes : int
        Number of lanes.
    """

    def __init__(
        self, events: Events, surroundings: Surroundings, colours: int, lanes: int, roulette: Roulette, watch: Stopwatch
    ) -> None:
        self.events_done = 0
        self._arrived = 0
        self._radiance = np.zeros(lanes)
        self._seen: list[tuple[Index, Real]] = []
        self._seen_count = 0
        self._events = events
        self._surroundings = surroundings
        self._colours = colours
        self._roulette = roulette
        self._watch = watch
        self._usual = surroundings.usual if events.lossless else 0.0
        self._pools = tuple(Pool() for _ in range(events.modes))

    def arrive(self, arrivals: Arrivals) -> None:
        """Take rays in; call `finish` after the last."""
        self._watch.restart()
        self._arrived += arrivals.lane.size
        if self._usual:
            self._seen.append((arrivals.lane, self._usual * arrivals.importance.intensity()))
        leaving, inside = self._events.enter(arrivals, self._roulette)
        self._settle(arrivals.lane.size, leaving, inside)
        self._drain(len(self._pools) * BATCH)

    def finish(self) -> Real:
        """Trace what still waits; return the radiance of each lane."""
        self._drain(1 + int(FEW * self._arrived))
        if self._roulette.random.random() < CHANCE_OF_FEW:
            self._make_up_for(CHANCE_OF_FEW)
            self._drain(1)
        self._add_up()
        return self._radiance

    def _drain(self, least: int) -> None:
        """Work while `least` rays wait."""
        while sum(len(pool) for pool in self._pools) >= least:
            mode = max(range(len(self._pools)), key=lambda m: len(self._pools[m]))
            self._watch.restart()
            rays = self._pools[mode].pop()
            leaving, inside = self._events.leave(rays, mode, self._roulette)
            self._settle(len(rays), leaving, inside)

    def _make_up_for(self, chance: float) -> None:
        """Make the rays that wait, and what roulette takes for heavy, heavier by 1/chance."""
        for pool in self._pools:
            for rays in pool:
                rays.importance[:] /= chance
        self._roulette.below /= chance

    def _settle(self, count: int, leaving: Leaving, inside: list[InsideRays]) -> None:
        self._watch.stop("interfaces")
        self.events_done += count
        for pool, rays in zip(self._pools, inside, strict=True):
            pool.push(rays)
        colour = leaving.lane % self._colours
        radiance = self._surroundings.radiance(leaving.point, leaving.direction, colour)
        seen = leaving.importance * (radiance - self._usual)
        self._seen.append((leaving.lane, seen))
        self._seen_count += seen.size
        if self._seen_count > self._radiance.size:
            self._add_up()
        self._watch.stop("page")

    def _add_up(self) -> None:
        """Add what was seen to the lanes: seldom, as each time costs a walk over all of them."""
        if self._seen:
            lanes = np.concatenate([lane for lane, _ in self._seen])
            values = np.concatenate([value for _, value in self._seen])
            self._radiance += np.bincount(lanes, weights=values, minlength=self._radiance.size)
        self._seen, self._seen_count = [], 0


def face_normals(specimen: StagedSpecimen) -> Real:
    """Return the outward normals as columns, shape (3, F), ready to be gathered per ray."""
    return np.ascontiguousarray(specimen.body.normals.T)
