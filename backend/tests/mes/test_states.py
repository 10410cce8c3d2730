"""The life of an order is that of OPC 10031-4, whatever is asked of it and whatever the station does meanwhile.

The reference is the table of this page: for each state what may be asked, and where that leads.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)
from sqlalchemy import Connection, delete, select

from sequence_planner.controller.views.details import WorkMastersView
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.execution.vocabulary import JobState
from sequence_planner.journal import audit
from sequence_planner.mes import events, orders, responses
from sequence_planner.mes.order import JobOrder, OrderCommand, OrderContent, OrderRefused, OrderState, Wish, allowed
from sequence_planner.mes.tables import JOB_EVENTS, JOB_ORDERS, JOB_RESPONSES
from sequence_planner.mes.tracker import JobMade, News, response, update_order
from support.examples import examples

MES = Actor(kind=ActorKind.KEY, id="mes", name="MES")
WAITING, READY, RUNNING, INTERRUPTED = "NotAllowedToStart", "AllowedToStart", "Running", "Interrupted"
ENDED, ABORTED, GONE = "Ended", "Aborted", "gone"

# Where nobody works on it: at once.
TABLE = {
    (WAITING, "Start"): READY,
    (WAITING, "Abort"): ABORTED,
    (WAITING, "Cancel"): GONE,
    (READY, "RevokeStart"): WAITING,
    (READY, "Abort"): ABORTED,
    (READY, "Cancel"): GONE,
    (ENDED, "Clear"): GONE,
    (ABORTED, "Clear"): GONE,
}
# At the station: what it then is to do. Beside the states there are those in which it is still to do something.
AT_STATION = {
    (READY, "Abort"): "abort",
    (RUNNING, "Pause"): "pause",
    (RUNNING, "Stop"): "stop",
    (RUNNING, "Abort"): "abort",
    (INTERRUPTED, "Resume"): "resume",
    (INTERRUPTED, "Stop"): "stop",
    (INTERRUPTED, "Abort"): "abort",
    ("pause", "Resume"): "resume",
    ("pause", "Stop"): "stop",
    ("pause", "Abort"): "abort",
    ("resume", "Pause"): "pause",
    ("resume", "Stop"): "stop",
    ("resume", "Abort"): "abort",
    ("stop", "Abort"): "abort",
}


@dataclass
class Expected:
    """An order as it should be."""

    state: str
    revision: int = 1
    at_station: bool = False
    wish: str | None = None
    told: list[str] = field(default_factory=lambda: ["job-order-stored"])

    def allowed(self) -> set[str]:
        table = AT_STATION if self.at_station else TABLE
        return {command for state, command in table if state == (self.wish or self.state)}


class Orders(RuleBasedStateMachine):
    """A MES, a station that takes orders or refuses them, and all that may happen between them."""

    def __init__(self, database: Database) -> None:
        super().__init__()
        self.database = database
        self.expected: dict[str, Expected] = {}
        self.now = 1000.0
        self.recorded = 0

    @initialize()
    def begin(self) -> None:
        with self.database.writing() as connection:
            for table in (JOB_ORDERS, JOB_EVENTS, JOB_RESPONSES):
                connection.execute(delete(table))
            end = audit.end(connection)
        assert end is not None
        self.before = end.number

    def pick(self, which: int) -> tuple[str, Expected] | None:
        names = list(self.expected)
        return (names[which % len(names)], self.expected[names[which % len(names)]]) if names else None

    @precondition(lambda self: len(self.expected) < 3)  # few, so that each comes far
    @rule(start=st.booleans(), named=st.booleans())
    def store(self, start: bool, named: bool) -> None:
        self.now += 1
        id = f"order-{len(self.expected)}" if named else None
        with self.database.writing() as connection:
            stored = orders.store(connection, OrderContent(work_master="engine"), MES, self.now, id=id, start=start)
        assert named is (stored.id == id)
        self.expected[stored.id] = Expected(READY if start else WAITING)
        self.recorded += 1

    @rule(which=st.integers(0, 9))
    def store_again(self, which: int) -> None:
        if (picked := self.pick(which)) is None:
            return
        with pytest.raises(OrderRefused) as refused, self.database.writing() as connection:
            orders.store(connection, OrderContent(work_master="engine"), MES, self.now, id=picked[0], start=True)
        assert refused.value.slug == "job-order-exists"

    @rule(which=st.integers(0, 9), number=st.integers(0, 7), sensible=st.booleans())
    def command(self, which: int, number: int, sensible: bool) -> None:
        if (picked := self.pick(which)) is None:
            return
        id, expected = picked
        self.now += 1
        able = sorted(expected.allowed() if sensible else OrderCommand) or list(OrderCommand)
        given = OrderCommand(able[number % len(able)])
        try:
            with self.database.writing() as connection:
                orders.command(connection, id, given, MES, "as planned", self.now)
        except OrderRefused as refused:
            if expected.state == GONE:
                assert refused.slug == "no-job-order"
            else:
                assert (refused.slug, refused.status) == ("command-not-allowed", 409)
                assert set(refused.allowed) == expected.allowed()
                assert given not in expected.allowed()
            return
        assert given in expected.allowed()
        self.recorded += 1
        expected.revision += 1
        if expected.at_station:
            expected.wish = AT_STATION[(expected.wish or expected.state, given.value)]
            return
        expected.state = TABLE[(expected.state, given.value)]
        told = {"Start": "allowed", "RevokeStart": "revoked", "Abort": "aborted", "Cancel": "cancelled"}
        expected.told.append(f"job-order-{told.get(given.value, 'cleared')}")

    @rule(which=st.integers(0, 9), behind=st.integers(0, 1))
    def change(self, which: int, behind: int) -> None:
        if (picked := self.pick(which)) is None:
            return
        id, expected = picked
        content = OrderContent(work_master="engine", priority=which)
        try:
            with self.database.writing() as connection:
                orders.change(connection, id, expected.revision - behind, content, MES, self.now)
        except OrderRefused as refused:
            slug = "job-order-changed" if behind else "job-order-started"
            assert refused.slug == ("no-job-order" if expected.state == GONE else slug)
            assert behind or expected.at_station or expected.state not in (WAITING, READY)
            return
        assert not behind
        assert not expected.at_station
        assert expected.state in (WAITING, READY)
        expected.revision += 1
        expected.told.append("job-order-updated")
        self.recorded += 1

    @rule(which=st.integers(0, 9))
    def hand_over(self, which: int) -> None:
        if (picked := self.pick(which)) is None:
            return
        id, expected = picked
        with self.database.writing() as connection:
            handed = orders.hand_over(connection, orders_named(connection, id), self.now)
        assert (handed is not None) is (expected.state == READY)
        if handed is not None and not expected.at_station:
            expected.at_station = True
            expected.revision += 1

    @rule(which=st.integers(0, 9))
    def station_refuses(self, which: int) -> None:
        if (picked := self.pick(which)) is None:
            return
        id, expected = picked
        with self.database.writing() as connection:
            back = orders.take_back(connection, orders_named(connection, id), self.now)
        assert (back is not None) is (expected.at_station and expected.state == READY)
        if back is not None:
            expected.at_station = False
            expected.revision += 1
            if expected.wish is not None:
                expected.state, expected.wish = ABORTED, None
                expected.told.append("job-order-aborted")

    @rule(which=st.integers(0, 9))
    def station_takes(self, which: int) -> None:
        if (picked := self.pick(which)) is None or not picked[1].at_station:
            return
        id, expected = picked
        with self.database.writing() as connection:
            update_order(connection, News("taken", made(id), self.now), None)
        if expected.state == READY:
            expected.state = RUNNING
            expected.revision += 1
            expected.told.append("job-order-running")

    @rule(which=st.integers(0, 9))
    def station_pauses_or_resumes(self, which: int) -> None:
        if (picked := self.pick(which)) is None or picked[1].wish not in ("pause", "resume"):
            return
        id, expected = picked
        with self.database.writing() as connection:
            assert orders.granted(connection, orders_named(connection, id), self.now) is not None
        pausing = expected.wish == "pause"
        expected.state, expected.wish = INTERRUPTED if pausing else RUNNING, None
        expected.revision += 1
        expected.told.append("job-order-interrupted" if pausing else "job-order-running")

    @rule(which=st.integers(0, 9))
    def station_refuses_what_is_wished_for(self, which: int) -> None:
        if (picked := self.pick(which)) is None or picked[1].wish is None:
            return
        id, expected = picked
        with self.database.writing() as connection:
            orders.refused(connection, orders_named(connection, id), self.now)
        expected.wish = None
        expected.revision += 1

    @rule(which=st.integers(0, 9), how=st.sampled_from((JobState.ENDED, JobState.STOPPED, JobState.ABORTED)))
    def job_ends(self, which: int, how: JobState) -> None:
        if (picked := self.pick(which)) is None or not picked[1].at_station:
            return
        id, expected = picked
        job = made(id, how)
        with self.database.writing() as connection:
            for _ in range(2):  # told twice, it has happened once
                update_order(
                    connection,
                    News("over", job, self.now),
                    response(job, WorkMastersView(work_masters={}, abilities={})),
                )
        expected.state = ABORTED if how is JobState.ABORTED else ENDED
        expected.at_station, expected.wish = False, None
        expected.revision += 1
        expected.told.append(f"job-order-{expected.state.lower()}")

    @invariant()
    def every_order_is_as_it_should_be_and_everything_is_told_once(self) -> None:
        with self.database.reading() as connection:
            found = {each["id"]: JobOrder.from_row(each) for each in connection.execute(select(JOB_ORDERS)).mappings()}
            told = events.after(connection, 0, 10_000)
            end = audit.end(connection)
        assert end is not None
        assert end.number - self.before == self.recorded
        assert [each.number for each in told] == list(range(1, len(told) + 1))
        assert found.keys() == self.expected.keys()
        for id, expected in self.expected.items():
            order = found[id]
            assert [str(each.kind) for each in told if each.job_order == id] == expected.told
            assert (order.revision, order.wish) == (expected.revision, expected.wish)
            assert (order.removed is not None) is (expected.state == GONE)
            if expected.state != GONE:
                assert (order.state.value, set(order.allowed)) == (expected.state, expected.allowed())

    def teardown(self) -> None:
        """What lists show in the end."""
        shown = [id for id, each in self.expected.items() if each.state != GONE]
        over = {id for id in shown if self.expected[id].state in (ENDED, ABORTED)}
        with self.database.reading() as connection:
            assert [each.id for each in orders.page(connection, None, 0, 1000)] == shown
            for state in OrderState:
                of_state = [id for id in shown if self.expected[id].state == state.value]
                assert [each.id for each in orders.page(connection, state, 0, 1000)] == of_state
            assert {each.job_order for each in responses.page(connection, 0, 1000)} == over
            assert [each.id for each in orders.open_orders(connection)] == [id for id in shown if id not in over]
            assert orders.count_open(connection) == len(shown) - len(over)


def made(id: str, state: JobState = JobState.RUNNING) -> JobMade:
    """The job of an order."""
    return JobMade(job=id, work_master="engine", state=state, taken=5.0, ended=6.0 if state.is_over else None)


def orders_named(connection: Connection, id: str) -> JobOrder:
    """The order as somebody read it before."""
    found = orders.find(connection, id)
    assert found is not None
    return found


@pytest.mark.parametrize("state", OrderState)
@pytest.mark.parametrize("wish", [None, *Wish])
def test_each_state_allows_what_the_table_says(state: OrderState, wish: Wish | None) -> None:
    over = state.value in (ENDED, ABORTED)
    if wish is None and state.value not in (RUNNING, INTERRUPTED):
        assert set(allowed(state, handed_over=over, wish=None)) == Expected(state.value).allowed()
    if state.value in (READY, RUNNING, INTERRUPTED):
        expected = Expected(state.value, at_station=True, wish=wish)
        assert set(allowed(state, handed_over=True, wish=wish)) == expected.allowed()


def test_the_life_of_an_order_is_that_of_the_table(database: Database) -> None:
    class Here(Orders):
        def __init__(self) -> None:
            super().__init__(database)

    run_state_machine_as_test(Here, settings=examples(10))
