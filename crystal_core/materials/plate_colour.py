"""The colour of a stack of plates between polars, in daylight."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from crystal_core.errors import InputError
from crystal_core.optics.arrays import Real
from crystal_core.optics.plates import Coherence, Plate, plate_stack
from crystal_core.optics.retardation import path_lengths_nm
from crystal_core.spectra.colour import D65_WHITE_XYZ, encode_srgb, xyz_to_linear_srgb
from crystal_core.spectra.illuminants import d65
from crystal_core.spectra.observer import colour_matching

__all__ = ["LONGEST_NM", "SHORTEST_NM", "PlateColour", "plate_colours", "transmittance", "wavelength_grid"]

SHORTEST_NM = 380.0
LONGEST_NM = 780.0
"""Ends of the grid: beyond them the eye has less than 1e-5 of daylight."""

SAMPLES_PER_FRINGE = 8.0

MOST_SAMPLES = 1_000_000
"""Most wavelengths times plates: some fifteen seconds of work. Enough for an exact plate of 1 cm of calcite."""

CHUNK = 8192
"""Wavelengths computed at a time: what the processor's cache holds."""


@dataclass(frozen=True, slots=True)
class PlateColour:
    """A colour seen through a stack.

    Parameters
    ----------
    xyz : Real
        Tristimulus values, Y = 1 for white, shape (3,).
    srgb : Real
        sRGB as stored in files, 0 to 1, linear channels clipped to 0 … 1 before they are encoded, shape (3,).
    """

    xyz: Real
    srgb: Real


def transmittance(mueller: Real, polarizer_deg: float | None, analyser_deg: float | None) -> Real:
    """Return the share of unpolarized light that gets through polarizer, stack and analyser, shape (N,).

    The unit is what the same polars let through without a stack when they are parallel: the open field between
    parallel polars is 1, the open field between crossed ones 0. Without a polar, too, the open field is 1.

    Parameters
    ----------
    mueller : Real
        Mueller matrices of the stack, transmitted, shape (4, 4, N).
    polarizer_deg, analyser_deg : float or None
        Directions that pass before and behind the stack, degrees from x towards y; None for no polar.

    Raises
    ------
    InputError
        An angle that is not finite.
    """
    before, behind = _polar(polarizer_deg, "/polarizer_deg"), _polar(analyser_deg, "/analyser_deg")
    passed = np.einsum("i,ijn,j->n", behind, mueller, before)
    both = polarizer_deg is not None and analyser_deg is not None
    return np.asarray(0.5 * passed if both else passed)


def plate_colours(
    describe: Callable[[Real], Sequence[Plate]],
    mount_index: float,
    polarizer_deg: float | None,
    analyser_deg: float | None,
    coherent: Coherence = "exact",
) -> PlateColour:
    """Return the colour of a stack in light along +z: D65, CIE 1931 2° observer, white = open field.

    The spectrum is computed on a grid of its own, fine enough for the fringes of the stack (`wavelength_grid`).

    Parameters
    ----------
    describe : callable
        Takes wavelengths, nm, (N,), and returns the plates with their media at them.
    mount_index : float
        Index of the medium on both sides.
    polarizer_deg, analyser_deg : float or None
        See `transmittance`.
    coherent : "exact", "single-pass" or "incoherent"
        See `optics.plates`.

    Raises
    ------
    InputError
        The stack is so thick that its fringes would take too many wavelengths (`wavelength_grid`); whatever
        `plate_stack` and `transmittance` do not take.
    """
    wavelengths = wavelength_grid(describe, coherent)
    weights = d65(wavelengths) * colour_matching(wavelengths)
    seen, white = np.zeros(3), weights.sum(axis=1)
    for start in range(0, wavelengths.size, CHUNK):
        part = slice(start, start + CHUNK)
        optics = plate_stack(describe(wavelengths[part]), wavelengths[part], mount_index, coherent=coherent)
        passed = transmittance(optics.mueller_transmitted, polarizer_deg, analyser_deg)
        seen += (weights[:, part] * passed).sum(axis=1)
    xyz = seen / white * np.array(D65_WHITE_XYZ)
    return PlateColour(xyz, encode_srgb(np.clip(xyz_to_linear_srgb(xyz), 0.0, 1.0)))


def wavelength_grid(describe: Callable[[Real], Sequence[Plate]], coherent: Coherence) -> Real:
    """Return equidistant wavelengths, nm, 380 to 780, fine enough for every fringe of a stack.

    A step is at most 1 nm and λ²/(8 Γ), Γ the retardation or, with dispersion, Γ − λ dΓ/dλ, whichever is larger: eight
    samples a fringe. Where plates may not share axes Γ is the sum of all. With "exact" the same holds for the fringes
    of multiple beams, whose path is 2 Σ n d; the incoherent sum has no fringes.

    Raises
    ------
    InputError
        More than 1,000,000 would be needed, divided by the number of plates.
    """
    grid = np.linspace(SHORTEST_NM, LONGEST_NM, round(LONGEST_NM - SHORTEST_NM) + 1)
    plates = describe(grid)
    if coherent == "incoherent" or not plates:
        return grid
    difference, there_and_back = path_lengths_nm(plates, grid)
    steps = [np.ones(1)]
    for path in (difference, there_and_back) if coherent == "exact" else (difference,):
        group = np.abs(path - grid * np.gradient(path, grid))
        steps.append(grid * grid / (SAMPLES_PER_FRINGE * np.maximum(np.maximum(path, group), 1e-9)))
    count = int(np.ceil((LONGEST_NM - SHORTEST_NM) / min(float(step.min()) for step in steps))) + 1
    if count * len(plates) > MOST_SAMPLES:
        other = '"single-pass" or "incoherent"' if coherent == "exact" else '"incoherent"'
        raise InputError.at(
            "/plates",
            f"the fringes of so thick a stack need {count} wavelengths for each of {len(plates)} plates, more than "
            f"{MOST_SAMPLES} in all; thinner plates or coherent = {other} need fewer",
        )
    return np.linspace(SHORTEST_NM, LONGEST_NM, count)


def _polar(angle_deg: float | None, pointer: str) -> Real:
    """Return the Stokes vector that a polar passes, of twice its power, or what an analyser takes of one."""
    if angle_deg is None:
        return np.array((1.0, 0.0, 0.0, 0.0))
    if not np.isfinite(angle_deg):
        raise InputError.at(pointer, "the angle of a polar must be finite")
    double = 2.0 * np.radians(angle_deg)
    return np.array((1.0, np.cos(double), np.sin(double), 0.0))
