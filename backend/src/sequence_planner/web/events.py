"""What has happened to job orders, to be read on from wherever somebody has stopped reading."""

from __future__ import annotations

from typing import Annotated

from fastapi import Query
from pydantic import BaseModel
from sqlalchemy import Connection

from sequence_planner.identity.roles import Role, Scope
from sequence_planner.mes import events
from sequence_planner.mes.events import JobEvent
from sequence_planner.web.access import allowed
from sequence_planner.web.audit import LARGEST_NUMBER, MOST_RECORDS
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import Identity

router = interface("/events", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)])


class EventsAnswer(BaseModel):
    """Events, the oldest first; `next` is the `after` with which to ask for what comes then."""

    events: list[JobEvent]
    next: int


@router.get("", responses=refused(409, 410))
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
        detail = (
            f"There is no event {after}, the newest is {last}: the station was restored from a backup. Read the orders "
            f"anew, and the events after {last}."
        )
        raise ProblemFound(409, "event-not-known", "There is no such event yet", detail)
    return EventsAnswer(events=found, next=last)
