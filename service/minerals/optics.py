"""The optics of a mineral at wavelengths: indices, group indices, birefringence, 2V, absorption of each axis."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crystal_core.errors import Fault, InputError
from minerals_db import Mineral
from minerals_db.curve import Curve, FloatArray, OutsideRangeError
from minerals_db.indicatrix import birefringence, optic_sign, two_v_deg
from minerals_db.quality import colour_quality, dispersion_quality

__all__ = ["MineralOptics", "mineral_optics", "read_concentrations"]


@dataclass(frozen=True, slots=True)
class MineralOptics:
    """What a mineral does to light of some wavelengths.

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    weight_percent : mapping of str to float
        Concentration of each chromophore, by key.
    wavelengths_nm : float64 array, shape (N,)
        Vacuum wavelengths.
    indices, group_indices : mapping of str to float64 array, shape (N,)
        Of each principal axis.
    birefringence, two_v_deg : float64 array, shape (N,)
        Largest less smallest index; acute angle between the optic axes in degrees, NaN unless biaxial.
    signs : sequence of str or None
        Optic sign at each wavelength.
    absorption_per_mm : mapping of str to float64 array, shape (N,), or None
        Of each principal axis of absorption, natural; None of an entry without absorption.
    clamped : bool array, shape (N,)
        Whether the wavelength lies outside the range of any curve, so that its value at the nearer end was taken.
    """

    mineral: Mineral
    weight_percent: Mapping[str, float]
    wavelengths_nm: FloatArray
    indices: Mapping[str, FloatArray]
    group_indices: Mapping[str, FloatArray]
    birefringence: FloatArray
    two_v_deg: FloatArray
    signs: Sequence[str | None]
    absorption_per_mm: Mapping[str, FloatArray] | None
    clamped: np.ndarray[Any, np.dtype[np.bool_]]

    def document(self) -> dict[str, Any]:
        """Return it as a JSON object: ``optics`` holds an object for each wavelength, in their order."""
        return {
            "mineral": self.mineral.id,
            "optical_class": self.mineral.optical_class,
            "quality": {"dispersion": dispersion_quality(self.mineral), "colour": colour_quality(self.mineral)},
            "concentrations_weight_percent": dict(self.weight_percent),
            "optics": [self._at(place) for place in range(self.wavelengths_nm.size)],
        }

    def _at(self, place: int) -> dict[str, Any]:
        two_v = float(self.two_v_deg[place])
        return {
            "wavelength_nm": float(self.wavelengths_nm[place]),
            "indices": _at(self.indices, place),
            "group_indices": _at(self.group_indices, place),
            "birefringence": float(self.birefringence[place]),
            "two_v_deg": None if math.isnan(two_v) else two_v,
            "optic_sign": self.signs[place],
            "absorption_per_mm": None if self.absorption_per_mm is None else _at(self.absorption_per_mm, place),
            "clamped": bool(self.clamped[place]),
        }

    def columns(self) -> list[str]:
        """Return the names of the columns of `rows`."""
        return [
            "wavelength_nm",
            *(f"n_{axis}" for axis in self.indices),
            *(f"group_index_{axis}" for axis in self.group_indices),
            "birefringence",
            "two_v_deg",
            "optic_sign",
            *(f"absorption_{axis}_per_mm" for axis in self.absorption_per_mm or ()),
            "clamped",
        ]

    def rows(self) -> list[dict[str, object]]:
        """Return it as a table, a row for each wavelength."""
        return [
            {
                "wavelength_nm": told["wavelength_nm"],
                **{f"n_{axis}": n for axis, n in told["indices"].items()},
                **{f"group_index_{axis}": n for axis, n in told["group_indices"].items()},
                "birefringence": told["birefringence"],
                "two_v_deg": told["two_v_deg"],
                "optic_sign": told["optic_sign"],
                **{f"absorption_{axis}_per_mm": a for axis, a in (told["absorption_per_mm"] or {}).items()},
                "clamped": told["clamped"],
            }
            for told in self.document()["optics"]
        ]


def mineral_optics(
    mineral: Mineral, wavelengths_nm: Sequence[float], weight_percent: Mapping[str, float], where: str
) -> MineralOptics:
    """Return the optics of a mineral.

    Parameters
    ----------
    mineral : Mineral
        Its entry.
    wavelengths_nm : sequence of float
        Vacuum wavelengths.
    weight_percent : mapping of str to float
        Concentrations that differ from the entry's own, as of `read_concentrations`.
    where : str
        Pointer of a fault of the wavelengths.

    Raises
    ------
    InputError
        A curve of the entry refuses a wavelength outside its range.
    """
    at = np.asarray(wavelengths_nm, dtype=np.float64)
    curves: list[Curve] = list(mineral.dispersion.values())
    faults: list[Fault] = []
    indices: dict[str, FloatArray] = {}
    group_indices: dict[str, FloatArray] = {}
    absorption: dict[str, FloatArray] = {}

    for axis, curve in mineral.dispersion.items():
        try:
            indices[axis], group_indices[axis] = curve.index(at), curve.group_index(at)
        except OutsideRangeError as error:
            faults.append(Fault(where, f"index {axis} of {mineral.id}: {error}"))
    if mineral.absorption is not None:
        curves += [curve for part in mineral.absorption.parts for curve in part.axes.values()]
        for axis in mineral.absorption.axes:
            try:
                absorption[axis] = mineral.absorption.per_mm(axis, at, weight_percent)
            except OutsideRangeError as error:
                faults.append(Fault(where, f"absorption {axis} of {mineral.id}: {error}"))
    if faults:
        raise InputError(faults)
    known = {} if mineral.absorption is None else mineral.absorption.chromophores
    return MineralOptics(
        mineral=mineral,
        weight_percent={key: weight_percent.get(key, chromophore.weight_percent) for key, chromophore in known.items()},
        wavelengths_nm=at,
        indices=indices,
        group_indices=group_indices,
        birefringence=birefringence(mineral, at),
        two_v_deg=two_v_deg(mineral, at),
        signs=[optic_sign(mineral, wavelength) for wavelength in at.tolist()],
        absorption_per_mm=None if mineral.absorption is None else absorption,
        clamped=np.array([not all(curve.covers(nm, nm) for curve in curves) for nm in at.tolist()], dtype=np.bool_),
    )


def read_concentrations(
    mineral: Mineral, texts: Mapping[str, str], call: Callable[[str], str]
) -> tuple[dict[str, float], list[Fault]]:
    """Return concentrations of chromophores in weight %, by key, and what is wrong with them.

    Parameters
    ----------
    mineral : Mineral
        Whose chromophores they are.
    texts : mapping of str to str
        Numbers from 0 to 100, by the keys of the chromophores.
    call : callable
        From a key to the pointer of its fault.
    """
    known = () if mineral.absorption is None else tuple(mineral.absorption.chromophores)
    found: dict[str, float] = {}
    faults: list[Fault] = []
    for key, text in texts.items():
        if key not in known:
            told = f"those of {mineral.id} are {', '.join(known)}" if known else f"{mineral.id} has none"
            faults.append(Fault(call(key), f"no chromophore with a concentration is called so; {told}"))
            continue
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not 0.0 <= value <= 100.0:
            faults.append(Fault(call(key), f"must be a number of weight %, 0 to 100, not {text!r}"))
        found[key] = value
    return found, faults


def _at(values: Mapping[str, FloatArray], place: int) -> dict[str, float]:
    return {axis: float(of_axis[place]) for axis, of_axis in values.items()}
