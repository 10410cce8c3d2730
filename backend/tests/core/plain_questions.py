"""Questions about random plain automata, and their answers by exhaustive search."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

import pytest

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.evaluator import holds
from sequence_planner.language.printer import print_value
from sequence_planner.model.efa_document import read_plain
from sequence_planner.model.source import ModelError
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import Goal
from sequence_planner.planning.validation.replay import missing

from .choices import Choices
from .explicit_plain import ExplicitPlain, Key, type_of
from .random_plain import document


def document_with_goals(choices: Choices) -> dict[str, Any]:
    """A document that now and then has further goals."""
    first = document(choices)
    more = (
        [f"F ({name} == {value})" for name, value in values(choices, first["variables"])] if choices.chance(2) else []
    )
    return {**first, "goal": [*first["goal"], *more]}


def values(choices: Choices, variables: dict[str, object]) -> list[tuple[str, str]]:
    """Some variables, each with a value of its domain as it is written."""
    chosen = choices.different(list(variables), 1, 2)
    return [(name, print_value(choices.pick(type_of(variables[name]).domain))) for name in chosen]


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


def distance(explicit: ExplicitPlain, begin: Key, goals: Goals) -> int | None:
    """The fewest transitions of a supervised run from `begin` in which each goal holds somewhere, if there is one.

    The search is over states together with the goals that are missing still.
    """

    def missing_in(key: Key, left: Goals) -> Goals:
        return tuple(goal for goal in left if not holds(goal.predicate, explicit.valuation(key)))

    layer = {(begin, missing_in(begin, goals))}
    seen, steps = set(layer), 0
    while layer:
        if any(not left for _, left in layer):
            return steps
        following = {
            (after, missing_in(after, left))
            for key, left in layer
            for after in explicit.steps[False][key] | (explicit.steps[True][key] & explicit.safe)
        }
        layer, steps = following - seen, steps + 1
        seen |= layer
    return None


def reaches(
    automaton: Automaton, supervisor: Supervisor, state: State, plan: Iterable[str], goals: Iterable[Goal]
) -> bool:
    """Whether each transition of `plan` can be taken under the supervisor, and each goal holds somewhere on the way."""
    transitions, left = plain_transitions(automaton), missing(goals, state)
    for name in plan:
        after = step(state, transitions[name])
        if after is None or (transitions[name].controllable and not supervisor.allows(state, after)):
            return False
        state, left = after, missing(left, after)
    return not left
