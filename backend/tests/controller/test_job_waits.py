"""What an order waits for that is being worked: whatever keeps it from going on is said."""

from __future__ import annotations

from dataclasses import replace

import pytest

from controller.alarming.causes import cause
from controller.bench_of_jobs import Bench
from controller.carrying_out import carry_out
from sequence_planner.controller.alarms.alarm import Alarm
from sequence_planner.controller.commands.jobs import SetByOrder, TakeJob
from sequence_planner.controller.commands.tasks import ReportProblem
from sequence_planner.controller.features.jobs import JobHandler
from sequence_planner.controller.views.jobs import Around, job_views
from sequence_planner.controller.views.station import AlarmView, Priority
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.simulation.devices import EmulatedDevices
from support.people import EVA
from support.simulated import Rig, never


def alarm(text: str, priority: Priority, ended: float | None = None, kind: str = "a") -> AlarmView:
    life = Alarm(cause(kind, priority=priority, text=text), 1.0)
    return life.view().model_copy(update={"ended": ended})


def waits(on: Bench, around: Around | None = None, job: str = "a") -> list[str]:
    around = around or Around(on.now.monotonic)
    return job_views(on.execution, None, around)[job].waits_for


@pytest.fixture
def on() -> Bench:
    bench = Bench()
    bench.by_order()
    bench.execution.start_production()
    bench.take("a", "bottle")
    bench.ticks(2)
    return bench


def test_while_no_plan_is_known_one_is_waited_for(on: Bench) -> None:
    assert waits(on) == ["a plan, which is being looked for"]
    on.plan()
    assert waits(on) == [], "it starts in the next tick"
    on.ticks(2)
    assert on.execution.running() == {"fill"}
    assert waits(on) == [], "it moves"


def test_where_there_is_no_plan_it_is_said_why(on: Bench) -> None:
    on.measured["flows"] = True
    on.correct({"content": "empty"})
    on.ticks()
    on.execution.unanswered("it cannot be reached", again=False)
    assert any("a plan" in each for each in waits(on))


def test_a_station_that_stands_is_said_with_who_is_to_let_it_go_on(on: Bench) -> None:
    on.plan()
    on.execution.change_mode(Mode.PAUSED, "Eva", on.now)
    on.tick()
    alone = Around(on.now.monotonic, controlled=False)
    assert waits(on, alone)[:2] == ["automatic mode: the station is paused", "somebody to take control"]
    assert "somebody to take control" not in waits(on)


def test_what_comes_before_is_said() -> None:
    on = Bench()
    on.by_order()
    on.execution.start_production()
    on.take("a", "bottle")
    on.take("b", "box")
    on.sequence(("b/pack_it", "a/check_it"))
    on.ticks()
    assert waits(on, job="b") == ["“check_it” of job a"]


def test_a_precondition_that_does_not_hold_is_said() -> None:
    on = Bench()
    on.by_order()
    on.execution.start_production()
    on.take("a", "crate")
    on.ticks(3, packed=True)
    assert waits(on) == ["“label_it”, which waits until content == full"]


def test_alarms_are_said_where_nothing_moves(on: Bench) -> None:
    alarms = {
        "silent:x": alarm("X is silent", Priority.MEDIUM),
        "command": alarm("Commands are not sent", Priority.HIGH),
        "old": alarm("Is over", Priority.HIGH, ended=2.0),
        "forced:y": alarm("Y is forced", Priority.LOW),
        "no-plan": alarm("No plan", Priority.MEDIUM, kind="no-plan"),
    }
    around = Around(on.now.monotonic, alarms=alarms)
    said = ["an alarm to be dealt with: Commands are not sent", "an alarm to be dealt with: X is silent"]
    assert waits(on, around)[1:] == said
    on.plan()
    on.ticks(2)
    assert waits(on, replace(around, monotonic=on.now.monotonic)) == []


def test_the_past_is_told_from_the_execution_alone(on: Bench) -> None:
    on.execution.change_mode(Mode.PAUSED, "Eva", on.now)
    assert on.jobs["a"].waits_for == ["automatic mode: the station is paused"]


class Ordered:
    """The bolt tightening station works an order, with an operator who may be away and devices that may stand still."""

    def __init__(self) -> None:
        self.rig = Rig()
        self.rig.start_production()
        desk, now = JobHandler(self.rig.execution), self.now
        carry_out(desk, SetByOrder(actor=SYSTEM, on=True, reason="shift"), now)
        carry_out(desk, TakeJob(actor=SYSTEM, job="4711", title="Engine", work_master="truck_engine"), now)

    @property
    def now(self) -> Timestamp:
        return Timestamp(self.rig.now, self.rig.now)

    def waits(self) -> list[str]:
        around = Around(self.rig.now, tasks=self.rig.desk.open, problems=self.rig.desk.problems)
        return job_views(self.rig.execution, None, around)["4711"].waits_for

    def run(self, seconds: float = 200.0) -> bool:
        return self.rig.run(seconds, until=lambda: "nutrunner.run_nut" in self.rig.execution.running())


def test_a_stuck_order_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """As it was met: an ability overdue for half an hour, and an order that waited for nothing."""
    station = Ordered()
    assert station.run()
    late = "“Run the nutrunner”, which has not finished within 30 s"
    assert late not in station.waits()
    monkeypatch.setattr(EmulatedDevices, "advance", lambda self, now: None)
    station.rig.run(40)
    assert late in station.waits(), station.waits()
    station.rig.execution.change_mode(Mode.PAUSED, "Eva", station.now)
    station.rig.run(1)
    assert station.waits()[0] == "automatic mode: the station is paused"
    assert late in station.waits()


def test_a_tight_pair_that_was_corrected_to_placed_is_what_the_order_waits_for() -> None:
    """It was tightened for this order and is not again; what comes after cannot begin, and that was said nowhere."""
    station = Ordered()
    pairs, state = ("bolts[bolt_pair_1]", "bolts[bolt_pair_2]", "bolts[bolt_pair_3]"), station.rig.execution
    assert station.rig.run(200, until=lambda: "tightened" in {state.state[pair] for pair in pairs})
    (tight,) = [pair for pair in pairs if state.state[pair] == "tightened"]
    state.correct({tight: "placed"}, "Eva", "a mistake", station.now)
    station.rig.run(200)
    assert station.waits() == [f"“New engine”, which waits until {tight} == tightened"]


def test_people_are_waited_for_and_what_keeps_them() -> None:
    station = Ordered()
    station.rig.acknowledges = never
    assert station.rig.run(60, until=lambda: bool(station.rig.desk.open))
    (id_,) = station.rig.desk.open
    station.rig.run(30)
    (waiting,) = station.waits()
    assert waiting.endswith("to be done by Operator"), waiting
    problem = ReportProblem(actor=EVA, task=id_, revision=1, reason="no bolts")
    station.rig.desk.report(problem, Timestamp(station.rig.now, station.rig.now))
    assert station.waits() == [f"{waiting}, who cannot: no bolts"]


def test_no_job_under_way_stands_silently() -> None:
    """With the devices and the operator as they are: either something moves, or it is said what is waited for."""
    station, silent = Ordered(), 0.0
    while station.rig.now < 1200.0:
        station.rig.run(0.5)
        jobs = job_views(station.rig.execution, None)["4711"]
        moves = {
            name
            for name in station.rig.execution.running()
            if station.rig.station.automaton.abilities[name].human is None
        }
        silent = silent + 0.5 if not (jobs.state.is_over or moves or station.waits()) else 0.0
        assert silent < 2.0, station.rig.now
        if jobs.state.is_over:
            return
    raise AssertionError("the order does not end")
