"""Plain automata: what their documents mean, and what synthesis and planner make of them."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given

from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.language.evaluator import holds
from sequence_planner.planning.efa_planner import PlainPlanner, plan_transitions
from sequence_planner.planning.problem import Contract, Verdict, goals_of
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.supervisor import Supervision, SynthesisError, relevant, synthesise
from sequence_planner.synthesis.transition_relation import Plant
from support.examples import examples

from .choices import made_by
from .explicit_plain import Key
from .plain_questions import distance, document_with_goals, meant, reaches
from .random_plain import document


@examples(200)
@given(made_by(document))
def test_each_transition_does_what_its_document_says(written: dict[str, Any]) -> None:
    explicit, automaton = meant(written)
    if automaton is None:
        return
    transitions = plain_transitions(automaton)
    by_event = {
        t["event"]: [name for name in transitions if event_of(name) == t["event"]] for t in written["transitions"]
    }
    for transition in written["transitions"]:
        taken, name = explicit.taken(transition), by_event[transition["event"]].pop(0)
        assert transitions[name].controllable == transition["controllable"]
        for key in explicit.states:
            after = step(explicit.valuation(key), transitions[name])
            assert (None if after is None else tuple(after.values())) == taken.get(key)


@examples(200)
@given(made_by(document))
def test_the_initial_states_are_those_that_are_described_and_exist(written: dict[str, Any]) -> None:
    explicit, automaton = meant(written)
    if automaton is None:
        return
    declared = tuple(variable.initial for variable in automaton.variables.values())
    assert declared in explicit.initial
    assert (automaton.initial is None) == (len(explicit.initial) == 1)
    if automaton.initial is not None:
        assert explicit.initial == {k for k in explicit.states if holds(automaton.initial, explicit.valuation(k))}


@examples(200)
@given(made_by(document))
def test_safe_and_reachable_states_are_those_of_the_definition(written: dict[str, Any]) -> None:
    """Over the variables that matter; and there is a supervisor when all initial states are safe."""
    explicit, automaton = meant(written)
    if automaton is None:
        return
    supervision = Supervision(Plant(automaton, relevant(automaton)))
    diagrams = supervision.plant.diagrams

    def projected(key: Key) -> Key:
        return tuple(explicit.valuation(key)[name] for name in diagrams.names)

    def members(states: Function) -> set[Key]:
        return {tuple(member.values()) for member in diagrams.exported(states, diagrams.names).members()}

    safe = members(supervision.safe)
    for key in explicit.states:
        assert (projected(key) in safe) == (key in explicit.safe)
    for supervised in (False, True):
        reached = members(supervision.reachable(supervised))
        assert reached == set(map(projected, explicit.distances(explicit.initial, supervised)))
    if explicit.initial <= explicit.safe:
        assert synthesise(automaton).safe.includes(automaton.initial_valuation)
    else:
        with pytest.raises(SynthesisError):
            synthesise(automaton)


@examples(150)
@given(made_by(document_with_goals))
def test_plans_have_the_fewest_transitions_and_there_is_none_exactly_where_exhaustive_search_finds_none(
    written: dict[str, Any],
) -> None:
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    for key in sorted(explicit.initial, key=str)[:2]:
        begin, least = explicit.valuation(key), distance(explicit, key, goals)
        answer = plan_transitions(automaton, supervisor, goals, begin, budget=Budget.seconds(60))
        fast = plan_transitions(automaton, supervisor, goals, begin, Contract.FAST, budget=Budget.seconds(60))
        if least is None:
            assert answer.verdict is fast.verdict is Verdict.NONE_AT_ALL
            continue
        assert answer.verdict is fast.verdict is Verdict.FOUND
        assert answer.minimal
        assert len(answer.transitions) == answer.searched == least
        assert fast.searched <= least <= len(fast.transitions)
        for each in (answer, fast):
            assert reaches(automaton, supervisor, begin, each.transitions, goals)


@examples(100)
@given(made_by(document_with_goals))
def test_of_several_initial_states_a_plan_begins_in_the_best(written: dict[str, Any]) -> None:
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    distances = [distance(explicit, key, goals) for key in explicit.initial]
    found = [least for least in distances if least is not None]
    answer = plan_transitions(automaton, supervisor, goals, budget=Budget.seconds(60))
    fast = plan_transitions(automaton, supervisor, goals, contract=Contract.FAST, budget=Budget.seconds(60))
    if not found:
        assert answer.verdict is fast.verdict is Verdict.NONE_AT_ALL
        return
    assert answer.verdict is fast.verdict is Verdict.FOUND
    assert answer.minimal
    assert len(answer.transitions) == answer.searched == min(found)
    assert fast.searched <= min(found) <= len(fast.transitions)
    for each in (answer, fast):
        begin = each.begin or automaton.initial_valuation
        assert tuple(begin[name] for name in explicit.types) in explicit.initial
        assert reaches(automaton, supervisor, begin, each.transitions, goals)


@examples(60)
@given(made_by(document_with_goals), made_by(lambda choices: [choices.number(0, 9) for _ in range(5)]))
def test_a_planner_that_was_asked_before_answers_as_one_that_was_not(written: dict[str, Any], drawn: list[int]) -> None:
    """From states on the ways of its plans, beside them, and anywhere else, by both contracts."""
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    planner = PlainPlanner(automaton, supervisor)
    known = sorted((key for key in explicit.distances(explicit.initial, True)), key=str)
    for number in drawn:
        key = known[number % len(known)]
        begin, asked = explicit.valuation(key), goals[: 1 + number % len(goals)]
        least = distance(explicit, key, asked)
        contract = Contract.FAST if number % 3 == 0 else Contract.MINIMAL
        answer = planner.answer(asked, begin, contract, budget=Budget.seconds(60))
        if least is None:
            assert answer.verdict is Verdict.NONE_AT_ALL
            continue
        assert answer.verdict is Verdict.FOUND
        assert answer.searched <= least <= len(answer.transitions)
        assert not answer.minimal or len(answer.transitions) == least
        assert answer.minimal or contract is Contract.FAST
        assert reaches(automaton, supervisor, begin, answer.transitions, asked)
