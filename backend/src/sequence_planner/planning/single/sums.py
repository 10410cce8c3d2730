"""The engine that proves what sums exclude: weighted sums of values that no start changes, exactly or modulo a prime.

Whatever a start changes is a row of differences; weights by which every row comes to nothing make a sum that stays what
it is (place invariants of Petri nets, Lautenbach and Schmid 1974). Modulo 2 it is a parity. Where no state in which a
goal holds has the sum of the state to plan from, the goal is never reached.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from typing import Final

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.syntax import Expression, conjuncts
from sequence_planner.language.types import Value
from sequence_planner.planning.demands import Demands, Some, Starts, Written
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import ConservedSum, Proof
from sequence_planner.planning.validation.conservation import check_conserved
from sequence_planner.process.budget import Budget, SpentError

NAME: Final = "sums"
_PRIMES: Final = (2, 2**31 - 1)
_MOST_PAIRS = 64  # of values before and after a start that are told apart
_MOST_WEIGHT = 1000  # of sums over the integers: others are hardly what a person has built

Row = dict[int, int]  # by column


class Sums:
    """Proves for one automaton, whose starts are taken one at a time, that goals are never reached."""

    name = NAME

    def __init__(self, automaton: Automaton, supervisor: Supervisor, starts: Starts | None = None) -> None:
        """Leave aside what the supervisor allows: nothing more than can be proven without it is."""
        self._automaton = automaton
        self._starts = starts or Starts(automaton, supervisor)
        self._values: dict[str, dict[Value, Row]] = {}
        column = 0
        for name, domain in self._starts.domains.values.items():
            if all(isinstance(value, int) and not isinstance(value, bool) for value in domain):
                self._values[name] = {value: {column: int(value)} for value in domain}
                column += 1
            else:
                self._values[name] = {v: {column + n - 1: 1} if n else {} for n, v in enumerate(domain)}
                column += len(domain) - 1
        self._rows: list[Row] | None = None
        self._all = _Unchanged({c for each in self._values.values() for row in each.values() for c in row}, _PRIMES[-1])

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A proof that there is no plan at all, or nothing. Raises `CertificateError` where it is none."""
        if None in task.state.values():
            return Finding()
        try:
            if self._rows is None:
                self._rows = self._changes(budget.require)
            for goal in task.goals:
                conserved = self._conserved(goal.predicate, task.state, self._rows, budget.require)
                if conserved is not None:
                    check_conserved(self._automaton, task, conserved, budget.require)
                    return Finding(proof=Proof(NAME, (), conserved))
        except SpentError:
            pass
        return Finding()

    def _conserved(
        self, predicate: Expression, state: State, rows: list[Row], pause: Callable[[], object]
    ) -> ConservedSum | None:
        """A sum that is another one in `state` than where the parts of a conjunction hold that read one variable."""
        asked: dict[str, Some] = {}
        for part in conjuncts(predicate):
            if (alone := self._starts.domains.asked(part)) is not None:
                asked[alone[0]] = asked.get(alone[0], -1) & alone[1]
        bounds = self._bounds(asked)
        if bounds is None:
            return None  # for others to say
        now = {column: weight for name in self._values for column, weight in self._at(name, state).items()}
        fixed = {column for column, (least, most) in bounds.items() if least == most}
        for prime in _PRIMES:
            for weights in _Unchanged(fixed, prime).found(rows, pause):
                if sum(w * (bounds[column][0] - now.get(column, 0)) for column, w in weights.items()) % prime:
                    return self._sum(weights, state, prime)
        for weights in self._all.found(rows, pause):
            exact = _exact(weights, rows)
            if exact is not None:
                there = sum(w * now.get(column, 0) for column, w in exact.items())
                least = sum(min(w * bound for bound in bounds[column]) for column, w in exact.items())
                most = sum(max(w * bound for bound in bounds[column]) for column, w in exact.items())
                if not least <= there <= most:
                    return self._sum(exact, state)
        return None

    def _sum(self, by_column: Row, state: State, modulus: int = 0) -> ConservedSum:
        """The same by values of variables."""
        weights: dict[str, dict[Value, int]] = {}
        for name, values in self._values.items():
            each = {value: sum(by_column.get(c, 0) * n for c, n in row.items()) for value, row in values.items()}
            if any(each.values()):
                weights[name] = {value: weight for value, weight in each.items() if weight}
        there = (each.get(value, 0) for name, each in weights.items() if (value := state[name]) is not None)
        return ConservedSum(weights, sum(there), modulus)

    def _at(self, name: str, state: State) -> Row:
        value = state[name]
        assert value is not None
        return self._values[name][value]

    def _bounds(self, asked: Mapping[str, Some]) -> dict[int, tuple[int, int]] | None:
        """Between which each column is where that is asked for; None if nowhere."""
        bounds: dict[int, tuple[int, int]] = {}
        for name, values in self._values.items():
            possible = self._starts.domains.some(name, asked.get(name, -1))
            if not possible:
                return None
            for column in {column for row in values.values() for column in row}:
                each = [values[value].get(column, 0) for value in possible]
                bounds[column] = min(each), max(each)
        return bounds

    def _changes(self, pause: Callable[[], object]) -> list[Row]:
        """Return what spans all differences that starts can make."""
        rows: dict[tuple[tuple[int, int], ...], Row] = {}
        for name in self._automaton.abilities:
            pause()
            for row in self._of(self._starts[name]):
                rows[tuple(sorted(row.items()))] = row
        return [row for key, row in rows.items() if key]

    def _of(self, demands: Demands) -> Iterator[Row]:
        """One choice of what it writes, and how any other choice differs from that."""
        first: Row = {}
        for written in demands.writes:
            differences = self._differences(demands, written)
            if not differences:
                return  # it can never start
            one, *others = differences
            first = _plus(first, one, 1)
            yield from (_plus(other, one, -1) for other in others)
        yield first

    def _differences(self, demands: Demands, written: Written) -> list[Row]:
        """Return what it can make of the columns of a variable."""
        values, domains = self._values[written.name], self._starts.domains
        before = domains.some(written.name, demands.asked.get(written.name, -1))
        if written.source == written.name and written.becomes is not None:
            pairs = list(written.becomes)
        else:
            after = list(values) if written.becomes is None else [value for _, value in written.becomes]
            if len(before) * len(after) > _MOST_PAIRS:  # then any value after any other
                columns = {column for row in values.values() for column in row}
                return [{}, *({column: 1} for column in columns)]
            pairs = [(one, other) for one in before for other in after]
        if written.action.condition is not None:
            pairs += [(value, value) for value in before]
        rows = (_plus(values[after], values[before_], -1) for before_, after in pairs)
        return list({tuple(sorted(row.items())): row for row in rows}.values())


