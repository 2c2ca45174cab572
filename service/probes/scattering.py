"""Scattering of many requests at once: media of one kind share a call of the optics, and no answer tells of it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError, IsogyreError, NotSupportedError
from crystal_core.materials.description import MediumDescription, joint_medium
from crystal_core.optics import Medium, Scattering, Wave, absorption_along_ray, scatter
from crystal_core.optics.arrays import Complex, Field, Rays, Real, columns, dot

if TYPE_CHECKING:
    from service.probes.interface import InterfaceRequest

__all__ = ["scatter_requests"]

Answer = dict[str, Any]
Numbers = NDArray[np.intp]


def scatter_requests(requests: Sequence[InterfaceRequest]) -> list[Answer | IsogyreError]:
    """Answer requests.

    Parameters
    ----------
    requests : sequence of InterfaceRequest
        Of any media.

    Returns
    -------
    list
        For each request what `InterfaceAnswer` describes, or the error of a request that has no answer: no wave comes
        in, or the optics cannot do its media. The bits of an answer do not depend on the other requests.
    """
    groups: defaultdict[object, list[int]] = defaultdict(list)
    for number, request in enumerate(requests):
        groups[request.source.family, request.target.family].append(number)
    answers: dict[int, Answer | IsogyreError] = {}
    for numbers in groups.values():
        answers.update(zip(numbers, _of_one_kind([requests[number] for number in numbers]), strict=True))
    return [answers[number] for number in range(len(requests))]


@dataclass(frozen=True)
class _Batch:
    """Faces between media of one kind each, with arrays over the requests."""

    normal: Real
    tangential_k: Real
    source: Medium
    target: Medium

    @classmethod
    def of(cls, requests: Sequence[InterfaceRequest]) -> _Batch:
        wavelengths = np.array([request.wavelength_nm for request in requests])
        source = _medium([request.source for request in requests], wavelengths)
        target = _medium([request.target for request in requests], wavelengths)
        normal = np.ascontiguousarray(np.array([request.normal for request in requests]).T)
        given = [request.wave_normal or request.tangential_k for request in requests]
        k = np.ascontiguousarray(np.array(given).T)
        if source.is_isotropic:
            k = _within(source.indices[0] * (k - dot(k, normal) * normal), source.indices[0])
        return cls(normal, k, source, target)

    def take(self, rays: Rays) -> _Batch:
        return _Batch(
            columns(self.normal, rays), columns(self.tangential_k, rays), self.source.take(rays), self.target.take(rays)
        )

    def scatter(self) -> Scattering:
        return scatter(self.normal, self.tangential_k, self.source, self.target)


def _medium(descriptions: Sequence[MediumDescription], wavelength_nm: Real) -> Medium:
    """Return the medium of each ray, a mineral's without its optical activity.

    What an answer promises of H and of the names of modes holds for linear modes. Who wants those of an active medium
    gives the gyration.
    """
    medium = joint_medium(descriptions, wavelength_nm)
    return medium if descriptions[0].mineral is None else medium.inactive()


def _within(k: Real, n: Real) -> Real:
    """Return tangential wave vectors with those that rounding made longer than the index cut to it: they graze."""
    length = np.sqrt(dot(k, k))
    return k * np.where(length >= n, n * (1.0 - 2.0**-51) / np.maximum(length, n), 1.0)


def _of_one_kind(requests: Sequence[InterfaceRequest]) -> list[Answer | IsogyreError]:
    batch = _Batch.of(requests)
    answers: list[Answer | IsogyreError] = [_NOTHING_COMES_IN] * len(requests)
    try:
        for rays, scattering in _alike(batch):
            for number, answer in zip(rays.tolist(), _answers(batch.take(rays), scattering), strict=True):
                if answer["incident"]:
                    answers[number] = answer
    except (InputError, NotSupportedError) as error:
        # Whose request it was, a call for all of them does not tell.
        return [error] if len(requests) == 1 else [_of_one_kind([request])[0] for request in requests]
    return answers


_NOTHING_COMES_IN = InputError.at("/tangential_k", "no wave of `from` propagates with this tangential wave vector")


def _alike(batch: _Batch) -> Iterator[tuple[Numbers, Scattering]]:
    """Scatter a batch in parts in which either all waves of a side propagate or each face has one that does not.

    One evanescent wave makes a whole call complex, and that changes the last bits of its other faces.
    """
    whole = batch.scatter()
    here = whole.incident[0].propagating & whole.incident[1].propagating
    there = whole.transmitted[0].propagating & whole.transmitted[1].propagating
    sort = 2 * here + there
    sorts = np.unique(sort)
    for this in sorts:
        rays = np.flatnonzero(sort == this)
        yield rays, whole if sorts.size == 1 else batch.take(rays).scatter()


def _answers(batch: _Batch, scattering: Scattering) -> list[Answer]:
    phased = [_phased(wave.field) for wave in scattering.incident]
    incident = [
        _Columns(mode=wave.mode, k=wave.k, ray=wave.ray, index=wave.index, field=_pairs(field))
        for wave, (field, _) in zip(scattering.incident, phased, strict=True)
    ]
    turns = [turn for _, turn in phased]
    scattered = []
    for i in (0, 1):
        amplitude, power = scattering.amplitude_transmitted[i], scattering.power_transmitted[i]
        scattered.append(_outgoing("transmitted", scattering.transmitted[i], batch.target, amplitude, power, turns))
    for i in (0, 1):
        amplitude, power = scattering.amplitude_reflected[i], scattering.power_reflected[i]
        scattered.append(_outgoing("reflected", scattering.reflected[i], batch.source, amplitude, power, turns))

    answers = []
    comes_in = np.stack([wave.propagating for wave in scattering.incident], axis=1)
    for ray, free in enumerate(comes_in.tolist()):
        entering = [j for j in (0, 1) if free[j]]
        waves = [entries.row(ray) for entries in scattered]
        for wave in waves:
            wave["power"] = [wave["power"][j] for j in entering]
            wave["amplitude"] = [wave["amplitude"][j] for j in entering]
            if wave["evanescent"]:
                wave.update(ray=None, index=None, absorption_per_mm=None)
        answers.append({"incident": [incident[j].row(ray) for j in entering], "scattered": waves})
    return answers


def _outgoing(
    kind: str, wave: Wave, medium: Medium, amplitude: Sequence[Field], power: Sequence[Real], turns: Sequence[Complex]
) -> _Columns:
    field, turn = _phased(wave.field)
    # The field was divided by its phase factor: the amplitude takes it over, and gives back the incident field's.
    turned = [a * turn * np.conj(of_incident) for a, of_incident in zip(amplitude, turns, strict=True)]
    return _Columns(
        kind=np.full(wave.mode.shape, kind),
        mode=wave.mode,
        k=wave.k,
        k_imag=wave.k_imag,
        ray=wave.ray,
        index=wave.index,
        field=_pairs(field),
        power=np.stack(power),
        amplitude=_pairs(np.stack(turned)),
        evanescent=~wave.propagating,
        absorption_per_mm=_absorption(medium, wave),
    )


class _Columns:
    """Keys and their arrays, the rays on the last axis; as rows of plain Python values."""

    def __init__(self, **arrays: NDArray[Any]) -> None:
        self._names = tuple(arrays)
        self._rows = list(zip(*(_plain(values) for values in arrays.values()), strict=True))

    def row(self, ray: int) -> dict[str, Any]:
        return dict(zip(self._names, self._rows[ray], strict=True))


def _plain(values: NDArray[Any]) -> list[Any]:
    if values.dtype.kind == "f":
        values = values + 0.0  # no -0.0
    rows: list[Any] = np.moveaxis(values, -1, 0).tolist()
    return rows


def _pairs(values: Complex) -> Real:
    """Return complex values, shape (M, N), as real and imaginary parts, shape (M, 2, N)."""
    return np.stack((values.real, values.imag), axis=1)


def _phased(field: Complex) -> tuple[Complex, Complex]:
    """Return fields, shape (3, N), with their largest component real and positive, and the phase factors taken off."""
    size = np.abs(field)
    largest = np.argmax(size, axis=0)
    rays = np.arange(field.shape[1])
    turn = field[largest, rays] / size[largest, rays]
    turned = field * np.conj(turn)
    turned[largest, rays] = size[largest, rays]
    return turned, turn


def _absorption(medium: Medium, wave: Wave) -> Real:
    """Return the absorption along the ray, mm⁻¹, shape (N,); NaN where the wave is evanescent."""
    absorption = np.where(wave.propagating, 0.0, np.nan)
    if medium.absorption_per_mm is not None:
        rays = np.flatnonzero(wave.propagating)
        absorption[rays] = absorption_along_ray(
            medium.take(rays), columns(wave.k, rays), np.ascontiguousarray(wave.field[:, rays])
        )
    return absorption
