"""Faces for Hypothesis to draw: between media of any kind, as special in their directions and indices as can be."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

from crystal_core.optics import Medium, Scattering, Wave, scatter
from crystal_core.optics.arrays import BoolArray, Real
from crystal_core.optics.indicatrix import optic_axes
from tests.reference.media import KINDS, Kind

__all__ = ["CLEAR", "Crystal", "DrawnFace", "assert_sound", "crystals", "drawn_faces", "frames"]

CLEAR = 1e-3
"""Angle to an optic axis, and normal component of a wave vector, above which each mode is known for itself."""

ANGLES = st.sampled_from((0.0, np.pi / 4, np.pi / 2, np.pi)) | st.floats(0.0, 2 * np.pi).map(lambda x: round(x, 9))
GAPS = st.sampled_from((0.0, 1e-15, 1e-12, 1e-8, 1e-4, 1e-2, -1e-2)) | st.floats(-0.4, 0.6).map(lambda x: round(x, 12))


@dataclass(frozen=True)
class Crystal:
    """One, two (o, e) or three principal indices on the rows of a frame (uniaxial: e on the third)."""

    indices: tuple[float, ...]
    frame: Real

    def medium(self) -> Medium:
        if len(self.indices) == 1:
            return Medium.isotropic(self.indices[0])
        if len(self.indices) == 2:
            return Medium.uniaxial(*self.indices, self.frame[2])
        return Medium.biaxial(self.indices, self.frame)

    def optic_axes(self) -> tuple[Real, ...] | None:
        """Return the directions that tell the modes apart, None if there are none."""
        if len(self.indices) == 2:
            return (self.frame[2],)
        return optic_axes(self.medium()) or None

    def is_near_axis(self, wave: Wave) -> BoolArray:
        """Return for which rays a wave is less than `CLEAR` from an optic axis, (N,)."""
        near = np.zeros(wave.k.shape[1], np.bool_)
        k = wave.k + 1j * wave.k_imag
        for axis in self.optic_axes() or ():
            across = np.abs(np.sum(np.cross(k, axis[:, None], axis=0) ** 2, axis=0))
            near |= across <= CLEAR**2 * np.sum(np.abs(k) ** 2, axis=0)
        return near

    def turned(self, rotation: Real) -> Crystal:
        return replace(self, frame=np.einsum("ij,kj->ki", rotation, self.frame))

    def scaled(self, factor: float) -> Crystal:
        return replace(self, indices=tuple(factor * n for n in self.indices))


@dataclass(frozen=True)
class DrawnFace:
    """A face with its normal (3,) and rays with tangential wave vectors (3, N)."""

    source: Crystal
    target: Crystal
    normal: Real
    tangential: Real

    def run(self) -> Scattering:
        return scatter(self.normal, self.tangential, self.source.medium(), self.target.medium())

    def reversed(self) -> DrawnFace:
        return DrawnFace(self.target, self.source, -self.normal, -self.tangential)

    def turned(self, rotation: Real) -> DrawnFace:
        k = np.einsum("ij,jn->in", rotation, self.tangential)
        return DrawnFace(self.source.turned(rotation), self.target.turned(rotation), rotation @ self.normal, k)

    def steep(self, s: Scattering) -> BoolArray:
        """Return for which rays every wave is away from grazing."""
        waves = (*s.incident, *s.reflected, *s.transmitted)
        return np.asarray(np.min([self.rise(wave) for wave in waves], axis=0) > CLEAR)

    def rise(self, wave: Wave) -> Real:
        """Return the size of a wave vector's normal component, (N,)."""
        return np.asarray(np.abs(np.sum(self.normal[:, None] * (wave.k + 1j * wave.k_imag), axis=0)))

    def apart(self, s: Scattering) -> BoolArray:
        """Return for which rays every mode is known for itself: away from optic axes, off the normal in glass."""
        ok = np.ones(self.tangential.shape[1], np.bool_)
        for crystal, waves in ((self.source, (*s.incident, *s.reflected)), (self.target, s.transmitted)):
            if crystal.optic_axes() is None:
                ok &= np.sum(self.tangential**2, axis=0) > CLEAR**2
                ok &= len(crystal.indices) == 1
            for wave in waves:
                ok &= ~crystal.is_near_axis(wave)
        return ok

    def sums_are_known(self, s: Scattering) -> BoolArray:
        """Return for which rays what is summed over modes is known even near an optic axis.

        There both waves of a pair must be. Where the face cuts the cone of rays of a biaxial axis, one of the two waves
        goes forward and one back, and how the field divides depends on where exactly k lies about the axis.
        """
        ok = np.ones(self.tangential.shape[1], np.bool_)
        for crystal, pair in ((self.source, s.incident), (self.source, s.reflected), (self.target, s.transmitted)):
            ok &= crystal.is_near_axis(pair[0]) == crystal.is_near_axis(pair[1])
        return ok


