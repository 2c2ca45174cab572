"""What a mineral is like: the properties that mineralogists list beside the optical constants."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from pydantic import Field

from minerals_db.fields import AngleInterval, Interval, Known, Positive, Text

__all__ = [
    "Appearance",
    "AxialAngle",
    "AxialDispersion",
    "Colour",
    "Density",
    "Hardness",
    "Luminescence",
    "Pleochroism",
    "PleochroismStrength",
    "ThinSection",
]

Colour = Literal[
    "colourless", "white", "grey", "black", "brown", "red", "orange", "yellow", "green", "blue", "violet", "pink",
    "purple",
]  # fmt: skip
PleochroismStrength = Literal["none", "weak", "moderate", "strong"]


class Density(Known):
    """Mass per volume."""

    g_per_cm3: Interval


class Hardness(Known):
    """Scratch hardness on the scale of Mohs."""

    mohs: Interval


class Appearance(Known):
    """What the eye sees of a specimen."""

    colours: tuple[Colour, ...] = Field(min_length=1, description="All that are common, the typical one first")
    streak: Text | None = Field(None, description="Colour of the powder")
    lustre: Text | None = None


class Luminescence(Known):
    """Light given off under ultraviolet rays, X-rays or heat."""

    description: Text


class AxialAngle(Known):
    """A measured angle between the optic axes."""

    two_v_deg: AngleInterval = Field(description="2V, degrees; about the bisectrix named, so up to 180")
    bisectrix: Literal["alpha", "gamma"] = Field(description="Which of X and Z lies in the angle: 2V_α or 2V_γ")
    wavelength_nm: Positive | None = Field(None, description="Vacuum wavelength, nm; None where the source is silent")
    disagreement: Text | None = Field(
        None, description="Why the indices of the entry give another angle; only where they do"
    )


class AxialDispersion(Known):
    """How the angle between the optic axes changes from red to violet."""

    sense: Literal["r>v", "r<v"] = Field(description="Whether 2V is larger in red (r) or in violet (v) light")
    strength: Literal["weak", "moderate", "strong"] | None = None
    kind: Literal["inclined", "horizontal", "crossed"] | None = Field(
        None, description="How the bisectrices turn in a monoclinic crystal: b along Y, the obtuse or the acute one"
    )


class Pleochroism(Known):
    """The colours of light that vibrates along each principal direction, in words."""

    colours: Mapping[Literal["o", "e", "alpha", "beta", "gamma"], Text] = Field(min_length=1)
    strength: PleochroismStrength
    order: Text | None = Field(None, description="Which direction absorbs most, as in 'o > e'")


class ThinSection(Known):
    """What a petrographer notes of a section 0.03 mm thick."""

    extinction: Text | None = None
    elongation: Text | None = None
