"""Messages to systemd about a station that it runs (sd_notify(3)), where it asks for that; else nothing."""

from __future__ import annotations

import contextlib
import os
import socket
from collections.abc import MutableMapping

SOCKET, WATCHDOG, WATCHED = "NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"


class ServiceManager:
    """Speaks for this process alone: what asks for it is taken out of the environment, and no part inherits it."""

    def __init__(self, environ: MutableMapping[str, str] = os.environ) -> None:
        address = environ.pop(SOCKET, "")
        watched, microseconds = environ.pop(WATCHED, ""), environ.pop(WATCHDOG, "")
        self._address = f"\0{address[1:]}" if address.startswith("@") else address
        is_for_this = not watched or watched == str(os.getpid())
        self.patience = int(microseconds) / 1e6 if microseconds.isdecimal() and is_for_this else None
        """Seconds without a sign of life after which the service is started again; None where nobody watches."""

    def ready(self) -> None:
        """The station is open."""
        self._tell("READY=1\nSTATUS=The station is open")

    def alive(self) -> None:
        """The server answers, and its controller is heard."""
        self._tell("WATCHDOG=1")

    def stopping(self) -> None:
        """It is coming to its end."""
        self._tell("STOPPING=1")

    def _tell(self, state: str) -> None:
        if not self._address:
            return
        with (
            contextlib.suppress(OSError),
            socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC) as out,
        ):
            out.sendto(state.encode(), self._address)
