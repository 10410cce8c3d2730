"""Corrections bring a plan back, and no fewer changes do, as trying them all shows."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, product

from hypothesis import given

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.tick import synchronise
from sequence_planner.planning.diagnosis import CorrectedValue, corrections
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.validation.replay import Replay, missing
from sequence_planner.process.budget import Budget
from support.examples import examples

from .choices import Choices, made_by
from .exhaustive import can_reach
from .random_problems import Problem, problem


def changed(given_: Problem, changes: tuple[CorrectedValue, ...]) -> Problem:
    """The problem after `changes`."""
    values = {change.name: change.value for change in changes if change.value is not None}
    online = {change.name for change in changes if change.value is None and not change.ability}
    served = {change.name for change in changes if change.ability}
    circumstances = replace(
        given_.circumstances,
        offline=given_.circumstances.offline - online,
        barred=given_.circumstances.barred - served,
    )
    state = synchronise(given_.automaton, {**given_.state, **values})
    return replace(given_, state=state, circumstances=circumstances)


def possible(given_: Problem) -> bool:
    """Whether there is a plan, be it that nothing is left to do, from a safe state."""
    if not given_.supervisor.safe.includes(given_.state):
        return False
    goals = missing(given_.goals, given_.state)
    return not goals or can_reach(given_.automaton, given_.supervisor, [given_.state], goals, given_.circumstances)


def restates(given_: Problem, changes: frozenset[CorrectedValue]) -> bool:
    """Whether the changes only say that the goals are reached."""
    after = changed(given_, tuple(changes))
    return not missing(after.goals, after.state)


def by_trying(given_: Problem, size: int) -> set[frozenset[CorrectedValue]]:
    """All sets of so many changes after which there is a plan."""
    options: list[list[CorrectedValue]] = [
        [CorrectedValue(resource, None)] for resource in sorted(given_.circumstances.offline)
    ]
    options += [[CorrectedValue(name, None, ability=True)] for name in sorted(given_.circumstances.barred)]
    for name in given_.automaton.names(Kind.ESTIMATED):
        if given_.state[name] is not None:
            domain = given_.automaton.variables[name].type.domain
            options.append([CorrectedValue(name, value) for value in domain if value != given_.state[name]])
    sets = (changes for subjects in combinations(options, size) for changes in product(*subjects))
    return {frozenset(changes) for changes in sets if possible(changed(given_, changes))}


def corrects(given_: Problem) -> None:
    """All corrections of the fewest changes are found, with plans that replay."""
    task = PlanningTask(given_.state, given_.goals, given_.circumstances)
    found = corrections(given_.automaton, given_.supervisor, task, Budget.seconds(60), most_changes=2, most_found=1000)
    every = [by_trying(given_, size) for size in (1, 2)]
    helping = [{each for each in some if not restates(given_, each)} for some in every]
    expected = helping[0] or helping[1] or every[0] or every[1]
    assert {frozenset(each.changes) for each in found} == expected
    for each in found:
        after = changed(given_, each.changes)
        replay = Replay(after.automaton, after.supervisor, after.circumstances)
        assert replay.exactly(after.state, after.state, after.goals, (), each.plan.ticks)


def some_problem(choices: Choices) -> Problem:
    """Any kind of problem that has no plan as it is, or also one that has."""
    return problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))


@examples(80)
@given(made_by(some_problem))
def test_corrections_are_those_that_trying_finds(given_: Problem) -> None:
    if not possible(given_):
        corrects(given_)


@examples(40)
@given(made_by(some_problem))
def test_no_more_than_asked_for_are_given(given_: Problem) -> None:
    task = PlanningTask(given_.state, given_.goals, given_.circumstances)
    found = corrections(given_.automaton, given_.supervisor, task, Budget.seconds(60), most_changes=1, most_found=2)
    assert len(found) <= 2
    assert corrections(given_.automaton, given_.supervisor, task, Budget.seconds(0)) == ()