def _plus(row: Row, other: Row, times: int) -> Row:
    found = dict(row)
    for column, value in other.items():
        found[column] = found.get(column, 0) + times * value
        if not found[column]:
            del found[column]
    return found


class _Unchanged:
    """Weights of `columns`, a basis, by which every row comes to nothing modulo `prime`: the kernel, by elimination."""

    def __init__(self, columns: Set[int], prime: int) -> None:
        self._columns = columns
        self._prime = prime
        self._leading: dict[int, Row] = {}
        self._done = 0  # rows

    def found(self, rows: Sequence[Row], pause: Callable[[], object]) -> Iterator[Row]:
        """One after the other. `pause` may raise; asked again, it goes on."""
        for row in rows[self._done :]:
            pause()
            self._eliminate(row)
            self._done += 1
        down = sorted(self._leading, reverse=True)
        for free in sorted(self._columns - self._leading.keys()):
            pause()
            weights = {free: 1}
            for first in down:
                if first < free:
                    terms = (value * weights.get(column, 0) for column, value in self._leading[first].items())
                    if total := sum(terms) % self._prime:
                        weights[first] = self._prime - total
            yield weights

    def _eliminate(self, row: Row) -> None:
        prime, leading = self._prime, self._leading
        left = {column: value % prime for column, value in row.items() if column in self._columns and value % prime}
        while left:
            first = min(left)
            times = left[first]
            if first not in leading:
                inverse = pow(times, -1, prime)
                leading[first] = {column: value * inverse % prime for column, value in left.items()}
                return
            for column, value in leading[first].items():
                after = (left.get(column, 0) - times * value) % prime
                if after:
                    left[column] = after
                else:
                    left.pop(column, None)


def _exact(weights: Row, rows: list[Row]) -> Row | None:
    """The same as integers, if they are small, and every row comes to nothing by them exactly."""
    prime = _PRIMES[-1]
    found = {column: weight if 2 * weight < prime else weight - prime for column, weight in weights.items()}
    if any(abs(weight) > _MOST_WEIGHT for weight in found.values()):
        return None
    if any(sum(found.get(column, 0) * value for column, value in row.items()) for row in rows):
        return None
    return found
