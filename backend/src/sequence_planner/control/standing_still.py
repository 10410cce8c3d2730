"""What devices should have done by themselves, and have not for longer than anything of theirs may take.

A run that is overdue says that its device does not react. A device can stand still without any: a robot that was pushed
off its pose, for instance, when nothing was about to move it.
"""

from __future__ import annotations

from math import inf

from sequence_planner.automaton.structure import Automaton, Effect, State, reads, target
from sequence_planner.automaton.tick import effect_writes
from sequence_planner.control.execution import Execution
from sequence_planner.control.happenings import Ticked
from sequence_planner.control.heard import Heard
from sequence_planner.control.view import Production
from sequence_planner.expressions.syntax import variables
from sequence_planner.planning.advice.stalling import changes_something


class StandingStill:
    """Listens to an execution for what could happen at its devices, and since when.

    Only what is told the devices counts, so nothing does before production is started; nor does what people do.
    """

    def __init__(self, execution: Execution) -> None:
        self._execution = execution
        self._patience = _patience(execution.automaton)
        self._effects = {
            effect.name: effect
            for effect in execution.automaton.effects
            if effect.resource in self._patience and not effect.fault
        }
        self._about: dict[str, set[str]] = {}  # variable: the effects that read or write it
        for effect in self._effects.values():
            acted = (name for action in effect.actions for name in (target(action), *reads(action)))
            for name in {*variables(effect.guard), *acted}:
                self._about.setdefault(name, set()).add(effect.name)
        self._since: dict[str, float] = {}
        self._seen: State = {}
        execution.listeners.append(self._hear)

    def late(self, monotonic: float, most: float = inf) -> frozenset[str]:
        """The effects that have been possible for too long, and would have changed something.

        No more patience than `most` is had with any, as long as it has had twice the time that it takes.
        """

        def patience(effect: Effect) -> float:
            return max(min(most, self._patience[effect.resource]), 2 * effect.longest)

        since = self._since.items()
        return frozenset(name for name, moment in since if monotonic - moment > patience(self._effects[name]))

    def devices(self, monotonic: float, most: float = inf) -> dict[str, frozenset[str]]:
        """The resources whose devices are late, each with the measured variables that should have changed."""
        found: dict[str, frozenset[str]] = {}
        for name in self.late(monotonic, most):
            effect, state = self._effects[name], self._execution.state
            should = {n for n, value in (effect_writes(effect, state) or {}).items() if state[n] != value}
            found[effect.resource] = found.get(effect.resource, frozenset()) | should
        return found

    def _hear(self, heard: Heard) -> None:
        if not isinstance(heard.happening, Ticked):
            return
        if self._execution.production is not Production.STARTED:
            self._since, self._seen = {}, {}
            return
        before, self._seen = self._seen, dict(heard.after)
        changed = {name for name in self._about if name not in before or before[name] != heard.after[name]}
        for name in frozenset[str]().union(*(self._about[each] for each in changed)):
            self._since.pop(name, None)
            if changes_something(self._effects[name], heard.after):
                self._since[name] = heard.happening.now.monotonic


def _patience(automaton: Automaton) -> dict[str, float]:
    """For each resource how long its slowest ability may take; none where that is not said, or a person does it."""
    patience: dict[str, float] = {}
    for ability in automaton.abilities.values():
        if ability.human is None and ability.timeouts.finish is not None:
            patience[ability.resource] = max(patience.get(ability.resource, 0.0), ability.timeouts.finish)
    return patience
