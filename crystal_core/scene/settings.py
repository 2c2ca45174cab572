"""How a scene is rendered."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from crystal_core.scene.parts import Part

__all__ = ["RenderSettings"]

_Pixels = Annotated[int, Field(strict=True, ge=16, le=2048)]


class RenderSettings(Part):
    """Size, quality and what is switched off to show what it does."""

    size_px: tuple[_Pixels, _Pixels] = (512, 512)
    quality: Literal["draft", "standard", "fine"] = "standard"
    seed: Annotated[int, Field(strict=True, ge=0, le=2**63 - 1)] = 0
    exposure: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=1e6)] | None = Field(
        default=None,
        description="Linear picture value of a white diffuser under 1000 lx [default: automatic]",
    )
    dispersion: bool = Field(default=True, strict=True, description="false: every index as at 589.3 nm")
    interference: bool = Field(default=True, strict=True, description="false: the two waves of a plate add as powers")
