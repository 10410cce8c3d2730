"""A process that a fork server has forked, as whoever has asked for it sees it."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import socket
import subprocess
import threading
import time
from typing import Final

from sequence_planner.forking.request import read_begun, read_code

LOST: Final = -signal.SIGKILL  # the exit code of a process that has ended when nobody was there to see how
_PATIENCE: Final = 1.0  # seconds in which the server says how a process has ended that certainly has


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
        self._killed = False

    @property
    def pid(self) -> int | None:
        """Its number, as soon as it has begun, which is waited for; None if it never has."""
        if self._pid is None:
            self._ready(None)  # nobody who ends it waits for that
            self._hear()
        return self._pid

    @property
    def has_begun(self) -> bool:
        """Whether there is, or was, such a process."""
        if self._pid is None and self._ready(0):
            self._hear()
        return self._pid is not None or self.returncode is not None

    def poll(self) -> int | None:
        """Its exit code, once it has ended; a signal's number, negative, where that has ended it."""
        self._look(0)
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait until it has ended: its exit code. Raises `subprocess.TimeoutExpired`."""
        end = None if timeout is None else time.monotonic() + timeout
        while self.returncode is None:
            rest = None if end is None else end - time.monotonic()
            if rest is not None and rest <= 0:
                raise subprocess.TimeoutExpired(self.name, timeout or 0.0)
            self._look(rest)
        return self.returncode

    def join(self) -> None:
        """Wait until it has ended."""
        self.wait()

    def terminate(self) -> None:
        """Ask it to end."""
        if self.pid is not None:
            self._signal(signal.SIGTERM)

    def kill(self) -> None:
        """End it at once, and all that it has started if it leads. One that has not begun yet never does."""
        self._look(0)
        with self._lock:
            if self.returncode is not None:
                return
            self._killed = True
            if self._pid is None:
                with contextlib.suppress(OSError):
                    self._connection.shutdown(socket.SHUT_WR)  # the server ends it, should it have begun
                return
            if self._leads:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(self._pid, signal.SIGKILL)
            self._signal(signal.SIGKILL)

    def _signal(self, number: signal.Signals) -> None:
        with self._lock:
            if self.returncode is None:
                with contextlib.suppress(ProcessLookupError):
                    signal.pidfd_send_signal(self._handle, number)

    def _look(self, seconds: float | None) -> None:
        """See whether it has ended, for at most so many seconds; None: until something is said."""
        over = self._killed and self._pid is None
        if self._ready(_PATIENCE if over else seconds, self._handle):
            self._hear()
        elif over:
            self._end(LOST)

    def _hear(self) -> None:
        """Take what was said, or see that nothing more will be."""
        with self._lock:
            if self.returncode is not None:
                return
            try:
                if self._pid is None:
                    self._pid, self._handle = read_begun(self._connection)
                elif self._ready(_PATIENCE):
                    self._end(read_code(self._connection))
                else:  # it has ended, and its server stands still
                    self._end(LOST)
            except (EOFError, OSError):  # the server is gone, and so is whoever else had this connection: the process
                if self._pid is not None:
                    _poll(None, self._handle)
                self._end(LOST)

    def _ready(self, seconds: float | None, *others: int) -> bool:
        """Whether something is said within so many seconds, or one of the `others` is ready."""
        with contextlib.suppress(ValueError, OSError):  # it was closed meanwhile
            return _poll(seconds, self._connection.fileno(), *(each for each in others if each >= 0))
        return False

    def _end(self, code: int) -> None:
        with self._lock:
            if self.returncode is not None:
                return
            self.returncode = code
            with contextlib.suppress(OSError):
                self._connection.shutdown(socket.SHUT_RDWR)  # whoever waits for it is woken
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
