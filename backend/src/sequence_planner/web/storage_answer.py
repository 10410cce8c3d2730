"""What the server answers about what is kept."""

from __future__ import annotations

from pydantic import BaseModel

from sequence_planner.retention.settings import DAY, GB
from sequence_planner.web.retention_desk import Looked, RetentionDesk


class StorageSizesAnswer(BaseModel):
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


class StorageDayAnswer(BaseModel):
    """What has come in a day that begins at `since`: so many records, and about so many bytes."""

    since: float
    records: int
    size: int


class StorageGrowthAnswer(BaseModel):
    """How it goes on if it goes on like this: bytes a day in the database (the mean of the last days) and, of these,
    in the archive; `journal` is how large what happened becomes until it is cut, `by_size` whether that is because of
    its size. The disk is full in `full_in` days; null where that is not foreseen within ten years.
    """

    per_day: int
    archived_per_day: int
    journal: int
    by_size: bool
    full_in: float | None


class StorageKeptAnswer(BaseModel):
    """The records from `first` to `last`, and when these happened, in seconds since the epoch."""

    first: int
    last: int
    since: float
    until: float


class StorageFileAnswer(BaseModel):
    """A file of the archive: with the records from `first` to `last`, or else with so many `orders`."""

    file: str
    size: int
    since: float | None
    until: float
    first: int | None
    last: int | None
    orders: int | None
    missing: bool


class StorageSettingsAnswer(BaseModel):
    """For how long things are kept, as the station was started: see the options of `run`. `folder` is null where what
    is cut is archived nowhere.
    """

    journal_days: float
    journal_gb: float
    order_days: float
    folder: str | None
    archive_days: float | None
    archive_gb: float | None


class StorageBusyAnswer(BaseModel):
    """For whom it is done now."""

    by: str


class StorageRunAnswer(BaseModel):
    """What was done last: how many records and job orders were cut, and how many files removed."""

    time: float
    records: int
    orders: int
    removed: int


class StorageAnswer(BaseModel):
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


def storage_answer(desk: RetentionDesk, looked: Looked) -> StorageAnswer:
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


def _files(looked: Looked) -> list[StorageFileAnswer]:
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


def _growth(desk: RetentionDesk, looked: Looked) -> StorageGrowthAnswer | None:
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


def _packed(looked: Looked) -> float:
    """How large a record is in the archive, compared with the database; a fifth before that is known."""
    segments, journal = looked.index.segments[-20:], looked.sizes.journal
    bounds = looked.bounds
    if not segments or bounds is None or not journal:
        return 0.2
    records = segments[-1].last - segments[0].first + 1
    each = sum(segment.size for segment in segments) / records
    return each / (journal / max(1, bounds[1].number - bounds[0].number + 1))
