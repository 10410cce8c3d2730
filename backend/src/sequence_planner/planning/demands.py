"""Demands of a start on the state before it, and what it leaves in the one after it, as far as its text alone says
so.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from functools import cached_property
from typing import NamedTuple

from sequence_planner.automaton.automaton import Ability, Automaton, State, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import (
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Variable,
    conjunction,
    conjuncts,
    variables,
)
from sequence_planner.language.types import Value
from sequence_planner.planning.partial_states import PartialState

Becomes = tuple[tuple[Value, Value], ...]  # for values of a variable, what is written to another
Some = int  # of the values of a variable, a bit each, in the order of its domain

_BINARY = (Comparison, Arithmetic)


class Domains:
    """The variables of an automaton with their values by number, and what has been asked of each alone."""

    def __init__(self, automaton: Automaton) -> None:
        self.automaton = automaton
        self.values = {name: variable.type.domain for name, variable in automaton.variables.items()}
        self.number = {name: {value: n for n, value in enumerate(each)} for name, each in self.values.items()}
        kinds: dict[object, int] = {}  # equal numbers are given to equal domains
        self._kind = {n: kinds.setdefault((type(each[0]), each), len(kinds)) for n, each in self.values.items()}
        self._asked: dict[object, Some] = {}
        self._became: dict[object, Becomes] = {}

    def asked(self, predicate: Expression) -> tuple[str, Some] | None:
        """The variable that `predicate` reads, if that is one alone, and the values with which it holds."""
        name, shape = self._shape(predicate)
        if name is None:
            return None
        if shape not in self._asked:
            each = enumerate(self.values[name])
            found = sum(1 << n for n, value in each if evaluate(predicate, PartialState({name: value})) is True)
            if shape is None:
                return name, found
            self._asked[shape] = found
        return name, self._asked[shape]

    def becomes(self, name: str, value: Expression, asked: Mapping[str, Some]) -> tuple[str | None, Becomes | None]:
        """The variable that `value`, which is written to another, reads, if that is one alone, and what is written for
        each of its values that is `asked` for.
        """
        source, shape = self._shape(value)
        if source is None:
            return None, None
        values = asked.get(source, -1)
        key = None if shape is None else (shape, values, self._kind[name])
        if key not in self._became or key is None:
            domain = self.number[name]
            results = ((each, evaluate(value, PartialState({source: each}))) for each in self.some(source, values))
            found = tuple((each, after) for each, after in results if after in domain)
            if key is None:
                return source, found
            self._became[key] = found
        return source, self._became[key]

    def _shape(self, expression: Expression) -> tuple[str | None, object]:
        """The variable that is read, if that is one alone, and what else there is to the expression, if it is short.

        Two of one shape have the same value where their variables have.
        """
        inner = expression
        more: list[Value] = []
        while isinstance(inner, _BINARY) and isinstance(inner.right, Constant):
            more += (inner.operator, inner.right.value)
            inner = inner.left
        if isinstance(inner, Variable):
            return (inner.name, (self._kind[inner.name], *more)) if inner.name in self.values else (None, None)
        names = set(variables(expression))
        return (names.pop(), None) if len(names) == 1 and names <= self.values.keys() else (None, None)

    def some(self, name: str, values: Some) -> list[Value]:
        """The values themselves."""
        return [value for n, value in enumerate(self.values[name]) if values >> n & 1]

    def only(self, name: str, values: Some) -> Value | None:
        """The value if it is one alone."""
        return self.values[name][values.bit_length() - 1] if values and not values & (values - 1) else None


class Written(NamedTuple):
    """A variable that is written by `action`: where `source` has one of these values, the value beside it.

    Without a `source` it is the only one of `becomes` whatever the state is, or, if that is None, any value.
    """

    name: str
    action: Assignment
    source: str | None
    becomes: Becomes | None


class Demands:
    """Of one ability: the values that variables have wherever it starts, and those that they have then.

    What else it asks for is in `others`, and it reads the variables `reads`, some of them through flags.
    """

    def __init__(self, domains: Domains, ability: Ability) -> None:
        self._domains = domains
        self.asked: dict[str, Some] = {}
        self.others: list[Expression] = []
        for part in conjuncts(conjunction(ability.enabled, ability.start_guard)):
            alone = domains.asked(part)
            if alone is None:
                self.others.append(part)
            else:
                name, values = alone
                self.asked[name] = self.asked.get(name, -1) & values
        actions = ability.start_actions
        self.writes = [self._written(action) for action in actions]
        self.written = frozenset(map(target, actions))
        read = [*self.others, *(action.condition for action in actions if action.condition is not None)]
        read += (each.action.value for each in self.writes if each.becomes is None)
        self.reads = self.asked.keys() | {each.source for each in self.writes if each.source is not None}
        if read:
            self.reads |= read_variables(domains.automaton, read)

    def _written(self, action: Assignment) -> Written:
        name, value = target(action), action.value
        if type(value) is Constant:
            known = value.value in self._domains.number[name]
            return Written(name, action, None, ((value.value, value.value),) if known else ())
        return Written(name, action, *self._domains.becomes(name, value, self.asked))

    @cached_property
    def surely_written(self) -> frozenset[str]:
        """The variables that it writes in any case."""
        return frozenset(written.name for written in self.writes if written.action.condition is None)

    @cached_property
    def left(self) -> Mapping[str, Some]:
        """The values that variables can have right after it; those that are not there, any."""
        left = {name: values for name, values in self.asked.items() if name not in self.written}
        for written in self.writes:
            if written.becomes is not None and written.action.condition is None:
                number = self._domains.number[written.name]
                left[written.name] = 0
                for _, value in written.becomes:
                    left[written.name] |= 1 << number[value]
        return left

    @cached_property
    def _known(self) -> PartialState:
        """The values of those that can have but one."""
        return PartialState(self._single(self.left))

    def _single(self, some: Mapping[str, Some]) -> Iterator[tuple[str, Value]]:
        for name, values in some.items():
            if (value := self._domains.only(name, values)) is not None:
                yield name, value

    def excludes(self, other: Demands) -> bool:
        """Return whether `other` cannot start in the same tick after this start and no others."""
        left = self.left
        for name, values in other.asked.items():
            if not left.get(name, -1) & values:
                return True
        return any(self._refuses(part) for part in other.others)

    def _refuses(self, part: Expression) -> bool:
        if type(part) is Comparison and part.operator == "==" and type(part.left) is type(part.right) is Variable:
            one, same = (self.left.get(each.name) for each in (part.left, part.right))
            if one is not None and same is not None and self._apart(part.left.name, one, part.right.name, same):
                return True
        return evaluate(part, self._known) is False

    def _apart(self, name: str, some: Some, other: str, others: Some) -> bool:
        """Return whether two variables with these values have none in common."""
        return set(self._domains.some(name, some)).isdisjoint(self._domains.some(other, others))

    def undone_by(self, other: Demands) -> bool:
        """Return whether `other`, right after this start, leaves every variable as it was before this start."""
        own, others = self._constants, other._constants
        if own is None or others is None:
            return False
        return all(name in self._before and self._before[name] == value for name, value in {**own, **others}.items())

    def commutes_with(self, other: Demands) -> bool:
        """Return whether `other`, where it can start after this, can start before this just as well, to the same
        effect.
        """
        own, others = self._constants, other._constants
        if own is None or others is None:
            return False
        if any(own[name] != others[name] for name in self.written & other.written):
            return False
        known = PartialState({n: v for n, v in other._before.items() if n not in self.written})
        known.update(self._before)
        if not other._holds(self.written, known):
            return False
        known.update(others)
        return self._holds(other.written, known)

    @cached_property
    def _constants(self) -> Mapping[str, Value] | None:
        """The values it writes, if these are constants in any case."""
        found: dict[str, Value] = {}
        for written in self.writes:
            if type(written.action.value) is not Constant or written.action.condition is not None:
                return None
            found[written.name] = written.action.value.value
        return found

    @cached_property
    def _before(self) -> dict[str, Value]:
        """The values of variables that can have but one before it."""
        return dict(self._single(self.asked))

    @cached_property
    def _read_by_others(self) -> list[tuple[Expression, frozenset[str]]]:
        return [(part, read_variables(self._domains.automaton, (part,))) for part in self.others]

    def _holds(self, changing: Set[str], state: State) -> bool:
        """Return whether what is asked of what is `changing` is so in `state`."""
        for name in changing & self.asked.keys():
            value = state[name]
            if value is None or not self.asked[name] >> self._domains.number[name][value] & 1:
                return False
        return all(
            evaluate(part, state) is True for part, read in self._read_by_others if not read.isdisjoint(changing)
        )


class Starts:
    """The demands of each start of an automaton and what it leaves, made when it is first asked about."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self.domains = Domains(automaton)
        self._guards = supervisor.guards
        self._demands: dict[str, Demands] = {}

    def __getitem__(self, name: str) -> Demands:
        if name not in self._demands:
            self._demands[name] = Demands(self.domains, self.domains.automaton.abilities[name])
        return self._demands[name]

    def guarded(self, name: str) -> frozenset[str]:
        """The variables that the supervisor looks at to allow it."""
        guard = self._guards.get(name)
        return frozenset() if guard is None else frozenset(guard.names)
