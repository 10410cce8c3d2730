"""What processes do in the tests of forking."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from multiprocessing.connection import Connection, Pipe

from sequence_planner.forking.starting import start


def tell(connection: Connection, *names: str) -> None:
    """Say what the process has of the variables of the environment that are called so."""
    connection.send([os.environ.get(name) for name in names])


def describe(connection: Connection) -> None:
    """Say what a process can see of itself."""
    connection.send(
        {
            "folder": os.getcwd(),  # noqa: PTH109 - as the system has it
            "path": sys.path,
            "descriptors": len(os.listdir("/proc/self/fd")),  # noqa: PTH208
            "threads": threading.active_count(),
            "input": sys.stdin.read(),
            "title": " ".join(open("/proc/self/cmdline").read().replace("\0", " ").split()),  # noqa: PTH123, SIM115
            "parent": os.getppid(),
        }
    )


def fail(connection: Connection) -> None:
    """End with an error."""
    raise SystemExit(7)


def wait(connection: Connection) -> None:
    """Say the number of the process, and wait."""
    connection.send(os.getpid())
    time.sleep(60)


def wait_with_another(connection: Connection) -> None:
    """Start a program, say the numbers of both processes, and wait."""
    program = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    connection.send((os.getpid(), program.pid))
    time.sleep(60)


def start_another(connection: Connection) -> None:
    """Start a process in the same way, say the numbers of both and who has forked them, and wait."""
    ours, theirs = Pipe()
    child = start(wait, name="another", connection=theirs)
    connection.send((os.getpid(), ours.recv(), os.getppid(), child.pid))
    time.sleep(60)
