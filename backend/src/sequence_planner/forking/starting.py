"""Starting processes: the station's fork server forks them, or where there is none one of this process's own."""

from __future__ import annotations

import atexit
import contextlib
import os
import pickle
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import weakref
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Final

from sequence_planner.forking.child import Child
from sequence_planner.forking.request import Request, send_request
from sequence_planner.secret_variables import environment

VARIABLE: Final = "SEQUENCE_PLANNER_FORK_SERVER"  # of the environment: the socket of the station's fork server
_BACKLOG: Final = 64
_SOCKET: Final = "fork.socket"
_PREFIX: Final = "sequence-planner-fork-"
_LONGEST_FOLDER: Final = 60  # bytes: the path of a socket has 107 at most, unix(7)
_children: weakref.WeakSet[Child] = weakref.WeakSet()


class OwnServer:
    """The fork server of a process that has none of a station: started when it is first needed, and again when it has
    died. Its socket is this process's, so that requests wait meanwhile, in a folder that is open to nobody else.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._listener: socket.socket | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._modules: tuple[str, ...] = ()
        self._asked = False

    @property
    def lives(self) -> bool:
        """Whether it runs."""
        return self._process is not None and self._process.poll() is None

    def prepare(self, *modules: str) -> None:
        """Start it, and have it import `modules` while nobody asks."""
        self._modules = modules
        with self._lock:
            self._see_to_it()

    def path(self) -> Path:
        """Where it is asked."""
        with self._lock:
            self._asked = True
            return self._see_to_it()

    def replace(self) -> None:
        """End the one that does not answer. What it was asked for and has not taken up the next one is asked for."""
        with self._lock:
            if self._process is not None:
                self._process.kill()
                self._process.wait()
            self._see_to_it()

    def _see_to_it(self) -> Path:
        if self._listener is None:
            self._listener = _listening(_short_folder() / _SOCKET)
            atexit.register(self._end, self._listener, Path(self._listener.getsockname()))
        if not self.lives:
            self._hang_up()
            self._process = self._started(self._listener.fileno())
        return Path(self._listener.getsockname())

    def _started(self, listener: int) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-m", __package__, str(listener), *self._modules],
            stdin=subprocess.PIPE,
            start_new_session=True,
            pass_fds=(listener,),
            env={**environment(), "OPENBLAS_NUM_THREADS": "1"},  # a process with threads cannot be forked
        )

    def _end(self, listener: socket.socket, at: Path) -> None:
        listener.close()
        self._hang_up()
        shutil.rmtree(at.parent, ignore_errors=True)

    def _hang_up(self) -> None:
        if self._process is not None:
            assert self._process.stdin is not None
            self._process.stdin.close()
            if not self._asked:
                self._process.kill()  # it may import for some time yet, and has nothing to see to
            self._process.wait()
            self._process = None


OWN: Final = OwnServer()


def start(
    main: Callable[..., object] | str,
    *arguments: object,
    name: str,
    connection: Connection,
    modules: tuple[str, ...] = (),
    leads: bool = False,
) -> Child:
    """Start a process that calls `main`, a function of a module or the name of one as in `package.module:function`.

    Its first argument is `connection`, which is closed here, then come `arguments`. What it imports besides is in
    `modules`. The process ends with this one, and with the last reference to what is returned; one that `leads` ends
    with all that it has started. Raises OSError when it cannot be started.
    """
    where = main if isinstance(main, str) else f"{main.__module__}:{main.__qualname__}"

    def asked(server: Path) -> Child:
        request = Request(
            where,
            pickle.dumps(arguments),
            modules,
            f"sequence-planner: {name}",
            {**os.environ, VARIABLE: str(server)},
            list(sys.path),
            str(Path.cwd()),
            connections=1,
            leads=leads,
        )
        child = ask(server, request, [connection.fileno()], name)
        _children.add(child)
        return child

    with connection:
        of_station = os.environ.get(VARIABLE)
        if of_station is not None:
            with contextlib.suppress(OSError):  # it has ended, and this process goes on without
                return asked(Path(of_station))
        return asked(OWN.path())


def children() -> list[Child]:
    """The processes that this one has started here and that live."""
    return [each for each in list(_children) if each.poll() is None]


def ask(server: Path, request: Request, descriptors: list[int], name: str) -> Child:
    """Have a process forked by the server at that socket. Raises OSError when it cannot be asked."""
    to = socket.socket(socket.AF_UNIX)
    try:
        to.connect(str(server))
        send_request(to, request, descriptors)
    except OSError:
        to.close()
        raise
    return Child(name, to, leads=request.leads)


def _listening(at: Path) -> socket.socket:
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(str(at))
    listener.listen(_BACKLOG)
    return listener


def _short_folder() -> Path:
    """A new folder whose name is short enough for a socket in it."""
    usual = Path(tempfile.gettempdir())
    return Path(tempfile.mkdtemp(prefix=_PREFIX, dir=usual if len(bytes(usual)) <= _LONGEST_FOLDER else "/tmp"))
