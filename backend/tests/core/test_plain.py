"""Plain automata: what their documents mean, and what synthesis and planner make of them."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given

from sequence_planner.automaton.plain.meaning import event_of, plain_automaton
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.evaluation import holds
from sequence_planner.model.plain_documents import read_plain
from sequence_planner.model.source import ModelError
from sequence_planner.planning.plain import plan_transitions
from sequence_planner.planning.plan import Verdict
from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.supervision import Supervision, SynthesisError, relevant, synthesise

from .budget import examples
from .choices import made_by
from .explicit_plain import ExplicitPlain, Key
from .random_plain import document

LONGEST = 8


def read(written: dict[str, Any]) -> Automaton:
    return plain_automaton(read_plain(json.dumps(written, indent=1), "example.efa.json"))


def meant(written: dict[str, Any]) -> tuple[ExplicitPlain, Automaton | None]:
    """The document state by state, and as an automaton if it has an initial state at all."""
    explicit = ExplicitPlain(written)
    if explicit.initial:
        return explicit, read(written)
    with pytest.raises(ModelError, match="there is nowhere to begin"):
        read(written)
    return explicit, None


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


@examples(120)
@given(made_by(document))
def test_a_goal_has_a_plan_when_breadth_first_search_finds_one(written: dict[str, Any]) -> None:
    explicit, automaton = meant(written)
    if automaton is None or not explicit.initial <= explicit.safe:
        return
    supervisor, goal = synthesise(automaton), automaton.operations["goal_1"].goal
    for key in sorted(explicit.initial, key=str)[:2]:
        distances = explicit.distances([key], supervised=True)
        reached = [steps for state, steps in distances.items() if holds(goal, explicit.valuation(state))]
        answer = plan_transitions(automaton, supervisor, "goal_1", explicit.valuation(key), LONGEST, deadline=60)
        if answer.verdict is Verdict.FOUND:
            assert reached
            assert len(answer.transitions) >= min(reached)
        elif answer.verdict is Verdict.NONE_AT_ALL:
            assert not reached
        else:
            assert not reached or min(reached) > LONGEST
