"""What nobody can complete without what is absent: never said of an operation that some run completes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, Operation, State
from sequence_planner.automaton.tick import start, start_guard_holds, synchronise
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import holds
from sequence_planner.planning.heuristic.still_possible import Absent, Remaining
from support.examples import examples

from .choices import Choices, made_by
from .explicit import outcomes
from .random_problems import problem


@dataclass(frozen=True)
class Case:
    """A station and a state, in which some resources are silent and others, or abilities, out of service."""

    automaton: Automaton
    state: State
    absent: Absent
    silent: frozenset[str]


def case(choices: Choices) -> Case:
    """Any, with preconditions that other operations have as goals."""
    given_ = problem(choices, unknown=choices.chance(2), demanding=True)
    station = given_.automaton
    goals = [each.goal for each in station.operations.values()]
    operations = {name: replace(each, precondition=choices.pick(goals)) for name, each in station.operations.items()}
    resources = frozenset(choices.different(list(station.resources), 1, 2))
    abilities = frozenset(choices.different(list(station.abilities), 0, 1))
    silent = frozenset(choices.different(sorted(resources), 0, 2))
    variables = {
        name: replace(each, resource=choices.pick(list(station.resources))) for name, each in station.variables.items()
    }
    station = replace(station, operations=operations, variables=variables)
    return Case(station, synchronise(station, given_.state), Absent(resources, abilities), silent)


def runs(case_: Case) -> Iterator[State]:
    """Every state in the run of a tick that may come without what is absent, whatever the supervisor says of it."""
    station, absent = case_.automaton, case_.absent
    pending = list(_heard(case_))
    seen = {tuple(each.values()) for each in pending}
    here = [each for each in station.abilities.values() if each.resource not in absent.resources]
    may = [each for each in here if each.name not in absent.abilities]
    while pending:
        state = pending.pop()
        yield state
        started = (start(station, state, ability) for ability in may if start_guard_holds(ability, state))
        for after in (*outcomes(station, state, station.effects), *(each for each in started if each is not None)):
            if (key := tuple(after.values())) not in seen:
                seen.add(key)
                pending.append(after)


def _heard(case_: Case) -> list[State]:
    """The state with what is unknown of resources that are not silent as it may turn out to be, or still unknown."""
    states = [case_.state]
    for name, variable in case_.automaton.variables.items():
        if case_.state[name] is None and variable.resource not in case_.silent:
            states += [{**state, name: value} for state in states for value in variable.type.domain]
    return [synchronise(case_.automaton, state) for state in states]


def completed(states: Iterable[State], operation: Operation, active: bool) -> bool:
    """Whether the states of runs have what completes it: its goal, and its precondition where it is not active."""
    every = list(states)
    begun = active or any(holds(operation.precondition, state) for state in every)
    return begun and any(holds(operation.goal, state) for state in every)


@given(made_by(case))
@examples(150)
def test_what_nobody_can_complete_no_run_completes(case_: Case) -> None:
    remaining = Remaining(case_.automaton, case_.state, case_.absent, case_.silent)
    beyond = [
        (operation, active)
        for operation in case_.automaton.operations.values()
        for active in (True, False)
        if not remaining.may_complete(operation, active)
    ]
    if beyond:
        states = list(runs(case_))
        for operation, active in beyond:
            assert not completed(states, operation, active), (operation.name, active)


@given(made_by(case))
@examples(150)
def test_whoever_is_said_to_do_it_is_not_absent(case_: Case) -> None:
    remaining = Remaining(case_.automaton, case_.state, case_.absent, case_.silent)
    for operation in case_.automaton.operations.values():
        doing = remaining.doing(operation, active=True)
        assert case_.absent.resources.isdisjoint(doing.by)
        if doing.by or doing.once:
            assert remaining.may_complete(operation, active=True)


@given(made_by(case))
@examples(150)
def test_nothing_more_becomes_possible_with_more_absent(case_: Case) -> None:
    fewer = Remaining(case_.automaton, case_.state, Absent(), frozenset())
    more = Remaining(case_.automaton, case_.state, case_.absent, case_.silent)
    for operation in case_.automaton.operations.values():
        for active in (True, False):
            assert fewer.may_complete(operation, active) or not more.may_complete(operation, active)
