"""A way back that a person has taken starts at once, comes to its end whatever else happens, or says why it waits."""

from __future__ import annotations

import pytest

from controller.ways import Taken, after_a_fault, execution_in, operator_plan_of
from planning.advice.rules import station
from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.tick import initial_state, record_activity, synchronise, update_operations
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.recovery.operator_plans import OperatorPlans
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import OperatorPlan, OperatorPlanKind
from sequence_planner.language.syntax import TRUE
from sequence_planner.planning.problem import ORDINARY, Plan, PlanTick, goals_of
from sequence_planner.planning.recovery.proposals import OfferKind
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.station import prepare_station
from support.automata import predicate_of
from support.places import MODELS

NAME = "bolt_tightening"
TO_ABOVE, LEAVES = "robot.move_to_position(above_engine)", "robot.move_to_position(home).robot_leaves"
ACKNOWLEDGES = "operator.place_bolt_pair(bolt_pair_1).operator_acknowledges"


def stuck() -> tuple[State, frozenset[str]]:
    """The robot stands on placed bolts with a tool that does not turn, and a person is asked for the next pair."""
    automaton = station(NAME).automaton
    at_the_pair = dict.fromkeys(("robot.pose", "robot.previous_pose", "robot.target_pose"), "bolt_pair_1")
    attached = dict.fromkeys(("robot.attach_tool", "robot.tool_is_attached"), True)
    others = {"bolts[bolt_pair_1]": "placed", "operator.requested_pair": "bolt_pair_2"}
    state = synchronise(automaton, {**initial_state(automaton), **at_the_pair, **attached, **others})
    active = update_operations(automaton, state, frozenset())
    return record_activity(automaton, state, active), active


def standing() -> Taken:
    tried, (state, active) = station(NAME), stuck()
    execution = execution_in(tried.automaton, tried.supervisor, state, active, ORDINARY)
    taken = Taken(execution, tried.automaton, frozenset())
    taken.tick()
    return taken


def take(taken: Taken, errand: OperatorPlan) -> None:
    taken.execution.start_operator_plan(errand, Timestamp(taken.seconds, taken.seconds))


def alarms_of(execution: Executor) -> OperatorPlans:
    """The alarms of what it does."""
    ready = prepare_station(MODELS / NAME)
    return OperatorPlans(execution, Inputs(ready.pipelines, ready.registry).heard_on)


def test_the_way_to_make_the_bolts_tight_comes_first_and_nobody_is_asked_to_say_they_are() -> None:
    tried, (state, active) = station(NAME), stuck()
    request = AdviceRequest(state, goals_of(tried.automaton, sorted(active)), deadline=60)
    first, *others = tried.advisor.advise(request).offers
    assert (first.kind, first.only_if_checked) == (OfferKind.WAY_BACK, False)
    assert first.operator_plan is not None
    assert first.operator_plan.starts == ((1, "nutrunner.run_nut"),)
    assert [[(c.name, c.new) for c in offer.corrections] for offer in others] == [
        [("bolts[bolt_pair_1]", "empty")],
        [("bolts[bolt_pair_1]", "tightened")],
    ]
    assert [offer.claims for offer in others] == [(), ("tighten_bolt_pair(bolt_pair_1)",)]


@pytest.mark.parametrize("meanwhile", [(), (ACKNOWLEDGES,)])
def test_a_way_back_starts_although_a_person_has_an_open_task(meanwhile: tuple[str, ...]) -> None:
    """Its end once was a state that was over as soon as the task was acknowledged, so it never started."""
    tried, taken = station(NAME), standing()
    plan = Plan((PlanTick((), (TO_ABOVE,)), PlanTick((LEAVES,), ())), False, False)
    ends = "not operator.acknowledged and robot.pose == unknown and robot.target_pose == above_engine"
    goal = predicate_of(tried.automaton, ends)
    take(taken, OperatorPlan(OperatorPlanKind.WAY_BACK, "up", plan, goal, unsupervised=True))
    assert taken.tick() == (TO_ABOVE,)
    taken = standing()
    take(taken, OperatorPlan(OperatorPlanKind.WAY_BACK, "up", plan, unsupervised=True, into_safe=True))
    assert taken.tick() == (TO_ABOVE,)
    assert not taken.execution.safe
    taken.tick((*meanwhile, LEAVES))
    assert taken.execution.conduct.last_operator_plan is not None
    assert taken.execution.conduct.last_operator_plan.done
    assert taken.execution.safe


def test_what_is_offered_there_is_carried_out_to_its_end() -> None:
    tried, (state, active) = station(NAME), stuck()
    request = AdviceRequest(state, goals_of(tried.automaton, sorted(active)), deadline=60)
    offer = tried.advisor.advise(request).offers[0]
    assert offer.into_safe
    taken = standing()
    take(taken, operator_plan_of(tried.automaton, offer))
    assert taken.tick() == ("nutrunner.run_nut",)
    taken.tick((ACKNOWLEDGES, "nutrunner.run_nut.tool_starts"))
    assert taken.execution.operator_plan is None
    assert taken.execution.safe


@pytest.mark.parametrize("name", ["bolt_tightening", "docking_agv", "robots_with_buffer", "single_bolt"])
def test_what_is_proposed_after_a_fault_comes_to_its_end(name: str) -> None:
    """A sample of `campaigns/ways.py`."""
    for number in range(15):
        after_a_fault(name, f"sample.{number}", 3.0)


def test_what_was_taken_and_does_not_start_says_why_and_is_an_alarm_after_five_seconds() -> None:
    """The robot has to arrive before the second start, and does not."""
    tried, taken = station(NAME), standing()
    alarms = alarms_of(taken.execution)
    arrives = "robot.move_to_position(home).robot_arrives"
    to_home = "robot.move_to_position(home)"
    ticks = (PlanTick((), (TO_ABOVE,)), PlanTick((LEAVES,), ()), PlanTick((arrives,), (to_home,)))
    goal = predicate_of(tried.automaton, "robot.target_pose == home")
    take(
        taken,
        OperatorPlan(OperatorPlanKind.WAY_BACK, "home", Plan(ticks, False, False), goal, unsupervised=True, by="Eva"),
    )

    def causes(seconds: float) -> list[str]:
        return [str(c.text) for c in alarms.causes(Timestamp(0.0, taken.seconds + seconds)) if c.key == "errand-waits"]

    assert taken.tick() == (TO_ABOVE,)
    taken.tick((LEAVES,))
    assert causes(20) == [], "what runs is overdue by its own time-outs"
    taken = standing()
    alarms = alarms_of(taken.execution)
    missing = OperatorPlan(
        OperatorPlanKind.WAY_BACK, "home", Plan((PlanTick((), (to_home,)),), False, False), goal, by="Eva"
    )
    take(taken, missing)
    assert taken.tick() == ()
    assert taken.execution.operator_plan is None, "it leads nowhere, and is over at once"
    held = replace(missing, plan=Plan((PlanTick((), (TO_ABOVE,)),), False, False), into_safe=True, unsupervised=True)
    taken = standing()
    taken.execution.set_stepping(True)
    alarms = alarms_of(taken.execution)
    take(taken, replace(held, goal=TRUE))
    assert taken.tick() == ()
    assert causes(4) == []
    (text,) = causes(5.1)
    assert text == "“Move to above engine” has not started for 5 s: it waits for a step: the station goes step by step"
    taken.execution.take_step()
    assert taken.tick() == (TO_ABOVE,)
    assert causes(60) == []
