"""Translation of a planning problem to sequential actions, as input for classical planners."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

from sequence_planner.automaton.automaton import Automaton, State, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.plain.updates import decided
from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.tick import synchronise
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.export.case_splits import condition_of, no_dispute
from sequence_planner.export.efa import allowed_values, can_dispute, reaction_order, writes_outside
from sequence_planner.language.evaluator import holds
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.substitution import Replacements, replaced
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    conjunction,
)
from sequence_planner.language.types import BOOLEAN, BooleanType, Type, Value
from sequence_planner.planning.heuristic.relaxation import counted_on
from sequence_planner.planning.problem import Circumstances, Goal

# A question to the planner as actions that are taken one after another: what classical planners understand.
#
# A tick is begun by `begin`, then come the effects that happen in it, one by one. `finishing` sees which finishes are
# due; when all of these have been taken, `settled` ends step 3, and then come the starts. Every such sequence is a run
# of ticks, and every run is such a sequence: what reads a value of before the tick is kept from being taken after what
# writes it, or reads a copy where that would exclude a run.

# Ways through a guard of the supervisor, so that texts stay readable and are soon written.
MOST_PATHS = 256


class ExportError(Exception):
    """A request that has no counterpart there; says why, and what to do."""


class Move(StrEnum):
    """The role of an action in a run of ticks."""

    BEGIN = "begin"
    EFFECT = "effect"
    FINISHING = "finishing"
    FINISH = "finish"
    SETTLED = "settled"
    START = "start"
    REACH = "reach"  # a goal is seen to hold after step 3


@dataclass(frozen=True)
class ConditionalUpdate:
    """An update by which, where `condition` holds before the action, `variable` gets `value`."""

    variable: str
    value: Value
    condition: Expression = TRUE


@dataclass(frozen=True)
class Action:
    """A guarded update; `name` is that of the effect, the ability or the goal. All updates read the state before."""

    move: Move
    name: str
    guard: Expression
    updates: tuple[ConditionalUpdate, ...]


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


def updates_of(automaton: Automaton, transition: Transition, seen: Replacements) -> Iterator[ConditionalUpdate]:
    """Yield what a transition writes, each value on its own; `seen` is what its actions read in place of variables."""
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
                yield ConditionalUpdate(name, each, where)


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


# The ticks of a station as sequential actions.

# The phases of a tick, and that no start has come since step 3.
SENSING, FINISHING, ACTING, SETTLED = (
    Variable(f"phase:{name}", BOOLEAN) for name in ("sensing", "finishing", "acting", "settled")
)


def sequential(
    automaton: Automaton,
    supervisor: Supervisor,
    state: State,
    goals: Iterable[Goal],
    circumstances: Circumstances = Circumstances(),
) -> Sequential:
    """The question whether a station reaches `goals` from `state`, one after step 3 or after a start.

    An automaton without effects, finishes and outputs, such as `planning.efa_planner.for_planning` makes, needs no
    ticks: each start could have its own. Raises `ExportError` where a value is unknown, and for what has no
    counterpart.
    """
    asked = tuple(goals)
    require_counterparts(automaton, supervisor, state, asked, circumstances)
    return _Ticks(automaton, supervisor, state, asked, circumstances).sequential()


class _Ticks:
    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        state: State,
        goals: tuple[Goal, ...],
        circumstances: Circumstances,
    ) -> None:
        self._automaton, self._state, self._goals = automaton, state, goals
        self._flags = inlined(automaton)
        self._guards = supervisor.guards
        moves = counted_on(automaton, circumstances)
        self._effects = [t for t in moves if t.phase is Phase.SENSE and t.writes]
        self._finishes = [t for t in moves if t.phase is Phase.FINISH and t.actions]
        self._starts = [t for t in moves if t.phase is Phase.START]
        self._timeless = not (self._effects or self._finishes or automaton.outputs)
        self._permitted = conjunction(*(Not(replaced(avoided, self._flags)) for avoided in circumstances.avoid))
        self._order = reaction_order(self._effects, self._flags)
        self._notes = {} if self._timeless else self._noted()
        self._unpublished = {} if self._timeless else self._revertible()
        self._helpers: dict[str, tuple[Type, Value]] = {}

    def sequential(self) -> Sequential:
        automaton = self._automaton
        reached = [self._helper("reached", g.name, holds(g.predicate, self._state)) for g in self._goals]
        actions = [*self._reaching(), *map(self._starting, self._starts)]
        if not self._timeless:
            self._helpers |= {each.name: (BOOLEAN, each is SENSING) for each in (SENSING, FINISHING, ACTING, SETTLED)}
            actions = [*map(self._happening, self._effects), *self._finishing(), *actions]
            actions.insert(0, self._beginning())
        types = {name: variable.type for name, variable in automaton.variables.items()}
        values: dict[str, Value] = {}
        for name in automaton.variables:
            value = self._state[name]
            assert value is not None
            values[name] = value
        for name, (type_, value) in self._helpers.items():
            types[name], values[name] = type_, value
        return Sequential(automaton.title, types, values, tuple(actions), conjunction(*reached))

    def _helper(self, what: str, name: str, initial: bool = False) -> Variable:
        """A truth value of our own; no name of a model has a colon."""
        helper = Variable(f"{what}:{name}", BOOLEAN)
        self._helpers.setdefault(helper.name, (BOOLEAN, initial))
        return helper

    def _variable(self, name: str) -> Variable:
        return Variable(name, self._automaton.variables[name].type)

    def _noted(self) -> dict[str, Expression]:
        """The flags that finishes read as the last tick left them, and effects may change."""
        written = frozenset[str]().union(*(effect.writes for effect in self._effects))
        read = frozenset[str]().union(*(finish.reads for finish in self._finishes))
        return {
            name: predicate
            for name, predicate in self._flags.items()
            if name in read and read_variables(self._automaton, (predicate,)) & written
        }

    def _revertible(self) -> dict[tuple[str, Value], Variable]:
        """Values of outputs that a start can set, after another change in the same tick has left them unpublished."""
        by_start, by_any = defaultdict[str, set[Value]](set), defaultdict[str, set[Value]](set)
        for transition in (*self._starts, *self._finishes):
            for update in self._updates(transition):
                if update.variable in self._automaton.outputs:
                    by_any[update.variable].add(update.value)
                    if transition.phase is Phase.START:
                        by_start[update.variable].add(update.value)
        return {
            (name, value): Variable(f"unpublished:{name}={value}", BOOLEAN)
            for name, values in by_start.items()
            for value in sorted(values, key=str)
            if by_any[name] - {value}
        }

    def _updates(self, transition: Transition) -> tuple[ConditionalUpdate, ...]:
        return tuple(updates_of(self._automaton, transition, self._flags))

    def _beginning(self) -> Action:
        updates = [
            ConditionalUpdate(SENSING.name, True),
            ConditionalUpdate(ACTING.name, False),
            ConditionalUpdate(SETTLED.name, False),
        ]
        updates += [ConditionalUpdate(n, False) for n in self._helpers if n.startswith(("started:", "unpublished:"))]
        for name, predicate in self._notes.items():
            note = self._helper("note", name, self._state[name] is True).name
            updates.append(ConditionalUpdate(note, True, predicate))
        for name in sorted(self._order.copies):
            copy, original = self._copy(name), self._variable(name)
            updates += [ConditionalUpdate(copy.name, value, has(original, value)) for value in copy.type.domain]
        return Action(Move.BEGIN, "", simplify(conjunction(ACTING, self._permitted)), tuple(updates))

    def _copy(self, name: str) -> Variable:
        copy = Variable(f"before:{name}", self._automaton.variables[name].type)
        value = self._state[name]
        assert value is not None
        self._helpers.setdefault(copy.name, (copy.type, value))
        return copy

    def _happening(self, effect: Transition) -> Action:
        copies = {name: self._copy(name) for name in self._order.copies}
        seen = {**copies, **{name: replaced(predicate, copies) for name, predicate in self._flags.items()}}
        marks = {name: self._helper("sensed", name) for name in self._order.marked & effect.writes}
        updates = tuple(updates_of(self._automaton, effect, seen))
        agreed = (
            Implies(
                conjunction(update.condition, marks[update.variable]),
                has(self._variable(update.variable), update.value),
            )
            for update in updates
            if update.variable in self._order.contended
        )
        first = (Not(self._helper("sensed", name)) for name in sorted(self._order.locks[effect.name]))
        guard = conjunction(SENSING, replaced(effect.guard, seen), *first, *agreed)
        marked = {
            ConditionalUpdate(marks[u.variable].name, True, u.condition): None for u in updates if u.variable in marks
        }
        return Action(Move.EFFECT, effect.name, simplify(guard), (*updates, *marked))

    def _finishing(self) -> Iterator[Action]:
        """All finishes are judged at once, and then taken one by one."""
        notes = {name: self._helper("note", name, self._state[name] is True) for name in self._notes}
        seen = {**self._flags, **notes}
        due: list[Variable] = []
        judged: list[ConditionalUpdate] = []
        for finish in self._finishes:
            guard = conjunction(replaced(finish.guard, seen), *self._undisputed(finish, seen))
            ways: dict[Expression, list[ConditionalUpdate]] = {}
            for update in updates_of(self._automaton, finish, seen):
                ways.setdefault(update.condition, []).append(ConditionalUpdate(update.variable, update.value))
            for number, (condition, updates) in enumerate(ways.items(), start=1):
                name = finish.name.removesuffix(f".{Phase.FINISH}") + (f"#{number}" if number > 1 else "")
                helper = self._helper("due", name)
                due.append(helper)
                judged.append(ConditionalUpdate(helper.name, True, simplify(conjunction(guard, condition))))
                lost = [each for update in updates for each in self._unseen(update, among_others=False)]
                yield Action(Move.FINISH, name, helper, (ConditionalUpdate(helper.name, False), *updates, *lost))
        marks = (ConditionalUpdate(name, False) for name in self._helpers if name.startswith("sensed:"))
        phases = (ConditionalUpdate(SENSING.name, False), ConditionalUpdate(FINISHING.name, True))
        yield Action(Move.FINISHING, "", SENSING, (*phases, *marks, *judged))
        forgotten = (ConditionalUpdate(note.name, False) for note in notes.values())
        done = (
            ConditionalUpdate(FINISHING.name, False),
            ConditionalUpdate(ACTING.name, True),
            ConditionalUpdate(SETTLED.name, True),
        )
        yield Action(Move.SETTLED, "", conjunction(FINISHING, *map(Not, due)), (*done, *forgotten))

    def _undisputed(self, finish: Transition, seen: Replacements) -> Iterator[Expression]:
        for other in self._finishes:
            if other is not finish and can_dispute(finish, other):
                yield no_dispute(finish, other, seen)

    def _unseen(self, update: ConditionalUpdate, among_others: bool) -> Iterator[ConditionalUpdate]:
        """The value that an output loses, the first of several in this tick, is not set back before it is published."""
        own = {value: helper for (name, value), helper in self._unpublished.items() if name == update.variable}
        none = [Not(helper) for helper in own.values()] if among_others else []
        for value, helper in own.items():
            if value != update.value:
                self._helpers.setdefault(helper.name, (BOOLEAN, False))
                lost = conjunction(update.condition, has(self._variable(update.variable), value), *none)
                yield ConditionalUpdate(helper.name, True, simplify(lost))

    def _starting(self, start: Transition) -> Action:
        name = start.name.removesuffix(f".{Phase.START}")
        updates = [update for each in self._updates(start) for update in (each, *self._unseen(each, among_others=True))]
        guard = [replaced(start.guard, self._flags), self._permitted]
        if (states := self._guards.get(name)) is not None:
            read = {n: self._variable(n) if n in self._automaton.variables else self._flags[n] for n in states.names}
            guard.append(member(states, read))
        if not self._timeless:
            updates.append(ConditionalUpdate(SETTLED.name, False))
            guard.append(ACTING)
            for each in self._updates(start):
                if (
                    each.value is not None
                    and (helper := self._unpublished.get((each.variable, each.value))) is not None
                ):
                    guard.append(Not(conjunction(each.condition, helper)))
            if not self._disables_itself(start):
                once = self._helper("started", name)
                updates.append(ConditionalUpdate(once.name, True))
                guard.append(Not(once))
        return Action(Move.START, name, simplify(conjunction(*guard)), tuple(updates))

    def _disables_itself(self, start: Transition) -> bool:
        """Return whether no other start of the same tick could make it possible again."""
        allowed = allowed_values(replaced(start.guard, self._flags))
        others = frozenset[str]().union(*(other.writes for other in self._starts if other is not start))
        return any(writes_outside(start, name, allowed) for name in start.writes - others)

    def _reaching(self) -> Iterator[Action]:
        for goal in self._goals:
            reached = self._helper("reached", goal.name)
            predicate = replaced(goal.predicate, self._flags)
            settled = TRUE if self._timeless else SETTLED
            guard = simplify(conjunction(settled, Not(reached), predicate, self._permitted))
            yield Action(Move.REACH, goal.name, guard, (ConditionalUpdate(reached.name, True),))
