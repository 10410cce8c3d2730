"""What a person could change: estimates that are wrong, what stands at a device, and what is out of service.

The more plausible an act is, the lower its `rank`: most of all, what a device should have done by itself, or that it is
back; then what the model names as a fault, such as a person who takes over; and least of all, what would not stay: that
a robot is on its way is nothing to see to, as it arrives by itself then.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from enum import StrEnum

from sequence_planner.automaton.structure import Automaton, Effect, Kind, State, target
from sequence_planner.automaton.tick import effect_writes, writes
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Constant, Variable
from sequence_planner.expressions.types import Value, contains
from sequence_planner.immutable import Immutable
from sequence_planner.planning.advice.situation import Situation

_HAPPENS, _EXPECTED, _FAULT, _INITIAL, _CAN_BE, _ESTIMATED, _UNLIKELY, PASSING = range(8)
LIKELY = _FAULT  # acts of this rank, or a lower one, are tried before anything that takes long


class ActKind(StrEnum):
    """Where something is changed."""

    ESTIMATE = "estimate"  # in what is believed
    DEVICE = "device"  # measured variables, at a device
    RETURN = "return"  # a resource is back online, and says what it last said
    SERVICE = "service"  # an ability is back in service


class Act(Immutable):
    """One thing that a person does; `name` is the variable, resource or ability that it is about."""

    kind: ActKind
    name: str
    values: tuple[tuple[str, Value], ...]
    rank: int


class Options:
    """The acts that make sense at one station."""

    def __init__(self, automaton: Automaton, effects: tuple[Effect, ...]) -> None:
        """`effects` are all that devices are known to do, also what nobody counts on."""
        self._automaton = automaton
        self._effects = [(effect, frozenset(map(target, effect.actions))) for effect in effects]

    def acts(
        self, here: Situation, last: Mapping[str, Value], fixed: frozenset[str], aside: frozenset[str] = frozenset()
    ) -> list[Act]:
        """All of them, the most plausible first, but those at devices that change nothing but variables `aside`.

        Of what is unknown only a resource that comes back says more.
        """
        acts = [*self._corrections(here.state, fixed), *self._physical(here, fixed), *self._back(here, last, fixed)]
        different: dict[object, Act] = {}
        for act in sorted(acts, key=lambda act: act.rank):
            same = act.values if act.kind is ActKind.DEVICE else act.name  # other variables may ask for the same
            if act.kind is not ActKind.DEVICE or not aside.issuperset(name for name, _ in act.values):
                different.setdefault((act.kind, same, act.values), act)
        return list(different.values())

    def _corrections(self, state: State, fixed: frozenset[str]) -> Iterator[Act]:
        for name in self._automaton.names(Kind.ESTIMATED):
            if name not in fixed:
                for value in self._others(state, name):
                    yield Act(ActKind.ESTIMATE, name, ((name, value),), _ESTIMATED)

    def _physical(self, here: Situation, fixed: frozenset[str]) -> Iterator[Act]:
        """For each value of a measured variable what effects would do with it too, and then that alone."""
        offline = here.circumstances.offline
        given_up = {ability.partition("(")[0] for ability in here.circumstances.barred}
        for name in self._automaton.names(Kind.MEASURED):
            declared = self._automaton.variables[name]
            if name in fixed or declared.resource in offline:
                continue
            for value in self._others(here.state, name):
                together: dict[frozenset[tuple[str, Value]], int] = {}
                for effect, changed in self._effects:
                    if name in changed and changed.isdisjoint(fixed) and not self._touches(changed, offline):
                        awaited = effect.name.rpartition(".")[0] in given_up
                        self._add(together, effect, name, value, here.state, awaited=awaited)
                alone = frozenset({(name, value)})
                together.setdefault(alone, _INITIAL if value == declared.initial and not together else _UNLIKELY)
                for values, rank in together.items():
                    rank = PASSING if self._passes(dict(values), here.state) else rank
                    yield Act(ActKind.DEVICE, name, tuple(sorted(values, key=str)), rank)

    def _passes(self, values: dict[str, Value], state: State) -> bool:
        """Whether devices change one of the values by themselves then."""
        after = {**state, **values}
        for effect, changed in self._effects:
            if not effect.fault and not changed.isdisjoint(values):
                written = effect_writes(effect, after) or {}
                if any(written.get(name, value) != value for name, value in values.items()):
                    return True
        return False

    def _touches(self, names: frozenset[str], resources: frozenset[str]) -> bool:
        return any(self._automaton.variables[name].resource in resources for name in names)

    def _add(
        self,
        together: dict[frozenset[tuple[str, Value]], int],
        effect: Effect,
        name: str,
        value: Value,
        state: State,
        *,
        awaited: bool,
    ) -> None:
        """What `effect` writes where it gives `name` this value, be it enabled or not. One that is `awaited` has not
        come for so long that its ability was given up.
        """
        written = effect_writes(effect, state)
        if written is not None and written.get(name) == value:
            rank = _HAPPENS
        else:
            written = self._shaped(effect, name, value, state)
            expected = {target(action): action.value for action in effect.actions}[name]
            follows = isinstance(expected, Variable) and state[expected.name] == value
            rank = _EXPECTED if follows or awaited else _CAN_BE
        if effect.fault:
            rank = max(rank, _FAULT)
        if written is not None:
            changed = frozenset((n, v) for n, v in written.items() if state[n] is not None and state[n] != v)
            if (name, value) in changed:
                together[changed] = min(rank, together.get(changed, rank))

    def _shaped(self, effect: Effect, name: str, value: Value, state: State) -> dict[str, Value] | None:
        """All that the effect would write if it wrote this; None if it never does."""
        if any(action.condition is not None for action in effect.actions):
            return None
        source = {target(action): action.value for action in effect.actions}[name]
        assumed = dict(state)
        match source:
            case Constant(constant) if constant == value:
                pass
            case Variable(other) if value in self._automaton.types[other].domain:
                assumed[other] = value
            case _:
                return None
        written: dict[str, Value] = {}
        for action in effect.actions:
            result = evaluate(action.value, assumed)
            if result is None or result not in self._automaton.variables[target(action)].type.domain:
                return None
            written[target(action)] = result
        return written

    def _back(self, here: Situation, last: Mapping[str, Value], fixed: frozenset[str]) -> Iterator[Act]:
        automaton, state = self._automaton, here.state
        for resource in automaton.resources:
            unknown = [n for n in automaton.names(Kind.MEASURED) if state[n] is None and self._is_of(n, resource)]
            known = tuple((name, last[name]) for name in unknown if name in last and name not in fixed)
            if resource in here.circumstances.offline or known:
                yield Act(ActKind.RETURN, resource, known, _EXPECTED)
                for values, rank in self._meanwhile({**state, **dict(known)}, frozenset(unknown) - fixed):
                    yield Act(ActKind.RETURN, resource, tuple({**dict(known), **values}.items()), rank)
        for ability in sorted(here.circumstances.barred):
            yield Act(ActKind.SERVICE, ability, (), _EXPECTED)

    def _meanwhile(self, state: State, names: frozenset[str]) -> Iterator[tuple[dict[str, Value], int]]:
        """What an effect on nothing but `names`, or a hand, may have brought about while nobody heard of it."""
        for effect, changed in self._effects:
            written = writes(effect.actions, state) if changed <= names else None
            if written is None or not all(self._can_be(name, value) for name, value in written.items()):
                continue  # its guard, of which nobody knows whether it held, would have excluded that
            if any(state[name] != value for name, value in written.items()):
                follows = any(isinstance(action.value, Variable) for action in effect.actions)
                yield written, _EXPECTED if follows else _CAN_BE

    def _can_be(self, name: str, value: Value) -> bool:
        return contains(self._automaton.variables[name].type, value)

    def _is_of(self, name: str, resource: str) -> bool:
        return self._automaton.variables[name].resource == resource

    def _others(self, state: State, name: str) -> Iterator[Value]:
        if state[name] is not None:
            yield from (value for value in self._automaton.variables[name].type.domain if value != state[name])
