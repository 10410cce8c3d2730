"""A reason excludes every plan, and each of its members is needed for that, as an exhaustive search sees it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from functools import cache
from random import Random

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, Operation, Specification, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import supervised_start
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import TRUE, Comparison, Constant, Expression, Variable, conjunction
from sequence_planner.planning.diagnosis import Member, MemberKind, SupervisorFor, explain
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Circumstances
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import SynthesisError, synthesise
from support.examples import examples

from .choices import Choices, made_by
from .exhaustive import alike, can_reach
from .explicit import outcomes
from .random_problems import Problem, problem


def supervisors(given_: Problem) -> SupervisorFor:
    """The supervisor of some of the specifications."""

    @cache
    def supervisor_for(names: frozenset[str]) -> Supervisor:
        every = given_.automaton.specifications
        if names == every.keys():
            return given_.supervisor
        kept = {name: specification for name, specification in every.items() if name in names}
        return synthesise(replace(given_.automaton, specifications=kept))

    return supervisor_for


def possible(given_: Problem, members: Collection[Member], supervisor_for: SupervisorFor) -> bool:
    """Whether there is a plan when no more than `members` stands in its way."""
    named = {part: {member.name for member in members if member.part is part} for part in MemberKind}
    goals = tuple(
        goal if goal.name in named[MemberKind.LOCAL] else replace(goal, local=TRUE, at=0)
        for goal in given_.goals
        if goal.name in named[MemberKind.GOAL]
    )
    circumstances = Circumstances(
        frozenset(named[MemberKind.OFFLINE]),
        given_.circumstances.restart,
        tuple(c for c in given_.circumstances.avoid if print_expression(c) in named[MemberKind.AVOID]),
        frozenset(named[MemberKind.BARRED]),
    )
    free = [name for name in given_.automaton.variables if name not in named[MemberKind.VALUE]]
    states = alike(given_.automaton, given_.state, free)
    supervisor = supervisor_for(frozenset(named[MemberKind.SPECIFICATION]))
    return not goals or can_reach(given_.automaton, supervisor, states, goals, circumstances)


def explains(given_: Problem) -> bool:
    """There is a minimal reason exactly where there is no plan; whether there is one."""
    supervisor_for = supervisors(given_)
    task = PlanningTask(given_.state, given_.goals, given_.circumstances)
    reason = explain(given_.automaton, supervisor_for, task, Budget.seconds(60))
    plan = can_reach(given_.automaton, given_.supervisor, [given_.state], given_.goals, given_.circumstances)
    assert (reason is None) == plan
    if reason is None:
        return False
    assert reason.minimal or None in given_.state.values()
    assert not possible(given_, reason.members, supervisor_for)
    for member in reason.members if reason.minimal else ():
        others = [other for other in reason.members if other != member]
        assert possible(given_, others, supervisor_for), member
    return True


def demanding(choices: Choices) -> Problem:
    """A problem with formulas and circumstances."""
    return problem(choices, demanding=True)


@examples(60)
@given(made_by(problem))
def test_reasons_suffice_and_each_member_is_needed(given_: Problem) -> None:
    explains(given_)


@examples(60)
@given(made_by(demanding))
def test_so_they_do_with_formulas_and_circumstances(given_: Problem) -> None:
    explains(given_)


@pytest.mark.parametrize("seed", [103448, 900574])
def test_a_plan_for_a_value_that_is_still_awaited_makes_nothing_needed(seed: int) -> None:
    """Whoever frees a variable that is awaited lets it have any value, and not be awaited for ever."""
    choices = Choices(Random(seed).randrange)
    assert explains(problem(choices, unknown=True, demanding=choices.chance(2)))


def specified(choices: Choices) -> Problem:
    """A problem on whose way to the goals a specification forbids what free runs come through."""
    made = problem(choices)
    automaton = replace(made.automaton, rest=None, specifications={})
    supervisor = synthesise(automaton)
    state = made.state
    specifications: dict[str, Specification] = {}
    helpful = [effect for effect in automaton.effects if not effect.fault]
    for number in range(choices.number(4, 8)):
        before = state
        state = choices.pick(outcomes(automaton, before, helpful)[::-1])
        for ability in choices.different(list(automaton.abilities.values()), 1, 4):
            state = supervised_start(automaton, supervisor, before, state, ability) or state
        changed = [name for name in automaton.variables if state[name] != made.state[name]]
        if number % 2 == 1 and changed:
            others = [name for name in automaton.variables if name != changed[0]]
            named = [choices.pick(changed), *choices.different(others, 0, 1)]
            name = f"s{number}"
            specifications[name] = Specification(
                name, name, conjunction(*(_equals(automaton, state, n) for n in named))
            )
    end = [name for name in automaton.variables if state[name] != made.state[name]]
    goal = conjunction(*(_equals(automaton, state, name) for name in end[:2]))
    operations = {name: Operation(name, name, TRUE, goal) for name in made.automaton.operations}
    automaton = replace(automaton, specifications=specifications, operations=operations)
    try:
        return replace(made, automaton=automaton, supervisor=synthesise(automaton))
    except SynthesisError:
        return made


def _equals(automaton: Automaton, state: State, name: str) -> Expression:
    value = state[name]
    assert value is not None
    return Comparison("==", Variable(name, automaton.variables[name].type), Constant(value))


@examples(60)
@given(made_by(specified))
def test_specifications_are_named_where_they_matter(given_: Problem) -> None:
    explains(given_)


@examples(40)
@given(made_by(lambda choices: problem(choices, unknown=True, demanding=choices.chance(2))))
def test_so_they_do_with_unknown_values(given_: Problem) -> None:
    explains(given_)


@examples(10)
@given(made_by(problem))
def test_without_time_no_reason_is_given(given_: Problem) -> None:
    task = PlanningTask(given_.state, given_.goals, given_.circumstances)
    assert explain(given_.automaton, supervisors(given_), task, Budget.seconds(0)) is None
