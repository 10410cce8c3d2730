"""The automaton seen through some of its variables: whatever it can do to these, what is seen can do as well.

What is read of other variables has any value, decided anew in each tick by an *oracle* (localisation, Kurshan 1994): a
variable for each place where it is read. So goals that cannot be reached in what is seen cannot be reached at all.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.structure import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    State,
    VariableDeclaration,
    target,
)
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.replacing import rebuilt
from sequence_planner.expressions.syntax import (
    TRUE,
    And,
    Assignment,
    Expression,
    Implies,
    Not,
    Or,
    Variable,
    conjunction,
    variables,
)
from sequence_planner.expressions.types import BOOLEAN, Type
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.sat.following import Following

_ALL = StateSet((), ())


class Localised(Immutable):
    """What is seen, and for each oracle the variables it speaks for. States outside the safe set are not told apart."""

    automaton: Automaton
    supervisor: Supervisor
    oracles: Mapping[str, frozenset[str]]

    def state(self, state: State) -> State:
        """What is seen of `state`; oracles say anything."""
        return synchronise(self.automaton, {name: state.get(name, False) for name in self.automaton.types})

    def order(self, order: Iterable[Ability]) -> tuple[Ability, ...]:
        """The starts of `order` that write anything that is seen."""
        seen = (self.automaton.abilities.get(ability.name) for ability in order)
        return tuple(ability for ability in seen if ability is not None and ability.start_actions)


def localised(automaton: Automaton, supervisor: Supervisor, kept: frozenset[str]) -> Localised:
    """`automaton`, none of whose variables is unknown, seen through its variables `kept`."""
    return _Localiser(automaton, supervisor, kept).localised()


def localisable(automaton: Automaton, state: State, goals: Goals) -> bool:
    """Whether questions about runs from `state` can be answered so.

    Unknown values decide too much, and formulas count the positions of runs, also those at which nothing seen happens.
    """
    known = None not in state.values() and synchronise(automaton, state) == dict(state)
    return known and all(goal.local == TRUE for goal in goals)


class _Localiser:
    def __init__(self, automaton: Automaton, supervisor: Supervisor, kept: frozenset[str]) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._kept = kept
        hidden = {flag.name for flag in Following(automaton).flags(automaton.variables.keys() - kept)}
        self._flags = frozenset(flag.name for flag in automaton.flags if flag.name not in hidden)
        self._seen = kept | self._flags
        self._declared: dict[str, VariableDeclaration] = {}
        self._oracles: dict[str, frozenset[str]] = {}
        self._disputed = dict(_disputed(automaton, kept))

    def localised(self) -> Localised:
        automaton = self._automaton
        abilities = {ability.name: ability for ability in self._abilities()}
        guards = {
            name: _projected(guard, self._kept) for name, guard in self._supervisor.guards.items() if name in abilities
        }
        enabled = {ability.flag("enabled") for ability in abilities.values()} - self._flags
        flags = (
            *(flag for flag in automaton.flags if flag.name in self._flags),
            *(Flag(name, TRUE) for name in sorted(enabled)),
        )
        seen = replace(
            automaton,
            abilities=abilities,
            effects=tuple(self._effects()),
            flags=flags,
            variables={n: v for n, v in automaton.variables.items() if n in self._kept} | self._declared,
        )
        return Localised(seen, Supervisor(_ALL, guards), self._oracles)

    def _effects(self) -> Iterator[Effect]:
        for effect in self._automaton.effects:
            if not effect.fault and self._relevant(effect.actions):
                place = _Place(self, inlined=True)
                yield replace(effect, guard=place.predicate(effect.guard), actions=place.actions(effect.actions))

    def _abilities(self) -> Iterator[Ability]:
        for ability in self._automaton.abilities.values():
            starts, finishes = self._relevant(ability.start_actions), self._relevant(ability.finish_actions)
            if not starts and (not finishes or ability.finish_guard is None):
                continue
            start, end = _Place(self, inlined=True), _Place(self, inlined=False)
            guard = conjunction(ability.enabled, ability.start_guard)
            if ability.flag("enabled") in self._flags:
                enabled, guard = ability.enabled, ability.start_guard
            else:
                enabled = TRUE
            guard = start.predicate(guard)
            if hidden := frozenset(self._supervisor.guards.get(ability.name, _ALL).names) - self._kept:
                guard = conjunction(guard, self.oracle(BOOLEAN, hidden))
            finish = ability.finish_guard if finishes else None
            if finish is not None:
                finish = end.predicate(finish)
                if hidden := self._disputed.get(ability.name, frozenset()):
                    finish = conjunction(finish, self.oracle(BOOLEAN, hidden))
            yield replace(
                ability,
                enabled=enabled,
                start_guard=guard,
                start_actions=start.actions(ability.start_actions),
                finish_guard=finish,
                finish_actions=end.actions(ability.finish_actions) if finish is not None else (),
            )

    def _relevant(self, actions: tuple[Assignment, ...]) -> bool:
        return any(target(action) in self._kept for action in actions)

    def visible(self, expression: Expression) -> bool:
        """Whether nothing is read that is not seen."""
        return self._seen.issuperset(variables(expression))

    def kept(self, name: str) -> bool:
        """Whether the variable is seen."""
        return name in self._kept

    def inlined(self, name: str) -> Expression | None:
        """The predicate of a flag."""
        return self._automaton.flag_predicates.get(name)

    def hidden(self, expression: Expression) -> frozenset[str]:
        """The variables it reads that are not seen."""
        return read_variables(self._automaton, (expression,)) - self._kept

    def oracle(self, type_: Type, hidden: frozenset[str]) -> Variable:
        """A new one, which speaks for the variables `hidden`."""
        name = f"oracle.{len(self._oracles)}"
        self._oracles[name] = hidden
        self._declared[name] = VariableDeclaration(name, type_, Kind.MEASURED, type_.domain[0], None)
        return Variable(name, type_)


class _Place:
    """A moment of the tick at which one transition reads the state: what it reads twice has one value.

    Flags may be `inlined` where they are those of the state that is read.
    """

    def __init__(self, localiser: _Localiser, inlined: bool) -> None:
        self._localiser = localiser
        self._inlined = inlined
        self._values: dict[Expression, Variable] = {}

    def predicate(self, expression: Expression) -> Expression:
        """The predicate, where each part that reads what is not seen is what an oracle says."""
        localiser = self._localiser
        if localiser.visible(expression):
            return expression
        match expression:
            case Not() | And() | Or() | Implies():
                return rebuilt(expression, self.predicate)
            case Variable(name) if self._inlined and (predicate := localiser.inlined(name)) is not None:
                return self.predicate(predicate)
            case _:
                return self._oracle(expression, BOOLEAN)

    def actions(self, actions: tuple[Assignment, ...]) -> tuple[Assignment, ...]:
        """Those that write what is seen."""
        return tuple(self._action(action) for action in actions if self._localiser.kept(target(action)))

    def _action(self, action: Assignment) -> Assignment:
        value, written = action.value, action.target
        assert isinstance(written, Variable)
        if not self._localiser.visible(value):
            value = self.predicate(value) if written.type == BOOLEAN else self._oracle(value, written.type)
        condition = None if action.condition is None else self.predicate(action.condition)
        return Assignment(written, value, condition)

    def _oracle(self, expression: Expression, type_: Type) -> Variable:
        if expression not in self._values:
            self._values[expression] = self._localiser.oracle(type_, self._localiser.hidden(expression))
        return self._values[expression]


def _projected(states: StateSet, kept: frozenset[str]) -> StateSet:
    """What `states` allow for some value of the variables that are not kept."""
    hidden = frozenset(states.names) - kept
    return _complement(_complement(states).for_all(hidden)) if hidden else states


def _complement(states: StateSet) -> StateSet:
    other = {NOTHING: EVERYTHING, EVERYTHING: NOTHING}
    nodes = tuple((axis, tuple(other.get(child, child) for child in children)) for axis, children in states.nodes)
    return replace(states, nodes=nodes, root=other.get(states.root, states.root))


def _disputed(automaton: Automaton, kept: frozenset[str]) -> Iterator[tuple[str, frozenset[str]]]:
    """The abilities whose finish another one's can refuse over variables that are not kept, with all these."""
    writers: dict[str, set[str]] = {}
    for ability in automaton.abilities.values():
        if ability.finish_guard is not None:
            for action in ability.finish_actions:
                writers.setdefault(target(action), set()).add(ability.name)
    found: dict[str, set[str]] = {}
    for name, abilities in writers.items():
        if name not in kept:
            for pair in combinations(sorted(abilities), 2):
                if _may_differ(automaton, name, pair):
                    for each in pair:
                        found.setdefault(each, set()).add(name)
    return ((ability, frozenset(names)) for ability, names in found.items())


def _may_differ(automaton: Automaton, name: str, pair: tuple[str, ...]) -> bool:
    one, other = ({a.value for a in automaton.abilities[each].finish_actions if target(a) == name} for each in pair)
    return one != other or len(one) > 1
