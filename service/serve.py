"""Runs the service until it is told to stop."""

from __future__ import annotations

import contextlib
import ipaddress
import os
import signal
import socket
import sys
import threading
from collections.abc import Iterator
from types import FrameType

import uvicorn

import minerals_db
from crystal_core.errors import InputError
from service.app import create_app
from service.events import Bell
from service.log import set_up_logging
from service.settings import Settings
from service.workshop import Workshop

__all__ = ["run"]

GRACE_S = 5
"""How long open answers may go on after the service has been told to stop, s."""


class _Server(uvicorn.Server):
    """Says where it is, ends the event streams before it waits for open connections, and remembers why it stopped."""

    def __init__(self, config: uvicorn.Config, bell: Bell, address: str) -> None:
        super().__init__(config)
        self._bell = bell
        self._address = address
        self.stopped_by: int | None = None

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            print(f"Isogyre: {self._address}", flush=True)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        self._bell.close()
        await super().shutdown(sockets)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:  # noqa: ARG002
        # uvicorn would raise the signal again at the end; here it decides the exit code instead.
        self.force_exit = self.should_exit and sig == signal.SIGINT
        self.should_exit = True
        self.stopped_by = sig


def run(host: str, port: int, settings: Settings) -> None:
    """Serve until SIGTERM or Ctrl-C.

    When renders are accepted, one line on stdout says where: ``Isogyre: http://127.0.0.1:8000/``. Everything else
    goes to stderr.

    Parameters
    ----------
    host : str
        Address or name to listen at.
    port : int
        TCP port; 0 for any that is free.
    settings : Settings
        The service's settings.

    Raises
    ------
    InputError
        The settings, the data directory or the address cannot be used.
    MineralDataError
        The mineral data are faulty, the user's own as a rule.
    SystemExit
        Code 1 if the port is taken, 130 after Ctrl-C.
    """
    minerals_db.minerals()  # what is wrong with them is said now, not to everybody who asks for one
    set_up_logging(settings)
    with _sigterm_ends():
        _run(host, port, settings)


def _run(host: str, port: int, settings: Settings) -> None:
    listener = _listen(host, port)
    try:
        if not _is_loopback(listener):
            print(
                f"isogyre: warning: anybody who reaches {host} can use this service; there are no API keys yet",
                file=sys.stderr,
            )
        with Workshop(settings) as workshop:
            config = uvicorn.Config(
                create_app(settings, workshop=workshop),
                log_config=None,
                access_log=False,
                server_header=False,
                timeout_graceful_shutdown=GRACE_S,
            )
            server = _Server(config, workshop.bell, _address(listener, host))
            server.run(sockets=[listener])
    except KeyboardInterrupt:  # before the server took over the signals
        raise SystemExit(130) from None
    finally:
        listener.close()
    if server.stopped_by == signal.SIGINT:
        raise SystemExit(130)


@contextlib.contextmanager
def _sigterm_ends() -> Iterator[None]:
    """Let SIGTERM end the program in order also while the server does not (yet) look after the signals."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _listen(host: str, port: int) -> socket.socket:
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
    except (OSError, OverflowError) as error:
        raise InputError.at("--host", f"{host} is no address of this machine: {error}") from error
    try:
        listener = socket.create_server(address[:2], family=family)
    except PermissionError as error:
        raise InputError.at("--port", f"port {port} may not be used: {error.strerror}") from error
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        print(f"isogyre: cannot listen at {host} port {port}: {reason}", file=sys.stderr)
        raise SystemExit(1) from error
    # Connections inherit it. asyncio sets it only for sockets that name their protocol, which these do not; without it
    # each answer waits 40 ms for the caller to acknowledge its head.
    listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return listener


def _is_loopback(listener: socket.socket) -> bool:
    return ipaddress.ip_address(listener.getsockname()[0]).is_loopback


def _address(listener: socket.socket, host: str) -> str:
    bound = ipaddress.ip_address(listener.getsockname()[0])
    # A wildcard is no address that a browser could open.
    name = "localhost" if bound.is_unspecified else f"[{host}]" if ":" in host else host
    return f"http://{name}:{listener.getsockname()[1]}/"
