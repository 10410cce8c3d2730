"""The worked example of the semantics, with exactly its figures, and the traps that the paper's model holds."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    finish,
    initial_state,
    start_guard_holds,
    supervised_start,
    synchronise,
)
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import Expression
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Plan, PlanRequest, Verdict, goals_of
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.supervisor import Supervision

from .explicit import Explicit

RUN, ABOVE, DOWN = "nutrunner.run_nut", "robot.move(above)", "robot.move(bolt_pair)"
TORQUE = "nutrunner.run_nut.torque_is_reached"


def predicate(automaton: Automaton, text: str) -> Expression:
    return automaton.read_condition(text)


@pytest.fixture(scope="module")
def reached(worked_example: Automaton, supervision: Supervision) -> list[State]:
    """The states that the station can reach under its supervisor."""
    diagrams = supervision.plant.diagrams
    members = diagrams.exported(supervision.reachable(supervised=True), worked_example.variables).members()
    blank = worked_example.initial_valuation
    return [synchronise(worked_example, {**blank, **member}) for member in members]


@pytest.fixture(scope="module")
def placed(worked_example: Automaton) -> State:
    """A bolt is placed, the tool is idle, the robot at home, no acknowledgement pending."""
    return synchronise(worked_example, {**initial_state(worked_example), "bolts": "placed"})


@pytest.fixture(scope="module")
def plan(worked_example: Automaton, supervisor: Supervisor, placed: State) -> Plan:
    answer = Planner(worked_example, supervisor).answer(
        PlanRequest(placed, goals_of(worked_example, ("tighten_bolt_pair",)), deadline=60)
    )
    assert answer.verdict is Verdict.FOUND
    assert answer.plan is not None
    return answer.plan


def run(automaton: Automaton, supervisor: Supervisor, state: State, plan: Plan) -> Iterator[tuple[str, State]]:
    """The states of a plan: `sensed` after step 3, `started` after each start."""
    effects = {effect.name: effect for effect in automaton.effects}
    for tick in plan.ticks:
        published = state
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        assert sensed is not None
        state = synchronise(automaton, finish(automaton, sensed).state)
        yield "sensed", state
        for name in tick.starts:
            after = supervised_start(automaton, supervisor, published, state, automaton.abilities[name])
            assert after is not None
            state = after
            yield "started", state


def test_the_initial_state(worked_example: Automaton) -> None:
    state = initial_state(worked_example)
    true = {name for name in worked_example.variables if state[name] is True}
    assert true == {"nutrunner.tool_is_idle", "nutrunner.set_tool_idle"}
    assert (state["bolts"], state["robot.pose"], state["robot.target_pose"]) == ("empty", "home", "home")


def test_180_states_are_reachable_without_the_specification_and_24_of_them_are_forbidden(
    supervision: Supervision,
) -> None:
    reached = supervision.reachable(supervised=False)
    assert count(supervision, reached) == 180
    (forbidden,) = supervision.forbidden.values()
    assert count(supervision, reached & forbidden) == 24


def test_148_states_are_reachable_with_the_supervisor(supervision: Supervision) -> None:
    assert count(supervision, supervision.reachable(supervised=True)) == 148


def count(supervision: Supervision, states: Function) -> int:
    return supervision.plant.diagrams.count(states)


def test_the_plain_enumeration_of_the_definition_gives_the_same_figures(worked_example: Automaton) -> None:
    explicit = Explicit(worked_example)
    assert len(explicit.reachable(supervised=False)) == 180
    assert len(explicit.reachable(supervised=False) & explicit.forbidden) == 24
    assert len(explicit.reachable(supervised=True)) == 148


@pytest.mark.parametrize(
    ("ability", "added"),
    [
        (DOWN, "not operator.task and (bolts != placed or nutrunner.run_nut.executing)"),
        ("operator.place_bolt", "robot.target_pose != bolt_pair and robot.pose != bolt_pair"),
        (RUN, "true"),
        (ABOVE, "true"),
        ("robot.move(home)", "true"),
        ("engine.next_engine", "true"),
    ],
)
def test_the_guards_added_are_those_of_the_example(
    worked_example: Automaton, supervisor: Supervisor, reached: list[State], ability: str, added: str
) -> None:
    """As functions on the supervised states in which the written guard holds."""
    guard = predicate(worked_example, added)
    startable = [state for state in reached if start_guard_holds(worked_example.abilities[ability], state)]
    assert startable
    for state in startable:
        shown = ability not in supervisor.guards or supervisor.guards[ability].includes(state)
        enforced = supervised_start(worked_example, supervisor, state, state, worked_example.abilities[ability])
        assert shown == (enforced is not None) == holds(guard, state)


def test_both_added_guards_are_needed(worked_example: Automaton, supervisor: Supervisor, reached: list[State]) -> None:
    for name in (DOWN, "operator.place_bolt"):
        startable = [state for state in reached if start_guard_holds(worked_example.abilities[name], state)]
        assert {supervisor.guards[name].includes(state) for state in startable} == {False, True}


def test_the_shortest_plan_takes_six_ticks_and_three_starts(plan: Plan) -> None:
    assert (plan.minimal_ticks, plan.minimal_starts) == (True, True)
    assert [set(tick.starts) for tick in plan.ticks] == [{RUN, ABOVE}, set(), {DOWN}, set(), set(), set()]
    assert plan.ticks[5].effects == (TORQUE,)
    assert not any(TORQUE in tick.effects for tick in plan.ticks[:5])


def test_no_state_of_the_plan_is_forbidden(
    worked_example: Automaton, supervisor: Supervisor, placed: State, plan: Plan
) -> None:
    states = [state for _, state in run(worked_example, supervisor, placed, plan)]
    forbidden = [specification.forbidden for specification in worked_example.specifications.values()]
    assert not any(holds(each, state) for each in forbidden for state in states)
    assert states[-1]["bolts"] == "tightened"


# The traps of the paper's small model, when its transitions are taken literally.


def test_trap_1_a_plan_that_tightens_without_moving_the_robot(
    worked_example: Automaton, supervisor: Supervisor, reached: list[State], plan: Plan
) -> None:
    """Nothing in `run_nut` itself mentions the pose; the torque does."""
    assert DOWN in {name for _, name in plan.starts}
    explicit = Explicit(worked_example)
    tightened_at = {
        state["robot.pose"]
        for state in reached
        if state["bolts"] == "placed"
        for key in explicit.uncontrollable[explicit.key(state)]
        if explicit.states[key]["bolts"] == "tightened"
    }
    assert tightened_at == {"bolt_pair"}


def test_trap_2_a_supervisor_that_forbids_the_move_because_executing_ends_before_the_bolt_is_tightened(
    worked_example: Automaton, supervisor: Supervisor, reached: list[State]
) -> None:
    """The torque report ends `executing` and the finish sees it, all in one tick: nothing forbidden in between."""
    above_placed = [
        s for s in reached if s["bolts"] == "placed" and start_guard_holds(worked_example.abilities[DOWN], s)
    ]
    assert any(supervisor.guards[DOWN].includes(state) for state in above_placed)

    torque = next(effect for effect in worked_example.effects if effect.name == TORQUE)
    tightening = [state for state in reached if holds(torque.guard, state)]
    assert tightening
    for state in tightening:
        sensed = apply_effects(state, [torque])
        assert sensed is not None
        finishing = finish(worked_example, sensed)
        assert RUN in finishing.finished
        settled = synchronise(worked_example, finishing.state)
        assert (settled["bolts"], settled[f"{RUN}.executing"]) == ("tightened", False)


def test_trap_3_a_finish_that_needs_priority_over_the_reset_of_executing(
    worked_example: Automaton, supervisor: Supervisor, reached: list[State], placed: State, plan: Plan
) -> None:
    """The plan that needed such a priority exists without: the tool runs first, then the robot moves down.

    The guard is the one expected of it, once no bolt is being placed.
    """
    order = [name for _, name in plan.starts]
    assert sorted(order) == sorted([RUN, ABOVE, DOWN])
    assert order[-1] == DOWN
    moments = list(run(worked_example, supervisor, placed, plan))
    down = next(state for kind, state in moments if kind == "started" and state["robot.target_pose"] == "bolt_pair")
    assert down[f"{RUN}.executing"] is True
    expected = predicate(worked_example, "nutrunner.run_nut.executing or bolts != placed")
    for state in reached:
        if state["operator.task"] is False and start_guard_holds(worked_example.abilities[DOWN], state):
            assert supervisor.guards[DOWN].includes(state) == holds(expected, state)
