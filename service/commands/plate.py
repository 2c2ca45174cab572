"""`isogyre plate`: what plane-parallel plates do to light, between polars or without."""

from __future__ import annotations

from typing import Annotated

import typer

__all__ = ["plate"]


def plate(
    file: Annotated[
        str, typer.Argument(help="A file of JSON, or of JSON Lines; - for standard input.", metavar="FILE|-")
    ],
) -> None:
    """Compute colour, transmittance and matrices of a stack of plates in light along its normal.

    Each question is a JSON object: plates, and if need be mount_index, polarizer_deg, analyser_deg, coherent and
    wavelengths_nm. Each answer is a line of JSON on stdout. If a line is wrong, stderr names it and there are no
    answers. docs/probes.md describes every key.
    """
    from service.commands.answers import print_answers
    from service.probes.plate import PLATE

    print_answers(PLATE, file)
