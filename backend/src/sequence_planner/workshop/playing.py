"""A run that shows a finding, as an ability goes through it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sequence_planner.analysis.document import TraceDocument
from sequence_planner.automaton.structure import Ability, Automaton
from sequence_planner.control.definition_view import AutomatonView
from sequence_planner.control.drawing import Drawing
from sequence_planner.expressions.types import Value
from sequence_planner.workshop.transfer import transferred


def played(automaton: Automaton, ability: Ability, trace: TraceDocument) -> list[AutomatonView]:
    """The automaton of `ability` in the initial state of a run, and after each step; without a supervisor, which such a
    run has not been held back by.
    """
    states = (transferred(automaton, values) for values in _values(trace))
    return [Drawing(automaton, state, {}, None).of(ability) for state in states]


def _values(trace: TraceDocument) -> Iterator[Mapping[str, Value | None]]:
    values = dict(trace.initial)
    yield values
    for step in trace.steps:
        values = {**values, **step.changes}
        yield values
