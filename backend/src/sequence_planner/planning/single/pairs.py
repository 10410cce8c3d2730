"""The engine that proves what pairs of values exclude: which values two variables ever have at the same time.

From the state to plan from on it is noted which values can be there, each with which others; a start is taken where
what it asks for can be there, pair by pair, and what it writes is noted with all that can have been there beside it
(h^2 of Haslum and Geffner 2000). That only adds, so it ends soon. The values that are never noted together are an
invariant: no start leads to them from states without them.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import reduce
from operator import or_
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.syntax import Expression, conjuncts
from sequence_planner.planning.demands import Demands, Some, Starts, Written
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Clause, Literal, Proof
from sequence_planner.process.budget import Budget, SpentError

NAME = "pairs"  # of proofs, too

_MOST = 1500  # values of all variables together

Facts = int  # a set of values of variables, a bit each


class _Asked(NamedTuple):
    """One of these values, all of one variable, is asked for; `others` are those of other variables."""

    values: Facts
    others: Facts


class _Outcome(NamedTuple):
    """A value that may be written where that is asked for; `others` are those of other variables."""

    value: int
    others: Facts
    asked: tuple[_Asked, ...]


class _Start(NamedTuple):
    """The demands of a start, what it may write, and the values of variables that it does not write in any case."""

    asked: tuple[_Asked, ...]
    outcomes: tuple[_Outcome, ...]
    left: Facts


class _Work:
    """The notes made for a task so far, and the starts that they may matter to."""

    def __init__(self, task: PlanningTask, noted: list[Facts], waiting: set[int]) -> None:
        self.task = task
        self.noted = noted
        self.waiting = waiting


class PairProver:
    """Proves for one automaton, whose starts are taken one at a time, that goals are never reached.

    Asked again, it goes on where the budget was spent.
    """

    name = NAME

    def __init__(self, automaton: Automaton, supervisor: Supervisor, starts: Starts | None = None) -> None:
        """Leave aside what the supervisor allows: nothing more than can be proven without it is."""
        self._demands = starts or Starts(automaton, supervisor)
        self._facts = [(name, value) for name, each in automaton.variables.items() for value in each.type.domain]
        self._number = {fact: number for number, fact in enumerate(self._facts)}
        self._all = (1 << len(self._facts)) - 1
        self._own: dict[str, Facts] = defaultdict(int)  # all values of a variable
        self._first: dict[str, int] = {}  # and the number of the first
        for number, (name, _) in enumerate(self._facts):
            self._own[name] |= 1 << number
            self._first.setdefault(name, number)
        self._names = tuple(automaton.abilities)
        self._starts: list[_Start] = []  # in this order, as far as they have been looked at
        self._readers: dict[int, set[int]] = defaultdict(set)  # of each value, the starts that it matters to
        self._unasked: set[int] = set()  # starts that ask for nothing, so that all values matter to them
        self._work: _Work | None = None

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A proof, or nothing."""
        if len(self._facts) > _MOST:
            return Finding()
        wanted = [tuple(self._asked(goal.predicate)) for goal in task.goals]
        work = self._work
        if work is None or work.task is not task:
            if work is not None and work.task.goals == task.goals and self._in_vain(work, wanted, task.state):
                return Finding()
            work = None
        try:
            if work is None:
                work = self._work = self._begun(task, budget)
            while work.waiting:
                if all(_beside(work.noted, each, self._all) for each in wanted):
                    return Finding()
                budget.require()
                self._note(work)
        except SpentError:
            return Finding()
        if all(_beside(work.noted, each, self._all) for each in wanted):
            return Finding()
        return Finding(proof=Proof(NAME, tuple(self._clauses(work.noted))))

    def _in_vain(self, work: _Work, wanted: Iterable[tuple[_Asked, ...]], state: State) -> bool:
        """Return whether all that is noted for another task, where the goals can be, holds for `state` too, at
        least.
        """
        there = sum(1 << self._number[name, value] for name in self._own if (value := state[name]) is not None)
        inside = all(there & ~work.noted[number] == 0 for number in _bits(there))
        return inside and all(_beside(work.noted, each, self._all) for each in wanted)

    def _begun(self, task: PlanningTask, budget: Budget) -> _Work:
        """The values that are there at first, and all starts. Raises `SpentError`; asked again, it goes on."""
        for name in self._names[len(self._starts) :]:
            budget.require()
            number, start = len(self._starts), self._start(self._demands[name])
            for asked in (*start.asked, *(each for outcome in start.outcomes for each in outcome.asked)):
                for fact in _bits(asked.values):
                    self._readers[fact].add(number)
            if not start.asked:
                self._unasked.add(number)
            self._starts.append(start)
        begin = sum(1 << self._number[name, value] for name in self._own if (value := task.state[name]) is not None)
        noted = [begin if begin >> number & 1 else 0 for number in range(len(self._facts))]
        return _Work(task, noted, set(range(len(self._starts))))

    def _note(self, work: _Work) -> None:
        """Take each of the starts that wait, and have those wait to which it matters what is noted then."""
        noted = work.noted
        layer, work.waiting = work.waiting, set()
        for number in layer:
            for fact, others in self._results(noted, self._starts[number]):
                new = others & ~noted[fact]
                if new:
                    noted[fact] |= new
                    work.waiting |= self._unasked | self._readers[fact]
                    for other in _bits(new):
                        noted[other] |= 1 << fact
                        work.waiting |= self._readers[other]

    def _results(self, noted: list[Facts], start: _Start) -> Iterator[tuple[int, Facts]]:
        """Yield what `start` writes, with all that can be there beside it."""
        before = _beside(noted, start.asked, self._all)
        if not before:
            return
        if not start.asked:
            before &= reduce(or_, noted)
        each = [(outcome, _beside(noted, (*start.asked, *outcome.asked), before)) for outcome in start.outcomes]
        for outcome, beside in each:
            if not beside:
                continue
            together = beside & start.left & outcome.others | 1 << outcome.value
            for other, _ in each:
                if outcome.others >> other.value & 1 and all(asked.values & beside for asked in other.asked):
                    together |= 1 << other.value
            yield outcome.value, together

    def _start(self, demands: Demands) -> _Start:
        asked = tuple(self._of(name, values) for name, values in demands.asked.items())
        left = self._all
        for name in demands.surely_written:
            left &= ~self._own[name]
        return _Start(asked, tuple(o for written in demands.writes for o in self._outcomes(written)), left)

    def _outcomes(self, written: Written) -> Iterator[_Outcome]:
        name, condition = written.name, written.action.condition
        others = self._all & ~self._own[name]
        asked = () if condition is None else tuple(self._asked(condition))
        if written.becomes is None:
            yield from (_Outcome(number, others, asked) for number in _bits(self._own[name]))
            return
        for from_, value in written.becomes:
            source = written.source
            where = (
                () if source is None else (self._of(source, 1 << self._number[source, from_] - self._first[source]),)
            )
            yield _Outcome(self._number[name, value], others, (*asked, *where))

    def _asked(self, predicate: Expression) -> Iterator[_Asked]:
        """Yield what the parts of a conjunction ask for that read one variable; others may ask for more."""
        for part in conjuncts(predicate):
            alone = self._demands.domains.asked(part)
            if alone is not None:
                yield self._of(*alone)

    def _of(self, name: str, values: Some) -> _Asked:
        """One of these values of a variable is asked for."""
        return _Asked(values << self._first[name], self._all & ~self._own[name])

    def _clauses(self, noted: list[Facts]) -> Iterator[Clause]:
        """That no two values are there together that never are."""
        for number, others in enumerate(noted):
            literal = self._without(number)
            if not others:
                yield (literal,)
                continue
            name = self._facts[number][0]
            for other in _bits(self._all & ~others & ~self._own[name] & ((1 << number) - 1)):
                if noted[other]:
                    yield (literal, self._without(other))

    def _without(self, number: int) -> Literal:
        name, value = self._facts[number]
        truth = isinstance(value, bool)
        return Literal(name, not value) if truth else Literal(name, value, equal=False)


def _beside(noted: list[Facts], asked: Iterable[_Asked], among: Facts) -> Facts:
    """The values of `among` that can be there beside what is `asked`, pair by pair; none if that cannot be."""
    beside = among
    asked = tuple(asked)
    for each in asked:
        beside &= reduce(or_, (noted[number] for number in _bits(each.values)), 0) & (each.values | each.others)
    return beside if all(each.values & beside for each in asked) else 0


def _bits(facts: Facts) -> Iterator[int]:
    """The numbers of a set, the lowest first."""
    while facts:
        lowest = facts & -facts
        yield lowest.bit_length() - 1
        facts ^= lowest
