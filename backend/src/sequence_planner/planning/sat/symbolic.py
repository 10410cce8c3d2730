"""Symbolic states and actions: three-valued expressions over literals, writes and their conflicts."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from itertools import product
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton, Flag, target
from sequence_planner.automaton.state_set import FIRST_NODE, StateSet
from sequence_planner.language.evaluator import RELATIONS
from sequence_planner.language.syntax import (
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
)
from sequence_planner.language.types import Value
from sequence_planner.planning.sat.solver import Circuit

# States whose values are literals, and expressions over them with three truth values.
#
# A variable is a literal for each of its values; none of them is true while it is unknown. A predicate is two literals:
# that it is true for certain, and that it is false for certain. Where nothing is unknown, one is the other's negation,
# and the circuit makes them one gate.


class Symbol(NamedTuple):
    """A value that a solver decides: a literal for each possible value, and one that says it is known."""

    literals: Mapping[Value, int]
    known: int = Circuit.TRUE

    def literal(self, value: Value) -> int:
        """The literal that is true when the value is `value`."""
        return self.literals.get(value, Circuit.FALSE)

    def within(self, domain: Collection[Value]) -> Symbol:
        """The same value where it is one of `domain`."""
        if self.literals.keys() <= set(domain):
            return self
        return Symbol({value: literal for value, literal in self.literals.items() if value in domain}, self.known)


class Truth(NamedTuple):
    """Literals for *true for certain* and *false for certain*."""

    yes: int
    no: int


SymbolicState = Mapping[str, Symbol]


class Reading:
    """Reads expressions over symbolic states into a circuit."""

    def __init__(self, circuit: Circuit) -> None:
        self._circuit = circuit
        self._members: dict[int, _Member] = {}  # by the identity of a set, which each keeps alive

    def truth(self, expression: Expression, state: SymbolicState) -> Truth:
        """A resolved predicate over `state`."""
        # What is most frequent comes first, and without patterns, as in `language.evaluator.evaluate`.
        if isinstance(expression, Comparison):
            return self._compared(expression, state)
        if isinstance(expression, And):
            return self._all([self.truth(part, state) for part in expression.operands])
        if isinstance(expression, Variable):
            symbol = state[expression.name]
            return Truth(symbol.literal(True), symbol.literal(False))
        if isinstance(expression, Not):
            inner = self.truth(expression.operand, state)
            return Truth(inner.no, inner.yes)
        if isinstance(expression, Or):
            return self._any([self.truth(part, state) for part in expression.operands])
        match expression:
            case Constant(value):
                return Truth(Circuit.TRUE, Circuit.FALSE) if value else Truth(Circuit.FALSE, Circuit.TRUE)
            case Implies(left, right):
                premise = self.truth(left, state)
                return self._any([Truth(premise.no, premise.yes), self.truth(right, state)])
            case Membership(left, options):
                subject = self.symbol(left, state)
                return self._any([self._comparison("==", subject, self.symbol(o, state)) for o in options])
            case _:
                raise TypeError(f"{expression} is no predicate")

    def symbol(self, expression: Expression, state: SymbolicState) -> Symbol:
        """The value of a resolved expression over `state`."""
        match expression:
            case Constant(value):
                return Symbol({value: Circuit.TRUE})
            case Variable(name):
                return state[name]
            case Arithmetic(sign, left, right):
                return self._arithmetic(sign, self.symbol(left, state), self.symbol(right, state))
            case _:
                truth = self.truth(expression, state)
                return Symbol({True: truth.yes, False: truth.no}, self._circuit.disjunction((truth.yes, truth.no)))

    def chosen(self, condition: int, then: Symbol, otherwise: Symbol) -> Symbol:
        """The value `then` where `condition` is true, else `otherwise`."""
        circuit = self._circuit
        values = dict.fromkeys((*otherwise.literals, *then.literals))
        if set(values) == {True, False} and then.known == otherwise.known == circuit.TRUE:
            literal = circuit.choice(condition, then.literal(True), otherwise.literal(True))
            return Symbol({True: literal, False: -literal})
        return Symbol(
            {v: circuit.choice(condition, then.literal(v), otherwise.literal(v)) for v in values},
            circuit.choice(condition, then.known, otherwise.known),
        )

    def same(self, one: Symbol, other: Symbol) -> int:
        """The literal that is true when both are known and equal."""
        if one == other and one.known == Circuit.TRUE:
            return Circuit.TRUE
        return self._comparison("==", one, other).yes

    def member(self, states: StateSet, state: SymbolicState) -> int:
        """The literal that is true when `state` is in `states`, none of whose variables is unknown."""
        member = self._members.get(id(states))
        if member is None:
            member = self._members[id(states)] = _Member(states, self._circuit)
        return member.literal(state)

    def _all(self, truths: list[Truth]) -> Truth:
        yes = self._circuit.conjunction(truth.yes for truth in truths)
        return Truth(yes, self._circuit.disjunction(truth.no for truth in truths))

    def _any(self, truths: list[Truth]) -> Truth:
        yes = self._circuit.disjunction(truth.yes for truth in truths)
        return Truth(yes, self._circuit.conjunction(truth.no for truth in truths))

    def _compared(self, comparison: Comparison, state: SymbolicState) -> Truth:
        relation, left, right = comparison.operator, comparison.left, comparison.right
        if not (isinstance(left, Variable) and isinstance(right, Constant) and relation in ("==", "!=")):
            return self._comparison(relation, self.symbol(left, state), self.symbol(right, state))
        symbol = state[left.name]
        equal = symbol.literal(right.value)
        differs = self._circuit.both(symbol.known, -equal)
        return Truth(equal, differs) if relation == "==" else Truth(differs, equal)

    def _comparison(self, relation: str, left: Symbol, right: Symbol) -> Truth:
        if relation == "!=":
            equal = self._comparison("==", left, right)
            return Truth(equal.no, equal.yes)
        if relation == "==":
            shared = [value for value in left.literals if value in right.literals]
            pairs = [(left.literals[value], right.literals[value]) for value in shared]
        else:
            holds = RELATIONS[relation]
            both = product(left.literals.items(), right.literals.items())
            pairs = [(a, b) for (value, a), (other, b) in both if holds(value, other)]
        yes = self._circuit.disjunction(self._circuit.both(a, b) for a, b in pairs)
        return Truth(yes, self._circuit.conjunction((left.known, right.known, -yes)))

    def _arithmetic(self, sign: str, left: Symbol, right: Symbol) -> Symbol:
        sums: dict[Value, list[int]] = {}
        for (value, a), (other, b) in product(left.literals.items(), right.literals.items()):
            total = int(value) + int(other) if sign == "+" else int(value) - int(other)
            sums.setdefault(total, []).append(self._circuit.both(a, b))
        known = self._circuit.conjunction((left.known, right.known))
        return Symbol({total: self._circuit.disjunction(parts) for total, parts in sums.items()}, known)


class _Member:
    """The membership of states in one set; of a state that differs little from the last one little is read anew."""

    def __init__(self, states: StateSet, circuit: Circuit) -> None:
        self._states = states
        self._circuit = circuit
        self._last: list[Symbol | None] = [None] * len(states.names)
        self._literals = [Circuit.FALSE, Circuit.TRUE, *(Circuit.FALSE for _ in states.nodes)]
        tested = [0, 0]  # by node the variables that it and those it refers to test, as bits
        for axis, children in states.nodes:
            below = 1 << axis
            for child in children:
                below |= tested[child]
            tested.append(below)
        self._tested = tested[FIRST_NODE:]

    def literal(self, state: SymbolicState) -> int:
        """The literal that is true when `state` is in the set."""
        states, literals, both = self._states, self._literals, self._circuit.both
        changed = 0
        for axis, name in enumerate(states.names):
            symbol = state[name]
            if symbol is not self._last[axis]:
                self._last[axis] = symbol
                changed |= 1 << axis
        for number, (axis, children) in enumerate(states.nodes if changed else ()):
            if self._tested[number] & changed:
                read = self._last[axis]
                assert read is not None
                cases = zip(states.domains[axis], children, strict=True)
                each = [both(read.literal(value), literals[child]) for value, child in cases]
                literals[number + FIRST_NODE] = self._circuit.disjunction(each)
        return literals[states.root]


class FollowingState(dict[str, Symbol]):
    """A state whose flags equal their predicates; those that are not there yet are read when they are asked for."""

    def __init__(
        self, state: SymbolicState, changed: Iterable[Flag], predicates: Mapping[str, Expression], reading: Reading
    ) -> None:
        """All values of `state` but those of the `changed` flags."""
        super().__init__(state)
        for flag in changed:
            self.pop(flag.name, None)
        self._predicates = predicates
        self._reading = reading

    def __missing__(self, name: str) -> Symbol:
        truth = self._reading.truth(self._predicates[name], self)
        symbol = self[name] = Symbol({False: truth.no, True: truth.yes})
        return symbol


# Actions over symbolic states: what is written, where, and whether it goes together.


class Write(NamedTuple):
    """A value that is written to a variable where `where` is true."""

    where: int
    value: Symbol


Writes = dict[str, Write]


class SymbolicWriter:
    """Reads the actions of an automaton into a circuit."""

    def __init__(self, automaton: Automaton, circuit: Circuit) -> None:
        self._automaton = automaton
        self._circuit = circuit
        self._reading = Reading(circuit)

    def writes(self, actions: Iterable[Assignment], state: SymbolicState) -> tuple[Writes, int]:
        """Return what `actions` write, and the literal that says nothing about it is undetermined."""
        writes: Writes = {}
        determined: list[int] = []
        for action in actions:
            # Where it is taken, an action writes a value of the domain; it is encoded for all states.
            domain = self._automaton.variables[target(action)].type.domain
            value = self._reading.symbol(action.value, state).within(domain)
            written = Symbol(value.literals)  # nothing undetermined is ever written
            if action.condition is None:
                writes[target(action)] = Write(Circuit.TRUE, written)
                determined.append(value.known)
            else:
                condition = self._reading.truth(action.condition, state)
                writes[target(action)] = Write(condition.yes, written)
                determined.append(
                    self._circuit.disjunction((condition.no, self._circuit.conjunction((condition.yes, value.known))))
                )
        return writes, self._circuit.conjunction(determined)

    def applied(self, state: SymbolicState, writes: Writes) -> SymbolicState:
        """The state after `writes`."""
        after = dict(state)
        for name, write in writes.items():
            after[name] = self._reading.chosen(write.where, write.value, state[name])
        return after

    def together(self, state: SymbolicState, taken: Iterable[tuple[int, Writes]]) -> SymbolicState:
        """The state after all writes of what is taken, none of which conflict."""
        all_writes: dict[str, list[Write]] = defaultdict(list)
        for choice, writes in taken:
            for name, write in writes.items():
                all_writes[name].append(Write(self._circuit.both(choice, write.where), write.value))
        return {**state, **{name: self._written(state[name], writes) for name, writes in all_writes.items()}}

    def _written(self, before: Symbol, writes: list[Write]) -> Symbol:
        """The value after `writes`, of which any two that are taken write the same."""
        circuit = self._circuit
        values = dict.fromkeys(value for symbol in (before, *(w.value for w in writes)) for value in symbol.literals)
        kept = circuit.conjunction(-write.where for write in writes)

        def after(value: Value) -> int:
            old = circuit.both(kept, before.literal(value))
            return circuit.disjunction((old, *(circuit.both(w.where, w.value.literal(value)) for w in writes)))

        if set(values) == {False, True} and before.known == circuit.TRUE:
            literal = after(True)
            return Symbol({False: -literal, True: literal})
        return Symbol({value: after(value) for value in values}, circuit.disjunction((before.known, -kept)))

    def conflict(self, first: Writes, second: Writes) -> int:
        """The literal that says that the two write different values to a variable."""
        return self._circuit.disjunction(
            self._circuit.conjunction(
                (first[n].where, second[n].where, -self._reading.same(first[n].value, second[n].value))
            )
            for n in first
            if n in second
        )


def sharing(all_writes: Mapping[str, Writes]) -> list[tuple[str, str]]:
    """The pairs of those that write a common variable, the earlier one first."""
    writers: dict[str, list[str]] = {}
    pairs: dict[tuple[str, str], None] = {}
    for one, writes in all_writes.items():
        for name in writes:
            others = writers.setdefault(name, [])
            pairs |= dict.fromkeys((other, one) for other in others)
            others.append(one)
    return list(pairs)
