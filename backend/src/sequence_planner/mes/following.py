"""Orders go on as the run's journal says: what is durable there has happened, and is told once.

The journal is read on from where the ledger stands. What a page of records brings about is one transaction: the orders,
their events and responses, and where the ledger stands then.
"""

from __future__ import annotations

from typing import Final

from pydantic import JsonValue
from sqlalchemy import Connection, delete, insert, select

from sequence_planner.control.job_view import JobState
from sequence_planner.control.work_master_view import WorkMastersView
from sequence_planner.history.codec import BEGUN, SNAPSHOT
from sequence_planner.journal import run_journal
from sequence_planner.mes import events, orders, responses
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.ledger import JobMade, Ledger, News
from sequence_planner.mes.order import JobOrder
from sequence_planner.mes.responses import JobOutcome, JobResponse, OperationMade
from sequence_planner.mes.run_reading import read
from sequence_planner.mes.states import OrderState
from sequence_planner.mes.tables import JOB_LEDGER
from sequence_planner.storage.database import Database

_PAGE: Final = 500  # records read at once
_KEEP_EVERY: Final = 2000  # records after which it is kept how far they were read, though nothing has come of them
_OUTCOMES: Final = {
    JobState.ENDED: (JobOutcome.COMPLETED, OrderState.ENDED, EventKind.ENDED),
    JobState.STOPPED: (JobOutcome.STOPPED, OrderState.ENDED, EventKind.ENDED),
    JobState.ABORTED: (JobOutcome.ABORTED, OrderState.ABORTED, EventKind.ABORTED),
}


class Following:
    """Reads the run's journal in `database` on behalf of its orders. Used by one thread at a time."""

    def __init__(self, database: Database) -> None:
        self._database = database
        self._ledger: Ledger | None = None
        self._kept = 0  # the number of the record up to which the database knows

    @property
    def has_jobs(self) -> bool:
        """Whether it knows of jobs that are not over."""
        return self._ledger is not None and any(not job.state.is_over for job in self._ledger.jobs.values())

    def begin(self, connection: Connection) -> None:
        """Nothing is worked on now: what was before does not matter. To be called before the first job is taken."""
        last = next(iter(run_journal.before(connection, None, 1, (BEGUN, SNAPSHOT))), None)
        ledger = Ledger(number=0 if last is None else last.number - 1)
        _keep(connection, ledger)
        self._ledger = None  # whether this is written is not certain yet: it is read then

    def read_on(self, masters: WorkMastersView) -> tuple[bool, bool]:
        """Take note of the next records: whether orders have changed by it, and whether there may be more records.

        Raises `StorageError`; then nothing has happened.
        """
        with self._database.reading() as connection:
            if self._ledger is None:
                self._ledger = _load(connection)
                self._kept = self._ledger.number
            records = run_journal.after(connection, self._ledger.number, _PAGE)
        if not records:
            return False, False
        ledger, happened = self._ledger.copied(), list[tuple[News, JobResponse | None]]()
        for record in records:
            for news in ledger.take(read(record), masters):
                happened.append((news, response(news.job, masters) if news.what == "over" else None))
        if happened or ledger.number - self._kept >= _KEEP_EVERY:
            with self._database.writing() as connection:
                if _number(connection) != self._kept:  # where several stations share it another one has read on
                    self._ledger = None
                    return True, True
                for news, made in happened:
                    note(connection, news, made)
                _keep(connection, ledger)
            self._kept = ledger.number
        self._ledger = ledger
        return bool(happened), len(records) == _PAGE


def response(job: JobMade, masters: WorkMastersView) -> JobResponse:
    """What was made for a job that is over. The description is that of its order, which is entered then."""
    master = masters.work_masters.get(job.work_master)
    names = list(job.operations) if master is None else [*dict.fromkeys([*master.operations, *job.operations])]
    assert job.ended is not None
    return JobResponse(
        job_order=job.job,
        work_master=job.work_master,
        description="",
        outcome=_OUTCOMES[job.state][0],
        began=job.taken,
        ended=job.ended,
        operations=[job.operations.get(name, OperationMade(operation=name)) for name in names],
        abilities=list(job.abilities),
        deviations=list(job.deviations),
        deviations_left_out=job.deviations_left_out,
        corrections=list(job.corrections),
    )


def note(connection: Connection, news: News, made: JobResponse | None) -> None:
    """Let an order be as its job is. Of jobs that nobody has ordered here there is nothing to note."""
    order = orders.find(connection, news.job.job)
    if order is None or order.is_over:
        return
    match news.what:
        case "taken":
            _taken(connection, order, news)
        case "over":
            assert made is not None
            _over(connection, order, news, made)
        case _:
            kind = EventKind.OPERATION_STARTED if news.what == "started" else EventKind.OPERATION_COMPLETED
            events.append(connection, kind, order.id, news.time, {"operation": news.operation})


def _taken(connection: Connection, order: JobOrder, news: News) -> None:
    if order.state is OrderState.ALLOWED_TO_START:
        orders.become(connection, order, OrderState.RUNNING, news.time, {"began": news.time})
        events.append(connection, EventKind.RUNNING, order.id, news.time, {"state": OrderState.RUNNING.value})


def _over(connection: Connection, order: JobOrder, news: News, made: JobResponse) -> None:
    outcome, state, kind = _OUTCOMES[news.job.state]
    number = responses.write(connection, made.model_copy(update={"description": order.description}), news.time)
    over = {"ended": news.time, "wish": None, "wished_by": None, "wished_because": None}
    orders.become(connection, order, state, news.time, over)
    told: dict[str, JsonValue] = {"state": state.value, "outcome": outcome.value, "response": number}
    told |= {} if order.wish is None else {"reason": order.wished_because}
    events.append(connection, kind, order.id, news.time, told)


def _number(connection: Connection) -> int:
    """Up to which record the database knows."""
    return connection.execute(select(JOB_LEDGER.c.number)).scalar_one_or_none() or 0


def _load(connection: Connection) -> Ledger:
    content: str | None = connection.execute(select(JOB_LEDGER.c.content)).scalar_one_or_none()
    return Ledger() if content is None else Ledger.model_validate_json(content)


def _keep(connection: Connection, ledger: Ledger) -> None:
    connection.execute(delete(JOB_LEDGER))
    connection.execute(insert(JOB_LEDGER), {"id": 1, "number": ledger.number, "content": ledger.model_dump_json()})
