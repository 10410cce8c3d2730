"""A copy of this process that works beside it, so that what was imported and read is there and not made once more.

That is for commands, which are soon over: a copy has every file of this process open and shares its memory.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Final, NoReturn

from setproctitle import setproctitle

_SIGNAL_AT_END: Final = 1  # PR_SET_PDEATHSIG of prctl(2)


def can_be_copied() -> bool:
    """Return whether this process has a single thread: in a copy the others would be gone, and what they hold would
    not.
    """
    return threading.active_count() == 1


class Copy:
    """A process that calls `main`, which ends with this process; to be used by the thread that makes it.

    Its first argument is `connection`, which is closed here, then come `arguments`. Raises OSError when there are too
    many processes.
    """

    def __init__(self, main: Callable[..., object], *arguments: object, name: str, connection: Connection) -> None:
        with connection:
            for stream in (sys.stdout, sys.stderr):
                with contextlib.suppress(OSError, ValueError):
                    stream.flush()  # or what waits there would be written twice
            parent = os.getpid()
            self.pid = os.fork()
            if self.pid == 0:
                _live(main, connection, arguments, name, parent)
        self._over = False

    def kill(self) -> None:
        """End it at once."""
        if not self._over:
            os.kill(self.pid, signal.SIGKILL)

    def join(self) -> None:
        """Wait until it has ended."""
        if not self._over:
            os.waitpid(self.pid, 0)
            self._over = True


def _live(
    main: Callable[..., object], connection: Connection, arguments: tuple[object, ...], name: str, parent: int
) -> NoReturn:
    code = 1
    try:
        ctypes.CDLL(None).prctl(_SIGNAL_AT_END, signal.SIGKILL, 0, 0, 0)
        if os.getppid() == parent:
            setproctitle(f"sequence-planner: {name}")
            main(connection, *arguments)
            code = 0
    except BaseException:  # nothing of what this was a copy of may go on here
        traceback.print_exc()
    finally:
        os._exit(code)
