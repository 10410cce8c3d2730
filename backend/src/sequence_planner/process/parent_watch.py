"""Processes that end when the one that started them does, however that came about.

A station's processes must not outlive the launcher: nobody would watch over them, and they would go on commanding
devices. Signals cannot tell (nobody sends one on behalf of a process that was killed), but a pipe can: when its other
end has gone it can be read to its end.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import shutil
import signal
import threading
import time
from pathlib import Path

from sequence_planner.process import restarts

STANDARD_INPUT = 0
LAST_WORDS_FILE = "SEQUENCE_PLANNER_LAST_WORDS"  # the variable of the environment that names it
LAST_WORDS_SUFFIX = ".last-words"
DEMONSTRATION_DATABASE = "demonstration.sqlite"  # in the launcher's folder; nothing of it is kept
# With what SQLite writes beside it, the revisions of the model, and what the launcher tells.
LEFT_BEHIND = (
    "demonstration.*",
    f"{restarts.NAME}*",
    "deployment",
    "analysis",
    "emulated*.*",
    f"*{LAST_WORDS_SUFFIX}",
)
DEPLOYED = 75  # the exit code with which the controller makes room for one that runs another model
OVERTAKEN = 76  # the exit code of a controller when another station has taken the command
NOT_EMULATED = 77  # the exit code of emulated devices that cannot be run with this model
LAST_WORDS = 5.0  # seconds in which a process may end in good order


def end_with_launcher(folder: Path | None = None) -> None:
    """End this process like SIGTERM does as soon as its standard input, a pipe from the launcher, is closed.

    `folder` is the launcher's; it is removed then, if it is empty but for what a demonstration keeps and what the
    launcher tells.
    """

    def remove() -> None:
        if folder is not None:
            with contextlib.suppress(OSError):
                for left in (each for pattern in LEFT_BEHIND for each in folder.glob(pattern)):
                    if left.is_dir():
                        shutil.rmtree(left, ignore_errors=True)
                    else:
                        left.unlink(missing_ok=True)
                folder.rmdir()

    def watch() -> None:
        _closed()
        remove()
        atexit.register(remove)  # once this process has taken out what is its own
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(LAST_WORDS)
        os._exit(1)

    threading.Thread(target=watch, daemon=True, name="lifeline").start()


def leave_last_words(text: str) -> None:
    """Tell the launcher why this process ends."""
    if file := os.environ.get(LAST_WORDS_FILE):
        with contextlib.suppress(OSError):
            Path(file).write_text(text, encoding="utf-8")


def _closed() -> None:
    while os.read(STANDARD_INPUT, 64):  # not `sys.stdin`: whoever waits in it holds up the interpreter's end
        pass
