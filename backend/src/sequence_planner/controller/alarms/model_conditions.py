"""Alarms that the model declares: raised and cleared by conditions on the state."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from sequence_planner.automaton.automaton import AlarmDeclaration, Automaton, State
from sequence_planner.automaton.compiler import closure
from sequence_planner.controller.alarms.kinds import MODEL, Cause
from sequence_planner.controller.views.station import Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.language.syntax import variables
from sequence_planner.texts.message import Argument, Wording


class ModelAlarms:
    """Looks at the state of `execution` for what the alarms of its model say.

    An alarm is raised once its condition has held for its delay, and cleared once it does not hold. What is unknown
    neither raises an alarm nor clears one: whose values are not known has an alarm of its own.
    """

    def __init__(self, execution: Executor) -> None:
        self._execution = execution
        automaton = execution.automaton
        self._alarms = [_Declared(automaton, alarm) for alarm in automaton.alarms.values()]

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of those that are raised now."""
        state = self._execution.state
        return (alarm.cause for alarm in self._alarms if alarm.is_raised(state, moment.monotonic))


class _Declared:
    def __init__(self, automaton: Automaton, alarm: AlarmDeclaration) -> None:
        self._holds: Callable[[State], bool | None] = closure(alarm.when)
        self._delay = alarm.delay
        self._since: float | None = None  # since when the condition has held
        self._raised = False
        resources = {each.resource for name in variables(alarm.when) if (each := automaton.variables.get(name))}
        cause = MODEL.cause(
            alarm.name,
            {
                "title": _said(alarm.title),
                "consequence": _said(alarm.consequence),
                "action": _said(alarm.action),
            },
            resources=[alarm.resource] if alarm.resource else sorted(filter(None, resources)),
        )
        self.cause = replace(cause, priority=Priority(alarm.priority))

    def is_raised(self, state: State, monotonic: float) -> bool:
        """Whether it is to be told now."""
        holds = self._holds(state)
        if holds is False:
            self._since, self._raised = None, False
        elif holds:
            self._since = monotonic if self._since is None else self._since
            self._raised = self._raised or monotonic - self._since >= self._delay
        return self._raised


def _said(words: Mapping[str, str]) -> Argument:
    return words[""] if "" in words else Wording(words) if words else ""
