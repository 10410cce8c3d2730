"""Mutually exclusive values in fault-free operation, and the background process that computes them."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.automaton import Ability, Automaton, Flag, Kind
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.syntax import FALSE, TRUE
from sequence_planner.language.types import Value
from sequence_planner.planning.pdr.invariants import never_paired
from sequence_planner.planning.pdr.transition_relation import Relation
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Goal, Literal
from sequence_planner.planning.sat.start_order import sweep_order
from sequence_planner.process.budget import Budget, SpentError
from sequence_planner.process.task import BackgroundTask, WorkerError
from sequence_planner.synthesis.bdd import Diagrams, Function
from sequence_planner.synthesis.reachability import reachable
from sequence_planner.synthesis.transition_relation import NodeLimit, Plant, TooMuchError

# What is never together as long as nothing goes wrong: an estimate's value with what is measured and commanded.
#
# It is all that is not reached from the initial state under the supervisor and without faults, restart abilities and
# calling off included. Where the states that are reached can be said exactly, on decision diagrams, they are; where
# that is too much, an invariant of pairs says less, and nothing that is wrong.

MOST_EFFORT = 5_000_000  # nodes, see `synthesis.transition_relation`
MOST_BITS = 48  # beyond them one step can be too much already

_FLAGS = ("enabled", "executing", "finished")

Pair = tuple[str, Value, str, Value]


class NeverTogether(Immutable):
    """`pairs` are an estimate, its value, another variable and a value that this never has meanwhile.

    `fits` are exactly the states that are reached, over all variables but activities; None where that is not known.
    """

    pairs: frozenset[Pair]
    fits: StateSet | None


def never_together(
    automaton: Automaton, supervisor: Supervisor, budget: Budget, most_bits: int = MOST_BITS
) -> NeverTogether | None:
    """Return what is never together in a station. None when the budget is spent before that is known."""
    counted = _with_all_starts(automaton)
    seen = tuple(name for name, variable in automaton.variables.items() if variable.kind is not Kind.ACTIVITY)
    diagrams, reached = _reached(counted, supervisor, most_bits) or (None, None)
    if diagrams is not None and reached is not None:
        here = diagrams.exists(reached, automaton.names(Kind.ACTIVITY))
        return NeverTogether(frozenset(_apart(automaton, diagrams, here)), diagrams.exported(here, seen))
    try:
        return NeverTogether(frozenset(_paired(counted, supervisor, budget)), None)
    except SpentError:
        return None


def _with_all_starts(automaton: Automaton) -> Automaton:
    """The same with restart abilities as any others, and with a start for whatever can be called off."""
    abilities = {name: replace(ability, restart=False) for name, ability in automaton.abilities.items()}
    flags = list(automaton.flags)
    for ability in automaton.abilities.values():
        if ability.cancel_actions:
            name = f"{ability.name} called off"
            off = Ability(name, ability.resource, name, TRUE, TRUE, ability.cancel_actions, FALSE, FALSE, None, ())
            abilities[name] = off
            flags += [Flag(off.flag(which), TRUE if which == "enabled" else FALSE) for which in _FLAGS]
    return replace(automaton, abilities=abilities, flags=tuple(flags))


def _reached(automaton: Automaton, supervisor: Supervisor, most_bits: int) -> tuple[Diagrams, Function] | None:
    """The states that are reached; None where that is too much."""
    bits = sum((len(variable.type.domain) - 1).bit_length() for variable in automaton.variables.values())
    if bits > most_bits:
        return None
    plant = Plant(automaton, tuple(automaton.variables))
    diagrams, effort = plant.diagrams, NodeLimit(MOST_EFFORT)
    safe = diagrams.imported(supervisor.safe) & diagrams.valid
    helpful = effort.limited(plant.helpful)
    starts = effort.limited(plant.all_starts)
    reached, before = plant.initial, None
    try:
        while reached != before:
            before = reached
            reached = reachable(diagrams, reached, helpful)
            reached |= reachable(diagrams, reached & safe, [*helpful, *starts], safe)
    except (TooMuchError, MemoryError):
        return None
    return diagrams, reached


def _apart(automaton: Automaton, diagrams: Diagrams, reached: Function) -> Iterator[Pair]:
    others = (*automaton.names(Kind.MEASURED), *automaton.names(Kind.OUTPUT))
    for estimate in automaton.names(Kind.ESTIMATED):
        for value, where in diagrams.values(estimate).items():
            believed = reached & where
            if not believed.satisfiable():
                continue  # it never has this value: that is no news of the others
            for other in others:
                for measured, there in diagrams.values(other).items():
                    if not (believed & there).satisfiable() and (reached & there).satisfiable():
                        yield estimate, value, other, measured


def _paired(automaton: Automaton, supervisor: Supervisor, budget: Budget) -> Iterator[Pair]:
    """The pairs that an invariant excludes. Raises `SpentError`."""
    state = initial_state(automaton)
    goals = (Goal("never", FALSE),)
    task = PlanningTask(state, goals)
    activities = frozenset(automaton.names(Kind.ACTIVITY))
    relation = Relation(automaton, supervisor, sweep_order(automaton, supervisor), task, state, budget, activities)
    kinds = {name: variable.kind for name, variable in automaton.variables.items()}
    for pair in never_paired(relation, relation.beginning(state, goals), budget):
        values = [_value(automaton, literal) for literal in relation.excluding(pair)]
        for (one, value), (other, measured) in (values, values[::-1]):
            if kinds.get(one) is Kind.ESTIMATED and kinds.get(other) in (Kind.MEASURED, Kind.OUTPUT):
                yield one, value, other, measured


def _value(automaton: Automaton, excluding: Literal) -> tuple[str, Value]:
    """The value that a literal excludes; of a variable that has two it may say the other one."""
    name, value = excluding.name, excluding.value
    if not excluding.equal:
        return name, value
    domain: tuple[Value, ...] = automaton.types[name].domain
    return name, next(other for other in domain if other != value)


# The search for what is never together, in a process of its own that gives way to all others.

_NICENESS = 15  # it only serves questions


async def find_never_together(automaton: Automaton, supervisor: Supervisor, seconds: float) -> NeverTogether | None:
    """Return what is never together; nothing when that is not found within so many seconds of work, as it would not be
    another time. None when the process has ended early. It can be cancelled.
    """
    task = BackgroundTask(_found, (automaton, supervisor, seconds), "never-together", _NICENESS)
    try:
        return await task.found()
    except WorkerError:
        return None


def _found(automaton: Automaton, supervisor: Supervisor, seconds: float) -> NeverTogether:
    found = never_together(automaton, supervisor, Budget(float("inf")).working(seconds))
    return found or NeverTogether(frozenset(), None)
