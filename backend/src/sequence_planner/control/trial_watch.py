"""What has come of the last trial of an ability: its run from the start to the end, and the reactions of its device."""

from __future__ import annotations

from dataclasses import dataclass, field

from sequence_planner.automaton.structure import Ability, Automaton, Effect, State
from sequence_planner.automaton.tick import effect_writes
from sequence_planner.control.conduct import LastErrand
from sequence_planner.control.errand import Errand
from sequence_planner.control.execution import Execution
from sequence_planner.control.happenings import ErrandTaken, Ticked
from sequence_planner.control.heard import Heard, TickOutcome
from sequence_planner.control.moment import Moment
from sequence_planner.expressions.types import Value


@dataclass
class Reaction:
    """An effect that may come: `lacking` are the values that it has still to bring since it has been `due`."""

    effect: Effect
    due: Moment | None = None
    came: Moment | None = None
    lacking: dict[str, Value] = field(default_factory=dict)

    def look(self, state: State, now: Moment) -> None:
        """Take note of a state; what comes one variable after the other is one reaction."""
        if self.due is None:
            written = effect_writes(self.effect, state) or {}
            self.lacking = {name: value for name, value in written.items() if state[name] != value}
            self.due = now if self.lacking else None
        elif self.came is None:
            self.lacking = {name: value for name, value in self.lacking.items() if state[name] != value}
            self.came = None if self.lacking else now


@dataclass
class Trial:
    """The course of a trial; `end` says how it ended."""

    errand: Errand
    ability: Ability
    reactions: list[Reaction]
    started: Moment | None = None
    executing: Moment | None = None
    end: LastErrand | None = None


class TrialWatch:
    """Listens to an execution for trials. What a device still does after one counts, until something else starts."""

    def __init__(self, execution: Execution) -> None:
        self._execution = execution
        self.last: Trial | None = None
        self._looks = False
        execution.listeners.append(self._hear)

    def _hear(self, heard: Heard) -> None:
        match heard.happening:
            case ErrandTaken(errand):
                self._end()
                self._looks = False
                if errand.ability is not None:
                    self._begin(errand, errand.ability)
            case Ticked(now=now) if heard.outcome is not None:
                self._note(heard.outcome, heard.after, now)
                self._end()
            case _:
                self._end()

    def _begin(self, errand: Errand, name: str) -> None:
        automaton = self._execution.automaton
        self.last = Trial(errand, automaton.abilities[name], [Reaction(each) for each in reactions(automaton, name)])
        self._looks = True

    def _end(self) -> None:
        trial, execution = self.last, self._execution
        if trial is not None and trial.end is None and execution.errand is not trial.errand:
            trial.end = execution.conduct.last_errand

    def _note(self, outcome: TickOutcome, state: State, now: Moment) -> None:
        trial = self.last
        if trial is None or not self._looks:
            return
        if trial.started is None:
            if trial.ability.name not in outcome.started:
                return
            trial.started = now
        elif outcome.started:
            self._looks = False  # what comes from now on may have another cause
            return
        if trial.executing is None and state[trial.ability.flag("executing")] is True:
            trial.executing = now
        for reaction in trial.reactions:
            reaction.look(state, now)


def reactions(automaton: Automaton, ability: str) -> list[Effect]:
    """The effects that are written with an ability."""
    effects = {effect.name: effect for effect in automaton.effects}
    return [effects[name] for name in automaton.reactions.get(ability, ())]
