"""What devices should have done by themselves, and have not for several times as long as it ever takes.

A run that is overdue says that its device does not react, but only once the run has had all the time that it may take.
And a device can stand still without any: a robot that was pushed off its pose, for instance, when nothing was about to
move it. What is late can be so because of another device: then that one is, however much patience there would be.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sequence_planner.automaton.structure import Ability, Automaton, Effect, State, reads, target
from sequence_planner.automaton.tick import effect_writes
from sequence_planner.control.culprits import Culprits
from sequence_planner.control.execution import Execution
from sequence_planner.control.happenings import Ticked
from sequence_planner.control.heard import Heard
from sequence_planner.control.timeouts import overdue
from sequence_planner.control.vocabulary import Production
from sequence_planner.expressions.syntax import variables
from sequence_planner.planning.advice.stalling import changes_something

# The patience with a device: seconds at least, and times as long as what it does ever takes.
_EASE = 10.0, 3.0
_HURRY = 5.0, 2.0  # while the state is unsafe
_SAYS_WITHIN = 1.0  # seconds in which a device says what has become of it


class StandingStill:
    """Listens to an execution for what could happen at its devices, and since when.

    Only what is told the devices counts, so nothing does before production is started; nor does what people do. Where
    the state is `unsafe` there is less patience: a device that is late for it is why.
    """

    def __init__(self, execution: Execution, unsafe: Callable[[], bool] = lambda: False) -> None:
        self._execution = execution
        self._unsafe = unsafe
        self._patience = _patience(execution.automaton)
        self._effects = {
            effect.name: effect
            for effect in execution.automaton.effects
            if effect.resource in self._patience and not effect.fault
        }
        self._culprits = Culprits(execution.automaton, self._effects)
        self._about: dict[str, set[str]] = {}  # variable: the effects that read or write it
        for effect in self._effects.values():
            acted = (name for action in effect.actions for name in (target(action), *reads(action)))
            for name in {*variables(effect.guard), *acted}:
                self._about.setdefault(name, set()).add(effect.name)
        self._since: dict[str, float] = {}
        self._seen: State = {}
        self._blamed: tuple[object, Mapping[str, frozenset[str]]] = (None, {})
        execution.listeners.append(self._hear)

    def late(self, monotonic: float) -> Mapping[str, frozenset[str]]:
        """The effects that are to blame for what is late, each with those that it explains: these should have happened
        by now too, but would not have to if it had.
        """
        least, times = _HURRY if self._unsafe() else _EASE
        over = self._for_longer(monotonic, lambda each: min(max(least, times * each.longest), self._most(each)))
        runs = self._overdue(monotonic)
        if not over and not runs:
            return {}
        slow = self._slow(monotonic)
        about = (self._execution.revision, over, slow, tuple(ability.name for ability in runs))
        if about != self._blamed[0]:
            since, state = {name: self._since[name] for name in slow | over}, self._execution.state
            of_runs = frozenset[str]().union(*(self._culprits.of_run(ability, state, since) for ability in runs))
            found: dict[str, set[str]] = {name: set() for name in of_runs}
            for name in over:
                found.setdefault(self._culprits.of_effect(name, state, since), set()).add(name)
            self._blamed = about, {name: frozenset(explained - {name}) for name, explained in found.items()}
        return self._blamed[1]

    def stalled(self, monotonic: float) -> frozenset[str]:
        """The effects that nobody can count on."""
        late = self.late(monotonic)
        return frozenset(late).union(*late.values())

    def explained_effects(self, monotonic: float) -> frozenset[str]:
        """Those among them that are none of their own devices' fault."""
        late = self.late(monotonic)
        return frozenset[str]().union(*late.values()) - late.keys()

    def devices(self, monotonic: float) -> dict[str, frozenset[str]]:
        """The resources whose devices are to blame, each with the measured variables that should have changed."""
        found: dict[str, frozenset[str]] = {}
        for name in self.late(monotonic):
            found[self._resource(name)] = found.get(self._resource(name), frozenset()) | self._unchanged(name)
        return found

    def explained(self, monotonic: float) -> dict[str, tuple[frozenset[str], frozenset[str]]]:
        """The resources whose devices seem to be late and are not, each with the measured variables that should have
        changed, and the resources that are to blame.
        """
        late = self.late(monotonic)
        blamed = {self._resource(name) for name in late}
        found: dict[str, tuple[frozenset[str], frozenset[str]]] = {}
        for culprit, names in late.items():
            for name in names:
                if (resource := self._resource(name)) not in blamed:
                    says, because = found.get(resource, (frozenset[str](), frozenset[str]()))
                    found[resource] = says | self._unchanged(name), because | {self._resource(culprit)}
        return found

    def keeping(self, ability: Ability, monotonic: float) -> frozenset[str]:
        """The other resources whose devices keep a run of the ability from its end."""
        since = {name: self._since[name] for name in self._slow(monotonic)}
        culprits = self._culprits.of_run(ability, self._execution.state, since)
        return frozenset(map(self._resource, culprits))

    def has_to_act(self, ability: Ability) -> bool:
        """Whether there is something that the ability's own device should do so that a run of it goes on."""
        return self._culprits.has_to_act(ability, self._execution.state)

    def _most(self, effect: Effect) -> float:
        """The seconds after which its resource is late whatever else is so."""
        return max(self._patience[effect.resource], 2 * effect.longest)

    def _for_longer(self, monotonic: float, patience: Callable[[Effect], float]) -> frozenset[str]:
        since = self._since.items()
        return frozenset(name for name, moment in since if monotonic - moment > patience(self._effects[name]))

    def _slow(self, monotonic: float) -> frozenset[str]:
        """The effects that take longer than they ever do."""
        return self._for_longer(monotonic, lambda effect: effect.longest + _SAYS_WITHIN)

    def _resource(self, name: str) -> str:
        return self._effects[name].resource

    def _unchanged(self, name: str) -> frozenset[str]:
        state = self._execution.state
        written = effect_writes(self._effects[name], state) or {}
        return frozenset(each for each, value in written.items() if state[each] != value)

    def _overdue(self, monotonic: float) -> list[Ability]:
        abilities = self._execution.automaton.abilities
        running = ((step, abilities[step.ability]) for step in self._execution.plan.order.running)
        return [ability for step, ability in running if overdue(step, ability, monotonic)]

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
