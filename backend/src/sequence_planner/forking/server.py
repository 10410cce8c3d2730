"""The fork server: it imports what processes need, and forks one whenever it is asked to.

It has one thread, and nothing but imports ever happens in it, so that what is forked from it begins as a new process
does. It ends with whoever has started it: its standard input is a pipe from there.
"""

from __future__ import annotations

import contextlib
import fcntl
import gc
import importlib
import os
import pickle
import selectors
import signal
import socket
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any, Final

from setproctitle import setproctitle

from sequence_planner.forking.request import ForkRequest, read_request, send_begun, send_code

_STANDARD_INPUT: Final = 0
_LEAVING: Final = 0.5  # seconds after which one that was hung up is ended, unless that was the end of the launcher
_QUIET: Final = 1.0  # seconds in which nobody has wanted anything, before each thing that is not urgent
ABOVE: Final = 300  # no place has such a number
_PATIENCE: Final = 5.0  # seconds for the whole of a request: its parts are sent one right after the other
_OWN = "sequence_planner."  # what is imported here; anything else is imported by the process that needs it
Life = Callable[[], None]
"""Main function of a process."""


@dataclass
class _Forked:
    """A process, and the connection to whoever has asked for it."""

    leads: bool
    left: bool
    connection: socket.socket


class ForkServer:
    """Forks for whoever connects to `listener`; imports modules while it has nothing else to do: those for `now`, and
    those for `later` once nobody has wanted anything for a while, as whoever starts now needs the processor.
    """

    def __init__(self, listener: socket.socket, now: Iterable[str], later: Iterable[str] = ()) -> None:
        self._listener = listener
        self._now, self._later = deque(now), deque(later)
        self._tidy = False
        self._forked: dict[int, _Forked] = {}
        self._unwanted: dict[int, float] = {}  # processes that were to be left, and when they are ended
        self._selector = selectors.DefaultSelector()
        self._selector.register(listener, selectors.EVENT_READ)
        self._selector.register(_STANDARD_INPUT, selectors.EVENT_READ)
        self._woken, self._waking = socket.socketpair()
        for each in (self._woken, self._waking):
            each.setblocking(False)
        self._selector.register(self._woken, selectors.EVENT_READ)
        signal.set_wakeup_fd(self._waking.fileno(), warn_on_full_buffer=False)
        signal.signal(signal.SIGCHLD, lambda *_: None)  # or no signal wakes anybody
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # it is for whoever has started this
        gc.disable()  # whatever is imported stays

    def serve(self) -> Life | None:
        """Serve; returns in each process that was forked, with its life, and without one in the end."""
        while True:
            wait = self._patience()
            events = self._selector.select(wait)
            if not events and wait != _LEAVING:
                self._use_the_time()
            self._end_unwanted()
            for key, _ in events:
                if key.fileobj == _STANDARD_INPUT:
                    self._end()
                    return None
                if key.fileobj is self._listener:
                    life = self._accept()
                    if life is not None:
                        return life
                elif key.fileobj is self._woken:
                    with contextlib.suppress(BlockingIOError):
                        self._woken.recv(4096)
                    self._reap()
                else:
                    self._hang_up(key.data)

    def _patience(self) -> float | None:
        """Return how long it is waited for whoever wants something; None where there is nothing else to do."""
        if self._now:
            return 0
        if self._unwanted:
            return _LEAVING
        return None if self._tidy else _QUIET

    def _use_the_time(self) -> None:
        """Do the next of what is done while nobody wants anything."""
        for modules in (self._now, self._later):
            if modules:
                _import(modules.popleft())
                return
        gc.collect()  # what imports have left behind
        self._tidy = True

    def _accept(self) -> Life | None:
        """Fork for the next who asks: the life of the process in it, None here."""
        try:
            connection, _ = self._listener.accept()
        except OSError as error:  # too many files are open
            sys.stderr.write(f"nothing can be forked: {error.strerror}\n")
            time.sleep(_LEAVING)
            return None
        connection.settimeout(_PATIENCE)
        try:
            request, descriptors = read_request(connection)
        except Exception:  # whatever it was that came, it asks for nothing
            connection.close()
            return None
        for module in (request.main.partition(":")[0], *request.modules):
            _import(module)
        gc.freeze()  # what is shared is not touched by the collectors of those that share it
        pid = -1 if _is_closed(connection) else _fork()
        if pid == 0:
            return self._become(request, descriptors, connection)
        for each in descriptors:
            os.close(each)
        if pid < 0:
            connection.close()
            return None
        self._forked[pid] = _Forked(request.leads, request.left, connection)
        self._selector.register(connection, selectors.EVENT_READ, pid)
        return None

    def _hang_up(self, pid: int) -> None:
        """Hang up, as whoever has asked for the process is gone, or wants it to end."""
        forked = self._forked.get(pid)
        if forked is None:  # it was waited for in the same turn
            return
        self._selector.unregister(forked.connection)
        if forked.left:
            self._unwanted[pid] = time.monotonic() + _LEAVING
        else:
            _kill(pid, forked)  # how it has ended is still said to who waits for that

    def _end_unwanted(self) -> None:
        """End those that were to be left, but were hung up by somebody who lives on."""
        now = time.monotonic()
        for pid in [each for each, when in self._unwanted.items() if when <= now]:
            del self._unwanted[pid]
            if (forked := self._forked.get(pid)) is not None:
                _kill(pid, forked)

    def _reap(self) -> None:
        """Tell whoever has asked of all that have ended."""
        while self._forked:
            ended = os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
            if ended is None:
                return
            forked = self._forked.pop(ended.si_pid, None)
            self._unwanted.pop(ended.si_pid, None)
            if forked is not None and forked.leads and not forked.left:
                _kill_group(ended.si_pid)  # what it has started, before its number can be another's
            _, status = os.waitpid(ended.si_pid, 0)
            if forked is None:
                continue
            with contextlib.suppress(KeyError):  # it has been hung up
                self._selector.unregister(forked.connection)
            with contextlib.suppress(OSError):
                send_code(forked.connection, os.waitstatus_to_exitcode(status))
            forked.connection.close()

    def _end(self) -> None:
        for pid, forked in self._forked.items():
            if not forked.left:
                _kill(pid, forked)

    def _become(self, request: ForkRequest, descriptors: list[int], connection: socket.socket) -> Life:
        """Leave behind, in a process that was just forked, all that is the server's."""
        handle = os.pidfd_open(os.getpid())
        with contextlib.suppress(OSError):  # nobody waits for it any more, as is seen soon
            send_begun(connection, os.getpid(), handle)
        os.close(handle)
        gc.enable()
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        self._selector.close()
        for each in (self._listener, self._woken, self._waking):
            each.close()
        for forked in self._forked.values():
            forked.connection.close()
        self._forked.clear()
        if request.leads:
            os.setsid()
        # Above all places that somebody asks for, or one could be in the way of another.
        descriptors = [_above(each) for each in descriptors]
        connection = socket.socket(fileno=_above(connection.detach()))
        connections = [Connection(each) for each in descriptors[: request.connections]]
        places = dict(zip(request.places, descriptors[request.connections :], strict=True))
        if _STANDARD_INPUT not in places:
            places[_STANDARD_INPUT] = os.open(os.devnull, os.O_RDONLY)
        for place, descriptor in places.items():
            os.dup2(descriptor, place, inheritable=place == _STANDARD_INPUT)
            os.close(descriptor)
        os.environ.clear()
        os.environ.update(request.environment)
        sys.path[:] = request.path
        if request.folder is not None:
            os.chdir(request.folder)
        setproctitle(request.title)
        if request.left:
            connection.detach()  # it stays open, so that it tells whether this process lives if the server is gone
        else:
            _end_with(connection, leads=request.leads)
        module, _, name = request.main.partition(":")

        def life() -> None:
            arguments: tuple[Any, ...] = pickle.loads(request.arguments)
            getattr(importlib.import_module(module), name)(*connections, *arguments)

        return life


