"""Runs of an automaton as evidence: what happens in each step, and the state after it.

Each step is taken on the reference (`automaton.tick`, `automaton.plain.steps`), so that a trace always replays.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Kind, State
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.tick import (
    apply_effects,
    effect_writes,
    finish,
    start,
    start_guard_holds,
    synchronise,
    writes,
)
from sequence_planner.automaton.transitions import Transition
from sequence_planner.language.evaluator import holds
from sequence_planner.language.printer import print_value
from sequence_planner.language.types import Value

Valuation = Mapping[str, Value]


class StepKind(StrEnum):
    """The kinds of what happens in a step."""

    TICK = "tick"  # steps 1 to 3 of a tick: effects are sensed, abilities finish
    START = "start"
    ACTIVITY = "activity"  # an operation becomes active, or is so no longer
    TRANSITION = "transition"  # of a plain automaton


_LABELS = {StepKind.TICK: "tick", StepKind.START: "start", StepKind.ACTIVITY: "operation", StepKind.TRANSITION: "step"}


@dataclass(frozen=True)
class TraceStep:
    """A step and the state after it.

    `names` are the effects of a tick, the ability that starts, the operation whose activity changes, or the transition
    of a plain automaton; `finished` are the abilities that finish, but for those that neither were executing nor change
    anything. `forbidden_by` names the specifications that the state breaks.
    """

    kind: StepKind
    names: tuple[str, ...]
    finished: tuple[str, ...]
    changes: Valuation
    state: State
    forbidden_by: tuple[str, ...]

    def line(self, number: int, names: bool = True) -> str:
        """`tick 2: x := true (effect)`; without `names` only what changes."""
        changed = ", ".join(f"{name} := {print_value(value)}" for name, value in self.changes.items()) or "no change"
        text = f"{_LABELS[self.kind]} {number}: "
        if not names:
            return text + changed
        if self.kind is StepKind.ACTIVITY:
            text += f"{changed}, as any operation may become active or be completed"
        elif self.kind is not StepKind.TICK:
            text += f"{self.names[0]}: {changed}"
        else:
            # Of several instances that are alike there is one effect, with arguments that say too much.
            causes = [", ".join(map(without_arguments, self.names))] if self.names else []
            causes += [f"{', '.join(self.finished)} finished"] if self.finished else []
            text += f"{changed} ({'; '.join(causes)})" if causes else changed
        return f"{text}, which {', '.join(self.forbidden_by)} forbids" if self.forbidden_by else text


@dataclass(frozen=True)
class Trace:
    """A run from an initial state. States have a value for each variable and flag.

    `forbidden_by` names the specifications that the initial state breaks.
    """

    initial: State
    forbidden_by: tuple[str, ...]
    steps: tuple[TraceStep, ...]

    @property
    def last(self) -> State:
        """The state in which it ends."""
        return self.steps[-1].state if self.steps else self.initial

    @property
    def breaks(self) -> tuple[str, ...]:
        """The specifications that are broken first on it."""
        return next(filter(None, (self.forbidden_by, *(step.forbidden_by for step in self.steps))), ())

    def and_then(self, *steps: TraceStep) -> Trace:
        """It, and then further steps."""
        return replace(self, steps=(*self.steps, *steps))

    def lines(self) -> list[str]:
        """A line for each step."""
        return [each.line(number) for number, each in enumerate(self.steps, start=1)]


@dataclass(frozen=True)
class Steps:
    """The single steps of `automaton`, of which only `effects` and `abilities` may happen, taken on the reference."""

    automaton: Automaton
    effects: Sequence[Effect]
    abilities: Sequence[Ability]

    def leading(self, state: State, wanted: Valuation) -> TraceStep:
        """A step from `state` to one with the values `wanted`; one must be there. Of ticks one with fewest effects."""
        return next(self._candidates(state, wanted))

    def tick(self, state: State, wanted: Valuation) -> TraceStep | None:
        """A tick after which the measured variables of `wanted` have these values; with as few effects as possible."""
        measured = [name for name in self.automaton.names(Kind.MEASURED) if name in wanted]
        changed = frozenset(name for name in measured if state[name] != wanted[name])
        covers: dict[str, frozenset[str]] = {}
        for effect in self.effects:
            written = effect_writes(effect, state) or {}
            if all(wanted.get(name, value) == value for name, value in written.items()):
                covers[effect.name] = changed & written.keys()
        names = _smallest_cover(changed, covers)
        sensed = None if names is None else apply_effects(state, [e for e in self.effects if e.name in names])
        if names is None or sensed is None:
            return None
        finishing = finish(self.automaton, sensed)
        after = synchronise(self.automaton, finishing.state)
        finished = [name for name in finishing.finished if self._worth_telling(name, sensed)]
        return self._step(StepKind.TICK, names, state, after, tuple(finished))

    def _worth_telling(self, name: str, sensed: State) -> bool:
        ability = self.automaton.abilities[name]
        written = writes(ability.finish_actions, sensed) or {}
        return sensed[ability.flag("executing")] is True or any(sensed[n] != value for n, value in written.items())

    def start(self, state: State, name: str) -> TraceStep | None:
        """The start `name`, or the transition of a plain automaton; None where its guard does not hold."""
        return next((each for each in self._starts(state) if each.names == (name,)), None)

    def turned(self, state: State, name: str) -> TraceStep | None:
        """The operation `name` becomes active, or is so no longer; None if there is none."""
        if name not in self.automaton.operations:
            return None
        activity = self.automaton.operations[name].activity
        after = synchronise(self.automaton, {**state, activity: not state[activity]})
        return self._step(StepKind.ACTIVITY, (name,), state, after)

    def _candidates(self, state: State, wanted: Valuation) -> Iterator[TraceStep]:
        for found in self._transitions(state) if self.automaton.one_at_a_time else self._of_station(state, wanted):
            if all(found.state[name] == value for name, value in wanted.items()):
                yield found

    def _starts(self, state: State) -> Iterator[TraceStep]:
        if self.automaton.one_at_a_time:
            yield from self._transitions(state)
            return
        for ability in self.abilities:
            if start_guard_holds(ability, state):
                started = start(self.automaton, state, ability)
                if started is not None:
                    yield self._step(StepKind.START, (ability.name,), state, started)

    def _transitions(self, state: State) -> Iterator[TraceStep]:
        counted = {*(effect.name for effect in self.effects), *(ability.name for ability in self.abilities)}
        for name, transition in self._plain.items():
            if name in counted and (after := step(state, transition)) is not None:
                yield self._step(StepKind.TRANSITION, (name,), state, after)

    def _of_station(self, state: State, wanted: Valuation) -> Iterator[TraceStep]:
        for operation in self.automaton.operations.values():
            activity = operation.activity
            if activity in wanted and state[activity] != wanted[activity]:
                turned = self.turned(state, operation.name)
                assert turned is not None
                yield turned
        if (ticked := self.tick(state, wanted)) is not None:
            yield ticked
        yield from self._starts(state)

    def _step(
        self, kind: StepKind, names: tuple[str, ...], before: State, after: State, finished: tuple[str, ...] = ()
    ) -> TraceStep:
        changes: dict[str, Value] = {}
        for name in self.automaton.variables:
            if (value := after[name]) is not None and before[name] != value:
                changes[name] = value
        return TraceStep(kind, names, finished, changes, after, forbidding(self.automaton, after))

    @cached_property
    def _plain(self) -> Mapping[str, Transition]:
        return plain_transitions(self.automaton)


def forbidding(automaton: Automaton, state: State) -> tuple[str, ...]:
    """The specifications that forbid `state`."""
    return tuple(each.name for each in automaton.specifications.values() if holds(each.forbidden, state))


def _smallest_cover(needed: frozenset[str], covers: Mapping[str, frozenset[str]]) -> tuple[str, ...] | None:
    """As few of `covers` as together have all of `needed`; None if there are none."""
    best: dict[frozenset[str], tuple[str, ...] | None] = {frozenset(): ()}

    def smallest(left: frozenset[str]) -> tuple[str, ...] | None:
        if left not in best:
            first = min(left)
            found: Iterable[tuple[str, ...]] = (
                (name, *rest)
                for name, covered in covers.items()
                if first in covered and (rest := smallest(left - covered)) is not None
            )
            best[left] = min(found, key=len, default=None)
        return best[left]

    return smallest(needed)
