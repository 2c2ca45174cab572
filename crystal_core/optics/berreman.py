"""Berreman's matrix: Maxwell's equations of a layered medium for the tangential fields alone."""

from __future__ import annotations

import numpy as np

from crystal_core.errors import InputError
from crystal_core.optics.arrays import Complex, Field, Real
from crystal_core.optics.indicatrix import dissipation, permittivity
from crystal_core.optics.medium import Medium

__all__ = ["activity", "berreman_matrix", "flux_product", "is_active", "normal_fields", "plate_matrix", "stacked"]

NO_GYRATION = 1e-15
"""Gyration below which a medium counts as inactive."""


def berreman_matrix(epsilon: Field, kx: Real, ky: Real, kappa: Real | None = None) -> Field:
    """Return Δ of ∂ψ/∂z = i k0 Δ ψ for ψ = (E_x, E_y, H_x, H_y); its eigenvalues are the normal parts q of the waves.

    From k × E = B, k × H = −D with D = ε E + i κ H, B = H − i κᵀ E (Condon, Rev. Mod. Phys. 9, 432, 1937); E_z and H_z
    follow from the equations' z components. Without activity it is the matrix of Berreman, J. Opt. Soc. Am. 62, 502
    (1972), for any direction of the tangential wave vector.

    Parameters
    ----------
    epsilon : Field
        Relative permittivity, symmetric, complex if the medium absorbs, shape (N, 3, 3).
    kx, ky : Real
        Tangential wave vector in units of k0, shape (N,).
    kappa : Real or None
        Symmetric tensor of the optical activity (see `activity`), shape (N, 3, 3).

    Returns
    -------
    Field
        Shape (N, 4, 4), without unit; real where ε is and there is no activity.
    """
    x, y = kx[:, None], ky[:, None]
    # Each field component as a row of four coefficients of (E_x, E_y, H_x, H_y).
    ex, ey, hx, hy = np.eye(4)[:, None, :]
    e = epsilon[:, :, :, None]
    if kappa is None:
        hz: Field = x * ey - y * ex
        ez: Field = -(x * hy - y * hx + e[:, 2, 0] * ex + e[:, 2, 1] * ey) / e[:, 2, 2]
        dx: Field = e[:, 0, 0] * ex + e[:, 0, 1] * ey + e[:, 0, 2] * ez
        dy: Field = e[:, 1, 0] * ex + e[:, 1, 1] * ey + e[:, 1, 2] * ez
        return np.stack((x * ez + hy, y * ez - hx, x * hz - dy, y * hz + dx), axis=1)
    c: Complex = np.asarray(1j * kappa[:, :, :, None], np.complex128)
    ez, hz = _normal_fields(e, c, x, y, (ex, ey, hx, hy))
    dx, dy = (
        e[:, i, 0] * ex + e[:, i, 1] * ey + e[:, i, 2] * ez + c[:, i, 0] * hx + c[:, i, 1] * hy + c[:, i, 2] * hz
        for i in (0, 1)
    )
    bx, by = ((hx, hy)[i] - c[:, 0, i] * ex - c[:, 1, i] * ey - c[:, 2, i] * ez for i in (0, 1))
    return np.stack((x * ez + by, y * ez - bx, x * hz - dy, y * hz + dx), axis=1)


def normal_fields(epsilon: Field, kx: Real, ky: Real, kappa: Real, psi: Field) -> tuple[Field, Field]:
    """Return E_z and H_z of waves of given tangential fields, by the z components of Maxwell's equations.

    Parameters
    ----------
    epsilon, kx, ky, kappa
        As for `berreman_matrix`.
    psi : Field
        (E_x, E_y, H_x, H_y) of m waves as columns, shape (N, 4, m).

    Returns
    -------
    pair of Field
        Shape (N, m) each.
    """
    tangential = (psi[:, 0], psi[:, 1], psi[:, 2], psi[:, 3])
    c: Complex = np.asarray(1j * kappa[:, :, :, None], np.complex128)
    return _normal_fields(epsilon[:, :, :, None], c, kx[:, None], ky[:, None], tangential)


