"""Child process of a fork server: handle of the requester, and reaping of orphans."""

from __future__ import annotations

import contextlib
import ctypes
import os
import select
import signal
import socket
import subprocess
import threading
import time
from typing import Final

from sequence_planner.forking.request import read_begun, read_code

# A process that a fork server has forked, as whoever has asked for it sees it.

LOST: Final = -signal.SIGKILL  # the exit code of a process that has ended when nobody was there to see how
_PATIENCE: Final = 10.0  # seconds in which the server says how a process has ended that certainly has
_LOOK: Final = 1.0  # seconds after which whoever waits sees for itself whether somebody else has heard


class Child:
    """A process called `name`; used like `subprocess.Popen`, from any thread. It ends when nobody refers to this."""

    def __init__(self, name: str, connection: socket.socket, *, leads: bool = False) -> None:
        self.name = name
        self.returncode: int | None = None
        self._connection = connection
        self._leads = leads
        self._lock = threading.RLock()
        self._pid: int | None = None
        self._handle = -1  # the descriptor that means the process, once it has begun
        self._gone: float | None = None  # since when, on the clock of `time.monotonic`, it is known to have ended
        self._killed = False

    def __del__(self) -> None:
        self._connection.close()
        if self._handle >= 0:
            os.close(self._handle)

    @property
    def pid(self) -> int | None:
        """Its number, as soon as it has begun, which is waited for; None if it never has."""
        while not self.has_begun:
            self._ready(_LOOK)
        return self._pid

    @property
    def has_begun(self) -> bool:
        """True if there is, or was, such a process, or never will be."""
        if self._pid is None and self.returncode is None and self._ready(0):
            self._hear()
        return self._pid is not None or self.returncode is not None

    @property
    def was_withdrawn(self) -> bool:
        """True if it was ended before it had begun."""
        return self._pid is None and self.returncode is not None

    def poll(self) -> int | None:
        """Its exit code, once it has ended; a signal's number, negative, where that has ended it."""
        self._hear()
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait until it has ended: its exit code. Raises `subprocess.TimeoutExpired`."""
        end = None if timeout is None else time.monotonic() + timeout
        while self.poll() is None:
            rest = _LOOK if end is None else min(_LOOK, end - time.monotonic())
            if rest <= 0:
                raise subprocess.TimeoutExpired(self.name, timeout or 0.0)
            self._ready(rest, *(() if self._gone else (self._handle,)))
        assert self.returncode is not None
        return self.returncode

    def join(self) -> None:
        """Wait until it has ended."""
        self.wait()

    def terminate(self) -> None:
        """Ask it to end. One that has not begun yet never does."""
        if self.has_begun:
            self._signal(signal.SIGTERM)
        else:
            self._withdraw()

    def kill(self) -> None:
        """End it at once, and all that it has started if it leads. One that has not begun yet never does."""
        if not self.has_begun:
            self._withdraw()
            return
        with self._lock:
            if self.poll() is not None or self._pid is None:
                return
            self._killed = True
            if self._leads:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(self._pid, signal.SIGKILL)
            self._signal(signal.SIGKILL)

    def _withdraw(self) -> None:
        """Nobody wants it any more: the server does not fork it, or ends it should it have done so just now."""
        self._end(LOST)

    def _signal(self, number: signal.Signals) -> None:
        with self._lock:
            if self.returncode is None:
                with contextlib.suppress(ProcessLookupError):
                    signal.pidfd_send_signal(self._handle, number)

    def _hear(self) -> None:
        """Take what was said, if anything was, or see that nothing more will be. It waits for nobody."""
        with self._lock:
            if self.returncode is not None or not self._ready(0, self._handle):
                return
            if not self._ready(0):
                self._is_gone()
                return
            try:
                if self._pid is None:
                    self._pid, self._handle = read_begun(self._connection)
                else:
                    self._end(read_code(self._connection))
            except (EOFError, OSError):  # the server is gone, and so is whoever else had this connection: the process
                self._end(self._seen())

    def _is_gone(self) -> None:
        """It has ended, and its server has not said how."""
        now = time.monotonic()
        self._gone = self._gone or now
        if self._killed:
            self._end(-signal.SIGKILL)
        elif now - self._gone > _PATIENCE:
            self._end(LOST)

    def _seen(self) -> int:
        """Tell how it has ended, of one without a server: whoever is the reaper of this process's orphans can see
        it.
        """
        if self._pid is None:
            return LOST
        _poll(None, self._handle)  # it has let go of the connection, and ends
        with contextlib.suppress(OSError):
            seen = os.waitid(os.P_PIDFD, self._handle, os.WEXITED)
            if seen is not None:
                return seen.si_status if seen.si_code == os.CLD_EXITED else -seen.si_status
        return LOST

    def _ready(self, seconds: float, *others: int) -> bool:
        """Return whether something is said within so many seconds, or one of the `others` is ready."""
        with contextlib.suppress(ValueError, OSError):  # it was closed meanwhile
            return _poll(seconds, self._connection.fileno(), *(each for each in others if each >= 0))
        return False

    def _end(self, code: int) -> None:
        with self._lock:
            if self.returncode is not None:
                return
            self.returncode = code
            with contextlib.suppress(OSError):
                self._connection.shutdown(socket.SHUT_RDWR)
            self._connection.close()
            if self._handle >= 0:
                os.close(self._handle)
                self._handle = -1


def _poll(seconds: float | None, *descriptors: int) -> bool:
    """Not `select`, which knows no descriptor above 1023."""
    looking = select.poll()
    for each in descriptors:
        looking.register(each, select.POLLIN)
    return bool(looking.poll(None if seconds is None else 1000 * seconds))


# Processes whose fork server has died: who sees how they end.

_SUBREAPER: Final = 36  # PR_SET_CHILD_SUBREAPER of prctl(2)


def reap_orphans() -> None:
    """Be the parent of all that descends from this process and has lost its own, where the system lets one be."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_SUBREAPER, 1, 0, 0, 0)
