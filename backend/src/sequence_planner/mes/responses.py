"""The record of what was made of an order: operations and abilities with their times, values, deviations and
corrections.

A response is written once, when its order is over, and never changes. `record` is always the number of the record of
the run's journal that says so, so that responses can be held against the journal.
"""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field, JsonValue
from sqlalchemy import Connection, Select, func, insert, select, update

from sequence_planner.controller.views.part import Value
from sequence_planner.core.data_models import DataModel
from sequence_planner.mes.order import JobOrder, OrderRefused, OrderState
from sequence_planner.mes.tables import JOB_BEGIN, JOB_RESPONSES
from sequence_planner.texts.message import message


class JobOutcome(StrEnum):
    """Outcome of an order."""

    COMPLETED = "completed"
    STOPPED = "stopped"  # not everything that was ordered was made
    ABORTED = "aborted"


class OperationMade(DataModel):
    """An operation of the order. Where its goal held already it was never `started`; without `ended` it is not done.

    `actuals` are the values that its goal depends on, as they were when it was completed.
    """

    operation: str
    started: float | None = None
    ended: float | None = None
    record: int | None = None  # that tells of its end, or else of its start
    actuals: dict[str, Value | None] = Field(default={})


class AbilityMade(DataModel):
    """A start of an ability for the order. Without `ended` it still ran when the order was over."""

    ability: str
    started: float
    ended: float | None = None
    record: int  # that tells of its start
    called_off: bool = False  # it was ended by its cancel actions


class Deviation(DataModel):
    """What did not go as planned while the order was worked: `kind` is that of the record.

    Several orders that were worked at the same time tell of the same one.
    """

    time: float
    record: int
    kind: str
    content: dict[str, JsonValue]


class CorrectionMade(DataModel):
    """Values that a person has set while the order was worked, who and why."""

    time: float
    record: int
    values: dict[str, Value]
    by: str
    why: str


class JobResponse(DataModel):
    """The account of what was made of an order. Times are in seconds since the epoch.

    It was `due` by then, and stopped or aborted for a `reason`, where one was given. Of very many `deviations` the
    first are told, and how many were left out.
    """

    job_order: str
    work_master: str
    description: str
    outcome: JobOutcome
    due: float | None = None
    reason: str | None = None
    began: float | None  # when the station began to work on it
    ended: float
    operations: list[OperationMade]
    abilities: list[AbilityMade]
    deviations: list[Deviation]
    deviations_left_out: int = 0
    corrections: list[CorrectionMade]


class StoredResponse(JobResponse):
    """A response in its place; `number` counts them without gaps."""

    number: int


def nothing_made(order: JobOrder, reason: str | None = None) -> JobResponse:
    """The response to an order that is over for a `reason`, and of which the station has no job."""
    assert order.is_over
    assert order.ended is not None
    return JobResponse(
        job_order=order.id,
        work_master=order.work_master,
        description=order.description,
        outcome=JobOutcome.ABORTED if order.state is OrderState.ABORTED else JobOutcome.STOPPED,
        due=order.due,
        reason=reason,
        began=order.began,
        ended=order.ended,
        operations=[],
        abilities=[],
        deviations=[],
        corrections=[],
    )


def write(connection: Connection, response: JobResponse, now: float) -> int:
    """Keep a response, within a `writing()` block; its number."""
    last: int | None = connection.execute(select(func.max(JOB_RESPONSES.c.number))).scalar_one()
    number = (last or last_trimmed_response(connection)) + 1
    row = {"number": number, "job_order": response.job_order, "time": now, "content": response.model_dump_json()}
    connection.execute(insert(JOB_RESPONSES), row)
    return number


def last_trimmed_response(connection: Connection) -> int:
    """The number of the last response that is kept no more; 0 if all are."""
    found: int | None = connection.execute(select(JOB_BEGIN.c.responses)).scalar_one_or_none()
    return found or 0


def require_kept(connection: Connection, after: int) -> None:
    """Raises `OrderRefused` (`responses-gone`, 410) where a response behind `after` is kept no more."""
    if after < (gone := last_trimmed_response(connection)):
        raise OrderRefused("responses-gone", message("refused.responses-gone.up-to", number=gone), 410)


def remove(connection: Connection, job_order: str, now: float) -> None:
    """Show the response to an order no more, if there is one."""
    connection.execute(update(JOB_RESPONSES).where(JOB_RESPONSES.c.job_order == job_order).values(removed=now))


def get(connection: Connection, job_order: str) -> StoredResponse | None:
    """The response to an order; None where there is none, or the order was cleared."""
    return next(iter(_chosen(connection, 0, 1, job_order)), None)


def page(connection: Connection, after: int, limit: int) -> list[StoredResponse]:
    """Up to `limit` responses with numbers above `after`, the oldest first; those of cleared orders are left out."""
    return _chosen(connection, after, limit, None)


def latest(connection: Connection, before: int | None, limit: int) -> list[StoredResponse]:
    """Up to `limit` responses with numbers below `before` (None: the last), the newest first; see `page`."""
    chosen = _shown().order_by(JOB_RESPONSES.c.number.desc()).limit(limit)
    if before is not None:
        chosen = chosen.where(JOB_RESPONSES.c.number < before)
    return _read(connection, chosen)


def _chosen(connection: Connection, after: int, limit: int, job_order: str | None) -> list[StoredResponse]:
    chosen = _shown().where(JOB_RESPONSES.c.number > after).order_by(JOB_RESPONSES.c.number).limit(limit)
    if job_order is not None:
        chosen = chosen.where(JOB_RESPONSES.c.job_order == job_order)
    return _read(connection, chosen)


def _shown() -> Select[int, str]:
    """The responses of orders that are not cleared."""
    return select(JOB_RESPONSES.c.number, JOB_RESPONSES.c.content).where(JOB_RESPONSES.c.removed.is_(None))


def _read(connection: Connection, chosen: Select[int, str]) -> list[StoredResponse]:
    found = []
    for number, content in connection.execute(chosen):
        response = JobResponse.model_validate_json(content)
        found.append(StoredResponse(**dict(response), number=number))
    return found
