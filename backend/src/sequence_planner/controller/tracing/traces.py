"""The trace of a variable: from the message that tells it to the messages that follow from it, or the other way."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.commands.command import CommandRefused, answers
from sequence_planner.controller.commands.queries import AskTrace
from sequence_planner.controller.features.variables import Variables
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.recovery.explain import ConditionContext, Involving
from sequence_planner.controller.tracing.passage import Passages
from sequence_planner.controller.tracing.readers import Readers
from sequence_planner.controller.tracing.schemas import TracedChangeView, TraceView
from sequence_planner.controller.views.wording import hint_of
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.texts.message import message

MOST_READERS = 60  # conditions that are told of a variable
MOST_CHANGES = 12  # other variables that are told


class Traces:
    """Answers about the variables of `execution`: nothing is kept for it but what each condition reads."""

    def __init__(
        self,
        execution: Executor,
        pipelines: StationPipelines,
        devices: Devices,
        variables: Variables,
        surroundings: ConditionContext,
    ) -> None:
        self._execution, self._variables, self._around = execution, variables, surroundings
        self._devices = devices
        self._passages = Passages(pipelines, devices.feeds, devices.commander)
        self._involving = Involving(execution, surroundings)
        self._readers = Readers(execution, surroundings)

    @answers(AskTrace)
    def trace(self, query: AskTrace) -> TraceView:
        """Return the trace of a variable. Raises `CommandRefused` for one that the station does not have."""
        automaton, name, moment = self._execution.automaton, query.name, Timestamp.now()
        variable = automaton.variables.get(name)
        if variable is None or variable.kind is Kind.ACTIVITY:
            known = [each for each, declared in automaton.variables.items() if declared.kind is not Kind.ACTIVITY]
            hint = hint_of(name, known)
            raise CommandRefused(
                "unknown-variable", message("refused.unknown-variable.name", name=name, hint=hint), 404
            )
        state = self._execution.state
        observed = self._devices.traffic(self._passages.on_the_way(name))
        readers, changes = list(self._readers.conditions_on(name)), list(self._changes(name, moment))
        abilities = automaton.abilities.values()
        return TraceView.model_validate(
            {
                "name": name,
                "kind": str(variable.kind),
                "resource": variable.resource,
                "value": state[name],
                "since": self._variables.since(name),
                "time": moment.epoch,
                "revision": self._execution.revision,
                "incoming": list(self._passages.incoming(name, observed, moment)),
                "outgoing": list(self._passages.outgoing(name, observed, moment)),
                "written_by": self._writer(name),
                "belief": self._around.beliefs.of(name) if variable.kind is Kind.ESTIMATED else None,
                "acknowledges": [
                    each.name for each in abilities if each.human is not None and each.human.acknowledgement == name
                ],
                "writers": self._involving.writers(name),
                "readers": readers[:MOST_READERS],
                "more_readers": max(0, len(readers) - MOST_READERS),
                "from_beginning": self._variables.since(name) in (None, self._variables.began),
                "changes": changes[:MOST_CHANGES],
                "more_changes": max(0, len(changes) - MOST_CHANGES),
            }
        )

    def _writer(self, name: str) -> str | None:
        """The ability that has written a variable, as far as that is known."""
        kind = self._execution.automaton.variables[name].kind
        if kind is Kind.OUTPUT:
            return self._variables.commanded_by(name)
        if kind is Kind.ESTIMATED:
            writer = self._around.beliefs.of(name).writer
            return writer if writer in self._execution.automaton.abilities else None
        return None

    def _changes(self, name: str, moment: Timestamp) -> Iterator[TracedChangeView]:
        """Yield what has another value since a variable has its own, in the order in which it came about."""
        automaton, since = self._execution.automaton, self._variables.since(name)
        if since is None:
            return
        found = [
            (when, other)
            for other, variable in automaton.variables.items()
            if other != name and variable.kind in (Kind.OUTPUT, Kind.ESTIMATED)
            if (when := self._variables.since(other)) is not None and when >= since and when != self._variables.began
        ]
        for when, other in sorted(found):
            yield TracedChangeView(
                name=other,
                value=self._execution.state[other],
                since=when,
                same_tick=when == since,
                by=self._writer(other),
                sent={topic: self._passages.sent(topic, moment) for topic in self._passages.carrying(other)},
            )
