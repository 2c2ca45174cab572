"""Energy where formulas degenerate: along optic axes, at critical and grazing incidence, in nearly equal media."""

import numpy as np
from hypothesis import given, settings

from tests.optics.faces import DrawnFace, assert_sound, drawn_faces


@settings(deadline=None, derandomize=True, max_examples=200, database=None)
@given(drawn_faces())
def test_energy_of_special_faces(face: DrawnFace) -> None:
    """Along optic axes, at critical and grazing incidence, in media of equal or nearly equal indices.

    Powers are ratios of fluxes, so rounding counts 1/k_n times as much next to grazing (but not at it).
    """
    s = face.run()
    rises = np.array([face.rise(wave) for wave in (*s.incident, *s.reflected, *s.transmitted)])
    least = np.min(np.where(rises > 0.0, rises, 1.0), axis=0)
    assert_sound(s, 1e-12 + 4e-15 / least)
