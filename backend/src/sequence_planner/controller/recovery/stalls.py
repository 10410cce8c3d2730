"""Stall detection: overdue device effects, and the root cause among several late devices."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, State, reads, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.tick import effect_writes, synchronise
from sequence_planner.execution.events import Heard, Ticked
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.timeouts import overdue
from sequence_planner.execution.vocabulary import Production
from sequence_planner.language.syntax import variables
from sequence_planner.planning.recovery.manual_plans import changes_something

# Who is to blame where several devices are late: what the others only wait for, and what follows once it has happened.
#
# A device can seem late because another one is: a tool that is felt in the gripper should be lost, as the robot still
# says that it is elsewhere. Once the robot has said what it should have said long ago, there is nothing wrong with it.

_MOST_STEPS = 4  # of a device that goes on


class Culprits:
    """Consequences at the devices of one station, what follows from what: among `effects`, by name, those that are
    counted on.
    """

    def __init__(self, automaton: Automaton, effects: Mapping[str, Effect]) -> None:
        self._automaton = automaton
        self._effects = effects
        self._upstream: dict[str, frozenset[str]] = {}

    def of_effect(self, name: str, state: State, since: Mapping[str, float]) -> str:
        """The effect for whose absence this one has not happened; itself where it is its own device that is late.

        `since` are the effects that take longer than they ever do, with the moment from which they were possible: only
        what was to happen before is to blame.
        """
        seen = {name}
        while (earlier := self._explaining(name, state, since, seen)) is not None:
            seen.add(earlier)
            name = earlier
        return name

    def of_run(self, ability: Ability, state: State, since: Mapping[str, float]) -> frozenset[str]:
        """The effects for whose absence a run of the ability goes on; none where its own device is to blame, or nobody
        is known to be.
        """
        late = {self.of_effect(name, state, since) for name in self._led_to(ability) & since.keys()}
        own = any(ability.resource in self.silent(name, state) for name in late)
        return frozenset() if own else frozenset(late)

    def silent(self, name: str, state: State) -> dict[str, frozenset[str]]:
        """The resources that do not say yet what the effect brings, each with the variables that should have changed.

        The device that brings it about may be another one: a robot that is at its place has done its part where the
        tool that it has brought does not say so.
        """
        effect, found = self._effects[name], dict[str, set[str]]()
        for each, value in (effect_writes(effect, state) or {}).items():
            if state[each] != value:
                found.setdefault(self._automaton.variables[each].resource or effect.resource, set()).add(each)
        return {resource: frozenset(names) for resource, names in found.items()}

    def has_to_act(self, ability: Ability, state: State) -> bool:
        """Return whether there is something that the ability's own device should do so that a run of it goes on."""
        own = (self._effects[name] for name in self._led_to(ability))
        return any(each.resource == ability.resource and changes_something(each, state) for each in own)

    def _explaining(self, name: str, state: State, since: Mapping[str, float], seen: Collection[str]) -> str | None:
        effect = self._effects[name]
        for earlier in sorted(since.keys() - seen, key=lambda each: (since[each], each)):
            before = since[earlier] <= since.get(name, since[earlier])
            if before and self._effects[earlier].resource != effect.resource and self._ends(effect, earlier, state):
                return earlier
        return None

    def _ends(self, effect: Effect, earlier: str, state: State) -> bool:
        """Return whether there is nothing to be done by `effect` once the device of the `earlier` one has gone on."""
        device = [each for each in self._effects.values() if each.resource == self._effects[earlier].resource]
        due: Effect | None = self._effects[earlier]
        for _ in range(_MOST_STEPS):
            if due is None:
                return False
            state = synchronise(self._automaton, {**state, **(effect_writes(due, state) or {})})
            if not changes_something(effect, state):
                return True
            due = next((each for each in device if changes_something(each, state)), None)
        return False

    def _led_to(self, ability: Ability) -> frozenset[str]:
        """The effects that can lead to its end, also by what they make possible."""
        if ability.name not in self._upstream:
            guards = (ability.executing, *(() if ability.finish_guard is None else (ability.finish_guard,)))
            self._upstream[ability.name] = self._upstream_of(read_variables(self._automaton, guards))
        return self._upstream[ability.name]

    def _upstream_of(self, names: Iterable[str]) -> frozenset[str]:
        relevant, found = set(names), set[str]()
        while True:
            further = [
                effect
                for name, effect in self._effects.items()
                if name not in found and not relevant.isdisjoint(target(action) for action in effect.actions)
            ]
            if not further:
                return frozenset(found)
            for effect in further:
                found.add(effect.name)
                relevant |= read_variables(self._automaton, (effect.guard,))
                relevant.update(name for action in effect.actions for name in reads(action))


# What devices should have done by themselves, and have not for several times as long as it ever takes.
#
# A run that is overdue says that its device does not react, but only once the run has had all the time that it may
# take. And a device can stand still without any: a robot that was pushed off its pose, for instance, when nothing was
# about to move it. What is late can be so because of another device: then that one is, however much patience there
# would be.

# The patience with a device: seconds at least, and times as long as what it does ever takes.
_EASE = 10.0, 3.0
_HURRY = 5.0, 2.0  # while the state is unsafe
_SAYS_WITHIN = 1.0  # seconds in which a device says what has become of it


class StallDetector:
    """Listens to an execution for what could happen at its devices, and since when.

    Only what is told the devices counts, so nothing does before production is started; nor does what people do. Where
    the state is `unsafe` there is less patience: a device that is late for it is why.
    """

    def __init__(self, execution: Executor, unsafe: Callable[[], bool] = lambda: False) -> None:
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
            for resource, unchanged in self._silent(name).items():
                found[resource] = found.get(resource, frozenset()) | unchanged
        return found

    def explained(self, monotonic: float) -> dict[str, tuple[frozenset[str], frozenset[str]]]:
        """The resources whose devices seem to be late and are not, each with the measured variables that should have
        changed, and the resources that are to blame.
        """
        late = self.late(monotonic)
        blamed = {resource for name in late for resource in self._silent(name)}
        found: dict[str, tuple[frozenset[str], frozenset[str]]] = {}
        for culprit, names in late.items():
            for resource, unchanged in (each for name in names for each in self._silent(name).items()):
                if resource not in blamed:
                    says, because = found.get(resource, (frozenset[str](), frozenset[str]()))
                    found[resource] = says | unchanged, because.union(self._silent(culprit))
        return found

    def keeping(self, ability: Ability, monotonic: float) -> frozenset[str]:
        """The other resources whose devices keep a run of the ability from its end."""
        since = {name: self._since[name] for name in self._slow(monotonic)}
        culprits = self._culprits.of_run(ability, self._execution.state, since)
        return frozenset(resource for name in culprits for resource in self._silent(name))

    def has_to_act(self, ability: Ability) -> bool:
        """Return whether there is something that the ability's own device should do so that a run of it goes on."""
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

    def _silent(self, name: str) -> dict[str, frozenset[str]]:
        return self._culprits.silent(name, self._execution.state)

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
