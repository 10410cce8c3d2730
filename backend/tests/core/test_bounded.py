"""The SAT engine finds exactly what a breadth-first search on the reference tick finds, formulas and all."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    finish,
    initial_state,
    supervised_start,
    synchronise,
)
from sequence_planner.language.evaluator import holds
from sequence_planner.language.ltl import satisfies
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import BOOLEAN
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Contract, Goal, Plan, goals_of
from sequence_planner.planning.sat.bmc import BoundedModelChecking
from sequence_planner.process.budget import Budget
from support.automata import Does, automaton
from support.examples import examples

from .breadth_first import Shortest, may_start, permitted, shortest
from .choices import Choices, made_by
from .random_problems import Problem, problem
from .random_stations import state_of

LONGEST = 7


def open_goals(given_: Problem) -> Goals:
    """The goals that do not hold already."""
    return tuple(goal for goal in given_.goals if not holds(goal.predicate, given_.state))


def solved(given_: Problem, contract: Contract, engine: BoundedModelChecking | None = None) -> Finding:
    """What `engine`, or a new one, finds for all goals that are open."""
    engine = engine or BoundedModelChecking(given_.automaton, given_.supervisor)
    task = PlanningTask(given_.state, open_goals(given_), given_.circumstances, contract, LONGEST)
    return engine.solve(task, Budget.seconds(60))


def positions(given_: Problem, plan: Plan) -> Iterator[tuple[bool, State]]:
    """The states after step 3, marked true, and after each start; AssertionError where the plan cannot be taken."""
    station, circumstances, state = given_.automaton, given_.circumstances, given_.state
    effects = {e.name: e for e in station.effects if not e.fault and e.resource not in circumstances.offline}
    for tick in plan.ticks:
        published = state
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        assert sensed is not None
        state = synchronise(station, finish(station, sensed).state)
        yield True, state
        for name in tick.starts:
            ability = station.abilities[name]
            assert may_start(ability, circumstances)
            after = supervised_start(station, given_.supervisor, published, state, ability)
            assert after is not None
            state = after
            yield False, state


def reached(goal: Goal, run: list[tuple[bool, State]]) -> bool:
    """Whether the run reaches the goal, and its positions up to then satisfy the goal's formula."""
    for number, (settled, state) in enumerate(run, start=1):
        if settled and holds(goal.predicate, state):
            return satisfies(goal.local, [position for _, position in run[:number]]) is True
    return False


def valid(given_: Problem, plan: Plan) -> bool:
    """Whether the run of the plan reaches all goals, by the definition of formulas, and avoids what it shall."""
    run = list(positions(given_, plan))
    kept = all(permitted(state, given_.circumstances) for _, state in run)
    return kept and not plan.ticks[-1].starts and all(reached(goal, run) for goal in open_goals(given_))


def looks_closely(given_: Problem) -> bool:
    """Whether formulas or conditions look between more starts than the engine tries in every order.

    It then claims nothing about the length of its plans.
    """
    looked_at = bool(given_.circumstances.avoid) or any(goal.local != TRUE for goal in given_.goals)
    return looked_at and len(given_.automaton.abilities) > 6


def check(given_: Problem, engine: BoundedModelChecking | None = None) -> None:
    """Minimal plans are as short as they can be; fast ones are plans."""
    if not (goals := open_goals(given_)):
        return
    best = shortest(given_.automaton, given_.supervisor, given_.state, goals, LONGEST, given_.circumstances)
    minimal = solved(given_, Contract.MINIMAL, engine)
    if best is None:
        assert minimal.plan is None
        assert minimal.searched == LONGEST or looks_closely(given_)
    elif looks_closely(given_):
        assert minimal.plan is not None or minimal.searched == 0
        assert minimal.plan is None or valid(given_, minimal.plan)
    else:
        assert minimal.plan is not None
        assert (minimal.plan.minimal_ticks, minimal.plan.minimal_starts, minimal.searched) == (True, True, best.ticks)
        assert Shortest(len(minimal.plan.ticks), len(minimal.plan.starts)) == best
        assert valid(given_, minimal.plan)
    fast = solved(given_, Contract.FAST, engine)
    if fast.plan is not None:
        assert best is not None
        assert not fast.plan.minimal_ticks or len(fast.plan.ticks) == best.ticks
        assert valid(given_, fast.plan)
    assert fast.plan is not None or best is None or best.ticks < LONGEST or best.starts > 1


@examples(150)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(3))))
def test_the_fewest_ticks_and_then_the_fewest_starts(given_: Problem) -> None:
    check(given_)


@examples(250)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(4), demanding=True)))
def test_formulas_and_circumstances_are_kept_to(given_: Problem) -> None:
    check(given_)


def several_questions(choices: Choices) -> list[Problem]:
    """A problem, and the same from further states."""
    first = problem(choices, demanding=choices.chance(2))
    states = [state_of(choices, first.automaton, unknown=choices.chance(4)) for _ in range(4)]
    return [first, *(replace(first, state=state) for state in states)]


@examples(50)
@given(made_by(several_questions))
def test_what_is_kept_from_question_to_question_changes_no_answer(questions: list[Problem]) -> None:
    engine = BoundedModelChecking(questions[0].automaton, questions[0].supervisor)
    for each in questions:
        check(each, engine)


def counter(bits: int) -> Automaton:
    """Counts to 2 to the power of `bits`, a tick at a time: no plan is short."""
    names = [f"b{number}" for number in range(bits)]
    start = tuple(
        f"{name} := not {name}" + (f" if {' and '.join(names[:number])}" if number else "")
        for number, name in enumerate(names)
    )
    return automaton(
        {"count": Does(start=start)},
        estimated=dict.fromkeys(names, (BOOLEAN, False)),
        goals={"full": " and ".join(names)},
    )


def test_when_the_time_is_over_it_says_how_far_it_came() -> None:
    station = counter(12)
    engine = BoundedModelChecking(station, Supervisor(StateSet((), ()), {}))
    task = PlanningTask(initial_state(station), goals_of(station, ("full",)), longest=5000, depth=5000)
    budget = Budget.seconds(0.4)
    finding = engine.solve(task, budget)
    assert budget.spent
    assert finding.plan is None
    assert 0 < finding.searched < 4096
