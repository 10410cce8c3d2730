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
import time
import weakref
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Final

from sequence_planner.core.secrets import environment
from sequence_planner.forking.child import Child
from sequence_planner.forking.request import LATER, ForkRequest, send_request

VARIABLE: Final = "SEQUENCE_PLANNER_FORK_SERVER"  # of the environment: the socket of the station's fork server
_BACKLOG: Final = 64
_SOCKET: Final = "fork.socket"
_PATIENCE: Final = 2.0  # seconds until a request has been taken, of which much fits into a socket
_LAST_WORDS: Final = 5.0  # seconds in which it may end in good order
_FIRST_PAUSE: Final = 0.5  # seconds before one that has died is started again, doubled each time up to the longest
_LONGEST_PAUSE: Final = 10.0
_PROBE_EVERY: Final = 10.0  # seconds between two questions whether it answers
LONGEST_SILENCE: Final = 60.0  # seconds: on a busy machine it may import for long
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
        self._again = 0.0  # when it may be started again, on the clock of `time.monotonic`
        self._pause = _FIRST_PAUSE
        self._probe: tuple[socket.socket, float] | None = None  # a question whether it answers, and since when
        self._probed = 0.0

    @property
    def lives(self) -> bool:
        """True if it runs."""
        return self._process is not None and self._process.poll() is None

    def prepare(self, now: Sequence[str], later: Sequence[str] = ()) -> None:
        """Start it, and have it import modules while nobody asks, some of them `later`. Raises OSError."""
        self._modules = (*now, LATER, *later)
        with self._lock:
            self._see_to_it()

    def path(self) -> Path:
        """Return where it is asked; it is started if need be. Raises OSError."""
        with self._lock:
            self._asked = True
            return self._see_to_it()

    def look_after(self) -> None:
        """Start it again some time after it has died, and replace it when it has not answered for long.

        What it was asked for and has not taken up the next one is asked for.
        """
        now = time.monotonic()
        with self._lock:
            if self._listener is None:
                return
            if not self.lives:
                self._forget_probe()
                if now >= self._again:
                    self._again, self._pause = now + self._pause, min(2 * self._pause, _LONGEST_PAUSE)
                    self._see_to_it()
            elif self._probe is None:
                if now - self._probed > _PROBE_EVERY:
                    self._ask_whether_it_answers(now)
            elif self._has_answered(self._probe[0]):
                self._forget_probe()
                self._pause = _FIRST_PAUSE
            elif now - self._probe[1] > LONGEST_SILENCE:
                self._forget_probe()
                assert self._process is not None
                self._process.kill()

    def _ask_whether_it_answers(self, now: float) -> None:
        """It closes a connection on which nothing is asked."""
        assert self._listener is not None
        probe = socket.socket(socket.AF_UNIX)
        probe.setblocking(False)
        with contextlib.suppress(OSError):  # too many wait already: then it does not answer
            probe.connect(self._listener.getsockname())
            probe.shutdown(socket.SHUT_WR)
        self._probe, self._probed = (probe, now), now

    def _has_answered(self, probe: socket.socket) -> bool:
        try:
            return probe.recv(1) == b""
        except OSError:
            return False

    def _forget_probe(self) -> None:
        if self._probe is not None:
            self._probe[0].close()
            self._probe = None

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
        self._forget_probe()
        self._hang_up()
        shutil.rmtree(at.parent, ignore_errors=True)

    def _hang_up(self) -> None:
        if self._process is not None:
            assert self._process.stdin is not None
            self._process.stdin.close()
            try:
                # It may import for some time yet; if it was never asked it has nothing to see to.
                self._process.wait(_LAST_WORDS if self._asked else 0)
            except subprocess.TimeoutExpired:
                self._process.kill()
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
        request = ForkRequest(
            where,
            pickle.dumps(arguments),
            modules,
            f"sequence-planner: {name}",
            {**os.environ, VARIABLE: str(server)},
            list(sys.path),
            working_folder(),
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


def working_folder() -> str | None:
    """Return where this process is; None where that is gone."""
    try:
        return str(Path.cwd())
    except OSError:
        return None


def hang_up(connection: Connection) -> None:
    """Let nothing more come over a connection of both directions: whoever waits for it is told so at once.

    To close it would not do: its other end may be on its way to a fork server that stands still.
    """
    with contextlib.suppress(OSError), socket.socket(fileno=os.dup(connection.fileno())) as end:
        end.shutdown(socket.SHUT_RDWR)


def children() -> list[Child]:
    """The processes that this one has started here and that live."""
    return [each for each in list(_children) if each.poll() is None]


def ask(server: Path, request: ForkRequest, descriptors: list[int], name: str) -> Child:
    """Have a process forked by the server at that socket. Raises OSError when it cannot be asked."""
    to = socket.socket(socket.AF_UNIX)
    to.settimeout(_PATIENCE)
    try:
        to.connect(str(server))
        send_request(to, request, descriptors)
        to.settimeout(None)
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
