"""Routes of the history: audit journal, run records, order events, past states and branches."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from functools import partial
from typing import Annotated, TypeVar

from fastapi import Depends, Path, Query, Request
from fastapi.responses import StreamingResponse
from pydantic import Field
from sqlalchemy import Connection

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.commands.command import GivenValue
from sequence_planner.controller.views.part import View
from sequence_planner.execution.record.codec import HistoryError
from sequence_planner.history.client import HistoryProcess
from sequence_planner.history.timeline import (
    Answer,
    BranchView,
    LineView,
    LookBack,
    MomentView,
    PlaceView,
    Question,
    RunRecordView,
    TakeBranch,
    line,
    place_at,
    record_view,
)
from sequence_planner.journal import audit, checkpoints
from sequence_planner.journal.archive import Archive, ArchiveError
from sequence_planner.journal.checkpoints import Checkpoint
from sequence_planner.journal.entry import Record
from sequence_planner.journal.full_run import MOST_FILES, WholeRun
from sequence_planner.journal.run_journal import RecordQuery, RunRecord
from sequence_planner.mes import events
from sequence_planner.mes.events import JobEvent
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, AnswerModel, Body, Identity
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.texts.message import message

# Reading the record of who did what. Nobody can change it over this interface or any other.

LARGEST_NUMBER = 2**53 - 1  # the largest whole number that every JSON reader keeps
MOST_RECORDS = 200

audit_router = interface("/audit", tags=["audit"], dependencies=[allowed(Role.OPERATOR, scope=Scope.AUDIT)])


class AuditAnswer(AnswerModel):
    """Records, newest first; `next` is the `before` with which older ones follow, null when there are none."""

    records: list[Record]
    next: int | None


@audit_router.get("")
async def read_audit(
    identity: Identity,
    before: Annotated[int | None, Query(ge=1, le=LARGEST_NUMBER)] = None,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
    action: Annotated[str | None, Query(pattern="^[a-z-]{1,100}$")] = None,
    actor: Annotated[str | None, Query(pattern="^[!-~ ]{1,200}$")] = None,
    since: Annotated[float | None, Query(allow_inf_nan=False)] = None,
    until: Annotated[float | None, Query(allow_inf_nan=False)] = None,
) -> AuditAnswer:
    """Acts that were done, refused or failed; only those of one action or one actor (by id), where these are named, and
    that from `since` to before `until` (seconds since the epoch).
    """
    records = await identity.read(
        lambda connection: audit.read(
            connection, before=before, limit=limit + 1, action=action, actor=actor, since=since, until=until
        )
    )
    more = len(records) > limit
    return AuditAnswer(records=records[:limit], next=records[limit - 1].number if more else None)


# What has happened to job orders, to be read on from wherever somebody has stopped reading.

events_router = interface("/events", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)])


class EventsAnswer(AnswerModel):
    """Events, the oldest first; `next` is the `after` with which to ask for what comes then."""

    events: list[JobEvent]
    next: int


@events_router.get("", responses=refused(409, 410))
async def read_events(
    identity: Identity,
    after: Annotated[int | None, Query(ge=0, le=LARGEST_NUMBER)] = None,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
) -> EventsAnswer:
    """The events with higher numbers than `after`; without it from the oldest that is kept. They are numbered without
    gaps and never change.

    410 `events-gone` where one behind `after` is kept no more: it may have been missed.

    409 `event-not-known` where there is no event `after` yet: a station that was restored from a backup numbers anew.
    """

    def chosen(connection: Connection) -> tuple[list[JobEvent], int]:
        if after is not None:
            events.require_kept(connection, after)
        found = events.after(connection, after or 0, limit)
        return found, found[-1].number if found else events.last(connection)

    found, last = await identity.read(chosen)
    if after is not None and last < after:
        raise ProblemFound(409, "event-not-known", message("refused.event-not-known.newest", number=after, last=last))
    return EventsAnswer(events=found, next=last)


# What has happened at the station: its records, how it was at each of them, and how it might have gone on.
#
# The database is read here, without the controller. Replay and simulation are done in a process of their own, which
# needs the model that ran then; see `docs/journal.md`. Nobody can change the record over this interface or any other.

T = TypeVar("T")
LOOKING_BACK = 60.0  # seconds for a look back, the first of which also prepares the station
BRANCHING = 60.0  # seconds of work for a branch
MOST_SECONDS = 600.0  # that a branch goes on
EXPORTED_AT_ONCE = 500  # records
LINES = "application/x-ndjson"
PARTS = "^[a-z_]{1,40}(,[a-z_]{1,40}){0,19}$"
KINDS = "^[a-z-]{1,40}(,[a-z-]{1,40}){0,19}$"

OPERATOR = allowed(Role.OPERATOR, scope=Scope.AUDIT)
history_router = interface("/history", tags=["history"])

_STATUSES = {
    "no-record": 404,
    "history-gone": 404,
    "model-changed": 409,
    "other-version": 409,
    "history-differs": 409,
    "history-unreadable": 409,
    "archive-unreadable": 409,
    "not-estimated": 422,
    "not-in-domain": 422,
    "history-timeout": 504,
    "history-failed": 503,
    "storage-unavailable": 503,
}

Text = Annotated[str, Field(min_length=1, max_length=200)]
Texts = Annotated[list[Text] | None, Query(max_length=100)]
Seconds = Annotated[float, Query(ge=-1e11, le=1e11, allow_inf_nan=False)]
Number = Annotated[int, Path(ge=1, le=LARGEST_NUMBER)]


async def _the_archive(request: Request) -> Archive:
    found: Archive = request.app.state.archive
    return found


TheArchive = Annotated[Archive, Depends(_the_archive)]


class HistoryAnswer(View):
    """Records, newest first; `next` is the `before` with which older ones follow, null when there are none."""

    records: list[RunRecordView]
    next: int | None


class BranchBody(Body):
    """For how long to go on, and estimates that are other than they were."""

    seconds: Annotated[float, Field(gt=0, le=MOST_SECONDS, strict=True)]
    corrections: dict[str, GivenValue] = Field(default_factory=dict, max_length=200)


@history_router.get("", dependencies=[OPERATOR], responses=refused(409))
async def read_history(
    identity: Identity,
    archive: TheArchive,
    before: Annotated[int | None, Query(ge=1, le=LARGEST_NUMBER)] = None,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
    kinds: Annotated[str | None, Query(pattern=KINDS)] = None,
    parts: Annotated[str | None, Query(pattern=PARTS)] = None,
    who: Annotated[str, Query(max_length=200)] = "",
    name: Texts = None,
    text: Texts = None,
) -> HistoryAnswer:
    """Records of events, only of some kinds, such as `mode-changed,forced`, or with some parts, such as
    `started,ended`, where these are named.

    `who` asks for what that person did, `name` for what has to do with one of these abilities, variables or operations
    (`robot.` stands for all of a resource), and `text` for records in which one of these stands.
    """
    wanted = None if kinds is None else frozenset(kinds.split(","))
    sought = RecordQuery(who, tuple(name or ()), tuple(text or ()), tuple(parts.split(",")) if parts else ())

    def chosen(run: WholeRun) -> tuple[list[RunRecord], int | None]:
        return run.before(before, limit + 1, wanted, sought, MOST_FILES), run.reached

    records, reached = await _read(identity, archive, chosen)
    following = records[limit - 1].number if len(records) > limit else reached
    return HistoryAnswer(records=[record_view(each) for each in records[:limit]], next=following)


@history_router.get("/line", dependencies=[OPERATOR], responses=refused(404, 409))
async def timeline(identity: Identity, archive: TheArchive, since: Seconds, until: Seconds) -> LineView:
    """Events after `since` and up to `until` (seconds since the epoch), as a time line shows them."""
    found = await _read(identity, archive, partial(line, since=since, until=until))
    if found is None:
        raise _empty()
    return found


@history_router.get("/at", dependencies=[OPERATOR], responses=refused(404, 409))
async def find_time(identity: Identity, archive: TheArchive, time: Seconds) -> PlaceView:
    """The last record up to `time` (seconds since the epoch), or the first one where none is so old."""
    found = await _read(identity, archive, partial(place_at, time=time))
    if found is None:
        raise _empty()
    return found


@history_router.get(
    "/export",
    dependencies=[OPERATOR],
    response_class=StreamingResponse,
    responses={200: {"content": {LINES: {"schema": {"type": "string"}}}}},
)
async def export_history(
    identity: Identity,
    archive: TheArchive,
    after: Annotated[int, Query(ge=0, le=LARGEST_NUMBER)] = 0,
    to: Annotated[int, Query(ge=1, le=LARGEST_NUMBER)] = LARGEST_NUMBER,
) -> StreamingResponse:
    """All records with higher numbers than `after`, up to `to`, one JSON document a line, as `journal export` writes
    them.
    """
    return StreamingResponse(_lines(identity, archive, after, to), media_type=LINES)


@history_router.get("/checkpoint", dependencies=[OPERATOR], responses=refused(404))
async def checkpoint(identity: Identity) -> Checkpoint:
    """The newest signed checkpoint: kept elsewhere, it shows whether the journal was made anew since."""
    newest = await identity.read(checkpoints.newest)
    if newest is None:
        raise ProblemFound(404, "no-checkpoint", message("refused.no-checkpoint.hourly"))
    return newest


@history_router.get("/{number}", dependencies=[OPERATOR], responses=refused(404, 409, 503, 504))
async def state_at(request: Request, number: Number) -> MomentView:
    """A record, and how the station was right after it."""
    return await looked_back(request, number)


@history_router.post(
    "/{number}/branch",
    dependencies=[JSON_ONLY, allowed(Role.ENGINEER)],
    responses=refused(404, 409, 503, 504),
)
async def branch_history(request: Request, number: Number, body: BranchBody) -> BranchView:
    """Simulate from a past record with emulated devices. Nothing of it reaches the station."""
    question = TakeBranch(number, body.seconds, dict(body.corrections), BRANCHING)
    found = await _asked(request, question, BRANCHING + LOOKING_BACK)
    assert isinstance(found, BranchView)
    return found


async def looked_back(request: Request, number: int) -> MomentView:
    """Return how the station was right after a record. Raises `ProblemFound`."""
    found = await _asked(request, LookBack(number), LOOKING_BACK)
    assert isinstance(found, MomentView)
    return found


async def _read(identity: IdentityService, archive: Archive, work: Callable[[WholeRun], T]) -> T:
    """Return what `work` reads of the run. Raises `ProblemFound` where that is in a file that cannot be read."""
    try:
        return await identity.read(lambda connection: work(WholeRun(connection, archive)))
    except ArchiveError as error:
        raise _unreadable(str(error)) from None


def _unreadable(why: str) -> ProblemFound:
    return ProblemFound(409, "archive-unreadable", message("refused.archive-unreadable.why", why=why))


def _empty() -> ProblemFound:
    return ProblemFound(404, "no-record", message("refused.no-record.empty"))


async def _asked(request: Request, question: Question, patience: float) -> Answer:
    process: HistoryProcess | None = request.app.state.history
    if process is None:
        raise ProblemFound(503, "history-failed", message("refused.history-failed.no-model"))
    try:
        return await process.ask(question, patience)
    except HistoryError as error:
        raise ProblemFound(_STATUSES[error.slug], error.slug, error.detail) from None


async def _lines(identity: IdentityService, archive: Archive, number: int, to: int) -> AsyncIterator[bytes]:
    while number < to:
        limit = min(EXPORTED_AT_ONCE, to - number)
        found = await _read(identity, archive, partial(WholeRun.after, number=number, limit=limit))
        page = [each for each in found if each.number <= to]
        if not page:
            return
        yield "".join(f"{each.line()}\n" for each in page).encode()
        number = page[-1].number
