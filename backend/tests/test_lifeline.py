"""Processes end with the one that started them, even if that is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

# A process that starts another and waits; its child says its id and waits too.
LAUNCHED = """
import os, sys, time
from pathlib import Path
from sequence_planner.process.parent_watch import end_with_launcher
end_with_launcher(Path(sys.argv[1]) if sys.argv[1:] else None)
print(os.getpid(), flush=True)
time.sleep(60)
"""


def launcher(*arguments: str) -> str:
    """A program that starts a process and waits."""
    command = f"[sys.executable, '-c', {LAUNCHED!r}, *{arguments!r}]"
    return f"import subprocess, sys\nsubprocess.Popen({command}, stdin=subprocess.PIPE).wait()"


def is_there(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def ends(pid: int) -> bool:
    end = time.monotonic() + 5
    while is_there(pid) and time.monotonic() < end:
        time.sleep(0.05)
    return not is_there(pid)


def killed(program: str) -> int:
    """The child of a process that runs `program` and was killed."""
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        child = int(process.stdout.readline())
        assert is_there(child)
        process.send_signal(signal.SIGKILL)
    return child


def test_what_was_launched_ends_with_a_launcher_that_is_killed() -> None:
    assert ends(killed(launcher()))


def test_nothing_is_left_of_a_demonstration_whose_launcher_was_killed(tmp_path: Path) -> None:
    folder = tmp_path / "launcher"
    (folder / "demonstration.revisions.git" / "objects").mkdir(parents=True)
    (folder / "demonstration.revisions.git" / "HEAD").write_text("ref: refs/heads/main\n")
    (folder / "demonstration.sqlite-wal").touch()
    assert ends(killed(launcher(str(folder))))
    assert not folder.exists()


def test_what_is_not_of_a_demonstration_stays_when_the_launcher_was_killed(tmp_path: Path) -> None:
    (tmp_path / "station.sqlite").touch()
    assert ends(killed(launcher(str(tmp_path))))
    assert (tmp_path / "station.sqlite").exists()
