"""A process of its own that makes or checks one backup."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from sequence_planner import background_process
from sequence_planner.background_process import EndedEarlyError
from sequence_planner.backup.archive import Maker
from sequence_planner.backup.making import Step
from sequence_planner.backup.settings import Keeping
from sequence_planner.backup.trouble import BackupError, Trouble

LONGEST: Final = 12 * 3600.0  # seconds after which it is given up


@dataclass(frozen=True)
class Task:
    """What to do with `file`: check it, or make it where there is a `maker`."""

    url: str
    model: Path
    keeping: Keeping
    file: Path
    maker: Maker | None


@dataclass(frozen=True)
class Finished:
    """It is whole; for its sake the `removed` are no more."""

    removed: tuple[str, ...]


async def carried_out(task: Task, tell: Callable[[Step], None]) -> Finished:
    """Do it in a process; `tell` is called with each step. Raises `StorageError`."""

    def hear(step: object) -> None:
        assert isinstance(step, Step)
        tell(step)

    try:
        done = await background_process.carried_out("sequence_planner.backup.task:do", task, LONGEST, hear)
    except TimeoutError:
        raise BackupError(Trouble.OTHER, f"it has taken more than {LONGEST / 3600:.0f} h and was given up") from None
    except EndedEarlyError:
        raise BackupError(Trouble.OTHER, "its process has ended too early: is memory short? Try again") from None
    assert isinstance(done, Finished)
    return done