def spent(s: Scattering, j: int) -> np.ndarray:
    return s.power_reflected[0][j] + s.power_reflected[1][j] + s.power_transmitted[0][j] + s.power_transmitted[1][j]


def assert_sound(s: Scattering, bound: float | np.ndarray = 1e-12) -> None:
    """No NaN, no power below 0, no energy lost; waves of unit field."""
    for j in (0, 1):
        free = s.incident[j].propagating
        assert (np.abs(spent(s, j) - 1.0) <= bound)[free].all(), spent(s, j)
        for table in (s.power_reflected, s.power_transmitted):
            for i in (0, 1):
                assert (table[i][j][free] >= 0.0).all()
                assert np.isnan(table[i][j][~free]).all()
    for wave in (*s.incident, *s.reflected, *s.transmitted):
        free = wave.propagating
        np.testing.assert_allclose(np.sum(np.abs(wave.field) ** 2, axis=0), 1.0, atol=1e-13)
        np.testing.assert_allclose(np.sum(wave.ray**2, axis=0)[free], 1.0, atol=1e-13)
        assert np.isfinite(wave.k).all()
        assert np.isfinite(wave.k_imag).all()


@st.composite
def frames(draw: st.DrawFn) -> Real:
    """Draw three orthonormal rows of either handedness, often along the axes or half-way between them."""
    a, b, c = draw(ANGLES), draw(ANGLES), draw(ANGLES)
    about_z = np.array(((np.cos(a), np.sin(a), 0), (-np.sin(a), np.cos(a), 0), (0, 0, 1)))
    about_x = np.array(((1, 0, 0), (0, np.cos(b), np.sin(b)), (0, -np.sin(b), np.cos(b))))
    again = np.array(((np.cos(c), np.sin(c), 0), (-np.sin(c), np.cos(c), 0), (0, 0, 1)))
    frame = again @ about_x @ about_z
    return frame * np.array(((draw(st.sampled_from((1.0, -1.0))),), (1.0,), (1.0,)))


@st.composite
def crystals(draw: st.DrawFn, kinds: tuple[Kind, ...] = KINDS) -> Crystal:
    """Draw a medium with indices from 0.9 to 2.9; often two of them are equal, or nearly."""
    count = 1 + KINDS.index(draw(st.sampled_from(kinds)))
    first = draw(st.floats(1.0, 1.8) | st.just(1.5))
    others = [max(0.9, first * (1.0 + draw(GAPS))) for _ in range(count - 1)]
    return Crystal((first, *others), draw(frames()))


@st.composite
def drawn_faces(draw: st.DrawFn, kinds: tuple[Kind, ...] = KINDS) -> DrawnFace:
    """Draw a face with a few rays: at normal, critical and grazing incidence, along optic axes, or anywhere."""
    source, target = draw(crystals(kinds)), draw(crystals(kinds))
    if draw(st.booleans()) and len(source.indices) == len(target.indices):
        target = replace(target, indices=source.indices)
    x, y, z = draw(frames())
    largest = max(source.indices)
    rays = []
    for _ in range(4):
        special = draw(st.integers(0, 3))
        if special == 0:
            crystal = draw(st.sampled_from((source, target)))
            axes = crystal.optic_axes()
            if axes is not None:
                k = np.median(crystal.indices if len(crystal.indices) == 3 else crystal.indices[:1]) * axes[0]
                across = k - (k @ z) * z
                rays.append(across - (across @ z) * z)
                continue
        azimuth = draw(ANGLES)
        direction = np.cos(azimuth) * x + np.sin(azimuth) * y
        if special == 1:
            size = draw(st.sampled_from((*source.indices, *target.indices)))
            rays.append(min(size, largest) * direction)
        else:
            fraction = draw(st.sampled_from((0.0, 1e-12, 1e-6, 0.5, 0.999)) | st.floats(0.0, 0.999))
            rays.append(fraction * largest * direction)
    return DrawnFace(source, target, z, np.array(rays).T)
