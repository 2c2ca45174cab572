"""Made-up entries for tests: what no mineral of the database shows alone."""

from __future__ import annotations

from typing import Any

from minerals_db import Mineral

_KNOWN = {"source": "me", "status": "estimated"}


def curve(n: float) -> dict[str, Any]:
    """Return the data of an index without dispersion."""
    return {"model": "table", "wavelengths_nm": [380, 780], "indices": [n, n], "range_nm": [380, 780], **_KNOWN}


def grey(per_mm: float) -> dict[str, Any]:
    """Return the data of an absorption that is the same at all wavelengths."""
    return {
        "model": "table",
        "wavelengths_nm": [380, 780],
        "coefficients_per_mm": [per_mm, per_mm],
        "range_nm": [380, 780],
        **_KNOWN,
    }


def monoclinic(**changes: Any) -> Mineral:
    """Return a monoclinic entry: β = 118.43°, Y = b, Z at 52° from +c towards +a; as gypsum, but absorbing."""
    entry = {
        "id": "made-up",
        "names": {"en": "Made up", "ru": "Выдуманный"},
        "formula": "X",
        "system": "monoclinic",
        "point_group": "2/m",
        "optical_class": "biaxial",
        "optic_sign": "positive",
        "cell": {
            "a_angstrom": 5.7, "b_angstrom": 15.2, "c_angstrom": 6.5,
            "alpha_deg": 90, "beta_deg": 118.43, "gamma_deg": 90, "space_group": "I 1 2/a 1", **_KNOWN,
        },
        "dispersion": {"alpha": curve(1.52), "beta": curve(1.523), "gamma": curve(1.53)},
        "orientation": {
            "parallel_to_b": "beta", "direction": "gamma", "from_axis": "c", "angle_deg": 52, **_KNOWN
        },
        "absorption": {
            "sample": "Made up",
            "chromophores": {"iron": {"formula": "FeO", "weight_percent": 2.0, **_KNOWN}},
            "parts": [
                {"name": "host", "axes": {"alpha": grey(0.1), "beta": grey(0.2), "gamma": grey(0.3)}},
                {
                    "name": "iron",
                    "proportional_to": ["iron"],
                    "axes": {"alpha": grey(1.0), "beta": grey(0.0), "gamma": grey(3.0)},
                },
            ],
        },
        "sources": {"me": {"citation": "Made up.", "licence": "none"}},
    }  # fmt: skip
    return Mineral.model_validate({**entry, **changes})
