"""Where the server listens and what it serves, and the rule that keeps it to this machine.

There is no sign-in yet, so whoever reaches the server can move the station. It therefore binds to the loopback
address only; any other is refused before anything starts.
"""

from __future__ import annotations

import errno
import socket
from dataclasses import dataclass, field
from pathlib import Path

LOOPBACK = ("127.0.0.1", "localhost")


class SettingsError(Exception):
    """The server cannot start as asked; the message says what to do. The exit code is 2."""


@dataclass(frozen=True)
class StreamLimits:
    """How much one client of the stream may ask of the server."""

    queue: int = 32  # messages; a client that is further behind gets one fresh snapshot instead
    send_seconds: float = 5.0  # a client that takes no message for so long is dropped
    frame: int = 4096  # bytes in a frame from a client
    clients: int = 100


@dataclass(frozen=True)
class Settings:
    """All that the server needs to know; `page` is the folder of the built page, `model` that of the running station.

    With `transport` the network is joined for what a person wants to attach, as the controller joins it.
    """

    controller_socket: Path
    page: Path
    host: str = "127.0.0.1"
    port: int = 8000
    model: Path | None = None
    transport: str = "auto"
    stream: StreamLimits = field(default_factory=StreamLimits)


def check_host(host: str) -> None:
    """Raise `SettingsError` unless `host` is the loopback address of this machine."""
    if host not in LOOPBACK:
        allowed = " or ".join(LOOPBACK)
        raise SettingsError(f"cannot serve on {host}: until there is sign-in, only {allowed} is allowed; use --host")


def bind(host: str, port: int) -> socket.socket:
    """A socket bound to `host` and `port` (1 to 65535), so that nobody takes it between check and start.

    Raises `SettingsError` when the host is not allowed, the port is taken or may not be used.
    """
    check_host(host)
    if not 1 <= port <= 65535:
        raise SettingsError(f"{port} is not a port; use --port with a number from 1 to 65535")
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    # Without it a port stays closed for a minute after a restart; it never lets two servers listen.
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((LOOPBACK[0], port))
        listener.listen(128)
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise SettingsError(f"port {port} is taken; use --port") from error
        raise SettingsError(f"port {port} cannot be used: {error.strerror}; use --port") from error
    return listener


def check_port(host: str, port: int) -> None:
    """Raise `SettingsError` when `bind` would; for asking before other processes are started."""
    bind(host, port).close()
