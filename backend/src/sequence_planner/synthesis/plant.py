"""What can happen in an automaton, over sets of states of some of its variables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from math import inf

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Ability, Automaton, Effect, Kind, target
from sequence_planner.automaton.transitions import Phase, transitions
from sequence_planner.expressions.syntax import TRUE, Expression, conjunction, conjuncts, variables
from sequence_planner.synthesis.diagrams import Diagrams, Function, Values
from sequence_planner.synthesis.ordering import hubs_first, ordered
from sequence_planner.synthesis.reaction import Reaction
from sequence_planner.synthesis.reading import Reader
from sequence_planner.synthesis.steps import Flip, Step, depends, updates

_MOST_TRIED = 1 << 18  # nodes, to find out whether an order is a good one


class _FlagReader(Reader):
    """Reads predicates of an automaton; a flag is what its predicate says."""

    def __init__(self, automaton: Automaton, diagrams: Diagrams) -> None:
        super().__init__(diagrams, self._values)
        self._automaton = automaton
        self._variables = diagrams
        self._flags: dict[str, Values] = {}

    def _values(self, name: str) -> Values:
        if name in self._variables.bits:
            return self._variables.values(name)
        if name not in self._flags:
            holds = self.predicate(self._automaton.flag_predicates[name])
            self._flags[name] = {True: holds, False: ~holds}
        return self._flags[name]


class Plant:
    """An automaton over the variables `names`, on which nothing that is asked of it depends further.

    Flags are functions of the variables. Restart abilities are left out: they are not counted on. Their `order` is one
    that makes small what is forbidden, unless another one is given, or `diagrams` that have it.
    """

    def __init__(
        self,
        automaton: Automaton,
        names: Sequence[str],
        order: Sequence[str] | None = None,
        diagrams: Diagrams | None = None,
    ) -> None:
        self.automaton = automaton
        if diagrams is None:
            order = _ordered(automaton, names) if order is None else order
            afterwards = written_afterwards(automaton, order)
            diagrams = Diagrams({name: automaton.variables[name].type.domain for name in order}, afterwards)
        self.diagrams = diagrams
        self.reader = _FlagReader(automaton, self.diagrams)

    def where(self, predicate: Expression) -> Function:
        """The states in which `predicate` holds; all of them exist."""
        return self.reader.predicate(predicate) & self.diagrams.valid

    @cached_property
    def rest(self) -> Function:
        """The states of rest."""
        return self.where(TRUE if self.automaton.rest is None else self.automaton.rest)

    @cached_property
    def initial(self) -> Function:
        """The initial states. What is said of variables outside says nothing about those inside."""
        automaton, names = self.automaton, self.diagrams.bits.keys()
        if automaton.initial is None:
            return self.diagrams.states({name: automaton.variables[name].initial for name in names})
        inside = [part for part in conjuncts(automaton.initial) if set(variables(part)) <= names]
        return self.where(conjunction(*inside))

    @cached_property
    def starts(self) -> dict[str, list[Step]]:
        """The start of each ability that changes something here, each in cases."""
        return {
            ability.name: updates(
                self.diagrams, self.reader, (ability.enabled, ability.start_guard), ability.start_actions
            )
            for ability in self.automaton.abilities.values()
            if not ability.restart and self._startable(ability)
        }

    def _startable(self, ability: Ability) -> bool:
        if not any(target(action) in self.diagrams.bits for action in ability.start_actions):
            return False
        return self.says((ability.enabled, ability.start_guard))

    def says(self, predicates: Iterable[Expression]) -> bool:
        """Whether `predicates` depend on variables of the plant only."""
        return read_variables(self.automaton, predicates) <= self.diagrams.bits.keys()

    @cached_property
    def flags(self) -> tuple[str, ...]:
        """The flags that depend on variables of the plant only, in order of declaration."""
        return tuple(flag.name for flag in self.automaton.flags if self.says((flag.predicate,)))

    @cached_property
    def uncontrollable(self) -> list[Step]:
        """What can happen without us, faults included."""
        return self._uncontrollable(self.automaton.effects)

    @cached_property
    def helpful(self) -> list[Step]:
        """The same without faults, on which nobody counts."""
        effects = [effect for effect in self.automaton.effects if not effect.fault]
        return self.uncontrollable if len(effects) == len(self.automaton.effects) else self._uncontrollable(effects)

    def reaction(self, effects: Iterable[Effect]) -> Reaction:
        """Steps 1 to 3 of a tick of a station in which `effects` can happen."""
        return Reaction(self.diagrams, self.reader, effects, self.automaton.abilities.values())

    def _uncontrollable(self, effects: Sequence[Effect]) -> list[Step]:
        """In a plain automaton each effect alone; else a tick's reaction, and any outcome of its step 4."""
        if self.automaton.one_at_a_time:
            concerned = [e for e in effects if any(target(action) in self.diagrams.bits for action in e.actions)]
            return [s for e in concerned for s in updates(self.diagrams, self.reader, (e.guard,), e.actions)]
        reaction = self.reaction(effects)
        return [*([reaction] if reaction.changed else []), *self._flips()]

    def _flips(self) -> Iterator[Step]:
        for name in self.automaton.names(Kind.ACTIVITY):
            if name in self.diagrams.bits:
                (number,) = self.diagrams.bits[name]
                yield Flip(self.diagrams.substitution([(number, ~self.diagrams.bit(number))]), number)


