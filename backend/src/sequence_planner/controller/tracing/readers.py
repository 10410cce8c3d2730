"""The conditions that read a variable, with what they are now."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.lifting.condition_tree import ConditionTree, condition_tree
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.recovery.explain import ConditionContext
from sequence_planner.controller.tracing.schemas import TracedReaderView
from sequence_planner.execution.executor import Executor
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import Constant, Expression
from sequence_planner.texts.message import message


class Reading(NamedTuple):
    """A condition of a part of the model."""

    of: str
    name: str
    title: str
    part: str
    condition: Expression


class Readers:
    """Knows which conditions of `execution` read which variable, once somebody has asked."""

    def __init__(self, execution: Executor, surroundings: ConditionContext) -> None:
        self._execution, self._around = execution, surroundings
        self._known: Mapping[str, list[Reading]] | None = None

    def conditions_on(self, name: str) -> Iterator[TracedReaderView]:
        """Yield the conditions that read a variable, also by way of flags, and what the supervisor adds to starts."""
        automaton, state = self._execution.automaton, self._execution.state
        if self._known is None:
            self._known = _readings(automaton)
        for reading in (*self._known.get(name, ()), *self._guards(name)):
            tree = condition_tree(automaton, reading.condition, state)
            said = sentences_of(automaton).tell_so([reading.condition], print_expression(reading.condition))
            yield TracedReaderView.model_validate(
                {
                    "of": reading.of,
                    "name": reading.name,
                    "title": reading.title,
                    "part": reading.part,
                    "sentence": message("sentence.so", condition=said),
                    "holds": tree.holds,
                    "decides": _decides(automaton, tree, name),
                }
            )

    def _guards(self, name: str) -> Iterator[Reading]:
        """Yield what the supervisor adds; it is known a while after the station has begun."""
        automaton = self._execution.automaton
        for each, guard in self._around.guards().items():
            ability, condition = automaton.abilities.get(each), guard.expression
            if ability is not None and condition is not None and name in read_variables(automaton, (condition,)):
                yield Reading("ability", each, ability.title, "supervisor", condition)


def _decides(automaton: Automaton, tree: ConditionTree, name: str) -> bool:
    """Return whether a leaf that decides reads a variable."""
    if not tree.decides:
        return False
    if not tree.parts:
        return name in read_variables(automaton, (tree.condition,))
    return any(_decides(automaton, part, name) for part in tree.parts)


def _readings(automaton: Automaton) -> Mapping[str, list[Reading]]:
    """The conditions of the model that read each variable."""
    found: dict[str, list[Reading]] = defaultdict(list)
    for reading in _conditions(automaton):
        for name in read_variables(automaton, (reading.condition,)):
            found[name].append(reading)
    return found


def _conditions(automaton: Automaton) -> Iterator[Reading]:
    """Yield all conditions of the model that are not constant."""
    for ability in automaton.abilities.values():
        written = {
            "enabled": ability.enabled,
            "start": ability.start_guard,
            "executing": ability.executing,
            "finish": ability.finish_guard,
        }
        for part, condition in written.items():
            if condition is not None and not isinstance(condition, Constant):
                yield Reading("ability", ability.name, ability.title, part, condition)
    for operation in automaton.operations.values():
        for part, condition in (("precondition", operation.precondition), ("goal", operation.goal)):
            if not isinstance(condition, Constant):
                yield Reading("operation", operation.name, operation.title, part, condition)
    for specification in automaton.specifications.values():
        yield Reading("specification", specification.name, specification.title, "forbidden", specification.forbidden)
    for alarm in automaton.alarms.values():
        title = alarm.title.get("") or alarm.title.get("en") or alarm.name
        yield Reading("alarm", alarm.name, title, "when", alarm.when)
