"""Eigenwaves of an isotropic medium: s across the plane of incidence, p in it, both with k² = n²."""

from __future__ import annotations

import numpy as np

from crystal_core.optics.arrays import BoolArray, Rays, Real
from crystal_core.optics.framed import ClosedForm, signed_root
from crystal_core.optics.frames import InterfaceFrame
from crystal_core.optics.medium import Medium
from crystal_core.optics.modes import Mode

__all__ = ["FramedIsotropic"]


class FramedIsotropic(ClosedForm):
    """An isotropic medium in the frame of an interface: modes s and p, p = (q, 0, −κ)/n."""

    def __init__(self, medium: Medium, frame: InterfaceFrame) -> None:
        super().__init__(medium, frame)
        self._q2 = medium.indices[0] ** 2 - frame.kappa * frame.kappa

    def take(self, rays: Rays) -> FramedIsotropic:
        """Return the same for a selection of rays."""
        return FramedIsotropic(self.medium.take(rays), self.frame.take(rays))

    def propagating(self) -> tuple[BoolArray, BoolArray]:
        """Return whether s and p propagate, shape (N,) each."""
        free = self._q2 >= 0
        return free, free

    def _pair(self, sign: float | Real, evanescent: bool) -> tuple[Mode, Mode]:
        n = self.medium.indices[0]
        kappa = self.frame.kappa
        q = sign * signed_root(self._q2, evanescent)
        ray = (kappa, None, q)
        s = Mode(q, None, np.ones_like(kappa), None, -q, None, ray, "s")
        p = Mode(q, q / n, None, -kappa / n, None, np.broadcast_to(n, kappa.shape), ray, "p")
        return s, p
