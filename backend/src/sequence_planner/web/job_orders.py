"""Job orders, as a MES gives them and people look after them; see `docs/mes.md`.

An order that is repeated with its `Idempotency-Key` is stored once and answered the same. A change names the revision
that was seen (`If-Match`), a command needs none: what the state of the order does not allow is refused.
"""

from __future__ import annotations

import json
from enum import StrEnum
from typing import Annotated, Any

from fastapi import Header, Path, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field, StrictBool, StrictInt
from sqlalchemy import Connection

from sequence_planner.identity.roles import Role, Scope
from sequence_planner.mes import answers, orders
from sequence_planner.mes.answers import Kept
from sequence_planner.mes.order import JobOrder, OrderContent
from sequence_planner.mes.states import OrderCommand, OrderState
from sequence_planner.mes.tables import LONGEST_ID
from sequence_planner.mes.times import Time
from sequence_planner.web.access import allowed
from sequence_planner.web.audit import LARGEST_NUMBER, MOST_RECORDS
from sequence_planner.web.body import Body, Reason
from sequence_planner.web.interface import interface
from sequence_planner.web.order_answer import OrderAnswer, all_answered, answered
from sequence_planner.web.order_desk import OrderDesk
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Identity

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

bodiless = interface("/job-orders", tags=["job orders"], dependencies=[READ])
router = interface("/job-orders", tags=["job orders"], dependencies=[WRITE, JSON_ONLY])


class Sort(StrEnum):
    """In which order orders are answered: as they were `stored`, or as they are to begin, by the order of `work`."""

    STORED = "stored"
    WORK = "work"


class OrdersAnswer(BaseModel):
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
    """What is asked of the order, and why."""

    command: OrderCommand
    reason: Reason = None


@bodiless.get("")
async def read_job_orders(
    request: Request,
    identity: Identity,
    state: Annotated[OrderState | None, Query()] = None,
    cursor: Annotated[int, Query(ge=0, le=LARGEST_NUMBER)] = 0,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
    sort: Annotated[Sort, Query()] = Sort.STORED,
) -> OrdersAnswer:
    """The orders as they were stored, only those in a state where one is named. Those that come meanwhile are last.

    With `sort=work` those that are not over, as they are to begin; pages may then overlap while that changes.
    """
    desk = desk_of(request)
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


@bodiless.get("/{id}", responses={200: TAGGED, **refused(404, 410)})
async def read_job_order(id: OrderId, request: Request, identity: Identity, response: Response) -> OrderAnswer:
    """An order, and why nothing is done for it now."""
    order = await identity.read(lambda connection: orders.get(connection, id))
    response.headers["ETag"] = _tag(order)
    return answered(order, desk_of(request))


@router.post("", status_code=201, response_model=OrderAnswer, responses={201: STORED, **refused(409)})
async def store_job_order(
    body: NewOrderBody, request: Request, identity: Identity, actor: Actor, idempotency_key: NewKey
) -> Response:
    """Store an order; with `start` it may begin at once.

    The same request with the same `Idempotency-Key` stores nothing more and is answered the same, for seven days, with
    `Idempotency-Replayed: true`. 422
    `idempotency-key-reused` when the key was that of another request; 409 `job-order-exists` when the id was used.
    """
    desk, now = desk_of(request), identity.now()
    digest = answers.digest(request.url.path, body)
    unknown = await desk.unknown_work_master(body.work_master)

    def write(connection: Connection) -> tuple[Kept, bool]:
        if (kept := answers.recall(connection, actor.id, idempotency_key, digest)) is not None:
            return kept, True
        if unknown is not None:
            raise unknown
        order = orders.store(connection, body.content(), actor, now, id=body.id, start=body.start)
        kept = Kept(201, _tag(order), answered(order, desk).model_dump_json())
        answers.keep(connection, actor.id, idempotency_key, digest, kept, now)
        return kept, False

    found, again = await identity.write(write, by=actor)
    desk.poke()
    id = json.loads(found.content)["id"]
    headers = {"ETag": found.tag, "Location": request.url_for("read_job_order", id=id).path}
    return Response(found.content, found.status, headers | ({REPLAYED: "true"} if again else {}), "application/json")


@router.put("/{id}", responses={200: TAGGED, **refused(404, 409, 410, 412, 428)})
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
        detail = "Name the revision that you saw in the header If-Match, in double quotes."
        raise ProblemFound(428, "revision-needed", "Which revision was seen is not said", detail)
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


@router.post("/{id}/commands", responses={200: TAGGED, **refused(404, 409, 410)})
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


def desk_of(request: Request) -> OrderDesk:
    """What knows how orders stand at the station."""
    desk: OrderDesk = request.app.state.order_desk
    return desk


def _tag(order: JobOrder) -> str:
    return f'"{order.revision}"'