def _import(module: str) -> None:
    """Import it here, for all who will need it; what is not the program's own, each imports for itself."""
    if module.startswith(_OWN) and module not in sys.modules:
        with contextlib.suppress(Exception):
            importlib.import_module(module)


def _fork() -> int:
    """Fork: 0 in the process, its number here, and less where there can be none."""
    if len(os.listdir("/proc/self/task")) > 1:  # noqa: PTH208
        sys.stderr.write("the fork server has threads: what it forks may stand still\n")
    try:
        return os.fork()
    except OSError as error:  # there are too many, or memory is short
        sys.stderr.write(f"no process can be forked: {error.strerror}\n")
        return -1


def _is_closed(connection: socket.socket) -> bool:
    """Return whether the other end wants nothing any more."""
    connection.setblocking(False)
    try:
        return not connection.recv(1, socket.MSG_PEEK)
    except BlockingIOError:
        return False
    except OSError:
        return True


def _above(descriptor: int) -> int:
    """The same at a number from `ABOVE` on."""
    there = fcntl.fcntl(descriptor, fcntl.F_DUPFD_CLOEXEC, ABOVE)
    os.close(descriptor)
    return there


def _kill(pid: int, forked: _Forked) -> None:
    """End a process that was not waited for yet, so that its number is no other's."""
    if forked.leads:
        _kill_group(pid)
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)  # it may not lead yet


def _kill_group(pid: int) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(pid, signal.SIGKILL)


def _end_with(connection: socket.socket, *, leads: bool) -> None:
    """End this process when `connection` is closed, should the server be gone by then."""
    connection.setblocking(True)

    def watch() -> None:
        with contextlib.suppress(OSError):
            while connection.recv(1, socket.MSG_PEEK):
                pass
        (os.killpg if leads else os.kill)(os.getpid(), signal.SIGKILL)

    threading.Thread(target=watch, daemon=True, name="lifeline").start()
