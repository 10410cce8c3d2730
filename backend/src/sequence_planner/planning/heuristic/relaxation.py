"""Delete-relaxed reachability: accumulated variable values, and starts excluded by the supervisor."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Set
from functools import cached_property
from itertools import product
from math import prod

from sequence_planner.automaton.automaton import Automaton, Flag, State, target
from sequence_planner.automaton.state_set import EVERYTHING, FIRST_NODE, NOTHING, StateSet, Supervisor
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import (
    And,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    variables,
)
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Circumstances, Clause, Literal, Proof

# What a supervisor may allow where variables have gathered values: what it never allows from there never starts.

_MOST_NODES = 80_000  # of safe states that are looked at in all: a fifth of a second

_Branches = tuple[bool, list[int]]  # whether every one of them must be safe, as nobody knows, and their places


class Permission:
    """Looks up a supervisor's safe states, as far as that takes little time; from then on it says yes.

    It says so too often and never too seldom. Of one relaxation: what is possible there only grows.
    """

    def __init__(self, supervisor: Supervisor) -> None:
        self._safe: StateSet = supervisor.safe
        self._left = _MOST_NODES
        self._kept: tuple[int, list[_Branches], dict[int, bool]] | None = None

    def may(self, move: Transition, possible: Mapping[str, set[Value | None]]) -> bool:
        """Return whether `move` may be taken from a safe state and lead to one, as far as `possible` values tell."""
        if move.phase is not Phase.START or self._safe.root == EVERYTHING or self._left < 0:
            return True
        return self._may_be_safe(possible, self._written(move, possible)) and self._may_be_safe(possible, {})

    def _written(self, move: Transition, possible: Mapping[str, set[Value | None]]) -> Mapping[str, Set[Value | None]]:
        """The values that what `move` writes may have then: any, where that depends on the state."""
        written: dict[str, Set[Value | None]] = {}
        for action in move.actions:
            name = target(action)
            if name not in self._domains or possible[name] == {None}:  # what is unknown stays so
                continue
            may: Set[Value | None] = {action.value.value} if isinstance(action.value, Constant) else self._domains[name]
            otherwise = frozenset() if action.condition is None else possible[name]
            written[name] = may | otherwise | written.get(name, frozenset())
        return written

    def _may_be_safe(self, possible: Mapping[str, set[Value | None]], written: Mapping[str, Set[Value | None]]) -> bool:
        """Return whether a safe state may have `written` values, or else `possible` ones; of an unknown variable every
        one.
        """
        possibly, known = self._at_hand(possible)
        axes = list(possibly)
        deepest = -1  # below it nothing is written, so that it is as it was for other moves
        for name in written.keys() & self._axes.keys():
            deepest = max(deepest, axis := self._axes[name])
            axes[axis] = self._branches(axis, written[name], unknown=False)
        may = {NOTHING: False, EVERYTHING: True}
        children: dict[int, tuple[bool, list[int]]] = {}  # whether every one of them must be, and which
        pending = [self._safe.root]
        while pending:
            reference = pending.pop()
            if reference in children or reference in may:
                continue
            axis, branches = self._safe.nodes[reference - FIRST_NODE]
            if axis > deepest and reference in known:
                may[reference] = known[reference]
                continue
            every, places = axes[axis]
            below = [branches[place] for place in places]
            children[reference] = every, below
            pending += below
        self._left -= len(children)
        for reference in sorted(children):  # a node comes after those it refers to
            every, below = children[reference]
            may[reference] = (all if every else any)([may[each] for each in below])
            if self._safe.nodes[reference - FIRST_NODE][0] > deepest:
                known[reference] = may[reference]
        return may[self._safe.root]

    def _at_hand(self, possible: Mapping[str, set[Value | None]]) -> tuple[list[_Branches], dict[int, bool]]:
        """The branches of each axis for `possible` values, and what is known of nodes until one more is possible."""
        size = sum(map(len, possible.values()))  # no value is ever lost
        if self._kept is None or self._kept[0] != size:
            sets = [possible[name] for name in self._safe.names]
            axes = [self._branches(axis, values, unknown=values == {None}) for axis, values in enumerate(sets)]
            self._kept = size, axes, {}
        return self._kept[1:]

    def _branches(self, axis: int, values: Set[Value | None], *, unknown: bool) -> _Branches:
        if unknown:
            return True, list(range(len(self._safe.domains[axis])))
        positions = self._positions[axis]
        return False, [positions[value] for value in values if value is not None]

    @cached_property
    def _axes(self) -> Mapping[str, int]:
        return {name: axis for axis, name in enumerate(self._safe.names)}

    @cached_property
    def _domains(self) -> Mapping[str, frozenset[Value | None]]:
        return dict(zip(self._safe.names, map(frozenset, self._safe.domains), strict=True))

    @cached_property
    def _positions(self) -> tuple[dict[Value, int], ...]:
        return tuple({value: place for place, value in enumerate(domain)} for domain in self._safe.domains)


# Reachability with nothing ever undone: each variable gathers values, and never loses one.
#
# Whatever the station can do, the relaxation can. A goal it cannot reach can never be reached, which is a proof that
# there is no plan at all; this is the delete relaxation of planning (Bonet and Geffner 2001) over finite domains.

Possible = Mapping[str, set[Value | None]]

# An expression over more combinations than this is not evaluated: it may have any value, so the relaxation stays sound.
_MOST_COMBINATIONS = 4096


def reachable(
    automaton: Automaton,
    state: State,
    circumstances: Circumstances,
    supervisor: Supervisor | None = None,
    pause: Callable[[], object] = lambda: None,
) -> Relaxation:
    """All that runs from `state` can make of variables and flags, and perhaps more.

    Operations stay as active as they are. With a `supervisor` nothing starts that it never allows, which takes longer.
    `pause` is called again and again, and may raise.
    """
    first: dict[str, set[Value | None]] = {name: {value} for name, value in state.items()}
    permission = None if supervisor is None else Permission(supervisor)
    return Relaxation(automaton, first, counted_on(automaton, circumstances), permission, pause)


def unreached(automaton: Automaton, relaxed: Relaxation) -> Proof:
    """That no run leaves the relaxation: what has never gained a value does not have it."""
    clauses: list[Clause] = []
    for name, type_ in automaton.types.items():
        never = (value for value in type_.domain if value not in relaxed.possible[name])
        clauses += [(Literal(name, value, equal=False),) for value in never]
    return Proof("relaxation", tuple(clauses))


def counted_on(automaton: Automaton, circumstances: Circumstances) -> tuple[Transition, ...]:
    """The transitions a plan may be made of: no faults, and nothing that does not happen or start."""
    offline = circumstances.offline
    idle = {effect.name for effect in automaton.effects if effect.fault or effect.resource in offline}
    idle |= {f"{name}.start" for name, ability in automaton.abilities.items() if circumstances.bars(ability)}
    return tuple(transition for transition in transitions(automaton) if transition.name not in idle)


class Relaxation:
    """The values that each variable and flag may get from `first`, where each has some already, by permitted
    `moves`.
    """

    def __init__(
        self,
        automaton: Automaton,
        first: Possible,
        moves: Iterable[Transition],
        permission: Permission | None = None,
        pause: Callable[[], object] = lambda: None,
    ) -> None:
        self._automaton = automaton
        self._permission = permission
        self.possible = {name: set(values) for name, values in first.items()}
        self._true: set[tuple[int, bool]] = set()  # expressions known to have a truth value, which they never lose
        self._kept: list[Expression] = []  # so that no identity is given to another expression
        steps: list[Transition | Flag] = [*automaton.flags, *moves]
        permitted: set[int] = set()
        readers: dict[str, list[int]] = defaultdict(list)
        for number, step in enumerate(steps):
            for name in set(variables(step.predicate)) if isinstance(step, Flag) else step.reads:
                readers[name].append(number)
        waiting = dict.fromkeys(range(len(steps)))
        held: dict[int, Transition] = {}  # that only the supervisor keeps from being taken
        while waiting:
            pause()
            number = waiting.popitem()[0]
            step = steps[number]
            if (
                permission is not None
                and isinstance(step, Transition)
                and step.controllable
                and number not in permitted
            ):
                if self.may(step.guard):
                    held[number] = step
            else:
                for name in self._taken(step):
                    waiting.update(dict.fromkeys(readers[name]))
            if not waiting and held:  # once nothing else is to be done, as this takes longest
                now = [each for each, start in held.items() if self._may_start(start)]
                permitted.update(now)
                for each in now:
                    del held[each]
                waiting.update(dict.fromkeys(now))

    def may(self, predicate: Expression, truth: bool = True) -> bool:
        """Return whether some choice of possible values may give `predicate` the value `truth`."""
        key = (id(predicate), truth)
        if key in self._true:
            return True
        if not self._may(predicate, truth):
            return False
        self._true.add(key)
        self._kept.append(predicate)
        return True

    def _may_start(self, start: Transition) -> bool:
        return self._permission is None or self._permission.may(start, self.possible)

    def _taken(self, step: Transition | Flag) -> list[str]:
        """Take a step if it may be; what has gained values."""
        if isinstance(step, Flag):
            values = self.possible[step.name]
            new = [t for t in (True, False) if t not in values and self.may(step.predicate, t)]
            values.update(new)
            return [step.name] if new else []
        if not self.may(step.guard):
            return []
        return [target(action) for action in step.actions if self._gather(action)]

    def _gather(self, action: Assignment) -> bool:
        """Add what `action` can write; whether anything was new."""
        if action.condition is not None and not self.may(action.condition):
            return False
        name = target(action)
        if self.possible[name] == {None}:
            return False  # the planner keeps an unknown variable unknown
        domain = set(self._automaton.variables[name].type.domain)
        values = self._values(action.value)
        # Where it is taken an action writes a value of the domain; it is looked at where it is not taken, too.
        new = (domain if values is None else domain & values) - self.possible[name]
        self.possible[name] |= new
        return bool(new)

    def _may(self, predicate: Expression, truth: bool) -> bool:
        match predicate:
            case Constant(value):
                return value is truth
            case Variable(name):
                return truth in self.possible[name]
            case Not(operand):
                return self.may(operand, not truth)
            case And(operands):
                decide = all if truth else any
                return decide(self.may(part, truth) for part in operands)
            case Or(operands):
                decide = any if truth else all
                return decide(self.may(part, truth) for part in operands)
            case Implies(left, right) if truth:
                return self.may(left, False) or self.may(right, True)
            case Implies(left, right):
                return self.may(left, True) and self.may(right, False)
            case Comparison("==" | "!=" as relation, left, Constant(value)):
                return self._may_equal(left, {value}, truth is (relation == "=="))
            case Comparison("==" | "!=" as relation, left, Variable(name)):
                return self._may_equal(left, self.possible[name], truth is (relation == "=="))
            case Membership(left, options) if all(isinstance(option, Constant) for option in options):
                return self._may_be_among(left, {o.value for o in options if isinstance(o, Constant)}, truth)
        values = self._values(predicate)
        return values is None or truth in values

    def _may_equal(self, left: Expression, right: set[Value | None], truth: bool) -> bool:
        if (values := self._values(left)) is None:
            return True
        known, other = values - {None}, right - {None}
        return bool(known & other) if truth else len(known | other) > 1 and bool(known and other)

    def _may_be_among(self, left: Expression, options: set[Value], truth: bool) -> bool:
        values = self._values(left)
        return values is None or bool(values & options if truth else values - options - {None})

    def _values(self, expression: Expression) -> set[Value | None] | None:
        """Return what `expression` may be; None when there are too many combinations to say."""
        match expression:
            case Constant(value):
                return {value}
            case Variable(name):
                return self.possible[name]
        names = sorted(set(variables(expression)))
        if self._combinations(names) > _MOST_COMBINATIONS:
            return None
        return {
            evaluate(expression, dict(zip(names, values, strict=True)))
            for values in product(*(self.possible[name] for name in names))
        }

    def _combinations(self, names: Iterable[str]) -> int:
        return prod(len(self.possible[name]) for name in names)
