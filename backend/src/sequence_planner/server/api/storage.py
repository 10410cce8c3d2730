"""Routes of storage: backups, database size and growth, retention and archive."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request

from sequence_planner.auth.roles import Role
from sequence_planner.backup.archive import How, Manifest
from sequence_planner.backup.errors import Trouble, trouble_in
from sequence_planner.backup.service import (
    BackupAttempt,
    Doing,
    Kept,
    Recorded,
    RestoreInstructions,
    Shelf,
    Step,
    instructions,
    what_is_in,
)
from sequence_planner.backup.service import (
    BackupFolderState as LookedAtBackups,
)
from sequence_planner.core.storage_error import StorageError
from sequence_planner.journal.entry import Outcome
from sequence_planner.process.user import user_name
from sequence_planner.retention.settings import DAY, GB
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, AnswerModel, Identifier, NothingBody
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.server.services.backups import (
    BackupService,
    Busy,
    CannotBeginError,
    FolderSilentError,
    OtherBusyError,
)
from sequence_planner.server.services.retention import RetentionService, RetentionState
from sequence_planner.texts.message import message

# What the server answers about backups, from what the folder holds and the journal tells.


class BackupTroubleAnswer(AnswerModel):
    """An obstacle: its kind, and in words with what to do."""

    kind: Trouble
    detail: str


class BackupContentAnswer(AnswerModel):
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


class BackupCheckedAnswer(AnswerModel):
    """Result of the last verification of a backup, which is also done when it is made."""

    time: float
    by: str
    whole: bool
    detail: str


class BackupAnswer(AnswerModel):
    """A file in the folder, and the commands that restore it; `content` is null, and `wrong` says why, where the file
    cannot be read.
    """

    file: str
    size: int
    content: BackupContentAnswer | None
    wrong: str | None
    checked: BackupCheckedAnswer | None
    restoring: RestoreInstructions | None


class BackupBusyAnswer(AnswerModel):
    """The work under way; `step` is null until it has begun."""

    doing: Doing
    file: str
    begun: float
    by: str
    step: Step | None


class BackupAttemptAnswer(AnswerModel):
    """Result of the last work: `requested` if the server ended before it."""

    doing: Doing
    file: str
    time: float
    by: str
    outcome: Outcome
    trouble: BackupTroubleAnswer | None


class BackupsAnswer(AnswerModel):
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


def backups_answer(shelf: Shelf, looked: LookedAtBackups, recorded: Recorded, busy: Busy | None) -> BackupsAnswer:
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
    """Return what is done just now."""
    return BackupBusyAnswer(doing=busy.doing, file=busy.file, begun=busy.begun, by=busy.by.name, step=busy.step)


def _backup(shelf: Shelf, kept: Kept, checked: BackupAttempt | None) -> BackupAnswer:
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


def _checked(attempt: BackupAttempt) -> BackupCheckedAnswer:
    whole = attempt.outcome is Outcome.DONE
    return BackupCheckedAnswer(time=attempt.time, by=attempt.by.name, whole=whole, detail=attempt.why)


def _attempt(attempt: BackupAttempt) -> BackupAttemptAnswer:
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


# Backups: which there are, making one, and reading one as a whole. They stay on the server, and so does restoring.
#
# A backup holds password hashes and who did what. Whoever gets hold of an administrator's browser for a minute must not
# be able to carry all of that away, so none can be downloaded: who may read the folder may copy it from there.

ADMINISTRATOR = allowed(Role.ADMINISTRATOR)
backups_bodiless = interface("/backups", tags=["backups"], dependencies=[ADMINISTRATOR], responses=refused(409))
backups_router = interface(
    "/backups", tags=["backups"], dependencies=[ADMINISTRATOR, JSON_ONLY], responses=refused(409)
)


async def _backup_desk(request: Request) -> BackupService:
    """Return who looks after backups. Raises `ProblemFound` where there are none."""
    found: BackupService | None = request.app.state.backups
    if found is None:
        if request.app.state.settings.demonstration:
            raise ProblemFound(409, "demonstration", message("refused.demonstration.backups"))
        raise ProblemFound(409, "no-model", message("refused.no-model.start"))
    return found


Backups = Annotated[BackupService, Depends(_backup_desk)]


@backups_bodiless.get("")
async def list_backups(desk: Backups) -> BackupsAnswer:
    """All backups, the work under way, and what would keep another from being made."""
    try:
        looked, recorded = await desk.look(), await desk.recorded()
    except FolderSilentError as error:
        raise _silent(error) from None
    return backups_answer(desk.shelf, looked, recorded, desk.busy)


@backups_router.post("", status_code=202)
async def create_backup(body: NothingBody, desk: Backups, actor: Actor) -> BackupBusyAnswer:
    """Make a backup in the background. Whoever asks while one is being made gets that one."""
    try:
        return busy_answer(await desk.make(actor))
    except CannotBeginError as error:
        slug, why = f"backup-{trouble_in(error.trouble)}", str(error)
        raise ProblemFound(409, slug, f"{why[:1].upper()}{why[1:]}.", title=message("refused.backup-refused")) from None
    except OtherBusyError as other:
        raise _other(other.busy) from None
    except FolderSilentError as error:
        raise _silent(error) from None


@backups_router.post("/{file}/check", status_code=202, responses=refused(404))
async def check_backup(file: Identifier, body: NothingBody, desk: Backups, actor: Actor) -> BackupBusyAnswer:
    """Read a backup as a whole in the background, as if it were to be restored, but put nothing in place."""
    try:
        busy = await desk.check(file, actor)
    except OtherBusyError as other:
        raise _other(other.busy) from None
    except FolderSilentError as error:
        raise _silent(error) from None
    if busy is None:
        raise ProblemFound(404, "no-backup", message("refused.no-backup.folder", folder=str(desk.shelf.folder)))
    return busy_answer(busy)


def _other(busy: Busy) -> ProblemFound:
    return ProblemFound(409, "backup-busy", message("refused.backup-busy.by", file=busy.file, by=busy.by.name))


def _silent(error: FolderSilentError) -> ProblemFound:
    return ProblemFound(
        503, "backup-folder-silent", message("refused.backup-folder-silent.elsewhere", folder=str(error))
    )


# What the server answers about what is kept.


class StorageSizesAnswer(AnswerModel):
    """Bytes: of the database, of which `unused` are free for what comes (known of SQLite alone); of what happened and
    of job orders in it, estimated; of the archive and of backups beside the database. `free` is what is free on the
    disk of the database (null on another machine), `archive_free` on that of the archive.
    """

    database: int
    unused: int
    journal: int
    orders: int
    archive: int
    backups: int
    free: int | None
    archive_free: int | None


class StorageDayAnswer(AnswerModel):
    """Records of the day that begins at `since`, and about how many bytes they take."""

    since: float
    records: int
    size: int


class StorageGrowthAnswer(AnswerModel):
    """How it goes on if it goes on like this: bytes a day in the database (the mean of the last days) and, of these,
    in the archive; `journal` is how large what happened becomes until it is cut, `by_size` whether that is because of
    its size. The disk is full in `full_in` days; null where that is not foreseen within ten years.
    """

    per_day: int
    archived_per_day: int
    journal: int
    by_size: bool
    full_in: float | None


class StorageKeptAnswer(AnswerModel):
    """The records from `first` to `last`, and when these happened, in seconds since the epoch."""

    first: int
    last: int
    since: float
    until: float


class StorageFileAnswer(AnswerModel):
    """A file of the archive: with the records from `first` to `last`, or else with so many `orders`."""

    file: str
    size: int
    since: float | None
    until: float
    first: int | None
    last: int | None
    orders: int | None
    missing: bool


class StorageSettingsAnswer(AnswerModel):
    """For how long things are kept, as the station was started: see the options of `run`. `folder` is null where what
    is cut is archived nowhere.
    """

    journal_days: float
    journal_gb: float
    order_days: float
    folder: str | None
    archive_days: float | None
    archive_gb: float | None


class StorageBusyAnswer(AnswerModel):
    """For whom it is done now."""

    by: str


class StorageRunAnswer(AnswerModel):
    """Result of the last clean-up: numbers of records and job orders cut, and of files removed."""

    time: float
    records: int
    orders: int
    removed: int


class StorageAnswer(AnswerModel):
    """How much is kept, for how long, and how it grows. `database` and `archived` are null where there is nothing.

    `days` are the last days, the oldest first; `files` the newest files of the archive, the newest first, of so many.
    `trouble` is what keeps old things from being cut now; `missing` counts the files that are not there.
    """

    sizes: StorageSizesAnswer
    days: list[StorageDayAnswer]
    growth: StorageGrowthAnswer | None
    database: StorageKeptAnswer | None
    archived: StorageKeptAnswer | None
    files: list[StorageFileAnswer]
    file_count: int
    missing: int
    settings: StorageSettingsAnswer
    busy: StorageBusyAnswer | None
    last: StorageRunAnswer | None
    trouble: str | None


MOST_FILES = 20
_FAR = 3650.0  # days


def storage_answer(desk: RetentionService, looked: RetentionState) -> StorageAnswer:
    """All of it."""
    bounds, segments, done = looked.bounds, looked.index.segments, desk.done
    files = _files(looked)
    settings = desk.retention
    return StorageAnswer(
        sizes=StorageSizesAnswer(**vars(looked.sizes)),
        days=[StorageDayAnswer(**vars(each)) for each in looked.days],
        growth=_growth(desk, looked),
        database=None
        if bounds is None
        else StorageKeptAnswer(
            first=bounds[0].number, last=bounds[1].number, since=bounds[0].time, until=bounds[1].time
        ),
        archived=StorageKeptAnswer(
            first=segments[0].first, last=segments[-1].last, since=segments[0].since, until=segments[-1].until
        )
        if segments
        else None,
        files=files[:MOST_FILES],
        file_count=len(files),
        missing=len(looked.missing),
        settings=StorageSettingsAnswer(
            journal_days=settings.journal_days,
            journal_gb=settings.journal_gb,
            order_days=settings.order_days,
            folder=str(desk.folder) if settings.archived else None,
            archive_days=settings.archive_days,
            archive_gb=settings.archive_gb,
        ),
        busy=None if desk.busy is None else StorageBusyAnswer(by=desk.busy.name),
        last=None
        if done is None or desk.last_done is None
        else StorageRunAnswer(time=desk.last_done, records=done.records, orders=done.orders, removed=done.removed),
        trouble=desk.trouble,
    )


def _files(looked: RetentionState) -> list[StorageFileAnswer]:
    missing = {path.rpartition("/")[2] for path in looked.missing}
    found = [
        StorageFileAnswer(
            file=each.file,
            size=each.size,
            since=each.since,
            until=each.until,
            first=each.first,
            last=each.last,
            orders=None,
            missing=each.file in missing,
        )
        for each in looked.index.segments
    ]
    found += [
        StorageFileAnswer(
            file=each.file,
            size=each.size,
            since=None,
            until=each.until,
            first=None,
            last=None,
            orders=each.orders,
            missing=each.file in missing,
        )
        for each in looked.orders
    ]
    return sorted(found, key=lambda each: each.until, reverse=True)


def _growth(desk: RetentionService, looked: RetentionState) -> StorageGrowthAnswer | None:
    """From what the last days have brought; a day of which there is only a part counts as that part."""
    bounds, sizes, settings = looked.bounds, looked.sizes, desk.retention
    if not looked.days or bounds is None:
        return None
    seconds = min(bounds[1].time - bounds[0].time, len(looked.days) * DAY)
    if seconds <= 0:
        return None
    per_day = sum(each.size for each in looked.days) / seconds * DAY
    packed = _packed(looked)
    archived = per_day * packed if settings.archived else 0.0
    by_days, most = per_day * settings.journal_days, settings.journal_gb * GB
    becomes = min(by_days, most)
    return StorageGrowthAnswer(
        per_day=round(per_day),
        archived_per_day=round(archived),
        journal=round(becomes),
        by_size=most < by_days,
        full_in=_full_in(per_day, archived, becomes - sizes.journal - sizes.unused, sizes.free, settings.archive_gb),
    )


def _full_in(
    per_day: float, archived: float, to_come: float, free: int | None, archive_gb: float | None
) -> float | None:
    """Days until the disk is full: first the database grows, until as much is cut as comes, and then the archive."""
    if free is None or per_day <= 0:
        return None
    growing = max(0.0, to_come) / per_day
    if growing * per_day >= free:
        return free / per_day
    left = free - max(0.0, to_come)
    if archived <= 0 or (archive_gb is not None and archive_gb * GB <= left):
        return None
    days = growing + left / archived
    return days if days <= _FAR else None


def _packed(looked: RetentionState) -> float:
    """Return how large a record is in the archive, compared with the database; a fifth before that is known."""
    segments, journal = looked.index.segments[-20:], looked.sizes.journal
    bounds = looked.bounds
    if not segments or bounds is None or not journal:
        return 0.2
    records = segments[-1].last - segments[0].first + 1
    each = sum(segment.size for segment in segments) / records
    return each / (journal / max(1, bounds[1].number - bounds[0].number + 1))


# How much is kept and how it grows, for how long it is, and the archive; and to have what is old cut now.

storage_bodiless = interface("/storage", tags=["storage"], dependencies=[ADMINISTRATOR], responses=refused(409))
storage_router = interface(
    "/storage", tags=["storage"], dependencies=[ADMINISTRATOR, JSON_ONLY], responses=refused(409)
)


async def _retention_desk(request: Request) -> RetentionService:
    """Return who looks after it. Raises `ProblemFound` where nobody does."""
    found: RetentionService | None = request.app.state.retention
    if found is None:
        if request.app.state.settings.demonstration:
            raise ProblemFound(409, "demonstration", message("refused.demonstration.archive"))
        raise ProblemFound(409, "no-model", message("refused.no-model.start"))
    return found


Retention = Annotated[RetentionService, Depends(_retention_desk)]


@storage_bodiless.get("")
async def storage(desk: Retention) -> StorageAnswer:
    """Stored amounts, their growth, how long each is kept, and what keeps them from being cut."""
    return storage_answer(desk, await desk.look())


@storage_router.post("/archive", status_code=202)
async def archive_now(body: NothingBody, desk: Retention, actor: Actor) -> StorageBusyAnswer:
    """Cut what is older than the settings say now, in the background. Whoever asks while it is done gets that."""
    desk.ask(actor)
    return StorageBusyAnswer(by=actor.name if desk.busy is None else desk.busy.name)
