"""The variables that decide a condition, as they are now, and who could change them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

from sequence_planner.automaton.structure import Kind
from sequence_planner.control.execution import Execution
from sequence_planner.control.hindrances import Hindrance
from sequence_planner.control.responsible import changers, responsible, wanted
from sequence_planner.control.view import BeliefView
from sequence_planner.control.why_not_view import ChangerView, ConditionView, InvolvedView
from sequence_planner.expressions.syntax import Expression
from sequence_planner.expressions.types import Value
from sequence_planner.synthesis.guards import Guard

MOST_CHANGERS = 20  # abilities that are listed for a variable


class TellsBelief(Protocol):
    """Who knows where an estimate comes from."""

    def of(self, name: str) -> BeliefView:
        """Of an estimated variable."""
        ...


@dataclass(frozen=True)
class Surroundings:
    """What is known beside the execution: topics by measured variable, since when a variable has its value, what is
    believed, and the guards that the supervisor has added, by ability.
    """

    feeds: Mapping[str, str]
    since: Callable[[str], float | None]
    beliefs: TellsBelief
    guards: Callable[[], Mapping[str, Guard]]


class Involving:
    """Shows conditions on `execution`."""

    def __init__(self, execution: Execution, surroundings: Surroundings) -> None:
        self._execution = execution
        self._around = surroundings

    def condition(self, hindrance: Hindrance) -> ConditionView:
        """What has to be otherwise, and who could see to that."""
        condition, execution = hindrance.expression, self._execution
        names = () if condition is None else responsible(execution.automaton, condition, execution.state)
        involved = [] if condition is None else [self._involved(name, condition) for name in names]
        return ConditionView(kind=str(hindrance.kind), text=hindrance.text, involved=involved)

    def _involved(self, name: str, condition: Expression) -> InvolvedView:
        automaton, state = self._execution.automaton, self._execution.state
        variable = automaton.variables[name]
        values = wanted(automaton, condition, state, name)
        belief = self._around.beliefs.of(name) if variable.kind is Kind.ESTIMATED else None
        return InvolvedView(
            name=name,
            kind=str(variable.kind),
            resource=variable.resource,
            value=state[name],
            wanted=list(values),
            since=self._around.since(name),
            topic=self._around.feeds.get(name),
            unconfirmed_since=None if belief is None else belief.unconfirmed_since,
            changers=[*(self._abilities(name, values) if state[name] is not None else ()), *self._people(name)],
        )

    def _abilities(self, name: str, values: tuple[Value, ...]) -> list[ChangerView]:
        running = self._execution.running()
        found = [
            ChangerView(how=each.how, name=each.ability.name, title=each.ability.title, running=is_running)
            for each in changers(self._execution.automaton, name, values)
            for is_running in (each.ability.name in running,)
        ]
        return sorted(found, key=lambda changer: not changer.running)[:MOST_CHANGERS]

    def _people(self, name: str) -> list[ChangerView]:
        """What a person could do about it."""
        automaton = self._execution.automaton
        variable = automaton.variables[name]
        resource = variable.resource or ""
        title = automaton.resources.get(resource, automaton.title)
        match variable.kind:
            case Kind.ESTIMATED:
                return [ChangerView(how="correction", name=name, title=f"correct {name}", running=False)]
            case Kind.OUTPUT:
                return [ChangerView(how="force", name=name, title=f"force {name}", running=False)]
            case Kind.MEASURED if self._execution.state[name] is None:
                topic = self._around.feeds.get(name, name)
                return [ChangerView(how="message", name=topic, title=f"a message on {topic}", running=False)]
            case Kind.MEASURED:
                return [ChangerView(how="device", name=resource, title=f"at {title}", running=False)]
            case Kind.ACTIVITY:
                return []
