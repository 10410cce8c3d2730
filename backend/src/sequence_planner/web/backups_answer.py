"""What the server answers about backups, from what the folder holds and the journal tells."""

from __future__ import annotations

from pydantic import BaseModel

from sequence_planner.backup.archive import How, Manifest
from sequence_planner.backup.instructions import RestoreInstructions, instructions
from sequence_planner.backup.keeping import Kept, Looked, Shelf, what_is_in
from sequence_planner.backup.making import Step
from sequence_planner.backup.recording import Attempt, Doing, Recorded
from sequence_planner.backup.trouble import Trouble, trouble_in
from sequence_planner.journal.entry import Outcome
from sequence_planner.storage.error import StorageError
from sequence_planner.user import user_name
from sequence_planner.web.backup_desk import Busy


class BackupTroubleAnswer(BaseModel):
    """What is in the way: of which kind, and in words with what to do."""

    kind: Trouble
    detail: str


class BackupContentAnswer(BaseModel):
    """What a backup says of itself. `how` and `by` are null where it does not tell who made it.

    `time` is in seconds since the epoch; `audit` and `run` are the last records of who did what, and of what happened.
    """

    time: float
    how: How | None
    by: str | None
    program: str
    station: str
    database: str
    audit: int
    run: int
    model_files: int
    revisions: bool


class BackupCheckedAnswer(BaseModel):
    """How a backup was found when it was last read as a whole, which is also done when it is made."""

    time: float
    by: str
    whole: bool
    detail: str


class BackupAnswer(BaseModel):
    """A file in the folder, and the commands that restore it; `content` is null, and `wrong` says why, where the file
    cannot be read.
    """

    file: str
    size: int
    content: BackupContentAnswer | None
    wrong: str | None
    checked: BackupCheckedAnswer | None
    restoring: RestoreInstructions | None


class BackupBusyAnswer(BaseModel):
    """What is done just now; `step` is null until it has begun."""

    doing: Doing
    file: str
    begun: float
    by: str
    step: Step | None


class BackupAttemptAnswer(BaseModel):
    """How what was done last ended: `requested` where the server ended before."""

    doing: Doing
    file: str
    time: float
    by: str
    outcome: Outcome
    trouble: BackupTroubleAnswer | None


class BackupsAnswer(BaseModel):
    """Backups, the newest first, and where and how they are kept. `free` is in bytes, `every` in hours.

    The newest is old when it is older than `old_after` (seconds). `trouble` is what keeps one from being made, `last`
    how the last attempt ended, `user` who runs the station on its machine. With `same_disk` the disk of the database
    keeps its backups as well.
    """

    backups: list[BackupAnswer]
    folder: str
    free: int | None
    same_disk: bool
    kept: int
    every: float | None
    old_after: float
    user: str
    busy: BackupBusyAnswer | None
    last: BackupAttemptAnswer | None
    trouble: BackupTroubleAnswer | None


def backups_answer(shelf: Shelf, looked: Looked, recorded: Recorded, busy: Busy | None) -> BackupsAnswer:
    """All of it. Raises `StorageError` where the database has no place."""
    keeping = shelf.keeping
    return BackupsAnswer(
        backups=[_backup(shelf, each, recorded.checked.get(each.file)) for each in looked.backups],
        folder=str(shelf.folder),
        free=looked.free,
        same_disk=looked.same_disk,
        kept=keeping.kept,
        every=keeping.every,
        old_after=keeping.old_after,
        user=user_name(),
        busy=None if busy is None else busy_answer(busy),
        last=None if recorded.last is None else _attempt(recorded.last),
        trouble=None if looked.trouble is None else _trouble(looked.trouble),
    )


def busy_answer(busy: Busy) -> BackupBusyAnswer:
    """What is done just now."""
    return BackupBusyAnswer(doing=busy.doing, file=busy.file, begun=busy.begun, by=busy.by.name, step=busy.step)


def _backup(shelf: Shelf, kept: Kept, checked: Attempt | None) -> BackupAnswer:
    readable = kept.manifest is not None
    return BackupAnswer(
        file=kept.file,
        size=kept.size,
        content=None if kept.manifest is None else _content(kept.manifest),
        wrong=kept.wrong,
        checked=None if checked is None else _checked(checked),
        restoring=instructions(shelf.folder / kept.file, shelf.url, shelf.model) if readable else None,
    )


def _content(manifest: Manifest) -> BackupContentAnswer:
    files, revisions = what_is_in(manifest)
    return BackupContentAnswer(
        time=manifest.time,
        how=None if manifest.maker is None else manifest.maker.how,
        by=None if manifest.maker is None else manifest.maker.name,
        program=manifest.program,
        station=manifest.station,
        database=manifest.database,
        audit=manifest.audit.number,
        run=manifest.run.number,
        model_files=files,
        revisions=revisions,
    )


def _checked(attempt: Attempt) -> BackupCheckedAnswer:
    whole = attempt.outcome is Outcome.DONE
    return BackupCheckedAnswer(time=attempt.time, by=attempt.by.name, whole=whole, detail=attempt.why)


def _attempt(attempt: Attempt) -> BackupAttemptAnswer:
    failed = attempt.outcome is Outcome.FAILED
    return BackupAttemptAnswer(
        doing=attempt.doing,
        file=attempt.file,
        time=attempt.time,
        by=attempt.by.name,
        outcome=attempt.outcome,
        trouble=BackupTroubleAnswer(kind=attempt.trouble, detail=attempt.why) if failed else None,
    )


def _trouble(error: StorageError) -> BackupTroubleAnswer:
    return BackupTroubleAnswer(kind=trouble_in(error), detail=str(error))
