"""Orders go on as the run's journal says: what is durable there has happened, and is told once.

The journal is read on from where the ledger stands, be there orders or not: what becomes of the station is told too.
What a page of records brings about is one transaction: the orders, their events and responses, and where the ledger
stands then.
"""

from __future__ import annotations

from typing import Final

from pydantic import JsonValue
from sqlalchemy import Connection, delete, insert, select

from sequence_planner.control.vocabulary import JobState
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
from sequence_planner.mes.station_news import Told
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

    def read_on(self, masters: WorkMastersView) -> tuple[bool, bool]:
        """Take note of the next records: whether orders have changed by it, and whether there may be more records.

        Raises `StorageError`; then nothing has happened.
        """
        if self._ledger is None:
            self._ledger = self._begin()
            self._kept = self._ledger.number
        with self._database.reading() as connection:
            records = run_journal.after(connection, self._ledger.number, _PAGE)
        if not records:
            return False, False
        ledger, happened = self._ledger.copied(), list[tuple[News, JobResponse | None] | Told]()
        for record in records:
            for news in ledger.take(read(record), masters):
                happened.append((news, response(news.job, masters) if news.what == "over" else None))
            happened += ledger.stand(record)
        if happened or ledger.number - self._kept >= _KEEP_EVERY:
            with self._database.writing() as connection:
                if _number(connection) != self._kept:  # where several stations share it another one has read on
                    self._ledger = None
                    return True, True
                for each in happened:
                    if isinstance(each, Told):
                        tell(connection, each)
                    else:
                        note(connection, *each)
                _keep(connection, ledger)
            self._kept = ledger.number
        self._ledger = ledger
        return any(not isinstance(each, Told) for each in happened), len(records) == _PAGE

    def _begin(self) -> Ledger:
        """The ledger as it is kept. Where nothing was told of the station so far, that begins now."""
        with self._database.reading() as connection:
            ledger = _load(connection)
            if ledger.silent is not None:
                return ledger
        with self._database.writing() as connection:
            ledger = _load(connection)
            if ledger.silent is None:
                ledger = _beginning(connection, ledger)
                _keep(connection, ledger)
        return ledger


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


def tell(connection: Connection, told: Told) -> None:
    """Write an event of the station, or of an order that is not over."""
    if told.job_order is not None:
        order = orders.find(connection, told.job_order)
        if order is None or order.is_over:
            return
    events.append(connection, told.kind, told.job_order, told.time, told.content)


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


def _beginning(connection: Connection, before: Ledger) -> Ledger:
    """A ledger in which the records of now are old: if nothing is worked on, none but the last whole one matters."""
    newest = next((each.number for each in run_journal.before(connection, None, 1)), 0)
    if any(not job.state.is_over for job in before.jobs.values()):
        return before.model_copy(update={"silent": newest})
    whole = next(iter(run_journal.before(connection, None, 1, (BEGUN, SNAPSHOT))), None)
    return Ledger(number=0 if whole is None else whole.number - 1, silent=newest)


def _keep(connection: Connection, ledger: Ledger) -> None:
    connection.execute(delete(JOB_LEDGER))
    connection.execute(insert(JOB_LEDGER), {"id": 1, "number": ledger.number, "content": ledger.model_dump_json()})
