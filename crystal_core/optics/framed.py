"""A medium in the frame of an interface, and what the kinds of media have in common there."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from crystal_core.optics.arrays import BoolArray, Field, Rays, Real
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Mode

__all__ = ["ClosedForm", "FramedMedium", "signed_root"]

BOTH_SIGNS = np.array(((1.0,), (-1.0,)))
"""For waves along and against the normal in one go: half the calls for the same arithmetic."""


class FramedMedium(ABC):
    """The four waves of a medium that share a tangential wave vector; `eigenwaves.framed` makes one of a medium.

    Parameters
    ----------
    medium : Medium
        The medium.
    frame : InterfaceFrame
        Plane of incidence of each ray.
    """

    def __init__(self, medium: Medium, frame: InterfaceFrame) -> None:
        self.medium = medium
        self.frame = frame

    @abstractmethod
    def take(self, rays: Rays) -> FramedMedium:
        """Return the same for a selection of rays."""

    @abstractmethod
    def propagating(self) -> tuple[BoolArray, BoolArray]:
        """Return, for each of the two modes, whether it propagates, shape (N,) each.

        A wave exactly at its limit (no flux along the normal) counts as propagating.
        """

    def crowded(self) -> BoolArray:
        """Return where a forward and a backward wave all but coincide without slanting, shape (N,)."""
        return np.zeros(self.frame.kappa.shape, np.bool_)

    @abstractmethod
    def pair(self, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
        """Return the two waves whose energy goes along sign·normal (evanescent ones: that decay along it).

        Parameters
        ----------
        sign : int
            +1 or −1.
        evanescent : bool
            Whether a wave of this batch may be evanescent: then the arithmetic is complex. With False every wave must
            propagate (see `propagating`).
        """

    def both_pairs(self, evanescent: bool) -> tuple[tuple[Mode, Mode], tuple[Mode, Mode]]:
        """Return the pairs of `pair` for +1 and for −1."""
        return self.pair(+1, evanescent), self.pair(-1, evanescent)


class ClosedForm(FramedMedium):
    """A medium whose waves in both directions follow from one formula with a sign: computed together."""

    def pair(self, sign: int, evanescent: bool) -> tuple[Mode, Mode]:
        """Return the waves along sign·normal, as `FramedMedium.pair` says."""
        return self._pair(float(sign), evanescent)

    def both_pairs(self, evanescent: bool) -> tuple[tuple[Mode, Mode], tuple[Mode, Mode]]:
        """Return the pairs of `pair` for +1 and for −1, computed together."""
        first, second = self._pair(BOTH_SIGNS.astype(self.frame.kappa.dtype), evanescent)
        return (first.half(0), second.half(0)), (first.half(1), second.half(1))

    @abstractmethod
    def _pair(self, sign: float | Real, evanescent: bool) -> tuple[Mode, Mode]:
        """Return a pair of modes; a sign of shape (2, 1) gives arrays of shape (2, N)."""


def signed_root(square: Real, evanescent: bool) -> Field:
    """Return √square, with Im ≥ 0 where it is negative: a wave along +normal decays with it."""
    if not evanescent:
        return np.sqrt(square)
    root = np.empty(square.shape, np.result_type(square, np.complex64))
    root.real = np.sqrt(np.maximum(square, 0.0))
    root.imag = np.sqrt(np.maximum(-square, 0.0))
    return root
