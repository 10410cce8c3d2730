"""Why estimates are believed: who wrote them, when, from what; and that it outlives the controller."""

from __future__ import annotations

import json

from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.features.variables import Beliefs, beliefs_from
from sequence_planner.controller.views.station import BeliefView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import InitialState
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.language.types import Value
from support.simulated import PAIRS, Rig, truck_engine

from .corrected import NOW, WHY, Station

BOLT = "bolts[bolt_pair_2]"


def rig_until(finished: str) -> tuple[Rig, Beliefs]:
    """A station at work, until an ability has ended."""
    rig = Rig()
    beliefs = Beliefs(rig.execution)
    rig.start_production()
    assert rig.run(120, lambda: any(name.startswith(finished) for tick in rig.ticks for name in tick.ended))
    return rig, beliefs


def test_what_is_so_in_the_beginning_is_the_model_s_word() -> None:
    belief = Station().beliefs.of(BOLT)
    assert belief == BeliefView(writer="the model", at=0.0, evidence=[], unconfirmed_since=None)


def test_an_ability_that_finishes_writes_with_what_its_guard_has_read() -> None:
    rig, beliefs = rig_until("operator.place_bolt_pair")
    [(name, belief)] = [
        (name, belief)
        for name in rig.station.automaton.names(Kind.ESTIMATED)
        if (belief := beliefs.of(name)).writer != "the model"
    ]
    assert rig.value(name) == "placed"
    assert belief.writer == f"operator.place_bolt_pair({name[len('bolts[') : -1]})"
    assert belief.at == rig.now
    assert belief.evidence == ["operator.acknowledged"]
    assert belief.unconfirmed_since is None


def test_a_condition_of_an_action_is_evidence_and_what_it_leaves_is_not_written() -> None:
    rig, beliefs = rig_until("nutrunner.run_nut")
    tight = [pair for pair in PAIRS if rig.value(f"bolts[{pair}]") == "tightened"]
    for pair in PAIRS:
        belief = beliefs.of(f"bolts[{pair}]")
        assert (belief.writer == "nutrunner.run_nut") is (pair in tight)
        if pair in tight:
            assert belief.evidence == ["nutrunner.programmed_torque_reached", f"robot.pose == {pair}"]


def test_a_guard_that_goes_on_to_hold_says_nothing_new() -> None:
    rig, beliefs = rig_until("operator.place_bolt_pair")
    name = next(n for n in rig.station.automaton.names(Kind.ESTIMATED) if beliefs.of(n).writer != "the model")
    written = beliefs.of(name)
    for _ in range(3):
        rig.execution.tick(rig.measured() | rig.desk.measured(), Timestamp(rig.now + 1, rig.now + 1))
    assert beliefs.of(name) == written


def test_what_is_forced_is_no_evidence() -> None:
    station = Station()
    running: dict[str, Value] = {BOLT: "placed", "nutrunner.run_tool_forward": True, "nutrunner.set_tool_idle": False}
    station.execution.state = station.execution.corrected(running)
    station.tick(robot__pose="bolt_pair_2")
    until = Timestamp(station.now.epoch + 60, station.now.monotonic + 60)
    station.execution.force("nutrunner.programmed_torque_reached", True, until, "Eva", WHY)
    station.tick()
    assert station.execution.state[BOLT] == "tightened"
    belief = station.beliefs.of(BOLT)
    assert belief.writer == "nutrunner.run_nut"
    assert belief.evidence == ["robot.pose == bolt_pair_2"]
    assert belief.unconfirmed_since == belief.at == station.now.epoch
    assert station.beliefs.unconfirmed


def test_persons_correct_and_confirm() -> None:
    station = Station()
    station.execution.correct({BOLT: "placed"}, "Eva", WHY, station.now)
    written = BeliefView(writer="Eva", at=station.now.epoch, evidence=[], unconfirmed_since=None)
    assert station.beliefs.of(BOLT) == written
    station.execution.confirm(frozenset({BOLT}), "Adam", Timestamp(2000.0, 1010.0))
    assert station.beliefs.of(BOLT) == written.model_copy(update={"writer": "Adam", "at": 2000.0})


def restarted(before: dict[str, BeliefView], told: list[object]) -> tuple[Executor, Beliefs]:
    station, supervisor, _ = truck_engine()
    beginning = InitialState({BOLT: "placed", "bolts[bolt_pair_1]": "empty"}, 900.0, (), frozenset(), NOW)
    execution = Executor(station.automaton, supervisor, beginning)
    return execution, Beliefs(execution, beginning, before, told.append)


def test_beliefs_come_back_and_nobody_has_seen_them_since() -> None:
    told: list[object] = []
    written = BeliefView(writer="Eva", at=800.0, evidence=["operator.acknowledged"], unconfirmed_since=None)
    execution, beliefs = restarted({BOLT: written}, told)
    assert beliefs.of(BOLT) == written.model_copy(update={"unconfirmed_since": 900.0})
    assert beliefs.of("bolts[bolt_pair_1]").writer == "the journal"
    assert beliefs.of("bolts[bolt_pair_3]").writer == "the model"
    assert beliefs.unconfirmed
    assert not told
    execution.confirm(frozenset(execution.automaton.names(Kind.ESTIMATED)), "Eva", NOW)
    assert not beliefs.unconfirmed
    # What is told is all that another life needs to know.
    [content] = told
    came_back = beliefs_from(json.loads(json.dumps(content)))
    assert came_back == {name: beliefs.of(name) for name in execution.automaton.names(Kind.ESTIMATED)}


def test_doubt_is_as_old_as_it_is() -> None:
    doubted = BeliefView(writer="Eva", at=700.0, evidence=[], unconfirmed_since=750.0)
    _, beliefs = restarted({BOLT: doubted}, [])
    assert beliefs.of(BOLT).unconfirmed_since == 750.0


def test_a_change_of_mode_writes_nothing() -> None:
    station = Station()
    station.execution.change_mode(Mode.HOLD, "Eva", station.now)
    assert station.beliefs.of(BOLT).writer == "the model"
