"""Local specifications on a running station: what has happened since an operation's activation counts."""

from __future__ import annotations

import shutil
from dataclasses import dataclass, field
from pathlib import Path

from hypothesis import given

from controller.alarming.scene import alarms
from controller.test_ticks import EVERYTHING_IS_SAFE, NOW
from core.choices import Choices, made_by
from core.random_problems import Problem, problem
from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.tick import (
    apply_effects,
    finish,
    record_activity,
    start,
    synchronise,
    update_operations,
)
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.language.ltl import satisfies
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import PlanAnswer
from support.automata import Does, automaton
from support.examples import examples
from support.places import CELL
from support.simulated import Rig

PLACES = EnumerationType(("home", "scanner", "out"))

# A carrier that has to pass the scanner on its way out, and could take a short cut.
CARRIER = automaton(
    {
        "to_scanner": Does(start=("target := scanner",), enabled="at == home and target == home"),
        "out": Does(start=("target := out",), enabled="at == target and at != out"),
        "back": Does(start=("target := home",), enabled="at == target and at != home"),
    },
    measured={"at": (PLACES, "home")},
    output={"target": (PLACES, "home")},
    effects={
        "arrives_at_scanner": ("target == scanner and at != scanner", ("at := scanner",)),
        "arrives_out": ("target == out and at != out", ("at := out",)),
        "arrives_home": ("target == home and at != home", ("at := home",)),
    },
    goals={"deliver": "at == out"},
    local={"deliver": "F at == scanner"},
)


