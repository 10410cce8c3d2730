"""Pair invariants, and independent verification of unsolvability proofs with CaDiCaL."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

import pysolvers

from sequence_planner.automaton.automaton import Ability, Automaton
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import synchronise
from sequence_planner.core.immutable import replace
from sequence_planner.language.syntax import TRUE, Variable
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.monitor import monitor_of
from sequence_planner.planning.goals.tracking import Progress, Tracker
from sequence_planner.planning.pdr.abstraction import Orders, localisable, localised
from sequence_planner.planning.pdr.proof_clauses import asserted, one_of, open_to
from sequence_planner.planning.pdr.transition_relation import Cube, Relation, TickQueries
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import CertificateError, Clause, Goal, Literal, Proof
from sequence_planner.planning.sat.encoding import Encoding, SymbolicTick
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.symbolic import Reading, Symbol, SymbolicState
from sequence_planner.process.budget import Budget

# Invariants of pairs: what is never so together, found by taking away what a tick makes so (Rintanen 1998).
#
# To begin with no two values are together but those of the beginning. A tick from where that is so may bring others
# together; what is left when none does is the strongest invariant whose clauses have two literals. Many a goal cannot
# be reached for such a reason alone: two users of one thing, a place that is taken, a state that a specification
# forbids. The number of pairs grows with the square of what is seen, and the number of questions much slower: one
# answer brings all values of a state together.

# Values beyond which there are too many pairs of them.
_MOST_FACTS = 120

# Questions after which the search goes on elsewhere.
_MOST_QUESTIONS = 400

# Questions between two looks at whether the goals can still be excluded.
_LOOK = 4


def excluded_pairs(relation: Relation, beginning: Cube, budget: Budget) -> tuple[Cube, ...] | None:
    """Cubes of one or two literals, an invariant that excludes the goals; None if no such cubes do, or too many.

    Raises `SpentError`.
    """
    facts = _facts(relation)
    return _Pairs(relation, facts, beginning, budget).invariant() if len(facts) <= _MOST_FACTS else None


def never_paired(relation: Relation, beginning: Cube, budget: Budget) -> tuple[Cube, ...]:
    """All pairs of values, each of which occurs, that are never together: the strongest invariant of that kind.

    Raises `SpentError`.
    """
    return _Pairs(relation, _facts(relation), beginning, budget).strongest()


def _facts(relation: Relation) -> list[int]:
    """A literal for each value of each variable."""
    bits = Counter(literal.name for literal in relation.meanings.values())
    facts: list[int] = []
    for bit, literal in relation.meanings.items():
        facts += (bit,) if bits[literal.name] > 1 else (bit, -bit)
    return facts


class _Pairs:
    """Facts become possible one by one; only of those that are, pairs are looked at."""

    def __init__(self, relation: Relation, facts: Sequence[int], beginning: Cube, budget: Budget) -> None:
        self._relation = relation
        self._inquiry = TickQueries(relation, budget)
        self._inquiry.demand(list(relation.unfinished))
        self._inquiry.prefer([relation.reached, *relation.choices])
        self._impossible = list(facts)
        self._possible: list[int] = []
        self._apart: dict[Cube, int] = {}  # what has not come together yet, with the literals that say it does not ...
        self._meeting: dict[Cube, int] = {}  # ... before the tick, and that it does after it
        self._more = self._inquiry.fresh()  # that anything comes together of which the clauses so far do not speak
        self._inquiry.demand([relation.reached, self._more])
        self._part([(fact,) for fact in facts])
        excluded = {-literal for literal in beginning}
        self._together({fact for fact in facts if fact not in excluded})

    def invariant(self) -> tuple[Cube, ...] | None:
        """Return what is never together, as far as the goals are excluded by it."""
        relation, inquiry = self._relation, self._inquiry
        for question in range(_MOST_QUESTIONS):
            apart = self._apart.values()
            if question % _LOOK == 0 and inquiry.solves([relation.valid, relation.reached, *apart]):
                return None
            if not inquiry.solves([relation.valid, -self._more, *apart]):
                return self._needed()
            true = set(inquiry.model())
            if relation.reached in true:
                return None
            facts = (*self._impossible, *self._possible)
            self._together({fact for fact in facts if relation.after(fact) in true})
        return None

    def strongest(self) -> tuple[Cube, ...]:
        """The pairs that are never together, whatever the goals are."""
        relation, inquiry = self._relation, self._inquiry
        while inquiry.solves([relation.valid, -self._more, *self._apart.values()]):
            true = set(inquiry.model())
            self._together({fact for fact in (*self._impossible, *self._possible) if relation.after(fact) in true})
        return tuple(cube for cube in self._apart if len(cube) > 1)

    def _together(self, facts: set[int]) -> None:
        """All of `facts` may be so together."""
        new = [fact for fact in self._impossible if fact in facts]
        if new:
            self._impossible = [fact for fact in self._impossible if fact not in facts]
            pairs: list[Cube] = []
            for fact in new:
                name = self._relation.meanings[abs(fact)].name
                pairs += [(other, fact) for other in self._possible if self._relation.meanings[abs(other)].name != name]
                self._possible.append(fact)
            self._part(pairs)
        for cube in [cube for cube in self._apart if facts.issuperset(cube)]:
            del self._apart[cube]
            self._inquiry.demand([-self._meeting.pop(cube)])

    def _part(self, cubes: list[Cube]) -> None:
        """Take it that none of `cubes` is ever so, until one is."""
        inquiry, after = self._inquiry, self._relation.after
        for cube in cubes:
            apart, meeting = inquiry.fresh(), inquiry.fresh()
            inquiry.demand([-apart, *(-fact for fact in cube)])
            for fact in cube:
                inquiry.demand([-meeting, after(fact)])
            self._apart[cube], self._meeting[cube] = apart, meeting
        more = inquiry.fresh()
        inquiry.demand([-self._more, *(self._meeting[cube] for cube in cubes), more])
        self._more = more

    def _needed(self) -> tuple[Cube, ...]:
        """Those of the cubes that it takes to exclude the goals, and to stay excluded themselves."""
        relation, inquiry = self._relation, self._inquiry
        cubes = {apart: cube for cube, apart in self._apart.items()}
        needed: dict[Cube, None] = {}
        target = relation.reached
        while True:
            assert not inquiry.solves([relation.valid, target, *self._apart.values()])
            core = inquiry.core()
            new = [cube for apart, cube in cubes.items() if apart in core and cube not in needed]
            if not new:
                return tuple(sorted(needed))
            needed |= dict.fromkeys(new)
            target = inquiry.passing([self._meeting[cube] for cube in new])


# The solver of those who check: CaDiCaL 1.5.3 (Biere et al. 2020), with which no proof was found.

# Conflicts after which the clock is looked at; nothing else can stop this solver.
_AT_ONCE = 1000


class SecondSolver:
    """Clauses are added and questions asked in any order."""

    def __init__(self) -> None:
        self._handle: object = pysolvers.cadical153_new()

    def __del__(self) -> None:
        pysolvers.cadical153_del(self._handle, None)

    def add_clause(self, clause: Sequence[int]) -> None:
        """Demand that one of the literals is true."""
        pysolvers.cadical153_add_cl(self._handle, clause)

    def solve(self, assumptions: Sequence[int], budget: Budget) -> bool:
        """Return whether the clauses can be satisfied under `assumptions`. Raises `SpentError`."""
        while True:
            budget.require()
            pysolvers.cadical153_cbudget(self._handle, _AT_ONCE)
            answer = pysolvers.cadical153_solve_lim(self._handle, assumptions, 0)
            if answer != 0:
                return answer > 0


# Proofs that there is no plan, checked by another solver, on clauses of their own.


def check(
    automaton: Automaton,
    supervisor: Supervisor,
    task: PlanningTask,
    proof: Proof,
    budget: Budget,
    orders: Orders | None = None,
    whole: bool = False,
    free: frozenset[str] = frozenset(),
) -> None:
    """Raises `CertificateError` unless `proof` shows that the goals of `task` cannot be reached from its state.

    Nor may they from one like it with any values of the variables `free`; flags follow what is free.

    What the proof speaks of is looked at first, which is enough for most; the whole automaton if that is not enough or
    if it is wanted. `orders` are those of the automaton, if they are at hand. Where the state's flags are as
    synchronisation leaves them, those of every state on the way are. Raises `SpentError`.
    """
    orders = orders or Orders(automaton, supervisor)
    task = replace(task, state=one_of(automaton, task.state, free))
    open_ = open_to(automaton, free)
    if whole or not _without_need_of_the_rest(automaton, supervisor, task, proof, budget, orders, open_):
        _Check(automaton, supervisor, task, orders.whole(task, budget), budget).run(proof, open_)


def _without_need_of_the_rest(
    automaton: Automaton,
    supervisor: Supervisor,
    task: PlanningTask,
    proof: Proof,
    budget: Budget,
    orders: Orders,
    open_: frozenset[str],
) -> bool:
    """Return whether the proof is one for the part of the automaton that it speaks of, and so for all of it."""
    if not localisable(automaton, task.state, task.goals):
        return False
    names = {literal.name for clause in proof.invariant for literal in clause} & automaton.types.keys()
    read = [Variable(name, automaton.types[name]) for name in sorted(names)]
    asked = [*(goal.predicate for goal in task.goals), *task.circumstances.avoid]
    kept = read_variables(automaton, [*read, *asked])
    seen = localised(automaton, supervisor, kept)
    part = replace(task, state=seen.state(task.state))
    order = orders.part(seen, task, budget)
    try:
        _Check(seen.automaton, seen.supervisor, part, order, budget).run(proof, open_ | seen.oracles.keys())
    except CertificateError:
        return False
    return True


class _Check:
    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, task: PlanningTask, order: Iterable[Ability], budget: Budget
    ) -> None:
        self._budget = budget
        self._task = task
        self._automaton = automaton
        self._solver = SecondSolver()
        self._circuit = Circuit(self._solver)
        self._reading = Reading(self._circuit)
        unknown = frozenset(name for name in automaton.variables if task.state[name] is None)
        encoding = Encoding(automaton, supervisor, self._circuit, unknown)
        self._before = encoding.initial(unknown)
        self._synchronised = synchronise(automaton, task.state) == dict(task.state)
        if self._synchronised:
            for literal in self._follow(self._before):
                self._circuit.require(literal)
        progress = {goal: self._any_progress(goal) for goal in task.goals}
        tick = encoding.tick(self._before, order, budget.require)
        tracker = Tracker(self._circuit)
        after = {goal: tracker.after(goal, progress[goal], tick) for goal in task.goals}
        self._end = tick.end
        self._values_before = _values(self._before, progress)
        self._values_after = _values(tick.end, after)
        self._reached = self._circuit.conjunction(each.reached for each in after.values())
        # Where all have been reached there is nothing left to do; no tick is about to lead there.
        open_ = -self._circuit.conjunction(each.reached for each in progress.values())
        barred = tick.without(task.circumstances.barred)
        self._given = [open_, *encoding.assumptions(task.circumstances), *barred, *self._avoided(tick)]

    def run(self, proof: Proof, open_: frozenset[str]) -> None:
        """All steps of the proof, from the state with any values of what is `open_`."""
        beginning = self._beginning(open_)
        before = [self._clause(clause, self._values_before) for clause in proof.invariant]
        after = [self._clause(clause, self._values_after) for clause in proof.invariant]
        if self._satisfiable([*beginning, -self._circuit.conjunction(before)]):
            raise CertificateError("the state to plan from does not satisfy the invariant")
        if self._satisfiable([*self._given, *before, self._reached]):
            raise CertificateError("the goals are reached from a state that satisfies the invariant")
        if self._satisfiable([*self._given, *before, -self._circuit.conjunction(after)]):
            raise CertificateError("a tick leads out of the states that satisfy the invariant")
        if self._synchronised and self._satisfiable([-self._circuit.conjunction(self._follow(self._end))]):
            raise CertificateError("a tick leaves flags unsynchronised")

    def _beginning(self, open_: frozenset[str]) -> list[int]:
        given = asserted(self._task.state, self._task.goals)
        return [
            literal if given[name] == value else -literal
            for name, symbol in self._values_before.items()
            if name not in open_
            for value, literal in symbol.literals.items()
        ]

    def _follow(self, state: SymbolicState) -> list[int]:
        """That each flag is what its predicate is, where that is determined."""
        follow: list[int] = []
        for flag in self._automaton.flags:
            truth = self._reading.truth(flag.predicate, state)
            for condition, value in ((truth.yes, True), (truth.no, False)):
                follow.append(self._circuit.disjunction((-condition, state[flag.name].literal(value))))
        return follow

    def _clause(self, clause: Clause, values: Mapping[str, Symbol]) -> int:
        return self._circuit.disjunction(self._literal(literal, values) for literal in clause)

    def _literal(self, literal: Literal, values: Mapping[str, Symbol]) -> int:
        if literal.name not in values:
            raise CertificateError(f"the proof speaks of {literal.name}, which the model does not have")
        equal = values[literal.name].literal(literal.value)
        return equal if literal.equal else -equal

    def _any_progress(self, goal: Goal) -> Progress:
        circuit = self._circuit
        reached = circuit.fresh()
        if goal.local == TRUE:
            return Progress(reached, {})
        at = {number: circuit.fresh() for number in range(len(monitor_of(goal.local).steps))}
        circuit.at_most_one([reached, *at.values()])
        return Progress(reached, at)

    def _avoided(self, tick: SymbolicTick) -> list[int]:
        positions = [(Circuit.TRUE, tick.synchronised), *tick.positions]
        return [
            self._circuit.disjunction((-chosen, self._reading.truth(condition, state).no))
            for condition in self._task.circumstances.avoid
            for chosen, state in positions
        ]

    def _satisfiable(self, assumptions: list[int]) -> bool:
        return self._solver.solve(assumptions, self._budget)


def _values(state: SymbolicState, progress: Mapping[Goal, Progress]) -> dict[str, Symbol]:
    """Return what clauses can speak of."""
    values = dict(state)
    for goal, made in progress.items():
        values[f"goal.{goal.name}.reached"] = Symbol({False: -made.reached, True: made.reached})
        at: dict[Value, int] = {}
        at.update(made.at.items())
        values[f"goal.{goal.name}.at"] = Symbol(at)
    return values
