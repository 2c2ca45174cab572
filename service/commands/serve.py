"""`isogyre serve`: the service on this machine."""

from __future__ import annotations

from typing import Annotated

import typer

__all__ = ["serve"]


def serve(
    host: Annotated[str, typer.Option(help="Address to listen at.", metavar="ADDRESS")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="TCP port; 0 for any that is free.", min=0, max=65535)] = 8000,
) -> None:
    """Start the service and its page; stop it with Ctrl-C.

    When renders are accepted, one line on stdout says where. Settings are environment variables ISOGYRE_*.
    """
    from service.serve import run
    from service.settings import load_settings

    run(host, port, load_settings())
