"""Optical constants of a mineral's entry, evaluated, and its medium in the world."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crystal_core.errors import InputError
from crystal_core.optics import Medium
from minerals_db import Mineral

__all__ = ["absorption_coefficients", "gyration", "medium", "principal_indices"]

Real = NDArray[np.float64]

ROTATION_TOLERANCE = 1e-9
"""How far R Rᵀ may stand from 1: far above rounding, far below any direction known by measurement."""

_ALONG_AND_ACROSS = np.diag((0.0, 0.0, 1.0)), np.diag((1.0, 1.0, 0.0))


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
        (n,) of an isotropic, (n_o, n_e) of a uniaxial mineral; of a biaxial one those for waves that vibrate along the
        rows of `mineral.principal_axes`: along a, b, c of an orthorhombic cell, else along what is α, β, γ at the D
        line. Which of them is smallest may change with the wavelength.
    """
    wavelengths = np.asarray(wavelength_nm, np.float64)
    return tuple(curve.index(wavelengths) for curve in mineral.dispersion.values())


def absorption_coefficients(
    mineral: Mineral, wavelength_nm: ArrayLike, concentrations: Mapping[str, float] | None = None
) -> tuple[Real, ...] | None:
    """Return the principal absorption coefficients of a mineral, in the order of `principal_indices`.

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    wavelength_nm : array_like, shape (...)
        Vacuum wavelengths, nm.
    concentrations : Mapping of str to float, optional
        Weight percent of the chromophores of the entry, by their keys; those left out stay as the entry has them.

    Returns
    -------
    tuple of float64 arrays, shape (...) each, or None
        Natural, of the intensity, mm⁻¹, for waves that vibrate along the rows of `mineral.absorption_axes`; None if
        the entry knows of no absorption.

    Raises
    ------
    InputError
        A chromophore that the entry does not have, or a negative concentration.
    """
    absorption = mineral.absorption
    if absorption is None:
        if concentrations:
            raise InputError.at("/concentrations", f"{mineral.id} has no chromophores")
        return None
    try:
        return tuple(absorption.per_mm(axis, wavelength_nm, concentrations) for axis in mineral.dispersion)
    except ValueError as error:
        raise InputError.at("/concentrations", str(error)) from None


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


def medium(
    mineral: Mineral,
    wavelength_nm: ArrayLike,
    rotation: ArrayLike | None = None,
    concentrations: Mapping[str, float] | None = None,
) -> Medium:
    """Return the medium of a mineral that is turned into the world, with its absorption and its gyration.

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    wavelength_nm : array_like, shape () or (N,)
        Vacuum wavelength of each ray, nm.
    rotation : array_like, shape (3, 3), optional
        R of v_world = R v_crystal, a proper rotation; the crystal frame has x ∥ a, z ∥ c*, y = z × x. The optic axis of
        a uniaxial crystal is R's third column; R takes the rows of `mineral.principal_axes` to the axes of the medium.
        The identity if left out.
    concentrations : Mapping of str to float, optional
        See `absorption_coefficients`.

    Raises
    ------
    InputError
        A wavelength that is not finite and positive, or a rotation that is none: a mirror image is no rotation, the
        crystal would be one of the other hand. Whatever `absorption_coefficients` does not take.
    """
    wavelengths = np.asarray(wavelength_nm, np.float64)
    if wavelengths.ndim > 1 or not np.all(np.isfinite(wavelengths) & (wavelengths > 0)):
        raise InputError.at("/wavelength_nm", "wavelengths must be finite and positive, shape () or (N,)")
    turned = _rotation(rotation)
    indices = principal_indices(mineral, wavelengths)
    absorbed = absorption_coefficients(mineral, wavelengths, concentrations)
    if len(indices) == 1:
        return Medium.isotropic(indices[0], None if absorbed is None else absorbed[0])
    if len(indices) == 2:
        pair = None if absorbed is None else (absorbed[0], absorbed[1])
        uniaxial = Medium.uniaxial(indices[0], indices[1], turned[:, 2], pair)
        tensor = gyration(mineral, wavelengths)
        return uniaxial if tensor is None else uniaxial.active(_turned(tensor, turned))
    biaxial = Medium.biaxial(indices, _in_world(mineral.principal_axes(wavelengths), turned))
    if absorbed is None:
        return biaxial
    return biaxial.absorbing(absorbed, _in_world(mineral.absorption_axes(wavelengths), turned))


def _rotation(value: ArrayLike | None) -> Real:
    if value is None:
        return np.eye(3)
    matrix = np.asarray(value, np.float64)
    sound = matrix.shape == (3, 3) and bool(np.all(np.isfinite(matrix)))
    if not sound or np.abs(matrix @ matrix.T - np.eye(3)).max() > ROTATION_TOLERANCE or np.linalg.det(matrix) < 0:
        raise InputError.at("/rotation", "the rotation must be a proper one: orthonormal rows, determinant +1, (3, 3)")
    return matrix


def _in_world(axes: Real, rotation: Real) -> Real:
    """Return the rows of a frame in the world: row i becomes R · row i."""
    return np.asarray(np.einsum("ij...,kj->ik...", axes, rotation))


def _turned(tensor: Real, rotation: Real) -> Real:
    """Return R g Rᵀ, exactly symmetric."""
    world = np.einsum("ij,jk...,lk->il...", rotation, tensor, rotation)
    return np.asarray(0.5 * (world + world.swapaxes(0, 1)))
