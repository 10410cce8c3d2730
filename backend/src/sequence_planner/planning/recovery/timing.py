"""Estimates of time: how long a plan takes, and when each of its starts comes at the earliest."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, State, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.tick import effect_writes, finish, start, start_guard_holds, synchronise
from sequence_planner.planning.problem import Plan, PlanTick
from sequence_planner.planning.recovery.manual_plans import changes_something


def expected_seconds(automaton: Automaton, ticks: Iterable[PlanTick]) -> float:
    """Estimate how long a plan takes when each device needs the middle of the time its effects are declared with."""
    takes = {effect.name: _middle(effect) for effect in automaton.effects}
    return sum(max((takes[name] for name in tick.effects), default=0.0) for tick in ticks)


def estimated_times(automaton: Automaton, plan: Plan, state: State) -> list[tuple[float, float]]:
    """Estimate when each start of a plan from `state` comes and when it is over, in seconds after the plan begins.

    A plan goes from tick to tick, an execution does not: it starts what it may as soon as that is possible,
    whatever else is still under way. So effects take the time that they are declared with, one beside the other,
    and a start comes once it is possible, after what it has to do with of all before it in the plan. A run is over
    with the last effect of its resource before that is started again, or else as long as the model says: so also
    where the plan ends before it does.
    """
    course = _Course(automaton, plan, state)
    course.go()
    return course.times()


def _middle(effect: Effect) -> float:
    return (effect.shortest + effect.longest) / 2


@dataclass
class _Course:
    """A plan as it comes about in time."""

    automaton: Automaton
    plan: Plan
    state: State
    now: float = 0.0
    began: dict[int, float] = field(default_factory=dict)  # by the number of the start
    happened: list[tuple[float, str]] = field(default_factory=list)  # effects of which resource, and when

    def __post_init__(self) -> None:
        """Begin with all that the plan has."""
        effects = {effect.name: effect for effect in self.automaton.effects}
        self._ahead = [(tick, self.automaton.abilities[name]) for tick, name in self.plan.starts]
        ticks = enumerate(self.plan.ticks, start=1)
        self._effects = [(number, effects[name]) for number, tick in ticks for name in tick.effects]
        self._due: dict[str, float] = {}
        self._touched: dict[str, tuple[frozenset[str], frozenset[str]]] = {}

    def go(self) -> None:
        """Let things come about one after the other, until nothing of the plan does any more."""
        self._settle()
        while self._due:
            name = min(self._due, key=lambda each: (self._due[each], each))
            self.now = self._due.pop(name)
            place = next(place for place, (_, each) in enumerate(self._effects) if each.name == name)
            _, effect = self._effects.pop(place)
            self.state = {**self.state, **(effect_writes(effect, self.state) or {})}
            self.happened.append((self.now, effect.resource))
            self._settle()

    def _settle(self) -> None:
        """What is at its end finishes, what may start does, and devices begin to react."""
        self.state = synchronise(self.automaton, finish(self.automaton, self.state).state)
        while self._starts():
            pass
        for _, effect in self._effects:
            if effect.name not in self._due and changes_something(effect, self.state):
                self._due[effect.name] = self.now + _middle(effect)

    def _starts(self) -> bool:
        """Start the first that may start, and return whether one did; none passes what it has to do with."""
        waiting: list[Ability] = []
        for number, (tick, ability) in enumerate(self._ahead):
            if number in self.began:
                continue
            effects = (effect for place, effect in self._effects if place <= tick)
            free = not any(self._depend(ability, each) for before in (effects, waiting) for each in before)
            after = None
            if free and start_guard_holds(ability, self.state):
                after = start(self.automaton, self.state, ability)
            if after is not None:
                self.began[number], self.state = self.now, after
                return True
            waiting.append(ability)
        return False

    def _depend(self, one: Ability, other: Ability | Effect) -> bool:
        """Return whether one of them may change what the other reads or changes."""
        (reads, writes), (others_reads, others_writes) = self._touches(one), self._touches(other)
        return bool(writes & others_reads or others_writes & reads or writes & others_writes)

    def _touches(self, each: Ability | Effect) -> tuple[frozenset[str], frozenset[str]]:
        """What decides on it, and what it may change: a run all of its resource, and what it writes."""
        if each.name not in self._touched:
            if isinstance(each, Effect):
                guards, actions, own = [each.guard], each.actions, set[str]()
            else:
                guards = [each.enabled, each.start_guard, each.executing]
                guards += [] if each.finish_guard is None else [each.finish_guard]
                actions = (*each.start_actions, *each.finish_actions)
                own = {name for name, of in self.automaton.variables.items() if of.resource == each.resource}
            written = own | {target(action) for action in actions}
            self._touched[each.name] = read_variables(self.automaton, guards), frozenset(written)
        return self._touched[each.name]

    def times(self) -> list[tuple[float, float]]:
        """When each start comes, and when it is over; those that never came are told as coming after all that did."""
        begins = [self.began.get(number, self.now) for number in range(len(self._ahead))]
        return [(begins[number], self._end(number, each, begins)) for number, (_, each) in enumerate(self._ahead)]

    def _end(self, number: int, ability: Ability, begins: Sequence[float]) -> float:
        later = (at for at, (_, each) in enumerate(self._ahead) if at > number and each.resource == ability.resource)
        again = next(later, None)
        until = self.now if again is None else begins[again]
        begin, lasts = begins[number], 0.0 if ability.duration is None else sum(ability.duration) / 2
        ends = [at for at, resource in self.happened if resource == ability.resource and begin <= at <= until]
        return ends[-1] if ends and again is not None else max([*ends, begin + lasts])
