"""A DDS domain and ports of one run of the tests: no other station on this machine hears the tests, nor they it."""

from __future__ import annotations

import atexit
import os
import socket
from contextlib import ExitStack
from typing import Final

# A port that is listened on says that the domain is taken by tests; those in `e2e` look there, too.
_MARKS: Final = 7000
# Above, the ports of a domain are those that the system hands out to anybody.
_DOMAINS: Final = 100
# The ports of DDS: those of a domain begin there, so far apart; and so many programs are looked for in each.
_DDS, _APART, _FIRST, _PROGRAMS = 7400, 250, 10, 16


def free_domain() -> int:
    """A domain in which nobody is, and which no other tests take as long as this process lives."""
    for tries in range(_DOMAINS):
        number = 1 + (os.getpid() + tries) % _DOMAINS
        mark = _bound(socket.SOCK_STREAM, _MARKS + number, "127.0.0.1")
        if mark is not None and _is_empty(number):
            mark.listen()
            atexit.register(mark.close)
            return number
        if mark is not None:
            mark.close()
    raise RuntimeError(f"somebody is in each of the DDS domains from 1 to {_DOMAINS}")


def _is_empty(domain: int) -> bool:
    first = _DDS + _APART * domain
    ports = (first, *range(first + _FIRST, first + _FIRST + 2 * _PROGRAMS))
    with ExitStack() as bound:
        for port in ports:
            probe = _bound(socket.SOCK_DGRAM, port, "")
            if probe is None:
                return False
            bound.enter_context(probe)
        return True


def _bound(kind: socket.SocketKind, port: int, address: str) -> socket.socket | None:
    made = socket.socket(socket.AF_INET, kind)
    try:
        made.bind((address, port))
    except OSError:
        made.close()
        return None
    return made


def free_port() -> int:
    """A TCP port of the loopback on which nobody listens."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])


DOMAIN: Final = free_domain()
