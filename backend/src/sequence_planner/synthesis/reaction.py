"""The uncontrollable part of a tick over sets of states: all devices react, and all abilities finish, at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from oxidd.util import BooleanOperator

from sequence_planner.automaton.structure import Ability, Effect, target
from sequence_planner.expressions.syntax import Assignment
from sequence_planner.expressions.types import Value
from sequence_planner.synthesis.diagrams import Diagrams, Function, Lookup, Values
from sequence_planner.synthesis.reading import Reader
from sequence_planner.synthesis.steps import same

_AND = BooleanOperator.AND


@dataclass(frozen=True)
class Finish:
    """Where an ability finishes, and for each variable where it writes it, and which values."""

    guard: Function
    writes: Mapping[str, tuple[Function, Values]]


@dataclass(frozen=True)
class Part:
    """A relation between the values of variables now, and those of `decides` afterwards."""

    relation: Function
    decides: tuple[str, ...]


class Reaction:
    """Steps 1 to 3 of a tick: any set of compatible effects, then all finishes, on the state with the sensed values.

    Effects write measured variables, finishes the others. What is measured afterwards is chosen by relations, one for
    each group of effects that write common variables; all else is a function of the state before and of what is sensed,
    and so a relation, too. They are taken one after the other, so that sets stay small in between: each does away with
    what no other one asks for, values now or values afterwards (Burch et al. 1991, *Symbolic Model Checking with
    Partitioned Transition Relations*).
    """

    def __init__(
        self, diagrams: Diagrams, now: Reader, effects: Iterable[Effect], abilities: Iterable[Ability]
    ) -> None:
        self._diagrams = diagrams
        self._now = now
        self._parts = [self._sensed(group) for group in _groups(diagrams, effects)]
        self.measured = tuple(name for part in self._parts for name in part.decides)
        self._sensing = Reader(diagrams, self._sensed_values(frozenset(self.measured)))
        self.finishes = self._finishing(abilities)
        finished = self._finished()
        self.changed = (*self.measured, *finished)
        pairs = [
            pair for name in self.changed for pair in zip(diagrams.bits[name], diagrams.bits_after[name], strict=True)
        ]
        self._to_after = diagrams.substitution((now, diagrams.bit(after)) for now, after in pairs)
        self._to_now = diagrams.substitution((after, diagrams.bit(now)) for now, after in pairs)
        ordered = self._ordered([*self._parts, *self._computed(finished)])
        self.parts = tuple(ordered)
        self._backwards = [(part.relation, self._bits_after(part.decides)) for part in ordered]
        self._forwards = self._doing_away(ordered[::-1], [now for now, _ in pairs])
        self.top = diagrams.top([part.relation for part in ordered], [now for now, _ in pairs])

    def after(self, states: Function) -> Function:
        """Where it can lead from `states`."""
        for relation, done_with in self._forwards:
            states = states.apply_exists(_AND, relation, done_with)
        return states.substitute(self._to_now)

    def before(self, states: Function) -> Function:
        """From where it can lead to `states`."""
        states = states.substitute(self._to_after)
        for relation, done_with in self._backwards:
            states = states.apply_exists(_AND, relation, done_with)
        return states

    def sensed(self, states: Function) -> Function:
        """`states`, each with every value that may be measured after it; for conditions of the finishes."""
        return self._diagrams.conjunction((states, *(part.relation for part in self._parts)))

    def _bits_after(self, names: Iterable[str]) -> Function:
        return self._diagrams.cube(bit for name in names for bit in self._diagrams.bits_after[name])

    def _sensed(self, group: Sequence[Effect]) -> Part:
        """Any set of compatible effects of `group`; a mark says that a variable has been written."""
        diagrams = self._diagrams
        written = {target(action) for effect in group for action in effect.actions}
        names = tuple(name for name in diagrams.names if name in written)
        marks = {name: diagrams.bit(diagrams.marks[name]) for name in names}
        relation = diagrams.conjunction(~mark for mark in marks.values())
        for effect in group:
            actions = [action for action in effect.actions if target(action) in marks]
            chosen_sets: list[Function] = []
            for where, taken in _applying(self._now, actions, self._now.predicate(effect.guard)):
                names_taken = [target(action) for action in taken]
                chosen = relation.exists(diagrams.cube(diagrams.marks[name] for name in names_taken)) & where
                for action in taken:
                    name = target(action)
                    chosen &= marks[name]
                    chosen &= same(diagrams, self._now.values(action.value), diagrams.values_after(name))
                chosen_sets.append(chosen)
            relation |= diagrams.disjunction(chosen_sets)
        for name, mark in marks.items():
            relation &= mark | same(diagrams, diagrams.values(name), diagrams.values_after(name))
        relation = relation.exists(diagrams.cube(diagrams.marks[name] for name in names))
        return Part(relation & diagrams.valid_of(names), names)

    def _sensed_values(self, measured: frozenset[str]) -> Lookup:
        return lambda name: self._diagrams.values_after(name) if name in measured else self._now.lookup(name)

    def _finishing(self, abilities: Iterable[Ability]) -> dict[str, Finish]:
        found: dict[str, Finish] = {}
        for ability in abilities:
            actions = [action for action in ability.finish_actions if target(action) in self._diagrams.bits]
            if ability.finish_guard is None or not actions:
                continue
            guard = self._sensing.predicate(ability.finish_guard)
            writes = {}
            for action in actions:
                applies = guard if action.condition is None else guard & self._sensing.predicate(action.condition)
                writes[target(action)] = (applies, self._sensing.values(action.value))
            found[ability.name] = Finish(guard, writes)
        return found

    def disputes(self, one: Finish, other: Finish, name: str) -> Function:
        """Where both would write the variable, and different values."""
        (where, values), (other_where, other_values) = one.writes[name], other.writes[name]
        return where & other_where & ~same(self._diagrams, values, other_values)

    def _finished(self) -> Mapping[str, Values]:
        """The values afterwards of what finishes write."""
        diagrams = self._diagrams
        refused = dict.fromkeys(self.finishes, diagrams.false)
        for (one, first), (other, second) in combinations(self.finishes.items(), 2):
            for name in first.writes.keys() & second.writes.keys():
                dispute = self.disputes(first, second, name)
                refused[one] |= dispute
                refused[other] |= dispute
        after: dict[str, dict[Value, Function]] = {}
        for ability, finish in self.finishes.items():
            for name, (where, values) in finish.writes.items():
                taken = where & ~refused[ability]
                before = after.setdefault(name, dict(diagrams.values(name)))
                after[name] = {value: taken.ite(values.get(value, diagrams.false), before[value]) for value in before}
        return after

    def _computed(self, finished: Mapping[str, Values]) -> Iterator[Part]:
        """What finishes write, as relations."""
        for name, values in finished.items():
            becomes = same(self._diagrams, values, self._diagrams.values_after(name))
            yield Part(becomes & self._diagrams.valid_of((name,)), (name,))

    def _ordered(self, parts: Sequence[Part]) -> list[Part]:
        """`parts` as they do away with values afterwards: before none that still asks for these; the lowest first."""
        diagrams = self._diagrams
        decided = {bit: part.decides for part in parts for name in part.decides for bit in diagrams.bits_after[name]}
        asks = {
            part.decides: {decided[bit] for bit in diagrams.support_bits(part.relation) if bit in decided}
            for part in parts
        }
        left = sorted(parts, key=lambda part: max(diagrams.bits[name][-1] for name in part.decides), reverse=True)
        ordered: list[Part] = []
        while left:
            part = next(
                part for part in left if not any(part.decides in asks[other.decides] for other in left if other != part)
            )
            ordered.append(part)
            left.remove(part)
        return ordered

    def _doing_away(self, parts: Sequence[Part], bits: Iterable[int]) -> list[tuple[Function, Function]]:
        """The relations in this order, each with those of `bits` that none of the others behind it asks for."""
        diagrams = self._diagrams
        last = dict.fromkeys(bits, 0)
        for index, part in enumerate(parts):
            last |= {bit: index for bit in diagrams.support_bits(part.relation) if bit in last}
        return [
            (part.relation, diagrams.cube(bit for bit, at in last.items() if at == index))
            for index, part in enumerate(parts)
        ]


def _groups(diagrams: Diagrams, effects: Iterable[Effect]) -> list[list[Effect]]:
    """The effects that write a variable there are bits for; those that write common ones are one group."""
    groups: list[tuple[set[str], list[Effect]]] = []
    for effect in effects:
        written = {target(action) for action in effect.actions} & diagrams.bits.keys()
        if not written:
            continue
        joined = [group for group in groups if not group[0].isdisjoint(written)]
        groups = [group for group in groups if group[0].isdisjoint(written)]
        members = [member for _, group in joined for member in group]
        groups.append((written.union(*(names for names, _ in joined)), [*members, effect]))
    return [members for _, members in groups]


def _applying(
    reader: Reader, actions: Sequence[Assignment], guard: Function
) -> Iterator[tuple[Function, list[Assignment]]]:
    """Where which of `actions` are taken."""
    if not guard.satisfiable():
        return
    if not actions:
        yield guard, []
        return
    action, rest = actions[0], actions[1:]
    if action.condition is not None:
        applies = reader.predicate(action.condition)
        yield from _applying(reader, rest, guard & ~applies)
        guard &= applies
    for where, taken in _applying(reader, rest, guard):
        yield where, [action, *taken]
