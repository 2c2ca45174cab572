"""Optical constants of a mineral's entry, evaluated, and its medium in the world."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.errors import InputError
from crystal_core.optics import Medium
from minerals_db import Mineral

__all__ = ["SODIUM_D_NM", "gyration", "medium", "principal_indices"]

Real = NDArray[np.float64]

SODIUM_D_NM = 589.3
"""Mean of the sodium doublet, at which mineralogists quote indices."""

ROTATION_TOLERANCE = 1e-9
"""How far R Rᵀ may stand from 1: far above rounding, far below any direction known by measurement."""

_ALONG_AND_ACROSS = np.diag((0.0, 0.0, 1.0)), np.diag((1.0, 1.0, 0.0))

_CURVES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"isotropic": ("n",), "uniaxial": ("o", "e"), "biaxial": ("a", "b", "c")}
)
"""Names of the principal curves by optical class. Biaxial entries are orthorhombic: the schema takes no others."""


def principal_indices(mineral: Mineral, wavelength_nm: ArrayLike) -> tuple[Real, ...]:
    """Return the principal indices of a mineral.

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    wavelength_nm : array_like, shape (...)
        Vacuum wavelengths, nm. Outside a curve's range the value at its nearer end is taken.

    Returns
    -------
    tuple of float64 arrays, shape (...) each
        (n,) of an isotropic, (n_o, n_e) of a uniaxial mineral, (n_a, n_b, n_c) of an orthorhombic one for waves that
        vibrate along the axes a, b, c of its cell; which of them is α, β or γ may change with the wavelength.
    """
    wavelengths = np.asarray(wavelength_nm, np.float64)
    return tuple(mineral.dispersion[axis].index(wavelengths) for axis in _CURVES[mineral.optical_class])


def gyration(mineral: Mineral, wavelength_nm: ArrayLike) -> Real | None:
    """Return the gyration tensor of a mineral in its crystal frame.

    Along the optic axis the two circular waves have n² = n_o² ± G with G = g33 (Landau & Lifshitz, Electrodynamics of
    Continuous Media, 2nd ed., §104), so that the plane of polarization turns by ρ = π g33/(λ n_o) per length: clockwise
    for an observer who faces the source if g33 > 0, as in right crystals. g11 = g22 is g33 times the entry's ratio
    g11/g33, at every wavelength; where the ratio is not known the entry says what was taken (status `estimated`).

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    wavelength_nm : array_like, shape () or (N,)
        Vacuum wavelengths, nm. Outside the range of the rotatory power the value at its nearer end is taken.

    Returns
    -------
    float64 array, shape (3, 3) or (3, 3, N), or None
        None if the entry knows of no optical rotation.
    """
    rotation = mineral.optical_rotation
    if rotation is None:
        return None
    wavelengths = np.asarray(wavelength_nm, np.float64)
    n_o, _ = principal_indices(mineral, wavelengths)
    radians_per_mm = np.deg2rad(rotation.along_axis.degrees_per_mm_at(wavelengths))
    sense = {"right": 1.0, "left": -1.0}[rotation.hand.sense]
    g33 = sense * radians_per_mm * (wavelengths * 1e-6) * n_o / np.pi
    along, across = _ALONG_AND_ACROSS
    return np.asarray(np.multiply.outer(along + rotation.across_to_along.ratio * across, g33))


def medium(mineral: Mineral, wavelength_nm: ArrayLike, rotation: ArrayLike | None = None) -> Medium:
    """Return the medium of a mineral that is turned into the world, with its gyration tensor if it is optically active.

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    wavelength_nm : array_like, shape () or (N,)
        Vacuum wavelength of each ray, nm.
    rotation : array_like, shape (3, 3), optional
        R of v_world = R v_crystal, a proper rotation; the crystal frame has x ∥ a, z ∥ c*, y = z × x. The optic axis of
        a uniaxial crystal is R's third column, the axes a, b, c of an orthorhombic one are its three columns. The
        identity if left out.

    Raises
    ------
    InputError
        A wavelength that is not finite and positive, or a rotation that is none. A mirror image is no rotation: the
        crystal would be one of the other hand.
    """
    wavelengths = np.asarray(wavelength_nm, np.float64)
    if wavelengths.ndim > 1 or not np.all(np.isfinite(wavelengths) & (wavelengths > 0)):
        raise InputError.at("/wavelength_nm", "wavelengths must be finite and positive, shape () or (N,)")
    turned = _rotation(rotation)
    indices = principal_indices(mineral, wavelengths)
    if len(indices) == 1:
        return Medium.isotropic(indices[0])
    if len(indices) == 2:
        inactive = Medium.uniaxial(indices[0], indices[1], turned[:, 2])
        tensor = gyration(mineral, wavelengths)
        return inactive if tensor is None else inactive.active(_turned(tensor, turned))
    return Medium.biaxial(indices, turned.T)


def _rotation(value: ArrayLike | None) -> Real:
    if value is None:
        return np.eye(3)
    matrix = np.asarray(value, np.float64)
    sound = matrix.shape == (3, 3) and bool(np.all(np.isfinite(matrix)))
    if not sound or np.abs(matrix @ matrix.T - np.eye(3)).max() > ROTATION_TOLERANCE or np.linalg.det(matrix) < 0:
        raise InputError.at("/rotation", "the rotation must be a proper one: orthonormal rows, determinant +1, (3, 3)")
    return matrix


def _turned(tensor: Real, rotation: Real) -> Real:
    """Return R g Rᵀ, exactly symmetric."""
    world = np.einsum("ij,jk...,lk->il...", rotation, tensor, rotation)
    return np.asarray(0.5 * (world + world.swapaxes(0, 1)))
