"""What devices do that nothing commanded: somebody moved them by hand, or the model does not know them well enough.

A measured variable changed, and no effect of the model explains that from what the devices were told lately. It is
noted, with the ability by which the station went on; nothing else comes of it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from dataclasses import replace as replace_fields
from enum import StrEnum
from typing import Final

from pydantic import JsonValue

from sequence_planner.automaton.automaton import Ability, Kind, State
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.reactions import Reactions
from sequence_planner.controller.alarms.kinds import BY_HAND, Cause
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import Heard, Ticked, TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Production
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Value
from sequence_planner.pipelines.graph import GOAL_ON_ITS_WAY, StationPipelines
from sequence_planner.texts.message import Message, message

KIND: Final = BY_HAND.name  # of the records
LATENCY: Final = 2.0  # seconds for which a device may act on what it was told before, and that be on its way
STAYS: Final = 120.0  # seconds for which a notice stays after the station has gone on
LONGEST: Final = 900.0  # seconds for which it stays at most
_MOST_STATES: Final = 32  # of the last seconds

Tell = Callable[[str, Mapping[str, JsonValue]], None]


class WentOn(StrEnum):
    """The way in which the station went on."""

    EXECUTES = "executes"  # the ability is under way again, as it was commanded before
    FINISHED = "finished"  # it counts as finished by it
    STARTED = "started"  # it was started after it


@dataclass(frozen=True)
class Moved:
    """The measured variables of a resource that changed in a tick, each with its value before and after it.

    `by` is the ability by which the station went on, once it has, `how` it did, and `on` when.
    """

    resource: str
    values: Mapping[str, tuple[Value, Value]]
    at: Timestamp
    by: str | None = None
    how: WentOn | None = None
    on: Timestamp | None = None

    def lasts(self, monotonic: float) -> bool:
        """Return whether people are still told of it."""
        past = self.on is not None and monotonic - self.on.monotonic > STAYS
        return not past and monotonic - self.at.monotonic <= LONGEST


class ByHand:
    """Listens to `execution`; `tell` hears of each change that nothing explains, and of how the station went on."""

    def __init__(self, execution: Executor, pipelines: StationPipelines, tell: Tell) -> None:
        self._execution = execution
        self._tell = tell
        self._reactions = Reactions(execution.automaton, on_its_way(pipelines))
        self._begins_anew = frozenset(name for use in pipelines.answers.values() for name in use.variables)
        measured = frozenset(execution.automaton.names(Kind.MEASURED))
        self._watched = self._reactions.variables & measured & pipelines.feeds.keys()
        self._reading = {name: _read(ability) for name, ability in execution.automaton.abilities.items()}
        self._states: deque[tuple[float, State]] = deque(maxlen=_MOST_STATES)
        self._forced: frozenset[str] = frozenset()
        self._moved: dict[str, Moved] = {}
        execution.listeners.append(self._hear)

    def notices(self, monotonic: float) -> list[Moved]:
        """Return what people are told of now, the last of each resource."""
        self._moved = {name: moved for name, moved in self._moved.items() if moved.lasts(monotonic)}
        return list(self._moved.values())

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """One cause of an alarm for each resource that was last moved by hand."""
        automaton = self._execution.automaton
        said = sentences_of(automaton)
        for moved in self.notices(moment.monotonic):
            values = [
                # Of what is true or false it is clear what it was before.
                said.tell_value(name, after)
                if isinstance(before, bool)
                else message("by-hand.value", value=said.tell_value(name, after), before=said.call_value(name, before))
                for name, (before, after) in moved.values.items()
            ]
            resource = automaton.resources.get(moved.resource, moved.resource)
            yield BY_HAND.cause(
                moved.resource,
                {"resource": resource, "values": values, "went_on": self._how(moved)},
                resources=[moved.resource],
            )

    def _how(self, moved: Moved) -> Message:
        if moved.by is None:
            return message("by-hand.nothing")
        title = message("quoted", title=self._execution.automaton.abilities[moved.by].title)
        if moved.how is WentOn.EXECUTES:
            return message("by-hand.executes", ability=title)
        return message("by-hand.finished" if moved.how is WentOn.FINISHED else "by-hand.started", ability=title)

    def _hear(self, heard: Heard) -> None:
        happening, outcome = heard.happening, heard.outcome
        if not isinstance(happening, Ticked) or outcome is None:
            return
        now, forced = happening.now, frozenset(self._execution.conduct.forces)
        if self._execution.production is Production.STARTED:
            self._go_on(heard, outcome, now)
            self._look(heard, outcome, now, forced | self._forced)
        self._forced = forced
        self._remember(heard.after, now.monotonic)

    def _remember(self, state: State, monotonic: float) -> None:
        while len(self._states) > 1 and self._states[1][0] < monotonic - LATENCY:
            self._states.popleft()
        if not self._states or self._states[-1][1] is not state:
            self._states.append((monotonic, state))

    def _look(self, heard: Heard, outcome: TickOutcome, now: Timestamp, forced: frozenset[str]) -> None:
        found: dict[str, dict[str, tuple[Value, Value]]] = {}
        for name, before, after in self._changed(heard):
            if forced.isdisjoint(self._reactions.about(name)) and not self._is_explained(heard, name, after):
                resource = self._execution.automaton.variables[name].resource or ""
                found.setdefault(resource, {})[name] = (before, after)
        for resource, values in found.items():
            moved = Moved(resource, values, now)
            by, how = self._by(moved, heard, outcome, at_once=True)
            moved = self._moved[resource] = replace_fields(moved, by=by, how=how, on=now if how else None)
            changed: JsonValue = {name: [before, after] for name, (before, after) in values.items()}
            self._tell(KIND, {"resource": resource, "changed": changed, **_went_on(moved)})

    def _changed(self, heard: Heard) -> Iterator[tuple[str, Value, Value]]:
        for name in self._watched:
            before, after = heard.before[name], heard.after[name]
            if before is None or after is None or before == after:
                continue  # what a device has done that was not heard nobody knows
            if name in self._begins_anew and after == self._execution.automaton.variables[name].initial:
                continue  # as nothing is asked any more
            yield name, before, after

    def _is_explained(self, heard: Heard, name: str, after: Value) -> bool:
        explain = self._reactions.explain
        return explain((heard.before,), name, after) or explain(self._earlier(heard.before, name), name, after)

    def _earlier(self, before: State, name: str) -> Iterator[State]:
        """From where the device may have acted: told what it was lately, and being where it was seen last.

        What it does at once it may say one after the other, so of the others what they were lately counts too.
        """
        variables_ = self._execution.automaton.variables
        measured = {each: before[each] for each, v in variables_.items() if v.kind is Kind.MEASURED}
        for _, state in reversed(self._states):
            yield {**state, **measured}
            yield {**state, name: before[name]}

    def _go_on(self, heard: Heard, outcome: TickOutcome, now: Timestamp) -> None:
        for resource, moved in self._moved.items():
            if moved.how is not None:
                continue
            by, how = self._by(moved, heard, outcome)
            if how is not None:
                self._moved[resource] = gone = replace_fields(moved, by=by, how=how, on=now)
                self._tell(KIND, {"resource": resource, **_went_on(gone)})

    def _by(
        self, moved: Moved, heard: Heard, outcome: TickOutcome, at_once: bool = False
    ) -> tuple[str | None, WentOn | None]:
        """By which ability the station goes on, and how, if it does in this tick.

        In the tick of the change, `at_once`, what was under way and still is goes on too.
        """
        abilities = self._execution.automaton.abilities
        executing = [
            name
            for name, ability in abilities.items()
            if ability.resource == moved.resource
            and name not in outcome.started
            and heard.after[ability.flag("executing")] is True
            and (at_once or heard.before[ability.flag("executing")] is not True)
            and not self._reading[name].isdisjoint(moved.values)
        ]
        choices: tuple[tuple[WentOn, Collection[str]], ...] = (
            (WentOn.EXECUTES, executing),
            (WentOn.FINISHED, outcome.ended),
            (WentOn.STARTED, outcome.started),
        )
        for how, names in choices:
            for name in names:
                if abilities[name].resource == moved.resource or not self._reading[name].isdisjoint(moved.values):
                    return name, how
        return None, None


def on_its_way(pipelines: StationPipelines) -> dict[str, Collection[Value]]:
    """Return what a variable is on its way: between two named values, or a goal before it has come to its end."""
    named = {w.variable: (w.between,) for node in pipelines.nodes for w in node.writings if w.between is not None}
    goals = {name: GOAL_ON_ITS_WAY for use in pipelines.actions.values() for name in use.status.variables}
    return {**named, **goals}


def _went_on(moved: Moved) -> dict[str, JsonValue]:
    return {} if moved.by is None else {"by_ability": moved.by, "how": moved.how}


def _read(ability: Ability) -> frozenset[str]:
    """Return what decides whether the ability may start, executes, or has finished."""
    finish = () if ability.finish_guard is None else tuple(variables(ability.finish_guard))
    guards = (ability.enabled, ability.start_guard, ability.executing)
    return frozenset((*finish, *(name for guard in guards for name in variables(guard))))
