"""How far the data of an entry can be trusted, in one word for each of what a picture shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from minerals_db.schema import Mineral

__all__ = ["ColourQuality", "DispersionQuality", "colour_quality", "dispersion_quality"]

DispersionQuality = Literal["published", "fallback"]
ColourQuality = Literal["measured", "estimated", "none"]

_TRUSTED = ("published", "measured", "fitted", "derived")


def dispersion_quality(mineral: Mineral) -> DispersionQuality:
    """Return "published" if every principal index follows a published dispersion of its own.

    "fallback": at least one has the one-term formula through an index and a dispersion measure that all axes share, so
    that interference colours are not real in their dispersion; or its numbers are estimated or recalled.
    """
    curves = mineral.dispersion.values()
    sound = all(curve.model != "one-term" and curve.status in _TRUSTED for curve in curves)
    return "published" if sound else "fallback"


def colour_quality(mineral: Mineral) -> ColourQuality:
    """Return "measured" if all absorption of the entry was measured, "estimated" if any was not, "none" without any."""
    if mineral.absorption is None:
        return "none"
    spectra = [spectrum for part in mineral.absorption.parts for spectrum in part.axes.values()]
    return "measured" if all(spectrum.status in _TRUSTED for spectrum in spectra) else "estimated"