def _ordered(automaton: Automaton, names: Sequence[str]) -> tuple[str, ...]:
    """The better of two orders: the one in which what is forbidden and what is rest take fewer nodes."""
    groups = list(together(automaton))
    order = ordered(names, groups)
    other = hubs_first(order, groups)
    if other == order:
        return order
    sizes = {each: _size(automaton, each) for each in (order, other)}
    # Where neither is small, hubs first is: what is forbidden by station after station is then told apart early.
    return other if min(sizes.values()) == inf else min(sizes, key=sizes.__getitem__)


def orders(automaton: Automaton, names: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Orders to try where it is not known which suits: what draws variables together does not see which way round."""
    groups = list(together(automaton))
    order = ordered(names, groups)
    yield from dict.fromkeys((order[::-1], hubs_first(order, groups), order))


def _size(automaton: Automaton, order: Sequence[str]) -> float:
    diagrams = Diagrams({name: automaton.variables[name].type.domain for name in order}, most_nodes=_MOST_TRIED)
    reader = _FlagReader(automaton, diagrams)
    forbidden = [each.forbidden for each in automaton.specifications.values()]
    asked = [forbidden, [] if automaton.rest is None else [automaton.rest]]
    inside = [[p for p in each if read_variables(automaton, (p,)) <= diagrams.bits.keys()] for each in asked]
    try:
        return sum(diagrams.disjunction(map(reader.predicate, each)).node_count() for each in inside)
    except MemoryError:
        return inf


def written_afterwards(automaton: Automaton, names: Sequence[str]) -> frozenset[str]:
    """The variables that need bits for their value afterwards."""
    found: set[str] = set()
    for transition in transitions(automaton):
        together = not automaton.one_at_a_time and transition.phase is not Phase.START
        if together or len([name for name in depends(transition.actions) if name in names]) > 1:
            found |= transition.writes
    return frozenset(found)


def together(automaton: Automaton) -> Iterator[frozenset[str]]:
    """The variables that each transition and each part of a specification reads or writes."""
    for transition in transitions(automaton):
        read = read_variables(automaton, (transition.guard, *(a.value for a in transition.actions)))
        yield read | transition.writes
    for specification in automaton.specifications.values():
        yield read_variables(automaton, (specification.forbidden,))
    if automaton.rest is not None:
        for part in conjuncts(automaton.rest):
            yield read_variables(automaton, (part,))
