"""What has happened to job orders, to be read on from wherever somebody has stopped reading."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import BaseModel

from sequence_planner.identity.roles import Role, Scope
from sequence_planner.mes import events
from sequence_planner.mes.events import JobEvent
from sequence_planner.web.access import allowed
from sequence_planner.web.audit import LARGEST_NUMBER, MOST_RECORDS
from sequence_planner.web.request_parts import Identity

router = APIRouter(prefix="/events", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)])


class EventsAnswer(BaseModel):
    """Events, the oldest first; `next` is the `after` with which to ask for what comes then."""

    events: list[JobEvent]
    next: int


@router.get("")
async def read_events(
    identity: Identity,
    after: Annotated[int, Query(ge=0, le=LARGEST_NUMBER)] = 0,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
) -> EventsAnswer:
    """The events with higher numbers than `after`. They are numbered without gaps and never change."""
    found = await identity.read(lambda connection: events.after(connection, after, limit))
    return EventsAnswer(events=found, next=found[-1].number if found else after)
