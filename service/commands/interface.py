"""`isogyre interface`: what a plane face does to plane waves."""

from __future__ import annotations

from typing import Annotated

import typer

__all__ = ["interface"]


def interface(
    file: Annotated[
        str, typer.Argument(help="A file of JSON, or of JSON Lines; - for standard input.", metavar="FILE|-")
    ],
) -> None:
    """Compute the waves at the plane face between two media.

    Each question is a JSON object: wavelength_nm, normal, from, to, and wave_normal or tangential_k. Each answer is a
    line of JSON on stdout: the incident waves, and the two reflected and two transmitted ones with their powers. If a
    line is wrong, stderr names it and there are no answers. docs/probes.md describes every key.
    """
    from service.commands.answers import print_answers
    from service.probes.interface import INTERFACE

    print_answers(INTERFACE, file)
