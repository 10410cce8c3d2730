"""Routes of job orders for a MES: orders, responses, capabilities and the schedule."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Sequence
from enum import StrEnum
from typing import Annotated, Any

import structlog
from fastapi import Header, Path, Query, Request, Response
from pydantic import ConfigDict, Field, StrictBool, StrictInt
from sqlalchemy import Connection

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.jobs import JobOperation, JobWait, SequenceJobs
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.controller.views.details import WorkMasterView
from sequence_planner.controller.views.station import StationView
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Time, iso
from sequence_planner.core.storage_error import StorageError
from sequence_planner.mes import idempotency, orders, responses
from sequence_planner.mes.idempotency import KeptAnswer
from sequence_planner.mes.order import JobOrder, OrderCommand, OrderContent, OrderState, Wish
from sequence_planner.mes.orders import MOST_OPEN
from sequence_planner.mes.queue import order_of_work
from sequence_planner.mes.responses import (
    AbilityMade,
    CorrectionMade,
    Deviation,
    JobOutcome,
    OperationMade,
    StoredResponse,
)
from sequence_planner.mes.scheduling.dispatch import waits_among
from sequence_planner.mes.scheduling.problem import (
    MOST,
    KnownTimes,
    Schedule,
    SchedulingProblem,
    held_up,
    scheduling_problem,
)
from sequence_planner.mes.scheduling.scheduler import Sequencer
from sequence_planner.mes.tables import LONGEST_ID
from sequence_planner.server.api.history import LARGEST_NUMBER, MOST_RECORDS
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, AnswerModel, Body, Identity, LiveView, Reason
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.server.services.orders import OrderService
from sequence_planner.texts.message import Message, message, waits_in_one

# A job order as it is answered over REST.

_COMMANDS = {
    Wish.PAUSE: OrderCommand.PAUSE,
    Wish.RESUME: OrderCommand.RESUME,
    Wish.STOP: OrderCommand.STOP,
    Wish.ABORT: OrderCommand.ABORT,
}


class OrderAnswer(AnswerModel):
    """An order. Times are in seconds since the epoch, and in ISO 8601 where `_at` is added.

    `stored_by` is the name of a person or a key.

    `commanded` is what the station is still to do with it, `allowed` the commands that the order allows now. Since
    `began` the station works on it. `waits_for` says in words why nothing is done for it now, `reason` what was given
    as it was paused or cancelled, or as it was asked for what is `commanded`.

    `expected_start` and `expected_end` follow from the median of how long orders of its work master took, if the
    station goes on; null where nobody knows, as before one was completed.
    """

    id: str
    work_master: str
    description: str
    priority: int
    due: float | None
    due_at = iso("due", optional=True)
    earliest: float | None
    earliest_at = iso("earliest", optional=True)
    state: OrderState
    commanded: OrderCommand | None
    allowed: list[OrderCommand]
    revision: int
    stored: float
    stored_at = iso("stored")
    stored_by: str
    changed: float
    changed_at = iso("changed")
    began: float | None
    began_at = iso("began", optional=True)
    ended: float | None
    ended_at = iso("ended", optional=True)
    expected_start: float | None
    expected_start_at = iso("expected_start", optional=True)
    expected_end: float | None
    expected_end_at = iso("expected_end", optional=True)
    reason: str | None
    waits_for: list[str]
    waits_for_messages: list[Message]
    sentence: Message | None  # what the station waits for with it, as one sentence


_KEPT = OrderAnswer.model_fields.keys() & JobOrder.model_fields.keys()


def answered(order: JobOrder, desk: OrderService) -> OrderAnswer:
    """An order as it is told to who asks `desk`, which knows how it stands at the station."""
    return all_answered([order], desk)[0]


def all_answered(orders: Sequence[JobOrder], desk: OrderService) -> list[OrderAnswer]:
    """Orders as they are told to who asks `desk`."""
    waits, times = desk.waits_for(orders), desk.expected(orders)
    return [
        OrderAnswer(
            **each.model_dump(include=_KEPT),
            commanded=None if each.wish is None else _COMMANDS[each.wish],
            allowed=[] if each.removed is not None else list(each.allowed),
            expected_start=times[each.id].start,
            expected_end=times[each.id].end,
            reason=each.wished_because,
            waits_for=[*waits[each.id]],
            waits_for_messages=waits[each.id],
            sentence=waits_in_one(waits[each.id]),
        )
        for each in orders
    ]


# Job orders, as a MES gives them and people look after them; see `docs/mes.md`.
#
# An order that is repeated with its `Idempotency-Key` is stored once and answered the same. A change names the revision
# that was seen (`If-Match`), a command needs none: what the state of the order does not allow is refused.

READ, WRITE = allowed(Role.VIEWER, scope=Scope.ORDERS_READ), allowed(Role.OPERATOR, scope=Scope.ORDERS_WRITE)
LONGEST_DESCRIPTION = 2000  # characters
HIGHEST_PRIORITY = 32767
TEXT = r"^[^\x00]*$"  # what every database can keep
TAGGED: dict[str, Any] = {
    "headers": {
        "ETag": {
            "description": "The revision, as `If-Match` has to name it.",
            "required": True,
            "schema": {"type": "string", "pattern": '^"[0-9]{1,9}"$'},
        }
    }
}
Condition = Annotated[str | None, Header(pattern=r'^(\*|"[0-9]{1,9}")$')]
NewKey = Annotated[str, Header(alias="Idempotency-Key", pattern=r"^[!-~]{1,200}$")]
REPLAYED = "Idempotency-Replayed"
STORED: dict[str, Any] = {
    "headers": {
        **TAGGED["headers"],
        "Location": {
            "description": "Where the order is.",
            "required": True,
            "schema": {"type": "string", "format": "uri-reference"},
        },
        REPLAYED: {
            "description": "That this is the answer to the same request of before.",
            "schema": {"const": "true"},
        },
    }
}
OrderId = Annotated[str, Path(max_length=200)]

job_orders_bodiless = interface("/job-orders", tags=["job orders"], dependencies=[READ])
job_orders_router = interface("/job-orders", tags=["job orders"], dependencies=[WRITE, JSON_ONLY])


class Sort(StrEnum):
    """In which order orders are answered: as they were `stored`, or as they are to begin, by the order of `work`."""

    STORED = "stored"
    WORK = "work"


class OrdersAnswer(AnswerModel):
    """Orders in a row; `next` is the `cursor` with which later ones follow, null when there are none."""

    job_orders: list[OrderAnswer]
    next: int | None


class OrderBody(Body):
    """What is ordered: a job of a work master.

    How late it is weighs by its `priority`; nothing begins before `earliest`. Times are in seconds since the epoch or
    in ISO 8601.
    """

    work_master: Annotated[str, Field(min_length=1, max_length=200, pattern=TEXT)]
    description: Annotated[str, Field(max_length=LONGEST_DESCRIPTION, pattern=TEXT)] = ""
    priority: Annotated[StrictInt, Field(ge=0, le=HIGHEST_PRIORITY)] = 0
    due: Time | None = None
    earliest: Time | None = None

    def content(self) -> OrderContent:
        """It, to be stored."""
        return OrderContent(**{name: getattr(self, name) for name in OrderContent.model_fields})


class NewOrderBody(OrderBody):
    """A new order. Without an `id` it is given one; with `start` it is allowed to start at once."""

    model_config = ConfigDict(
        json_schema_extra={"examples": [{"id": "engine-4711", "work_master": "truck_engine", "start": True}]}
    )
    id: Annotated[str, Field(pattern=rf"^[A-Za-z0-9._-]{{1,{LONGEST_ID}}}$")] | None = None
    start: StrictBool = False


class CommandBody(Body):
    """A request about an order, with its reason."""

    command: OrderCommand
    reason: Reason = None


@job_orders_bodiless.get("")
async def read_job_orders(
    request: Request,
    identity: Identity,
    state: Annotated[OrderState | None, Query()] = None,
    cursor: Annotated[int, Query(ge=0, le=LARGEST_NUMBER)] = 0,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
    sort: Annotated[Sort, Query()] = Sort.STORED,
    cancelled: Annotated[bool, Query()] = False,
) -> OrdersAnswer:
    """The orders as they were stored, only those in a state where one is named. Those that come meanwhile are last.

    With `sort=work` those that are not over, as they are to begin; pages may then overlap while that changes. With
    `cancelled` no others than those that were cancelled, when they were `changed` last; the newest come first, in one
    page.
    """
    desk = desk_of(request)
    if cancelled:
        gone = await identity.read(lambda connection: orders.cancelled(connection, limit))
        return OrdersAnswer(job_orders=all_answered(gone, desk), next=None)
    if sort is Sort.WORK:
        known = desk.orders
        found = await identity.read(lambda connection: orders.open_orders(connection, known))
        ordered = desk.sequence([each for each in found if state is None or each.state is state])
        shown, rest = ordered[cursor : cursor + limit], len(ordered) - cursor - limit
        after = cursor + limit if rest > 0 else None
    else:
        found = await identity.read(lambda connection: orders.page(connection, state, cursor, limit + 1))
        shown = found[:limit]
        after = shown[-1].number if len(found) > limit else None
    return OrdersAnswer(job_orders=all_answered(shown, desk), next=after)


@job_orders_bodiless.get("/{id}", responses={200: TAGGED, **refused(404, 410)})
async def read_job_order(id: OrderId, request: Request, identity: Identity, response: Response) -> OrderAnswer:
    """An order, and why nothing is done for it now."""
    order = await identity.read(lambda connection: orders.get(connection, id))
    response.headers["ETag"] = _tag(order)
    return answered(order, desk_of(request))


@job_orders_router.post("", status_code=201, response_model=OrderAnswer, responses={201: STORED, **refused(409)})
async def store_job_order(
    body: NewOrderBody, request: Request, identity: Identity, actor: Actor, idempotency_key: NewKey
) -> Response:
    """Store an order; with `start` it may begin at once.

    The same request with the same `Idempotency-Key` stores nothing more and is answered the same, for seven days, with
    `Idempotency-Replayed: true`. 422
    `idempotency-key-reused` when the key was that of another request; 409 `job-order-exists` when the id was used.
    """
    desk, now = desk_of(request), identity.now()
    digest = idempotency.digest(request.url.path, body)
    unknown = await desk.unknown_work_master(body.work_master)

    def write(connection: Connection) -> tuple[KeptAnswer, bool]:
        if (kept := idempotency.recall(connection, actor.id, idempotency_key, digest)) is not None:
            return kept, True
        if unknown is not None:
            raise unknown
        order = orders.store(connection, body.content(), actor, now, id=body.id, start=body.start)
        kept = KeptAnswer(201, _tag(order), answered(order, desk).model_dump_json())
        idempotency.store_answer(connection, actor.id, idempotency_key, digest, kept, now)
        return kept, False

    found, again = await identity.write(write, by=actor)
    desk.poke()
    id = json.loads(found.content)["id"]
    headers = {"ETag": found.tag, "Location": request.url_for("read_job_order", id=id).path}
    return Response(found.content, found.status, headers | ({REPLAYED: "true"} if again else {}), "application/json")


@job_orders_router.put("/{id}", responses={200: TAGGED, **refused(404, 409, 410, 412, 428)})
async def change_job_order(
    id: OrderId,
    body: OrderBody,
    request: Request,
    identity: Identity,
    actor: Actor,
    response: Response,
    if_match: Condition = None,
) -> OrderAnswer:
    """Let an order be of another content, until the station works on it; what is left out is as if it was new.

    428 without `If-Match`, which may be `*` for whatever revision there is; 412 `job-order-changed` when by now it has
    another revision; 409 `job-order-started`.
    """
    if if_match is None:
        raise ProblemFound(428, "revision-needed", message("refused.revision-needed.header"))
    desk, now = desk_of(request), identity.now()
    revision = None if if_match == "*" else int(if_match.strip('"'))
    unknown = await desk.unknown_work_master(body.work_master)

    def write(connection: Connection) -> JobOrder:
        if unknown is not None:
            raise unknown
        return orders.change(connection, id, revision, body.content(), actor, now)

    order = await identity.write(write, by=actor)
    desk.poke()
    response.headers["ETag"] = _tag(order)
    return answered(order, desk)


@job_orders_router.post("/{id}/commands", responses={200: TAGGED, **refused(404, 409, 410)})
async def command_job_order(
    id: OrderId, body: CommandBody, request: Request, identity: Identity, actor: Actor, response: Response
) -> OrderAnswer:
    """Start, RevokeStart, Pause, Resume, Stop, Abort, Cancel or Clear an order.

    What the station has to do is `commanded` until it is done. 409 `command-not-allowed` names in `allowed` what is. A
    person who resumes an order has to be in control.
    """
    desk, now = desk_of(request), identity.now()
    if body.command is OrderCommand.RESUME:
        desk.require_control(actor)
    order = await identity.write(
        lambda connection: orders.command(connection, id, body.command, actor, body.reason, now), by=actor
    )
    desk.poke()
    response.headers["ETag"] = _tag(order)
    return answered(order, desk)


def desk_of(request: Request) -> OrderService:
    """Return what knows how orders stand at the station."""
    desk: OrderService = request.app.state.order_desk
    return desk


def _tag(order: JobOrder) -> str:
    return f'"{order.revision}"'


# What the station can do for a MES: its work masters, its equipment and its people, and how many orders it holds.

capabilities_router = interface(
    "/capabilities", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)]
)


class EquipmentAnswer(AnswerModel):
    """A resource, whether all its topics speak and it is in service."""

    title: str
    online: bool
    in_service: bool
    abilities: list[str]


class HeldAnswer(AnswerModel):
    """Number of unfinished orders that the station can hold, and holds now."""

    most: int
    now: int


class CapabilitiesAnswer(AnswerModel):
    """A work master: a product that may be ordered, and the operations that make it.

    `personnel` are the resources whose abilities people carry out, `equipment` all others. Only while `by_order` the
    station works on orders: it is for people there to let it.
    """

    station: str
    title: str
    by_order: bool
    work_masters: dict[str, WorkMasterView]
    equipment: dict[str, EquipmentAnswer]
    personnel: dict[str, EquipmentAnswer]
    job_orders: HeldAnswer


@capabilities_router.get("")
async def capabilities(request: Request, identity: Identity, view: LiveView) -> CapabilitiesAnswer:
    """A work master: a product that may be ordered, and the operations that make it."""
    masters = await desk_of(request).work_masters()
    if masters is None:
        raise ProblemFound(503, "preparing", message("refused.preparing.abilities"))
    out = {(each.of, each.name) for each in view.out_of_service}
    human = {each.resource for each in view.abilities.values() if each.human}
    able: dict[str, list[str]] = {name: [] for name in view.resources}
    for name, ability in view.abilities.items():
        able.setdefault(ability.resource, []).append(name)
    resources = {
        name: EquipmentAnswer(
            title=each.title,
            online=each.online,
            in_service=("resource", name) not in out,
            abilities=able[name],
        )
        for name, each in view.resources.items()
    }
    return CapabilitiesAnswer(
        station=view.station.name,
        title=view.station.title,
        by_order=view.by_order,
        work_masters=masters.work_masters,
        equipment={name: each for name, each in resources.items() if name not in human},
        personnel={name: each for name, each in resources.items() if name in human},
        job_orders=HeldAnswer(most=MOST_OPEN, now=await identity.read(orders.count_open)),
    )


# What was made of job orders, for a MES and for people.

MOST_RESPONSES = 50  # each may be long

job_responses_router = interface(
    "/job-responses", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)]
)


class OperationAnswer(OperationMade):
    """An operation of the order. Where its goal held already it was never `started`; without `ended` it is not done.

    `actuals` are the values that its goal depends on, as they were when it was completed.
    """

    started_at = iso("started", optional=True)
    ended_at = iso("ended", optional=True)


class AbilityAnswer(AbilityMade):
    """A start of an ability for the order. Without `ended` it still ran when the order was over."""

    started_at = iso("started")
    ended_at = iso("ended", optional=True)


class DeviationAnswer(Deviation):
    """What did not go as planned while the order was worked: `kind` is that of the record.

    Several orders that were worked at the same time tell of the same one.
    """

    time_at = iso("time")


class CorrectionAnswer(CorrectionMade):
    """Values that a person has set while the order was worked, who and why."""

    time_at = iso("time")


class ResponseAnswer(AnswerModel):
    """What was made of an order; `number` counts responses without gaps.

    Times are in seconds since the epoch, and in ISO 8601 where `_at` is added. It was `due` by then, and stopped or
    aborted for a `reason`, where one was given. Of very many `deviations` the first are told, and how many were left
    out.
    """

    number: int
    job_order: str
    work_master: str
    description: str
    outcome: JobOutcome
    due: float | None
    due_at = iso("due", optional=True)
    reason: str | None
    began: float | None
    began_at = iso("began", optional=True)
    ended: float
    ended_at = iso("ended")
    operations: list[OperationAnswer]
    abilities: list[AbilityAnswer]
    deviations: list[DeviationAnswer]
    deviations_left_out: int = 0
    corrections: list[CorrectionAnswer]


class ResponsesAnswer(AnswerModel):
    """Responses as they were written; `next` is the `cursor` with which later ones follow, null when there are none."""

    job_responses: list[ResponseAnswer]
    next: int | None


@job_responses_router.get("", responses=refused(410))
async def read_job_responses(
    identity: Identity,
    cursor: Annotated[int | None, Query(ge=0, le=LARGEST_NUMBER)] = None,
    limit: Annotated[int, Query(ge=1, le=MOST_RESPONSES)] = 10,
    newest: Annotated[bool, Query()] = False,
) -> ResponsesAnswer:
    """What was made of the orders that are over, in the order in which they were; orders that are cleared are left
    out. With `newest` it goes back from the last one.

    410 `responses-gone` where one behind `cursor` is kept no more; without `cursor` it begins with the oldest that is.
    """

    def chosen(connection: Connection) -> list[StoredResponse]:
        if newest:
            return responses.latest(connection, cursor or None, limit + 1)
        if cursor is not None:
            responses.require_kept(connection, cursor)
        return responses.page(connection, cursor or 0, limit + 1)

    found = await identity.read(chosen)
    shown = found[:limit]
    told = [_answered(each) for each in shown]
    return ResponsesAnswer(job_responses=told, next=shown[-1].number if len(found) > limit else None)


@job_responses_router.get("/{id}", responses=refused(404, 410))
async def read_job_response(id: OrderId, identity: Identity) -> ResponseAnswer:
    """Job response of an order; 404 `no-job-response` until it is over, 410 `job-order-gone` long after that."""

    def chosen(connection: Connection) -> StoredResponse | None:
        orders.require_kept(connection, id)
        return responses.get(connection, id)

    found = await identity.read(chosen)
    if found is None:
        raise ProblemFound(404, "no-job-response", message("refused.no-job-response.id"))
    return _answered(found)


def _answered(response: StoredResponse) -> ResponseAnswer:
    return ResponseAnswer.model_validate(response.model_dump())


# The order of work of the orders: looked for whenever something is known anew, told to the station, and shown.

LOG = structlog.get_logger(__name__)
LOOK_EVERY = 1.0  # seconds
ASK_EVERY = 5.0  # seconds between two questions
LIMIT = 5.0  # seconds for an answer
HELD_UP = 30.0  # seconds after which nobody waits any longer for a job of which nothing is active

order_of_work_router = interface(
    "/schedule", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)]
)


class ExpectedOperation(AnswerModel):
    """Expected start and end of an operation."""

    operation: str
    start: float
    start_at = iso("start")
    end: float
    end_at = iso("end")


class ExpectedOrder(AnswerModel):
    """Expected start and end of an order, and by how many seconds it is expected to be late."""

    id: str
    late: float
    operations: list[ExpectedOperation]


class OrderOfWorkAnswer(AnswerModel):
    """The orders in the order in which they are to begin, as it was found at `time`; null while there is none.

    The first `horizon` orders were searched for the best that was found in time, the others follow by rule; `bound` is
    what the weighted `tardiness` of all cannot be below. It is `optimal` when no other has less weighted tardiness, or
    with it an earlier end. `fallback` says why it is only
    that of priority and due time; empty if it is not. Times are in seconds since the epoch.
    """

    time: float | None
    time_at = iso("time", optional=True)
    job_orders: list[ExpectedOrder]
    tardiness: float
    bound: float
    optimal: bool
    horizon: int
    fallback: str


class OrderOfWorkDesk:
    """Looks for the order of work of what `desk` knows, once there are two orders to be put into one."""

    def __init__(self, office: IdentityService, controller: ControllerClient, desk: OrderService) -> None:
        self._office = office
        self._controller = controller
        self._desk = desk
        self._resources: dict[str, str] = {}
        self._known = KnownTimes(self._resources)
        self._sequencer: Sequencer | None = None
        self._asked = SchedulingProblem((), ())  # last
        self._answered = SchedulingProblem((), ())  # what `found` answers
        self._asked_at = float("-inf")  # on the clock of `time.monotonic`
        self._places: dict[str, int] = {}
        self._said: SequenceJobs | None = None
        self._held_up: dict[str, float] = {}  # jobs, and since when
        self.found: tuple[float, Schedule] | None = None
        self._in_trouble = False
        desk.sequence = self.ordered

    async def run(self) -> None:
        """Look until cancelled. What fails is tried again and again; until then it is as it was."""
        try:
            while True:
                try:
                    await self._look()
                    self._in_trouble = False
                except (StorageError, CommandRefused, ValueError) as error:
                    self._note(str(error))
                except Exception as error:  # whatever it is, orders are worked by rule at least
                    if not self._in_trouble:
                        LOG.exception("the order of work cannot be looked for")
                    self._note(repr(error))
                await asyncio.sleep(LOOK_EVERY)
        finally:
            if self._sequencer is not None:
                self._sequencer.close()

    def ordered(self, orders: Sequence[JobOrder]) -> list[JobOrder]:
        """Those that have a place in the order that was found, then the others by rule."""
        places = self._places  # any thread may ask, and there are others at any time
        return sorted(order_of_work(orders), key=lambda order: places.get(order.id, len(places)))

    async def _look(self) -> None:
        view = self._controller.view if self._controller.heard else None
        masters = await self._desk.work_masters()
        if view is None or masters is None or self._controller.stands_by:
            return
        question = scheduling_problem(self._desk.orders, view, masters, await self._times(view))
        if len(question.works) < 2:
            self._asked = self._answered = SchedulingProblem((), ())
            self._places, self.found = {}, None
        else:
            await self._ask(question)
        await self._tell(view)

    async def _times(self, view: StationView) -> KnownTimes:
        """Return how long operations take, as far as the run's journal tells by now."""
        # Also of abilities that have come with another model since.
        self._resources.update((name, ability.resource) for name, ability in view.abilities.items())
        known = self._known
        if len(self._desk.orders) > 1:
            await self._office.read(known.read_on)
        return known

    async def _ask(self, question: SchedulingProblem) -> None:
        now = time.monotonic()
        again = self.found is None or bool(self.found[1].fallback) or question != self._asked
        if not again or now - self._asked_at < ASK_EVERY:
            return
        if self._sequencer is None:
            self._sequencer = Sequencer()
        self._asked, self._asked_at = question, now
        schedule = await self._sequencer.sequence(question.works, question.exclusive, self._office.now(), LIMIT)
        self.found, self._answered = (self._office.now(), schedule), question
        self._places = {job: place for place, job in enumerate(schedule.jobs)}

    async def _tell(self, view: StationView) -> None:
        """Have the station keep to the order between operations of different jobs that it works on."""
        now, still = time.monotonic(), held_up(view.jobs)
        self._held_up = {job: self._held_up.get(job, now) for job in still}
        going = {job for job in view.jobs if now - self._held_up.get(job, now) < HELD_UP}
        waits = {}
        if self.found is not None:
            works = [work for work in self._answered.works if work.job in going]
            waits = waits_among(works, self.found[1])
        said = SequenceJobs(
            actor=SYSTEM,
            waits=[
                JobWait(
                    job=job,
                    operation=operation,
                    for_=[JobOperation(job=other, operation=its) for other, its in before],
                )
                for (job, operation), before in waits.items()
            ],
        )
        # The station may remember what was said before this server was started.
        before = None if self._said is None and len(view.jobs) > 1 else [] if self._said is None else self._said.waits
        if said.waits != before:
            await self._controller.send(said)
            self._said = said

    def _note(self, reason: str) -> None:
        if not self._in_trouble:
            LOG.warning("the order of work is not looked for now", reason=reason)
        self._in_trouble = True


@order_of_work_router.get("")
async def read_schedule(request: Request, limit: Annotated[int, Query(ge=1, le=MOST)] = MOST) -> OrderOfWorkAnswer:
    """Expected times of orders, sorted by start; only the first `limit`."""
    desk: OrderOfWorkDesk = request.app.state.order_of_work
    if desk.found is None:
        return OrderOfWorkAnswer(
            time=None, job_orders=[], tardiness=0.0, bound=0.0, optimal=False, horizon=0, fallback=""
        )
    found, schedule = desk.found
    operations: dict[str, list[ExpectedOperation]] = {job: [] for job in schedule.jobs[:limit]}
    for (job, operation), (start, end) in schedule.starts.items():
        if job in operations:
            operations[job].append(ExpectedOperation(operation=operation, start=start, end=end))
    return OrderOfWorkAnswer(
        time=found,
        job_orders=[
            ExpectedOrder(id=job, late=schedule.late.get(job, 0.0), operations=its) for job, its in operations.items()
        ],
        tardiness=schedule.tardiness,
        bound=schedule.bound,
        optimal=schedule.optimal,
        horizon=schedule.horizon,
        fallback=schedule.fallback,
    )
