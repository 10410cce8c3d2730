"""What was made of job orders, for a MES and for people."""

from __future__ import annotations

from typing import Annotated

from fastapi import Query
from pydantic import BaseModel
from sqlalchemy import Connection

from sequence_planner.identity.roles import Role, Scope
from sequence_planner.mes import orders, responses
from sequence_planner.mes.responses import (
    AbilityMade,
    CorrectionMade,
    Deviation,
    JobOutcome,
    OperationMade,
    StoredResponse,
)
from sequence_planner.mes.times import iso
from sequence_planner.web.access import allowed
from sequence_planner.web.audit import LARGEST_NUMBER
from sequence_planner.web.interface import interface
from sequence_planner.web.job_orders import OrderId
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import Identity

MOST_RESPONSES = 50  # each may be long

router = interface("/job-responses", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)])


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


class ResponseAnswer(BaseModel):
    """What was made of an order; `number` counts responses without gaps.

    Times are in seconds since the epoch, and in ISO 8601 where `_at` is added. Of very many `deviations` the first are
    told, and how many were left out.
    """

    number: int
    job_order: str
    work_master: str
    description: str
    outcome: JobOutcome
    began: float | None
    began_at = iso("began", optional=True)
    ended: float
    ended_at = iso("ended")
    operations: list[OperationAnswer]
    abilities: list[AbilityAnswer]
    deviations: list[DeviationAnswer]
    deviations_left_out: int = 0
    corrections: list[CorrectionAnswer]


class ResponsesAnswer(BaseModel):
    """Responses as they were written; `next` is the `cursor` with which later ones follow, null when there are none."""

    job_responses: list[ResponseAnswer]
    next: int | None


@router.get("", responses=refused(410))
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


@router.get("/{id}", responses=refused(404, 410))
async def read_job_response(id: OrderId, identity: Identity) -> ResponseAnswer:
    """What was made of an order; 404 `no-job-response` until it is over, 410 `job-order-gone` long after that."""

    def chosen(connection: Connection) -> StoredResponse | None:
        orders.require_kept(connection, id)
        return responses.get(connection, id)

    found = await identity.read(chosen)
    if found is None:
        detail = "There is no job order with this id that is over: a response is written when it is."
        raise ProblemFound(404, "no-job-response", "There is no such response", detail)
    return _answered(found)


def _answered(response: StoredResponse) -> ResponseAnswer:
    return ResponseAnswer.model_validate(response.model_dump())
