"""What has happened at the station: its records, how it was at each of them, and how it might have gone on.

The database is read here, without the controller. Replay and simulation are done in a process of their own, which needs
the model that ran then; see `docs/journal.md`. Nobody can change the record over this interface or any other.
"""

from __future__ import annotations

from collections.abc import AsyncIterator
from functools import partial
from typing import Annotated

from fastapi import APIRouter, Path, Query, Request
from fastapi.responses import StreamingResponse
from pydantic import Field

from sequence_planner.control.restart_commands import GivenValue
from sequence_planner.control.view_part import View
from sequence_planner.history.error import HistoryError
from sequence_planner.history.process import HistoryProcess
from sequence_planner.history.view import (
    Answer,
    BranchView,
    LookBack,
    MomentView,
    Question,
    RunRecordView,
    TakeBranch,
    record_view,
)
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.journal import checkpoints, run_journal
from sequence_planner.journal.checkpoints import Checkpoint
from sequence_planner.web.access import allowed
from sequence_planner.web.audit import LARGEST_NUMBER, MOST_RECORDS
from sequence_planner.web.body import Body
from sequence_planner.web.identity import IdentityOffice
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Identity

LOOKING_BACK = 60.0  # seconds for a look back, the first of which also prepares the station
BRANCHING = 60.0  # seconds of work for a branch
MOST_SECONDS = 600.0  # that a branch goes on
EXPORTED_AT_ONCE = 500  # records
LINES = "application/x-ndjson"
KINDS = "^[a-z-]{1,40}(,[a-z-]{1,40}){0,19}$"

OPERATOR = allowed(Role.OPERATOR, scope=Scope.AUDIT)
router = APIRouter(prefix="/history", tags=["history"])

_REFUSALS = {
    "no-record": (404, "There is no such record"),
    "history-gone": (404, "That was cut off"),
    "model-changed": (409, "The model is another one"),
    "history-differs": (409, "The run cannot be replayed"),
    "history-unreadable": (409, "The run cannot be replayed"),
    "not-estimated": (422, "This is no estimated variable"),
    "not-in-domain": (422, "This is no value of the variable"),
    "history-late": (504, "There was no answer in time"),
    "history-failed": (503, "The past cannot be looked at"),
    "storage-unavailable": (503, "The database does not answer"),
}

Number = Annotated[int, Path(ge=1, le=LARGEST_NUMBER)]


class HistoryAnswer(View):
    """Records, newest first; `next` is the `before` with which older ones follow, null when there are none."""

    records: list[RunRecordView]
    next: int | None


class BranchBody(Body):
    """For how long to go on, and estimates that are other than they were."""

    seconds: Annotated[float, Field(gt=0, le=MOST_SECONDS, strict=True)]
    corrections: dict[str, GivenValue] = Field(default_factory=dict, max_length=200)


@router.get("", dependencies=[OPERATOR])
async def read(
    identity: Identity,
    before: Annotated[int | None, Query(ge=1, le=LARGEST_NUMBER)] = None,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
    kinds: Annotated[str | None, Query(pattern=KINDS)] = None,
) -> HistoryAnswer:
    """What has happened, only of some kinds, such as `mode-changed,forced`, where these are named."""
    wanted = None if kinds is None else frozenset(kinds.split(","))
    records = await identity.read(lambda connection: run_journal.before(connection, before, limit + 1, wanted))
    more = len(records) > limit
    return HistoryAnswer(
        records=[record_view(each) for each in records[:limit]], next=records[limit - 1].number if more else None
    )


@router.get(
    "/export",
    dependencies=[OPERATOR],
    response_class=StreamingResponse,
    responses={200: {"content": {LINES: {"schema": {"type": "string"}}}}},
)
async def export(identity: Identity, after: Annotated[int, Query(ge=0, le=LARGEST_NUMBER)] = 0) -> StreamingResponse:
    """All records with higher numbers than `after`, one JSON document a line, as `journal export` writes them."""
    return StreamingResponse(_lines(identity, after), media_type=LINES)


@router.get("/checkpoint", dependencies=[OPERATOR], responses=refused(404))
async def checkpoint(identity: Identity) -> Checkpoint:
    """The newest signed checkpoint: kept elsewhere, it shows whether the journal was made anew since."""
    newest = await identity.read(checkpoints.newest)
    if newest is None:
        detail = "The station makes one every hour that it runs, and `sequence-planner journal checkpoint` at once."
        raise ProblemFound(404, "no-checkpoint", "There is no checkpoint yet", detail)
    return newest


@router.get("/{number}", dependencies=[OPERATOR], responses=refused(404, 409, 503, 504))
async def look_back(request: Request, number: Number) -> MomentView:
    """A record, and how the station was right after it."""
    found = await _asked(request, LookBack(number), LOOKING_BACK)
    assert isinstance(found, MomentView)
    return found


@router.post(
    "/{number}/branch",
    dependencies=[JSON_ONLY, allowed(Role.ENGINEER)],
    responses=refused(404, 409, 503, 504),
)
async def take_branch(request: Request, number: Number, body: BranchBody) -> BranchView:
    """How the station would have gone on from there, with emulated devices. Nothing of it reaches the station."""
    question = TakeBranch(number, body.seconds, dict(body.corrections), BRANCHING)
    found = await _asked(request, question, BRANCHING + LOOKING_BACK)
    assert isinstance(found, BranchView)
    return found


async def _asked(request: Request, question: Question, patience: float) -> Answer:
    process: HistoryProcess | None = request.app.state.history
    if process is None:
        detail = "The server was started without the model of the station: start the station with `run`."
        raise ProblemFound(503, "history-failed", "The past cannot be looked at", detail)
    try:
        return await process.ask(question, patience)
    except HistoryError as error:
        status, title = _REFUSALS[error.slug]
        detail = error.detail[0].upper() + error.detail[1:]
        raise ProblemFound(status, error.slug, title, detail if detail.endswith(".") else f"{detail}.") from None


async def _lines(identity: IdentityOffice, number: int) -> AsyncIterator[bytes]:
    while True:
        page = await identity.read(partial(run_journal.after, number=number, limit=EXPORTED_AT_ONCE))
        if not page:
            return
        yield "".join(f"{each.line()}\n" for each in page).encode()
        number = page[-1].number
