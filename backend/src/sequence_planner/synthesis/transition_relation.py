"""Symbolic transition relations over state sets: steps, device reactions, expressions, node limit."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product
from math import inf
from typing import Protocol

from oxidd.util import BooleanOperator

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Kind, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.transitions import Phase, Transition, starting, transitions
from sequence_planner.language.evaluator import RELATIONS
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    conjunction,
    conjuncts,
    variables,
)
from sequence_planner.language.types import Value
from sequence_planner.synthesis.bdd import (
    Diagrams,
    Function,
    Lookup,
    Substitution,
    Values,
    hubs_first,
    ordered,
)

# Which variables are near to a start: what it is about, then what is specified together with that, and so on.
#
# What a supervisor adds to a start is about few variables, and these are near to it. So they are sought there first,
# instead of leaving out one after the other all those that are not.


class Nearness:
    """The nearness of things in `automaton`, among the variables `names`."""

    def __init__(self, automaton: Automaton, names: Collection[str]) -> None:
        self._automaton = automaton
        self._names = frozenset(names)
        specified = [
            read_variables(automaton, (specification.forbidden,)) & self._names
            for specification in automaton.specifications.values()
        ]
        self._related = (specified, [self._about(each) for each in transitions(automaton)])

    def around(self, ability: str) -> Iterator[frozenset[str]]:
        """Wider and wider sets of variables around the start of an ability, and all of them in the end."""
        found = self._about(starting(self._automaton.abilities[ability]))
        before = None
        while found != before:
            before = found
            for related in self._related:
                yield found
                found = _widened(found, related)
        if found != self._names:
            yield self._names

    def _about(self, transition: Transition) -> frozenset[str]:
        read = read_variables(self._automaton, (transition.guard,))
        return (read | transition.reads | transition.writes) & self._names


def _widened(found: frozenset[str], related: Sequence[frozenset[str]]) -> frozenset[str]:
    return found.union(*(each for each in related if not each.isdisjoint(found)))


# Expressions over sets of states.


class ExpressionReader:
    """Reads resolved expressions; `lookup` says where each variable or flag has which value."""

    def __init__(self, diagrams: Diagrams, lookup: Lookup) -> None:
        self._diagrams = diagrams
        self.lookup = lookup

    def predicate(self, expression: Expression) -> Function:
        """Return where a predicate holds."""
        diagrams = self._diagrams
        match expression:
            case Constant(value):
                return diagrams.true if value else diagrams.false
            case Variable(name):
                return self.lookup(name).get(True, diagrams.false)
            case Not(operand):
                return ~self.predicate(operand)
            case And(operands):
                return diagrams.conjunction(map(self.predicate, operands))
            case Or(operands):
                return diagrams.disjunction(map(self.predicate, operands))
            case Implies(left, right):
                return self.predicate(left).imp(self.predicate(right))
            case Comparison(relation, left, right):
                return self._compared(RELATIONS[relation], self.values(left), self.values(right))
            case Membership(left, options):
                subject = self.values(left)
                return diagrams.disjunction(
                    self._compared(RELATIONS["=="], subject, self.values(option)) for option in options
                )
            case _:
                raise TypeError(f"{expression} is no predicate of a state")

    def values(self, expression: Expression) -> Values:
        """Return where an expression has each of the values that it can have."""
        match expression:
            case Constant(value):
                return {value: self._diagrams.true}
            case Variable(name):
                return self.lookup(name)
            case Arithmetic(sign, left, right):
                totals: dict[Value, Function] = {}
                for (a, where), (b, and_where) in product(self.values(left).items(), self.values(right).items()):
                    total = int(a) + int(b) if sign == "+" else int(a) - int(b)
                    totals[total] = totals.get(total, self._diagrams.false) | (where & and_where)
                return totals
            case _:
                holds = self.predicate(expression)
                return {True: holds, False: ~holds}

    def _compared(self, holds: Callable[[Value, Value], bool], left: Values, right: Values) -> Function:
        return self._diagrams.disjunction(
            where & and_where
            for (one, where), (other, and_where) in product(left.items(), right.items())
            if holds(one, other)
        )


# The steps of an automaton over sets of states: where a step leads from some states, and from where it leads to them.
#
# All writes are functions of the state, so a guarded update is split into cases that write constants: the states after
# it are a quantification and a conjunction, those before it a cofactor, and no bits for values afterwards are needed.
# Only an update of several values that depend on the state has such bits, and the `transition_relation` of a tick.

_AND = BooleanOperator.AND


class TransitionStep(Protocol):
    """A step, with what can happen in it. It touches no bit above the level `top`."""

    @property
    def top(self) -> int:
        """The first level that it reads or writes."""

    def after(self, states: Function) -> Function:
        """Return where it can lead from `states`."""

    def before(self, states: Function) -> Function:
        """From where it can lead to `states`."""


@dataclass(frozen=True)
class BitUpdate:
    """An update by which, where `guard` holds, the bits `written` take the values of `values`."""

    guard: Function
    values: Function
    written: Function
    top: int

    def after(self, states: Function) -> Function:
        """Return where it leads from `states`."""
        return states.apply_exists(_AND, self.guard, self.written) & self.values

    def before(self, states: Function) -> Function:
        """From where it leads to `states`."""
        return states.apply_exists(_AND, self.values, self.written) & self.guard


@dataclass(frozen=True)
class Stutter:
    """A step by which, where `guard` holds, nothing changes."""

    guard: Function
    top: int

    def after(self, states: Function) -> Function:
        """The same states."""
        return states & self.guard

    before = after


@dataclass(frozen=True)
class TransitionRelation:
    """A relation between values now and values afterwards of some variables; the others stay what they are."""

    relation: Function
    now: Function
    afterwards: Function
    to_now: Substitution
    to_afterwards: Substitution
    top: int

    def after(self, states: Function) -> Function:
        """Return where it leads from `states`."""
        return states.apply_exists(_AND, self.relation, self.now).substitute(self.to_now)

    def before(self, states: Function) -> Function:
        """From where it leads to `states`."""
        return states.substitute(self.to_afterwards).apply_exists(_AND, self.relation, self.afterwards)


def depends(actions: Iterable[Assignment]) -> list[str]:
    """The variables to which something is written that depends on the state."""
    return [target(a) for a in actions if a.condition is not None or not isinstance(a.value, Constant)]


def updates(
    diagrams: Diagrams, reader: ExpressionReader, guards: Iterable[Expression], actions: Iterable[Assignment]
) -> list[TransitionStep]:
    """A guarded update of those variables of `actions` that there are bits for.

    It is split into cases that write constants. Where several values depend on the state there would be a case for each
    combination of them, so then it is a relation, if there are bits for the values afterwards.
    """
    guard = diagrams.conjunction(map(reader.predicate, guards))
    written = [action for action in actions if target(action) in diagrams.bits]
    if len(depends(written)) > 1 and all(target(action) in diagrams.bits_after for action in written):
        return [_change(diagrams, reader, guard, written)]
    steps: list[TransitionStep] = []
    for where, values in _cases(diagrams, reader, written, guard):
        if not values:
            steps.append(Stutter(where, diagrams.top([where])))
            continue
        where &= diagrams.valid_of(values)
        bits = [bit for name in values for bit in diagrams.bits[name]]
        constants = diagrams.conjunction(diagrams.values(name)[value] for name, value in values.items())
        steps.append(BitUpdate(where, constants, diagrams.cube(bits), diagrams.top([where], bits)))
    return steps


def _change(
    diagrams: Diagrams, reader: ExpressionReader, guard: Function, actions: Sequence[Assignment]
) -> TransitionRelation:
    names = [target(action) for action in actions]
    relation = guard & diagrams.valid_of(names)
    for action in actions:
        name = target(action)
        becomes = same(diagrams, reader.values(action.value), diagrams.values_after(name))
        if action.condition is not None:
            stays = same(diagrams, diagrams.values(name), diagrams.values_after(name))
            becomes = reader.predicate(action.condition).ite(becomes, stays)
        relation &= becomes
    now = [bit for name in names for bit in diagrams.bits[name]]
    afterwards = [bit for name in names for bit in diagrams.bits_after[name]]
    return TransitionRelation(
        relation,
        diagrams.cube(now),
        diagrams.cube(afterwards),
        diagrams.substitution(zip(afterwards, map(diagrams.bit, now), strict=True)),
        diagrams.substitution(zip(now, map(diagrams.bit, afterwards), strict=True)),
        diagrams.top([relation], now),
    )


def _cases(
    diagrams: Diagrams, reader: ExpressionReader, actions: Sequence[Assignment], guard: Function
) -> Iterator[tuple[Function, dict[str, Value]]]:
    """Yield where which constants are written."""
    if not guard.satisfiable():
        return
    if not actions:
        yield guard, {}
        return
    action, rest = actions[0], actions[1:]
    if action.condition is not None:
        applies = reader.predicate(action.condition)
        yield from _cases(diagrams, reader, rest, guard & ~applies)
        guard &= applies
    domain = diagrams.domains[target(action)]
    for value, where in reader.values(action.value).items():
        if value in domain:
            for inner, values in _cases(diagrams, reader, rest, guard & where):
                yield inner, {**values, target(action): value}


@dataclass(frozen=True)
class Flip:
    """A truth value changes: an operation becomes active, or is so no longer."""

    other: Substitution
    top: int

    def after(self, states: Function) -> Function:
        """The states that differ by the truth value."""
        return states.substitute(self.other)

    before = after


def same(diagrams: Diagrams, one: Values, other: Values) -> Function:
    """Return where two have the same value."""
    return diagrams.disjunction(where & other[value] for value, where in one.items() if value in other)


# A limit to how much is computed with diagrams, counted in nodes and not in seconds, so that answers stay the same.

MOST_BITS = 300  # beyond them closures are not even begun
_SAMPLED = 64  # the nodes of every so many sets are counted


class TooMuchError(Exception):
    """The limit is reached before there is an answer."""


class NodeLimit:
    """The limit of what may still be spent: the nodes of all sets from which steps are taken or that are compared, by
    samples.

    What is spent is spent of the `whole` as well, if it is a part of one.
    """

    def __init__(self, most: int, least: int = 0, whole: NodeLimit | None = None) -> None:
        """`most` nodes are left. Whatever is done counts as `least` nodes at least."""
        self._left = most
        self._least = least
        self._whole = whole
        self._taken = 0

    def limited(self, steps: Iterable[TransitionStep]) -> list[TransitionStep]:
        """The same steps, which raise `TooMuchError` when all is spent."""
        return [_Limited(step, self) for step in steps]

    def spend(self, states: Function) -> None:
        """Count something that is done with `states`."""
        if self._taken % _SAMPLED == 0:
            self.use(max(states.node_count(), self._least) * _SAMPLED)
        self._taken += 1
        if self._whole is not None:
            self._whole.spend(states)

    def use(self, nodes: int) -> None:
        """Count what takes about as long as something is done with so many nodes."""
        self._left -= nodes
        if self._left < 0:
            raise TooMuchError


@dataclass(frozen=True)
class _Limited:
    step: TransitionStep
    effort: NodeLimit

    @property
    def top(self) -> int:
        """The first level that it reads or writes."""
        return self.step.top

    def after(self, states: Function) -> Function:
        """Return where it can lead from `states`."""
        self.effort.spend(states)
        return self.step.after(states)

    def before(self, states: Function) -> Function:
        """From where it can lead to `states`."""
        self.effort.spend(states)
        return self.step.before(states)


# The uncontrollable part of a tick over sets of states: all devices react, and all abilities finish, at once.


@dataclass(frozen=True)
class Finish:
    """The finish of an ability: where it finishes, and for each variable where it writes it, and which values."""

    guard: Function
    writes: Mapping[str, tuple[Function, Values]]


@dataclass(frozen=True)
class ReactionPart:
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
        self, diagrams: Diagrams, now: ExpressionReader, effects: Iterable[Effect], abilities: Iterable[Ability]
    ) -> None:
        self._diagrams = diagrams
        self._now = now
        self._parts = [self._sensed(group) for group in _groups(diagrams, effects)]
        self.measured = tuple(name for part in self._parts for name in part.decides)
        self._sensing = ExpressionReader(diagrams, self._sensed_values(frozenset(self.measured)))
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
        """Return where it can lead from `states`."""
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

    def _sensed(self, group: Sequence[Effect]) -> ReactionPart:
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
        return ReactionPart(relation & diagrams.valid_of(names), names)

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
        """Return where both would write the variable, and different values."""
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

    def _computed(self, finished: Mapping[str, Values]) -> Iterator[ReactionPart]:
        """Yield what finishes write, as relations."""
        for name, values in finished.items():
            becomes = same(self._diagrams, values, self._diagrams.values_after(name))
            yield ReactionPart(becomes & self._diagrams.valid_of((name,)), (name,))

    def _ordered(self, parts: Sequence[ReactionPart]) -> list[ReactionPart]:
        """`parts` as they do away with values afterwards: before none that still asks for these; the lowest first."""
        diagrams = self._diagrams
        decided = {bit: part.decides for part in parts for name in part.decides for bit in diagrams.bits_after[name]}
        asks = {
            part.decides: {decided[bit] for bit in diagrams.support_bits(part.relation) if bit in decided}
            for part in parts
        }
        left = sorted(parts, key=lambda part: max(diagrams.bits[name][-1] for name in part.decides), reverse=True)
        ordered: list[ReactionPart] = []
        while left:
            part = next(
                part for part in left if not any(part.decides in asks[other.decides] for other in left if other != part)
            )
            ordered.append(part)
            left.remove(part)
        return ordered

    def _doing_away(self, parts: Sequence[ReactionPart], bits: Iterable[int]) -> list[tuple[Function, Function]]:
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
    reader: ExpressionReader, actions: Sequence[Assignment], guard: Function
) -> Iterator[tuple[Function, list[Assignment]]]:
    """Yield where which of `actions` are taken."""
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


# What can happen in an automaton, over sets of states of some of its variables.

_MOST_TRIED = 1 << 18  # nodes, to find out whether an order is a good one


class _FlagReader(ExpressionReader):
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
    def starts(self) -> dict[str, list[TransitionStep]]:
        """The start of each ability that changes something here, each in cases."""
        return {
            ability.name: updates(
                self.diagrams, self.reader, (ability.enabled, ability.start_guard), ability.start_actions
            )
            for ability in self.automaton.abilities.values()
            if not ability.restart and self._startable(ability)
        }

    @property
    def all_starts(self) -> list[TransitionStep]:
        """The starts of all abilities."""
        return [step for steps in self.starts.values() for step in steps]

    def _startable(self, ability: Ability) -> bool:
        if not any(target(action) in self.diagrams.bits for action in ability.start_actions):
            return False
        return self.says((ability.enabled, ability.start_guard))

    def says(self, predicates: Iterable[Expression]) -> bool:
        """Return whether `predicates` depend on variables of the plant only."""
        return read_variables(self.automaton, predicates) <= self.diagrams.bits.keys()

    @cached_property
    def flags(self) -> tuple[str, ...]:
        """The flags that depend on variables of the plant only, in order of declaration."""
        return tuple(flag.name for flag in self.automaton.flags if self.says((flag.predicate,)))

    @cached_property
    def uncontrollable(self) -> list[TransitionStep]:
        """The steps that can happen without us, faults included."""
        return self._uncontrollable(self.automaton.effects)

    @cached_property
    def helpful(self) -> list[TransitionStep]:
        """The same without faults, on which nobody counts."""
        effects = [effect for effect in self.automaton.effects if not effect.fault]
        return self.uncontrollable if len(effects) == len(self.automaton.effects) else self._uncontrollable(effects)

    def reaction(self, effects: Iterable[Effect]) -> Reaction:
        """Steps 1 to 3 of a tick of a station in which `effects` can happen."""
        return Reaction(self.diagrams, self.reader, effects, self.automaton.abilities.values())

    def _uncontrollable(self, effects: Sequence[Effect]) -> list[TransitionStep]:
        """In a plain automaton each effect alone; else a tick's reaction, and any outcome of its step 4."""
        if self.automaton.one_at_a_time:
            concerned = [e for e in effects if any(target(action) in self.diagrams.bits for action in e.actions)]
            return [s for e in concerned for s in updates(self.diagrams, self.reader, (e.guard,), e.actions)]
        reaction = self.reaction(effects)
        return [*([reaction] if reaction.changed else []), *self._flips()]

    def _flips(self) -> Iterator[TransitionStep]:
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
