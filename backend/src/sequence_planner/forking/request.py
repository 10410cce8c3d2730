"""The requests to a fork server, and what it says of a process that it has forked.

A request is one connection: the length of a pickle, the pickle and the descriptors that come with it go in. What comes
out is the number of the process and a descriptor that means it, said by the process itself as it begins, and its exit
code when it has ended. Whoever closes the connection before, or ends, wants the process to end. Both ends are processes
of one station, in a folder that is open to nobody else.
"""

from __future__ import annotations

import os
import pickle
import socket
import struct
from dataclasses import dataclass
from typing import Final

_LENGTH: Final = struct.Struct("!I")
_NUMBER: Final = struct.Struct("!i")
BYTES_OF_NUMBER: Final = _NUMBER.size
MOST_DESCRIPTORS: Final = 8
LATER: Final = "--later"  # on the command line of a server: what is imported only when nothing is urgent follows


@dataclass(frozen=True)
class ForkRequest:
    """A process that calls `main`, a function such as `package.module:function`, with `arguments`, which are pickled.

    The server imports `modules` for it and for all later ones. What cannot be imported is an error of the process.
    Of the descriptors that are sent along, the first `connections` are its first arguments, as connections, and the
    others get the numbers in `places`. `title` is what `ps` shows. One that `leads` a session of its own is ended with
    all that it has started. One that is `left` ends by itself when whoever has asked for it does.
    """

    main: str
    arguments: bytes
    modules: tuple[str, ...]
    title: str
    environment: dict[str, str]
    path: list[str]
    folder: str | None
    connections: int = 0
    places: tuple[int, ...] = ()
    leads: bool = False
    left: bool = False


def send_request(to: socket.socket, request: ForkRequest, descriptors: list[int]) -> None:
    """Send a request. Raises OSError when nobody takes it."""
    content = pickle.dumps(request)
    socket.send_fds(to, [_LENGTH.pack(len(content))], descriptors)
    to.sendall(content)


def read_request(of: socket.socket) -> tuple[ForkRequest, list[int]]:
    """The request that comes next, and its descriptors. Raises EOFError when it is not whole."""
    head, descriptors, _, _ = socket.recv_fds(of, _LENGTH.size, MOST_DESCRIPTORS)
    try:
        for each in descriptors:
            os.set_inheritable(each, False)
        head += _read(of, _LENGTH.size - len(head))
        request: ForkRequest = pickle.loads(_read(of, _LENGTH.unpack(head)[0]))
    except BaseException:
        for each in descriptors:
            os.close(each)
        raise
    return request, descriptors


def send_begun(to: socket.socket, pid: int, handle: int) -> None:
    """Say that there is a process, with a descriptor that means it (pidfd_open(2))."""
    socket.send_fds(to, [_NUMBER.pack(pid)], [handle])


def read_begun(of: socket.socket) -> tuple[int, int]:
    """The number of the process, and a descriptor that means it. Raises EOFError when there will be none."""
    number, handles, _, _ = socket.recv_fds(of, BYTES_OF_NUMBER, 1)
    if len(number) < BYTES_OF_NUMBER or not handles:
        raise EOFError
    os.set_inheritable(handles[0], False)
    return _NUMBER.unpack(number)[0], handles[0]


def send_code(to: socket.socket, code: int) -> None:
    """Say how the process has ended: with an exit code, or with a signal, whose number is negative then."""
    to.sendall(_NUMBER.pack(code))


def read_code(of: socket.socket) -> int:
    """Tell how the process has ended. Raises EOFError when nobody knows."""
    return int(_NUMBER.unpack(_read(of, BYTES_OF_NUMBER))[0])


def _read(of: socket.socket, count: int) -> bytes:
    content = bytearray()
    while len(content) < count:
        more = of.recv(count - len(content))
        if not more:
            raise EOFError
        content += more
    return bytes(content)
