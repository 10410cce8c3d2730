"""Plans made with sight of a part are the shortest of the whole, with whatever part the engine begins."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given

from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.types import BOOLEAN, IntegerRange
from sequence_planner.planning.pdr.abstraction import localisable
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import ORDINARY, Circumstances, Contract, goals_of
from sequence_planner.planning.sat.bmc import PartialSight
from sequence_planner.planning.validation.replay import Replay, missing
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton
from support.examples import examples

from .breadth_first import shortest
from .choices import Choices, made_by
from .random_problems import Problem, problem
from .random_stations import state_of

LONGEST = 12


def several_questions(choices: Choices) -> list[Problem]:
    """A problem, now and then with an ability that is barred, and the same from further states."""
    first = problem(choices)
    barred = frozenset(choices.different(list(first.automaton.abilities), 0, 1))
    first = replace(first, circumstances=Circumstances(barred=barred))
    return [first, *(replace(first, state=state_of(choices, first.automaton)) for _ in range(3))]


@examples(100)
@given(made_by(several_questions))
def test_plans_are_the_shortest_and_bounds_are_none_too_high(questions: list[Problem]) -> None:
    engine = PartialSight(questions[0].automaton, questions[0].supervisor, most=1.0)
    for each in questions:
        task = PlanningTask(each.state, missing(each.goals, each.state), each.circumstances, longest=LONGEST)
        if not task.goals:
            continue
        finding = engine.solve(task, Budget.seconds(60))
        best = shortest(each.automaton, each.supervisor, each.state, task.goals, LONGEST, each.circumstances)
        if best is None:
            assert finding.plan is None
            continue
        assert finding.searched <= best.ticks
        if finding.plan is not None:
            assert len(finding.plan.ticks) == best.ticks
            assert len(finding.plan.starts) == best.starts or not finding.plan.minimal_starts
            replay = Replay(each.automaton, each.supervisor, each.circumstances)
            assert replay.exactly(each.state, each.state, task.goals, (), finding.plan.ticks)


@examples(20)
@given(made_by(problem))
def test_work_goes_on_where_a_turn_has_ended(given_: Problem) -> None:
    task = PlanningTask(given_.state, missing(given_.goals, given_.state), longest=LONGEST)
    if not task.goals:
        return
    interrupted, other = (PartialSight(given_.automaton, given_.supervisor, most=1.0) for _ in range(2))
    for seconds in (0.0, 0.001, 0.002, 0.004):
        assert interrupted.solve(task, Budget.seconds(seconds)).searched <= LONGEST
    one, two = (engine.solve(task, Budget.seconds(60)) for engine in (interrupted, other))
    assert shape(one) == shape(two)


def shape(finding: Finding) -> tuple[int, int, int] | int:
    plan = finding.plan
    return finding.searched if plan is None else (len(plan.ticks), len(plan.starts), finding.searched)


@pytest.mark.parametrize("contract", Contract)
@examples(10)
@given(given_=made_by(lambda choices: problem(choices, unknown=True)))
def test_it_leaves_to_others_what_cannot_be_seen_in_part(contract: Contract, given_: Problem) -> None:
    state = given_.state
    task = PlanningTask(state, missing(given_.goals, state), contract=contract, longest=LONGEST)
    if task.goals and (contract is Contract.FAST or None in state.values()):
        engine = PartialSight(given_.automaton, given_.supervisor, most=1.0)
        assert engine.solve(task, Budget.seconds(60)) == Finding()


def test_what_seems_to_finish_by_itself_is_looked_at() -> None:
    """Two parts go through one slot, which a pusher frees: it seems to end a push of which nothing is seen."""
    station = automaton(
        {
            "fill": Does(start=("slot := true", "filled := filled + 1"), enabled="not slot and filled < 2"),
            "push": Does(
                start=("pushing := true",),
                enabled="slot and not pushing and not pushed",
                executing="pushing and not pushed",
                finish="pushing and pushed",
                finally_=("pushing := false", "slot := false"),
            ),
        },
        measured={"pushed": (BOOLEAN, False)},
        output={"pushing": (BOOLEAN, False), "lamp": (BOOLEAN, False)},
        estimated={"slot": (BOOLEAN, False), "filled": (IntegerRange(0, 2), 0)},
        effects={"extends": ("pushing and not pushed", ("pushed := true",))},
        goals={"both": "filled == 2"},
    )
    supervisor, state = synthesise(station), initial_state(station)
    finding = PartialSight(station, supervisor, most=1.0).solve(
        PlanningTask(state, goals_of(station, station.operations)), Budget.seconds(60)
    )
    assert finding.plan is not None
    assert [tick.starts for tick in finding.plan.ticks] == [("fill", "push"), ("fill",), ()]
    assert (finding.plan.minimal_ticks, finding.plan.minimal_starts) == (True, True)


@examples(60)
@given(made_by(problem))
def test_it_finds_whatever_there_is_where_it_may_look_at_everything(given_: Problem) -> None:
    task = PlanningTask(given_.state, missing(given_.goals, given_.state), longest=LONGEST)
    engine = PartialSight(given_.automaton, given_.supervisor, most=1.0)
    localised = localisable(given_.automaton, task.state, task.goals)
    best = shortest(given_.automaton, given_.supervisor, given_.state, task.goals, LONGEST, ORDINARY)
    if task.goals and localised and best is not None:
        assert engine.solve(task, Budget.seconds(60)).plan is not None
