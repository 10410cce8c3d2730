"""What the process of a backup does, from its beginning to its end."""

from __future__ import annotations

from collections.abc import Callable

from sequence_planner.backup.keeping import Shelf
from sequence_planner.backup.making import Step, back_up
from sequence_planner.backup.process import Finished, Task
from sequence_planner.backup.whole import verify_backup
from sequence_planner.storage.error import StorageError


def do(task: Task, tell: Callable[[Step], None]) -> Finished:
    """Make a backup, read it again, and only then remove those that are too many; or only read one.

    Raises `StorageError`. What was made and is not whole is not kept.
    """
    shelf = Shelf(task.url, task.model, task.keeping)
    if task.maker is None:
        shelf.clear()
        tell(Step.CHECKING)
        verify_backup(task.file, shelf.scratch)
        return Finished(())
    shelf.prepare()
    back_up(task.url, task.model, task.file, task.maker, tell)
    tell(Step.CHECKING)
    try:
        verify_backup(task.file, shelf.scratch)
    except StorageError:
        task.file.unlink(missing_ok=True)
        raise
    return Finished(tuple(shelf.remove_oldest(task.file)))
