"""Reading the record of who did what. Nobody can change it over this interface or any other."""

from __future__ import annotations

from typing import Annotated

from fastapi import Query
from pydantic import BaseModel

from sequence_planner.identity.roles import Role, Scope
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Record
from sequence_planner.web.access import allowed
from sequence_planner.web.interface import interface
from sequence_planner.web.request_parts import Identity

LARGEST_NUMBER = 2**53 - 1  # the largest whole number that every JSON reader keeps
MOST_RECORDS = 200

router = interface("/audit", tags=["audit"], dependencies=[allowed(Role.OPERATOR, scope=Scope.AUDIT)])


class AuditAnswer(BaseModel):
    """Records, newest first; `next` is the `before` with which older ones follow, null when there are none."""

    records: list[Record]
    next: int | None


@router.get("")
async def read_audit(
    identity: Identity,
    before: Annotated[int | None, Query(ge=1, le=LARGEST_NUMBER)] = None,
    limit: Annotated[int, Query(ge=1, le=MOST_RECORDS)] = 50,
    action: Annotated[str | None, Query(pattern="^[a-z-]{1,100}$")] = None,
    actor: Annotated[str | None, Query(pattern="^[!-~ ]{1,200}$")] = None,
    since: Annotated[float | None, Query(allow_inf_nan=False)] = None,
    until: Annotated[float | None, Query(allow_inf_nan=False)] = None,
) -> AuditAnswer:
    """What was done, refused or failed; only that of one action or of one actor (by id), where these are named, and
    that from `since` to before `until` (seconds since the epoch).
    """
    records = await identity.read(
        lambda connection: audit.read(
            connection, before=before, limit=limit + 1, action=action, actor=actor, since=since, until=until
        )
    )
    more = len(records) > limit
    return AuditAnswer(records=records[:limit], next=records[limit - 1].number if more else None)
