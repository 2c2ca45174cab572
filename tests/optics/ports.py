"""The scattering matrix of a face between waves of unit Lorentz product, evanescent ones included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crystal_core.optics import InterfaceFrame, Medium, interface_frame
from crystal_core.optics.arrays import BoolArray, Complex, Real
from crystal_core.optics.eigenwaves import framed
from crystal_core.optics.interface import Face, solve_face
from crystal_core.optics.modes import Mode

__all__ = ["Port", "Ports", "ports"]


@dataclass(frozen=True)
class Port:
    """A wave at the face: wave vector and field, (3, N), and its Lorentz product along its own way, (N,)."""

    k: Complex
    e: Complex
    lorentz: Complex

    @classmethod
    def of(cls, mode: Mode, frame: InterfaceFrame, sign: float) -> Port:
        zero = np.zeros(mode.q.shape)
        e = frame.world(*(zero if v is None else v for v in (mode.ex, mode.ey, mode.ez)))
        return cls(frame.world(frame.kappa, None, mode.q) + 0j, e + 0j, sign * mode.norm() + 0j)

    def where(self, rays: BoolArray, other: Port) -> Port:
        """Return the other port on the rays given."""
        return Port(
            np.where(rays, other.k, self.k),
            np.where(rays, other.e, self.e),
            np.where(rays, other.lorentz, self.lorentz),
        )

    def factor_to(self, other: Port) -> Complex:
        """Return c of E = c E_other for two descriptions of one field."""
        return np.asarray(np.sum(np.conj(other.e) * self.e, axis=0) / np.sum(np.abs(other.e) ** 2, axis=0))

    def steepness(self) -> Real:
        """Return |Lorentz product| per |E|²: next to nothing where the wave grazes the face."""
        return np.asarray(np.abs(self.lorentz) / np.sum(np.abs(self.e) ** 2, axis=0))


@dataclass(frozen=True)
class Ports:
    """Waves towards and away from a face, 0 and 1 in the first medium, 2 and 3 in the second, and what joins them.

    ``amplitudes[i, j]``: of outgoing field i per incoming field j, shape (4, 4, N).
    """

    incoming: list[Port]
    outgoing: list[Port]
    amplitudes: Complex

    def matrix(self, incoming: list[Port], outgoing: list[Port]) -> Complex:
        """Return S, (4, 4, N), between √(2(E_x H_y − E_y H_x)), with the fields and norms of given ports.

        They are this face's own, or the partners of them that the face has in the reversed problem.
        """
        s = self.amplitudes.copy()
        for i in range(4):
            s[i] *= self.outgoing[i].factor_to(outgoing[i]) * np.sqrt(outgoing[i].lorentz)
            s[:, i] /= self.incoming[i].factor_to(incoming[i]) * np.sqrt(incoming[i].lorentz)
        return s

    def in_order(self, incoming: list[Complex], outgoing: list[Complex]) -> Ports:
        """Return the same with the waves of each pair in the order of given wave vectors, ray by ray."""
        ours, theirs, s = list(self.incoming), list(self.outgoing), self.amplitudes.copy()
        for first, second in ((0, 1), (2, 3)):
            swapped = _crossed(ours[first].k, ours[second].k, incoming[first], incoming[second])
            s[:, [first, second]] = np.where(swapped, s[:, [second, first]], s[:, [first, second]])
            ours[first], ours[second] = (
                ours[first].where(swapped, ours[second]),
                ours[second].where(swapped, ours[first]),
            )
            swapped = _crossed(theirs[first].k, theirs[second].k, outgoing[first], outgoing[second])
            s[[first, second]] = np.where(swapped, s[[second, first]], s[[first, second]])
            theirs[first], theirs[second] = (
                theirs[first].where(swapped, theirs[second]),
                theirs[second].where(swapped, theirs[first]),
            )
        return Ports(ours, theirs, s)


def _crossed(a: Complex, b: Complex, first: Complex, second: Complex) -> BoolArray:
    """Return for which rays (a, b) are (second, first); equal ones stay."""
    straight = np.abs(a - first).sum(axis=0) + np.abs(b - second).sum(axis=0)
    crossed = np.abs(a - second).sum(axis=0) + np.abs(b - first).sum(axis=0)
    return np.asarray(crossed < straight - 1e-9)


def ports(normal: Real, tangential_k: Real, first: Medium, second: Medium) -> Ports:
    """Return the ports of a face whose normal, (3, N), points from the first medium into the second."""
    here, here_frame = _face(normal, tangential_k, first, second)
    there, there_frame = _face(-normal, tangential_k, second, first)
    incoming = [Port.of(mode, here_frame, +1.0) for mode in here.incident]
    incoming += [Port.of(mode, there_frame, +1.0) for mode in there.incident]
    outgoing = [Port.of(mode, here_frame, -1.0) for mode in here.reflected]
    outgoing += [Port.of(mode, here_frame, +1.0) for mode in here.transmitted]
    # From the far side the same four waves go away, with their fields to another scale, maybe in another order.
    far = [Port.of(mode, there_frame, +1.0) for mode in there.transmitted]
    far += [Port.of(mode, there_frame, -1.0) for mode in there.reflected]

    s = np.zeros((4, 4, normal.shape[1]), np.complex128)
    for i in (0, 1):
        for j in (0, 1):
            s[i, j], s[2 + i, j] = here.reflection(i, j), here.transmission(j)[i]
            s[i, 2 + j], s[2 + i, 2 + j] = there.transmission(j)[i], there.reflection(i, j)
    by_far = Ports(incoming, far, s).in_order([p.k for p in incoming], [p.k for p in outgoing])
    for i in range(4):
        s[i, 2:] = by_far.amplitudes[i, 2:] * by_far.outgoing[i].factor_to(outgoing[i])
    return Ports(incoming, outgoing, s)


def _face(normal: Real, tangential_k: Real, source: Medium, target: Medium) -> tuple[Face, InterfaceFrame]:
    frame = interface_frame(normal, tangential_k)
    return solve_face(framed(source, frame), framed(target, frame), True, True), frame
