"""A question to the planner as actions that are taken one after another: what classical planners understand.

A tick is begun by `begin`, then come the effects that happen in it, one by one. `finishing` sees which finishes are
due; when all of these have been taken, `settled` ends step 3, and then come the starts. Every such sequence is a run of
ticks, and every run is such a sequence: what reads a value of before the tick is kept from being taken after what
writes it, or reads a copy where that would exclude a run.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

from sequence_planner.automaton.plain.updates import decided
from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.structure import Automaton, State, target
from sequence_planner.automaton.tick import synchronise
from sequence_planner.automaton.transitions import Transition
from sequence_planner.exporting.cases import condition_of
from sequence_planner.expressions.replacing import Replacements, replaced
from sequence_planner.expressions.simplification import simplify
from sequence_planner.expressions.syntax import (
    FALSE,
    TRUE,
    Comparison,
    Constant,
    Expression,
    Membership,
    Not,
    Or,
    Variable,
    conjunction,
)
from sequence_planner.expressions.types import BooleanType, Type, Value
from sequence_planner.planning.plan import Circumstances, Goal

# Ways through a guard of the supervisor, so that texts stay readable and are soon written.
MOST_PATHS = 256


class ExportError(Exception):
    """What is asked has no counterpart there; says why, and what to do."""


class Move(StrEnum):
    """What an action is in a run of ticks."""

    BEGIN = "begin"
    EFFECT = "effect"
    FINISHING = "finishing"
    FINISH = "finish"
    SETTLED = "settled"
    START = "start"
    REACH = "reach"  # a goal is seen to hold after step 3


@dataclass(frozen=True)
class Update:
    """Where `condition` holds before the action, `variable` gets `value`."""

    variable: str
    value: Value
    condition: Expression = TRUE


@dataclass(frozen=True)
class Action:
    """A guarded update; `name` is that of the effect, the ability or the goal. All updates read the state before."""

    move: Move
    name: str
    guard: Expression
    updates: tuple[Update, ...]


@dataclass(frozen=True)
class Sequential:
    """Actions over variables of finite domains, from `initial` to `goal`.

    Guards and conditions read variables alone, no flags.
    """

    title: str
    types: Mapping[str, Type]
    initial: Mapping[str, Value]
    actions: tuple[Action, ...]
    goal: Expression


def inlined(automaton: Automaton) -> dict[str, Expression]:
    """The predicate of each flag over variables alone."""
    found: dict[str, Expression] = {}
    for flag in automaton.flags:
        found[flag.name] = simplify(replaced(flag.predicate, found))
    return found


def has(variable: Variable, value: Value) -> Expression:
    """That a variable has a value."""
    if isinstance(variable.type, BooleanType):
        return variable if value else Not(variable)
    return Comparison("==", variable, Constant(value))


def updates_of(automaton: Automaton, transition: Transition, seen: Replacements) -> Iterator[Update]:
    """What a transition writes, each value on its own; `seen` is what its actions read in place of variables."""
    for action in transition.actions:
        name = target(action)
        type_ = automaton.variables[name].type
        condition = simplify(condition_of(action, seen))
        value = simplify(replaced(action.value, seen))
        for each in (value.value,) if isinstance(value, Constant) else type_.domain:
            if isinstance(value, Constant):
                equal: Expression = TRUE
            elif isinstance(type_, BooleanType):
                equal = value if each else Not(value)
            else:
                equal = decided(Comparison("==", value, Constant(each)))
            where = simplify(conjunction(condition, equal))
            if where != FALSE:
                yield Update(name, each, where)


def member(states: StateSet, variables: Mapping[str, Expression]) -> Expression:
    """That a state is in `states`, over what stands for its variables and flags. Raises `ExportError`."""
    made: dict[int, Expression] = {NOTHING: FALSE, EVERYTHING: TRUE}
    paths = {NOTHING: 0, EVERYTHING: 1}
    for number, (axis, children) in enumerate(states.nodes, start=2):
        variable = variables[states.names[axis]]
        ways: dict[int, list[Value]] = {}
        for child, value in zip(children, states.domains[axis], strict=True):
            ways.setdefault(child, []).append(value)
        paths[number] = sum(paths[child] for child in ways)
        if paths[number] > MOST_PATHS:
            raise ExportError(
                f"a guard of the supervisor takes more than {MOST_PATHS} cases to write down: leave out a specification"
            )
        made[number] = simplify(
            Or((FALSE, *(conjunction(_among(variable, values), made[child]) for child, values in ways.items())))
        )
    return made[states.root]


def _among(variable: Expression, values: list[Value]) -> Expression:
    if all(isinstance(value, bool) for value in values):
        return TRUE if len(values) == 2 else variable if values[0] else Not(variable)
    return Membership(variable, tuple(map(Constant, values)))


def require_counterparts(
    automaton: Automaton, supervisor: Supervisor, state: State, goals: tuple[Goal, ...], circumstances: Circumstances
) -> None:
    """Raises `ExportError` for what no sequential actions can say."""
    if unknown := [name for name in automaton.variables if state[name] is None]:
        raise ExportError(f"`{unknown[0]}` has no value, and other planners know no unknown values: give it one")
    if synchronise(automaton, state) != state:
        raise ExportError("the state is none between ticks, since flags contradict it: take one after step 3")
    if not supervisor.safe.includes(state):
        raise ExportError("the state is not safe, so that nothing may start: lead the station back first")
    if local := [goal.name for goal in goals if goal.local != TRUE]:
        raise ExportError(f"the goal `{local[0]}` has a `local` formula, which has no counterpart: leave that goal out")
    if circumstances.restart and not supervisor.safe.everything:
        raise ExportError("restart abilities under specifications have no counterpart: leave out one or the other")
