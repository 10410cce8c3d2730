"""Planning problem and answer types: goals, requests, plans, proofs, ways back, and log events."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import StrEnum
from typing import Final

from sequence_planner.automaton.automaton import Ability, Automaton, Operation
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import TRUE, Expression
from sequence_planner.language.types import Value

# Questions to the planner and its answers.

LONGEST: Final = 1000  # ticks of a plan: a shift of work
DEPTH: Final = 60  # ticks up to which it is proven that there is no plan: each costs more than the one before


class Contract(StrEnum):
    """Contract of a plan."""

    MINIMAL = "minimal"  # the fewest ticks, then the fewest starts, proven
    FAST = "fast"  # soon, nearly as short, and without needless starts


class Goal(Immutable):
    """A predicate that shall hold after step 3 of some tick, and what a run must keep to until then.

    `local` is a formula of LTL over finite traces. Its positions are the states after step 3 and after each start, up
    to the first after step 3 that satisfies `predicate`; those up to now have brought its automaton
    (`goals.monitor.monitor_of`) to the state `at`. Of goals that cannot be reached together, those of lowest
    `priority` are left out.
    """

    name: str
    predicate: Expression
    local: Expression = TRUE
    at: int = 0
    priority: int = 0


class Circumstances(Immutable):
    """The circumstances that a plan must cope with besides the state.

    Abilities of `offline` resources do not start and their effects do not happen. With `restart`, restart abilities may
    start. No state after step 3 or after a start may satisfy one of `avoid`, nor leave it open. The abilities `barred`
    do not start; what runs of them finishes, and their devices react as ever.
    """

    offline: frozenset[str] = frozenset()
    restart: bool = False
    avoid: tuple[Expression, ...] = ()
    barred: frozenset[str] = frozenset()

    def bars(self, ability: Ability) -> bool:
        """Return whether the ability does not start, whatever the state."""
        absent = ability.resource in self.offline or ability.name in self.barred
        return absent or (ability.restart and not self.restart)


# Everything is online, in an ordinary mode, and nothing is to be avoided.
ORDINARY = Circumstances()


class PlanTick(Immutable):
    """One tick of a plan: the effects that are expected in its sense, then the starts, in order."""

    effects: tuple[str, ...]
    starts: tuple[str, ...]


class Plan(Immutable):
    """A way to the goals. The goals hold after step 3 of the last tick at the latest, so it has no starts."""

    ticks: tuple[PlanTick, ...]
    minimal_ticks: bool
    minimal_starts: bool

    @property
    def starts(self) -> tuple[tuple[int, str], ...]:
        """The start order, each with the number of its tick, counted from 1."""
        return starts_of(self.ticks)


class PlanRequest(Immutable):
    """A state to plan from and the goals that shall be reached, until `deadline` seconds have passed.

    A plan has at most `longest` ticks; see `Task` for the rest.
    """

    state: Mapping[str, Value | None]
    goals: tuple[Goal, ...]
    deadline: float = 5.0
    longest: int = LONGEST
    contract: Contract = Contract.MINIMAL
    circumstances: Circumstances = ORDINARY


class Verdict(StrEnum):
    """The kind of an answer."""

    FOUND = "found"
    NONE_UP_TO = "none up to"  # none within the searched number of ticks
    NONE_AT_ALL = "none at all"  # proven
    LATE = "deadline"  # neither a plan nor a proof in time


class Literal(Immutable):
    """A variable or flag has the value, or with `equal` false it has not: it has another one, or none."""

    name: str
    value: Value
    equal: bool = True


Clause = tuple[Literal, ...]


class ConservedSum(Immutable):
    """A sum of the `weights` of values, of 0 where none is given, that is `total` and that no start changes: exactly,
    or modulo `modulus` if that is not 0.
    """

    weights: Mapping[str, Mapping[Value, int]]
    total: int
    modulus: int = 0

    def residue(self, number: int) -> int:
        """The number as it counts."""
        return number % self.modulus if self.modulus else number

    def is_other(self, difference: int) -> bool:
        """Return whether sums with this difference are not the same."""
        return self.residue(difference) != 0

    def holds_in(self, values: Mapping[str, Value | None]) -> bool:
        """Return whether the sum of these values, all of which are known, is the one."""
        there = [(weights, values[name]) for name, weights in self.weights.items()]
        known = sum(weights.get(value, 0) for weights, value in there if value is not None)
        return all(value is not None for _, value in there) and not self.is_other(known - self.total)


class CertificateError(Exception):
    """An alleged proof that proves nothing; the message says which step fails."""


class Proof(Immutable):
    """A proof that there is no plan at all: an inductive invariant of the state to plan from, in which no goal is
    reached.

    Every tick leads from states that satisfy all `invariant` clauses into such states, and the goals that are reached
    on the way never are all of them. Of several goals clauses also say whether one has been reached,
    `goal.<name>.reached`, and of formulas in which state their automata are, `goal.<name>.at`. `by` is the method that
    found it. One by `pdr` has been checked by a solver of its own; those by `relaxation` and `pairs`, whose clauses
    say no more than that values are never taken, or two never together, have not, but pass the same check
    (`pdr.invariants`). One by `sums` says that a sum is `conserved`, and has been checked start by start
    (`validation.conservation`).
    """

    by: str
    invariant: tuple[Clause, ...]
    conserved: ConservedSum | None = None


class PlanAnswer(Immutable):
    """An answer. `left_out` are goals that could not be planned together with the others, lowest priority first.

    Of these, `undecided` are those of which that is not proven: no plan for them too was found in the time there was,
    or with so many ticks. `searched` is the number of ticks up to which it is proven that there is no shorter plan;
    `engine` gave the answer, and `seconds` is the time it took.
    """

    verdict: Verdict
    plan: Plan | None
    goals: tuple[str, ...]
    left_out: tuple[str, ...]
    searched: int
    seconds: float
    engine: str = ""
    proof: Proof | None = None
    undecided: tuple[str, ...] = ()


class WayBackRequest(Immutable):
    """A state outside the safe set, from which a way back is wanted until `deadline` seconds have passed."""

    state: Mapping[str, Value | None]
    deadline: float = 2.0
    longest: int = 40
    circumstances: Circumstances = ORDINARY  # whether restart abilities may start is not asked


class RecoveryPath(Immutable):
    """A way into the safe set, with the fewest ticks and then the fewest starts.

    `end` is the first safe state on it, one after step 3 or after the last of its starts. `breaks` are the
    specifications that it violates on the way although they were not violated before.
    """

    ticks: tuple[PlanTick, ...]
    end: Mapping[str, Value | None]
    breaks: tuple[str, ...]
    minimal_starts: bool

    @property
    def starts(self) -> tuple[tuple[int, str], ...]:
        """The starts in order, each with the number of its tick, counted from 1."""
        return starts_of(self.ticks)


class WayBackAnswer(Immutable):
    """An answer. Without a way, there is none of up to `searched` ticks.

    `threatened` are specifications that are not violated yet and that what happens without starts, faults included, can
    violate soonest; none are named while one is violated.
    """

    way: RecoveryPath | None
    threatened: tuple[str, ...]
    searched: int
    seconds: float


def one_by_one(order: Iterable[str], minimal: bool = False) -> Plan:
    """A plan that takes the starts of `order`, each in a tick of its own; `minimal` if no plan has fewer."""
    ticks = (*(PlanTick((), (name,)) for name in order), PlanTick((), ()))
    return Plan(ticks, minimal_ticks=minimal, minimal_starts=minimal)


def starts_of(ticks: Iterable[PlanTick]) -> tuple[tuple[int, str], ...]:
    """All starts, each with the number of its tick, counted from 1."""
    return tuple((number, name) for number, tick in enumerate(ticks, 1) for name in tick.starts)


def goal_of(operation: Operation, at: int = 0) -> Goal:
    """The goal of an active operation whose local formula's automaton has come to the state `at`."""
    return Goal(operation.name, operation.goal, operation.local or TRUE, at, operation.priority)


def goals_of(automaton: Automaton, names: Iterable[str]) -> tuple[Goal, ...]:
    """The goals of operations by name, before the first position of their runs."""
    return tuple(goal_of(automaton.operations[name]) for name in names)


# What goes wrong within the planner, for the log.


def log(message: str, *arguments: object, trace: bool = False) -> None:
    """Note an error; with `trace`, where the exception that is being handled comes from."""
    # Importing it takes a sixth of the time that importing the planner takes.
    import logging  # noqa: PLC0415

    logging.getLogger(__package__).error(message, *arguments, exc_info=trace)