def _normal_fields(
    e: Field, c: Field, x: Real, y: Real, tangential: tuple[Field, Field, Field, Field]
) -> tuple[Field, Field]:
    """Return E_z and H_z for ε and c = i κ of shape (N, 3, 3, 1)."""
    ex, ey, hx, hy = tangential
    curl = x * ey - y * ex + c[:, 0, 2] * ex + c[:, 1, 2] * ey
    known = x * hy - y * hx + e[:, 2, 0] * ex + e[:, 2, 1] * ey + c[:, 2, 0] * hx + c[:, 2, 1] * hy
    ez = -(known + c[:, 2, 2] * curl) / (e[:, 2, 2] + c[:, 2, 2] ** 2)
    return ez, curl + c[:, 2, 2] * ez


def is_active(medium: Medium) -> bool:
    """Return whether the medium has a gyration that counts: n² ± G is n² for less than rounding."""
    return medium.gyration is not None and bool(np.any(np.abs(medium.gyration) > NO_GYRATION))


def activity(medium: Medium) -> Real | None:
    """Return κ of D = ε E + i κ H, B = H − i κᵀ E, shape (3, 3) or (3, 3, N); None where the medium is inactive.

    κ = (½ tr g − g)/n for the gyration tensor g and the mean index n (n_o of a uniaxial medium), so that light along
    an optic axis is turned by ρ = π G/(λ n) per length, G = s·g·s: positive ρ (dextro) is clockwise to an observer who
    faces the source. First order in g, as g itself is defined (Landau & Lifshitz, §104). In a crystal G = s·g·s holds
    to |g| times the relative birefringence along other directions; along an optic axis of a biaxial one the mean index
    is not n_β, and G comes out n_β/n times as large.

    Raises
    ------
    InputError
        κ as large as an index: the energy of the medium would not be positive.
    """
    g = medium.gyration
    if g is None:
        return None
    n: Real = medium.indices[0] if len(medium.indices) < 3 else sum(medium.indices[1:], medium.indices[0]) / 3.0
    trace = g[0, 0] + g[1, 1] + g[2, 2]
    if g.ndim == 2 and np.ndim(n) == 0:
        kappa = np.asarray((0.5 * trace * np.eye(3) - g) / n)
    else:
        wide = g if g.ndim == 3 else g[:, :, None]
        kappa = np.asarray((0.5 * trace * np.eye(3)[:, :, None] - wide) / n)
    size = np.sqrt(np.sum(kappa * kappa, axis=(0, 1)))
    if any(np.any(size >= index) for index in medium.indices):
        raise InputError.at("/gyration", "the gyration is too large: optical activity would outweigh the indices")
    return kappa


def plate_matrix(medium: Medium, wavelength_nm: Real, kx: Real, ky: Real) -> Field:
    """Return Δ, shape (N, 4, 4), of a medium with its absorption, ε = ε′ + i ε″, and its activity.

    Parameters
    ----------
    medium : Medium
        At each wavelength, in the frame whose z is the normal of the plate.
    wavelength_nm : Real
        Vacuum wavelength, nm, shape (N,).
    kx, ky : Real
        Tangential wave vector in units of k0, shape (N,).
    """
    epsilon: Field = stacked(permittivity(medium), kx.size)
    if medium.absorption_per_mm is not None:
        k0_per_mm = 2e6 * np.pi / wavelength_nm
        epsilon = epsilon + 1j * stacked(dissipation(medium), kx.size) / k0_per_mm[:, None, None]
    kappa = activity(medium)
    return berreman_matrix(epsilon, kx, ky, None if kappa is None else stacked(kappa, kx.size))


def flux_product(a: Field, b: Field) -> Complex:
    """Return a† K b over the second axis, shapes (N, 4, i) and (N, 4, j) → (N, i, j); a† K a = 2 Re(E × H*)_z.

    In a lossless medium K Δ is Hermitian, so two waves with different real q exchange no energy: a† K b = 0.
    """
    c = np.conj(a)[:, :, :, None]
    d = b[:, :, None, :]
    product = c[:, 0] * d[:, 3] + c[:, 3] * d[:, 0] - c[:, 1] * d[:, 2] - c[:, 2] * d[:, 1]
    return np.asarray(product, np.complex128)


def stacked(tensor: Real, count: int) -> Real:
    """Return a tensor (3, 3) or (3, 3, N) as (N, 3, 3)."""
    wide = tensor[:, :, None] if tensor.ndim == 2 else tensor
    return np.moveaxis(np.broadcast_to(wide, (3, 3, count)), 2, 0)
