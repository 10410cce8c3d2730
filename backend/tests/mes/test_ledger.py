"""What is made for which job, read from records of the run as the controller writes them."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from journal.happened import with_writer
from sequence_planner.controller.views.details import (
    WorkAbilityView,
    WorkMastersView,
    WorkMasterView,
    WorkOperationView,
)
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.journal.writer import RunWriter
from sequence_planner.mes import events, orders, responses
from sequence_planner.mes.order import OrderCommand, OrderContent, OrderState
from sequence_planner.mes.tracker import MOST_DEVIATIONS, Ledger, OrderTracker, read
from support.examples import examples

JOBS = ("a", "b", "c")


def master(name: str) -> WorkMasterView:
    """One operation after the other, about variables of its own."""
    operations = {
        f"{name}.{number}": WorkOperationView(title="", after=[], goal_reads=[f"{name}.part"]) for number in (1, 2)
    }
    return WorkMasterView(
        title=name, brings=[], brought=[f"{name}.part"], operations=operations, alternatives=[], arbitrary=[]
    )


def able(*writes: str, instant: bool = False) -> WorkAbilityView:
    return WorkAbilityView(title="", writes=list(writes), instant=instant)


MASTERS = WorkMastersView(
    work_masters={name: master(name) for name in JOBS},
    abilities={
        "make_b": able("b.part"),
        "make_c": able("c.part", "lamp"),
        "move": able("pose"),
        "blink": able("lamp", instant=True),
    },
)


def job(name: str, state: str = "running", **more: Any) -> dict[str, Any]:  # noqa: ANN401 - JSON
    taken = moment(JOBS.index(name[0]))
    return {"id": name, "work_master": name[0], "title": name, "taken": taken, "state": state, **more}


def moment(epoch: float) -> dict[str, float]:
    return {"epoch": float(epoch), "monotonic": 0.0}


def at(**moments: float) -> dict[str, dict[str, float]]:
    """Operations by their last letter, as `a1=5`."""
    return {f"{name[0]}.{name[1]}": moment(epoch) for name, epoch in moments.items()}


class Run:
    """Records that follow one another."""

    def __init__(self) -> None:
        self.records: list[RunRecord] = []
        self.add("begun", values={"a.part": "none", "b.part": "none"}, senses={}, memory={}, jobs={})

    def add(self, kind: str, **content: Any) -> RunRecord:  # noqa: ANN401
        number = len(self.records) + 1
        self.records.append(RunRecord(number, 100.0 + number, kind, json.dumps(content), ""))
        return self.records[-1]

    def ledger(self) -> Ledger:
        ledger = Ledger()
        for record in self.records:
            ledger.process(read(record), MASTERS)
        return ledger

    def made(self, name: str) -> list[str]:
        return [each.ability for each in self.ledger().jobs[name].abilities]


def test_an_ability_starts_for_the_job_whose_goal_depends_on_it() -> None:
    run = Run()
    run.add("ticked", jobs={name: job(name, started=at(**{f"{name}1": 5})) for name in ("a", "b")})
    run.add("ticked", started=["make_b", "move", "make_c"])
    assert (run.made("a"), run.made("b")) == (["move", "make_c"], ["make_b"])


def test_what_starts_while_no_operation_of_a_job_is_active_is_the_stations_own() -> None:
    run = Run()
    run.add("ticked", started=["move"])
    run.add("job-taken", jobs={"b": job("b", "waiting")})
    run.add("ticked", started=["move"])
    run.add("ticked", jobs={"b": job("b", started=at(b1=5))}, started=["make_b"])
    run.add("job-commanded", jobs={"b": job("b", "paused", started=at(b1=5))})
    run.add("ticked", started=["move"])
    run.add("ticked", jobs={"b": job("b", started=at(b1=5), completed=at(b1=6))}, started=["move"])
    assert run.made("b") == ["make_b"]


def test_runs_have_an_end_and_instant_ones_have_it_at_once() -> None:
    run = Run()
    begun = {"b": job("b", started=at(b1=5))}
    first = run.add("ticked", jobs=begun, started=["make_b", "blink"])
    over = run.add("ticked", ended=["make_b"], started=["move"])
    called_off = run.add("ticked", called_off=["move"], started=["make_b"])
    run.add("alarm", ended=None, started=None, text="note that names are its own")
    made = run.ledger().jobs["b"].abilities
    assert [(each.ability, each.record, each.ended, each.called_off) for each in made] == [
        ("make_b", first.number, over.time, False),
        ("blink", first.number, first.time, False),
        ("move", over.number, called_off.time, True),
        ("make_b", called_off.number, None, False),
    ]


def test_values_deviations_and_corrections_are_told() -> None:
    run = Run()
    run.add("corrected", what={"values": {"b.part": "lost"}, "by": "Eva", "why": "before"}, changes={"b.part": "lost"})
    run.add("ticked", jobs={"b": job("b", started=at(b1=5))})
    run.add("corrected", what={"values": {"b.part": "none"}, "by": "Eva", "why": "seen"}, changes={"b.part": "none"})
    run.add("alarm", text="too slow")
    run.add("answered", plan={"status": "followed", "reason": "it was late", "replaced": True})
    run.add("ticked", changes={"b.part": "placed"}, jobs={"b": job("b", started=at(b1=5), completed=at(b1=7))})
    found = run.ledger().jobs["b"]
    assert [(each.by, each.why, each.values) for each in found.corrections] == [("Eva", "seen", {"b.part": "none"})]
    assert [each.kind for each in found.deviations] == ["alarm", "replanned"]
    assert found.operations["b.1"].actuals == {"b.part": "placed"}
    assert (found.operations["b.1"].started, found.operations["b.1"].ended) == (5.0, 7.0)


def test_of_an_alarm_that_comes_and_goes_for_days_the_first_are_told() -> None:
    run = Run()
    run.add("ticked", jobs={"b": job("b", started=at(b1=5))})
    for _ in range(MOST_DEVIATIONS + 7):
        run.add("alarm", text="silent")
    found = run.ledger().jobs["b"]
    assert (len(found.deviations), found.deviations_left_out) == (MOST_DEVIATIONS, 7)


def test_a_job_that_a_station_does_not_remember_is_aborted_with_what_was_made() -> None:
    run = Run()
    run.add("ticked", jobs={"b": job("b", started=at(b1=5))}, started=["make_b"])
    ledger = run.ledger()
    before = ledger.copied()
    news = ledger.process(read(run.add("begun", values={}, senses={}, memory={}, jobs={})), MASTERS)
    assert [(each.what, each.job.state, each.job.ended) for each in news] == [("over", "aborted", 103.0)]
    assert [each.ability for each in news[0].job.abilities] == ["make_b"]
    assert not ledger.jobs
    assert before.jobs["b"].active == ["b.1"]


def test_an_operation_that_was_reset_is_made_anew() -> None:
    run = Run()
    run.add("ticked", jobs={"b": job("b", started=at(b1=5), completed=at(b1=6))})
    run.add("ticked", jobs={"b": job("b")})
    run.add("ticked", jobs={"b": job("b", started=at(b1=9))})
    assert run.ledger().jobs["b"].operations["b.1"].started == 9.0


STEPS = st.lists(
    st.tuples(st.sampled_from(JOBS), st.sampled_from(("begin", "done", "end", "abort", "pause", "start", "restart"))),
    max_size=25,
)


def random_run(steps: list[tuple[str, str]]) -> Run:
    """Each job goes through its life, abilities start in between, and the controller begins anew now and then."""
    run, jobs, abilities = Run(), dict[str, dict[str, Any]](), list(MASTERS.abilities)
    for number, (name, what) in enumerate(steps):
        known = jobs.get(name)
        if what == "start":
            run.add("ticked", started=[abilities[number % len(abilities)]])
            continue
        if what == "restart":
            run.add("begun", values={}, senses={}, memory={}, jobs=jobs)
            continue
        if known is None:
            jobs[name] = job(name, "waiting")
        elif known["state"] in ("ended", "aborted"):
            continue
        elif what == "begin":
            jobs[name] = {**known, "state": "running", "started": at(**{f"{name}1": number})}
        elif what == "done" and "started" in known:
            jobs[name] = {**known, "state": "running", "completed": at(**{f"{name}1": number})}
        elif what in ("end", "abort"):
            jobs[name] = {**known, "state": f"{what}ed", "ended": moment(number)}
        elif what == "pause":
            jobs[name] = {**known, "state": "paused"}
        run.add("ticked", jobs={name: jobs[name]}, started=["move"])
    return run


@given(steps=STEPS)
@examples(60)
def test_every_start_belongs_to_one_job_at_most(steps: list[tuple[str, str]]) -> None:
    run = random_run(steps)
    claimed = [(each.record, each.ability) for made in run.ledger().jobs.values() for each in made.abilities]
    journal = [
        (record.number, name) for record in run.records for name in json.loads(record.content).get("started", ())
    ]
    assert len(set(claimed)) == len(claimed)
    assert set(claimed) <= set(journal)


def test_orders_go_on_as_the_journal_says_wherever_the_server_is_killed(database: Database) -> None:
    OrderTracker(database).read_on(MASTERS)
    run = random_run([(name, what) for what in ("begin", "begin", "start", "done", "restart", "end") for name in JOBS])
    with database.writing() as connection:
        for name in JOBS:
            content = OrderContent(work_master=name, description=f"Part {name}")
            order = orders.store(connection, content, SYSTEM, 1.0, id=name, start=True)
            assert orders.hand_over(connection, order, 1.0) is not None
    for record in run.records:  # one by one, and by a server that has just been started

        async def write(writer: RunWriter, record: RunRecord = record) -> None:
            writer.write(record.kind, record.time, record.content)

        with_writer(database, write)
        OrderTracker(database).read_on(MASTERS)
        OrderTracker(database).read_on(MASTERS)
    with database.reading() as connection:
        told = events.after(connection, 0, 1000)
        found = {each.job_order: each for each in responses.page(connection, 0, 10)}
        assert {orders.get(connection, name).state for name in JOBS} == {OrderState.ENDED}
    for name in JOBS:
        kinds = [str(each.kind) for each in told if each.job_order == name]
        working = ["job-order-running", "operation-started", "operation-completed", "job-order-ended"]
        assert kinds == ["job-order-stored", *working]
        assert (found[name].description, found[name].began) == (f"Part {name}", float(JOBS.index(name)))
    made = run.ledger().jobs
    assert {name: each.abilities for name, each in found.items()} == {name: made[name].abilities for name in JOBS}


def test_what_another_server_has_read_is_news_here_too(database: Database) -> None:
    OrderTracker(database).read_on(MASTERS)
    with database.writing() as connection:
        order = orders.store(connection, OrderContent(work_master="a"), SYSTEM, 1.0, id="a", start=True)
        orders.hand_over(connection, order, 1.0)
    one, other = OrderTracker(database), OrderTracker(database)
    assert one.read_on(MASTERS) == other.read_on(MASTERS) == (False, False)

    async def write(writer: RunWriter) -> None:
        writer.write("ticked", 1.0, json.dumps({"jobs": {"a": job("a", "ended", ended=moment(6))}}))

    with_writer(database, write)
    assert one.read_on(MASTERS) == (True, False)
    assert other.read_on(MASTERS) == (True, True)


def test_an_order_that_is_over_stays_so_and_is_commanded_no_more(database: Database) -> None:
    OrderTracker(database).read_on(MASTERS)
    with database.writing() as connection:
        order = orders.store(connection, OrderContent(work_master="a", due=9.0), SYSTEM, 1.0, id="a", start=True)
        orders.hand_over(connection, order, 1.0)
        assert orders.command(connection, "a", OrderCommand.ABORT, SYSTEM, "no parts", 2.0).wish == "abort"

    async def write(writer: RunWriter) -> None:
        writer.write("begun", 1.0, json.dumps({"values": {}, "senses": {}, "memory": {}, "jobs": {}}))
        for each in (job("a", "waiting"), job("a", "aborted", ended=moment(5)), job("a", "ended", ended=moment(6))):
            writer.write("ticked", 1.0, json.dumps({"jobs": {"a": each}}))

    with_writer(database, write)
    assert OrderTracker(database).read_on(MASTERS) == (True, False)
    with database.reading() as connection:
        over = orders.get(connection, "a")
        (made,) = responses.page(connection, 0, 10)
    assert (made.reason, made.due) == ("no parts", 9.0)
    assert (over.state, over.wish, over.allowed) == (OrderState.ABORTED, None, (OrderCommand.CLEAR,))


def test_an_order_says_why_it_is_paused_until_it_is_resumed(database: Database) -> None:
    with database.writing() as connection:
        order = orders.store(connection, OrderContent(work_master="a"), SYSTEM, 1.0, id="a", start=True)
        handed = orders.hand_over(connection, order, 1.0)
        assert handed is not None
        orders.become(connection, handed, OrderState.RUNNING, 1.0, {})
        wished = orders.command(connection, "a", OrderCommand.PAUSE, SYSTEM, "lunch", 2.0)
        paused = orders.granted(connection, wished, 3.0)
        assert paused is not None
        assert (paused.state, paused.wish, paused.wished_because) == (OrderState.INTERRUPTED, None, "lunch")
        resumed = orders.granted(
            connection, orders.command(connection, "a", OrderCommand.RESUME, SYSTEM, None, 4.0), 5.0
        )
        assert resumed is not None
        assert (resumed.state, resumed.wished_because) == (OrderState.RUNNING, None)
