"""The reference of plain automata: one transition at a time."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.tick import writes
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.language.evaluator import holds


def plain_transitions(automaton: Automaton) -> Mapping[str, Transition]:
    """The transitions of a plain automaton by name, controllable ones first."""
    return {
        **{
            a.name: Transition(a.name, Phase.START, a.start_guard, a.start_actions)
            for a in automaton.abilities.values()
        },
        **{e.name: Transition(e.name, Phase.SENSE, e.guard, e.actions) for e in automaton.effects},
    }


def step(state: State, transition: Transition) -> State | None:
    """The state after `transition`, or None where its guard does not hold."""
    written = writes(transition.actions, state) if holds(transition.guard, state) else None
    return None if written is None else {**state, **written}
