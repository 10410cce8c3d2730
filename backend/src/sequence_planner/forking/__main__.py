"""The process of a fork server: `python -m sequence_planner.forking DESCRIPTOR MODULE… LATER MODULE…`."""

from __future__ import annotations

import contextlib
import socket
import sys
from pathlib import Path

from setproctitle import setproctitle

from sequence_planner.forking.request import LATER
from sequence_planner.forking.server import ForkServer


def main() -> None:
    """Serve, or live what a process lives that was forked from this one."""
    setproctitle("sequence-planner: fork server")  # its place is found before the environment changes, or never
    listener = socket.socket(fileno=int(sys.argv[1]))
    place = Path(listener.getsockname())
    modules = sys.argv[2:]
    at = modules.index(LATER) if LATER in modules else len(modules)
    life = ForkServer(listener, modules[:at], modules[at + 1 :]).serve()
    if life is not None:
        life()
        return
    with contextlib.suppress(OSError):  # there may be more in the folder, whose owner sees to that
        place.unlink(missing_ok=True)
        place.parent.rmdir()


if __name__ == "__main__":
    main()
