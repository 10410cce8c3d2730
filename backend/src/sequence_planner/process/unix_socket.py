"""A Unix domain socket that only its owner can open, and that has one listener.

The file's permissions are the only sign-in between the processes of a station, so they must be right before the
first connection is possible: a socket that is bound but does not listen yet refuses everybody.
"""

from __future__ import annotations

import socket
from pathlib import Path

LONGEST_PATH = 107  # bytes; `sun_path` of Linux without its final zero


class SocketTakenError(Exception):
    """Another process listens on this path."""


def listen_on(path: Path) -> socket.socket:
    """Bind `path` with mode 0600 and listen; the socket does not block.

    A file left behind by a process that died is replaced. Raises `SocketTakenError` when somebody listens there,
    `ValueError` when the path is too long for the system, `OSError` when the folder cannot be written.
    """
    if len(str(path).encode()) > LONGEST_PATH:
        raise ValueError(f"the socket's path is longer than {LONGEST_PATH} bytes: {path}")
    remove_if_abandoned(path)
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        listener.setblocking(False)
        listener.bind(str(path))
        path.chmod(0o600)
        listener.listen(16)
    except BaseException:
        listener.close()
        raise
    return listener


def remove_if_abandoned(path: Path) -> None:
    """Remove the socket file `path` if nobody listens on it; anything but a socket is left alone."""
    if not path.is_socket():
        return
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        probe.settimeout(1.0)
        try:
            probe.connect(str(path))
        except ConnectionRefusedError:
            path.unlink(missing_ok=True)
            return
        except FileNotFoundError:
            return
    raise SocketTakenError(f"another controller listens on {path}")
