"""The ticks of a station as sequential actions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.exporting.cases import no_dispute
from sequence_planner.exporting.reaction_order import allowed_values, reaction_order, writes_outside
from sequence_planner.exporting.sequential import (
    Action,
    Move,
    Sequential,
    Update,
    has,
    inlined,
    member,
    require_counterparts,
    updates_of,
)
from sequence_planner.exporting.together import can_dispute
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.replacing import Replacements, replaced
from sequence_planner.expressions.simplification import simplify
from sequence_planner.expressions.syntax import TRUE, Expression, Implies, Not, Variable, conjunction
from sequence_planner.expressions.types import BOOLEAN, Type, Value
from sequence_planner.planning.plan import Circumstances, Goal
from sequence_planner.planning.relaxed.relaxation import counted_on

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

    An automaton without effects, finishes and outputs, such as `planning.plain.for_planning` makes, needs no ticks:
    each start could have its own. Raises `ExportError` where a value is unknown, and for what has no counterpart.
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

    def _updates(self, transition: Transition) -> tuple[Update, ...]:
        return tuple(updates_of(self._automaton, transition, self._flags))

    def _beginning(self) -> Action:
        updates = [Update(SENSING.name, True), Update(ACTING.name, False), Update(SETTLED.name, False)]
        updates += [Update(n, False) for n in self._helpers if n.startswith(("started:", "unpublished:"))]
        for name, predicate in self._notes.items():
            note = self._helper("note", name, self._state[name] is True).name
            updates.append(Update(note, True, predicate))
        for name in sorted(self._order.copies):
            copy, original = self._copy(name), self._variable(name)
            updates += [Update(copy.name, value, has(original, value)) for value in copy.type.domain]
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
        marked = {Update(marks[u.variable].name, True, u.condition): None for u in updates if u.variable in marks}
        return Action(Move.EFFECT, effect.name, simplify(guard), (*updates, *marked))

    def _finishing(self) -> Iterator[Action]:
        """All finishes are judged at once, and then taken one by one."""
        notes = {name: self._helper("note", name, self._state[name] is True) for name in self._notes}
        seen = {**self._flags, **notes}
        due: list[Variable] = []
        judged: list[Update] = []
        for finish in self._finishes:
            guard = conjunction(replaced(finish.guard, seen), *self._undisputed(finish, seen))
            ways: dict[Expression, list[Update]] = {}
            for update in updates_of(self._automaton, finish, seen):
                ways.setdefault(update.condition, []).append(Update(update.variable, update.value))
            for number, (condition, updates) in enumerate(ways.items(), start=1):
                name = finish.name.removesuffix(f".{Phase.FINISH}") + (f"#{number}" if number > 1 else "")
                helper = self._helper("due", name)
                due.append(helper)
                judged.append(Update(helper.name, True, simplify(conjunction(guard, condition))))
                lost = [each for update in updates for each in self._unseen(update, among_others=False)]
                yield Action(Move.FINISH, name, helper, (Update(helper.name, False), *updates, *lost))
        marks = (Update(name, False) for name in self._helpers if name.startswith("sensed:"))
        phases = (Update(SENSING.name, False), Update(FINISHING.name, True))
        yield Action(Move.FINISHING, "", SENSING, (*phases, *marks, *judged))
        forgotten = (Update(note.name, False) for note in notes.values())
        done = (Update(FINISHING.name, False), Update(ACTING.name, True), Update(SETTLED.name, True))
        yield Action(Move.SETTLED, "", conjunction(FINISHING, *map(Not, due)), (*done, *forgotten))

    def _undisputed(self, finish: Transition, seen: Replacements) -> Iterator[Expression]:
        for other in self._finishes:
            if other is not finish and can_dispute(finish, other):
                yield no_dispute(finish, other, seen)

    def _unseen(self, update: Update, among_others: bool) -> Iterator[Update]:
        """The value that an output loses, the first of several in this tick, is not set back before it is published."""
        own = {value: helper for (name, value), helper in self._unpublished.items() if name == update.variable}
        none = [Not(helper) for helper in own.values()] if among_others else []
        for value, helper in own.items():
            if value != update.value:
                self._helpers.setdefault(helper.name, (BOOLEAN, False))
                lost = conjunction(update.condition, has(self._variable(update.variable), value), *none)
                yield Update(helper.name, True, simplify(lost))

    def _starting(self, start: Transition) -> Action:
        name = start.name.removesuffix(f".{Phase.START}")
        updates = [update for each in self._updates(start) for update in (each, *self._unseen(each, among_others=True))]
        guard = [replaced(start.guard, self._flags), self._permitted]
        if (states := self._guards.get(name)) is not None:
            read = {n: self._variable(n) if n in self._automaton.variables else self._flags[n] for n in states.names}
            guard.append(member(states, read))
        if not self._timeless:
            updates.append(Update(SETTLED.name, False))
            guard.append(ACTING)
            for each in self._updates(start):
                if (
                    each.value is not None
                    and (helper := self._unpublished.get((each.variable, each.value))) is not None
                ):
                    guard.append(Not(conjunction(each.condition, helper)))
            if not self._disables_itself(start):
                once = self._helper("started", name)
                updates.append(Update(once.name, True))
                guard.append(Not(once))
        return Action(Move.START, name, simplify(conjunction(*guard)), tuple(updates))

    def _disables_itself(self, start: Transition) -> bool:
        """Whether no other start of the same tick could make it possible again."""
        allowed = allowed_values(replaced(start.guard, self._flags))
        others = frozenset[str]().union(*(other.writes for other in self._starts if other is not start))
        return any(writes_outside(start, name, allowed) for name in start.writes - others)

    def _reaching(self) -> Iterator[Action]:
        for goal in self._goals:
            reached = self._helper("reached", goal.name)
            predicate = replaced(goal.predicate, self._flags)
            settled = TRUE if self._timeless else SETTLED
            guard = simplify(conjunction(settled, Not(reached), predicate, self._permitted))
            yield Action(Move.REACH, goal.name, guard, (Update(reached.name, True),))
