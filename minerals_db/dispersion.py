"""How a refractive index depends on the wavelength.

One frozen model per kind of curve, told apart in the data by ``model``: the formulas of refractiveindex.info, a table
of measured values, and a term from two numbers where nothing else is published.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from minerals_db.formulas import (
    Cauchy,
    Exotic,
    Gas,
    Herzberger,
    Polynomial,
    ResonancesAndPowers,
    Retro,
    Sellmeier1,
    Sellmeier2,
)
from minerals_db.one_term import OneTerm
from minerals_db.refractive_index import Dispersion, TabulatedIndex

__all__ = ["AnyDispersion", "Dispersion"]

AnyDispersion = Annotated[
    Sellmeier1
    | Sellmeier2
    | Polynomial
    | ResonancesAndPowers
    | Cauchy
    | Gas
    | Herzberger
    | Retro
    | Exotic
    | TabulatedIndex
    | OneTerm,
    Field(discriminator="model"),
]
