"""What was made of job orders, for a MES and for people."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import BaseModel
from sqlalchemy import Connection

from sequence_planner.identity.roles import Role, Scope
from sequence_planner.mes import responses
from sequence_planner.mes.responses import StoredResponse
from sequence_planner.web.access import allowed
from sequence_planner.web.audit import LARGEST_NUMBER
from sequence_planner.web.job_orders import OrderId
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import Identity

MOST_RESPONSES = 50  # each may be long

router = APIRouter(
    prefix="/job-responses", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)]
)


class ResponsesAnswer(BaseModel):
    """Responses as they were written; `next` is the `cursor` with which later ones follow, null when there are none."""

    job_responses: list[StoredResponse]
    next: int | None


@router.get("")
async def read_job_responses(
    identity: Identity,
    cursor: Annotated[int, Query(ge=0, le=LARGEST_NUMBER)] = 0,
    limit: Annotated[int, Query(ge=1, le=MOST_RESPONSES)] = 10,
    newest: Annotated[bool, Query()] = False,
) -> ResponsesAnswer:
    """What was made of the orders that are over, in the order in which they were; orders that are cleared are left
    out. With `newest` it goes back from the last one.
    """

    def chosen(connection: Connection) -> list[StoredResponse]:
        if newest:
            return responses.latest(connection, cursor or None, limit + 1)
        return responses.page(connection, cursor, limit + 1)

    found = await identity.read(chosen)
    shown = found[:limit]
    return ResponsesAnswer(job_responses=shown, next=shown[-1].number if len(found) > limit else None)


@router.get("/{id}", responses=refused(404))
async def read_job_response(id: OrderId, identity: Identity) -> StoredResponse:
    """What was made of an order; 404 `no-job-response` until it is over."""
    found = await identity.read(lambda connection: responses.get(connection, id))
    if found is None:
        detail = "There is no job order with this id that is over: a response is written when it is."
        raise ProblemFound(404, "no-job-response", "There is no such response", detail)
    return found