def beginning(station: Automaton, **measured: Value) -> tuple[Executor, Planner]:
    """A station whose production has just started, after its first tick, and its planner."""
    execution = Executor(station, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick(measured, NOW)
    return execution, Planner(station, EVERYTHING_IS_SAFE)


def answered(execution: Executor, planner: Planner) -> PlanAnswer:
    """The answer to what is asked now, which has been adopted."""
    request = execution.request(20)
    assert request is not None
    answer = planner.answer(request)
    assert execution.adopt(request, answer)
    return answer


def test_a_plan_keeps_to_the_local_specification() -> None:
    execution, planner = beginning(CARRIER, at="home")
    answered(execution, planner)
    assert execution.plan.order.names == ("to_scanner", "out")


def test_what_has_been_done_since_the_activation_need_not_be_done_again() -> None:
    execution, planner = beginning(CARRIER, at="home")
    answered(execution, planner)
    execution.tick({"at": "home"}, NOW)
    execution.tick({"at": "scanner"}, NOW)
    execution.plan.order.drop()  # a plan is wanted that begins here
    execution.state = synchronise(CARRIER, {**execution.state, "at": "home", "target": "home"})
    execution.tick({"at": "home"}, NOW)
    assert answered(execution, planner).plan is not None
    assert execution.plan.order.names == ("out",)


# The lid must not be closed before the part is in.
BOX = automaton(
    {
        "fill": Does(start=("filling := true",), enabled="not filling"),
        "shut": Does(start=("shutting := true",), enabled="not shutting"),
    },
    measured={"full": (BOOLEAN, False), "closed": (BOOLEAN, False)},
    output={"filling": (BOOLEAN, False), "shutting": (BOOLEAN, False)},
    effects={
        "fills": ("filling and not full", ("full := true",)),
        "closes": ("shutting and not closed", ("closed := true",)),
    },
    goals={"pack": "full and closed"},
    local={"pack": "not closed U full and not closed"},
)


def test_a_violated_specification_is_told_and_no_plan_is_asked_for() -> None:
    execution, planner = beginning(BOX, full=False, closed=False)
    answered(execution, planner)
    execution.tick({"full": False, "closed": True}, NOW)
    assert dict(execution.pursued.violated) == {"pack": NOW}
    assert execution.active == {"pack"}
    assert execution.plan.status is PlanStatus.NONE
    assert execution.plan.reason == "no plan: `not closed U full and not closed` of pack was violated"
    assert execution.plan.order.names == ()
    assert execution.request(20) is None


def test_a_violation_is_remembered_until_the_operation_is_activated_again() -> None:
    execution, _ = beginning(BOX, full=False, closed=False)
    execution.tick({"full": False, "closed": True}, NOW)
    assert execution.tick({"full": True, "closed": True}, NOW).completed == {"pack"}
    assert execution.pursued.violated
    execution.tick({"full": False, "closed": False}, NOW)
    assert not execution.pursued.violated
    assert execution.request(20) is not None


def test_a_violation_raises_an_alarm_that_says_which(tmp_path: Path) -> None:
    cell = Path(shutil.copytree(CELL, tmp_path / "cell"))
    with (cell / "operations.yaml").open("a", encoding="utf-8") as operations:
        operations.write("  local: G arm.goto != out\n")
    rig = Rig(folder=cell)
    rig.start_production()
    rig.run(1)
    shown = alarms(rig)
    now = Timestamp(rig.now, rig.now)
    assert not [key for key in shown.current(now) if key.startswith("local:")]
    rig.execution.state = {**rig.execution.state, "arm.goto": "out"}
    rig.tick()
    texts = [alarm.text for key, alarm in shown.current(now).items() if key.startswith("local:")]
    assert set(texts) == {"The local specification `G (arm.goto != out)` of “fetch” was violated"}


def test_what_happens_before_production_is_started_is_not_held_against_anybody() -> None:
    execution = Executor(BOX, EVERYTHING_IS_SAFE)
    execution.tick({"full": None, "closed": None}, NOW)
    execution.tick({"full": False, "closed": True}, NOW)
    execution.tick({"full": False, "closed": False}, NOW)
    execution.start_production()
    execution.tick({"full": False, "closed": False}, NOW)
    assert not execution.pursued.violated
    assert execution.pursued.hopeful == {"pack"}


@dataclass
class Witness:
    """Writes down the positions of each active operation's formula, on the reference tick."""

    station: Automaton
    positions: dict[str, list[State]] = field(default_factory=dict)

    def sees(self, before: State, measured: State, active: frozenset[str], outcome: TickOutcome) -> dict[str, bool]:
        """A tick from `before`; whether those operations that it completes have kept to their formulas."""
        station = self.station
        state = synchronise(station, finish(station, {**before, **measured}).state)
        kept: dict[str, bool] = {}
        for name, trace in list(self.positions.items()):
            trace.append(state)
            if name in outcome.completed:
                kept[name] = satisfies(station.operations[name].local or TRUE, trace) is True
                del self.positions[name]
        after = update_operations(station, state, active)
        assert (after - active, active - after) == (outcome.activated, outcome.completed)
        state = record_activity(station, state, after)
        self.positions |= {name: [state] for name in after - active}
        for ability in outcome.started:
            started = start(station, state, station.abilities[ability])
            assert started is not None
            state = started
            for trace in self.positions.values():
                trace.append(state)
        return kept


@dataclass(frozen=True)
class Life:
    """A problem, and for each tick which of the effects happen, as far as they can."""

    problem: Problem
    happening: tuple[tuple[int, ...], ...]


def life(choices: Choices) -> Life:
    """Any such life."""
    given_ = problem(choices, demanding=True)
    places = range(len(given_.automaton.effects))
    return Life(given_, tuple(tuple(choices.different(places, 0, 3)) for _ in range(choices.number(3, 12))))


@examples(100)
@given(made_by(life))
def test_what_is_violated_is_what_the_positions_do_not_satisfy(lived: Life) -> None:
    station, planner = lived.problem.automaton, Planner(lived.problem.automaton, lived.problem.supervisor)
    execution = Executor(station, lived.problem.supervisor)
    execution.state = lived.problem.state
    execution.start_production()
    silent = lived.problem.circumstances.offline
    witness = Witness(station)
    for happening in lived.happening:
        before, active = execution.state, execution.active
        measured = {name: before[name] for name in station.names(Kind.MEASURED)}
        for place in happening:
            after = apply_effects({**before, **measured}, [station.effects[place]])
            measured = measured if after is None else {name: after[name] for name in measured}
        outcome = execution.tick(measured, NOW, silent=silent)
        violated = execution.pursued.violated
        for name, kept in witness.sees(before, measured, active, outcome).items():
            assert kept == (name not in violated), "at its end"
        for name, trace in witness.positions.items():
            local = station.operations[name].local or TRUE
            if name in violated:
                assert not any(satisfies(local, [*trace, *more]) for more in ([], [execution.state], [before] * 2))
            else:
                assert name in execution.pursued.hopeful
        assert witness.positions.keys() == execution.pursued.goals.keys() == execution.active
        request = execution.request(2)
        if request is not None:
            execution.adopt(request, planner.answer(request))
